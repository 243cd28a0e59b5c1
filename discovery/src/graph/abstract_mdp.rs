//! The abstract Markov decision process of thesis 7.2.2.4, and value iteration on it.
//!
//! Falling off the graph ends a plan with nothing, so a vertex is worth what its best path is worth, and values fall along
//! the path from the target back. That allows an order: vertices are settled best first, as Dijkstra's algorithm settles
//! them, and without rewards on the way every edge is looked at once. Rewards may raise a value again; then its
//! predecessors are looked at again, until nothing rises any more. That is value iteration to its fixed point, to the last
//! bit of a float, and not ten sweeps of it (`decisions.md`).

use std::collections::BinaryHeap;

use serde::{Deserialize, Serialize};

use super::{Edge, Plan, Planner, SkillGraph, Vertex};

/// Settings of [`AbstractMdp`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct AbstractMdpConfig {
    /// c of equation 7.6, in \[0, 1\]: how much is hoped of an edge that was never tried. (The thesis gives no value.)
    pub optimism: f32,
    /// κ, at least 0: what the task's reward counts beside the 1 of the target. (The authors' planner: a half.)
    pub task_reward: f32,
    /// γ̄, in \[0, 1): so that no cycle is as good as a way out of it (authors' precursor: 0.99).
    pub discount: f32,
}

impl Default for AbstractMdpConfig {
    fn default() -> Self {
        Self { optimism: 0.5, task_reward: 0.5, discount: 0.95 }
    }
}

impl AbstractMdpConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the mend.
    pub fn check(&self) -> Result<(), String> {
        if !(0.0..=1.0).contains(&self.optimism) {
            return Err(format!("optimism is {}; it must lie in [0, 1]", self.optimism));
        }
        if !(self.task_reward.is_finite() && self.task_reward >= 0.0) {
            return Err(format!("task_reward is {}; it must be 0 or above", self.task_reward));
        }
        if !(0.0..1.0).contains(&self.discount) {
            return Err(format!("discount is {}; it must lie in [0, 1)", self.discount));
        }
        Ok(())
    }
}

/// Planning on the optimistic model: who calls skill j from i gets there with p⁺ᵢⱼ and is lost otherwise.
///
/// ```text
/// V(i) = max( 0, maxⱼ p⁺ᵢⱼ (κ max(Rᵢⱼ, 0) + 1{j = target} + γ̄ V(j)) ),   V(target) = 0
/// ```
///
/// Costs (R below 0) are left out: falling off costs nothing here, so a plan that minded them would rather fail.
#[derive(Clone, Debug, Default)]
pub struct AbstractMdp {
    config: AbstractMdpConfig,
}

impl AbstractMdp {
    /// A planner.
    pub fn new(config: &AbstractMdpConfig) -> Self {
        Self { config: config.clone() }
    }

    /// p⁺ of equation 7.6: v + c/√(N + 1), at most 1.
    fn probability(&self, edge: &Edge) -> f32 {
        (edge.value + self.config.optimism / (edge.tries as f32 + 1.0).sqrt()).clamp(0.0, 1.0)
    }

    /// Raises values until none can be raised. `open` holds the vertices whose value has changed; `into` gives the edges
    /// to a vertex: where each begins, and its model.
    fn raise<I>(&self, target: Vertex, plan: &mut Plan, open: &mut Open, into: impl Fn(Vertex) -> I)
    where
        I: Iterator<Item = (Vertex, Model)>,
    {
        while let Some((value, j)) = open.pop() {
            if value < plan.value[j.index()] {
                continue; // It was raised again since, and stood further ahead.
            }
            for (i, model) in into(j) {
                let worth = self.worth(model, value);
                if i != target && worth > plan.value[i.index()] {
                    plan.set(i, worth, j);
                    open.push(worth, i);
                }
            }
        }
    }

    /// What a call of this model is worth where its end is worth that.
    fn worth(&self, model: Model, end: f32) -> f32 {
        model.probability * (model.pay + self.config.discount * end)
    }

    /// What is known of calling `to` by this edge, on the way to the target.
    fn model(&self, edge: &Edge, to: Vertex, target: Vertex) -> Model {
        let arrived = if to == target { 1.0 } else { 0.0 };
        let pay = self.config.task_reward * edge.reward.max(0.0) + arrived;
        Model { probability: self.probability(edge), pay }
    }

    /// The best call from `i` by the values of `plan`; none where none is worth anything.
    fn best(&self, graph: &SkillGraph, target: Vertex, plan: &Plan, i: Vertex) -> Option<(f32, Vertex)> {
        let calls = graph.successors(i).map(|(j, edge)| (self.through(edge, j, target, plan), j));
        calls.filter(|(worth, _)| *worth > 0.0).reduce(|a, b| if b.0 > a.0 { b } else { a })
    }
}

/// An edge to one who plans: p⁺, and what is paid besides the value of where it leads.
#[derive(Clone, Copy, Default)]
struct Model {
    probability: f32,
    pay: f32,
}

/// Vertices whose value has changed, the greatest value first.
#[derive(Default)]
struct Open(BinaryHeap<(u32, Vertex)>);

impl Open {
    fn push(&mut self, value: f32, v: Vertex) {
        // Values are never negative, so their bits are ordered as they are.
        self.0.push((value.to_bits(), v));
    }

    fn pop(&mut self) -> Option<(f32, Vertex)> {
        self.0.pop().map(|(bits, v)| (f32::from_bits(bits), v))
    }
}

impl Plan {
    fn set(&mut self, i: Vertex, worth: f32, next: Vertex) {
        (self.value[i.index()], self.next[i.index()]) = (worth, Some(next));
    }

    /// Forgets what `i` is worth, and all whose way leads through it. These are they.
    fn forget(&mut self, graph: &SkillGraph, i: Vertex) -> Vec<Vertex> {
        let mut found = vec![i];
        let mut at = 0;
        while let Some(&j) = found.get(at) {
            (self.value[j.index()], self.next[j.index()]) = (0.0, None);
            let through = |from: &&Vertex| self.next[from.index()] == Some(j);
            found.extend(graph.into[j.index()].iter().filter(through));
            at += 1;
        }
        found
    }
}

impl Planner for AbstractMdp {
    fn plan(&self, graph: &SkillGraph, target: Vertex) -> Plan {
        let n = graph.len();
        let mut plan = Plan { next: vec![None; n], value: vec![0.0; n], elsewhere: None };
        // Edges by where they end, those of j from `starts[j]` on, so that each is looked up once; and what every vertex
        // is worth for its next call alone.
        let mut starts = vec![0; n + 1];
        graph.edges().for_each(|(_, j, _)| starts[j.index() + 1] += 1);
        (0..n).for_each(|j| starts[j + 1] += starts[j]);
        let mut into = vec![(target, Model::default()); starts[n]];
        let mut free = starts.clone();
        for (i, j, edge) in graph.edges().filter(|(i, _, _)| *i != target) {
            let model = self.model(edge, j, target);
            into[free[j.index()]] = (i, model);
            free[j.index()] += 1;
            let worth = self.worth(model, 0.0);
            if worth > plan.value[i.index()] {
                plan.set(i, worth, j);
            }
        }
        let mut open = Open::default();
        let worthy = graph.vertices().filter(|v| plan.value[v.index()] > 0.0);
        worthy.for_each(|v| open.push(plan.value[v.index()], v));
        let into = |j: Vertex| into[starts[j.index()]..free[j.index()]].iter().copied();
        self.raise(target, &mut plan, &mut open, into);
        plan
    }

    fn through(&self, edge: &Edge, to: Vertex, target: Vertex, plan: &Plan) -> f32 {
        let end = if to == target { 0.0 } else { plan.value[to.index()] };
        self.worth(self.model(edge, to, target), end)
    }

    /// What rests on an edge that has become worse is forgotten and found anew; what has become better is passed on.
    fn replan(&self, graph: &SkillGraph, target: Vertex, plan: &mut Plan, changed: &[(Vertex, Vertex)]) {
        plan.next.resize(graph.len(), None);
        plan.value.resize(graph.len(), 0.0);
        let mut doubtful = Vec::new();
        for &(i, j) in changed.iter().filter(|(i, _)| *i != target) {
            let edge = graph.edge(i, j);
            let worth = if edge.connected { self.through(&edge, j, target, plan) } else { 0.0 };
            match plan.next[i.index()] == Some(j) && worth < plan.value[i.index()] {
                true => doubtful.extend(plan.forget(graph, i)),
                false => doubtful.push(i),
            }
        }
        let mut open = Open::default();
        for i in doubtful {
            if let Some((worth, j)) = self.best(graph, target, plan, i)
                && worth > plan.value[i.index()]
            {
                plan.set(i, worth, j);
                open.push(worth, i);
            }
        }
        let into = |j: Vertex| graph.predecessors(j).map(move |(i, edge)| (i, self.model(&edge, j, target)));
        self.raise(target, plan, &mut open, into);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::{Cost, Dijkstra};
    use inroads_envs::{Rng, Seed};
    use rand::RngExt;

    fn planner(optimism: f32, task_reward: f32, discount: f32) -> AbstractMdp {
        AbstractMdp::new(&AbstractMdpConfig { optimism, task_reward, discount })
    }

    /// `n` vertices where a share of all edges is there, some of which pay.
    fn random(n: u32, share: f64, paying: f64, rng: &mut Rng) -> SkillGraph {
        let mut graph = SkillGraph::default();
        (0..n).for_each(|_| _ = graph.add());
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (Vertex(i), Vertex(j)))) {
            if i != j && rng.random_bool(share) {
                *graph.change(i, j) = edge(paying, rng);
            }
        }
        graph
    }

    fn edge(paying: f64, rng: &mut Rng) -> Edge {
        let reward = if rng.random_bool(paying) { rng.random_range(-1.0..1.0) } else { 0.0 };
        let (value, tries) = (rng.random_range(0.0..1.0), rng.random_range(0..50));
        Edge { connected: true, value, tries, reward, ..Edge::default() }
    }

    #[test]
    fn the_detour_over_two_good_edges_is_worth_more_than_one_poor_edge() {
        // algorithms.md 12.1.
        let mut graph = SkillGraph::default();
        let [i, j, e] = std::array::from_fn(|_| graph.add());
        for (from, to, value) in [(i, j, 0.9), (j, e, 0.8), (i, e, 0.5)] {
            let edge = graph.change(from, to);
            (edge.connected, edge.value) = (true, value);
        }
        let planner = planner(0.0, 1.0, 0.95);
        let plan = planner.plan(&graph, e);
        assert!((plan.value[0] - 0.684).abs() < 1e-5 && (plan.value[1] - 0.8).abs() < 1e-5);
        assert_eq!((plan.value[2], plan.next), (0.0, vec![Some(j), Some(e), None]));

        // A reward on the direct way makes it the better one: 0.5 (1 + 1) > 0.684; a cost does not make it worse.
        graph.change(i, e).reward = 1.0;
        let plan = planner.plan(&graph, e);
        assert_eq!((plan.value[0], plan.next[0]), (1.0, Some(e)));
        graph.change(i, e).reward = -1.0;
        assert!((planner.plan(&graph, e).value[0] - 0.684).abs() < 1e-5);
    }

    #[test]
    fn optimism_fades_with_tries_and_never_exceeds_certainty() {
        let planner = planner(0.1, 1.0, 0.95);
        let p = |tries, value| planner.probability(&Edge { tries, value, ..Edge::default() });
        assert!((p(0, 0.3) - 0.4).abs() < 1e-6 && (p(99, 0.3) - 0.31).abs() < 1e-6);
        assert_eq!(p(0, 0.95), 1.0);
    }

    #[test]
    fn cycles_of_certain_edges_are_no_way() {
        let mut graph = SkillGraph::default();
        let [a, b, c, target] = std::array::from_fn(|_| graph.add());
        for (i, j) in [(a, b), (b, a), (b, c), (c, target), (target, a)] {
            let edge = graph.change(i, j);
            (edge.connected, edge.value) = (true, 1.0);
        }
        let plan = planner(0.0, 1.0, 0.9).plan(&graph, target);
        assert_eq!(plan.next, [Some(b), Some(c), Some(target), None]);
        assert!((plan.value[0] - 0.81).abs() < 1e-6);
        graph.change(c, target).connected = false;
        assert_eq!(planner(0.0, 1.0, 0.9).plan(&graph, target).next, [None; 4]);
    }

    /// What a policy is worth at every vertex, by following it for long.
    fn worth(
        planner: &AbstractMdp,
        graph: &SkillGraph,
        target: Vertex,
        policy: &[Option<Vertex>],
    ) -> Vec<f32> {
        let mut values = vec![0.0; graph.len()];
        for _ in 0..400 {
            let next = graph.vertices().map(|i| match policy[i.index()] {
                Some(j) if i != target => {
                    let model = planner.model(&graph.edge(i, j), j, target);
                    planner.worth(model, if j == target { 0.0 } else { values[j.index()] })
                }
                _ => 0.0,
            });
            values = next.collect();
        }
        values
    }

    #[test]
    fn no_policy_is_better_than_the_plan() {
        // algorithms.md 14: exhaustive enumeration on random graphs of five vertices.
        let mut rng = Seed(5).stream("test", 0);
        let planner = planner(0.3, 1.0, 0.9);
        for _ in 0..20 {
            let (graph, target) = (random(5, 0.5, 0.3, &mut rng), Vertex(0));
            let choices: Vec<Vec<Option<Vertex>>> = graph
                .vertices()
                .map(|i| graph.successors(i).map(|(j, _)| Some(j)).chain([None]).collect())
                .collect();
            let mut best = vec![0.0_f32; graph.len()];
            for number in 0..choices.iter().map(Vec::len).product() {
                let mut rest = number;
                let pick = |c: &Vec<Option<Vertex>>| {
                    let choice = c[rest % c.len()];
                    rest /= c.len();
                    choice
                };
                let policy: Vec<_> = choices.iter().map(pick).collect();
                let values = worth(&planner, &graph, target, &policy);
                best.iter_mut().zip(values).for_each(|(best, value)| *best = best.max(value));
            }
            let plan = planner.plan(&graph, target);
            let followed = worth(&planner, &graph, target, &plan.next);
            for i in 0..graph.len() {
                assert!((plan.value[i] - best[i]).abs() < 1e-5, "{} {}", plan.value[i], best[i]);
                assert!((followed[i] - best[i]).abs() < 1e-5, "the policy is worth what its values say");
            }
        }
    }

    #[test]
    fn without_discount_the_plan_is_the_path_that_most_probably_succeeds() {
        // algorithms.md 14: Dijkstra on −ln p.
        let mut rng = Seed(6).stream("test", 0);
        for _ in 0..50 {
            let (graph, target) = (random(12, 0.2, 0.0, &mut rng), Vertex(3));
            let plan = planner(0.0, 1.0, 1.0).plan(&graph, target);
            let surest = Dijkstra { cost: Cost::Surprise }.plan(&graph, target);
            for i in graph.vertices().filter(|i| *i != target) {
                assert!((plan.value[i.index()] - surest.value[i.index()].exp()).abs() < 1e-5);
                assert_eq!(plan.next[i.index()], surest.next[i.index()]);
            }
        }
    }

    #[test]
    fn a_mended_plan_is_worth_what_a_new_one_is() {
        for (seed, paying, error) in [(7, 0.0, 0.0), (8, 0.2, 1e-5)] {
            let mut rng = Seed(seed).stream("test", 0);
            let planner = planner(0.5, 1.0, 0.9);
            for _ in 0..30 {
                let (mut graph, target) = (random(15, 0.25, paying, &mut rng), Vertex(4));
                let mut plan = planner.plan(&graph, target);
                for _ in 0..40 {
                    let several = rng.random_range(1..3);
                    let mut vertex = || Vertex(rng.random_range(0..15));
                    let changed: Vec<_> = (0..several).map(|_| (vertex(), vertex())).collect();
                    for &(i, j) in &changed {
                        let connected = rng.random_bool(0.6);
                        *graph.change(i, j) = Edge { connected, ..edge(paying, &mut rng) };
                    }
                    planner.replan(&graph, target, &mut plan, &changed);
                    let anew = planner.plan(&graph, target);
                    for i in graph.vertices() {
                        assert!((plan.value[i.index()] - anew.value[i.index()]).abs() <= error);
                        assert_eq!(plan.next[i.index()].is_some(), anew.next[i.index()].is_some());
                    }
                    let followed = worth(&planner, &graph, target, &plan.next);
                    assert!(followed.iter().zip(&anew.value).all(|(a, b)| (a - b).abs() < 1e-4));
                }
            }
        }
    }
}
