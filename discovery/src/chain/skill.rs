//! What is kept of a skill beside its initiation set and its policy.

use serde::{Deserialize, Serialize};

use crate::Subgoal;

/// How far a skill's initiation set is learned (3.1.3).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Phase {
    /// Its initiation period: executions still change the set.
    Refining,
    /// The set is fixed, and a salient event that another skill may aim at.
    Fixed,
}

/// One skill's row.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Skill {
    /// Where it ends.
    pub subgoal: Subgoal,
    /// How far its set is learned.
    pub phase: Phase,
    /// The training episode in which it was created.
    pub born: u64,
    /// Times it was executed.
    pub executions: u64,
    /// Times it reached its subgoal.
    pub successes: u64,
    /// Training episodes in which it was executed, while refining.
    pub episodes: u32,
    /// The last of them.
    pub last_episode: Option<u64>,
    /// Effect set: where its newest successful executions ended, as (episode, step).
    pub effects: Vec<(u64, u32)>,
}

/// Effects that are remembered: the authors keep the last 20.
const EFFECTS: usize = 20;

impl Skill {
    pub(super) fn new(subgoal: Subgoal, phase: Phase, born: u64) -> Self {
        Self {
            subgoal,
            phase,
            born,
            executions: 0,
            successes: 0,
            episodes: 0,
            last_episode: None,
            effects: Vec::new(),
        }
    }

    /// Counts one execution that ended at `step` of `episode`.
    pub(super) fn executed(&mut self, episode: u64, step: u32, success: bool) {
        self.executions += 1;
        if self.last_episode != Some(episode) {
            self.last_episode = Some(episode);
            self.episodes += 1;
        }
        if success {
            self.successes += 1;
            if self.effects.len() == EFFECTS {
                self.effects.remove(0);
            }
            self.effects.push((episode, step));
        }
    }
}
