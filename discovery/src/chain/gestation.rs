//! The time before a skill exists: its subgoal is triggered until there is enough to learn a set from.

use inroads_agents::Experience;
use serde::{Deserialize, Serialize};

use crate::Subgoal;

/// Trajectories that triggered a subgoal for which a skill may be created.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Gestation {
    pub(super) subgoal: Subgoal,
    /// Episode and step of each trigger.
    pub(super) triggers: Vec<(u64, u32)>,
}

impl Gestation {
    pub(super) fn new(subgoal: Subgoal) -> Self {
        Self { subgoal, triggers: Vec::new() }
    }

    /// The last `segment` states of each trajectory, the triggering one included (3.1.3), and the states in
    /// which the triggering actions were taken (3.1.2). Forgotten episodes tell nothing.
    pub(super) fn states<O: Clone, A>(&self, segment: u32, all: &Experience<O, A>) -> (Vec<O>, Vec<O>) {
        let (mut last, mut before) = (Vec::new(), Vec::new());
        for &(number, step) in &self.triggers {
            let Some(episode) = all.episode(number) else { continue };
            let end = step as usize + 1;
            let start = (end + 1).saturating_sub(segment as usize);
            last.extend_from_slice(&episode.observations[start..=end]);
            before.push(episode.observations[step as usize].clone());
        }
        (last, before)
    }
}
