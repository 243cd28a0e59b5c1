//! TD3 with hindsight on the open arena: a point robot starts anywhere and goes to the middle (thesis 4.2.3).
//!
//! Episodes have 100 steps, in training and when frozen, and the goal is reached within 0.6 m. Training ends with the episode
//! that reaches 30,000 steps; one update every two steps, everything else as the registry has `td3-her`. Beside it the same
//! agent that learns of its own goal only. The point is rllab's, which goes 1 m a step.
//!
//! Price: 2 rows × 5 seeds × 15,000 updates of 4 ms: some 10 core-minutes.

use inroads::{
    agents::{Context, episode, nets::Backend},
    assembly::{self, BoxedAgent, Vector},
    config::Config,
    envs::{
        Environment, Seed, TimeLimit,
        maze::{PointMaze, Stride, catalogue::REACHER},
    },
    statistics::{Estimate, Verdict, superiority, wilson},
};
use serde::Serialize;

use crate::{
    Options,
    support::{Done, over_seeds, write},
};

const AGENT: &str = "td3-her";
const SET: &[&str] = &["memory.updates_per_step=0.5"];
const ALONE: &str = "hindsight.strategy=none";
/// Steps an episode, trained or frozen.
const LIMIT: u32 = 100;
const STEPS: u64 = 30_000;
/// Training steps between two frozen evaluations of so many episodes, and episodes of the last one.
const EVERY: u64 = 5000;
const EPISODES: u64 = 40;
const LAST: u64 = 200;
const SEEDS: u64 = 5;

#[derive(Serialize)]
struct Result {
    agent: &'static str,
    set: &'static [&'static str],
    steps: u64,
    limit: u32,
    tolerance: f64,
    rows: [Row; 2],
    /// Of "with hindsight more frozen episodes reach the goal than without".
    comparison: (Estimate, Verdict),
}

#[derive(Serialize)]
struct Row {
    hindsight: bool,
    /// Frozen episodes that reached the goal, of all seeds together.
    success: Estimate,
    /// Their mean steps.
    mean_steps: f64,
    trials: Vec<Trial>,
}

#[derive(Clone, Debug, Serialize)]
struct Trial {
    seed: u64,
    /// Training steps, and share of frozen episodes that reached the goal.
    curve: Vec<(u64, f64)>,
    reached: u64,
    /// Mean steps of those.
    steps: f64,
}

pub(crate) fn run(options: &Options) -> Done {
    let seeds = options.seeds.unwrap_or(SEEDS);
    let row = |hindsight: bool| -> std::result::Result<Row, String> {
        let trials: std::result::Result<Vec<_>, String> =
            over_seeds(seeds, |seed| trial(hindsight, seed)).into_iter().collect();
        let trials = trials?;
        let reached = trials.iter().map(|trial| trial.reached).sum();
        let steps: f64 = trials.iter().map(|trial| trial.steps * trial.reached as f64).sum();
        let success = wilson(reached, LAST * trials.len() as u64);
        let row = Row { hindsight, success, mean_steps: steps / reached as f64, trials };
        let label = if hindsight { "TD3 + HER" } else { "TD3" };
        let each: Vec<_> = row.trials.iter().map(|trial| trial.reached as f64 / LAST as f64).collect();
        println!("{label:<10} {success:.3} in {:.1} steps; seeds {each:?}", row.mean_steps);
        Ok(row)
    };
    let rows = [row(true)?, row(false)?];
    let shares = |row: &Row| row.trials.iter().map(|trial| trial.reached as f64).collect::<Vec<_>>();
    let better = superiority(&shares(&rows[0]), &shares(&rows[1]));
    println!("hindsight reaches more often: P = {better}, {:?}", Verdict::of(&better));
    let comparison = (better, Verdict::of(&better));
    let tolerance = REACHER.tolerance;
    write(
        options,
        "td3-reacher",
        &Result { agent: AGENT, set: SET, steps: STEPS, limit: LIMIT, tolerance, rows, comparison },
    )
}

type Env = TimeLimit<PointMaze>;
type Agent = BoxedAgent<Vector, Vector>;

fn trial(hindsight: bool, number: u64) -> std::result::Result<Trial, String> {
    let told = |error: &dyn std::error::Error| error.to_string();
    let maze = PointMaze::striding(&REACHER, Stride::Rllab).map_err(|error| told(&error))?;
    let mut env = TimeLimit::new(maze, LIMIT);
    let mut config = Config::defaults(AGENT, REACHER.name).map_err(|error| told(&error))?;
    for assignment in SET.iter().chain((!hindsight).then_some(&ALONE)) {
        config = config.with_assignment(assignment).map_err(|error| told(&error))?;
    }
    let build =
        assembly::agent(AGENT).map_err(|error| told(&error))?.continuous.ok_or("it acts by numbers")?;
    let seed = Seed(number);
    let mut agent =
        build(env.spec(), &config.agent, Backend::default(), seed).map_err(|error| told(&error))?;

    let (mut curve, mut steps, mut next) = (Vec::new(), 0, EVERY);
    for index in 0.. {
        let start = seed.number("train-start", index);
        let mut ctx = Context::training(seed, index);
        let summary = episode(&mut env, &mut *agent, start, &mut ctx, |_, _| {});
        steps += u64::from(summary.map_err(|error| told(&error))?.steps);
        if steps >= STEPS {
            break;
        }
        if steps >= next {
            next += EVERY;
            let (reached, mean) = frozen(&mut env, &agent, seed, EPISODES)?;
            eprintln!(
                "hindsight {hindsight}, seed {number}, {steps}: {reached} of {EPISODES}, {mean:.1} steps"
            );
            curve.push((steps, reached as f64 / EPISODES as f64));
        }
    }
    let (reached, mean) = frozen(&mut env, &agent, seed, LAST)?;
    curve.push((steps, reached as f64 / LAST as f64));
    eprintln!("hindsight {hindsight}, seed {number}, last: {reached} of {LAST}, {mean:.1} steps");
    Ok(Trial { seed: number, curve, reached, steps: mean })
}

/// How many frozen episodes reach the goal, and in how many steps.
fn frozen(
    env: &mut Env,
    agent: &Agent,
    seed: Seed,
    episodes: u64,
) -> std::result::Result<(u64, f64), String> {
    let (mut reached, mut steps) = (0, 0);
    for index in 0..episodes {
        let mut ctx = Context::evaluation(seed, index);
        let start = seed.number("evaluate-start", index);
        let summary = episode(env, &mut *agent.frozen(), start, &mut ctx, |_, _| {});
        let summary = summary.map_err(|error| error.to_string())?;
        if summary.success {
            reached += 1;
            steps += u64::from(summary.steps);
        }
    }
    Ok((reached, steps as f64 / reached as f64))
}
