//! The shortest solution of a world, by breadth-first search.

use std::{
    collections::HashSet,
    hash::{DefaultHasher, Hash, Hasher},
};

use serde::Serialize;

use super::Options;
use crate::{
    End, Seed, Step, check,
    world::{Card, Draw, Grain, Layout, World},
};

/// What searching some layouts of a world has found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Search {
    /// States after which the search of a layout gave up.
    pub cap: usize,
    /// Whether something was seen to happen by chance. The search then knows what chance will bring, and of states that
    /// differ in this only, it follows one: its solutions are lucky ones, and neither the shortest for sure nor a plan.
    pub lucky: bool,
    /// Whether solutions are shortest ones: something was searched, nothing happens by chance, and states are told apart exactly.
    pub shortest: bool,
    /// Layouts that were solved.
    pub solved: usize,
    /// What was found of each layout.
    pub layouts: Vec<Searched>,
}

/// What searching one layout has found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Searched {
    /// The seed of the episode.
    pub seed: u64,
    /// States that were seen.
    pub states: usize,
    /// What there is to say.
    #[serde(flatten)]
    pub answer: Answer,
}

/// Whether a layout can be solved.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "answer", rename_all = "snake_case")]
pub enum Answer {
    /// It can.
    Solved {
        /// Steps that it takes.
        steps: usize,
        /// The choices.
        actions: Vec<usize>,
        /// How often the same choices succeed when chance has other numbers, of [`REPEATS`].
        repeats: u32,
    },
    /// It cannot: every state that can be reached within the time limit was seen.
    Unsolvable,
    /// Nobody knows: none of the states that were seen solves it, and there are more, or states that were not told apart.
    Undecided,
}

/// How often a solution is tried with other numbers of chance.
pub const REPEATS: u32 = 100;

/// Episodes, and steps of each, in which chance is looked for.
const LOOKS: (u64, u32) = (16, 1000);

/// Searches the layouts of a world.
pub(super) fn world<W: World>(world: &mut W, layout: Layout, options: &Options) -> Search {
    let card = world.card();
    carded(world, layout, &card, options)
}

/// The same with another card.
pub(super) fn carded<W: World>(world: &mut W, layout: Layout, card: &Card, options: &Options) -> Search {
    let count = if matches!(layout, Layout::Fixed(_)) { 1 } else { options.layouts };
    let seeds = (0..count).map(|index| options.seed.wrapping_add(index));
    let mut layouts = Vec::new();
    let (mut lucky, mut exact) = (false, true);
    for seed in seeds {
        let draw = layout.draw(seed);
        lucky |= chance(world, card, draw);
        let (found, grain) = search(world, card, draw, options.states);
        exact &= grain == Grain::Exact;
        if let Answer::Solved { repeats, .. } = found.1 {
            lucky |= repeats < REPEATS;
        }
        layouts.push(Searched { seed, states: found.0, answer: found.1 });
    }
    let shortest = exact && !lucky && !layouts.is_empty();
    for searched in layouts.iter_mut().filter(|_| !shortest) {
        if searched.answer == Answer::Unsolvable {
            searched.answer = Answer::Undecided;
        }
    }
    let solved = layouts.iter().filter(|found| matches!(found.answer, Answer::Solved { .. })).count();
    Search { cap: options.states, lucky, shortest, solved, layouts }
}

/// Whether the same choices lead elsewhere when chance has other numbers, as far as random choices show.
fn chance<W: World>(world: &mut W, card: &Card, draw: Draw) -> bool {
    let (mut one, mut other) = (Vec::new(), Vec::new());
    (0..LOOKS.0).any(|look| {
        let mut twin = world.clone();
        world.begin(draw);
        twin.begin(draw.with_play(look));
        let mut rng = Seed(look).stream("look for chance", 0);
        for _ in 0..LOOKS.1.min(card.limit.unwrap_or(u32::MAX)) {
            let choice = check::Drawn::legal(&crate::Space::Discrete(card.actions.len()), &mut rng);
            let (a, b) = (world.act(choice), twin.act(choice));
            world.symbols(&mut one);
            twin.symbols(&mut other);
            if (a, &one) != (b, &other) {
                return true;
            }
            if a.end.is_some() {
                return false;
            }
        }
        false
    })
}

/// How a state was reached: from which one, by what.
struct Reached {
    from: usize,
    choice: usize,
}

/// States seen, and whether the goal is among what they lead to.
fn search<W: World>(world: &mut W, card: &Card, draw: Draw, cap: usize) -> ((usize, Answer), Grain) {
    let mut marks = Marks::default();
    world.begin(draw);
    marks.put(world);
    // A state is kept while its level is expanded; how it was reached, for good.
    let mut reached = vec![Reached { from: 0, choice: 0 }];
    let mut level = vec![(world.save(), 0)];
    let mut answer = Answer::Unsolvable;
    'levels: for _ in 0..card.limit.unwrap_or(u32::MAX) {
        for (state, from) in std::mem::take(&mut level) {
            for choice in 0..card.actions.len() {
                world.load(&state);
                let step = world.act(choice);
                if succeeded(card, &step) {
                    let actions = back(&reached, from, choice);
                    let repeats = repeats(world, card, draw, &actions);
                    answer = Answer::Solved { steps: actions.len(), actions, repeats };
                    break 'levels;
                }
                if step.end.is_some() || !marks.put(world) {
                    continue;
                }
                if marks.seen.len() > cap {
                    answer = Answer::Undecided;
                    break 'levels;
                }
                level.push((world.save(), reached.len()));
                reached.push(Reached { from, choice });
            }
        }
        if level.is_empty() {
            break;
        }
    }
    ((marks.seen.len(), answer), marks.grain)
}

fn succeeded(card: &Card, step: &Step) -> bool {
    step.end == Some(End::Terminated) && step.reward >= card.success_reward
}

/// The choices that led to a state, and one more.
fn back(reached: &[Reached], mut at: usize, last: usize) -> Vec<usize> {
    let mut actions = vec![last];
    while at != 0 {
        actions.push(reached[at].choice);
        at = reached[at].from;
    }
    actions.reverse();
    actions
}

/// How often choices succeed when chance has other numbers.
fn repeats<W: World>(world: &mut W, card: &Card, draw: Draw, actions: &[usize]) -> u32 {
    let mut succeeds = |play: u64| {
        world.begin(draw.with_play(play));
        let steps = actions.iter().map(|&choice| world.act(choice));
        let last = { steps }.find(|step| step.end.is_some());
        last.is_some_and(|last| succeeded(card, &last))
    };
    (0..u64::from(REPEATS)).filter(|&play| succeeds(play)).count() as u32
}

/// States that were seen, by what tells them apart.
struct Marks {
    /// 128 bits of each: that two of a billion states have the same ones is less likely than a broken memory.
    seen: HashSet<[u64; 2]>,
    numbers: Vec<f32>,
    grain: Grain,
}

impl Default for Marks {
    fn default() -> Self {
        Self { seen: HashSet::new(), numbers: Vec::new(), grain: Grain::Exact }
    }
}

impl Marks {
    /// Takes down the state that the world is in; whether it was not seen before.
    fn put<W: World>(&mut self, world: &W) -> bool {
        self.grain = world.landmark(&mut self.numbers);
        let half = |salt: u64| {
            let mut hasher = DefaultHasher::new();
            salt.hash(&mut hasher);
            // Adding nothing makes -0 into 0.
            self.numbers.iter().for_each(|x| (x + 0.0).to_bits().hash(&mut hasher));
            hasher.finish()
        };
        self.seen.insert([half(0), half(1)])
    }
}
