//! What planning needs of a model, and of what there is to gain.

use inroads_envs::{Goal, Pay};
use serde::{Deserialize, Serialize};

/// Foresees what actions lead to: a learned model, or an exact one.
pub trait Predict {
    /// Numbers an action, each in [−1, 1].
    fn actions(&self) -> usize;

    /// The states that follow on these states when these actions are taken, row by row.
    fn next(&self, states: &[f32], actions: &[f32]) -> Vec<f32>;
}

/// What predicted states are worth.
pub trait Objective {
    /// R(s, g) of each row, of which there are as many as `out` has elements.
    fn rewards(&self, states: &[f32], out: &mut [f32]);

    /// V(s | g) of each row: what may be had beyond the horizon (equation 4.1). None: nothing is counted there
    /// (equation 6.6).
    fn values(&self, _states: &[f32]) -> Option<Vec<f32>> {
        None
    }
}

/// What a predicted state pays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Reward {
    /// Minus the distance to the goal, metres; nothing at the goal.
    #[default]
    Dense,
    /// −1 a step that does not end at the goal. Beyond the horizon a plan is blind to it, unless values are given.
    Sparse,
}

/// V(s | g) of each row of states.
pub type Values<'a> = &'a dyn Fn(&[f32]) -> Vec<f32>;

/// The objective of getting to a goal.
#[derive(Clone, Copy)]
pub struct Reach<'a> {
    /// Where to.
    pub goal: &'a Goal,
    /// What a state pays on the way.
    pub reward: Reward,
    /// V(s | g) where the horizon ends, if somebody has learned it.
    pub values: Option<Values<'a>>,
}

impl Objective for Reach<'_> {
    fn rewards(&self, states: &[f32], out: &mut [f32]) {
        let pay = match self.reward {
            Reward::Dense => Pay::Dense { price: 1.0 },
            Reward::Sparse => Pay::Sparse,
        };
        let width = states.len() / out.len().max(1);
        for (paid, s) in out.iter_mut().zip(states.chunks_exact(width.max(1))) {
            *paid = pay.step(self.goal.distance(s), self.goal.tolerance).reward;
        }
    }

    /// A state at the goal gets the greatest value of all (authors): nothing need be done from there, and a critic that
    /// was never asked beyond the goal would say anything.
    fn values(&self, states: &[f32]) -> Option<Vec<f32>> {
        let mut values = self.values?(states);
        let width = states.len() / values.len().max(1);
        let best = values.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        for (value, s) in values.iter_mut().zip(states.chunks_exact(width.max(1))) {
            if self.goal.reached(s) {
                *value = best;
            }
        }
        Some(values)
    }
}
