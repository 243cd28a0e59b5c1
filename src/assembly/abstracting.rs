//! Abstract subgoals by counterfactuals (thesis chapter 9).

use inroads_agents::{
    Curious, Pace, Practice, Replay, TabularQ, experience::Pay, nets::Backend, tabular::TabularConfig,
};
use inroads_discovery::{
    Abstracting, AbstractingConfig, Features, GraphExplorer, Hierarchy, Shared,
    frontier::Novel,
    graph::{AbstractMdpConfig, ExplorerConfig},
    naming::CounterfactualConfig,
    over_skills::{Epsilon, TabularOverSkills},
};
use inroads_envs::{Seed, Spec};
use serde::{Deserialize, Serialize};
use toml::Table;

use super::{
    AgentEntry, BoxedAgent, Vector,
    parts::{NamingKind, NoveltyConfig, NoveltyKind, PlannerKind},
    shared::{MemoryConfig, choices, named, table},
};
use crate::config::{ConfigError, section};

pub(super) const ENTRIES: &[AgentEntry] = &[AgentEntry {
    name: "abstract-subgoals",
    about: "subgoals of the few features that made a state novel (thesis chapter 9), with tables",
    defaults: || table(&AbstractConfig::default()),
    check: |t| section::<AbstractConfig>(t.clone(), "abstract-subgoals")?.check(),
    continuous: None,
    discrete: Some(abstract_subgoals),
    annotated: None,
    pictured: None,
}];

/// Settings of `abstract-subgoals`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct AbstractConfig {
    memory: MemoryConfig,
    /// Of the options' policy, which reads its subgoal.
    policy: TabularConfig,
    /// Of the policy for the task, and its share of random actions.
    task: TabularConfig,
    behaviour: AbstractingConfig,
    /// Of the policy over options, whose step size is the task's.
    over_options: Epsilon,
    explorer: ExplorerConfig,
    planner: PlannerKind,
    /// The abstract process, for the planner of that name.
    abstract_mdp: AbstractMdpConfig,
    /// What is new, and when that makes a subgoal.
    novelty: NoveltyConfig,
    /// Of the policy that explores.
    frontier: TabularConfig,
    /// What a subgoal is made of.
    naming: NamingKind,
    /// Of the naming by counterfactuals.
    counterfactuals: CounterfactualConfig,
}

impl Default for AbstractConfig {
    fn default() -> Self {
        Self {
            memory: MemoryConfig { capacity: 100_000, updates_per_step: 4.0, warm_up: 0 },
            policy: TabularConfig { discount: 0.95, ..TabularConfig::default() },
            task: TabularConfig::default(),
            behaviour: AbstractingConfig::default(),
            over_options: Epsilon { start: 1.0, end: 0.05, decisions: 1000 },
            explorer: ExplorerConfig { explore_for: 20, max_vertices: 40, ..ExplorerConfig::default() },
            planner: PlannerKind::Direct,
            abstract_mdp: AbstractMdpConfig::default(),
            novelty: NoveltyConfig {
                counts: NoveltyKind::Features,
                centred: false,
                ..NoveltyConfig::default()
            },
            frontier: TabularConfig { discount: 0.95, ..TabularConfig::default() },
            naming: NamingKind::Counterfactual,
            counterfactuals: CounterfactualConfig::default(),
        }
    }
}

impl AbstractConfig {
    fn check(&self) -> Result<(), ConfigError> {
        named("memory", self.memory.check())?;
        named("policy", self.policy.check())?;
        named("task", self.task.check())?;
        named("behaviour", self.behaviour.check())?;
        named("over_options", self.over_options.check())?;
        named("explorer", self.explorer.check())?;
        named("abstract_mdp", self.abstract_mdp.check())?;
        named("novelty", self.novelty.check())?;
        named("frontier", self.frontier.check())?;
        named("counterfactuals", self.counterfactuals.check())
    }
}

fn abstract_subgoals(
    spec: &Spec,
    settings: &Table,
    backend: Backend,
    seed: Seed,
) -> Result<BoxedAgent<Vector, usize>, ConfigError> {
    let config: AbstractConfig = section(settings.clone(), "abstract-subgoals")?;
    let (actions, capacity) = (choices(spec), config.memory.capacity);
    let pace: Pace = config.memory.pace();
    let practice = || Practice::new(Replay::new(capacity), pace);
    let curious = Curious::new(TabularQ::new(actions, &config.frontier), practice())
        .with_novelty(config.novelty.build(spec, backend, seed)?, config.novelty.weight)
        .centred(config.novelty.centred);
    let frontier =
        Novel::new(curious, config.naming.build(&config.counterfactuals), config.novelty.threshold);
    let replay = Replay::new(capacity).paying(Pay::ATTAINMENT);
    let policy: Shared<_, Features> =
        Shared::new(TabularQ::new(actions, &config.policy), Practice::new(replay, pace));
    let planner = |optimistic| config.planner.build(&config.abstract_mdp, optimistic);
    let explorer =
        GraphExplorer::new(&config.explorer, planner(true), policy, frontier).sober(planner(false));
    let task = Curious::new(TabularQ::new(actions, &config.task), practice());
    let over = TabularOverSkills::new(config.task.rate, config.over_options);
    let method = Abstracting::new(&config.behaviour, explorer, task, over);
    Ok(Box::new(Hierarchy::new(method, capacity)))
}
