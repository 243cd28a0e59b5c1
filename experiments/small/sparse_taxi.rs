//! Figures 8.3 and 8.4 in small: proto-goals against Q-learning on SparseTaxi.
//!
//! Three agents with the same table, the same replay ratio (32 clips a step) and the same starts: Q-learning that is
//! ε-greedy over values that begin at 0, Q-learning with optimistic initial values, and proto-goals. Each is tuned over some
//! settings on seeds of their own. An evaluation is frozen and goes over all 300 starts. What is compared are the steps of
//! the environment in training until two evaluations in a row solve 95 % of the starts.
//!
//! Price: (15 settings × 2 seeds + 3 agents × 20 seeds) × 40,000 steps, about 0.02 ms a step for Q-learning and 0.15 for
//! proto-goals: some 7 core-minutes.

use std::ops::Range;

use inroads::{
    discovery::record::GoalState,
    figures::{Panel, Series, Summary, curves},
    statistics::{Estimate, Verdict, mean_interval, median, superiority},
};
use serde::Serialize;

use crate::{
    Options,
    frozen::{Failure, Protocol, Recipe, Trial, trials},
    support::{Done, write},
};

const STEPS: u64 = 40_000;
/// Seeds of the tuning: none of those that are reported.
const TUNING: Range<u64> = 1000..1002;
const SEEDS: u64 = 20;

/// The settings that each agent is tuned over, beside a batch of 32 and no warm-up for all.
fn candidates() -> [(Recipe, &'static [&'static [&'static str]]); 3] {
    let common = ["memory.warm_up=1", "policy.batch=32"];
    [
        (
            Recipe::new("ε-greedy Q-learning", "q-learning", &[&common[..], &["policy.initial=0"]].concat()),
            &[
                &["policy.rate=0.5", "policy.epsilon=0.1"],
                &["policy.rate=1", "policy.epsilon=0.1"],
                &["policy.rate=0.5", "policy.epsilon=0.3"],
                &["policy.rate=1", "policy.epsilon=0.3"],
                &["policy.rate=1", "policy.epsilon=0.5"],
            ],
        ),
        (
            Recipe::new("optimistic Q-learning", "q-learning", &common),
            &[
                &["policy.rate=0.5", "policy.initial=0.1"],
                &["policy.rate=1", "policy.initial=0.1"],
                &["policy.rate=1", "policy.initial=0.5"],
                &["policy.rate=1", "policy.initial=1"],
                &["policy.rate=1", "policy.initial=0.5", "policy.epsilon=0"],
            ],
        ),
        (
            Recipe::new("proto-goals", "proto-goals", &[]),
            &[
                &[],
                &["goals.task_share=0.1"],
                &["goals.task_share=0.5"],
                &["goals.hindsight=5"],
                &["policy.rate=0.5"],
            ],
        ),
    ]
}

#[derive(Serialize)]
struct Result {
    protocol: Protocol,
    agents: Vec<Row>,
    comparisons: Vec<Comparison>,
    goals: GoalsFound,
}

#[derive(Serialize)]
struct Row {
    recipe: Recipe,
    /// Median steps of each setting that it was tuned over; none where one of the seeds never got there.
    tuned: Vec<(Vec<String>, Option<f64>)>,
    /// Seeds that got there.
    solved: usize,
    /// Medians over seeds, those that never got there counting as the end of training.
    steps: f64,
    episodes: f64,
    /// Steps taken over fewest steps, at that evaluation and at the last.
    ratio_when_solved: Estimate,
    final_ratio: Estimate,
    final_success: Estimate,
    trials: Vec<Trial>,
}

#[derive(Serialize)]
struct Comparison {
    claim: String,
    superiority: Estimate,
    verdict: Verdict,
}

/// What the goal space was after the first evaluation that had observed every proto-goal.
#[derive(Default, Serialize)]
struct GoalsFound {
    seeds: usize,
    /// Seeds in which all 25 cells were plausible, all 5 places of the passenger, no destination.
    all_cells: usize,
    all_places: usize,
    no_destination: usize,
    /// Places of the passenger that were plausible, seed by seed; and at the end of training.
    places: Vec<usize>,
    places_at_the_end: Vec<usize>,
}

pub(crate) fn run(options: &Options) -> Done {
    let seeds = options.seeds.unwrap_or(SEEDS);
    let protocol = Protocol::taxi(STEPS)?;
    let mut agents = Vec::new();
    for (recipe, settings) in candidates() {
        let (recipe, tuned) = tune(&recipe, settings, &protocol)?;
        let trials = trials(&recipe, &protocol, 0..seeds)?;
        agents.push(row(recipe, tuned, trials));
    }
    let steps: Vec<Vec<f64>> = agents.iter().map(|row| row.trials.iter().map(steps).collect()).collect();
    let compare = |x: usize, y: usize| {
        // Fewer steps are better.
        let superiority = superiority(&steps[y], &steps[x]);
        let claim = format!("{} needs fewer steps than {}", agents[x].recipe.label, agents[y].recipe.label);
        Comparison { claim, superiority, verdict: Verdict::of(&superiority) }
    };
    let comparisons = vec![compare(2, 0), compare(2, 1), compare(1, 0)];
    let goals = found(&agents[2].trials);
    print(&agents, &comparisons, &goals);
    draw(options, &agents)?;
    write(options, "sparse-taxi", &Result { protocol, agents, comparisons, goals })
}

/// Steps until it was solved; those of all training where it was not.
fn steps(trial: &Trial) -> f64 {
    trial.solved().map_or(STEPS as f64, |point| point.env_steps as f64)
}

type Tuned = Vec<(Vec<String>, Option<f64>)>;

/// The recipe with the setting whose seeds need the fewest steps, and all that was found.
fn tune(
    recipe: &Recipe,
    settings: &[&[&str]],
    protocol: &Protocol,
) -> std::result::Result<(Recipe, Tuned), Failure> {
    let protocol = &Protocol { until_solved: true, ..protocol.clone() };
    let (mut tuned, mut best) = (Vec::new(), (f64::INFINITY, recipe.clone()));
    for set in settings {
        let candidate = recipe.with(&recipe.label, set);
        let trials = trials(&candidate, protocol, TUNING)?;
        let mean = trials.iter().map(steps).sum::<f64>() / trials.len() as f64;
        let solved = trials.iter().all(|trial| trial.solved().is_some());
        tuned.push((set.iter().map(|s| (*s).to_owned()).collect(), solved.then_some(mean)));
        if mean < best.0 {
            best = (mean, candidate);
        }
    }
    Ok((best.1, tuned))
}

fn row(recipe: Recipe, tuned: Tuned, trials: Vec<Trial>) -> Row {
    let over = |of: &dyn Fn(&Trial) -> Option<f64>| trials.iter().filter_map(of).collect::<Vec<_>>();
    let end = |trial: &Trial| trial.points.last().cloned();
    let episodes = over(&|trial| trial.solved().or(trial.points.last()).map(|point| point.episodes as f64));
    Row {
        solved: trials.iter().filter(|trial| trial.solved().is_some()).count(),
        steps: median(&over(&|trial| Some(steps(trial)))).unwrap_or(f64::NAN),
        episodes: median(&episodes).unwrap_or(f64::NAN),
        ratio_when_solved: mean_interval(&over(&|trial| trial.solved().map(|point| point.ratio))),
        final_ratio: mean_interval(&over(&|trial| end(trial).map(|point| point.ratio))),
        final_success: mean_interval(&over(&|trial| end(trial).map(|point| point.success))),
        recipe,
        tuned,
        trials,
    }
}

/// Bits of the taxi's cells, the passenger's places, the destinations.
const CELLS: usize = 25;
const PLACES: usize = 5;
const DESTINATIONS: usize = 4;

fn found(trials: &[Trial]) -> GoalsFound {
    let mut found = GoalsFound { seeds: trials.len(), ..GoalsFound::default() };
    for trial in trials {
        let count =
            |states: &[GoalState]| states.iter().filter(|state| **state >= GoalState::Plausible).count();
        let all = CELLS + PLACES + DESTINATIONS;
        let states: Vec<Vec<GoalState>> =
            trial.goals.iter().map(|goals| goals.iter().take(all).map(|goal| goal.state).collect()).collect();
        let full = states.iter().find(|states| states.len() == all && !states.contains(&GoalState::Unseen));
        let (Some(first), Some(last)) = (full, states.last()) else { continue };
        found.all_cells += usize::from(count(&first[..CELLS]) == CELLS);
        let places = count(&first[CELLS..CELLS + PLACES]);
        found.all_places += usize::from(places == PLACES);
        found.no_destination += usize::from(count(&first[CELLS + PLACES..]) == 0);
        found.places.push(places);
        found.places_at_the_end.push(count(&last[CELLS..CELLS + PLACES]));
    }
    found
}

fn print(agents: &[Row], comparisons: &[Comparison], goals: &GoalsFound) {
    println!("{:<22} solved   steps  episodes  steps/fewest then  at the end  success at the end", "agent");
    for row in agents {
        println!(
            "{:<22} {:>2}/{:<2} {:>9.0} {:>8.0}   {:.2}   {:.2}   {:.3}   {:?}",
            row.recipe.label,
            row.solved,
            row.trials.len(),
            row.steps,
            row.episodes,
            row.ratio_when_solved,
            row.final_ratio,
            row.final_success,
            row.recipe.set
        );
        for (set, steps) in &row.tuned {
            println!("    tuning {set:?}: {}", steps.map_or("not solved".into(), |s| format!("{s:.0}")));
        }
    }
    for Comparison { claim, superiority, verdict } in comparisons {
        println!("{claim}: P = {superiority}, {verdict:?}");
    }
    println!(
        "goal space after the first full evaluation, {} seeds: all cells {}, all places {}, no destination {}; places {:?}, at the end {:?}",
        goals.seeds,
        goals.all_cells,
        goals.all_places,
        goals.no_destination,
        goals.places,
        goals.places_at_the_end
    );
}

fn draw(options: &Options, agents: &[Row]) -> Done {
    let series = agents.iter().zip(1..).map(|(row, colour)| {
        let points = |trial: &Trial| trial.points.iter().map(|p| (p.env_steps as f64, p.success)).collect();
        Series { label: row.recipe.label.clone(), colour, runs: row.trials.iter().map(points).collect() }
    });
    let panel = Panel {
        title: "SparseTaxi, all 300 starts".into(),
        x_label: "environment steps".into(),
        y_label: "success, frozen".into(),
        y_range: Some((0.0, 1.0)),
        summary: Summary::MeanAndInterval,
        series: series.collect(),
        ..Panel::default()
    };
    Ok(curves(options.out.join("sparse-taxi.png"), &[panel])?)
}
