//! How a goal space grows in training: a line of `goals.jsonl` now and then.

use inroads_discovery::record::{GoalRecord, GoalState};
use serde::{Deserialize, Serialize};

/// A goal space after so many episodes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Growth {
    /// Episodes trained.
    pub episodes: u64,
    /// Every goal that was ever observed: its proto-goals, and what had become of it.
    pub goals: Vec<(Vec<u32>, GoalState)>,
}

impl Growth {
    /// Whether a line is written after so many episodes: 1, 2, … 9, 10, 20, … 90, 100, 200 and so on. So the early growth
    /// is told closely, the file stays short, and its lines do not depend on how long the run will be.
    pub(super) fn due(episodes: u64) -> bool {
        let power = episodes.checked_ilog10().map_or(1, |digits| 10u64.pow(digits));
        episodes > 0 && episodes.is_multiple_of(power)
    }

    /// What the records tell.
    pub(crate) fn of(episodes: u64, goals: Vec<GoalRecord>) -> Self {
        let seen = goals.into_iter().filter(|goal| goal.state > GoalState::Unseen);
        Self { episodes, goals: seen.map(|goal| (goal.bits, goal.state)).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_due_at_numbers_with_one_digit_and_noughts() {
        let due: Vec<_> = (0..=1000).filter(|episodes| Growth::due(*episodes)).collect();
        let one = [1, 2, 3, 4, 5, 6, 7, 8, 9];
        let wanted = [one.as_slice(), &one.map(|n| 10 * n), &one.map(|n| 100 * n), &[1000]].concat();
        assert_eq!(due, wanted);
    }

    #[test]
    fn goals_that_were_never_observed_are_left_out() {
        let goal = |bit, state| GoalRecord { bits: vec![bit], state, attained: 0, pursued: 0, success: 0.0 };
        let growth = Growth::of(7, vec![goal(0, GoalState::Unseen), goal(1, GoalState::Pruned)]);
        assert_eq!(growth, Growth { episodes: 7, goals: vec![(vec![1], GoalState::Pruned)] });
        assert_eq!(serde_json::to_string(&growth).unwrap(), r#"{"episodes":7,"goals":[[[1],"pruned"]]}"#);
    }
}
