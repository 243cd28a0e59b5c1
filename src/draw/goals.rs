//! What goals are called, and how a goal space grew.

use std::collections::BTreeMap;

use inroads_discovery::record::GoalState;
use inroads_envs::{registry, world::Question};

use crate::{
    config::Settings,
    figures::{self, GoalPanel, GoalSquare},
    run::{Growth, Run, RunError},
};

/// Panels at most.
const PANELS: usize = 6;
/// Squares above which only goals that were observed are drawn.
const SQUARES: usize = 150;

/// What the proto-goals of a run's environment ask; nothing for an environment of somebody's own.
pub struct Questions(Vec<Question>);

impl Questions {
    /// Those of an environment.
    pub fn of(settings: &Settings) -> Self {
        Self(registry::questions(&settings.environment).unwrap_or_default())
    }

    /// What a goal asks for: all of its proto-goals at once.
    pub fn name(&self, bits: &[u32]) -> String {
        let names: Vec<_> = bits
            .iter()
            .map(|bit| match self.0.get(*bit as usize) {
                Some(question) => question.text.clone(),
                None => format!("proto-goal {bit}"),
            })
            .collect();
        names.join(" and ")
    }

    fn square(&self, bits: &[u32]) -> GoalSquare {
        let name = self.name(bits);
        let cell = match bits {
            [bit] => self.0.get(*bit as usize).and_then(|question| question.cell),
            _ => return GoalSquare { group: "together".to_owned(), label: name, cell: None },
        };
        let (group, label) = match cell {
            // What is asked of a cell, without its numbers.
            Some(_) => (name.trim_end_matches(|c: char| c.is_ascii_digit() || " (),".contains(c)), ""),
            None => name.rsplit_once(' ').unwrap_or(("", &name)),
        };
        GoalSquare { group: group.to_owned(), label: label.to_owned(), cell }
    }
}

/// Draws how a run's goal space grew; nothing when it has none.
pub(super) fn growth(run: &Run) -> Result<(), RunError> {
    let goals = run.session.goals();
    if goals.is_empty() {
        return Ok(());
    }
    let (episodes, _) = run.session.progress();
    let mut drawn: Vec<Vec<u32>> = goals.iter().map(|goal| goal.bits.clone()).collect();
    let times = chosen(run.folder.read_goals()?, Growth::of(episodes, goals));
    let states: Vec<BTreeMap<&[u32], GoalState>> = times
        .iter()
        .map(|time| time.goals.iter().map(|(bits, state)| (bits.as_slice(), *state)).collect())
        .collect();
    if drawn.len() > SQUARES {
        drawn.retain(|bits| states.iter().any(|states| states.contains_key(bits.as_slice())));
    }
    if drawn.is_empty() {
        // Of many goals none was observed yet.
        return Ok(());
    }
    let questions = Questions::of(&run.config.settings);
    let squares: Vec<_> = drawn.iter().map(|bits| questions.square(bits)).collect();
    let panel = |(time, states): (&Growth, &BTreeMap<&[u32], GoalState>)| GoalPanel {
        title: match time.episodes {
            1 => "1 episode".to_owned(),
            episodes => format!("{episodes} episodes"),
        },
        states: drawn
            .iter()
            .map(|bits| states.get(bits.as_slice()).copied().unwrap_or(GoalState::Unseen))
            .collect(),
    };
    let panels: Vec<_> = times.iter().zip(&states).map(panel).collect();
    Ok(figures::goal_space(run.folder.figures().join("goal-space.png"), &squares, &panels)?)
}

/// The times to draw: evenly among those at which something had changed, the present last.
fn chosen(mut times: Vec<Growth>, now: Growth) -> Vec<Growth> {
    times.retain(|time| time.episodes < now.episodes);
    times.dedup_by(|later, earlier| later.goals == earlier.goals);
    if times.last().is_some_and(|time| time.goals == now.goals) {
        times.pop();
    }
    let places = PANELS - 1;
    let kept = times.len().min(places);
    let mut chosen: Vec<_> =
        (0..kept).map(|nth| times[nth * (times.len() - 1) / (kept - 1).max(1)].clone()).collect();
    chosen.push(now);
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settings(environment: &str) -> Settings {
        crate::config::Config::defaults("q-learning", environment).unwrap().settings
    }

    #[test]
    fn squares_stand_in_groups_and_cells() {
        let taxi = Questions::of(&settings("sparse-taxi"));
        assert_eq!(taxi.name(&[7, 29]), "taxi at 1,2 and passenger in taxi");
        let square =
            |group: &str, label: &str, cell| GoalSquare { group: group.into(), label: label.into(), cell };
        assert_eq!(taxi.square(&[7]), square("taxi at", "", Some([2, 1])));
        assert_eq!(taxi.square(&[30]), square("destination", "red", None));
        assert_eq!(taxi.square(&[0, 29]), square("together", "taxi at 0,0 and passenger in taxi", None));
        let lamps = Questions::of(&settings("distractor-grid"));
        assert_eq!(lamps.square(&[16]), square("green", "", Some([0, 0])));
        let none = Questions::of(&settings("corridor-5"));
        assert_eq!(none.square(&[3]), square("proto-goal", "3", None));
    }

    #[test]
    fn few_times_of_change_and_the_present_are_drawn() {
        let at = |episodes, goal: u32| Growth { episodes, goals: vec![(vec![goal], GoalState::Pruned)] };
        let drawn = |times: Vec<Growth>, now| -> Vec<u64> {
            chosen(times, now).into_iter().map(|time| time.episodes).collect()
        };
        assert_eq!(drawn(vec![], at(5, 0)), [5]);
        assert_eq!(drawn(vec![at(1, 0), at(2, 0), at(3, 1)], at(3, 1)), [1, 3]);
        assert_eq!(drawn(vec![at(1, 0), at(2, 1)], at(3, 1)), [1, 3], "the present says it already");
        let many: Vec<_> = (1..=9).map(|n| at(n, n as u32)).collect();
        assert_eq!(drawn(many, at(10, 10)), [1, 3, 5, 7, 9, 10]);
    }
}
