//! Training with frozen evaluations on the way: what the experiments with proto-goals share.

use std::{collections::BTreeMap, error::Error, ops::Range};

use inroads::{
    agents::{Context, episode, nets::Backend},
    assembly::{self, BoxedAgent, Build, Vector},
    config::Config,
    discovery::record::GoalRecord,
    envs::{
        Environment, Seed, Snapshot,
        check::Observed,
        registry::{self, AnyAnnotated, AnyEnvironment, Options},
        taxi::{Rules, Taxi, TaxiState},
        world::{Layout, World},
    },
};
use serde::Serialize;

use crate::support::over_seeds;

/// What went wrong, in words: seeds run on threads, which hand over nothing else.
pub(crate) type Failure = String;

type Attempt<T> = Result<T, Box<dyn Error>>;

/// An agent of the registry with some settings, in a world.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Recipe {
    /// What figures and tables call it.
    pub(crate) label: String,
    /// Its name in the registry.
    pub(crate) agent: String,
    /// What is not as its defaults have it.
    pub(crate) set: Vec<String>,
}

impl Recipe {
    pub(crate) fn new(label: &str, agent: &str, set: &[&str]) -> Self {
        let set = set.iter().map(|s| (*s).to_owned()).collect();
        Self { label: label.into(), agent: agent.into(), set }
    }

    pub(crate) fn with(&self, label: &str, set: &[&str]) -> Self {
        let more = Self::new(label, &self.agent, set);
        Self { set: self.set.iter().cloned().chain(more.set).collect(), ..more }
    }
}

/// How a run is trained and watched.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Protocol {
    /// The world's name in the registry.
    pub(crate) world: String,
    /// The one layout of all episodes; none: another one in each.
    pub(crate) layout: Option<u64>,
    /// Training ends with the episode that reaches this many steps.
    pub(crate) steps: u64,
    /// Or, if that is asked for, with the second evaluation in a row that solves it.
    pub(crate) until_solved: bool,
    /// Training episodes between two evaluations.
    pub(crate) every: u64,
    /// The seeds of the evaluation's episodes, the same every time.
    pub(crate) starts: Vec<u64>,
    /// The fewest steps of each of them, where they are known.
    pub(crate) fewest: Vec<u32>,
}

impl Protocol {
    /// SparseTaxi for so many steps, evaluated from all of its starts.
    pub(crate) fn taxi(steps: u64) -> Result<Self, Failure> {
        let world = "sparse-taxi".to_owned();
        let (starts, fewest) = taxi_starts(&world)?;
        Ok(Self { world, layout: None, steps, until_solved: false, every: 25, starts, fewest })
    }
}

/// An evaluation.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Point {
    pub(crate) episodes: u64,
    pub(crate) env_steps: u64,
    /// Share of the starts from which the task was done.
    pub(crate) success: f64,
    /// Steps taken over fewest steps, over the starts that were solved.
    pub(crate) ratio: f64,
}

/// A run.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Trial {
    pub(crate) seed: u64,
    pub(crate) points: Vec<Point>,
    /// The goal space at each evaluation.
    #[serde(skip)]
    pub(crate) goals: Vec<Vec<GoalRecord>>,
}

impl Trial {
    /// The first evaluation from which on success is never below 95 % in any two evaluations one after the other.
    pub(crate) fn solved(&self) -> Option<&Point> {
        self.points
            .windows(2)
            .find(|pair| pair.iter().all(|point| point.success >= 0.95))
            .map(|pair| &pair[0])
    }
}

/// Trains some seeds.
pub(crate) fn trials(recipe: &Recipe, protocol: &Protocol, seeds: Range<u64>) -> Result<Vec<Trial>, Failure> {
    let trial = |i| attempt(recipe, protocol, seeds.start + i).map_err(|error| error.to_string());
    over_seeds(seeds.end - seeds.start, trial).into_iter().collect()
}

fn attempt(recipe: &Recipe, protocol: &Protocol, seed: u64) -> Attempt<Trial> {
    let mut config = Config::defaults(&recipe.agent, &protocol.world)?;
    for assignment in &recipe.set {
        config = config.with_assignment(assignment)?;
    }
    let entry = assembly::agent(&recipe.agent)?;
    let options = Options { layout: protocol.layout.map(Layout::Fixed), ..Options::default() };
    if let Some(build) = entry.annotated {
        let AnyAnnotated::Vectors(mut env) = registry::make_annotated(&protocol.world, &options)? else {
            return Err("the world is not seen as symbols".into());
        };
        return run(&mut *env, build, &config, protocol, seed);
    }
    match (entry.discrete, registry::make_with(&protocol.world, &options)?) {
        (Some(build), AnyEnvironment::Choices(mut env)) => run(&mut *env, build, &config, protocol, seed),
        _ => Err("the agent cannot act in this world".into()),
    }
}

fn run<O: Observed>(
    env: &mut (impl Environment<Observation = O, Action = usize> + ?Sized),
    build: Build<O, usize>,
    config: &Config,
    protocol: &Protocol,
    number: u64,
) -> Attempt<Trial> {
    let seed = Seed(number);
    let mut agent: BoxedAgent<O, usize> = build(env.spec(), &config.agent, Backend::default(), seed)?;
    let mut trial = Trial { seed: number, points: Vec::new(), goals: Vec::new() };
    let (mut episodes, mut env_steps) = (0, 0);
    while env_steps < protocol.steps && !(protocol.until_solved && trial.solved().is_some()) {
        let start = seed.number("train-start", episodes);
        let mut ctx = Context::training(seed, episodes);
        env_steps += u64::from(episode(env, &mut *agent, start, &mut ctx, |_, _| {})?.steps);
        episodes += 1;
        if episodes.is_multiple_of(protocol.every) {
            let (mut solved, mut ratios) = (0_usize, 0.0);
            for (index, start) in protocol.starts.iter().enumerate() {
                let mut ctx = Context::evaluation(seed, index as u64);
                let summary = episode(env, &mut *agent.frozen(), *start, &mut ctx, |_, _| {})?;
                if summary.success {
                    solved += 1;
                    let fewest = protocol.fewest.get(index).copied().unwrap_or(summary.steps);
                    ratios += f64::from(summary.steps) / f64::from(fewest);
                }
            }
            let success = solved as f64 / protocol.starts.len() as f64;
            trial.points.push(Point { episodes, env_steps, success, ratio: ratios / solved as f64 });
            trial.goals.push(agent.goals());
        }
    }
    Ok(trial)
}

/// Seeds whose episodes begin in each of SparseTaxi's 300 starts, one each, and the fewest steps from there.
fn taxi_starts(world: &str) -> Result<(Vec<u64>, Vec<u32>), Failure> {
    let AnyEnvironment::Choices(mut env) = registry::make(world).map_err(|error| error.to_string())? else {
        return Err("taxis are driven by choices".into());
    };
    let wanted = TaxiState::starts().count();
    let (mut found, mut observation) = (BTreeMap::new(), Vector::new());
    for seed in 0.. {
        env.reset(seed);
        env.observe(&mut observation);
        let [row, column, passenger, destination] = std::array::from_fn(|i| observation[i] as u8);
        let state = TaxiState { row, column, passenger, destination };
        found.entry(state.encode()).or_insert(seed);
        if found.len() == wanted {
            break;
        }
    }
    let fewest = |state: &usize| TaxiState::decode(*state).map_or(0, fewest);
    Ok((found.values().copied().collect(), found.keys().map(fewest).collect()))
}

/// The fewest steps from a state to the passenger's arrival, by breadth-first search.
fn fewest(start: TaxiState) -> u32 {
    let mut taxi = Taxi::new(Rules::SPARSE);
    let (mut seen, mut edge) = (vec![false; TaxiState::COUNT], vec![start]);
    for steps in 1.. {
        let mut next = Vec::new();
        for state in edge {
            for choice in 0..6 {
                taxi.load(&state);
                let step = taxi.act(choice);
                if step.reward > 0.0 {
                    return steps;
                }
                let after = taxi.state();
                if step.end.is_none() && !std::mem::replace(&mut seen[after.encode()], true) {
                    next.push(after);
                }
            }
        }
        edge = next;
    }
    unreachable!("every start of the taxi can be solved")
}
