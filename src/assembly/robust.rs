//! Robust skill chaining (thesis chapter 4) on TD3, model-free and model-based, and what its parts are compared with.

use inroads_agents::{
    Encode, Learner, Practice, Replay,
    experience::Pay,
    goal::{Ground, Region},
    mpc::{Planned, PlannedConfig, Reward},
    nets::Backend,
    td3::{Td3, Td3Config},
};
use inroads_discovery::{
    ChainConfig, Chaining, Hierarchy, PerSkill, Shared,
    chain::{ChainAt, Explore, Lessons, OptionReward, Places, Subgoals},
    over_skills::Scan,
};
use inroads_envs::{Seed, Spec};
use serde::{Deserialize, Serialize};
use toml::Table;

use super::{
    AgentEntry, BoxedAgent, Vector,
    initiation::{InitiationConfig, Plan},
    model_based::{Frame, view},
    shared::{MemoryConfig, named, scaled, table},
};
use crate::config::{ConfigError, section};

pub(super) const ENTRIES: &[AgentEntry] = &[AgentEntry {
    name: "robust-dsc",
    about: "robust skill chaining (thesis chapter 4): dual sets, one TD3 policy that reads subgoals, or plans on a learned model",
    defaults: || table(&RobustConfig::default()),
    check: |t| section::<RobustConfig>(t.clone(), "robust-dsc")?.check(),
    continuous: Some(robust),
    discrete: None,
    annotated: None,
    pictured: None,
}];

/// Settings of `robust-dsc`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct RobustConfig {
    memory: MemoryConfig,
    policy: Td3Config,
    control: ControlConfig,
    chain: ChainConfig,
    initiation: InitiationConfig,
}

/// Who chooses actions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct ControlConfig {
    /// Whether actions are planned on a learned model (4.1.3); else they are TD3's.
    model: bool,
    /// In which frame the model reads states.
    frame: Frame,
    /// The model and its planner.
    plans: PlannedConfig,
}

impl Default for ControlConfig {
    fn default() -> Self {
        Self { model: true, frame: Frame::default(), plans: PlannedConfig::default() }
    }
}

impl Default for RobustConfig {
    fn default() -> Self {
        Self {
            memory: MemoryConfig { capacity: 300_000, updates_per_step: 0.5, warm_up: 10_000 },
            policy: Td3Config { discount: 0.98, random: 0.2, ..Td3Config::default() },
            control: ControlConfig::default(),
            chain: ChainConfig {
                gestation: 5,
                segment: 50,
                initiation_episodes: 3,
                initiation_successes: 3,
                timeout: 200,
                chain_at: ChainAt::InitiationEnd,
                option_reward: OptionReward::Dense,
                lessons: Lessons::Own,
                pretrain: 0,
                subgoals: Subgoals::Sample,
                explore: Explore::Events,
                freeze: false,
                ..ChainConfig::default()
            },
            initiation: InitiationConfig {
                sets: "dual".into(),
                examples: 300,
                ..InitiationConfig::default()
            },
        }
    }
}

impl RobustConfig {
    fn check(&self) -> Result<(), ConfigError> {
        named("memory", self.memory.check())?;
        named("policy", self.policy.check())?;
        named("control.plans", self.control.plans.check())?;
        named("control", self.plans_for_goals())?;
        named("chain", self.chain.check())?;
        named("initiation", self.initiation.check())
    }

    fn plans_for_goals(&self) -> Result<(), String> {
        let ControlConfig { model, plans, .. } = &self.control;
        if *model && self.chain.subgoals == Subgoals::Set {
            return Err("model is true, and plans lead to states, of which chain.subgoals = \"set\" tells none; set model = \
                        false, or chain.subgoals = \"sample\""
                .into());
        }
        let same = match plans.reward {
            Reward::Dense => OptionReward::Dense,
            Reward::Sparse => OptionReward::Sparse,
        };
        if *model && plans.values && self.chain.option_reward != same {
            return Err("plans.values are what chain.option_reward pays in the long run, and plans.reward is of the other kind; set \
                        both to \"dense\" or both to \"sparse\", or plans.values = false"
                .into());
        }
        Ok(())
    }
}

fn robust(
    spec: &Spec,
    settings: &Table,
    backend: Backend,
    seed: Seed,
) -> Result<BoxedAgent<Vector, Vector>, ConfigError> {
    let config: RobustConfig = section(settings.clone(), "robust-dsc")?;
    let mut rng = seed.stream("initialise", 0);
    let actions = spec.action.len();
    let initiation = config.initiation.continuous(&Plan { spec, backend, seed })?;
    let mut td3 = |goal| Td3::new(scaled(spec), goal, actions, &config.policy, backend, &mut rng);
    let (capacity, pace) = (config.memory.capacity, config.memory.pace());
    if config.chain.subgoals == Subgoals::Set {
        let policy = PerSkill::new(td3(0), Td3::clone, capacity, pace);
        let chain = Chaining::new(&config.chain, spec, initiation, policy, Scan);
        return Ok(Box::new(Hierarchy::new(chain, capacity)));
    }
    let places = places(spec, &config)?;
    let width = places.ground.ball(vec![0.0; spec.place.len()], 0.0).width();
    let td3 = td3(width);
    let practice = Practice::new(Replay::new(capacity).paying(Pay::COST), pace);
    if !config.control.model {
        return Ok(chained(&config, spec, initiation, Shared::new(td3, practice), places));
    }
    let view = view(spec, config.control.frame);
    let mut rng = seed.stream("initialise", 3);
    let planned = Planned::new(td3, view, actions, &config.control.plans, backend, &mut rng);
    Ok(chained(&config, spec, initiation, Shared::new(planned, practice), places))
}

/// Where one may be sent.
fn places(spec: &Spec, config: &RobustConfig) -> Result<Places, ConfigError> {
    let Some(ground) = Ground::of(spec) else {
        let why = format!(
            "policies are told places, and `{}` has none of known bounds; choose a maze, or set chain.subgoals = \"set\", \
             chain.explore = \"task\" and control.model = false",
            spec.name
        );
        return named("chain", Err(why));
    };
    let goal = spec.goal.as_ref().filter(|goal| goal.dims == spec.place);
    let task = goal.map(|goal| ground.ball(goal.at.clone(), goal.tolerance));
    Ok(Places { ground, tolerance: config.chain.tolerance, task, discount: config.policy.discount })
}

fn chained<L: Learner<Vector, Vector, Region> + 'static>(
    config: &RobustConfig,
    spec: &Spec,
    initiation: super::initiation::Sets<Vector>,
    policy: Shared<L, Region>,
    places: Places,
) -> BoxedAgent<Vector, Vector> {
    let chain = Chaining::new(&config.chain, spec, initiation, policy, Scan).aiming(places);
    Box::new(Hierarchy::new(chain, config.memory.capacity))
}
