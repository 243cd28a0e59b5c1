//! R2D2's settings.

use serde::{Deserialize, Serialize};

use crate::{dqn::Epsilon, nets::TorsoConfig};

/// Settings of [`R2d2`](super::R2d2). Defaults are those of the authors' code for chapters 7 and 9 (`algorithms.md`, section
/// 0), but for the sizes of the networks, which are what a processor trains.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct R2d2Config {
    /// What makes features of what is seen.
    pub torso: TorsoConfig,
    /// Numbers that the cell remembers; 128 (authors: 512).
    pub memory: usize,
    /// Width of the hidden layer that reads what the cell puts out and the goal; 128 (authors: 512).
    pub head: usize,
    /// Adam's rate; 1e-4.
    pub rate: f32,
    /// ε that Adam adds to the root; 1e-3 (the paper).
    pub adam_epsilon: f32,
    /// γ; 0.997.
    pub discount: f32,
    /// Steps of returns, fewer at the end of a sequence; 5.
    pub returns: u32,
    /// Sequences an update; 32.
    pub batch: usize,
    /// Updates after which the target becomes what the network is; 1200.
    pub follow_every: u64,
    /// Greatest norm of the gradient, 0 for any; 40 (acme's R2D2).
    pub gradient_clip: f32,
    /// Share of the greatest error in a sequence's priority, beside that of the mean; 0.9 (the paper).
    pub greatest_share: f32,
    /// Whether values are rescaled by h(x) = sgn x (√(|x| + 1) − 1) + 10⁻³ x. The paper does; the authors do not, for with
    /// rewards of at most 1 it squeezes values below 0.42.
    pub rescale: bool,
    /// Share of random choices while exploring.
    pub epsilon: Epsilon,
    /// Rungs of Ape-X's [`ladder`](super::ladder), of which each episode has one in the place of `epsilon.end`; 0 for none.
    pub rungs: u32,
}

impl Default for R2d2Config {
    fn default() -> Self {
        Self {
            torso: TorsoConfig::default(),
            memory: 128,
            head: 128,
            rate: 1e-4,
            adam_epsilon: 1e-3,
            discount: 0.997,
            returns: 5,
            batch: 32,
            follow_every: 1200,
            gradient_clip: 40.0,
            greatest_share: 0.9,
            rescale: false,
            epsilon: Epsilon::default(),
            rungs: 0,
        }
    }
}

impl R2d2Config {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the mend.
    pub fn check(&self) -> Result<(), String> {
        let counts = [
            ("memory", self.memory as u64),
            ("head", self.head as u64),
            ("returns", u64::from(self.returns)),
            ("batch", self.batch as u64),
            ("follow_every", self.follow_every),
        ];
        if let Some((name, _)) = counts.iter().find(|(_, value)| *value == 0) {
            return Err(format!("{name} is 0; it must be at least 1"));
        }
        for (name, value) in [("rate", self.rate), ("adam_epsilon", self.adam_epsilon)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(format!("{name} is {value}; it must be a number above 0"));
            }
        }
        for (name, value) in [("discount", self.discount), ("greatest_share", self.greatest_share)] {
            if !(0.0..=1.0).contains(&value) {
                return Err(format!("{name} is {value}; it must lie in [0, 1]"));
            }
        }
        if !(self.gradient_clip.is_finite() && self.gradient_clip >= 0.0) {
            return Err(format!("gradient_clip is {}; it must be 0 (none) or above", self.gradient_clip));
        }
        self.torso.check().map_err(|why| format!("torso: {why}"))?;
        self.epsilon.check().map_err(|why| format!("epsilon: {why}"))
    }
}
