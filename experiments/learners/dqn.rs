//! The DQN family on two worlds whose answers are known: DoorKey-5x5 (another layout in each episode) and Taxi, both as
//! symbols; and what the parts of Rainbow are worth there at equal steps.
//!
//! Training is watched every 5,000 steps by 20 frozen episodes, and after its end by 100. Starts of evaluations are none of
//! training's. Each variant is the agent `dqn` of the registry with a few settings; none was tuned by itself but the
//! default (which was, on other seeds).

use inroads::{
    agents::{Actor, Context, Transition, episode, nets::Backend},
    assembly::{self, Vector},
    config::Config,
    envs::{
        Environment, Seed,
        registry::{self, AnyEnvironment},
    },
    figures::{Level, Panel, Series, Summary, curves},
    statistics::{Estimate, mean_interval, median},
};
use rand::RngExt;
use serde::Serialize;

use crate::{
    Options,
    support::{Done, over_seeds, write},
};

const SEEDS: u64 = 5;
/// Steps between two looks.
const EVERY: u64 = 5000;
/// Episodes a look, and after training.
const LOOK: u64 = 20;
const LAST: u64 = 100;
/// What counts as solved.
const SOLVED: f64 = 0.95;

/// Worlds and their steps of training.
const WORLDS: [(&str, u64); 2] = [("door-key-5x5", 100_000), ("taxi", 150_000)];

const PLAIN: &[&str] = &["learner.double=false", "learner.dueling=false", "replay.prioritised=false"];
/// Taxi's returns: 20 at most, −1 for ever is −20, and each of what is not allowed costs 10 more.
const ATOMS: &[&str] = &["learner.atoms.number=51", "learner.atoms.low=-50", "learner.atoms.high=20"];
/// DoorKey pays 1 at most, once.
const ATOMS_OF_ONE: &[&str] = &["learner.atoms.number=51", "learner.atoms.low=-1", "learner.atoms.high=1"];
/// Hessel 2018, but for its rates.
const RAINBOW: &[&str] = &[
    "learner.atoms.number=51",
    "learner.atoms.low=-1",
    "learner.atoms.high=1",
    "learner.noise=0.5",
    "learner.epsilon.start=0",
    "learner.epsilon.end=0",
    "replay.returns=3",
];

/// World (by number), variant, and what that sets; what matters most first.
const TRIALS: [(usize, &str, &[&str]); 8] = [
    (1, "C51", ATOMS),
    (0, "dqn", &[]),
    (1, "dqn", &[]),
    (0, "plain DQN", PLAIN),
    (1, "plain DQN", PLAIN),
    (1, "3 steps", &["replay.returns=3"]),
    (0, "C51", ATOMS_OF_ONE),
    (0, "Rainbow", RAINBOW),
];

#[derive(Serialize)]
struct Row {
    world: String,
    variant: String,
    /// What is not as the agent's defaults have it.
    set: Vec<String>,
    steps: u64,
    /// Success after training, over seeds.
    success: Estimate,
    /// Seeds with at least 95 % after training.
    solved: usize,
    /// Median steps until two looks in a row had 95 %; none where half of the seeds never did.
    steps_to_solve: Option<f64>,
    seeds: Vec<Run>,
}

#[derive(Serialize)]
struct Run {
    seed: u64,
    /// Steps and success at each look.
    curve: Vec<(u64, f64)>,
    updates: u64,
    /// Over the last episodes.
    success: f64,
    /// Mean steps of those that succeeded.
    length: f64,
}

impl Run {
    /// Steps at the first of two looks in a row that found it solved.
    fn solved(&self) -> Option<u64> {
        self.curve
            .windows(2)
            .find(|pair| pair.iter().all(|(_, success)| *success >= SOLVED))
            .map(|pair| pair[0].0)
    }
}

type Env = dyn Environment<Observation = Vector, Action = usize> + Send;
type Attempt<T> = Result<T, String>;

pub(crate) fn run(options: &Options) -> Done {
    let seeds = options.seeds.unwrap_or(SEEDS);
    let mut rows = Vec::new();
    println!(
        "{:<14} {:<10} {:>7}  solved  success            median steps to solve",
        "world", "variant", "steps"
    );
    for (name, _) in WORLDS {
        let runs = over_seeds(seeds, |seed| random(name, seed).map_err(|error| error.to_string()));
        rows.push(row(name, "random", &[], 0, runs.into_iter().collect::<Attempt<_>>()?));
    }
    for (world, variant, set) in TRIALS {
        let (name, steps) = WORLDS[world];
        let runs = over_seeds(seeds, |seed| train(name, steps, set, seed).map_err(|error| error.to_string()));
        rows.push(row(name, variant, set, steps, runs.into_iter().collect::<Attempt<_>>()?));
        // After each variant, so that a run that is cut short has its first results.
        write(options, "dqn", &rows)?;
        let panels: Vec<_> = WORLDS.iter().map(|(name, _)| panel(name, &rows)).collect();
        curves(options.out.join("dqn.png"), &panels)?;
    }
    Ok(())
}

/// The curves of all variants in a world.
fn panel(name: &str, rows: &[Row]) -> Panel {
    let (random, learned): (Vec<&Row>, Vec<&Row>) =
        rows.iter().filter(|row| row.world == name).partition(|row| row.steps == 0);
    let points = |run: &Run| run.curve.iter().map(|(steps, success)| (*steps as f64, *success)).collect();
    let series = learned.iter().zip(1..).map(|(row, colour)| Series {
        label: row.variant.clone(),
        colour,
        runs: row.seeds.iter().map(points).collect(),
    });
    let level = |row: &&Row| Level { label: row.variant.clone(), y: row.success.value };
    Panel {
        title: name.into(),
        x_label: "environment steps".into(),
        y_label: "success, frozen".into(),
        y_range: Some((0.0, 1.0)),
        summary: Summary::MeanAndInterval,
        series: series.collect(),
        levels: random.iter().map(level).collect(),
        ..Panel::default()
    }
}

fn row(world: &str, variant: &str, set: &[&str], steps: u64, seeds: Vec<Run>) -> Row {
    let last: Vec<f64> = seeds.iter().map(|run| run.success).collect();
    let never = f64::INFINITY;
    let first: Vec<f64> = seeds.iter().map(|run| run.solved().map_or(never, |steps| steps as f64)).collect();
    let row = Row {
        world: world.into(),
        variant: variant.into(),
        set: set.iter().map(|s| (*s).to_owned()).collect(),
        steps,
        success: mean_interval(&last),
        solved: last.iter().filter(|success| **success >= SOLVED).count(),
        steps_to_solve: median(&first).filter(|steps| steps.is_finite()),
        seeds,
    };
    println!(
        "{world:<14} {variant:<10} {steps:>7}  {}/{}     {:.3}  {}",
        row.solved,
        row.seeds.len(),
        row.success,
        row.steps_to_solve.map_or("never".into(), |steps| format!("{steps:.0}"))
    );
    row
}

fn world(name: &str) -> Result<Box<Env>, Box<dyn std::error::Error>> {
    match registry::make(name)? {
        AnyEnvironment::Choices(env) => Ok(env),
        _ => Err("the world has no choices, or is not seen as symbols".into()),
    }
}

/// Share of episodes that succeed, and their mean length.
fn evaluate(
    env: &mut Env,
    actor: &mut dyn Actor<Vector, usize>,
    seed: Seed,
    episodes: u64,
) -> Result<(f64, f64), Box<dyn std::error::Error>> {
    let (mut successes, mut steps) = (0_u64, 0_u64);
    for index in 0..episodes {
        let mut ctx = Context::evaluation(seed, index);
        let summary = episode(env, actor, seed.number("evaluate-start", index), &mut ctx, |_, _| {})?;
        if summary.success {
            successes += 1;
            steps += u64::from(summary.steps);
        }
    }
    Ok((successes as f64 / episodes as f64, steps as f64 / successes as f64))
}

fn train(name: &str, steps: u64, set: &[&str], number: u64) -> Result<Run, Box<dyn std::error::Error>> {
    let mut env = world(name)?;
    let config =
        set.iter().try_fold(Config::defaults("dqn", name)?, |config, set| config.with_assignment(set))?;
    let build = assembly::agent("dqn")?.discrete.ok_or("the agent cannot choose")?;
    let seed = Seed(number);
    let mut agent = build(env.spec(), &config.agent, Backend::default(), seed)?;
    let (mut done, mut curve) = (0, Vec::new());
    for index in 0.. {
        let mut ctx = Context::training(seed, index);
        done += u64::from(
            episode(&mut *env, &mut *agent, seed.number("train-start", index), &mut ctx, |_, _| {})?.steps,
        );
        if done / EVERY > curve.len() as u64 {
            curve.push((done, evaluate(&mut *env, &mut *agent.frozen(), seed, LOOK)?.0));
        }
        if done >= steps {
            break;
        }
    }
    let (success, length) = evaluate(&mut *env, &mut *agent.frozen(), seed, LAST)?;
    let updates = agent.updates().first().map_or(0, |(_, updates)| *updates);
    Ok(Run { seed: number, curve, updates, success, length })
}

/// Who chooses at random.
struct Random(usize);

impl Actor<Vector, usize> for Random {
    fn begin(&mut self, _: &Vector, _: &mut Context) {}

    fn act(&mut self, _: &Vector, ctx: &mut Context) -> usize {
        ctx.acting.random_range(0..self.0)
    }

    fn observe(&mut self, _: &Transition<Vector, usize>, _: &mut Context) {}
}

fn random(name: &str, number: u64) -> Result<Run, Box<dyn std::error::Error>> {
    let mut env = world(name)?;
    let mut actor = Random(env.spec().action.choices());
    let (success, length) = evaluate(&mut *env, &mut actor, Seed(number), LAST)?;
    Ok(Run { seed: number, curve: Vec::new(), updates: 0, success, length })
}
