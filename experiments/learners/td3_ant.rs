//! TD3 on the ant that is paid for running forward (`ant`, Gymnasium's Ant-v5 on our simulator): 200,000 steps, beside an ant
//! that acts at random.
//!
//! One update every four steps (50,000 in all) on batches of 128, everything else as the registry has `td3`; Fujimoto's has one
//! a step on 256. Returns
//! of an episode are a sum of three things: what it ran, in metres times 20; 1 for every step upright; minus what it
//! exerted. So they are told apart. Random actions are exerted at 4/3 a step and hardly run, so their mean return is below
//! zero, of which "three times" says nothing: what is asked for is three times the random return *above* zero and in absolute
//! value, and the distance beside it.
//!
//! Price: 5 seeds × 50,000 updates of 2 ms and 250,000 steps of 0.2 ms: some 14 core-minutes.

use inroads::{
    agents::{Actor, Context, Transition, episode, nets::Backend},
    assembly,
    config::Config,
    envs::{Environment, Seed, TimeLimit, ant_run::AntRun},
    statistics::{Estimate, mean_interval},
};
use rand::RngExt;
use serde::Serialize;

use crate::{
    Options,
    support::{Done, over_seeds, write},
};

const AGENT: &str = "td3";
const SET: &[&str] = &["memory.updates_per_step=0.25", "policy.batch=128"];
const STEPS: u64 = 200_000;
/// Steps an episode (Ant-v5).
const LIMIT: u32 = 1000;
/// Training steps between two frozen evaluations of so many episodes, and episodes of the last one and of random actions.
const EVERY: u64 = 20_000;
const EPISODES: u64 = 3;
const LAST: u64 = 10;
const SEEDS: u64 = 5;

#[derive(Serialize)]
struct Result {
    agent: &'static str,
    set: &'static [&'static str],
    steps: u64,
    random: Scores,
    learned: Scores,
    trials: Vec<Trial>,
}

/// What episodes came to: means over seeds of means over episodes.
#[derive(Clone, Serialize)]
struct Scores {
    returned: Estimate,
    /// Along x, metres.
    forward: Estimate,
    /// Steps.
    length: Estimate,
    /// Sum of the prices of effort.
    effort: Estimate,
}

#[derive(Clone, Debug, Serialize)]
struct Trial {
    seed: u64,
    /// Training steps, and the frozen agent's scores.
    curve: Vec<(u64, Score)>,
    learned: Score,
    random: Score,
}

/// Means over episodes.
#[derive(Clone, Copy, Debug, Default, Serialize)]
struct Score {
    returned: f64,
    forward: f64,
    length: f64,
    effort: f64,
}

pub(crate) fn run(options: &Options) -> Done {
    let seeds = options.seeds.unwrap_or(SEEDS);
    let trials: std::result::Result<Vec<_>, String> = over_seeds(seeds, trial).into_iter().collect();
    let trials = trials?;
    let scores = |score: fn(&Trial) -> Score| {
        let over = |part: fn(&Score) -> f64| {
            mean_interval(&trials.iter().map(|trial| part(&score(trial))).collect::<Vec<_>>())
        };
        Scores {
            returned: over(|score| score.returned),
            forward: over(|score| score.forward),
            length: over(|score| score.length),
            effort: over(|score| score.effort),
        }
    };
    let (random, learned) = (scores(|trial| trial.random), scores(|trial| trial.learned));
    for (name, Scores { returned, forward, length, effort }) in [("random", &random), ("TD3", &learned)] {
        println!("{name:<7} return {returned:.1}, {forward:.2} m, {length:.0} steps, effort {effort:.1}");
    }
    write(options, "td3-ant", &Result { agent: AGENT, set: SET, steps: STEPS, random, learned, trials })
}

type Env = TimeLimit<AntRun>;

fn trial(number: u64) -> std::result::Result<Trial, String> {
    let told = |error: &dyn std::error::Error| error.to_string();
    let mut env = TimeLimit::new(AntRun::new().map_err(|error| told(&error))?, LIMIT);
    let mut config = Config::defaults(AGENT, env.spec().name).map_err(|error| told(&error))?;
    for assignment in SET {
        config = config.with_assignment(assignment).map_err(|error| told(&error))?;
    }
    let build =
        assembly::agent(AGENT).map_err(|error| told(&error))?.continuous.ok_or("it acts by numbers")?;
    let seed = Seed(number);
    let mut agent =
        build(env.spec(), &config.agent, Backend::default(), seed).map_err(|error| told(&error))?;

    let random = score(&mut env, seed, LAST, &mut Aimless)?;
    eprintln!("seed {number}, random: {random:?}");
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
            let now = score(&mut env, seed, EPISODES, &mut *agent.frozen())?;
            eprintln!("seed {number}, {steps} steps: {now:?}");
            curve.push((steps, now));
        }
    }
    let learned = score(&mut env, seed, LAST, &mut *agent.frozen())?;
    eprintln!("seed {number}, {steps} steps, last: {learned:?}");
    Ok(Trial { seed: number, curve, learned, random })
}

/// Acts at random.
struct Aimless;

impl Actor<Vec<f32>, Vec<f32>> for Aimless {
    fn begin(&mut self, _: &Vec<f32>, _: &mut Context) {}

    fn act(&mut self, _: &Vec<f32>, ctx: &mut Context) -> Vec<f32> {
        (0..8).map(|_| ctx.acting.random_range(-1.0..=1.0)).collect()
    }

    fn observe(&mut self, _: &Transition<'_, Vec<f32>, Vec<f32>>, _: &mut Context) {}
}

/// What episodes of somebody who does not learn come to.
fn score(
    env: &mut Env,
    seed: Seed,
    episodes: u64,
    actor: &mut dyn Actor<Vec<f32>, Vec<f32>>,
) -> std::result::Result<Score, String> {
    let mut sum = Score::default();
    for index in 0..episodes {
        let mut ctx = Context::evaluation(seed, index);
        let (mut effort, start) = (0.0, seed.number("evaluate-start", index));
        env.reset(start);
        let from = env.inner().configuration().q[0];
        let watch = |t: &Transition<'_, Vec<f32>, Vec<f32>>, _| {
            effort += 0.5 * t.action.iter().map(|a| f64::from(*a).powi(2)).sum::<f64>();
        };
        let summary = episode(env, actor, start, &mut ctx, watch).map_err(|error| error.to_string())?;
        sum.returned += f64::from(summary.reward);
        sum.forward += f64::from(env.inner().configuration().q[0] - from);
        sum.length += f64::from(summary.steps);
        sum.effort += effort;
    }
    let n = episodes as f64;
    Ok(Score {
        returned: sum.returned / n,
        forward: sum.forward / n,
        length: sum.length / n,
        effort: sum.effort / n,
    })
}
