//! Proto-goal reinforcement learning (thesis chapter 8): many cheap candidate goals, pruned to the few that are worth
//! pursuing.
//!
//! A domain answers a list of questions about each state with yes or no: its proto-goals. A goal asks for one of them, or
//! for several at once ([`Wanted`](crate::Wanted)). The [`GoalSpace`] counts what becomes of each; every so many steps an
//! evaluation ([`evaluator`]) prunes those that cannot be had or that nobody can bring about, by the values of seeking and
//! of avoiding them ([`SeekAvoid`]). Of what is left, the agent pursues what is new and near ([`pursuit`]), learns what it
//! attained on the way ([`hindsight`]), and combines what it has mastered ([`recombine`]).
//!
//! | thesis | here |
//! |---|---|
//! | 8.2 goals, proto-goals; N(g) | [`space`] |
//! | 8.3.1 observed, reachable (8.1), controllable (8.2) | [`evaluator`], [`plausible`] |
//! | 8.3.2 desirability (8.3, 8.4) | [`desirable`] |
//! | 8.4.1 what to pursue, strata of timescales, the task's share | [`pursuit`], [`agent`] |
//! | 8.4.2 what to learn in hindsight | [`hindsight`] |
//! | 8.4.3 mastery, recombination | [`mastery`], [`recombine`] |

pub mod agent;
mod config;
pub mod desirable;
pub mod evaluator;
pub mod hindsight;
pub mod mastery;
pub mod plausible;
pub mod pursuit;
pub mod recombine;
pub mod space;

pub use agent::ProtoGoalAgent;
pub use config::ProtoConfig;
pub use evaluator::{LeastSquares, SeekAvoid, Verdict};
pub use hindsight::Relabel;
pub use space::{GoalId, GoalSpace};
