//! What is drawn of an explorer's graph, and who goes to places on it.

use inroads_agents::{Actor, Agent, Experience};

use super::GraphExplorer;
use crate::{
    Goal, Hierarchy, SkillPolicy, Skilled,
    frontier::Frontier,
    record::{EdgeRecord, GraphRecord, Place, PlanRecord, VertexRecord},
};

impl<G, P, F> GraphExplorer<G, P, F> {
    /// The graph as plain data.
    pub(crate) fn recorded<O, A>(&self, all: &Experience<O, A>) -> GraphRecord
    where
        O: AsRef<[f32]>,
        G: Goal<O>,
    {
        let vertices = self.graph.vertices().map(|v| {
            let last = self.effects(v).last();
            let at = last.and_then(|(number, step)| all.episode(*number)?.observations.get(*step as usize));
            VertexRecord {
                vertex: v.0,
                at: at.map_or_else(Vec::new, |s| s.as_ref().to_vec()),
                visits: self.graph.visits(v),
                kept: self.goals[v.index()].kept(),
            }
        });
        let edges = self.graph.edges().map(|(i, j, edge)| EdgeRecord {
            from: i.0,
            to: j.0,
            probability: edge.value,
            tries: edge.tries,
            successes: edge.successes,
        });
        GraphRecord { vertices: vertices.collect(), edges: edges.collect() }
    }
}

impl<O, A, G, P, F> Skilled<O, A> for Hierarchy<O, A, GraphExplorer<G, P, F>>
where
    O: Clone + AsRef<[f32]>,
    A: Clone,
    G: Goal<O>,
    P: SkillPolicy<O, A, G>,
    F: Frontier<O, A, G>,
    Self: Agent<O, A>,
{
    fn graph(&self) -> Option<GraphRecord> {
        Some(self.method().recorded(self.experience()))
    }

    fn plan(&self, from: &Place<'_, O>, to: &Place<'_, O>) -> Option<PlanRecord> {
        self.method().way(from, to, self.experience())
    }

    fn pursue(&self, to: &Place<'_, O>) -> Option<Box<dyn Actor<O, A> + '_>> {
        Some(self.watch(self.method().sent(to, self.experience())?))
    }
}
