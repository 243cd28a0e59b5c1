//! Exploration noise on continuous actions.
//!
//! The thesis says Gaussian (3.1.1); the authors' code has an Ornstein–Uhlenbeck process. Both are here, and
//! both never fall to zero: the authors' floor of 0 ends all exploration after 100,000 steps (`decisions.md`).

use inroads_envs::Rng;
use rand_distr::{Distribution, StandardNormal};
use serde::{Deserialize, Serialize};

use crate::Memory;

/// Pull of the Ornstein–Uhlenbeck process to zero, per step (DDPG, Lillicrap 2015; the authors' code).
const THETA: f32 = 0.15;

/// How noise follows on noise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NoiseKind {
    /// Drawn anew at each step (thesis, chapter 3).
    #[default]
    Gaussian,
    /// Correlated from step to step: x ← (1−θ)x + σξ (DDPG, Lillicrap 2015; the authors' code).
    OrnsteinUhlenbeck,
}

/// Noise whose standard deviation falls linearly over a learner's updates.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct NoiseConfig {
    /// How noise follows on noise.
    pub kind: NoiseKind,
    /// Standard deviation at the first update, in actions of [−1, 1]. Ours: a third of the half-range, so
    /// that most noise is not clipped away; the authors' process begins at about this size too.
    pub start: f32,
    /// Standard deviation after all updates; above 0 (`decisions.md`). Fujimoto's DDPG has 0.1 throughout.
    pub end: f32,
    /// Updates over which it falls; the authors' global option has 100,000, their other options 50,000.
    pub decay_steps: u64,
}

impl Default for NoiseConfig {
    fn default() -> Self {
        Self { kind: NoiseKind::Gaussian, start: 0.3, end: 0.1, decay_steps: 100_000 }
    }
}

impl NoiseConfig {
    /// Standard deviation after so many updates.
    pub fn deviation(&self, updates: u64) -> f32 {
        let done = if self.decay_steps == 0 { 1.0 } else { updates as f64 / self.decay_steps as f64 };
        self.start + (self.end - self.start) * done.min(1.0) as f32
    }

    /// Adds noise to an action and clips it to [−1, 1]. `memory` is the process's state, of which an empty one
    /// begins anew.
    pub fn perturb(&self, action: &mut [f32], memory: &mut Memory, updates: u64, rng: &mut Rng) {
        let deviation = self.deviation(updates);
        if memory.len() != action.len() {
            memory.clear();
            memory.resize(action.len(), 0.0);
        }
        for (a, x) in action.iter_mut().zip(memory) {
            let draw: f32 = StandardNormal.sample(rng);
            *x = match self.kind {
                NoiseKind::Gaussian => draw,
                // σ is such that the stationary deviation is 1, and `deviation` means the same for both kinds.
                NoiseKind::OrnsteinUhlenbeck => (1.0 - THETA) * *x + (THETA * (2.0 - THETA)).sqrt() * draw,
            };
            *a = (*a + deviation * *x).clamp(-1.0, 1.0);
        }
    }

    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        for (name, value) in [("noise.start", self.start), ("noise.end", self.end)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(format!("{name} is {value}; noise must stay above 0, or exploration ends"));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use inroads_envs::Seed;

    #[test]
    fn the_deviation_falls_linearly_to_its_floor_and_stays_there() {
        let noise = NoiseConfig { start: 0.5, end: 0.1, decay_steps: 100, ..Default::default() };
        let at = |updates| noise.deviation(updates);
        assert_eq!((at(0), at(50)), (0.5, 0.3));
        assert!((at(100) - 0.1).abs() < 1e-7 && at(100) == at(1_000_000));
        assert_eq!(NoiseConfig { decay_steps: 0, ..noise }.deviation(0), at(100));
    }

    /// Deviation of the noise, and correlation from step to step.
    fn moments(kind: NoiseKind) -> (f64, f64) {
        let noise = NoiseConfig { kind, start: 0.1, end: 0.1, decay_steps: 0 };
        let (mut memory, mut rng) = (Memory::new(), Seed(1).stream("noise", 0));
        let draws: Vec<f64> = (0..40_000)
            .map(|_| {
                let mut action = [0.0];
                noise.perturb(&mut action, &mut memory, 0, &mut rng);
                f64::from(action[0])
            })
            .collect();
        let variance = draws.iter().map(|x| x * x).sum::<f64>() / draws.len() as f64;
        let lagged = draws.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / draws.len() as f64;
        (variance.sqrt(), lagged / variance)
    }

    #[test]
    fn both_kinds_have_the_same_deviation_and_one_remembers() {
        let (deviation, correlation) = moments(NoiseKind::Gaussian);
        assert!((deviation - 0.1).abs() < 0.002 && correlation.abs() < 0.02, "{deviation} {correlation}");
        let (deviation, correlation) = moments(NoiseKind::OrnsteinUhlenbeck);
        assert!((deviation - 0.1).abs() < 0.005, "{deviation}");
        assert!((correlation - 0.85).abs() < 0.02, "{correlation}");
    }

    #[test]
    fn actions_stay_in_range_and_noise_must_not_vanish() {
        let noise = NoiseConfig { start: 9.0, ..Default::default() };
        let mut action = [0.5; 64];
        noise.perturb(&mut action, &mut Memory::new(), 0, &mut Seed(0).stream("noise", 0));
        assert!(action.iter().all(|a| a.abs() <= 1.0));
        assert!(action.contains(&1.0) && action.contains(&-1.0));
        assert!(noise.check().is_ok());
        assert!(NoiseConfig { end: 0.0, ..noise }.check().unwrap_err().contains("noise.end"));
    }
}
