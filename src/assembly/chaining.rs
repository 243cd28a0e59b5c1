//! Skill chaining (thesis chapter 3), and robust skill chaining (chapter 4).

use inroads_agents::{
    Practice, Replay,
    ddpg::{Ddpg, DdpgConfig},
    dqn::{GrowingConfig, GrowingDqn, Loss},
    experience::Pay,
    nets::Backend,
    tabular::{TabularConfig, TabularQ},
};
use inroads_discovery::{
    ChainConfig, Chaining, Hierarchy, PerSkill, PolicyOverSkills, Shared,
    chain::{States, Subgoals},
    over_skills::{DeepOverSkills, Epsilon, Scan, TabularOverSkills},
};
use inroads_envs::{Seed, Spec};
use serde::{Deserialize, Serialize};
use toml::Table;

use super::{
    AgentEntry, BoxedAgent, Vector,
    initiation::{ClassifierKind, InitiationConfig, Plan},
    shared::{MemoryConfig, choices, named, scaled, table, tuned_ddpg},
};
use crate::config::{ConfigError, section};

pub(super) const ENTRIES: &[AgentEntry] = &[
    AgentEntry {
        name: "dsc",
        about: "deep skill chaining (thesis chapter 3): DDPG option policies, SVM initiation sets, a growing DQN",
        defaults: || table(&DscConfig::default()),
        check: |t| section::<DscConfig>(t.clone(), "dsc")?.check(),
        continuous: Some(dsc),
        discrete: None,
        annotated: None,
        pictured: None,
    },
    AgentEntry {
        name: "dsc-tabular",
        about: "skill chaining with tables and nearest neighbours, for small worlds whose answer is known",
        defaults: || table(&TabularDscConfig::default()),
        check: |t| section::<TabularDscConfig>(t.clone(), "dsc-tabular")?.check(),
        continuous: None,
        discrete: Some(dsc_tabular),
        annotated: None,
        pictured: None,
    },
    AgentEntry {
        name: "robust-dsc-tabular",
        about: "robust skill chaining (thesis chapter 4) with tables: dual sets, one goal-conditioned policy, planned subgoals",
        defaults: || table(&TabularDscConfig::robust()),
        check: |t| section::<TabularDscConfig>(t.clone(), "robust-dsc-tabular")?.check(),
        continuous: None,
        discrete: Some(dsc_tabular),
        annotated: None,
        pictured: None,
    },
];

/// The policy over options as tuned on the Point-Maze: values of −100 are learned within ten thousand decisions.
fn tuned_dqn() -> GrowingConfig {
    let defaults = GrowingConfig::default();
    GrowingConfig { hidden: vec![128, 64], rate: 1e-3, tau: 0.01, loss: Loss::Squared, ..defaults }
}

/// Settings of `dsc`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct DscConfig {
    memory: MemoryConfig,
    policy: DdpgConfig,
    chain: ChainConfig,
    initiation: InitiationConfig,
    over_options: GrowingConfig,
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

/// Settings of `dsc-tabular` and `robust-dsc-tabular`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct TabularDscConfig {
    memory: MemoryConfig,
    policy: TabularConfig,
    chain: ChainConfig,
    initiation: InitiationConfig,
    over_options: OverOptions,
    exploration: Epsilon,
}

/// How a skill is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct OverOptions {
    choose: Choose,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Choose {
    /// By values of the task's reward (3.1.2), exploring as `exploration` says.
    Values,
    /// The first one that may start, from the goal outwards (authors' code of chapter 4).
    Scan,
}

impl Default for TabularDscConfig {
    /// Chapter 3 in worlds of five to a few hundred cells: options of some ten steps.
    fn default() -> Self {
        let defaults = InitiationConfig::default();
        Self {
            memory: MemoryConfig { capacity: 100_000, updates_per_step: 4.0, warm_up: 100 },
            // Small steps, many of them: in the noisy rooms a step of 0.5 makes values, and plans, of chance.
            policy: TabularConfig { rate: 0.1, ..TabularConfig::default() },
            chain: ChainConfig {
                gestation: 3,
                segment: 10,
                initiation_episodes: 5,
                initiation_successes: 3,
                timeout: 60,
                pretrain: 1000,
                goal_first: true,
                ..ChainConfig::default()
            },
            initiation: InitiationConfig { classifier: ClassifierKind::Nearest, examples: 200, ..defaults },
            over_options: OverOptions { choose: Choose::Values },
            exploration: Epsilon { decisions: 2000, ..Epsilon::default() },
        }
    }
}

impl TabularDscConfig {
    /// Chapter 4 in the same worlds.
    fn robust() -> Self {
        let Self { memory, policy, chain, initiation, exploration, .. } = Self::default();
        // One policy learns for all skills, so it learns twice as much.
        let memory = MemoryConfig { updates_per_step: 2.0 * memory.updates_per_step, ..memory };
        Self {
            chain: ChainConfig { subgoals: Subgoals::DynamicProgramming, freeze: false, ..chain },
            initiation: InitiationConfig { sets: "dual".into(), ..initiation },
            over_options: OverOptions { choose: Choose::Scan },
            memory,
            policy,
            exploration,
        }
    }
}

impl DscConfig {
    fn check(&self) -> Result<(), ConfigError> {
        named("memory", self.memory.check())?;
        named("policy", self.policy.check())?;
        named("chain", self.chain.check())?;
        named("chain", self.reads_no_goals())?;
        named("initiation", self.initiation.check())?;
        named("over_options", self.over_options.check())?;
        named("exploration", self.exploration.check())
    }

    fn reads_no_goals(&self) -> Result<(), String> {
        match self.chain.subgoals {
            Subgoals::Set => Ok(()),
            _ => Err("the policies of `dsc` are told no goals; set subgoals = \"set\"".into()),
        }
    }
}

impl TabularDscConfig {
    fn check(&self) -> Result<(), ConfigError> {
        named("memory", self.memory.check())?;
        named("policy", self.policy.check())?;
        named("chain", self.chain.check())?;
        named("initiation", self.initiation.check())?;
        named("exploration", self.exploration.check())
    }
}

fn dsc(
    spec: &Spec,
    settings: &Table,
    backend: Backend,
    seed: Seed,
) -> Result<BoxedAgent<Vector, Vector>, ConfigError> {
    let config: DscConfig = section(settings.clone(), "dsc")?;
    let encoder = scaled(spec);
    let mut rng = seed.stream("initialise", 0);
    let global = Ddpg::new(encoder.clone(), spec.action.len(), &config.policy, backend, &mut rng);
    let values = GrowingDqn::new(encoder.width(), 1, &config.over_options, backend, &mut rng);
    let plan = Plan { spec, backend, seed };
    let initiation = config.initiation.continuous(&plan)?;
    let policy = PerSkill::new(global, Ddpg::fork, config.memory.capacity, config.memory.pace());
    let over = DeepOverSkills::new(encoder, values, config.exploration, config.memory.capacity);
    let chain = Chaining::new(&config.chain, spec, initiation, policy, over);
    Ok(Box::new(Hierarchy::new(chain, config.memory.capacity)))
}

fn dsc_tabular(
    spec: &Spec,
    settings: &Table,
    backend: Backend,
    seed: Seed,
) -> Result<BoxedAgent<Vector, usize>, ConfigError> {
    let plan = Plan { spec, backend, seed };
    let config: TabularDscConfig = section(settings.clone(), "dsc-tabular")?;
    match config.over_options.choose {
        Choose::Values => {
            tabular(&plan, &config, TabularOverSkills::new(config.policy.rate, config.exploration))
        }
        Choose::Scan => tabular(&plan, &config, Scan),
    }
}

fn tabular(
    plan: &Plan<'_>,
    config: &TabularDscConfig,
    over: impl PolicyOverSkills<Vector> + 'static,
) -> Result<BoxedAgent<Vector, usize>, ConfigError> {
    let MemoryConfig { capacity, .. } = config.memory;
    let spec = plan.spec;
    let initiation = config.initiation.discrete(plan)?;
    let global = TabularQ::new(choices(spec), &config.policy);
    if config.chain.subgoals == Subgoals::Set {
        let policy = PerSkill::new(global, TabularQ::clone, capacity, config.memory.pace());
        let chain = Chaining::new(&config.chain, spec, initiation, policy, over);
        return Ok(Box::new(Hierarchy::new(chain, capacity)));
    }
    let replay = Replay::new(capacity).paying(Pay::ATTAINMENT);
    let policy = Shared::new(global, Practice::new(replay, config.memory.pace()));
    let aim = States { features: spec.place.clone(), tolerance: config.chain.tolerance };
    let chain = Chaining::new(&config.chain, spec, initiation, policy, over).aiming(aim);
    Ok(Box::new(Hierarchy::new(chain, capacity)))
}
