//! Markov decision processes: observation, action, reward, end of episode and start distribution, one file a
//! domain.
//!
//! This room knows nothing of tensors, learners or options. What an agent may know of a domain is the *data*
//! in its [`Spec`], never a method, so agents compile once for each kind of observation and action rather
//! than once for each domain.

#[cfg(test)]
extern crate self as inroads_envs;

pub mod ant_run;
pub mod baba;
mod capability;
pub mod certificate;
pub mod check;
pub mod corridor;
mod goals;
pub mod grid;
pub mod limit;
pub mod manipulation;
pub mod maze;
pub mod montezuma;
mod observation;
pub mod pinball;
pub mod probes;
pub mod reacher;
pub mod recall;
pub mod registry;
mod render;
pub mod river;
mod rng;
pub mod rooms;
pub mod sokoban;
mod spec;
pub mod taxi;
pub mod vector;
pub mod visual_grid;
pub mod visual_taxi;
pub mod world;

pub use capability::{Limited, Snapshot, Sweep};
pub use goals::{GoalError, Goals, Pay};
pub use limit::TimeLimit;
pub use observation::{Annotated, Bits};
pub use render::{Domain, Drawing, Render};
pub use rng::{Rng, Seed};
pub use spec::{Dimension, Goal, Kind, Space, Spec};
pub use world::ProtoGoals;

pub use inroads_sim::raster::Frame;

/// How an episode ended. The two are never one flag: a learner bootstraps past a truncation and never past a
/// termination.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum End {
    /// The task itself ended: nothing follows, the value of what comes next is zero.
    Terminated,
    /// Somebody stopped watching (a time limit, say): the task would have gone on.
    Truncated,
}

/// What an environment answers to an action.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// The reward of this transition.
    pub reward: f32,
    /// `None` while the episode goes on. When both ends fall on one step, termination wins.
    pub end: Option<End>,
}

/// An action that an environment did not carry out. The environment is as it was before the call.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refused {
    /// The action has the wrong number of components.
    #[error("action has {found} components where {expected} are needed; see the action space of the spec")]
    Shape {
        /// Components that the action space has.
        expected: usize,
        /// Components that were given.
        found: usize,
    },
    /// A component is NaN or infinite.
    #[error("action component {index} is {value}; actions must be finite numbers")]
    NotFinite {
        /// Which component.
        index: usize,
        /// Its value.
        value: f32,
    },
    /// A component lies outside the action space.
    #[error("action component {index} is {value}, outside [{low}, {high}]; clip it to the action space")]
    OutOfRange {
        /// Which component.
        index: usize,
        /// Its value.
        value: f32,
        /// Least legal value.
        low: f32,
        /// Greatest legal value.
        high: f32,
    },
    /// `step` was called before the first `reset`, or after the episode had ended.
    #[error("the episode is over (or was never begun); call reset before step")]
    Over,
}

/// A domain: everything about it that an episode needs.
///
/// `(seed, actions)` is a whole episode: the environment owns the randomness *within* an episode, drawn from
/// the seed given to [`reset`](Self::reset), and owns none between episodes. `step` returns no observation:
/// nothing is computed, drawn or allocated that nobody reads.
pub trait Environment {
    /// What the agent sees.
    type Observation: Clone + Default;
    /// What the agent does.
    type Action: Clone;

    /// What agents may know of the domain before they act.
    fn spec(&self) -> &Spec;

    /// Begins the episode that `seed` names.
    fn reset(&mut self, seed: u64);

    /// Carries out one action.
    ///
    /// # Errors
    /// [`Refused`] names what is wrong with the action; nothing has changed then.
    fn step(&mut self, action: &Self::Action) -> Result<Step, Refused>;

    /// Writes the present observation into the caller's buffer, whatever it held before.
    ///
    /// It may remember what it drew, to draw only what differs the next time, and changes nothing else: what it
    /// writes is a function of the episode so far, however often anybody looked.
    fn observe(&mut self, out: &mut Self::Observation);

    /// Why the simulator gave up on the episode, when it did. Such an episode ends as truncated: nothing is
    /// wrong with the task, and nothing may be concluded from how it went on.
    fn fault(&self) -> Option<&str> {
        None
    }
}
