//! Flat baselines for continuous actions: DDPG, TD3, and TD3 that reads the task's goal and learns in hindsight.

use inroads_agents::{
    Aimed, Curious, Encode, Flat, Learner, Practice, Replay,
    ddpg::{Ddpg, DdpgConfig},
    goal::{Ground, Region},
    hindsight::HindsightConfig,
    nets::Backend,
    td3::{Td3, Td3Config},
};
use inroads_envs::{Seed, Spec};
use serde::{Deserialize, Serialize};
use toml::Table;

use super::{
    AgentEntry, BoxedAgent, Vector,
    shared::{MemoryConfig, named, scaled, table, tuned_ddpg},
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
        pictured: None,
    },
    AgentEntry {
        name: "td3",
        about: "the same with TD3",
        defaults: || table(&FlatTd3Config::default()),
        check: |t| section::<FlatTd3Config>(t.clone(), "td3")?.check(),
        continuous: Some(td3),
        discrete: None,
        annotated: None,
        pictured: None,
    },
    AgentEntry {
        name: "td3-her",
        about: "TD3 on its way to the task's goal, which also learns of what it achieved instead (hindsight)",
        defaults: || table(&AimedTd3Config::default()),
        check: |t| section::<AimedTd3Config>(t.clone(), "td3-her")?.check(),
        continuous: Some(td3_her),
        discrete: None,
        annotated: None,
        pictured: None,
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

impl FlatDdpgConfig {
    fn check(&self) -> Result<(), ConfigError> {
        named("memory", self.memory.check())?;
        named("policy", self.policy.check())
    }
}

/// Settings of `td3`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct FlatTd3Config {
    memory: MemoryConfig,
    policy: Td3Config,
}

impl Default for FlatTd3Config {
    /// Less than half of the paper's 25,000 uniform steps, which are an eighth of what runs here are given.
    fn default() -> Self {
        let memory = MemoryConfig { warm_up: 10_000, ..MemoryConfig::default() };
        Self { memory, policy: Td3Config::default() }
    }
}

impl FlatTd3Config {
    fn check(&self) -> Result<(), ConfigError> {
        named("memory", self.memory.check())?;
        named("policy", self.policy.check())
    }
}

/// Settings of `td3-her`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct AimedTd3Config {
    memory: MemoryConfig,
    policy: Td3Config,
    hindsight: HindsightConfig,
    /// Steps of returns.
    returns: u32,
}

impl Default for AimedTd3Config {
    fn default() -> Self {
        let memory = MemoryConfig { warm_up: 1000, ..MemoryConfig::default() };
        // A third of actions are uniform, and rates are what rl-baselines3-zoo has for TD3+HER (`algorithms.md`, 1.3).
        let policy = Td3Config {
            actor_rate: 1e-3,
            critic_rate: 1e-3,
            discount: 0.95,
            random: 0.3,
            ..Td3Config::default()
        };
        Self { memory, policy, hindsight: HindsightConfig::default(), returns: 1 }
    }
}

impl AimedTd3Config {
    fn check(&self) -> Result<(), ConfigError> {
        named("memory", self.memory.check())?;
        named("policy", self.policy.check())?;
        if self.returns == 0 {
            return named("td3-her", Err("returns is 0; a return has at least one step".into()));
        }
        named("hindsight", self.hindsight.check())
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

fn td3(
    spec: &Spec,
    settings: &Table,
    backend: Backend,
    seed: Seed,
) -> Result<BoxedAgent<Vector, Vector>, ConfigError> {
    let config: FlatTd3Config = section(settings.clone(), "td3")?;
    let mut rng = seed.stream("initialise", 0);
    let learner = Td3::new(scaled(spec), 0, spec.action.len(), &config.policy, backend, &mut rng);
    let capacity = config.memory.capacity;
    Ok(Box::new(Flat::new(Curious::new(learner, config.memory.practice()), capacity)))
}

fn td3_her(
    spec: &Spec,
    settings: &Table,
    backend: Backend,
    seed: Seed,
) -> Result<BoxedAgent<Vector, Vector>, ConfigError> {
    let config: AimedTd3Config = section(settings.clone(), "td3-her")?;
    let AimedTd3Config { memory, policy, hindsight, returns } = &config;
    let practice = Practice::new(Replay::new(memory.capacity).spanning(*returns), memory.pace());
    aimed(spec, hindsight, practice, memory.capacity, |goal| {
        let mut rng = seed.stream("initialise", 0);
        Td3::new(scaled(spec), goal, spec.action.len(), policy, backend, &mut rng)
    })
}

/// A learner alone on its way to the task's goal. `build` makes one that reads goals of so many numbers.
pub(super) fn aimed<L: Learner<Vector, Vector, Region> + 'static>(
    spec: &Spec,
    hindsight: &HindsightConfig,
    practice: Practice<Region>,
    capacity: usize,
    build: impl FnOnce(usize) -> L,
) -> Result<BoxedAgent<Vector, Vector>, ConfigError> {
    let aim = spec.goal.as_ref().and_then(|goal| Some((goal, Ground::over(spec, &goal.dims)?)));
    let Some((goal, ground)) = aim else {
        let why = format!(
            "`{}` has no goal that is a place of bounded dimensions, which this agent goes for; choose a domain with one, \
             such as point-reacher, or the agent `td3`",
            spec.name
        );
        return named("goal", Err(why));
    };
    let tolerance = goal.tolerance;
    let aim = ground.ball(goal.at.clone(), tolerance);
    let achievement = move |s: &Vector| ground.ball(ground.place(s), tolerance);
    let learner = build(aim.width());
    Ok(Box::new(Aimed::new(learner, aim, Box::new(achievement), hindsight.clone(), practice, capacity)))
}
