//! Deep Q-learning for the whole task: Rainbow's parts, each a setting.

use inroads_agents::{
    Curious, Flat, Practice, Replay,
    dqn::{Dqn, DqnConfig, Epsilon},
    nets::Backend,
    replay::PriorityConfig,
};
use inroads_envs::{Seed, Spec};
use serde::{Deserialize, Serialize};
use toml::Table;

use super::{
    AgentEntry, BoxedAgent,
    kinds::{EncoderKind, Observed},
    shared::{MemoryConfig, choices, named, table},
};
use crate::config::{ConfigError, section};

pub(super) const ENTRIES: &[AgentEntry] = &[AgentEntry {
    name: "dqn",
    about: "the flat deep baseline: double and dueling DQN with priorities and returns of several steps; Rainbow by settings",
    defaults: || table(&FlatDqnConfig::default()),
    check: |t| section::<FlatDqnConfig>(t.clone(), "dqn")?.check(),
    continuous: None,
    discrete: Some(dqn),
    annotated: None,
    pictured: Some(dqn),
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

/// What is drawn from the memory.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct ReplayConfig {
    /// Steps of returns; 3 (Rainbow, Hessel 2018, table 1).
    returns: u32,
    /// Whether what surprised is drawn more often (Schaul 2016).
    prioritised: bool,
    /// How priorities are made, where there are any.
    priority: PriorityConfig,
}

impl Default for ReplayConfig {
    fn default() -> Self {
        Self { returns: 3, prioritised: true, priority: PriorityConfig::default() }
    }
}

impl Default for FlatDqnConfig {
    fn default() -> Self {
        let memory = MemoryConfig { capacity: 100_000, updates_per_step: 0.25, warm_up: 1000 };
        Self { encoder: EncoderKind::Auto, memory, replay: ReplayConfig::default(), learner: tuned_dqn() }
    }
}

/// DQN as tuned on DoorKey-5x5 and Taxi (`docs/results/learners.md`): a network that a CPU trains in a minute, and so a
/// larger rate and a target that follows sooner than Rainbow's.
fn tuned_dqn() -> DqnConfig {
    DqnConfig {
        rate: 5e-4,
        follow_every: 200,
        epsilon: Epsilon { start: 1.0, end: 0.05, updates: 5000 },
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

fn dqn<O: Observed>(
    spec: &Spec,
    settings: &Table,
    backend: Backend,
    seed: Seed,
) -> Result<BoxedAgent<O, usize>, ConfigError> {
    let config: FlatDqnConfig = section(settings.clone(), "dqn")?;
    let encoder = O::reader(spec, &config.learner.torso, config.encoder)?;
    let mut rng = seed.stream("initialise", 0);
    let learner = Dqn::new(encoder, choices(spec), &config.learner, backend, &mut rng);
    Ok(Box::new(Flat::new(Curious::new(learner, config.practice()), config.memory.capacity)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_that_make_no_agent_are_named() {
        let config = FlatDqnConfig::default();
        assert!(config.check().is_ok());
        let replay = ReplayConfig { returns: 0, ..ReplayConfig::default() };
        let wrong = FlatDqnConfig { replay, ..config }.check().unwrap_err().to_string();
        assert!(wrong.contains("returns"), "{wrong}");
    }
}
