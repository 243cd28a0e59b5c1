//! What a domain must show before a claim is made about it: its shortest solution, and how often somebody succeeds who
//! acts at random.
//!
//! A world of choices is searched ([`Search`]) and played ([`Random`]); of bodies there is no shortest solution, they
//! are played only. Everything is a function of the domain and of [`Options`].

mod random;
mod search;

pub use random::{Random, Spread};
pub use search::{Answer, REPEATS, Search, Searched};

use serde::Serialize;

use crate::{
    Environment, Spec, TimeLimit, check,
    world::{Layout, Symbolic, World},
};

/// How much to look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// The seed of the first layout searched and of the first episode played; the others' follow it.
    pub seed: u64,
    /// Layouts that are searched, where there are several.
    pub layouts: u64,
    /// States of a layout after which its search gives up. A million take up to half a minute and 200 MB.
    pub states: usize,
    /// Episodes that are played at random, at most.
    pub episodes: u64,
    /// Steps after which no other episode is begun. Where nothing limits an episode, none takes longer either.
    pub steps: u64,
}

impl Default for Options {
    fn default() -> Self {
        Self { seed: 0, layouts: 10, states: 1_000_000, episodes: 10_000, steps: 10_000_000 }
    }
}

/// What was found out.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Certificate {
    /// The domain.
    pub name: &'static str,
    /// Which layouts it has; `None`: it has no choice of them.
    pub layout: Option<Layout>,
    /// Steps after which an episode is truncated.
    pub time_limit: Option<u32>,
    /// An episode that terminates with at least this reward on its last step succeeded.
    pub success_reward: f32,
    /// The shortest solutions; `None` where states cannot be searched.
    pub search: Option<Search>,
    /// How random actions fare.
    pub random: Random,
}

/// Searches a world, and plays it at random.
pub fn world<W: World>(world: W, layout: Layout, options: &Options) -> Certificate {
    let limit = world.card().limit;
    let search = search::world(&mut world.clone(), layout, options);
    let unlimited = Symbolic::new(world, layout);
    let random = match limit {
        Some(limit) => random::play(&mut TimeLimit::new(unlimited.clone(), limit), options),
        None => random::play(&mut unlimited.clone(), options),
    };
    let spec = Spec { time_limit: limit, ..unlimited.spec().clone() };
    Certificate { search: Some(search), layout: Some(layout), ..without_search(&spec, random) }
}

/// Plays any environment at random.
pub fn environment<E>(env: &mut E, options: &Options) -> Certificate
where
    E: Environment<Action: check::Drawn> + ?Sized,
{
    let random = random::play(env, options);
    without_search(env.spec(), random)
}

fn without_search(spec: &Spec, random: Random) -> Certificate {
    Certificate {
        name: spec.name,
        layout: None,
        time_limit: spec.time_limit,
        success_reward: spec.success_reward,
        search: None,
        random,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::{Card, Draw, nine::Nine};

    /// Steps from the start to the goal.
    fn distance(draw: Draw) -> usize {
        let (mut world, mut symbols) = (Nine::new(false), Vec::new());
        world.begin(draw);
        world.symbols(&mut symbols);
        ((symbols[0] - symbols[2]).abs() + (symbols[1] - symbols[3]).abs()) as usize
    }

    #[test]
    fn solutions_of_nine_cells_are_shortest_and_hold() {
        for layout in [Layout::Random, Layout::FixedMap(3), Layout::Fixed(3)] {
            let found = world(Nine::new(false), layout, &Options { episodes: 2000, ..Options::default() });
            let search = found.search.expect("worlds are searched");
            assert!(search.shortest && !search.lucky);
            let count = if layout == Layout::Fixed(3) { 1 } else { 10 };
            assert_eq!((search.solved, search.layouts.len()), (count, count));
            for searched in search.layouts {
                let Answer::Solved { steps, actions, repeats } = searched.answer else {
                    panic!("nine cells can be solved: {searched:?}")
                };
                assert_eq!((steps, repeats), (distance(layout.draw(searched.seed)), REPEATS));
                assert!(actions.len() == steps && searched.states <= 8, "{} states", searched.states);
            }
            assert!(found.random.success > 0.8 && found.random.interval[1] <= 1.0);
        }
    }

    #[test]
    fn where_nothing_is_searched_nothing_is_shortest() {
        let none = Options { layouts: 0, ..Options::default() };
        let search = search::world(&mut Nine::new(false), Layout::Random, &none);
        assert!(!search.shortest && search.solved == 0 && search.layouts.is_empty());
    }

    #[test]
    fn on_ice_solutions_are_called_lucky() {
        let search = search::world(&mut Nine::new(true), Layout::Random, &Options::default());
        assert!(search.lucky && !search.shortest);
        let repeats = |found: &Searched| match found.answer {
            Answer::Solved { repeats, .. } => repeats,
            _ => 0,
        };
        assert!(search.layouts.iter().any(|found| (1..REPEATS).contains(&repeats(found))));
    }

    #[test]
    fn what_is_not_found_within_the_cap_is_not_called_unsolvable() {
        let options = |states| Options { states, ..Options::default() };
        let answers = |states, limit| {
            let mut nine = Nine::new(false);
            let card = Card { limit: Some(limit), ..nine.card() };
            let layouts = search::carded(&mut nine, Layout::Random, &card, &options(states)).layouts;
            layouts.into_iter().map(|found| found.answer).collect::<Vec<_>>()
        };
        assert!(answers(2, 50).contains(&Answer::Undecided));
        assert!(!answers(2, 50).contains(&Answer::Unsolvable));
        // One step reaches a goal beside the start only.
        assert!(answers(100, 1).contains(&Answer::Unsolvable));
    }

    #[test]
    fn a_certificate_is_json_and_the_same_every_time() {
        let options = Options { episodes: 100, layouts: 2, ..Options::default() };
        let found = || world(Nine::new(true), Layout::Fixed(42), &options);
        let json = serde_json::to_value(found()).expect("numbers and words");
        assert_eq!(json["layout"]["fixed"], 42);
        assert_eq!(json["search"]["layouts"][0]["answer"], "solved");
        assert_eq!(found(), found());
    }

    #[test]
    fn bodies_are_played_only() {
        let how = Options { episodes: 3, ..Options::default() };
        let found = crate::registry::certify("point-maze", &Default::default(), &how).unwrap();
        assert_eq!((found.name, found.random.episodes, found.search), ("point-maze", 3, None));
        assert!(crate::registry::certify("point-mze", &Default::default(), &how).is_err());
    }
}
