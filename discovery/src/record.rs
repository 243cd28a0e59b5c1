//! What tables and pictures are drawn from, as plain data.

use inroads_agents::{Actor, Agent, Aimed, Flat, Mpc};
use serde::{Deserialize, Serialize};

use crate::{Stop, chain::Phase};

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

/// One vertex of a skill graph, as plain data.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VertexRecord {
    /// Its number.
    pub vertex: u32,
    /// The observation in which it was reached last; empty when that is forgotten.
    pub at: Vec<f32>,
    /// Times it was visited in training.
    pub visits: u64,
    /// The features that its goal asks for, and their values.
    pub kept: Vec<(u32, f32)>,
}

/// One edge of a skill graph, as plain data.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EdgeRecord {
    /// Where the call is made.
    pub from: u32,
    /// The vertex whose skill is called.
    pub to: u32,
    /// How probable success is, as far as the agent knows.
    pub probability: f32,
    /// Times it was tried in training.
    pub tries: u32,
    /// Times that succeeded.
    pub successes: u32,
}

/// A skill graph, as plain data.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GraphRecord {
    /// Vertices, by number.
    pub vertices: Vec<VertexRecord>,
    /// Edges that plans may use.
    pub edges: Vec<EdgeRecord>,
}

/// What has become of a proto-goal (thesis 8.3, 8.4).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GoalState {
    /// Never observed.
    Unseen,
    /// Observed, and pruned as implausible.
    Pruned,
    /// Plausible: it may be pursued.
    Plausible,
    /// Plausible, and reached as often as mastery asks for.
    Mastered,
}

/// One goal, as plain data. Names of proto-goals are the domain's.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GoalRecord {
    /// The proto-goals that must hold together.
    pub bits: Vec<u32>,
    /// What has become of it.
    pub state: GoalState,
    /// N(g): times it was attained, on whatever errand.
    pub attained: u64,
    /// Times it was pursued.
    pub pursued: u64,
    /// Share of the latest pursuits that attained it.
    pub success: f32,
}

/// An end of a plan: a vertex, or a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place<'a, O> {
    /// A vertex's number.
    Vertex(u32),
    /// Anything that could be observed.
    State(&'a O),
}

/// The three cases of querying a graph (thesis 6.1.5).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Query {
    /// Start and goal lie in the graph.
    Inside,
    /// The goal lies outside: the nearest vertex is planned to, and the rest is left to a skill from there.
    GoalOutside,
    /// The start lies outside: a skill from there has to reach the graph first.
    StartOutside,
}

/// A plan, as plain data.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlanRecord {
    /// Which case it is.
    pub case: Query,
    /// The vertices to be reached one after the other, the start's left out, each with how probable it is to be reached
    /// from the one before.
    pub legs: Vec<(u32, f32)>,
    /// How probable it is that the stretches outside the graph succeed; 1 where there are none.
    pub outside: f32,
}

impl PlanRecord {
    /// How probable it is that all of it succeeds.
    pub fn probability(&self) -> f32 {
        self.outside * self.legs.iter().map(|(_, p)| p).product::<f32>()
    }
}

/// What one call of a skill came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Came {
    /// Why it handed back.
    pub stop: Stop,
    /// The steps that it took; 0 where it was called inside its subgoal and had nothing to do.
    pub steps: u32,
    /// Whether it ended inside its subgoal: also where it was told one state of it, and came to another (as training counts).
    pub success: bool,
}

/// One call of a skill, watched without learning: it begins where the episode does. Once it is over the agent goes on as it
/// likes, so whoever wanted the call alone leaves then.
pub trait Trial<O, A>: Actor<O, A> {
    /// What the call came to; none before it is over.
    fn came(&self) -> Option<Came>;
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

    /// Of all learned skills in order: whether another skill may aim at `s` in order to enter its initiation set (4.1.1).
    fn targets(&self, _s: &O) -> Vec<bool> {
        Vec::new()
    }

    /// Of all learned skills in order: how probable the agent holds it to be that the skill succeeds from `s`; none where its sets
    /// only tell inside from outside.
    fn chances(&self, _s: &O) -> Vec<Option<f32>> {
        Vec::new()
    }

    /// One call of that learned skill, wherever it may start by its set; none when there is no such skill, or skills cannot be
    /// called one by one.
    fn one_call(&self, _skill: u32) -> Option<Box<dyn Trial<O, A> + '_>> {
        None
    }

    /// The agent without learning, and without primitive actions wherever a learned skill may start; none when
    /// it has no skills.
    fn chain_alone(&self) -> Option<Box<dyn Actor<O, A> + '_>> {
        None
    }

    /// Its skill graph, if it has one.
    fn graph(&self) -> Option<GraphRecord> {
        None
    }

    /// Its goal space; nothing when it has none.
    fn goals(&self) -> Vec<GoalRecord> {
        Vec::new()
    }

    /// The way from one place to another on its graph; none when there is no way, or no graph.
    fn plan(&self, _from: &Place<'_, O>, _to: &Place<'_, O>) -> Option<PlanRecord> {
        None
    }

    /// The agent without learning, on the way to a place by such plans, replanning as it goes; none when it has no graph.
    /// When it is there it has nothing to do, and does what it likes.
    fn pursue(&self, _to: &Place<'_, O>) -> Option<Box<dyn Actor<O, A> + '_>> {
        None
    }
}

impl<O, A, L> Skilled<O, A> for Flat<O, A, L> where Self: Agent<O, A> {}

impl<O, A, G, L> Skilled<O, A> for Aimed<O, A, G, L> where Self: Agent<O, A> {}

impl Skilled<Vec<f32>, Vec<f32>> for Mpc {}
