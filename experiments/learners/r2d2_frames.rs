//! R2D2 learns DoorKey-5x5 from frames: MiniGrid's own tiles at 8 pixels, 40 × 40 × 3 bytes, one layout a seed.
//!
//! No bonus: choices are random at first and the task's reward is found by chance, in 6 to 8 % of random episodes. An
//! evaluation is frozen and has 50 episodes; it counts as failed with the third that fails, for then fewer than 95 % succeed.
//! Training ends with the second evaluation in a row that does not.
//!
//! Price: 5 seeds × at most 60,000 steps, an update every 8: at most 4 core-minutes a seed.

use std::{sync::Arc, time::Instant};

use inroads::{
    agents::{
        Agent, Context, Curious, Flat, Pace, Practice, Replay,
        dqn::Epsilon,
        encode::Patches,
        episode,
        nets::{Backend, TorsoConfig},
        r2d2::{R2d2, R2d2Config},
        replay::PriorityConfig,
    },
    envs::{
        Domain, Environment, Frame, Seed,
        registry::{self, AnyEnvironment},
        world::{Layout, See},
    },
    sim::raster::Format,
    statistics::median,
};
use serde::Serialize;

use crate::{
    Options,
    support::{Done, over_seeds, write},
};

const WORLD: &str = "door-key-5x5";
const SEEDS: u64 = 5;
const STEPS: u64 = 60_000;
/// Steps between evaluations.
const EVERY: u64 = 2500;
const EPISODES: u64 = 50;
/// Failed episodes with which an evaluation ends: fewer than 95 % can succeed then.
const FAILURES: u64 = 3;
/// Steps a sequence, and from the beginning of one to that of the next.
const SEQUENCE: [u32; 2] = [20, 10];
/// Steps an update.
const STEPS_AN_UPDATE: f32 = 8.0;

#[derive(Serialize)]
struct Result {
    world: &'static str,
    steps: u64,
    sequence: [u32; 2],
    steps_an_update: f32,
    config: R2d2Config,
    solved: usize,
    /// Median over seeds, those that never got there counting as the end of training.
    median_steps: f64,
    trials: Vec<Trial>,
}

#[derive(Clone, Debug, Serialize)]
struct Trial {
    seed: u64,
    /// Steps until the first of two evaluations in a row with at least 95 %.
    steps: Option<u64>,
    updates: u64,
    /// Of the last evaluation: share of episodes that succeeded, and their mean steps.
    success: f64,
    mean_steps: f64,
    /// Episodes of training that succeeded, and all.
    successes: u64,
    episodes: u64,
    /// Processor seconds, beside other work.
    seconds: f64,
}

pub(crate) fn run(options: &Options) -> Done {
    let config = config();
    let trials = over_seeds(options.seeds.unwrap_or(SEEDS), |seed| {
        let trial = trial(seed, &config);
        println!("{trial:?}");
        trial
    });
    println!(
        "{:>4} {:>8} {:>9} {:>9} {:>12} {:>9}",
        "seed", "steps", "updates", "success", "of training", "length"
    );
    for Trial { seed, steps, updates, success, mean_steps, successes, episodes, .. } in &trials {
        let steps = steps.map_or("never".to_owned(), |steps| steps.to_string());
        let training = format!("{successes}/{episodes}");
        println!(
            "{seed:>4} {steps:>8} {updates:>9} {:>7.0} % {training:>12} {mean_steps:>9.1}",
            100.0 * success
        );
    }
    let steps: Vec<_> = trials.iter().map(|trial| trial.steps.unwrap_or(STEPS) as f64).collect();
    let result = Result {
        world: WORLD,
        steps: STEPS,
        sequence: SEQUENCE,
        steps_an_update: STEPS_AN_UPDATE,
        config,
        solved: trials.iter().filter(|trial| trial.steps.is_some()).count(),
        median_steps: median(&steps).unwrap_or(f64::NAN),
        trials,
    };
    write(options, "r2d2-frames", &result)
}

fn config() -> R2d2Config {
    R2d2Config {
        torso: TorsoConfig { hidden: vec![128], ..TorsoConfig::default() },
        memory: 64,
        head: 64,
        rate: 5e-4,
        adam_epsilon: 1e-5,
        discount: 0.99,
        batch: 16,
        follow_every: 100,
        epsilon: Epsilon { start: 1.0, end: 0.1, updates: 2000 },
        ..R2d2Config::default()
    }
}

/// The world of a seed as frames.
fn world(seed: u64) -> Box<dyn Domain<Frame, usize>> {
    let (see, layout) = (Some(See::Pixels(Format::NATIVE)), Some(Layout::Fixed(seed)));
    match registry::make_with(WORLD, &registry::Options { see, layout, ..registry::Options::default() }) {
        Ok(AnyEnvironment::Frames(env)) => env,
        _ => unreachable!("a grid can be seen as pixels"),
    }
}

fn trial(seed: u64, config: &R2d2Config) -> Trial {
    let began = Instant::now();
    let mut env = world(seed);
    let encoder = Patches::new(&env.spec().observation, 0).expect("frames are cut into tiles");
    let choices = env.spec().action.choices();
    let rng = &mut Seed(seed).stream("initialise", 0);
    let learner = R2d2::new(Arc::new(encoder), choices, config, Backend::Flex, rng);
    let priorities = PriorityConfig { exponent: 0.9, correction: 0.6, ..PriorityConfig::default() };
    let replay = Replay::new(STEPS as usize).sequences(SEQUENCE[0], SEQUENCE[1], 0).prioritised(priorities);
    let pace = Pace { updates_per_step: 1.0 / STEPS_AN_UPDATE, warm_up: 1000 };
    let mut agent = Flat::new(Curious::new(learner, Practice::new(replay, pace)), STEPS as usize);

    let mut trial = Trial {
        seed,
        steps: None,
        updates: 0,
        success: 0.0,
        mean_steps: 0.0,
        successes: 0,
        episodes: 0,
        seconds: 0.0,
    };
    let mut steps = 0;
    while steps < STEPS {
        let mut ctx = Context::training(Seed(seed), trial.episodes);
        let played =
            episode(&mut env, &mut agent, trial.episodes, &mut ctx, |_, _| ()).expect("choices are legal");
        trial.episodes += 1;
        trial.successes += u64::from(played.success);
        let now = steps + u64::from(played.steps);
        if now / EVERY > steps / EVERY {
            evaluate(&agent, &mut trial);
            let again = trial.steps.is_some();
            trial.steps = if trial.success >= 0.95 { trial.steps.or(Some(now)) } else { None };
            if again && trial.steps.is_some() {
                break;
            }
        }
        steps = now;
    }
    trial.updates = agent.updates()[0].1;
    trial.seconds = began.elapsed().as_secs_f64();
    trial
}

fn evaluate(agent: &impl Agent<Frame, usize>, trial: &mut Trial) {
    let (mut env, mut actor) = (world(trial.seed), agent.frozen());
    let (mut played, mut failed, mut steps) = (0, 0, 0);
    while played < EPISODES && failed < FAILURES {
        let mut ctx = Context::evaluation(Seed(trial.seed), played);
        let found =
            episode(&mut env, &mut *actor, 1 << 32 | played, &mut ctx, |_, _| ()).expect("choices are legal");
        played += 1;
        failed += u64::from(!found.success);
        steps += if found.success { found.steps } else { 0 };
    }
    trial.success = (played - failed) as f64 / played as f64;
    trial.mean_steps = f64::from(steps) / (played - failed).max(1) as f64;
}
