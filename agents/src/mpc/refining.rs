//! The cross-entropy method with warm start and correlated noise: the default planner.
//!
//! Sequences are drawn around a mean, the best of them make the next mean and spread (Rubinstein 1999), and what is left
//! of the plan is the mean from which the next step begins (as in MPPI, Williams 2017). The noise of a sequence is
//! correlated in time, for what moves a body is a push that lasts: uncorrelated pushes cancel (iCEM, Pinneri 2020, has
//! coloured noise; here it is a first-order process, as in Nagabandi 2019).

use inroads_envs::Rng;
use rand_distr::{Distribution, StandardNormal};
use serde::{Deserialize, Serialize};

use super::{Candidates, Planner, Problem, horizon_and_discount};
use crate::Memory;

/// Settings of the cross-entropy method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Refining {
    /// H: actions a sequence.
    pub horizon: usize,
    /// Sequences drawn in a round.
    pub candidates: usize,
    /// Rounds a plan.
    pub rounds: usize,
    /// The best of a round, which make the next mean and spread.
    pub elites: usize,
    /// Standard deviation of the first round's noise, in actions of [−1, 1].
    pub deviation: f32,
    /// How much of a step's noise is that of the step before, in [0, 1).
    pub smoothing: f32,
    /// γ.
    pub discount: f32,
}

impl Default for Refining {
    fn default() -> Self {
        Self {
            horizon: 15,
            candidates: 250,
            rounds: 3,
            elites: 25,
            deviation: 0.7,
            smoothing: 0.7,
            discount: 0.99,
        }
    }
}

impl Refining {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        let Self { candidates, elites, deviation, smoothing, .. } = *self;
        if self.rounds == 0 {
            return Err("refining.rounds is 0; a plan takes at least one".into());
        }
        if elites == 0 || elites > candidates {
            return Err(format!(
                "refining.elites is {elites}; it must lie in 1..={candidates}, the candidates"
            ));
        }
        if !(deviation.is_finite() && deviation > 0.0) {
            return Err(format!(
                "refining.deviation is {deviation}; without noise there is nothing to choose from"
            ));
        }
        if !(0.0..1.0).contains(&smoothing) {
            return Err(format!("refining.smoothing is {smoothing}; it must lie in [0, 1)"));
        }
        horizon_and_discount("refining", self.horizon, self.discount)
    }

    /// Draws sequences about a mean; the first is the mean itself.
    fn draw(&self, mean: &[f32], spread: &[f32], width: usize, rng: &mut Rng) -> Candidates {
        let mut drawn = Candidates::new(self.candidates, self.horizon, width);
        let mut noise = vec![0.0_f32; self.candidates * width];
        // As much of the step before, so that the deviation is 1 at every step.
        let (mut kept, mut fresh) = (0.0, 1.0);
        let times = drawn.numbers().chunks_exact_mut(self.candidates * width);
        for ((now, mean), spread) in times.zip(mean.chunks_exact(width)).zip(spread.chunks_exact(width)) {
            for (i, (action, noise)) in now.iter_mut().zip(&mut noise).enumerate() {
                let draw: f32 = StandardNormal.sample(rng);
                *noise = kept * *noise + fresh * draw;
                let (about, part) = (if i < width { 0.0 } else { *noise }, i % width);
                *action = (mean[part] + spread[part] * about).clamp(-1.0, 1.0);
            }
            (kept, fresh) = (self.smoothing, (1.0 - self.smoothing * self.smoothing).sqrt());
        }
        drawn
    }
}

/// Mean and standard deviation of some of the sequences, number by number.
fn moments(drawn: &Candidates, elites: &[usize]) -> (Vec<f32>, Vec<f32>) {
    let n = elites.len() as f32;
    let elites: Vec<_> = elites.iter().map(|&i| drawn.sequence(i)).collect();
    let about = |i: usize| {
        let mean = elites.iter().map(|sequence| sequence[i]).sum::<f32>() / n;
        let square = elites.iter().map(|sequence| (sequence[i] - mean).powi(2)).sum::<f32>() / n;
        (mean, square.sqrt())
    };
    (0..elites[0].len()).map(about).unzip()
}

impl Planner for Refining {
    fn plan(&self, problem: &Problem<'_>, memory: &mut Memory, rng: &mut Rng) -> Vec<f32> {
        let width = problem.model.actions();
        let length = self.horizon * width;
        let mut mean = match memory.len() == length {
            true => std::mem::take(memory),
            false => vec![0.0; length],
        };
        let mut spread = vec![self.deviation; length];
        for _ in 0..self.rounds {
            let drawn = self.draw(&mean, &spread, width, rng);
            let returns = drawn.returns(problem, self.discount);
            let mut order: Vec<usize> = (0..drawn.count()).collect();
            order.sort_by(|&a, &b| returns[b].total_cmp(&returns[a]));
            (mean, spread) = moments(&drawn, &order[..self.elites]);
        }
        // The next step's plan begins with what is left of this one; after its end nothing is known yet.
        memory.extend_from_slice(&mean[width..]);
        memory.resize(length, 0.0);
        mean
    }

    fn predictions(&self) -> usize {
        self.candidates * self.rounds * self.horizon
    }
}
