//! Novelty: how seldom a state was seen (thesis 7.2.2.1).
//!
//! Where states are symbols they can be counted: [`Counts`], and [`FeatureCounts`], which generalises. Where they are
//! pictures or real numbers no two are equal, and a network stands in for the count: [`Cfn`] learns 1/√N itself,
//! [`Rnd`] has an error that falls with N in some way.

mod cfn;
mod counts;
mod features;
mod rnd;
mod standard;

pub use cfn::{Cfn, CfnConfig};
pub use counts::Counts;
pub use features::{FeatureCounts, FeatureCountsConfig};
pub use rnd::{Rnd, RndConfig};

use crate::{
    Checkpoint, Context,
    experience::{Moment, Seen},
};

/// Says how new states are.
///
/// The value is *raw*: for counts and pseudocounts it is 1/√N, in (0, 1], with which a threshold or a drop can be
/// compared (thesis 7.2.2.3, 9.2.3). Whoever learns from it divides by the spread of all values so far
/// ([`Curious`](crate::Curious)) and keeps the two apart. What has no scale of its own ([`Rnd`]) is above 0, greater for
/// what is newer, and good for learning only.
pub trait Novelty<O>: Checkpoint {
    /// r_novelty(s); 1 for what was never seen, where it is a count.
    fn bonus(&self, s: &O) -> f32;

    /// The same of many states.
    fn bonuses(&self, states: &[&O]) -> Vec<f32> {
        states.iter().map(|s| self.bonus(s)).collect()
    }

    /// A state was visited: what is newest in the experience. Who learns from visits keeps moments, not states.
    fn visit(&mut self, at: Moment, all: &dyn Seen<O>, ctx: &mut Context);
}

/// An encoder that many may share.
type Shared<O> = std::sync::Arc<dyn crate::Encoder<O> + Send + Sync>;

/// Checks what both networks have.
fn check_network(rate: f32, batch: usize, updates_per_visit: f32) -> Result<(), String> {
    if !(rate.is_finite() && rate > 0.0) {
        return Err(format!("rate is {rate}; it must be a number above 0"));
    }
    if batch == 0 {
        return Err("batch is 0; an update needs at least one visit".into());
    }
    if !(updates_per_visit.is_finite() && updates_per_visit >= 0.0) {
        return Err(format!("updates_per_visit is {updates_per_visit}; it must be 0 or above"));
    }
    Ok(())
}
