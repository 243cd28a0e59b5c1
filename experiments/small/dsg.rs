//! Deep skill graphs (thesis chapter 6): a graph is found in a world without a task, then 20 pairs of a start and a goal
//! are asked for, the same for all agents, 10 trials a pair (`decisions.md`).

use std::fmt;

use inroads::{
    agents::{Bag, Context, episode},
    assembly::{self, BoxedAgent, Vector},
    config::{Config, ConfigError},
    discovery::record::{GraphRecord, Place, Query},
    draw::View,
    envs::{
        Environment, Seed,
        maze::{Picture, Starts},
        registry::{self, AnyEnvironment, Options as World},
    },
    figures::{self, Calibration, Edge, Graph, Ground as Under, Vertex},
    session::BoxedEnvironment,
    statistics::{Estimate, mean_interval},
};
use rand::RngExt;
use serde::Serialize;

use crate::{
    Options,
    support::{Done, over_seeds, write},
};

/// Pairs and trials a pair (`decisions.md`).
const PAIRS: usize = 20;
const TRIALS: u64 = 10;
/// Training episodes before the queries. The thesis has 1000.
const EPISODES: u64 = 300;
/// Further episodes with a pair, where chains may be built to its goal (`decisions.md`: at most 50).
const FURTHER: u64 = 10;
/// Starts and goals are this far from walls, metres: the robot's radius, its start noise and a little.
const CLEARANCE: f64 = 0.7;
/// Start and goal of a pair are at least this far apart, metres: outside the goal's region with all noise.
const APART: f64 = 1.0;

/// A world without a task, and the same with one.
#[derive(Clone, Copy)]
struct Ground {
    free: &'static str,
    task: &'static str,
}

const U_MAZE: Ground = Ground { free: "point-umaze", task: "point-maze-small-steps" };
const ARENA: Ground = Ground { free: "point-arena", task: "point-reacher-small-steps" };

/// An agent, and where it is trained.
struct Variant {
    name: &'static str,
    ground: Ground,
    set: &'static [&'static str],
    episodes: u64,
    anywhere: bool,
    /// Seeds at most: networks cost more than all the rest.
    seeds: u64,
    /// Whether it is asked a second time, with further episodes.
    further: bool,
}

const fn variant(name: &'static str, ground: Ground, set: &'static [&'static str], episodes: u64) -> Variant {
    Variant { name, ground, set, episodes, anywhere: false, seeds: u64::MAX, further: false }
}

const VARIANTS: &[Variant] = &[
    Variant { further: true, ..variant("DSG, given controller", U_MAZE, &[], EPISODES) },
    variant("DSG, nearest-neighbour sets", U_MAZE, &["initiation.classifier=nearest"], EPISODES),
    variant("given controller alone", U_MAZE, &["graph.flat=true"], 0),
    variant("DSG, given controller", ARENA, &[], EPISODES),
    variant("given controller alone", ARENA, &["graph.flat=true"], 0),
    Variant { seeds: 1, ..variant("DSG, DDPG", U_MAZE, &["policies=ddpg"], EPISODES) },
    Variant {
        seeds: 1,
        ..variant("DDPG + HER alone", U_MAZE, &["policies=ddpg", "graph.flat=true"], EPISODES)
    },
    Variant {
        anywhere: true,
        seeds: 1,
        ..variant(
            "DDPG + HER alone, starts anywhere",
            U_MAZE,
            &["policies=ddpg", "graph.flat=true"],
            EPISODES,
        )
    },
];

/// A start and a goal, metres.
#[derive(Clone, Copy, Debug, Serialize)]
struct Pair {
    start: [f64; 2],
    goal: [f64; 2],
}

/// One query.
#[derive(Clone, Debug, Serialize)]
struct Trial {
    pair: usize,
    /// What the plan is, and how probable it is to succeed; none where there is no plan.
    case: Option<Query>,
    predicted: Option<f32>,
    success: bool,
    steps: u32,
}

/// What came of one seed.
#[derive(Clone, Debug, Serialize)]
struct Run {
    seed: u64,
    trials: Vec<Trial>,
    /// The same after further episodes.
    further: Vec<Trial>,
    /// Drawn, not written: half a megabyte.
    #[serde(skip)]
    graph: GraphRecord,
}

#[derive(Serialize)]
struct Row {
    world: &'static str,
    agent: &'static str,
    episodes: u64,
    success: Interval,
    further: Option<Interval>,
    brier: Option<f64>,
    /// By tenths of what was predicted: mean prediction, share that came true, trials.
    reliability: Vec<(f64, f64, usize)>,
    vertices: f64,
    edges: f64,
    pairs: Vec<Pair>,
    runs: Vec<Run>,
}

/// Mean over the seeds with its interval.
#[derive(Clone, Copy, Serialize)]
struct Interval {
    mean: f64,
    low: f64,
    high: f64,
}

impl From<Estimate> for Interval {
    fn from(of: Estimate) -> Self {
        Self { mean: of.value, low: of.low.max(0.0), high: of.high.min(1.0) }
    }
}

impl fmt::Display for Interval {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.3} [{:.3}, {:.3}]", self.mean, self.low, self.high)
    }
}

pub(crate) fn run(options: &Options) -> Done {
    let seeds = options.seeds.unwrap_or(3);
    let mut rows = Vec::new();
    for variant in VARIANTS {
        let pairs =
            pairs(&registry::picture_with(variant.ground.task, &World::default())?.expect("mazes have maps"));
        let runs = over_seeds(seeds.min(variant.seeds), |seed| {
            ask(variant, &pairs, seed).map_err(|why| why.to_string())
        });
        let runs: Vec<Run> = runs.into_iter().collect::<Result<_, _>>()?;
        let row = row(variant, pairs, runs);
        let further =
            row.further.map_or_else(String::new, |further| format!(", {FURTHER} more episodes {further}"));
        let brier = row.brier.map_or_else(String::new, |brier| format!(", Brier {brier:.3}"));
        println!(
            "{:<12} {:<34} success {}{further}{brier}, {:.0} vertices, {:.0} edges",
            row.world, row.agent, row.success, row.vertices, row.edges
        );
        for (predicted, came, trials) in &row.reliability {
            println!("  predicted {predicted:.2}: {came:.2} of {trials}");
        }
        rows.push(row);
    }
    write(options, "dsg", &rows)?;
    let asked = rows.iter().enumerate().filter(|(_, row)| row.brier.is_some());
    let calibrations: Vec<_> = asked.map(|(nth, row)| calibration(row, nth + 1)).collect();
    let path = options.out.join("dsg-reliability.png");
    figures::reliability(&path, "plans on deep skill graphs", &calibrations)?;
    println!("wrote {}", path.display());
    let path = options.out.join("dsg-graph.png");
    draw(&rows[0], &path)?;
    println!("wrote {}", path.display());
    Ok(())
}

/// What was predicted, and what came of it.
fn predictions(runs: &[Run]) -> Vec<(f64, f64)> {
    let trials = runs.iter().flat_map(|run| &run.trials);
    trials.filter_map(|t| Some((f64::from(t.predicted?), f64::from(u8::from(t.success))))).collect()
}

fn calibration(row: &Row, colour: usize) -> Calibration {
    Calibration { label: format!("{}, {}", row.agent, row.world), colour, pairs: predictions(&row.runs) }
}

/// The graph of the first seed on the map of its world.
fn draw(row: &Row, path: &std::path::Path) -> Done {
    let view = View::of(&Config::defaults("dsg", row.world)?.settings).ok_or("the world has no map")?;
    let run = &row.runs[0];
    let record = &run.graph;
    let number = |vertex: u32| record.vertices.iter().position(|known| known.vertex == vertex);
    let vertices = record.vertices.iter().map(|vertex| Vertex {
        label: vertex.vertex.to_string(),
        at: vertex.at.first_chunk().copied(),
        value: vertex.visits as f64,
        ..Vertex::default()
    });
    let edges = record.edges.iter().filter_map(|edge| {
        let (from, to) = (number(edge.from)?, number(edge.to)?);
        let probability = f64::from(edge.probability);
        Some(Edge { from, to, probability, hoped: edge.tries == 0, planned: false })
    });
    let graph = Graph {
        title: format!("{}: {} vertices, {} edges", row.world, record.vertices.len(), record.edges.len()),
        subtitle: format!("{} after {} episodes, seed {}", row.agent, row.episodes, run.seed),
        value: "visits".into(),
        vertices: vertices.collect(),
        edges: edges.collect(),
    };
    Ok(figures::graph(path, Under::Map(&view.map), &graph)?)
}

fn row(variant: &Variant, pairs: Vec<Pair>, runs: Vec<Run>) -> Row {
    let rate = |trials: &[Trial]| trials.iter().filter(|t| t.success).count() as f64 / trials.len() as f64;
    let mean = |of: &dyn Fn(&Run) -> f64| mean_interval(&runs.iter().map(of).collect::<Vec<_>>());
    let calibration = Calibration { pairs: predictions(&runs), ..Calibration::default() };
    let bins = calibration.bins(10).into_iter().map(|bin| (bin.predicted, bin.measured, bin.count));
    Row {
        world: variant.ground.free,
        agent: variant.name,
        episodes: variant.episodes,
        success: mean(&|run| rate(&run.trials)).into(),
        further: variant.further.then(|| mean(&|run| rate(&run.further)).into()),
        brier: Some(calibration.brier()).filter(|brier| brier.is_finite()),
        reliability: bins.collect(),
        vertices: mean(&|run| run.graph.vertices.len() as f64).value,
        edges: mean(&|run| run.graph.edges.len() as f64).value,
        pairs,
        runs,
    }
}

/// Pairs drawn evenly from the floor.
fn pairs(picture: &Picture) -> Vec<Pair> {
    let mut rng = Seed(0).stream("pairs", 0);
    let free = |at: &[f64; 2]| {
        picture.walls.iter().all(|wall| {
            let off = |axis: usize| (wall.low[axis] - at[axis]).max(at[axis] - wall.high[axis]).max(0.0);
            off(0).hypot(off(1)) >= CLEARANCE
        })
    };
    let bounds = picture.bounds;
    let mut point = || loop {
        let at = [0, 1].map(|axis| rng.random_range(bounds.low[axis]..bounds.high[axis]));
        if free(&at) {
            return at;
        }
    };
    let mut pairs = Vec::new();
    while pairs.len() < PAIRS {
        let pair @ Pair { start, goal } = Pair { start: point(), goal: point() };
        if (start[0] - goal[0]).hypot(start[1] - goal[1]) >= APART {
            pairs.push(pair);
        }
    }
    pairs
}

fn world(name: &str, options: &World<'_>) -> Result<BoxedEnvironment<Vector, Vector>, ConfigError> {
    match registry::make_with(name, options).map_err(|why| ConfigError::World(why.to_string()))? {
        AnyEnvironment::Vectors(env) => Ok(env),
        _ => Err(ConfigError::World(format!("{name} is no world of bodies"))),
    }
}

fn agent(
    env: &dyn Environment<Observation = Vector, Action = Vector>,
    set: &[&str],
    seed: u64,
) -> Result<BoxedAgent<Vector, Vector>, ConfigError> {
    let mut config = Config::defaults("dsg", U_MAZE.free)?;
    for assignment in set {
        config = config.with_assignment(assignment)?;
    }
    let build = assembly::agent("dsg")?.continuous.expect("the agent acts with vectors");
    build(env.spec(), &config.agent, config.settings.backend, Seed(seed))
}

fn ask(variant: &Variant, pairs: &[Pair], seed: u64) -> Result<Run, Box<dyn std::error::Error>> {
    let starts = variant.anywhere.then_some(Starts::Anywhere);
    let mut env = world(variant.ground.free, &World { starts, ..World::default() })?;
    let mut agent = self::agent(&*env, variant.set, seed)?;
    for number in 0..variant.episodes {
        let mut ctx = Context::training(Seed(seed), number);
        episode(&mut *env, &mut *agent, Seed(seed).number("train-start", number), &mut ctx, |_, _| {})?;
    }
    let mut run =
        Run { seed, trials: Vec::new(), further: Vec::new(), graph: agent.graph().unwrap_or_default() };
    let mut bag = Bag::default();
    agent.save(&mut bag);
    for (index, pair) in pairs.iter().enumerate() {
        let options =
            World { goal: Some(pair.goal), starts: Some(Starts::At(&[pair.start])), ..World::default() };
        let mut env = world(variant.ground.task, &options)?;
        query(&*agent, &mut *env, index, pair, seed, &mut run.trials)?;
        if variant.further {
            let mut pupil = self::agent(&*env, &[variant.set, &["graph.expand_every=0"]].concat(), seed)?;
            pupil.load(&bag)?;
            for number in 0..FURTHER {
                let mut ctx = Context::training(Seed(seed), variant.episodes + number);
                episode(
                    &mut *env,
                    &mut *pupil,
                    Seed(seed).number("further-start", number),
                    &mut ctx,
                    |_, _| {},
                )?;
            }
            query(&*pupil, &mut *env, index, pair, seed, &mut run.further)?;
        }
    }
    Ok(run)
}

/// All trials of one pair.
fn query(
    agent: &dyn inroads::discovery::Skilled<Vector, Vector>,
    env: &mut (dyn Environment<Observation = Vector, Action = Vector> + Send),
    index: usize,
    pair: &Pair,
    seed: u64,
    trials: &mut Vec<Trial>,
) -> Result<(), Box<dyn std::error::Error>> {
    let mut seen = Vector::new();
    env.observe(&mut seen);
    let goal: Vector = pair.goal.iter().map(|x| *x as f32).chain(seen[2..].iter().copied()).collect();
    for trial in 0..TRIALS {
        let mut ctx = Context::evaluation(Seed(seed), index as u64 * TRIALS + trial);
        let mut actor = agent.pursue(&Place::State(&goal)).ok_or("the agent has no graph")?;
        let mut start = None;
        let number = Seed(seed).number("trial", index as u64 * TRIALS + trial);
        let summary = episode(env, &mut *actor, number, &mut ctx, |t, _| {
            start.get_or_insert_with(|| t.before.clone());
        })?;
        let plan = start.and_then(|start| agent.plan(&Place::State(&start), &Place::State(&goal)));
        trials.push(Trial {
            pair: index,
            case: plan.as_ref().map(|plan| plan.case),
            predicted: plan.map(|plan| plan.probability()),
            success: summary.success,
            steps: summary.steps,
        });
    }
    Ok(())
}
