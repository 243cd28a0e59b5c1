//! The ablation of 8.4.2: which attained goals to learn about in hindsight.
//!
//! Fifteen by novelty, fifteen uniformly, all, on SparseTaxi with everything else as the registry has it. The replay ratio is
//! the same for all: who learns about more goals learns less about each.
//!
//! Price: 3 settings × 20 seeds × 24,000 steps of 0.15 ms: some 4 core-minutes.

use inroads::statistics::{Estimate, Verdict, mean_interval, median, superiority};
use serde::Serialize;

use crate::{
    Options,
    frozen::{Protocol, Recipe, Trial, trials},
    support::{Done, write},
};

const STEPS: u64 = 24_000;
const SEEDS: u64 = 20;

#[derive(Serialize)]
struct Result {
    protocol: Protocol,
    rows: Vec<Row>,
    /// Of "novelty-weighted is better than …".
    comparisons: Vec<(String, Estimate, Verdict)>,
}

#[derive(Serialize)]
struct Row {
    recipe: Recipe,
    solved: usize,
    /// Median steps until it was solved; the end of training for those that never were.
    steps: f64,
    /// Mean of the success over all evaluations: the area below the learning curve.
    area: Estimate,
    trials: Vec<Trial>,
}

pub(crate) fn run(options: &Options) -> Done {
    let seeds = options.seeds.unwrap_or(SEEDS);
    let protocol = Protocol::taxi(STEPS)?;
    let mut rows = Vec::new();
    for (label, relabel) in [("novelty", "novel"), ("uniform", "uniform"), ("all attained", "all")] {
        let recipe = Recipe::new(label, "proto-goals", &[&format!("goals.relabel={relabel}")]);
        let trials = trials(&recipe, &protocol, 0..seeds)?;
        rows.push(Row {
            solved: trials.iter().filter(|trial| trial.solved().is_some()).count(),
            steps: median(&trials.iter().map(steps).collect::<Vec<_>>()).unwrap_or(f64::NAN),
            area: mean_interval(&trials.iter().map(area).collect::<Vec<_>>()),
            recipe,
            trials,
        });
    }
    let needed = |row: &Row| row.trials.iter().map(steps).collect::<Vec<_>>();
    let comparisons: Vec<_> = rows[1..]
        .iter()
        .map(|other| {
            let superiority = superiority(&needed(other), &needed(&rows[0]));
            let claim = format!("novelty needs fewer steps than {}", other.recipe.label);
            (claim, superiority, Verdict::of(&superiority))
        })
        .collect();
    for Row { recipe, solved, steps, area, trials } in &rows {
        println!(
            "{:<14} solved {solved:>2}/{:<2} steps {steps:>7.0} area {area:.3}",
            recipe.label,
            trials.len()
        );
    }
    for (claim, superiority, verdict) in &comparisons {
        println!("{claim}: P = {superiority}, {verdict:?}");
    }
    write(options, "hindsight", &Result { protocol, rows, comparisons })
}

fn steps(trial: &Trial) -> f64 {
    trial.solved().map_or(STEPS as f64, |point| point.env_steps as f64)
}

fn area(trial: &Trial) -> f64 {
    trial.points.iter().map(|point| point.success).sum::<f64>() / trial.points.len().max(1) as f64
}
