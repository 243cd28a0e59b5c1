//! R2D2 as a flat baseline: one learner that remembers, for the whole task.

use inroads_agents::{
    Curious, Flat, Practice, Replay,
    nets::Backend,
    r2d2::{R2d2, R2d2Config},
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
    name: "r2d2",
    about: "a flat baseline that remembers: double Q-learning with an LSTM, from sequences by priority",
    defaults: || table(&FlatR2d2Config::default()),
    check: |t| section::<FlatR2d2Config>(t.clone(), "r2d2")?.check(),
    continuous: None,
    discrete: Some(r2d2),
    annotated: None,
    pictured: Some(r2d2),
}];

/// Settings of `r2d2`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct FlatR2d2Config {
    /// How vectors become rows.
    encoder: EncoderKind,
    memory: MemoryConfig,
    sequences: SequenceConfig,
    priorities: PriorityConfig,
    policy: R2d2Config,
}

impl Default for FlatR2d2Config {
    /// An update every 8 steps, for one of 32 sequences of 40 steps learns from each step 160 times as it is. Priorities as
    /// in the paper (Kapturowski 2019, section 2.3), but that their correction becomes whole, as in Schaul's.
    fn default() -> Self {
        let memory = MemoryConfig { capacity: 200_000, updates_per_step: 0.125, warm_up: 2000 };
        let priorities = PriorityConfig { exponent: 0.9, correction: 0.6, ..PriorityConfig::default() };
        let (encoder, sequences, policy) =
            (EncoderKind::Auto, SequenceConfig::default(), R2d2Config::default());
        Self { encoder, memory, sequences, priorities, policy }
    }
}

/// Which steps are learned from together. Defaults are those of the authors' code (`algorithms.md`, section 0).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct SequenceConfig {
    /// Steps of a sequence; 40.
    length: u32,
    /// Steps from the beginning of one to that of the next; 20.
    period: u32,
    /// Steps before, that only bring the memory up to date; 0 (the paper: 40, or 20).
    burn_in: u32,
}

impl Default for SequenceConfig {
    fn default() -> Self {
        Self { length: 40, period: 20, burn_in: 0 }
    }
}

impl SequenceConfig {
    fn check(&self) -> Result<(), String> {
        for (name, value) in [("length", self.length), ("period", self.period)] {
            if value == 0 {
                return Err(format!("{name} is 0; it must be at least 1"));
            }
        }
        if self.period > self.length {
            let Self { length, period, .. } = self;
            return Err(format!(
                "period is {period} and length {length}; steps between sequences are never learned from, so period may be \
                 at most length"
            ));
        }
        Ok(())
    }
}

impl FlatR2d2Config {
    fn check(&self) -> Result<(), ConfigError> {
        named("memory", self.memory.check())?;
        named("sequences", self.sequences.check())?;
        named("priorities", self.priorities.check())?;
        named("policy", self.policy.check())
    }
}

fn r2d2<O: Observed>(
    spec: &Spec,
    settings: &Table,
    backend: Backend,
    seed: Seed,
) -> Result<BoxedAgent<O, usize>, ConfigError> {
    let config: FlatR2d2Config = section(settings.clone(), "r2d2")?;
    let mut rng = seed.stream("initialise", 0);
    let encoder = O::reader(spec, &config.policy.torso, config.encoder)?;
    let learner = R2d2::new(encoder, choices(spec), &config.policy, backend, &mut rng);
    let capacity = config.memory.capacity;
    let SequenceConfig { length, period, burn_in } = config.sequences;
    let replay = Replay::new(capacity).sequences(length, period, burn_in).prioritised(config.priorities);
    let practice = Practice::new(replay, config.memory.pace());
    Ok(Box::new(Flat::new(Curious::new(learner, practice), capacity)))
}
