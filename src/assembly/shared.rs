//! Settings and parts that several agents have.

use std::sync::Arc;

use inroads_agents::{
    Encoder, Pace, Practice, Replay,
    ddpg::DdpgConfig,
    encode::{Scaled, Select},
    noise::NoiseConfig,
};
use inroads_envs::Spec;
use serde::{Deserialize, Serialize};
use toml::Table;

use super::Vector;
use crate::config::ConfigError;

/// What a learner learns from, and how much.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct MemoryConfig {
    /// Steps remembered (authors: 1e6).
    pub(super) capacity: usize,
    /// Minibatch updates of a policy for each step that it is trained on (authors: 1).
    pub(super) updates_per_step: f32,
    /// Steps of noise before the first update of the policy for the whole task.
    pub(super) warm_up: usize,
}

impl Default for MemoryConfig {
    fn default() -> Self {
        Self { capacity: 1_000_000, updates_per_step: 1.0, warm_up: 5000 }
    }
}

impl MemoryConfig {
    pub(super) fn pace(&self) -> Pace {
        Pace { updates_per_step: self.updates_per_step, warm_up: self.warm_up }
    }

    /// Practice on single steps, all drawn with the same probability.
    pub(super) fn practice(&self) -> Practice {
        Practice::new(Replay::new(self.capacity), self.pace())
    }

    pub(super) fn check(&self) -> Result<(), String> {
        if self.capacity == 0 {
            return Err("capacity is 0; at least one step must be remembered".into());
        }
        if !(self.updates_per_step.is_finite() && self.updates_per_step >= 0.0) {
            return Err(format!("updates_per_step is {}; it must be 0 or above", self.updates_per_step));
        }
        Ok(())
    }
}

/// DDPG as tuned on the Point-Maze, the same for every agent (`docs/results/point-maze.md`).
///
/// Networks that a CPU trains in minutes. Noise that begins wider than the actions, so that most are at their bounds:
/// before anything is learned that finds the goal in a quarter of the episodes, unit noise in a seventh. An actor that
/// cannot saturate while it has seen no reward. A large batch, so that the few successes are in it.
pub(super) fn tuned_ddpg() -> DdpgConfig {
    let noise = NoiseConfig { start: 2.0, end: 0.05, decay_steps: 40_000, ..NoiseConfig::default() };
    let fork_noise = NoiseConfig { start: 0.5, end: 0.05, decay_steps: 10_000, ..NoiseConfig::default() };
    DdpgConfig {
        hidden: vec![128, 128],
        actor_rate: 3e-4,
        discount: 0.98,
        tau: 0.005,
        batch: 256,
        preactivation: 0.3,
        noise,
        fork_noise,
        ..DdpgConfig::default()
    }
}

/// An error that names the table in which a setting is impossible.
pub(super) fn named<T>(table: &str, checked: Result<T, String>) -> Result<T, ConfigError> {
    checked.map_err(|why| ConfigError::Impossible { table: table.to_owned(), why })
}

/// Settings as a table.
pub(super) fn table(config: &impl Serialize) -> Table {
    Table::try_from(config).expect("settings are plain values")
}

/// What is seen, scaled by its usual ranges: what networks read.
pub(super) fn scaled(spec: &Spec) -> Arc<dyn Encoder<Vector> + Send + Sync> {
    Arc::new(Scaled::new(&spec.observation))
}

/// Which of what is seen initiation sets are learned on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum FeatureSet {
    /// Where one is (authors: x and y); where a key matters, whether one has it too.
    Place,
    /// All that is seen.
    All,
}

/// The features that initiation sets are learned on: as numbers of the domain where all have one unit, else each scaled by
/// its usual range, since a metre is no key (`decisions.md`).
pub(super) fn features(spec: &Spec, which: FeatureSet) -> Arc<dyn Encoder<Vector> + Send + Sync> {
    let seen = spec.observation.dimensions();
    let dims = match which {
        FeatureSet::Place => spec.place.clone(),
        FeatureSet::All => (0..seen.len()).collect(),
    };
    let mut units = dims.iter().map(|dim| (seen[*dim].unit, seen[*dim].kind));
    let first = units.next();
    match units.all(|unit| Some(unit) == first) {
        true => Arc::new(Select::new(&dims)),
        false => Arc::new(Scaled::of(&spec.observation, dims)),
    }
}

/// How many choices there are.
pub(super) fn choices(spec: &Spec) -> usize {
    match &spec.action {
        inroads_envs::Space::Discrete(n) => *n,
        other => other.len(),
    }
}

#[cfg(test)]
mod tests {
    use inroads_envs::{
        Environment,
        maze::{
            PointMaze,
            catalogue::{LOCK_AND_KEY, U_MAZE},
        },
    };

    use super::*;

    #[test]
    fn metres_stay_metres_and_a_key_is_as_much_as_half_the_map() {
        let row = |maze, which, seen: &[f32]| {
            let encoder = features(PointMaze::new(maze).unwrap().spec(), which);
            let mut row = vec![0.0; encoder.width()];
            encoder.write(&seen.to_vec(), &mut row);
            row
        };
        assert_eq!(row(&U_MAZE, FeatureSet::Place, &[4.0, 8.0, 0.5, 0.0, 0.0, 0.0]), [4.0, 8.0]);
        // Free space is from -3 to 11; the heading is read as a point on a circle.
        let seen = [4.0, 11.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(row(&LOCK_AND_KEY, FeatureSet::Place, &seen), [0.0, 1.0, -1.0]);
        assert_eq!(row(&LOCK_AND_KEY, FeatureSet::All, &seen)[..5], [0.0, 1.0, -1.0, 0.0, 1.0]);
    }
}
