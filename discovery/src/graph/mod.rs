//! The skill graph: numbers only (thesis 6.1.1, 7.2.1).
//!
//! A vertex stands for a skill and the states in which it ends. An edge i → j says that skill j may be called from
//! there, and holds what is known of that call. What a vertex's goal or states are stands elsewhere, in columns indexed
//! by its number: so this compiles once, draws without a domain, and saves small.

mod abstract_mdp;
mod deep;
mod dijkstra;
mod explorer;
mod planner;

pub use abstract_mdp::{AbstractMdp, AbstractMdpConfig};
pub use deep::{DeepGraph, DeepGraphConfig, Ground, Region};
pub use dijkstra::{Cost, Dijkstra};
pub(crate) use explorer::Lane as ExplorerLane;
pub use explorer::{ExplorerConfig, GraphExplorer};
pub use planner::{Direct, Plan, Planner};

use serde::{Deserialize, Serialize};

use crate::SkillId;

/// A vertex's number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Vertex(pub u32);

impl Vertex {
    /// The number as an index into a column.
    pub fn index(self) -> usize {
        self.0 as usize
    }

    /// The skill that ends there. Skill 0 is the one that belongs to no vertex.
    pub fn skill(self) -> SkillId {
        SkillId(self.0 + 1)
    }

    /// The vertex where a skill ends; none for skill 0.
    pub fn of(skill: SkillId) -> Option<Self> {
        skill.0.checked_sub(1).map(Self)
    }
}

/// What is known of calling one skill from the states of another's end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Edge {
    /// Whether plans may use it.
    pub connected: bool,
    /// N\[i, j\]: times the call was made.
    pub tries: u32,
    /// Times it succeeded.
    pub successes: u32,
    /// v: how probable success is, as the skill's value function has it (equation 7.5), in \[0, 1\].
    pub value: f32,
    /// Mean of the task's rewards that one call collected.
    pub reward: f32,
    /// Mean number of steps of a successful call.
    pub steps: f32,
}

impl Edge {
    /// Counts one call, which took that many steps and collected that much of the task's reward.
    fn count(&mut self, success: bool, reward: f32, steps: u32) {
        self.tries += 1;
        self.reward += (reward - self.reward) / self.tries as f32;
        if success {
            self.successes += 1;
            self.steps += (steps as f32 - self.steps) / self.successes as f32;
        }
    }
}

/// A weighted directed graph of skills.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SkillGraph {
    visits: Vec<u64>,
    /// Of each vertex: calls from it that were made, and edges, by the vertex called.
    out: Vec<Vec<(Vertex, Edge)>>,
    /// Of each vertex: whence it was called, and where edges to it begin, in order.
    into: Vec<Vec<Vertex>>,
}

impl SkillGraph {
    /// How many vertices there are.
    pub fn len(&self) -> usize {
        self.out.len()
    }

    /// Whether there is no vertex.
    pub fn is_empty(&self) -> bool {
        self.out.is_empty()
    }

    /// All vertices.
    pub fn vertices(&self) -> impl DoubleEndedIterator<Item = Vertex> + ExactSizeIterator + use<> {
        (0..self.out.len() as u32).map(Vertex)
    }

    /// A new vertex without edges.
    pub fn add(&mut self) -> Vertex {
        self.visits.push(0);
        self.out.push(Vec::new());
        self.into.push(Vec::new());
        Vertex(self.out.len() as u32 - 1)
    }

    /// The vertex was visited once more.
    pub fn visit(&mut self, v: Vertex) {
        self.visits[v.index()] += 1;
    }

    /// N\[v\]: how often the vertex was visited.
    pub fn visits(&self, v: Vertex) -> u64 {
        self.visits[v.index()]
    }

    /// What is known of calls from `i` to `j`.
    pub fn edge(&self, i: Vertex, j: Vertex) -> Edge {
        let known = &self.out[i.index()];
        known.binary_search_by_key(&j, |(to, _)| *to).map_or_else(|_| Edge::default(), |at| known[at].1)
    }

    /// The edges that plans may use, by their first vertex and then by their second.
    pub fn edges(&self) -> impl Iterator<Item = (Vertex, Vertex, &Edge)> {
        self.vertices().flat_map(|i| self.successors(i).map(move |(j, edge)| (i, j, edge)))
    }

    /// The edges from `i` that plans may use, by the vertex they lead to.
    pub fn successors(&self, i: Vertex) -> impl Iterator<Item = (Vertex, &Edge)> {
        self.out[i.index()].iter().filter(|(_, edge)| edge.connected).map(|(j, edge)| (*j, edge))
    }

    /// The edges to `j` that plans may use, by the vertex they begin at.
    pub fn predecessors(&self, j: Vertex) -> impl Iterator<Item = (Vertex, Edge)> {
        let edges = self.into[j.index()].iter().map(move |i| (*i, self.edge(*i, j)));
        edges.filter(|(_, edge)| edge.connected)
    }

    /// Changes what is known of calls from `i` to `j`.
    pub fn change(&mut self, i: Vertex, j: Vertex) -> &mut Edge {
        let known = &mut self.out[i.index()];
        let at = known.binary_search_by_key(&j, |(to, _)| *to).unwrap_or_else(|at| {
            known.insert(at, (j, Edge::default()));
            let into = &mut self.into[j.index()];
            into.insert(into.partition_point(|from| *from < i), i);
            at
        });
        &mut self.out[i.index()][at].1
    }

    /// A call of the skill of `j` from `i` was made.
    pub fn called(&mut self, i: Vertex, j: Vertex, success: bool, reward: f32, steps: u32) {
        self.change(i, j).count(success, reward, steps);
    }

    /// Whether each vertex can be reached from one of these on edges (equations 6.4, 7.3). A vertex reaches itself.
    pub fn descendants(&self, from: &[Vertex]) -> Vec<bool> {
        let mut found = vec![false; self.len()];
        let mut open: Vec<_> = from.to_vec();
        open.iter().for_each(|v| found[v.index()] = true);
        while let Some(i) = open.pop() {
            for (j, _) in self.successors(i) {
                if !std::mem::replace(&mut found[j.index()], true) {
                    open.push(j);
                }
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_follow_edges_and_calls_are_counted() {
        let mut graph = SkillGraph::default();
        let [a, b, c, d] = std::array::from_fn(|_| graph.add());
        for (i, j) in [(a, b), (b, c), (d, a)] {
            graph.change(i, j).connected = true;
        }
        graph.called(a, d, false, 0.0, 9);
        assert_eq!(graph.descendants(&[a]), [true, true, true, false], "a call that was tried is no edge");
        assert_eq!(graph.descendants(&[c, d]), [true, true, true, true]);
        graph.called(a, b, true, 1.0, 4);
        graph.called(a, b, true, 0.0, 8);
        graph.called(a, b, false, 2.0, 20);
        let edge = graph.edge(a, b);
        assert_eq!((edge.tries, edge.successes, edge.reward, edge.steps), (3, 2, 1.0, 6.0));
        assert_eq!(graph.edges().count(), 3);
        let whence: Vec<_> = graph.predecessors(a).map(|(i, _)| i).collect();
        assert_eq!((whence, graph.predecessors(d).count()), (vec![d], 0), "nor one that leads back");
    }
}
