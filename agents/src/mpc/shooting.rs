//! Random shooting: the best of many sequences of uniform actions (Nagabandi 2018; the authors of chapters 4 and 6).

use inroads_envs::Rng;
use rand::RngExt;
use serde::{Deserialize, Serialize};

use super::{Candidates, Planner, Problem, horizon_and_discount};
use crate::{Memory, draw::argmax};

/// Settings of random shooting.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Shooting {
    /// H: actions a sequence (authors: 7).
    pub horizon: usize,
    /// Sequences (authors: 14,000).
    pub candidates: usize,
    /// γ (authors: 0.95).
    pub discount: f32,
}

impl Default for Shooting {
    fn default() -> Self {
        Self { horizon: 7, candidates: 14_000, discount: 0.95 }
    }
}

impl Shooting {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        if self.candidates == 0 {
            return Err("shooting.candidates is 0; at least one sequence must be drawn".into());
        }
        horizon_and_discount("shooting", self.horizon, self.discount)
    }
}

impl Planner for Shooting {
    fn plan(&self, problem: &Problem<'_>, _: &mut Memory, rng: &mut Rng) -> Vec<f32> {
        let mut candidates = Candidates::new(self.candidates, self.horizon, problem.model.actions());
        candidates.numbers().fill_with(|| rng.random_range(-1.0..=1.0));
        let returns = candidates.returns(problem, self.discount);
        candidates.sequence(argmax(&returns, rng))
    }

    fn predictions(&self) -> usize {
        self.candidates * self.horizon
    }
}
