//! The time before a skill exists: its subgoal is triggered until there is enough to learn a set from.

use std::ops::Range;

use inroads_agents::Experience;
use serde::{Deserialize, Serialize};

use super::skill::Moment;
use crate::Subgoal;

/// Trajectories that triggered a subgoal for which a skill may be created.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Gestation {
    pub(crate) subgoal: Subgoal,
    /// Episode and steps of each trajectory; the last step is the one that triggered.
    pub(crate) triggers: Vec<(u64, Range<u32>)>,
}

impl Gestation {
    pub(crate) fn new(subgoal: Subgoal) -> Self {
        Self { subgoal, triggers: Vec::new() }
    }

    /// Where the last `segment` states of each trajectory are, the triggering one included (3.1.3). Forgotten episodes
    /// tell nothing.
    pub(crate) fn positives<O, A>(&self, segment: u32, all: &Experience<O, A>) -> Vec<Moment> {
        let remembered = self.triggers.iter().filter(|(number, _)| all.episode(*number).is_some());
        remembered
            .flat_map(|(number, steps)| {
                let from = (steps.end + 1).saturating_sub(segment).max(steps.start);
                (from..=steps.end).map(|i| (*number, i))
            })
            .collect()
    }

    /// Where the triggering actions were taken (3.1.2).
    pub(crate) fn before(&self) -> Vec<Moment> {
        self.triggers.iter().map(|(number, steps)| (*number, steps.end - 1)).collect()
    }

    /// Where the subgoal was entered.
    pub(crate) fn entered(&self) -> Vec<Moment> {
        self.triggers.iter().map(|(number, steps)| (*number, steps.end)).collect()
    }
}
