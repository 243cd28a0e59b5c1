//! Novelty: how seldom a state was seen (thesis 7.2.2.1).

mod counts;
mod features;

pub use counts::Counts;
pub use features::{FeatureCounts, FeatureCountsConfig};

use crate::{
    Checkpoint, Context,
    experience::{Moment, Seen},
};

/// Says how new states are, in (0, 1]: 1/√N where N is a count or what stands for one, a pseudocount.
pub trait Novelty<O>: Checkpoint {
    /// r_novelty(s); 1 for what was never seen.
    fn bonus(&self, s: &O) -> f32;

    /// The same of many states.
    fn bonuses(&self, states: &[&O]) -> Vec<f32> {
        states.iter().map(|s| self.bonus(s)).collect()
    }

    /// A state was visited: what is newest in the experience. Who learns from visits keeps moments, not states.
    fn visit(&mut self, at: Moment, all: &dyn Seen<O>, ctx: &mut Context);
}
