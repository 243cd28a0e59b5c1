//! Deep skill graphs (thesis chapter 6).

use inroads_agents::{
    Practice, Replay,
    ddpg::{Ddpg, DdpgConfig},
    encode::Encode,
    nets::Backend,
    noise::NoiseConfig,
};
use inroads_discovery::{
    Hierarchy, Shared, SkillPolicy,
    graph::{AbstractMdp, AbstractMdpConfig, DeepGraph, DeepGraphConfig, Dijkstra, Ground, Planner, Region},
    policy::Given,
};
use inroads_envs::{Seed, Spec, maze::Steering};
use serde::{Deserialize, Serialize};
use toml::Table;

use super::{
    AgentEntry, BoxedAgent, Vector,
    initiation::{InitiationConfig, Plan},
    shared::{MemoryConfig, named, scaled, table, tuned_ddpg},
};
use crate::config::{ConfigError, section};

pub(super) const ENTRIES: &[AgentEntry] = &[AgentEntry {
    name: "dsg",
    about: "deep skill graphs (thesis chapter 6): goal regions and options with sets, and plans over them",
    defaults: || table(&DsgConfig::default()),
    check: |t| section::<DsgConfig>(t.clone(), "dsg")?.check(),
    continuous: Some(dsg),
    discrete: None,
    annotated: None,
    pictured: None,
}];

/// Settings of `dsg`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct DsgConfig {
    /// What acts in an option.
    policies: Policies,
    /// What plans.
    planner: Planning,
    memory: MemoryConfig,
    graph: DeepGraphConfig,
    /// For `planner = "abstract_mdp"`.
    process: AbstractMdpConfig,
    /// For `policies = "ddpg"`.
    policy: DdpgConfig,
    initiation: InitiationConfig,
}

/// Option policies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Policies {
    /// A controller that goes straight to a place, written by hand for the point robot.
    Given,
    /// One goal-conditioned DDPG for all.
    Ddpg,
}

/// Planners.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Planning {
    /// The fewest steps (thesis 6.1.3).
    Dijkstra,
    /// Value iteration on the abstract process of chapter 7.
    AbstractMdp,
}

impl Default for DsgConfig {
    fn default() -> Self {
        Self {
            policies: Policies::Given,
            planner: Planning::Dijkstra,
            // Probabilities of edges are counted, so nothing has to be hoped of them.
            process: AbstractMdpConfig { optimism: 0.0, ..AbstractMdpConfig::default() },
            memory: MemoryConfig { warm_up: 1000, updates_per_step: 0.1, ..MemoryConfig::default() },
            graph: DeepGraphConfig::default(),
            policy: goal_ddpg(),
            // The authors keep the newest hundred.
            initiation: InitiationConfig { examples: 100, ..InitiationConfig::default() },
        }
    }
}

/// The main job's DDPG for ways of some tens of steps: smaller, because graphs are made in a minute, and less patient.
fn goal_ddpg() -> DdpgConfig {
    let noise = NoiseConfig { start: 1.0, end: 0.1, decay_steps: 10_000, ..NoiseConfig::default() };
    DdpgConfig {
        hidden: vec![64, 64],
        batch: 128,
        discount: 0.95,
        actor_rate: 1e-3,
        critic_rate: 1e-3,
        noise,
        ..tuned_ddpg()
    }
}

impl DsgConfig {
    fn planner(&self) -> Box<dyn Planner> {
        match self.planner {
            Planning::Dijkstra => Box::new(Dijkstra::default()),
            Planning::AbstractMdp => Box::new(AbstractMdp::new(&self.process)),
        }
    }

    fn check(&self) -> Result<(), ConfigError> {
        named("memory", self.memory.check())?;
        named("graph", self.graph.check())?;
        named("process", self.process.check())?;
        named("policy", self.policy.check())?;
        named("initiation", self.initiation.check())
    }
}

fn dsg(
    spec: &Spec,
    settings: &Table,
    backend: Backend,
    seed: Seed,
) -> Result<BoxedAgent<Vector, Vector>, ConfigError> {
    let config: DsgConfig = section(settings.clone(), "dsg")?;
    let plan = Plan { spec, backend, seed };
    let unfit = |why: &str| ConfigError::Impossible { table: "dsg".into(), why: why.to_owned() };
    let ground = Ground::of(spec)
        .ok_or_else(|| unfit("the domain has no bounded places to draw from; choose one with a map"))?;
    match config.policies {
        Policies::Given => {
            let steering = Steering::of(spec).filter(|_| ground.bounds().len() == 2).ok_or_else(|| {
                unfit("the given controller steers a point robot to x and y; set policies=\"ddpg\"")
            })?;
            let act = move |s: &Vector, goal: &Region| steering.action(s, [goal.at()[0], goal.at()[1]]);
            whole(&plan, &config, ground, Given::new(act))
        }
        Policies::Ddpg => {
            let width = ground.ball(vec![0.0; ground.bounds().len()], config.graph.tolerance).width();
            let mut rng = seed.stream("initialise", 0);
            let learner =
                Ddpg::with_goals(scaled(spec), width, spec.action.len(), &config.policy, backend, &mut rng);
            let replay = Replay::new(config.memory.capacity);
            whole(&plan, &config, ground, Shared::new(learner, Practice::new(replay, config.memory.pace())))
        }
    }
}

fn whole<P>(
    plan: &Plan<'_>,
    config: &DsgConfig,
    ground: Ground,
    policy: P,
) -> Result<BoxedAgent<Vector, Vector>, ConfigError>
where
    P: SkillPolicy<Vector, Vector, Region> + 'static,
{
    let sets = config.initiation.continuous(plan)?;
    let graph = DeepGraph::new(&config.graph, plan.spec, ground, config.planner(), sets, policy);
    Ok(Box::new(Hierarchy::new(graph, config.memory.capacity)))
}
