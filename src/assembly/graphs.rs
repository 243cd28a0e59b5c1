//! Skill graphs on tables (thesis chapter 7 in small).

use inroads_agents::{
    Curious, Pace, Practice, Replay,
    experience::Pay,
    nets::Backend,
    tabular::{TabularConfig, TabularQ},
};
use inroads_discovery::{
    Features, GraphExplorer, Hierarchy, Shared,
    frontier::Novel,
    graph::{AbstractMdpConfig, ExplorerConfig},
    naming::{CounterfactualConfig, Name},
};
use inroads_envs::{Seed, Spec};
use serde::{Deserialize, Serialize};

use super::{
    AgentEntry, BoxedAgent, Vector,
    flat::bonus_table,
    parts::{NamingKind, NoveltyConfig, PlannerKind},
    shared::{choices, named, table},
};
use crate::config::{ConfigError, section};

pub(super) const ENTRIES: &[AgentEntry] = &[AgentEntry {
    name: "im-dsg",
    about: "intrinsically motivated skill graphs (thesis chapter 7) on tables and counts",
    defaults: || table(&ImDsgConfig::default()),
    check: |t| section::<ImDsgConfig>(t.clone(), "im-dsg")?.check(),
    continuous: None,
    discrete: Some(|spec, settings, backend, seed| {
        let config: ImDsgConfig = section(settings.clone(), "im-dsg")?;
        let agent: BoxedAgent<Vector, usize> = Box::new(im_dsg(spec, &config, backend, seed)?);
        Ok(agent)
    }),
    annotated: None,
    pictured: None,
}];

/// IM-DSG on tables.
pub type ImDsg = Hierarchy<
    Vector,
    usize,
    GraphExplorer<Features, Shared<TabularQ, Features>, Novel<Vector, TabularQ, Namer>>,
>;

/// Makes goals of what is seen.
type Namer = Box<dyn Name<Vector, Features>>;

/// Settings of `im-dsg`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ImDsgConfig {
    /// Steps of the environment that are remembered.
    pub capacity: usize,
    /// The graph and who builds it.
    pub explorer: ExplorerConfig,
    /// Who plans.
    pub planner: PlannerKind,
    /// The abstract process, for the planner of that name.
    pub abstract_mdp: AbstractMdpConfig,
    /// What is new, and when that makes a vertex.
    pub novelty: NoveltyConfig,
    /// What a vertex's goal is made of.
    pub naming: NamingKind,
    /// Of the naming by counterfactuals.
    pub counterfactuals: CounterfactualConfig,
    /// π_g and V_g: one table for the skills of all vertices.
    pub skills: LearnerConfig,
    /// π_novelty and V_novelty.
    pub frontier: LearnerConfig,
}

impl Default for ImDsgConfig {
    fn default() -> Self {
        // γ to the horizon is 0.9: a value is the probability of success, less a tenth at most (`decisions.md`).
        let skills = TabularConfig { discount: 0.995, batch: 16, ..TabularConfig::default() };
        Self {
            capacity: 100_000,
            explorer: ExplorerConfig::default(),
            planner: PlannerKind::AbstractMdp,
            abstract_mdp: AbstractMdpConfig::default(),
            novelty: NoveltyConfig::default(),
            naming: NamingKind::Whole,
            counterfactuals: CounterfactualConfig::default(),
            skills: LearnerConfig { table: skills, ..LearnerConfig::default() },
            // The best of one, three and five (`docs/results/small.md`).
            frontier: LearnerConfig { table: bonus_table(), returns: 1, ..LearnerConfig::default() },
        }
    }
}

/// A table, and what it learns from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LearnerConfig {
    /// The table.
    pub table: TabularConfig,
    /// Steps of returns.
    pub returns: u32,
    /// Steps of lessons that are kept.
    pub replay: usize,
    /// Minibatch updates for each step of the environment.
    pub updates_per_step: f32,
}

impl Default for LearnerConfig {
    fn default() -> Self {
        Self { table: TabularConfig::default(), returns: 5, replay: 100_000, updates_per_step: 1.0 }
    }
}

impl LearnerConfig {
    /// A full minibatch is all that is waited for.
    fn pace(&self) -> Pace {
        Pace { updates_per_step: self.updates_per_step, warm_up: self.table.batch }
    }

    fn check(&self) -> Result<(), String> {
        self.table.check()?;
        if self.replay == 0 || self.returns == 0 {
            return Err("replay and returns must be at least 1".into());
        }
        if !(self.updates_per_step.is_finite() && self.updates_per_step >= 0.0) {
            return Err(format!("updates_per_step is {}; it must be 0 or above", self.updates_per_step));
        }
        Ok(())
    }
}

impl ImDsgConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// [`ConfigError`] names the table, the setting and the mend.
    pub fn check(&self) -> Result<(), ConfigError> {
        if self.capacity == 0 {
            return named("im-dsg", Err("capacity is 0; at least one step must be remembered".into()));
        }
        named("explorer", self.explorer.check())?;
        named("abstract_mdp", self.abstract_mdp.check())?;
        named("novelty", self.novelty.check())?;
        named("counterfactuals", self.counterfactuals.check())?;
        named("skills", self.skills.check())?;
        named("frontier", self.frontier.check())
    }
}

/// Builds IM-DSG for a domain whose symbols tell states apart. Backend and seed are those of networks that say what is
/// new, where the settings have such.
///
/// # Errors
/// [`ConfigError`] when what is to be counted cannot be in this domain.
pub fn im_dsg(spec: &Spec, config: &ImDsgConfig, backend: Backend, seed: Seed) -> Result<ImDsg, ConfigError> {
    let ImDsgConfig { skills, frontier, novelty, .. } = config;
    let table = |learner: &LearnerConfig| TabularQ::new(choices(spec), &learner.table);
    let replay = Replay::new(skills.replay).paying(Pay::ATTAINMENT).spanning(skills.returns);
    let policy = Shared::new(table(skills), Practice::new(replay, skills.pace()));
    let practice = Practice::new(Replay::new(frontier.replay).spanning(frontier.returns), frontier.pace());
    let curious = Curious::new(table(frontier), practice)
        .sober(table(frontier))
        .with_novelty(novelty.build(spec, backend, seed)?, novelty.weight)
        .centred(novelty.centred);
    let frontier = Novel::new(curious, config.naming.build(&config.counterfactuals), novelty.threshold);
    let planner = |optimistic| config.planner.build(&config.abstract_mdp, optimistic);
    let explorer =
        GraphExplorer::new(&config.explorer, planner(true), policy, frontier).sober(planner(false));
    Ok(Hierarchy::new(explorer, config.capacity))
}
