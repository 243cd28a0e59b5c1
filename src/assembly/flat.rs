//! Flat baselines on tables: one learner for the whole task.

use inroads_agents::{
    Curious, Flat, Practice, Replay,
    nets::Backend,
    tabular::{TabularConfig, TabularQ},
};
use inroads_envs::{Seed, Spec};
use serde::{Deserialize, Serialize};
use toml::Table;

use super::{
    AgentEntry, BoxedAgent,
    kinds::Observed,
    parts::NoveltyConfig,
    shared::{MemoryConfig, choices, named, table},
};
use crate::config::{ConfigError, section};

pub(super) const ENTRIES: &[AgentEntry] = &[
    AgentEntry {
        name: "q-learning",
        about: "the flat tabular baseline",
        defaults: || table(&FlatTabularConfig::default()),
        check: |t| section::<FlatTabularConfig>(t.clone(), "q-learning")?.check(),
        continuous: None,
        discrete: Some(q_learning),
        annotated: None,
        pictured: Some(q_learning),
    },
    AgentEntry {
        name: "counts-q",
        about: "the flat tabular baseline with a bonus for states that were seldom seen",
        defaults: || table(&CountsConfig::default()),
        check: |t| section::<CountsConfig>(t.clone(), "counts-q")?.check(),
        continuous: None,
        discrete: Some(counts_q),
        annotated: None,
        pictured: Some(counts_q),
    },
];

/// Settings of `q-learning`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct FlatTabularConfig {
    memory: MemoryConfig,
    policy: TabularConfig,
}

/// A table of rewards that change from visit to visit: a bonus that shrinks, a success that pays the less the later it comes.
/// With larger steps than these it never settles. And what a step that leads nowhere was once thought to be worth fades by
/// 1 − γ an update only, so with a γ nearer to 1 who acts greedily may stay where he is for good.
pub(super) fn bonus_table() -> TabularConfig {
    TabularConfig { rate: 0.1, discount: 0.97, ..TabularConfig::default() }
}

/// Settings of `counts-q`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct CountsConfig {
    memory: MemoryConfig,
    policy: TabularConfig,
    /// Flat agents have no use for its threshold.
    novelty: NoveltyConfig,
    /// Steps of returns.
    returns: u32,
}

impl Default for CountsConfig {
    fn default() -> Self {
        let memory = MemoryConfig { capacity: 100_000, warm_up: 8, ..MemoryConfig::default() };
        Self { memory, policy: bonus_table(), novelty: NoveltyConfig::default(), returns: 5 }
    }
}

impl CountsConfig {
    fn check(&self) -> Result<(), ConfigError> {
        named("memory", self.memory.check())?;
        named("policy", self.policy.check())?;
        if self.returns == 0 {
            return named("counts-q", Err("returns is 0; a return has at least one step".into()));
        }
        named("novelty", self.novelty.check())
    }
}

impl FlatTabularConfig {
    fn check(&self) -> Result<(), ConfigError> {
        named("memory", self.memory.check())?;
        named("policy", self.policy.check())
    }
}

/// An agent for whatever has keys.
fn q_learning<O: Observed>(
    spec: &Spec,
    settings: &Table,
    _: Backend,
    _: Seed,
) -> Result<BoxedAgent<O, usize>, ConfigError> {
    let config: FlatTabularConfig = section(settings.clone(), "q-learning")?;
    let learner = TabularQ::new(choices(spec), &config.policy);
    let capacity = config.memory.capacity;
    Ok(Box::new(Flat::new(Curious::new(learner, config.memory.practice()), capacity)))
}

/// The same with a bonus for what is novel.
fn counts_q<O: Observed>(
    spec: &Spec,
    settings: &Table,
    backend: Backend,
    seed: Seed,
) -> Result<BoxedAgent<O, usize>, ConfigError> {
    let config: CountsConfig = section(settings.clone(), "counts-q")?;
    let novelty = config.novelty.build(spec, backend, seed)?;
    let learner = TabularQ::new(choices(spec), &config.policy);
    let capacity = config.memory.capacity;
    let replay = Replay::new(capacity).spanning(config.returns);
    let curious = Curious::new(learner.clone(), Practice::new(replay, config.memory.pace()))
        .sober(learner)
        .with_novelty(novelty, config.novelty.weight)
        .centred(config.novelty.centred);
    Ok(Box::new(Flat::new(curious, capacity)))
}
