//! Deep Q-learning with a bonus for what is new: the flat baseline of chapters 7 and 9 (CFN, Lobel 2023).

use inroads_agents::{
    Curious, Flat, Practice, Replay,
    dqn::{Dqn, DqnConfig},
    nets::Backend,
};
use inroads_envs::{Seed, Spec};
use serde::{Deserialize, Serialize};
use toml::Table;

use super::{
    AgentEntry, BoxedAgent,
    kinds::{EncoderKind, Observed},
    parts::{NoveltyConfig, NoveltyKind},
    shared::{MemoryConfig, choices, named, table},
};
use crate::config::{ConfigError, section};

pub(super) const ENTRIES: &[AgentEntry] = &[AgentEntry {
    name: "cfn",
    about: "deep Q-learning with a bonus for states that a coin flip network calls new",
    defaults: || table(&CuriousConfig::default()),
    check: |t| section::<CuriousConfig>(t.clone(), "cfn")?.check(),
    continuous: None,
    discrete: Some(cfn),
    annotated: None,
    pictured: Some(cfn),
}];

/// Settings of `cfn`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct CuriousConfig {
    /// How vectors become rows.
    encoder: EncoderKind,
    memory: MemoryConfig,
    /// Of the learner that explores, and of the one that does not and learns the task's reward alone.
    policy: DqnConfig,
    /// Flat agents have no use for its threshold.
    novelty: NoveltyConfig,
    /// Steps of returns; 3 (the authors).
    returns: u32,
}

impl Default for CuriousConfig {
    fn default() -> Self {
        Self {
            encoder: EncoderKind::Auto,
            memory: MemoryConfig { capacity: 100_000, updates_per_step: 0.25, warm_up: 1000 },
            policy: DqnConfig::default(),
            novelty: NoveltyConfig { counts: NoveltyKind::Cfn, ..NoveltyConfig::default() },
            returns: 3,
        }
    }
}

impl CuriousConfig {
    fn check(&self) -> Result<(), ConfigError> {
        named("memory", self.memory.check())?;
        named("policy", self.policy.check())?;
        if self.returns == 0 {
            return named("cfn", Err("returns is 0; a return has at least one step".into()));
        }
        named("novelty", self.novelty.check())
    }
}

fn cfn<O: Observed>(
    spec: &Spec,
    settings: &Table,
    backend: Backend,
    seed: Seed,
) -> Result<BoxedAgent<O, usize>, ConfigError> {
    let config: CuriousConfig = section(settings.clone(), "cfn")?;
    let encoder = O::reader(spec, &config.policy.torso, config.encoder)?;
    let novelty = config.novelty.build(spec, backend, seed)?;
    let rng = &mut seed.stream("initialise", 0);
    let learner = Dqn::new(encoder, choices(spec), &config.policy, backend, rng);
    let capacity = config.memory.capacity;
    let replay = Replay::new(capacity).spanning(config.returns);
    let curious = Curious::new(learner.clone(), Practice::new(replay, config.memory.pace()))
        .sober(learner)
        .with_novelty(novelty, config.novelty.weight)
        .centred(config.novelty.centred);
    Ok(Box::new(Flat::new(curious, capacity)))
}
