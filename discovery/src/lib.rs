//! Options and how they are found.
//!
//! This room knows no particular domain and no Burn: it is generic over observation and action, and learns
//! through the learners of `inroads-agents`.
//!
//! A skill (the thesis' *option*; `Option` is Rust's) is a number. Its components are families indexed by it:
//! initiation sets ([`initiation`]), option policies ([`policy`]), and rows of counts and effects
//! ([`chain::Skill`]). One network shared by all skills or one each is then a choice of family, and "my subgoal
//! is to enter your initiation set" is a number too.

pub mod abstracting;
pub mod chain;
pub mod execution;
pub mod frontier;
pub mod goal;
pub mod graph;
pub mod initiation;
pub mod naming;
pub mod over_skills;
pub mod policy;
pub mod proto;
pub mod record;

pub use abstracting::{Abstracting, AbstractingConfig};
pub use chain::{ChainConfig, Chaining};
pub use execution::{Call, Discovery, Hierarchy, Outcome, Stop};
pub use goal::{Features, Goal, Wanted};
pub use graph::{DeepGraph, GraphExplorer};
pub use initiation::{Binary, Dual, Initiation, Ivf, Weighted};
pub use inroads_agents::hindsight;
pub use over_skills::{Choice, PolicyOverSkills};
pub use policy::{PerSkill, Shared, SkillPolicy};
pub use proto::ProtoGoalAgent;
pub use record::{SkillRecord, Skilled};

use serde::{Deserialize, Serialize};

/// A skill's number. Number 0 is the global option: it may start anywhere, lasts one step and aims at the
/// task's goal (3.1.2), so choosing it is choosing a primitive action.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct SkillId(pub u32);

impl SkillId {
    /// The option that every agent begins with.
    pub const GLOBAL: Self = Self(0);

    /// The number as an index into a family.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// Where a skill ends when it succeeds: its termination condition β.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Subgoal {
    /// The task's goal.
    Task,
    /// The initiation set of another skill.
    Enter(SkillId),
}
