//! How true the probabilities of edges are: each is compared with how often the skill succeeds from the state in which its
//! vertex was reached last, restored.

use std::path::Path;

use inroads::{
    agents::{Context, Transition, episode},
    assembly::{graphs::ImDsg, parts::PlannerKind},
    discovery::graph::Vertex,
    envs::{
        Environment, Rng, Seed, Snapshot, TimeLimit,
        world::{Symbolic, World as Rules},
    },
    figures,
    statistics::{Estimate, mean_interval},
};
use rand::RngExt;
use serde::Serialize;

use super::{
    agents::{im_dsg, ours},
    worlds::{Visit, WORLDS, World},
};
use crate::support::over_seeds;

/// Edges a seed, and executions an edge.
const EDGES: usize = 400;
const TRIALS: u64 = 4;
/// Stretches of predictions.
const BINS: usize = 10;

/// Predictions in one stretch of [0, 1].
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Bin {
    edges: usize,
    predicted: f64,
    realised: f64,
}

/// The edges of one world.
#[derive(Serialize)]
pub(crate) struct Calibration {
    world: &'static str,
    steps: u64,
    /// Mean squared difference of probability and success, over seeds.
    brier: Estimate,
    /// The same of one who says everywhere what is the case on average.
    constant: Estimate,
    edges: usize,
    bins: Vec<Bin>,
    /// Of all edges: the probability, and the share of executions that succeeded.
    pairs: Vec<(f32, f32)>,
}

/// The worlds of the issue.
pub(crate) fn run(seeds: u64) -> Vec<Calibration> {
    WORLDS[..2].iter().map(|world| calibrate(*world, seeds)).collect()
}

/// Pairs of probability and success as the picture takes them.
fn reliability(label: &str, colour: usize, pairs: &[(f32, f32)]) -> figures::Calibration {
    let pairs = pairs.iter().map(|(p, truth)| (f64::from(*p), f64::from(*truth))).collect();
    figures::Calibration { label: label.into(), colour, pairs }
}

/// Draws how true the probabilities of edges are.
pub(crate) fn draw(worlds: &[Calibration], path: &Path) -> Result<(), figures::FigureError> {
    let series = worlds.iter().zip(1..).map(|(world, colour)| reliability(world.world, colour, &world.pairs));
    figures::reliability(path, "edges of IM-DSG's graphs", &series.collect::<Vec<_>>())
}

fn calibrate(world: World, seeds: u64) -> Calibration {
    let of_seeds = over_seeds(seeds, |seed| world.visit(seed, Measure { seed, world }));
    let brier = |pairs: &Vec<(f32, f32)>, says: &dyn Fn(f32) -> f64| {
        let error = |(p, truth): &(f32, f32)| {
            let (p, truth) = (says(*p), f64::from(*truth));
            // Of single executions, of which a share `truth` succeeded.
            truth * (1.0 - p).powi(2) + (1.0 - truth) * p.powi(2)
        };
        pairs.iter().map(error).sum::<f64>() / pairs.len().max(1) as f64
    };
    let mean = |pairs: &Vec<(f32, f32)>| {
        pairs.iter().map(|(_, truth)| f64::from(*truth)).sum::<f64>() / pairs.len().max(1) as f64
    };
    let scores: Vec<_> = of_seeds.iter().map(|pairs| brier(pairs, &|p| f64::from(p))).collect();
    let constants: Vec<_> = of_seeds.iter().map(|pairs| brier(pairs, &|_| mean(pairs))).collect();
    let pairs = of_seeds.concat();
    let drawn = reliability(world.name, 1, &pairs).bins(BINS);
    let bins: Vec<_> = drawn
        .into_iter()
        .map(|bin| Bin { edges: bin.count, predicted: bin.predicted, realised: bin.measured })
        .collect();
    let (brier, constant) = (mean_interval(&scores), mean_interval(&constants));
    println!("{}: {} edges, Brier {brier:.3}, of a constant {constant:.3}", world.name, pairs.len());
    for bin in &bins {
        println!("  predicted {:.2}, realised {:.2}, {} edges", bin.predicted, bin.realised, bin.edges);
    }
    Calibration { world: world.name, steps: world.budget, brier, constant, edges: pairs.len(), bins, pairs }
}

/// Trains, then tries edges.
struct Measure {
    seed: u64,
    world: World,
}

impl Visit for Measure {
    type Out = Vec<(f32, f32)>;

    fn visit<W: Rules + Snapshot + Send + 'static>(self, env: Symbolic<W>) -> Vec<(f32, f32)> {
        let mut env = TimeLimit::new(env, self.world.limit);
        let config = ours(PlannerKind::AbstractMdp);
        let mut agent = im_dsg(env.spec(), &config);
        let (seed, mut steps, mut number) = (Seed(self.seed), 0, 0);
        while steps < self.world.budget {
            let mut ctx = Context::training(seed, number);
            let start = seed.number("train-start", number);
            let summary = episode(&mut env, &mut agent, start, &mut ctx, |_, _| {});
            steps += u64::from(summary.expect("agents choose among the choices").steps);
            number += 1;
        }
        let graph = agent.method().graph();
        let mut edges: Vec<_> = graph.edges().map(|(i, j, edge)| (i, j, edge.value)).collect();
        let mut rng = seed.stream("edges", 0);
        let tried = edges.len().min(EDGES);
        (0..tried).for_each(|at| edges.swap(at, rng.random_range(at..graph.edges().count())));
        let mut pairs = Vec::with_capacity(tried);
        for (i, j, predicted) in &edges[..tried] {
            let Some((episode, step)) = agent.method().effects(*i).last().copied() else { continue };
            let Some(past) = agent.experience().episode(episode) else { continue };
            // The same episode again, up to that step: then there is most of an episode's time left, or none is needed.
            env.reset(seed.number("train-start", episode));
            let again =
                past.actions[..step as usize].iter().try_for_each(|action| env.step(action).map(drop));
            if again.is_err() || past.actions.len() as u32 - step < config.explorer.horizon {
                continue;
            }
            let here = env.save();
            let trial = |n| {
                executed(&mut env, &here, &agent, *j, config.explorer.horizon, &mut seed.stream("try", n))
            };
            let successes = (0..TRIALS).map(trial).filter(|reached| *reached).count();
            pairs.push((*predicted, successes as f32 / TRIALS as f32));
        }
        pairs
    }
}

/// Whether the skill of `to` succeeds from a restored state, without noise.
fn executed<E>(env: &mut E, here: &E::State, agent: &ImDsg, to: Vertex, horizon: u32, rng: &mut Rng) -> bool
where
    E: Environment<Observation = Vec<f32>, Action = usize> + Snapshot,
{
    env.load(here);
    let (mut before, mut after) = (Vec::new(), Vec::new());
    let mut ctx = Context::evaluation(Seed(rng.random()), 0);
    let mut actor = agent.watch(agent.method().calling(to));
    env.observe(&mut before);
    actor.begin(&before, &mut ctx);
    for _ in 0..horizon {
        let action = actor.act(&before, &mut ctx);
        let Ok(step) = env.step(&action) else { return false };
        env.observe(&mut after);
        if agent.method().vertices_at(&after).contains(&to) {
            return true;
        }
        if step.end.is_some() {
            return false;
        }
        let transition =
            Transition { before: &before, action: &action, reward: step.reward, after: &after, end: None };
        actor.observe(&transition, &mut ctx);
        std::mem::swap(&mut before, &mut after);
    }
    false
}
