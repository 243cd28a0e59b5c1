//! What plans on a skill graph cost: value iteration, and mending a plan after one changed edge.

use std::hint::black_box;

use inroads::{
    discovery::graph::{AbstractMdp, AbstractMdpConfig, Edge, Planner, SkillGraph, Vertex},
    envs::{Rng, Seed},
};
use rand::RngExt;

use crate::workload::Workload;

/// All workloads of planning.
pub(crate) fn planning() -> Vec<Workload> {
    vec![anew("dense", 1_000, 999), anew("sparse", 1_000, 10), anew("sparse", 10_000, 10), mended(10_000, 10)]
}

/// A plan anew on `n` vertices with so many edges from each.
fn anew(kind: &str, n: u32, edges: u32) -> Workload {
    let (graph, planner) = (graph(n, edges), planner());
    Workload::repeated(&format!("planning/value iteration, {n} vertices, {kind}"), move || {
        black_box(planner.plan(black_box(&graph), Vertex(0)));
    })
}

/// Mending a plan: one edge after the other becomes what another one was.
fn mended(n: u32, edges: u32) -> Workload {
    let (mut graph, planner, mut rng) = (graph(n, edges), planner(), Seed(1).stream("bench", 0));
    let mut plan = planner.plan(&graph, Vertex(0));
    let all: Vec<_> = graph.edges().map(|(i, j, _)| (i, j)).collect();
    Workload::repeated(&format!("planning/one changed edge, {n} vertices, sparse"), move || {
        let (i, j) = all[rng.random_range(0..all.len())];
        *graph.change(i, j) = edge(&mut rng);
        planner.replan(&graph, Vertex(0), &mut plan, &[(i, j)]);
        black_box(&plan);
    })
}

fn planner() -> AbstractMdp {
    AbstractMdp::new(&AbstractMdpConfig::default())
}

/// Edges to vertices drawn at random, without rewards.
fn graph(n: u32, edges: u32) -> SkillGraph {
    let mut rng = Seed(0).stream("bench", 0);
    let mut graph = SkillGraph::default();
    (0..n).for_each(|_| _ = graph.add());
    for i in 0..n {
        if edges + 1 == n {
            (0..n).filter(|j| *j != i).for_each(|j| *graph.change(Vertex(i), Vertex(j)) = edge(&mut rng));
        } else {
            for _ in 0..edges {
                let j = (i + rng.random_range(1..n)) % n;
                *graph.change(Vertex(i), Vertex(j)) = edge(&mut rng);
            }
        }
    }
    graph
}

fn edge(rng: &mut Rng) -> Edge {
    let (value, tries) = (rng.random_range(0.0..1.0), rng.random_range(0..100));
    Edge { connected: true, value, tries, ..Edge::default() }
}
