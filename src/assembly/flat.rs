//! Flat baselines: one learner for the whole task.

use inroads_agents::{
    Curious, Flat, Practice, Replay,
    ddpg::{Ddpg, DdpgConfig},
    nets::Backend,
    tabular::{TabularConfig, TabularQ},
};
use inroads_envs::{Seed, Spec};
use serde::{Deserialize, Serialize};
use toml::Table;

use super::{
    AgentEntry, BoxedAgent, Vector,
    parts::NoveltyConfig,
    shared::{MemoryConfig, choices, named, scaled, table, tuned_ddpg},
};
use crate::config::{ConfigError, section};

pub(super) const ENTRIES: &[AgentEntry] = &[
    AgentEntry {
        name: "ddpg",
        about: "the flat baseline: one DDPG policy for the whole task",
        defaults: || table(&FlatDdpgConfig::default()),
        check: |t| section::<FlatDdpgConfig>(t.clone(), "ddpg")?.check(),
        continuous: Some(ddpg),
        discrete: None,
        annotated: None,
    },
    AgentEntry {
        name: "q-learning",
        about: "the flat tabular baseline",
        defaults: || table(&FlatTabularConfig::default()),
        check: |t| section::<FlatTabularConfig>(t.clone(), "q-learning")?.check(),
        continuous: None,
        discrete: Some(q_learning),
        annotated: None,
    },
    AgentEntry {
        name: "counts-q",
        about: "the flat tabular baseline with a bonus for states that were seldom seen",
        defaults: || table(&CountsConfig::default()),
        check: |t| section::<CountsConfig>(t.clone(), "counts-q")?.check(),
        continuous: None,
        discrete: Some(counts_q),
        annotated: None,
    },
];

/// Settings of `ddpg`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct FlatDdpgConfig {
    memory: MemoryConfig,
    policy: DdpgConfig,
}

impl Default for FlatDdpgConfig {
    fn default() -> Self {
        Self { memory: MemoryConfig::default(), policy: tuned_ddpg() }
    }
}

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

impl FlatDdpgConfig {
    fn check(&self) -> Result<(), ConfigError> {
        named("memory", self.memory.check())?;
        named("policy", self.policy.check())
    }
}

impl FlatTabularConfig {
    fn check(&self) -> Result<(), ConfigError> {
        named("memory", self.memory.check())?;
        named("policy", self.policy.check())
    }
}

fn ddpg(
    spec: &Spec,
    settings: &Table,
    backend: Backend,
    seed: Seed,
) -> Result<BoxedAgent<Vector, Vector>, ConfigError> {
    let config: FlatDdpgConfig = section(settings.clone(), "ddpg")?;
    let mut rng = seed.stream("initialise", 0);
    let learner = Ddpg::new(scaled(spec), spec.action.len(), &config.policy, backend, &mut rng);
    let capacity = config.memory.capacity;
    Ok(Box::new(Flat::new(Curious::new(learner, config.memory.practice()), capacity)))
}

fn q_learning(
    spec: &Spec,
    settings: &Table,
    _: Backend,
    _: Seed,
) -> Result<BoxedAgent<Vector, usize>, ConfigError> {
    let config: FlatTabularConfig = section(settings.clone(), "q-learning")?;
    let learner = TabularQ::new(choices(spec), &config.policy);
    let capacity = config.memory.capacity;
    Ok(Box::new(Flat::new(Curious::new(learner, config.memory.practice()), capacity)))
}

fn counts_q(
    spec: &Spec,
    settings: &Table,
    backend: Backend,
    seed: Seed,
) -> Result<BoxedAgent<Vector, usize>, ConfigError> {
    let config: CountsConfig = section(settings.clone(), "counts-q")?;
    named("novelty", config.novelty.fits(spec))?;
    let learner = TabularQ::new(choices(spec), &config.policy);
    let capacity = config.memory.capacity;
    let replay = Replay::new(capacity).spanning(config.returns);
    let curious = Curious::new(learner.clone(), Practice::new(replay, config.memory.pace()))
        .sober(learner)
        .with_novelty(config.novelty.build(spec, backend, seed), config.novelty.weight)
        .centred(config.novelty.centred);
    Ok(Box::new(Flat::new(curious, capacity)))
}
