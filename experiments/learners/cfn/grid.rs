//! How much of an empty grid one sees, from its pictures and without a reward.

use std::{path::Path, sync::Arc, time::Instant};

use inroads::{
    agents::{
        Actor, Context, Curious, Flat, Novelty, Pace, Practice, Replay, Transition,
        dqn::{Dqn, DqnConfig, Epsilon},
        encode::Patches,
        nets::{Backend, TorsoConfig},
        novelty::{Cfn, CfnConfig, Rnd, RndConfig},
    },
    envs::{
        Domain, Frame, Seed,
        registry::{AnyEnvironment, Options as Wanted, make_with},
        visual_grid::{GREY, SIDE},
    },
    figures::{FigureError, Heat, heat},
    statistics::{Estimate, Verdict, mean_interval, superiority},
};
use serde::Serialize;

use crate::{
    Options,
    support::{Done, over_seeds, write},
};

/// Steps a run.
const STEPS: u64 = 50_000;
/// Steps between two points of a curve.
const EVERY: u64 = 5_000;
/// Updates a step, of the learner and of the novelty: one every eighth (the paper: one a step, on a GPU).
const UPDATES: f32 = 0.125;
/// Left, right, up, down.
const CHOICES: usize = 4;

/// A side of the patches that pictures are cut into, pixels: six by six cells.
const PATCH: u32 = 12;

/// Who explores, and how much the bonus weighs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Kind {
    Cfn,
    Rnd,
    /// Nobody says what is new.
    Chance,
}

/// An agent with what was tuned.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct Agent {
    kind: Kind,
    /// b, of a bonus in standard deviations.
    weight: f32,
    /// Adam's rate of the novelty.
    rate: f32,
    /// Share of random choices from the 500th update on.
    epsilon: f32,
}

/// A run.
#[derive(Serialize)]
struct Run {
    seed: u64,
    /// Distinct cells after every 5,000 steps.
    cells: Vec<usize>,
    /// Visits of each cell, row by row.
    #[serde(skip)]
    visits: Vec<u64>,
}

impl Run {
    fn last(&self) -> f64 {
        self.cells.last().map_or(0.0, |cells| *cells as f64)
    }
}

/// An agent's runs.
#[derive(Serialize)]
struct Row {
    name: &'static str,
    agent: Agent,
    cells: Estimate,
    seconds: f64,
    runs: Vec<Run>,
}

/// "X sees so many times as many cells as Y."
#[derive(Serialize)]
struct Claim {
    claim: String,
    /// Of the means.
    ratio: f64,
    superiority: Estimate,
    verdict: Verdict,
}

/// All of it.
#[derive(Serialize)]
pub(super) struct Found {
    steps: u64,
    rows: Vec<Row>,
    claims: Vec<Claim>,
}

fn torso() -> TorsoConfig {
    TorsoConfig { embedding: 16, merges: vec![], hidden: vec![64], ..TorsoConfig::default() }
}

fn novelty(agent: &Agent, encoder: &Arc<Patches>, seed: Seed) -> Option<Box<dyn Novelty<Frame>>> {
    let rng = &mut seed.stream("novelty", 0);
    let (rate, updates_per_visit) = (agent.rate, UPDATES);
    let encoder = Arc::clone(encoder);
    match agent.kind {
        Kind::Chance => None,
        Kind::Cfn => {
            let config =
                CfnConfig { torso: torso(), rate, updates_per_visit, batch: 64, ..CfnConfig::default() };
            Some(Box::new(Cfn::new(encoder, &config, Backend::default(), rng)))
        }
        Kind::Rnd => {
            let config =
                RndConfig { torso: torso(), rate, updates_per_visit, batch: 64, ..RndConfig::default() };
            Some(Box::new(Rnd::new(encoder, &config, Backend::default(), rng)))
        }
    }
}

/// Explores for so many steps.
fn explore(agent: &Agent, seed: u64, steps: u64) -> Run {
    let wanted = Wanted { see: Some(GREY), ..Wanted::default() };
    let Ok(AnyEnvironment::Frames(mut env)) = make_with("visual-grid", &wanted) else {
        unreachable!("the grid is seen as a picture")
    };
    let encoder = Arc::new(Patches::new(&env.spec().observation, PATCH).expect("12 divides 84"));
    let epsilon = Epsilon { start: 1.0, end: agent.epsilon, updates: 500 };
    let config = DqnConfig {
        torso: torso(),
        head: 64,
        rate: 5e-4,
        follow_every: 125,
        epsilon,
        ..DqnConfig::default()
    };
    let learner = Dqn::new(
        Arc::clone(&encoder) as _,
        CHOICES,
        &config,
        Backend::default(),
        &mut Seed(seed).stream("initialise", 0),
    );
    let capacity = STEPS as usize;
    let replay = Replay::new(capacity).spanning(3);
    let mut curious =
        Curious::new(learner, Practice::new(replay, Pace { updates_per_step: UPDATES, warm_up: 1000 }));
    if let Some(novelty) = novelty(agent, &encoder, Seed(seed)) {
        curious = curious.with_novelty(novelty, agent.weight).centred(true);
    }
    live(&mut *env, Flat::new(curious, capacity), seed, steps)
}

fn live(
    env: &mut dyn Domain<Frame, usize>,
    mut agent: impl Actor<Frame, usize>,
    seed: u64,
    total: u64,
) -> Run {
    let mut run = Run { seed, cells: Vec::new(), visits: vec![0; usize::from(SIDE) * usize::from(SIDE)] };
    let (mut steps, mut number) = (0, 0);
    let (mut s, mut next) = (Frame::default(), Frame::default());
    let cell = |env: &dyn Domain<Frame, usize>| env.facts().first().map_or(0, |fact| fact.value as usize);
    while steps < total {
        let mut ctx = Context::training(Seed(seed), number);
        env.reset(number);
        env.observe(&mut s);
        agent.begin(&s, &mut ctx);
        run.visits[cell(env)] += 1;
        loop {
            let action = agent.act(&s, &mut ctx);
            let step = env.step(&action).expect("an episode is on");
            env.observe(&mut next);
            // Nothing is paid, not even for arriving: what drives one is the bonus alone.
            let t = Transition { before: &s, action: &action, reward: 0.0, after: &next, end: step.end };
            agent.observe(&t, &mut ctx);
            std::mem::swap(&mut s, &mut next);
            steps += 1;
            run.visits[cell(env)] += 1;
            if steps % EVERY == 0 {
                run.cells.push(run.visits.iter().filter(|visits| **visits > 0).count());
            }
            if step.end.is_some() || steps == total {
                break;
            }
        }
        number += 1;
    }
    run
}

/// Who is compared, as tuned.
const AGENTS: [(&str, Agent); 3] = [
    ("CFN", Agent { kind: Kind::Cfn, weight: 0.1, rate: 1e-3, epsilon: 0.01 }),
    ("RND", Agent { kind: Kind::Rnd, weight: 0.1, rate: 1e-4, epsilon: 0.01 }),
    ("epsilon-greedy", Agent { kind: Kind::Chance, weight: 0.0, rate: 1e-3, epsilon: 0.6 }),
];

pub(super) fn run(options: &Options, seeds: u64) -> Result<Found, Box<dyn std::error::Error>> {
    println!("cells of visual-grid visited in {STEPS} steps, of {}:", u32::from(SIDE).pow(2));
    let rows: Vec<Row> = AGENTS
        .into_iter()
        .map(|(name, agent)| {
            let began = Instant::now();
            let runs = over_seeds(seeds, |seed| explore(&agent, seed, STEPS));
            let seconds = began.elapsed().as_secs_f64();
            let cells = mean_interval(&runs.iter().map(Run::last).collect::<Vec<_>>());
            println!("  {name:15} {cells:.0}, {seconds:.0} s");
            Row { name, agent, cells, seconds, runs }
        })
        .collect();
    let claims = [(0, 1, 1.3), (0, 2, 2.0)].map(|(x, y, times)| {
        let of = |row: &Row, times: f64| row.runs.iter().map(|run| run.last() * times).collect::<Vec<_>>();
        let ratio = rows[x].cells.value / rows[y].cells.value;
        let superiority = superiority(&of(&rows[x], 1.0), &of(&rows[y], times));
        let verdict = Verdict::of(&superiority);
        let claim = format!("{} sees {times} times as many cells as {}", rows[x].name, rows[y].name);
        println!("  {claim}: {ratio:.2} times; {superiority}, {verdict:?}");
        Claim { claim, ratio, superiority, verdict }
    });
    std::fs::create_dir_all(&options.out)?;
    let path = options.out.join("visual-grid.png");
    draw(&rows, &path)?;
    println!("wrote {}", path.display());
    Ok(Found { steps: STEPS, rows, claims: claims.into() })
}

/// The median seed of each agent: how often each cell was visited.
fn draw(rows: &[Row], path: &Path) -> Result<(), FigureError> {
    let grid = |row: &Row| {
        let mut runs: Vec<&Run> = row.runs.iter().collect();
        runs.sort_by(|x, y| x.last().total_cmp(&y.last()));
        let run = runs[runs.len() / 2];
        // By the logarithm: the start is visited a thousand times as often as the border of what is known.
        let most = run.visits.iter().copied().max().unwrap_or(1) as f64;
        let shade = |visits: &u64| (*visits as f64).ln_1p() / most.ln_1p();
        Heat {
            title: row.name.into(),
            note: format!("{:.0} cells, seed {}; at most {most} visits", run.last(), run.seed),
            columns: usize::from(SIDE),
            cells: run.visits.iter().map(|visits| Some(shade(visits))).collect(),
            goal: Some(usize::from(SIDE).pow(2) - 1),
            ..Heat::default()
        }
    };
    let caption = "visual-grid, 50,000 steps without a reward, starts at the top left, the median seed of each agent. Colour \
                   is ln(1 + visits) over its greatest; white cells were never visited.";
    heat(path, &rows.iter().map(grid).collect::<Vec<_>>(), 3, caption)
}

/// What was tried, the same number of configurations for everybody, on a seed of its own.
const TRIED: [Agent; 12] = {
    const fn agent(kind: Kind, weight: f32, rate: f32, epsilon: f32) -> Agent {
        Agent { kind, weight, rate, epsilon }
    }
    [
        agent(Kind::Cfn, 0.1, 1e-3, 0.01),
        agent(Kind::Cfn, 0.01, 1e-3, 0.01),
        agent(Kind::Cfn, 0.1, 3e-4, 0.01),
        agent(Kind::Cfn, 0.1, 1e-3, 0.1),
        agent(Kind::Rnd, 0.1, 1e-3, 0.01),
        agent(Kind::Rnd, 0.1, 1e-4, 0.01),
        agent(Kind::Rnd, 0.01, 1e-4, 0.01),
        agent(Kind::Rnd, 0.1, 1e-4, 0.1),
        agent(Kind::Chance, 0.0, 1e-3, 0.1),
        agent(Kind::Chance, 0.0, 1e-3, 0.3),
        agent(Kind::Chance, 0.0, 1e-3, 0.6),
        agent(Kind::Chance, 0.0, 1e-3, 1.0),
    ]
};

/// Steps of a run that is tried.
const TRIED_FOR: u64 = 20_000;

/// A configuration and what it came to.
#[derive(Serialize)]
struct Tried {
    agent: Agent,
    runs: Vec<Run>,
}

/// Tries configurations, each on so many seeds away from those of the comparison.
pub(super) fn tune(options: &Options) -> Done {
    let seeds = options.seeds.unwrap_or(1);
    let try_one = |agent: &Agent| {
        let began = Instant::now();
        let runs = over_seeds(seeds, |seed| explore(agent, 1000 + seed, TRIED_FOR));
        let cells: Vec<_> = runs.iter().map(Run::last).collect();
        println!("  {agent:?}: {cells:?}, {:.0} s", began.elapsed().as_secs_f64());
        Tried { agent: *agent, runs }
    };
    write(options, "cfn-tuning", &TRIED.iter().map(try_one).collect::<Vec<_>>())
}
