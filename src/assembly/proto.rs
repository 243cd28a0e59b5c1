//! Proto-goal reinforcement learning (thesis chapter 8).

use inroads_agents::{
    Practice, Replay, TabularQ, encode::OneHot, experience::Pay, nets::Backend, tabular::TabularConfig,
};
use inroads_discovery::{
    Hierarchy, Shared,
    proto::{LeastSquares, ProtoConfig, ProtoGoalAgent, plausible::Plausibility},
};
use inroads_envs::{Annotated, Seed, Spec};
use serde::{Deserialize, Serialize};
use toml::Table;

use super::{
    AgentEntry, BoxedAgent, Vector,
    shared::{MemoryConfig, choices, named, table},
};
use crate::config::{ConfigError, section};

pub(super) const ENTRIES: &[AgentEntry] = &[AgentEntry {
    name: "proto-goals",
    about: "proto-goal RL (thesis chapter 8) with tables: prunes a space of candidate goals, pursues what is new and near",
    defaults: || table(&ProtoGoalsConfig::default()),
    check: |t| section::<ProtoGoalsConfig>(t.clone(), "proto-goals")?.check(),
    continuous: None,
    discrete: None,
    annotated: Some(proto_goals),
    pictured: None,
}];

/// Settings of `proto-goals`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct ProtoGoalsConfig {
    memory: MemoryConfig,
    policy: TabularConfig,
    returns: ReturnsConfig,
    goals: ProtoConfig,
    features: FeaturesConfig,
    plausibility: Plausibility,
}

/// Settings of returns.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct ReturnsConfig {
    /// n: steps of a return before it bootstraps. Above 1 the returns are those of whoever acted, and most of that is
    /// exploration (`docs/systems/proto-goals.md`).
    steps: u32,
}

impl Default for ReturnsConfig {
    fn default() -> Self {
        Self { steps: 1 }
    }
}

/// What the evaluator reads of an observation: whole numbers as one-hot rows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct FeaturesConfig {
    /// Values that the block of what is read jointly may have: where one is and, as long as they fit, what else there is in
    /// its order. All other numbers are read one by one.
    joint: usize,
}

impl Default for FeaturesConfig {
    fn default() -> Self {
        Self { joint: 128 }
    }
}

impl Default for ProtoGoalsConfig {
    fn default() -> Self {
        let memory = MemoryConfig { capacity: 200_000, warm_up: 1, ..MemoryConfig::default() };
        // Ten thousand transitions of the first wanderings hold enough drop-offs for all places of a taxi's passenger to be
        // judged right, in 20 of 20 seeds; four thousand in 3 of 8.
        let mut plausibility = Plausibility { batch: 10_240, ..Plausibility::default() };
        plausibility.lspi.features = 160;
        Self {
            memory,
            policy: TabularConfig { rate: 1.0, initial: 0.1, batch: 32, ..TabularConfig::default() },
            returns: ReturnsConfig::default(),
            goals: ProtoConfig { evaluate_every: 10_000, task_share: 0.3, ..ProtoConfig::default() },
            features: FeaturesConfig::default(),
            plausibility,
        }
    }
}

fn at_least_one(name: &str, value: usize) -> Result<(), String> {
    if value == 0 { Err(format!("{name} is 0; it must be at least 1")) } else { Ok(()) }
}

impl ProtoGoalsConfig {
    fn check(&self) -> Result<(), ConfigError> {
        named("memory", self.memory.check())?;
        named("policy", self.policy.check())?;
        named("goals", self.goals.check())?;
        named("returns", at_least_one("steps", self.returns.steps as usize))?;
        named("features", at_least_one("joint", self.features.joint))?;
        named("plausibility", self.plausibility.check())
    }
}

fn proto_goals(
    spec: &Spec,
    settings: &Table,
    _: Backend,
    _: Seed,
) -> Result<BoxedAgent<Annotated<Vector>, usize>, ConfigError> {
    let config: ProtoGoalsConfig = section(settings.clone(), "proto-goals")?;
    let learner = TabularQ::new(choices(spec), &config.policy);
    let replay = Replay::new(config.memory.capacity).paying(Pay::ATTAINMENT).spanning(config.returns.steps);
    let policy = Shared::new(learner, Practice::new(replay, config.memory.pace()));
    let encoder = OneHot::around(spec, config.features.joint)
        .map_err(|why| ConfigError::Impossible { table: "features".into(), why: why.to_string() })?;
    let judge = LeastSquares::new(config.plausibility, encoder, choices(spec));
    let agent = ProtoGoalAgent::new(&config.goals, policy, judge);
    Ok(Box::new(Hierarchy::new(agent, config.memory.capacity)))
}
