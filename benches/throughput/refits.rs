//! What it costs to learn initiation sets again after an execution: with full memories, and whether it grows with the run.

use std::sync::Arc;

use inroads::{
    agents::{
        classify::{Svm, SvmConfig, TwoClassRule},
        encode::Select,
    },
    discovery::{Binary, Dual, Initiation, SkillId},
    envs::{Rng, Seed},
};
use rand::RngExt;

use crate::workload::Workload;

/// A refit of chapter 3's sets with full memories.
pub(crate) const BINARY: &str = "classifiers/binary/refit, 500 seen";
/// The same of chapter 4's, an optimistic and a pessimistic machine each.
pub(crate) const DUAL: &str = "classifiers/dual/refit, 500 seen";

/// Examples of either class that a set remembers (the registry's default for `dsc`).
const MEMORY: usize = 500;

/// Refits after an execution by what was seen before it, of either class.
pub(crate) fn refits() -> Vec<Workload> {
    let mut all = Vec::new();
    for seen in [MEMORY, 10 * MEMORY] {
        let places = || Arc::new(Select::new(&[0, 1]));
        let binary = Binary::new(places(), Svm::default(), MEMORY);
        all.push(refit(&format!("classifiers/binary/refit, {seen} seen"), binary, seen));
        let optimistic = SvmConfig { nu: 0.01, two_class: TwoClassRule::Plain, ..SvmConfig::default() };
        let dual = Dual::new(places(), Svm::new(optimistic), Svm::default(), MEMORY);
        all.push(refit(&format!("classifiers/dual/refit, {seen} seen"), dual, seen));
    }
    all
}

/// An execution that succeeded, and the segment of 20 states that it hands to the set.
fn refit(name: &str, mut sets: impl Initiation<Vec<f32>, Vec<f32>> + 'static, seen: usize) -> Workload {
    let (k, mut rng) = (SkillId(1), Seed(0).stream("refits", 0));
    sets.born(k, &states(&mut rng, true, MEMORY.min(seen)));
    sets.outcome(k, &states(&mut rng, true, seen - MEMORY.min(seen)), true);
    sets.outcome(k, &states(&mut rng, false, seen), false);
    assert_eq!(sets.examples(k), (MEMORY, MEMORY), "what is older is forgotten");
    Workload::repeated(name, move || sets.outcome(k, &states(&mut rng, true, 20), true))
}

/// Places of a U-maze on either side of a blurred border, so that machines have something to tell apart.
fn states(rng: &mut Rng, success: bool, count: usize) -> Vec<Vec<f32>> {
    let from = if success { 4.0 } else { -2.0 };
    (0..count).map(|_| vec![rng.random_range(from..from + 6.5), rng.random_range(-2.0..10.0)]).collect()
}
