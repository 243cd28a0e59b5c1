//! Settings of deep skill graphs.

use serde::{Deserialize, Serialize};

use crate::chain::OptionReward;

/// Settings of [`DeepGraph`](super::DeepGraph). Those that the authors' code gives other values say so; their ant needs
/// about five times the steps of our point for a metre.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct DeepGraphConfig {
    /// ε: radius of a goal region, in the units of places (authors: 0.6 m).
    pub tolerance: f32,
    /// Least distance of the middles of two goal regions (authors: 2.5 ε).
    pub spacing: f32,
    /// An episode in so many expands the graph, the others consolidate it; 0: none does (authors: 50).
    pub expand_every: u64,
    /// Expansions that such an episode tries (authors: 10).
    pub tries: u32,
    /// K: steps of an expansion beyond the graph (authors: 100).
    pub extension: u32,
    /// H: steps after which an option hands back, and in which a walk without one must arrive (authors: 200).
    pub horizon: u32,
    /// Steps after which an errand (a vertex to be reached) is given up for another.
    pub patience: u32,
    /// N: times that a subgoal must be reached before an option for it is created (authors: 5).
    pub gestation: u32,
    /// Last states of each such trajectory that seed the option's initiation set (authors: 50).
    pub segment: u32,
    /// Successes after which an initiation set is fixed.
    pub refinements: u64,
    /// Options of a chain at most (authors: no more after 5 are trained).
    pub chain: u32,
    /// Share of an effect set that must lie in an initiation set for an edge (6.1.4: all; `decisions.md`: 0.9).
    pub inclusion: f32,
    /// Vertices at most.
    pub max_vertices: u32,
    /// What option policies that learn are rewarded with.
    pub option_reward: OptionReward,
    /// No graph: the policy alone, sent to random places in training and straight to the goal in a query. The flat
    /// goal-conditioned baseline of 6.2.3.
    pub flat: bool,
}

impl Default for DeepGraphConfig {
    fn default() -> Self {
        Self {
            tolerance: 0.6,
            spacing: 1.5,
            expand_every: 5,
            tries: 10,
            extension: 20,
            horizon: 40,
            patience: 300,
            gestation: 5,
            segment: 20,
            refinements: 30,
            chain: 5,
            inclusion: 0.9,
            max_vertices: 600,
            option_reward: OptionReward::Sparse,
            flat: false,
        }
    }
}

impl DeepGraphConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the mend.
    pub fn check(&self) -> Result<(), String> {
        for (name, value) in [("tolerance", self.tolerance), ("spacing", self.spacing)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(format!("{name} is {value}; it must be a finite number above 0"));
            }
        }
        for (name, value) in [
            ("extension", self.extension),
            ("horizon", self.horizon),
            ("patience", self.patience),
            ("gestation", self.gestation),
            ("segment", self.segment),
            ("chain", self.chain),
            ("max_vertices", self.max_vertices),
        ] {
            if value == 0 {
                return Err(format!("{name} is 0; it must be at least 1"));
            }
        }
        if !(0.0..=1.0).contains(&self.inclusion) {
            return Err(format!("inclusion is {}; it must lie in [0, 1]", self.inclusion));
        }
        Ok(())
    }
}
