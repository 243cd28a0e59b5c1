//! What tables and pictures are drawn from, as plain data.

use inroads_agents::{Actor, Agent, Flat};
use serde::{Deserialize, Serialize};

use crate::chain::Phase;

/// One learned skill, as plain data.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SkillRecord {
    /// Its number, from 1.
    pub skill: u32,
    /// The skill whose set it enters; none when it aims at the task's goal.
    pub enters: Option<u32>,
    /// Whether its initiation set still moves.
    pub phase: Phase,
    /// The training episode in which it was created.
    pub born: u64,
    /// Times it was executed in training.
    pub executions: u64,
    /// Times it reached its subgoal in training.
    pub successes: u64,
    /// Positive and negative examples that its set was learned from.
    pub examples: (usize, usize),
}

/// An agent whose skills can be looked at. An agent without skills says so by doing nothing.
pub trait Skilled<O, A>: Agent<O, A> {
    /// All learned skills.
    fn skills(&self) -> Vec<SkillRecord> {
        Vec::new()
    }

    /// Of all learned skills in order: whether `s` is in its initiation set.
    fn members(&self, _s: &O) -> Vec<bool> {
        Vec::new()
    }

    /// The agent without learning, and without primitive actions wherever a learned skill may start; none when
    /// it has no skills.
    fn chain_alone(&self) -> Option<Box<dyn Actor<O, A> + '_>> {
        None
    }
}

impl<O, A, L> Skilled<O, A> for Flat<O, A, L> where Self: Agent<O, A> {}
