//! Planning on the skill graph.

use super::{Edge, SkillGraph, Vertex};

/// A policy over vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plan {
    /// At each vertex the one to call next; none at the target, and where there is no way to it.
    pub next: Vec<Option<Vertex>>,
    /// What each vertex is worth on the way to the target, the greater the better; by the planner's own measure.
    pub value: Vec<f32>,
    /// The vertex to call where one is on none; none: the one that is most probably reached (7.2.2.5).
    pub elsewhere: Option<Vertex>,
}

impl Plan {
    /// Whether this plan to `target` knows a way from `v`, whatever its measure says that it is worth.
    pub fn leads(&self, v: Vertex, target: Vertex) -> bool {
        v == target || self.next[v.index()].is_some()
    }
}

/// Finds the way to a vertex from all others.
pub trait Planner {
    /// A policy over all vertices that leads to `target`.
    fn plan(&self, graph: &SkillGraph, target: Vertex) -> Plan;

    /// What it is worth to call the skill of `to` along this edge, by the measure of `plan`, which leads to `target`. So calls
    /// from where no vertex is can be compared with what vertices are worth.
    fn through(&self, edge: &Edge, to: Vertex, target: Vertex, plan: &Plan) -> f32;

    /// Which vertices there is a way to from these (equation 7.3); to all of them where one is on none and goes to the
    /// closest first (7.2.2.5).
    fn reachable(&self, graph: &SkillGraph, here: &[Vertex]) -> Vec<bool> {
        if here.is_empty() { vec![true; graph.len()] } else { graph.descendants(here) }
    }

    /// Mends a plan to `target` that was right until the edges `changed` (from, to) became what they are now, and others
    /// did not. What it is worth anywhere is what a new plan would be; among ways that are as good it may take another.
    fn replan(&self, graph: &SkillGraph, target: Vertex, plan: &mut Plan, changed: &[(Vertex, Vertex)]) {
        let _ = changed;
        *plan = self.plan(graph, target);
    }
}

/// No plan: the target's own skill is called, wherever one is (the ablation of 7.3.3.1, and 9.2.1 to the letter).
#[derive(Clone, Copy, Debug, Default)]
pub struct Direct;

impl Planner for Direct {
    /// Every vertex is worth 0.
    fn plan(&self, graph: &SkillGraph, target: Vertex) -> Plan {
        let next = graph.vertices().map(|v| (v != target).then_some(target)).collect();
        Plan { next, value: vec![0.0; graph.len()], elsewhere: Some(target) }
    }

    /// 0, as all is.
    fn through(&self, _: &Edge, to: Vertex, _: Vertex, plan: &Plan) -> f32 {
        plan.value[to.index()]
    }

    /// All of them.
    fn reachable(&self, graph: &SkillGraph, _: &[Vertex]) -> Vec<bool> {
        vec![true; graph.len()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_a_plan_everybody_calls_the_target() {
        let mut graph = SkillGraph::default();
        let [a, b, c] = std::array::from_fn(|_| graph.add());
        graph.change(a, b).connected = true;
        let plan = Direct.plan(&graph, c);
        assert_eq!((plan.next, plan.elsewhere), (vec![Some(c), Some(c), None], Some(c)));
    }
}
