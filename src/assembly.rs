//! Which agents there are, and how each is put together from its settings.
//!
//! A table, not a plug-in system: one entry an agent, one constructor a kind of observation and action. So agents
//! compile once a kind, and a pair that does not fit is an error that names the ones that do.

use std::sync::Arc;

use inroads_agents::{
    Encoder, Flat, Pace,
    classify::{Nearest, Svm, SvmConfig},
    ddpg::{Ddpg, DdpgConfig},
    dqn::{DqnConfig, GrowingDqn, Loss},
    encode::{Scaled, Select},
    nets::Backend,
    noise::NoiseConfig,
    tabular::{TabularConfig, TabularQ},
};
use inroads_discovery::{
    Binary, ChainConfig, Chaining, Hierarchy, PerSkill, Skilled,
    over_skills::{DeepOverSkills, Epsilon, TabularOverSkills},
};
use inroads_envs::{Seed, Spec, registry::nearest};
use serde::{Deserialize, Serialize};
use toml::Table;

use crate::config::{ConfigError, section};

/// Vectors seen.
pub type Vector = Vec<f32>;
/// An agent for actions of type `A`.
pub type BoxedAgent<A> = Box<dyn Skilled<Vector, A>>;

/// An agent's entry in the table.
pub struct AgentEntry {
    /// Its name.
    pub name: &'static str,
    /// One sentence for `inroads list`.
    pub about: &'static str,
    /// Its settings with their defaults.
    pub defaults: fn() -> Table,
    /// Names the first impossible value.
    pub check: fn(&Table) -> Result<(), ConfigError>,
    /// Builds it for continuous actions.
    pub continuous: Option<Build<Vec<f32>>>,
    /// Builds it for choices.
    pub discrete: Option<Build<usize>>,
}

/// Builds an agent from a domain's spec and checked settings.
pub type Build<A> = fn(&Spec, &Table, Backend, Seed) -> Result<BoxedAgent<A>, ConfigError>;

/// All agents.
pub const AGENTS: &[AgentEntry] = &[
    AgentEntry {
        name: "dsc",
        about: "deep skill chaining (thesis chapter 3): DDPG option policies, SVM initiation sets, a growing DQN",
        defaults: || table(&DscConfig::default()),
        check: |t| section::<DscConfig>(t.clone(), "dsc")?.check(),
        continuous: Some(dsc),
        discrete: None,
    },
    AgentEntry {
        name: "ddpg",
        about: "the flat baseline: one DDPG policy for the whole task",
        defaults: || table(&FlatDdpgConfig::default()),
        check: |t| section::<FlatDdpgConfig>(t.clone(), "ddpg")?.check(),
        continuous: Some(ddpg),
        discrete: None,
    },
    AgentEntry {
        name: "dsc-tabular",
        about: "skill chaining with tables and nearest neighbours, for small worlds whose answer is known",
        defaults: || table(&TabularDscConfig::default()),
        check: |t| section::<TabularDscConfig>(t.clone(), "dsc-tabular")?.check(),
        continuous: None,
        discrete: Some(dsc_tabular),
    },
    AgentEntry {
        name: "q-learning",
        about: "the flat tabular baseline",
        defaults: || table(&FlatTabularConfig::default()),
        check: |t| section::<FlatTabularConfig>(t.clone(), "q-learning").map(drop),
        continuous: None,
        discrete: Some(q_learning),
    },
];

/// The entry of that name.
///
/// # Errors
/// [`ConfigError::UnknownName`] with the nearest name.
pub fn agent(name: &str) -> Result<&'static AgentEntry, ConfigError> {
    AGENTS.iter().find(|entry| entry.name == name).ok_or_else(|| {
        let nearest = nearest(name, AGENTS.iter().map(|entry| entry.name)).unwrap_or_default();
        let all: Vec<_> = AGENTS.iter().map(|entry| entry.name).collect();
        let all = all.join(", ");
        ConfigError::UnknownName(format!(
            "there is no agent `{name}`; did you mean `{nearest}`? All agents: {all}"
        ))
    })
}

/// What a learner learns from, and how much.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct MemoryConfig {
    /// Steps remembered (authors: 1e6).
    capacity: usize,
    /// Minibatch updates of a policy for each step that it is trained on (authors: 1).
    updates_per_step: f32,
    /// Steps of noise before the first update of the policy for the whole task.
    warm_up: usize,
}

impl Default for MemoryConfig {
    fn default() -> Self {
        Self { capacity: 1_000_000, updates_per_step: 1.0, warm_up: 5000 }
    }
}

impl MemoryConfig {
    fn pace(&self) -> Pace {
        Pace { updates_per_step: self.updates_per_step, warm_up: self.warm_up }
    }

    fn check(&self) -> Result<(), String> {
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
fn tuned_ddpg() -> DdpgConfig {
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

/// The policy over options as tuned on the Point-Maze: values of −100 are learned within ten thousand decisions.
fn tuned_dqn() -> DqnConfig {
    let defaults = DqnConfig::default();
    DqnConfig { hidden: vec![128, 64], rate: 1e-3, tau: 0.01, loss: Loss::Squared, ..defaults }
}

/// Settings of `dsc`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct DscConfig {
    memory: MemoryConfig,
    policy: DdpgConfig,
    chain: ChainConfig,
    initiation: InitiationConfig,
    over_options: DqnConfig,
    exploration: Epsilon,
}

impl Default for DscConfig {
    fn default() -> Self {
        Self {
            memory: MemoryConfig::default(),
            policy: tuned_ddpg(),
            chain: ChainConfig::default(),
            initiation: InitiationConfig::default(),
            over_options: tuned_dqn(),
            exploration: Epsilon::default(),
        }
    }
}

/// Settings of initiation sets.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct InitiationConfig {
    /// Examples of either class that a skill remembers.
    examples: usize,
    /// The classifier.
    svm: SvmConfig,
}

impl Default for InitiationConfig {
    fn default() -> Self {
        Self { examples: 500, svm: SvmConfig::default() }
    }
}

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

/// Settings of `dsc-tabular`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct TabularDscConfig {
    memory: MemoryConfig,
    policy: TabularConfig,
    chain: ChainConfig,
    initiation: NearestConfig,
    exploration: Epsilon,
}

/// Settings of sets around examples.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct NearestConfig {
    /// Examples of either class that a skill remembers.
    examples: usize,
    /// Greatest distance from a positive example.
    radius: f32,
}

impl Default for NearestConfig {
    fn default() -> Self {
        Self { examples: 500, radius: 0.5 }
    }
}

/// Settings of `q-learning`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct FlatTabularConfig {
    memory: MemoryConfig,
    policy: TabularConfig,
}

impl DscConfig {
    fn check(&self) -> Result<(), ConfigError> {
        named("memory", self.memory.check())?;
        named("policy", self.policy.check())?;
        named("chain", self.chain.check())?;
        named("initiation.svm", self.initiation.svm.check().map_err(|e| e.to_string()))?;
        named("over_options", self.over_options.check())?;
        named("exploration", self.exploration.check())
    }
}

impl FlatDdpgConfig {
    fn check(&self) -> Result<(), ConfigError> {
        named("memory", self.memory.check())?;
        named("policy", self.policy.check())
    }
}

impl TabularDscConfig {
    fn check(&self) -> Result<(), ConfigError> {
        named("memory", self.memory.check())?;
        named("chain", self.chain.check())?;
        named("exploration", self.exploration.check())
    }
}

fn named(table: &str, checked: Result<(), String>) -> Result<(), ConfigError> {
    checked.map_err(|why| ConfigError::Impossible { table: table.to_owned(), why })
}

fn table(config: &impl Serialize) -> Table {
    Table::try_from(config).expect("settings are plain values")
}

fn scaled(spec: &Spec) -> Arc<dyn Encoder<Vector> + Send + Sync> {
    Arc::new(Scaled::new(&spec.observation))
}

/// Where one is, as numbers of the domain: what initiation sets are learned on (authors: x and y).
fn place(spec: &Spec) -> Arc<dyn Encoder<Vector> + Send + Sync> {
    Arc::new(Select::new(&spec.place))
}

fn dsc(
    spec: &Spec,
    settings: &Table,
    backend: Backend,
    seed: Seed,
) -> Result<BoxedAgent<Vec<f32>>, ConfigError> {
    let config: DscConfig = section(settings.clone(), "dsc")?;
    let encoder = scaled(spec);
    let mut rng = seed.stream("initialise", 0);
    let global = Ddpg::new(encoder.clone(), spec.action.len(), &config.policy, backend, &mut rng);
    let values = GrowingDqn::new(encoder.width(), 1, &config.over_options, backend, &mut rng);
    let initiation =
        Binary::new(place(spec), Svm::new(config.initiation.svm.clone()), config.initiation.examples);
    let policy = PerSkill::new(global, Ddpg::fork, config.memory.capacity, config.memory.pace());
    let over = DeepOverSkills::new(encoder, values, config.exploration, config.memory.capacity);
    let chain = Chaining::new(&config.chain, spec, initiation, policy, over);
    Ok(Box::new(Hierarchy::new(chain, config.memory.capacity)))
}

fn ddpg(
    spec: &Spec,
    settings: &Table,
    backend: Backend,
    seed: Seed,
) -> Result<BoxedAgent<Vec<f32>>, ConfigError> {
    let config: FlatDdpgConfig = section(settings.clone(), "ddpg")?;
    let mut rng = seed.stream("initialise", 0);
    let learner = Ddpg::new(scaled(spec), spec.action.len(), &config.policy, backend, &mut rng);
    Ok(Box::new(Flat::new(learner, config.memory.capacity, config.memory.pace())))
}

fn dsc_tabular(spec: &Spec, settings: &Table, _: Backend, _: Seed) -> Result<BoxedAgent<usize>, ConfigError> {
    let config: TabularDscConfig = section(settings.clone(), "dsc-tabular")?;
    let global = TabularQ::new(choices(spec), &config.policy);
    let initiation =
        Binary::new(place(spec), Nearest::new(config.initiation.radius), config.initiation.examples);
    let policy = PerSkill::new(global, TabularQ::clone, config.memory.capacity, config.memory.pace());
    let over = TabularOverSkills::new(config.policy.rate, config.exploration);
    let chain = Chaining::new(&config.chain, spec, initiation, policy, over);
    Ok(Box::new(Hierarchy::new(chain, config.memory.capacity)))
}

fn q_learning(spec: &Spec, settings: &Table, _: Backend, _: Seed) -> Result<BoxedAgent<usize>, ConfigError> {
    let config: FlatTabularConfig = section(settings.clone(), "q-learning")?;
    let learner = TabularQ::new(choices(spec), &config.policy);
    Ok(Box::new(Flat::new(learner, config.memory.capacity, config.memory.pace())))
}

fn choices(spec: &Spec) -> usize {
    match &spec.action {
        inroads_envs::Space::Discrete(n) => *n,
        other => other.len(),
    }
}
