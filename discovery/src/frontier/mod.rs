//! What happens at the edge of the skill graph: which vertex to go out from, how to act beyond it, and what to take
//! home as a new vertex (6.1.3, 7.2.2.1, 7.2.2.6, 7.2.2.7).

mod novel;

pub use novel::Novel;

use inroads_agents::{Checkpoint, Context, Experience, Memory};

use crate::graph::Vertex;

/// A vertex that one could go out from.
#[derive(Clone, Debug)]
pub struct Candidate<'a, O> {
    /// The vertex.
    pub vertex: Vertex,
    /// States in which it was reached lately, oldest first; perhaps none.
    pub states: Vec<&'a O>,
}

/// Expands the graph. Its policy's memory lasts for one episode of one actor.
pub trait Frontier<O, A, G>: Checkpoint {
    /// Which of the candidates (there is at least one) to go out from: drawn when `ctx.explore`, the best otherwise.
    fn choose(&self, memory: &mut Memory, candidates: &[Candidate<'_, O>], ctx: &mut Context) -> Vertex;

    /// The action at `s`, outside.
    fn act(&self, memory: &mut Memory, s: &O, ctx: &mut Context) -> A;

    /// The goal of a new vertex, if these states of an exploration bring one up. All of them are counted.
    fn propose(&self, states: &[O], ctx: &mut Context) -> Option<G>;

    /// The goal of being as `s` is, for goals that are given from outside, and for hindsight; none where it cannot name any.
    fn aim(&self, s: &O) -> Option<G> {
        let _ = s;
        None
    }

    /// The newest step of the experience, whoever acted.
    fn step(&mut self, all: &Experience<O, A>, ctx: &mut Context);

    /// Updates made so far.
    fn updates(&self) -> u64;
}
