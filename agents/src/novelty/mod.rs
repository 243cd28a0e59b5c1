//! Novelty: how seldom a state was seen (thesis 7.2.2.1).

mod counts;
mod features;

pub use counts::Counts;
pub use features::{FeatureCounts, FeatureCountsConfig};

use crate::{Checkpoint, Context};

/// Says how new states are, in (0, 1]: 1/√N where N is a count or what stands for one, a pseudocount.
pub trait Novelty<O>: Checkpoint {
    /// r_novelty(s); 1 for what was never seen.
    fn bonus(&self, s: &O) -> f32;

    /// `s` was visited.
    fn visit(&mut self, s: &O, ctx: &mut Context);
}
