//! Settings of proto-goal agents.

use serde::{Deserialize, Serialize};

use super::Relabel;

/// Settings of [`ProtoGoalAgent`](super::ProtoGoalAgent). What the thesis gives is named; the rest is ours.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ProtoConfig {
    /// Steps of the environment between two evaluations of the goal space. The thesis has about ten a minute; a clock
    /// would make runs differ (`decisions.md`).
    pub evaluate_every: u64,
    /// K: goals drawn by desirability, with replacement, whenever one is to be pursued (thesis: 100).
    pub draws: usize,
    /// Strata of timescales (thesis: quintiles).
    pub strata: usize,
    /// M: goals drawn by novelty within a stratum, of which the nearest is pursued.
    pub nearest_of: usize,
    /// Steps after which a goal is given up, and after which the task's turn is over.
    pub horizon: u32,
    /// Share of decisions for the task's reward instead of a goal (thesis: 0.1 was best on Baba).
    pub task_share: f32,
    /// M_her: attained goals that are learned in hindsight, a call (thesis: 15).
    pub hindsight: usize,
    /// Which of them.
    pub relabel: Relabel,
    /// κ: the share of pursuits that must attain a goal for it to be mastered (thesis: 0.6).
    pub mastery: f32,
    /// The latest pursuits of which that share is taken; with fewer nothing is mastered.
    pub window: usize,
    /// Proto-goals that a combination may have; 1: nothing is combined.
    pub max_bits: usize,
    /// Goals at most, combinations and proto-goals.
    pub max_goals: usize,
}

impl Default for ProtoConfig {
    fn default() -> Self {
        Self {
            evaluate_every: 1000,
            draws: 100,
            strata: 5,
            nearest_of: 10,
            horizon: 30,
            task_share: 0.1,
            hindsight: 15,
            relabel: Relabel::Novel,
            mastery: 0.6,
            window: 10,
            max_bits: 2,
            max_goals: 20_000,
        }
    }
}

impl ProtoConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        let counts = [
            ("evaluate_every", self.evaluate_every as usize),
            ("draws", self.draws),
            ("strata", self.strata),
            ("nearest_of", self.nearest_of),
            ("horizon", self.horizon as usize),
            ("window", self.window),
            ("max_bits", self.max_bits),
        ];
        for (name, value) in counts {
            if value == 0 {
                return Err(format!("{name} is 0; it must be at least 1"));
            }
        }
        for (name, value) in [("task_share", self.task_share), ("mastery", self.mastery)] {
            if !(0.0..=1.0).contains(&value) {
                return Err(format!("{name} is {value}; it must lie in [0, 1]"));
            }
        }
        Ok(())
    }
}
