//! An agent whose graph and goals are known by hand, for tests: it walks a corridor of five cells, each a vertex.

use inroads_agents::{Actor, Agent, Context, Transition, checkpoint};
use inroads_discovery::record::{
    EdgeRecord, GoalRecord, GoalState, GraphRecord, Place, PlanRecord, Query, Skilled, VertexRecord,
};
use inroads_envs::{Seed, TimeLimit, corridor::Corridor};

use super::{BoxedEnvironment, Session, pair::Pair};
use crate::assembly::{BoxedAgent, Vector};

/// Cells of the corridor; no edge leads from or to the last one, which is the goal.
const CELLS: u32 = 5;
/// How probable every edge is.
const EDGE: f32 = 0.5;

/// The session of the agent in its corridor.
pub(crate) fn session() -> Box<dyn Session> {
    let env = TimeLimit::new(Corridor::named("corridor-5", CELLS as usize), 50);
    let walker = Box::new(Walker { visits: vec![0; CELLS as usize] });
    Box::new(Pair::new(vec![Box::new(env)], None, walker, Seed(0)))
}

/// The session of an agent of a test's own.
pub(crate) fn of(
    env: BoxedEnvironment<Vector, Vector>,
    agent: BoxedAgent<Vector, Vector>,
) -> Box<dyn Session> {
    Box::new(Pair::new(vec![env], None, agent, Seed(0)))
}

struct Walker {
    visits: Vec<u64>,
}

checkpoint!([] Walker; plain: visits; parts: );

impl Actor<Vector, usize> for Walker {
    fn begin(&mut self, _: &Vector, _: &mut Context) {}

    fn act(&mut self, _: &Vector, _: &mut Context) -> usize {
        1
    }

    fn observe(&mut self, t: &Transition<Vector, usize>, _: &mut Context) {
        self.visits[cell(t.after) as usize] += 1;
    }
}

impl Agent<Vector, usize> for Walker {
    fn frozen(&self) -> Box<dyn Actor<Vector, usize> + '_> {
        Box::new(Bound { target: CELLS - 1 })
    }

    fn updates(&self) -> Vec<(&'static str, u64)> {
        Vec::new()
    }
}

impl Skilled<Vector, usize> for Walker {
    fn graph(&self) -> Option<GraphRecord> {
        let vertices = (0..CELLS).map(|vertex| VertexRecord {
            vertex,
            at: if vertex == 2 { Vec::new() } else { vec![vertex as f32] },
            visits: self.visits[vertex as usize],
            kept: vec![(0, vertex as f32)],
        });
        let edge = |from, to, tries| EdgeRecord { from, to, probability: EDGE, tries, successes: tries / 2 };
        let edges = (1..CELLS - 1).flat_map(|to| [edge(to - 1, to, 4), edge(to, to - 1, 0)]);
        Some(GraphRecord { vertices: vertices.collect(), edges: edges.collect() })
    }

    /// One proto-goal a cell; one and two together are a goal of their own.
    fn goals(&self) -> Vec<GoalRecord> {
        let goal = |bits: Vec<u32>, attained| {
            let state = match attained {
                0 => GoalState::Unseen,
                1 | 2 => GoalState::Pruned,
                3..20 => GoalState::Plausible,
                _ => GoalState::Mastered,
            };
            GoalRecord { bits, state, attained, pursued: attained / 2, success: 0.25 }
        };
        let cells = (0..CELLS).map(|cell| goal(vec![cell], self.visits[cell as usize]));
        cells.chain([goal(vec![1, 2], 3)]).collect()
    }

    fn plan(&self, from: &Place<'_, Vector>, to: &Place<'_, Vector>) -> Option<PlanRecord> {
        let [from, to] = [number(from), number(to)];
        let last = CELLS - 1;
        if from != to && (from == last || to == last) {
            return None;
        }
        let leg = |vertex| (vertex, EDGE);
        let legs =
            if from < to { (from + 1..=to).map(leg).collect() } else { (to..from).rev().map(leg).collect() };
        Some(PlanRecord { case: Query::Inside, legs, outside: 1.0 })
    }

    fn pursue(&self, to: &Place<'_, Vector>) -> Option<Box<dyn Actor<Vector, usize> + '_>> {
        Some(Box::new(Bound { target: number(to) }))
    }
}

/// Walks towards a cell, and steps to and fro there.
struct Bound {
    target: u32,
}

impl Actor<Vector, usize> for Bound {
    fn begin(&mut self, _: &Vector, _: &mut Context) {}

    fn act(&mut self, s: &Vector, _: &mut Context) -> usize {
        usize::from(cell(s) <= self.target)
    }

    fn observe(&mut self, _: &Transition<Vector, usize>, _: &mut Context) {}
}

fn cell(s: &Vector) -> u32 {
    s[0] as u32
}

fn number(place: &Place<'_, Vector>) -> u32 {
    match place {
        Place::Vertex(vertex) => *vertex,
        Place::State(s) => cell(s),
    }
}
