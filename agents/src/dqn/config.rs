//! Settings of the DQN family.

use serde::{Deserialize, Serialize};

use super::{AtomsConfig, Loss};
use crate::nets::TorsoConfig;

/// Settings of [`Dqn`](super::Dqn). Defaults are double and dueling DQN with Rainbow's numbers (Hessel 2018, table 1)
/// but for what a setting says. For Rainbow: `noise` 0.5, `epsilon` 0, `atoms.number` 51, returns of three steps and
/// priorities from the replay.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct DqnConfig {
    /// What makes features of what is seen.
    pub torso: TorsoConfig,
    /// Width of the hidden layer that reads features and goal; 128 (the thesis authors' DQN ends so; Rainbow: 512).
    pub head: usize,
    /// Adam's rate; 1e-4 (the thesis authors on grids; Rainbow 6.25e-5).
    pub rate: f32,
    /// ε that Adam adds to the root; 1.5e-4 (Rainbow).
    pub adam_epsilon: f32,
    /// γ; 0.99 (Rainbow).
    pub discount: f32,
    /// Updates between two steps of the target network; 2000 (Rainbow: 8,000 steps with an update every 4).
    pub follow_every: u64,
    /// τ of θ' ← τθ + (1−τ)θ' at each such step; 1 copies (Rainbow). Below 1 with `follow_every` 1 the target follows
    /// softly.
    pub tau: f32,
    /// Clips an update; 32 (Rainbow).
    pub batch: usize,
    /// Loss of an error; Huber's (Mnih 2015). Distributions have the cross entropy instead.
    pub loss: Loss,
    /// Greatest norm of the gradient; 0 is no bound. 10 (dueling networks, Wang 2016, section 4.2).
    pub gradient_clip: f32,
    /// Share of random choices while exploring.
    pub epsilon: Epsilon,
    /// Whether the online network chooses the next action, whose value is the target's (van Hasselt 2016).
    pub double: bool,
    /// Whether values are a state's and advantages (Wang 2016).
    pub dueling: bool,
    /// σ₀ of noisy layers in the head (Fortunato 2018; Rainbow 0.5); 0 for none.
    pub noise: f32,
    /// Distributions of return (Bellemare 2017).
    pub atoms: AtomsConfig,
}

impl Default for DqnConfig {
    fn default() -> Self {
        Self {
            torso: TorsoConfig::default(),
            head: 128,
            rate: 1e-4,
            adam_epsilon: 1.5e-4,
            discount: 0.99,
            follow_every: 2000,
            tau: 1.0,
            batch: 32,
            loss: Loss::Huber,
            gradient_clip: 10.0,
            epsilon: Epsilon::default(),
            double: true,
            dueling: true,
            noise: 0.0,
            atoms: AtomsConfig::default(),
        }
    }
}

impl DqnConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        self.torso.check().map_err(|why| format!("torso: {why}"))?;
        let counts =
            [("head", self.head as u64), ("batch", self.batch as u64), ("follow_every", self.follow_every)];
        for (name, value) in counts {
            if value == 0 {
                return Err(format!("{name} is 0; it must be at least 1"));
            }
        }
        for (name, value) in [("rate", self.rate), ("adam_epsilon", self.adam_epsilon)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(format!("{name} is {value}; it must be a number above 0"));
            }
        }
        for (name, value) in [("discount", self.discount), ("tau", self.tau)] {
            if !(0.0..=1.0).contains(&value) {
                return Err(format!("{name} is {value}; it must lie in [0, 1]"));
            }
        }
        for (name, value) in [("gradient_clip", self.gradient_clip), ("noise", self.noise)] {
            if !(value.is_finite() && value >= 0.0) {
                return Err(format!("{name} is {value}; it must be 0 (none) or a number above"));
            }
        }
        self.epsilon.check().map_err(|why| format!("epsilon: {why}"))?;
        self.atoms.check().map_err(|why| format!("atoms: {why}"))
    }
}

/// Share of random choices, linear over a learner's updates from `start` to the floor `end`.
///
/// It counts updates, not steps: while nothing has been learned yet, in the warm-up, it stays at `start`, and with an
/// update every few steps it falls over as many times the steps.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Epsilon {
    /// Share before the first update; 1 (Mnih 2015).
    pub start: f32,
    /// Share after `updates`; 0.05 (cleanrl's dqn.py; Mnih 2015 has 0.1).
    pub end: f32,
    /// Updates from the one to the other; 5,000 (the thesis authors on grids: 12,500 to 25,000 steps, 4 steps an update).
    pub updates: u64,
}

impl Default for Epsilon {
    fn default() -> Self {
        Self { start: 1.0, end: 0.05, updates: 5000 }
    }
}

impl Epsilon {
    /// The share after so many updates.
    pub fn at(&self, updates: u64) -> f32 {
        let done = updates as f64 / self.updates.max(1) as f64;
        self.start + (self.end - self.start) * done.min(1.0) as f32
    }

    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        for (name, share) in [("start", self.start), ("end", self.end)] {
            if !(0.0..=1.0).contains(&share) {
                return Err(format!("{name} is {share}; a share of random choices lies in [0, 1]"));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn epsilon_falls_to_its_floor_and_stays_there() {
        let epsilon = Epsilon { start: 1.0, end: 0.25, updates: 100 };
        assert_eq!([0, 50, 100, 1000].map(|updates| epsilon.at(updates)), [1.0, 0.625, 0.25, 0.25]);
    }

    #[test]
    fn settings_that_make_no_learner_are_named() {
        assert_eq!(DqnConfig::default().check(), Ok(()));
        let wrong = |config: DqnConfig| config.check().unwrap_err();
        assert!(wrong(DqnConfig { follow_every: 0, ..Default::default() }).contains("follow_every"));
        assert!(wrong(DqnConfig { rate: f32::NAN, ..Default::default() }).contains("rate"));
        assert!(wrong(DqnConfig { noise: -1.0, ..Default::default() }).contains("noise"));
        let epsilon = Epsilon { end: 1.5, ..Epsilon::default() };
        assert!(wrong(DqnConfig { epsilon, ..Default::default() }).contains("epsilon: end"));
        let atoms = AtomsConfig { number: 1, ..AtomsConfig::default() };
        assert!(wrong(DqnConfig { atoms, ..Default::default() }).contains("atoms: number"));
    }
}
