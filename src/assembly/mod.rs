//! Which agents there are, and how each is put together from its settings.
//!
//! A table, not a plug-in system: one entry an agent, one constructor a kind of observation and action. So agents
//! compile once a kind, and a pair that does not fit is an error that names the ones that do. The entries stand beside
//! the constructors, a file a family of agents.

mod abstracting;
mod actor_critic;
mod chaining;
mod curious;
mod deep_graphs;
mod deep_q;
mod flat;
pub mod graphs;
mod initiation;
mod kinds;
mod model_based;
pub mod parts;
mod proto;
mod recurrent;
mod robust;
mod shared;
mod suits;

use inroads_agents::nets::Backend;
use inroads_discovery::Skilled;
use inroads_envs::{
    Annotated, Frame, Seed, Spec,
    registry::{self, Options, nearest},
    world::Layout,
};
use toml::Table;

pub use suits::suits;

use crate::config::ConfigError;

/// Vectors seen.
pub type Vector = Vec<f32>;
/// An agent for observations of type `O` and actions of type `A`.
pub type BoxedAgent<O, A> = Box<dyn Skilled<O, A>>;

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
    pub continuous: Option<Build<Vector, Vector>>,
    /// Builds it for choices.
    pub discrete: Option<Build<Vector, usize>>,
    /// Builds it for choices where it is told which proto-goals hold (chapter 8). A run's environment tells them to
    /// agents that have this constructor alone.
    pub annotated: Option<Build<Annotated<Vector>, usize>>,
    /// Builds it for choices where it sees pictures.
    pub pictured: Option<Build<Frame, usize>>,
}

/// Builds an agent from a domain's spec and checked settings.
pub type Build<O, A> = fn(&Spec, &Table, Backend, Seed) -> Result<BoxedAgent<O, A>, ConfigError>;

/// All agents, in the order in which they are listed.
pub fn agents() -> impl Iterator<Item = &'static AgentEntry> {
    [
        chaining::ENTRIES,
        robust::ENTRIES,
        deep_graphs::ENTRIES,
        graphs::ENTRIES,
        proto::ENTRIES,
        abstracting::ENTRIES,
        actor_critic::ENTRIES,
        flat::ENTRIES,
        curious::ENTRIES,
        deep_q::ENTRIES,
        recurrent::ENTRIES,
        model_based::ENTRIES,
    ]
    .into_iter()
    .flatten()
}

/// Agents that tell every layout apart and carry nothing over from one to another. Their runs keep to one layout unless
/// they are told otherwise, as the authors' do in chapters 7 and 9.
const ONE_LAYOUT: &[&str] = &["im-dsg", "abstract-subgoals"];

/// The layouts that runs of this agent have in that environment unless they are told otherwise: the author's seed for agents
/// that need one layout, else the environment's own (an empty word).
pub fn usual_layout(agent: &str, environment: &str) -> &'static str {
    let options = Options { layout: Some(Layout::Fixed(42)), ..Options::default() };
    let one = ONE_LAYOUT.contains(&agent) && registry::make_with(environment, &options).is_ok();
    if one { "fixed:42" } else { "" }
}

/// The entry of that name.
///
/// # Errors
/// [`ConfigError::UnknownName`] with the nearest name.
pub fn agent(name: &str) -> Result<&'static AgentEntry, ConfigError> {
    agents().find(|entry| entry.name == name).ok_or_else(|| {
        let nearest = nearest(name, agents().map(|entry| entry.name)).unwrap_or_default();
        let all: Vec<_> = agents().map(|entry| entry.name).collect();
        let all = all.join(", ");
        ConfigError::UnknownName(format!(
            "there is no agent `{name}`; did you mean `{nearest}`? All agents: {all}"
        ))
    })
}
