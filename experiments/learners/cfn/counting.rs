//! Whether novelty by networks is a count, where counts are known.

use std::sync::Arc;

use inroads::{
    agents::{
        Context, Encoder, Novelty,
        nets::{Backend, TorsoConfig},
        novelty::{Cfn, CfnConfig, Rnd, RndConfig},
    },
    envs::Seed,
    statistics::mean_interval,
};
use rand::{RngExt, seq::SliceRandom};
use serde::Serialize;

use crate::support::over_seeds;

const STATES: usize = 64;

/// How often a state is visited; 4,177 visits in all.
fn visits(state: usize) -> usize {
    [1, 4, 16, 64, 256][state % 5]
}

/// A state by its number.
struct Numbered;

impl Encoder<usize> for Numbered {
    fn width(&self) -> usize {
        STATES
    }

    fn write(&self, state: &usize, out: &mut [f32]) {
        out.fill(0.0);
        out[*state] = 1.0;
    }
}

/// What came of one novelty.
#[derive(Serialize)]
pub(super) struct Row {
    novelty: &'static str,
    /// With 1/√N, a seed each.
    correlation: Vec<f64>,
    /// Of ranks.
    rank_correlation: Vec<f64>,
    /// Mean |bonus − 1/√N|; none where a bonus has no scale.
    error: Option<Vec<f64>>,
}

/// Builds a novelty of a seed.
type Build = fn(u64) -> Box<dyn Novelty<usize>>;

/// The networks of `algorithms.md` 4.2, an update a visit.
fn cfn(seed: u64, prior: bool) -> Box<dyn Novelty<usize>> {
    let torso = TorsoConfig { hidden: vec![128], ..TorsoConfig::default() };
    let config = CfnConfig { torso, batch: 256, warm_up: 256, prior, ..CfnConfig::default() };
    let rng = &mut Seed(seed).stream("novelty", 0);
    Box::new(Cfn::new(Arc::new(Numbered), &config, Backend::default(), rng))
}

fn rnd(seed: u64) -> Box<dyn Novelty<usize>> {
    let torso = TorsoConfig { hidden: vec![128], ..TorsoConfig::default() };
    // Each visit is learned from once.
    let config = RndConfig { torso, rate: 1e-3, batch: 1, warm_up: 256, ..RndConfig::default() };
    let rng = &mut Seed(seed).stream("novelty", 0);
    Box::new(Rnd::new(Arc::new(Numbered), &config, Backend::default(), rng))
}

const NOVELTIES: [(&str, Build); 3] =
    [("CFN", |seed| cfn(seed, true)), ("CFN without prior", |seed| cfn(seed, false)), ("RND", rnd)];

/// The best that twenty coins can say: the root of the mean square of their means, state by state.
fn coins(seed: u64) -> Vec<f64> {
    let rng = &mut Seed(seed).stream("coins", 0);
    let mut mean = |n: usize| (0..n).map(|_| if rng.random() { 1.0 } else { -1.0 }).sum::<f64>() / n as f64;
    let mut bonus = |state| (0..20).map(|_| mean(visits(state)).powi(2)).sum::<f64>() / 20.0;
    (0..STATES).map(|state| bonus(state).sqrt()).collect()
}

/// Bonuses of all states after all visits.
fn found(build: Build, seed: u64) -> Vec<f64> {
    let mut all: Vec<usize> = (0..STATES).flat_map(|state| vec![state; visits(state)]).collect();
    all.shuffle(&mut Seed(seed).stream("order", 0));
    let (mut novelty, mut ctx) = (build(seed), Context::training(Seed(seed), 0));
    (0..all.len() as u32).for_each(|step| novelty.visit((0, step), &all, &mut ctx));
    let states: Vec<_> = (0..STATES).collect();
    novelty.bonuses(&states.iter().collect::<Vec<_>>()).into_iter().map(f64::from).collect()
}

pub(super) fn run(seeds: u64) -> Vec<Row> {
    println!("64 states visited 1, 4, 16, 64 or 256 times in any order:");
    let truth: Vec<f64> = (0..STATES).map(|state| (visits(state) as f64).sqrt().recip()).collect();
    let row = |name: &'static str, runs: Vec<Vec<f64>>| {
        let correlation: Vec<_> = runs.iter().map(|run| pearson(run, &truth)).collect();
        let rank_correlation: Vec<_> = runs.iter().map(|run| pearson(&ranks(run), &ranks(&truth))).collect();
        let error =
            |run: &Vec<f64>| run.iter().zip(&truth).map(|(x, y)| (x - y).abs()).sum::<f64>() / STATES as f64;
        let error: Option<Vec<_>> = (name != "RND").then(|| runs.iter().map(error).collect());
        println!(
            "  {name:18} correlation {:.4}, of ranks {:.4}, mean error {}",
            mean_interval(&correlation),
            mean_interval(&rank_correlation),
            error.as_deref().map_or("no scale".into(), |error| format!("{:.4}", mean_interval(error)))
        );
        Row { novelty: name, correlation, rank_correlation, error }
    };
    let mut rows = vec![row("20 coins, counted", over_seeds(seeds, coins))];
    rows.extend(NOVELTIES.map(|(name, build)| row(name, over_seeds(seeds, |seed| found(build, seed)))));
    rows
}

/// Pearson's correlation.
fn pearson(x: &[f64], y: &[f64]) -> f64 {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (mx, my) = (mean(x), mean(y));
    let sum = |f: &dyn Fn(f64, f64) -> f64| x.iter().zip(y).map(|(a, b)| f(a - mx, b - my)).sum::<f64>();
    sum(&|a, b| a * b) / (sum(&|a, _| a * a) * sum(&|_, b| b * b)).sqrt()
}

/// Ranks from 0, equal values in the middle of theirs.
fn ranks(values: &[f64]) -> Vec<f64> {
    let rank = |x: &f64| {
        let below = values.iter().filter(|y| *y < x).count();
        let equal = values.iter().filter(|y| *y == x).count();
        below as f64 + (equal as f64 - 1.0) / 2.0
    };
    values.iter().map(rank).collect()
}
