//! Shortest paths (Dijkstra 1959), as chapter 6 plans.

use std::{cmp::Reverse, collections::BinaryHeap};

use serde::{Deserialize, Serialize};

use super::{Edge, Plan, Planner, SkillGraph, Vertex};

/// What an edge costs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Cost {
    /// Its mean number of steps, and at least one: the reward of a task that pays −1 a step, with its sign changed
    /// (`decisions.md`).
    #[default]
    Steps,
    /// −ln v: then the cheapest path is the one that most probably succeeds as a whole. What never succeeds is no edge.
    Surprise,
}

impl Cost {
    /// What this edge costs; infinity where it is none.
    fn of(self, edge: &Edge) -> f32 {
        match self {
            Self::Steps => edge.steps.max(1.0),
            Self::Surprise => -edge.value.clamp(0.0, 1.0).ln(),
        }
    }
}

/// The path of the least cost.
#[derive(Clone, Copy, Debug, Default)]
pub struct Dijkstra {
    /// What an edge costs.
    pub cost: Cost,
}

impl Planner for Dijkstra {
    /// Values are minus the cost to the target; negative infinity where there is no way.
    fn plan(&self, graph: &SkillGraph, target: Vertex) -> Plan {
        let mut into = vec![Vec::new(); graph.len()];
        for (i, j, edge) in graph.edges() {
            into[j.index()].push((i, self.cost.of(edge)));
        }
        let value = vec![f32::NEG_INFINITY; graph.len()];
        let mut plan = Plan { next: vec![None; graph.len()], value, elsewhere: None };
        plan.value[target.index()] = 0.0;
        // Costs are finite and not negative, so their bits are ordered as they are.
        let mut open = BinaryHeap::from([Reverse((0.0_f32.to_bits(), target))]);
        while let Some(Reverse((cost, j))) = open.pop() {
            let cost = f32::from_bits(cost);
            if cost > -plan.value[j.index()] {
                continue;
            }
            for &(i, step) in &into[j.index()] {
                if cost + step < -plan.value[i.index()] {
                    plan.value[i.index()] = -(cost + step);
                    plan.next[i.index()] = Some(j);
                    open.push(Reverse(((cost + step).to_bits(), i)));
                }
            }
        }
        plan
    }

    fn through(&self, edge: &Edge, to: Vertex, _: Vertex, plan: &Plan) -> f32 {
        plan.value[to.index()] - self.cost.of(edge)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cheaper_of_two_ways_is_taken_and_no_way_is_none() {
        let mut graph = SkillGraph::default();
        let [a, b, c, d] = std::array::from_fn(|_| graph.add());
        for (i, j, steps) in [(a, b, 2.0), (b, c, 3.0), (a, c, 6.0)] {
            let edge = graph.change(i, j);
            (edge.connected, edge.steps, edge.value) = (true, steps, 0.5);
        }
        let plan = Dijkstra::default().plan(&graph, c);
        assert_eq!(plan.next, [Some(b), Some(c), None, None]);
        assert_eq!(plan.value, [-5.0, -3.0, 0.0, f32::NEG_INFINITY]);
        assert_eq!(Dijkstra::default().plan(&graph, d).next, [None; 4]);

        let surest = Dijkstra { cost: Cost::Surprise };
        assert_eq!(surest.plan(&graph, c).next[0], Some(c), "one toss is won more often than two");
        graph.change(a, c).value = 0.0;
        assert_eq!(surest.plan(&graph, c).next[0], Some(b), "what never succeeds is no edge");
    }
}
