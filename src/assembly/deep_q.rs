//! Deep Q-learning for the whole task: Rainbow's parts, each a setting.

use std::sync::Arc;

use inroads_agents::{
    Curious, Encoder, Flat, Practice, Replay,
    dqn::{Dqn, DqnConfig, Epsilon},
    encode::OneHot,
    nets::Backend,
    replay::PriorityConfig,
};
use inroads_envs::{Dimension, Kind, Seed, Spec};
use serde::{Deserialize, Serialize};
use toml::Table;

use super::{
    AgentEntry, BoxedAgent, Vector,
    shared::{MemoryConfig, choices, named, scaled, table},
};
use crate::config::{ConfigError, section};

pub(super) const ENTRIES: &[AgentEntry] = &[AgentEntry {
    name: "dqn",
    about: "the flat deep baseline: double and dueling DQN with priorities; Rainbow by settings",
    defaults: || table(&FlatDqnConfig::default()),
    check: |t| section::<FlatDqnConfig>(t.clone(), "dqn")?.check(),
    continuous: None,
    discrete: Some(dqn),
    annotated: None,
}];

/// Settings of `dqn`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct FlatDqnConfig {
    /// How vectors become rows.
    encoder: EncoderKind,
    memory: MemoryConfig,
    replay: ReplayConfig,
    learner: DqnConfig,
}

/// How vectors become rows that networks read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum EncoderKind {
    /// One-hot where everything looks like a whole number, else scaled.
    #[default]
    Auto,
    /// A block a dimension, with a one at its value.
    OneHot,
    /// By the usual range of each dimension.
    Scaled,
}

/// What is drawn from the memory.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct ReplayConfig {
    /// Steps of returns; 1. Rainbow has 3, which hold what random steps cost: in Taxi, where such a step may cost 10, the
    /// runs with 3 that we tried learned nothing (`docs/results/learners.md`).
    returns: u32,
    /// Whether what surprised is drawn more often (Schaul 2016).
    prioritised: bool,
    /// How priorities are made, where there are any.
    priority: PriorityConfig,
}

impl Default for ReplayConfig {
    fn default() -> Self {
        Self { returns: 1, prioritised: true, priority: PriorityConfig::default() }
    }
}

impl Default for FlatDqnConfig {
    fn default() -> Self {
        let memory = MemoryConfig { capacity: 100_000, updates_per_step: 0.25, warm_up: 1000 };
        Self { encoder: EncoderKind::Auto, memory, replay: ReplayConfig::default(), learner: tuned_dqn() }
    }
}

/// DQN as tuned on DoorKey-5x5 and Taxi (`docs/results/learners.md`): a network that a CPU trains in seconds, and so a larger
/// rate and a target that follows sooner than Rainbow's. With γ of 0.99 Taxi's passengers were forgotten again.
fn tuned_dqn() -> DqnConfig {
    DqnConfig {
        rate: 1e-3,
        discount: 0.95,
        follow_every: 200,
        // An update every four steps: 60,000 steps.
        epsilon: Epsilon { start: 1.0, end: 0.05, updates: 15_000 },
        ..DqnConfig::default()
    }
}

impl FlatDqnConfig {
    fn check(&self) -> Result<(), ConfigError> {
        named("memory", self.memory.check())?;
        if self.replay.returns == 0 {
            return named("replay", Err("returns is 0; a return has at least one step".into()));
        }
        named("replay.priority", self.replay.priority.check())?;
        named("learner", self.learner.check())
    }

    fn practice(&self) -> Practice {
        let replay = Replay::new(self.memory.capacity).spanning(self.replay.returns);
        let replay = if self.replay.prioritised { replay.prioritised(self.replay.priority) } else { replay };
        Practice::new(replay, self.memory.pace())
    }
}

impl EncoderKind {
    fn build(self, spec: &Spec) -> Result<Arc<dyn Encoder<Vector> + Send + Sync>, ConfigError> {
        let one_hot = match self {
            Self::Auto => spec.observation.dimensions().iter().all(counts),
            Self::OneHot => true,
            Self::Scaled => false,
        };
        if !one_hot {
            return Ok(scaled(spec));
        }
        Ok(Arc::new(named("encoder", OneHot::new(&spec.observation, &[]).map_err(|why| why.to_string()))?))
    }
}

/// Whether a dimension looks like a whole number: it counts something from a whole number up to another, in no unit that
/// things are measured in. A guess, which the setting overrules: a `Spec` does not say it.
fn counts(dimension: &Dimension) -> bool {
    let whole = |x: f32| x.is_finite() && x >= 0.0 && x.fract() == 0.0;
    dimension.kind == Kind::Linear
        && whole(dimension.low)
        && whole(dimension.high)
        && ["", "cells", "steps", "turns"].contains(&dimension.unit)
}

fn dqn(
    spec: &Spec,
    settings: &Table,
    backend: Backend,
    seed: Seed,
) -> Result<BoxedAgent<Vector, usize>, ConfigError> {
    let config: FlatDqnConfig = section(settings.clone(), "dqn")?;
    let encoder = config.encoder.build(spec)?;
    let mut rng = seed.stream("initialise", 0);
    let learner = Dqn::new(encoder, choices(spec), &config.learner, backend, &mut rng);
    Ok(Box::new(Flat::new(Curious::new(learner, config.practice()), config.memory.capacity)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use inroads_envs::registry::{self, AnyEnvironment, Options};

    /// Numbers a row that networks read of a world of symbols.
    fn width(world: &str, kind: EncoderKind) -> usize {
        let options = Options { see: Some("symbols".parse().unwrap()), ..Options::default() };
        let AnyEnvironment::Choices(env) = registry::make_with(world, &options).unwrap() else {
            panic!("{world} is seen otherwise")
        };
        kind.build(env.spec()).unwrap().width()
    }

    #[test]
    fn what_counts_is_one_hot_and_what_is_measured_is_scaled() {
        // Rows, columns, passenger's places, destinations.
        assert_eq!(width("taxi", EncoderKind::Auto), 5 + 5 + 5 + 4);
        assert_eq!(width("taxi", EncoderKind::Scaled), 4);
        // The agent and what it holds and stands on, and 25 cells of an object, a colour and a state.
        assert_eq!(
            width("door-key-5x5", EncoderKind::Auto),
            (5 + 5 + 4 + 8 + 6 + 13 + 10 + 6) + 25 * (11 + 6 + 4)
        );
        assert_eq!(width("pinball", EncoderKind::Auto), width("pinball", EncoderKind::Scaled));
        assert_eq!(width("montezuma", EncoderKind::Auto), width("montezuma", EncoderKind::Scaled));
    }

    #[test]
    fn settings_that_make_no_agent_are_named() {
        let config = FlatDqnConfig::default();
        assert!(config.check().is_ok());
        let replay = ReplayConfig { returns: 0, ..ReplayConfig::default() };
        let wrong = FlatDqnConfig { replay, ..config }.check().unwrap_err().to_string();
        assert!(wrong.contains("returns"), "{wrong}");
    }
}
