//! Chapter 7 in small: IM-DSG with and without planning against Q-learning with a bonus for counts and without, on three
//! worlds; and how true the probabilities of its edges are, measured from restored states.

mod agents;
mod calibration;
pub(crate) mod tuning;
mod worlds;

use inroads::{
    agents::{Agent, Context, episode},
    envs::{Environment, Seed},
    figures::{Panel, Series, Summary, curves},
    statistics::{Estimate, Verdict, median, superiority},
};
use serde::Serialize;

use self::{
    agents::AGENTS,
    worlds::{Domain, WORLDS},
};
use crate::{
    Options,
    support::{Done, over_seeds, write},
};

/// Seeds an agent unless told otherwise.
const SEEDS: u64 = 10;
/// Frozen episodes an evaluation.
const EVALUATED: u64 = 5;
/// Evaluations over a training.
const EVALUATIONS: u64 = 40;

/// What one training came to.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Run {
    /// Steps of the environment, and the share of frozen episodes after them that succeeded.
    curve: Vec<(u64, f64)>,
    /// Steps until the first of two evaluations in a row with at least 80 % success; the whole budget when there is none.
    solved: u64,
    /// Whether there is.
    ever: bool,
    /// Steps of the last frozen episodes that succeeded, on average.
    path: Option<f64>,
    /// Vertices of the graph in the end.
    vertices: usize,
}

type Boxed = Box<dyn Agent<Vec<f32>, usize>>;

/// Trains an agent for so many steps.
pub(crate) fn train(env: &mut Domain, agent: &mut Boxed, seed: u64, budget: u64) -> Run {
    let (seed, mut steps, mut number) = (Seed(seed), 0, 0);
    let (mut curve, mut path) = (Vec::new(), None);
    for evaluation in 1..=EVALUATIONS {
        while steps < budget * evaluation / EVALUATIONS {
            let mut ctx = Context::training(seed, number);
            let start = seed.number("train-start", number);
            let summary = episode(env, &mut **agent, start, &mut ctx, |_, _| {});
            steps += u64::from(summary.expect("agents choose among the choices").steps);
            number += 1;
        }
        let (mut successes, mut taken) = (0_u32, 0);
        for index in 0..EVALUATED {
            let mut ctx = Context::evaluation(seed, index);
            let start = seed.number("evaluate-start", index);
            let summary = episode(env, &mut *agent.frozen(), start, &mut ctx, |_, _| {});
            let summary = summary.expect("agents choose among the choices");
            successes += u32::from(summary.success);
            taken += if summary.success { summary.steps } else { 0 };
        }
        path = (successes > 0).then(|| f64::from(taken) / f64::from(successes));
        curve.push((steps, f64::from(successes) / EVALUATED as f64));
    }
    let solved = curve.windows(2).find(|two| two.iter().all(|(_, share)| *share >= 0.8)).map(|two| two[0].0);
    Run { curve, solved: solved.unwrap_or(budget), ever: solved.is_some(), path, vertices: 0 }
}

/// One agent in one world.
#[derive(Serialize)]
struct Row {
    agent: &'static str,
    /// Seeds that solved it.
    solved: usize,
    /// Median over seeds of the steps it took; the budget where a seed did not.
    median_steps: f64,
    runs: Vec<Run>,
}

/// One world.
#[derive(Serialize)]
struct World {
    world: &'static str,
    budget: u64,
    limit: u32,
    /// Success of the uniformly random policy, an episode, over the layouts of all seeds.
    random: Estimate,
    /// Whether that is little enough for a claim about exploration (at most 0.1 %).
    carries_exploration: bool,
    rows: Vec<Row>,
    claims: Vec<Claim>,
}

/// "X needs fewer steps than Y."
#[derive(Serialize)]
struct Claim {
    claim: String,
    superiority: Estimate,
    verdict: Verdict,
}

/// All of it.
#[derive(Serialize)]
struct Found {
    command: String,
    seeds: u64,
    worlds: Vec<World>,
    calibration: Vec<calibration::Calibration>,
}

/// Which is compared with which: indices of [`AGENTS`].
const CLAIMS: [(usize, usize); 4] = [(0, 2), (0, 3), (0, 1), (2, 3)];

pub(crate) fn run(options: &Options) -> Done {
    let seeds = options.seeds.unwrap_or(SEEDS);
    let mut worlds = Vec::new();
    let mut panels = Vec::new();
    for world in WORLDS {
        let random = worlds::random(world, seeds);
        println!(
            "{} (limit {}, {} steps a run): the random policy succeeds in {:.2} % [{:.2}, {:.2}] of all episodes",
            world.name,
            world.limit,
            world.budget,
            100.0 * random.value,
            100.0 * random.low,
            100.0 * random.high
        );
        let mut rows = Vec::new();
        for agent in AGENTS {
            let began = std::time::Instant::now();
            let runs = over_seeds(seeds, |seed| {
                let mut env = world.make(seed);
                let mut built = (agent.build)(env.spec());
                train(&mut env, &mut built, seed, world.budget)
            });
            let steps: Vec<_> = runs.iter().map(|run| run.solved as f64).collect();
            let solved = runs.iter().filter(|run| run.ever).count();
            let paths: Vec<_> = runs.iter().filter_map(|run| run.path).collect();
            let median_steps = median(&steps).unwrap_or(f64::NAN);
            println!(
                "  {:24} solved {solved:2} of {seeds}, median {median_steps:8.0} steps, path {:5.1}, {:.1} s",
                agent.name,
                median(&paths).unwrap_or(f64::NAN),
                began.elapsed().as_secs_f64()
            );
            rows.push(Row { agent: agent.name, solved, median_steps, runs });
        }
        let claims = CLAIMS.map(|(x, y)| {
            let fewer = |row: &Row| row.runs.iter().map(|run| -(run.solved as f64)).collect::<Vec<_>>();
            let superiority = superiority(&fewer(&rows[x]), &fewer(&rows[y]));
            let verdict = Verdict::of(&superiority);
            let claim = format!("{} needs fewer steps than {}", rows[x].agent, rows[y].agent);
            println!("  {claim}: {superiority}, {verdict:?}");
            Claim { claim, superiority, verdict }
        });
        panels.push(panel(world.name, &rows));
        worlds.push(World {
            world: world.name,
            budget: world.budget,
            limit: world.limit,
            carries_exploration: random.value <= 0.001,
            random,
            rows,
            claims: claims.into(),
        });
    }
    let calibration = calibration::run(seeds);
    let command = format!("cargo run --release --example small -- im-dsg --seeds {seeds}");
    let path = options.out.join("im-dsg-reliability.png");
    std::fs::create_dir_all(&options.out)?;
    calibration::draw(&calibration, &path)?;
    println!("wrote {}", path.display());
    write(options, "im-dsg", &Found { command, seeds, worlds, calibration })?;
    let path = options.out.join("im-dsg.png");
    curves(&path, &panels)?;
    println!("wrote {}", path.display());
    Ok(())
}

fn panel(title: &str, rows: &[Row]) -> Panel {
    let points = |run: &Run| run.curve.iter().map(|(steps, share)| (*steps as f64, *share)).collect();
    let series = rows.iter().zip(1..).map(|(row, colour)| Series {
        label: row.agent.into(),
        colour,
        runs: row.runs.iter().map(points).collect(),
    });
    Panel {
        title: title.into(),
        x_label: "environment steps".into(),
        y_label: "frozen success".into(),
        y_range: Some((0.0, 1.0)),
        summary: Summary::MeanAndInterval,
        series: series.collect(),
        ..Panel::default()
    }
}
