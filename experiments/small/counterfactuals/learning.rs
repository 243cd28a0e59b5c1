//! The whole agent beside itself with goals of whole states.

use std::{error::Error, path::Path};

use inroads::{
    agents::{Context, episode},
    assembly::{self, BoxedAgent},
    config::Config,
    envs::{
        Domain, Seed,
        registry::{self, AnyEnvironment},
    },
    figures::{Panel, Series, curves},
    statistics::{Estimate, Verdict, mean_interval, median, superiority},
};
use serde::Serialize;

use crate::support::over_seeds;

/// Steps of training.
const STEPS: u64 = 30_000;
/// What counts as the steps of a seed that never got there: more than those of any that did.
const UNSOLVED: f64 = 2.0 * STEPS as f64;
/// Training steps between evaluations.
const EVERY: u64 = 2000;
/// Episodes of an evaluation.
const EVALUATION: u64 = 20;
/// The share of successes that is waited for.
const WANTED: f64 = 0.8;

const WORLDS: &[&str] = &["door-key-6x6-factored-distracted"];

/// An agent: its name here, and what is set of `abstract-subgoals`. What is not set are its defaults. Six others were tried
/// for the first (share of exploration, its length, horizon, b twice, decisions) and two for the second (share of
/// exploration, number of vertices), on four seeds each: none was clearly better.
type Variant = (&'static str, &'static [&'static str]);

const VARIANTS: &[Variant] = &[("abstract subgoals", &[]), ("whole states", &["naming=whole"])];

/// One agent in one world.
#[derive(Serialize)]
pub(super) struct Line {
    world: &'static str,
    agent: &'static str,
    /// Vertices at the end.
    vertices: Estimate,
    /// Features that a goal has kept, of all features.
    kept: f64,
    features: usize,
    /// Share of goals that ask for the distractor.
    distracted: f64,
    /// Steps to the first evaluation with enough successes; [`UNSOLVED`] where there was none.
    steps: Vec<f64>,
    median_steps: f64,
    /// Seeds that got there.
    solved: usize,
    /// Success in the last evaluation.
    last: Estimate,
    #[serde(skip)]
    runs: Vec<Vec<(f64, f64)>>,
}

/// Whether the first agent needs fewer steps than the second.
#[derive(Serialize)]
pub(super) struct Comparison {
    world: &'static str,
    agents: [&'static str; 2],
    /// Probability that a seed of the first needs fewer steps than one of the second.
    superiority: Estimate,
    verdict: Verdict,
}

/// What became of one seed.
struct Learned {
    curve: Vec<(f64, f64)>,
    steps: Option<f64>,
    vertices: usize,
    kept: usize,
    distracted: usize,
    features: usize,
}

fn learn(world: &'static str, settings: &[&str], seed: u64) -> Result<Learned, Box<dyn Error + Send + Sync>> {
    let mut config = Config::defaults("abstract-subgoals", world)?;
    for setting in settings {
        config = config.with_assignment(setting)?;
    }
    let AnyEnvironment::Choices(mut env) = registry::make(world)? else {
        return Err(format!("{world} has no choices").into());
    };
    let build = assembly::agent("abstract-subgoals")?.discrete.ok_or("it acts by choices")?;
    let mut agent = build(env.spec(), &config.agent, config.settings.backend, Seed(seed))?;
    let (mut steps, mut number, mut curve) = (0, 0, Vec::new());
    while steps < STEPS {
        let until = steps + EVERY;
        while steps < until {
            let start = Seed(seed).number("train-start", number);
            let mut ctx = Context::training(Seed(seed), number);
            steps += u64::from(episode(&mut *env, &mut *agent, start, &mut ctx, |_, _| {})?.steps);
            number += 1;
        }
        curve.push((steps as f64, evaluate(&mut *env, &agent, seed)?));
    }
    let graph = agent.graph().unwrap_or_default();
    let features = env.spec().observation.len();
    let asks = |feature: usize| move |kept: &[(u32, f32)]| kept.iter().any(|(i, _)| *i as usize == feature);
    let distracted = graph.vertices.iter().filter(|v| asks(features - 1)(&v.kept)).count();
    Ok(Learned {
        steps: curve.iter().find(|(_, success)| *success >= WANTED).map(|(steps, _)| *steps),
        curve,
        vertices: graph.vertices.len(),
        kept: graph.vertices.iter().map(|v| v.kept.len()).sum(),
        distracted,
        features,
    })
}

/// The share of frozen episodes that succeed.
fn evaluate(
    env: &mut dyn Domain<Vec<f32>, usize>,
    agent: &BoxedAgent<Vec<f32>, usize>,
    seed: u64,
) -> Result<f64, Box<dyn Error + Send + Sync>> {
    let mut successes = 0;
    for index in 0..EVALUATION {
        let start = Seed(seed).number("evaluate-start", index);
        let mut ctx = Context::evaluation(Seed(seed), index);
        let summary = episode(&mut *env, &mut *agent.frozen(), start, &mut ctx, |_, _| {})?;
        successes += u32::from(summary.success);
    }
    Ok(f64::from(successes) / EVALUATION as f64)
}

fn line(world: &'static str, variant: Variant, seeds: u64) -> Result<Line, Box<dyn Error>> {
    let learned = over_seeds(seeds, |seed| learn(world, variant.1, seed));
    let learned: Vec<_> = learned.into_iter().collect::<Result<_, _>>().map_err(|e| e.to_string())?;
    let vertices: Vec<_> = learned.iter().map(|l| l.vertices as f64).collect();
    let total = vertices.iter().sum::<f64>().max(1.0);
    let share = |count: fn(&Learned) -> usize| learned.iter().map(count).sum::<usize>() as f64 / total;
    let steps: Vec<_> = learned.iter().map(|l| l.steps.unwrap_or(UNSOLVED)).collect();
    let last: Vec<_> = learned.iter().filter_map(|l| l.curve.last()).map(|(_, success)| *success).collect();
    Ok(Line {
        world,
        agent: variant.0,
        vertices: mean_interval(&vertices),
        kept: share(|l| l.kept),
        features: learned.first().map_or(0, |l| l.features),
        distracted: share(|l| l.distracted),
        median_steps: median(&steps).unwrap_or(f64::NAN),
        solved: learned.iter().filter(|l| l.steps.is_some()).count(),
        last: mean_interval(&last),
        steps,
        runs: learned.into_iter().map(|l| l.curve).collect(),
    })
}

/// All agents in all worlds, and the picture of their curves.
pub(super) fn lines(seeds: u64, out: &Path) -> Result<(Vec<Line>, Vec<Comparison>), Box<dyn Error>> {
    let (mut lines, mut comparisons, mut panels) = (Vec::new(), Vec::new(), Vec::new());
    println!(
        "{:34} {:18} {:>24} {:>5} {:>10} {:>7} {:>6} {:>24}",
        "world", "agent", "vertices", "kept", "distracted", "steps", "solved", "last success"
    );
    for world in WORLDS {
        let of_world: Vec<_> = VARIANTS.iter().map(|v| line(world, *v, seeds)).collect::<Result<_, _>>()?;
        for l in &of_world {
            println!(
                "{:34} {:18} {:>24} {:>5.2} {:>10.2} {:>7} {:>6} {:>24}",
                l.world,
                l.agent,
                format!("{:.1}", l.vertices),
                l.kept,
                l.distracted,
                l.median_steps,
                l.solved,
                format!("{:.2}", l.last)
            );
        }
        for other in &of_world[1..] {
            // Fewer steps are better.
            let superiority = superiority(&negated(&of_world[0].steps), &negated(&other.steps));
            let (agents, verdict) = ([of_world[0].agent, other.agent], Verdict::of(&superiority));
            println!("{world}: {} before {}: {superiority:.2} {verdict:?}", agents[0], agents[1]);
            comparisons.push(Comparison { world, agents, superiority, verdict });
        }
        let series = of_world.iter().enumerate();
        panels.push(Panel {
            title: (*world).to_owned(),
            x_label: "environment steps".to_owned(),
            y_label: "evaluation success".to_owned(),
            y_range: Some((0.0, 1.0)),
            series: series
                .map(|(i, l)| Series { label: l.agent.to_owned(), colour: i + 1, runs: l.runs.clone() })
                .collect(),
            ..Panel::default()
        });
        lines.extend(of_world);
    }
    std::fs::create_dir_all(out)?;
    curves(out.join("counterfactuals.png"), &panels)?;
    Ok((lines, comparisons))
}

fn negated(values: &[f64]) -> Vec<f64> {
    values.iter().map(|x| -x).collect()
}
