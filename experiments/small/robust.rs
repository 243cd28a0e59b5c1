//! How robust chains are (4.2.2), and how near to the hierarchically optimal path (4.2.3), in small.
//!
//! The chaining probability is the true one: option after option is executed once, each from the very state in which the
//! one before ended, and a rollout counts when all of them reach their subgoals.

use inroads::{
    agents::{
        Context, Pace, Practice, Replay, TabularQ, classify::Nearest, encode::Select, episode,
        experience::Pay, tabular::TabularConfig,
    },
    config::Config,
    discovery::{
        Binary, Call, ChainConfig, Chaining, Discovery, Dual, Hierarchy, Initiation, PerSkill,
        PolicyOverSkills, Shared, SkillId, SkillPolicy, Skilled,
        chain::{Aim, Lane, States, Subgoals, metrics::chain_from},
        over_skills::{Epsilon, Scan, TabularOverSkills},
    },
    envs::{
        End, Environment, Seed, TimeLimit,
        rooms::{FOUR_ROOMS, Rooms, SLIP},
        world::{Layout, Symbolic},
    },
    statistics::{Estimate, Verdict, mean_interval, median, superiority, wilson},
};
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use std::sync::Arc;
use toml::Table;

use crate::{
    Options,
    support::{Done, over_seeds, write},
};

type Vector = Vec<f32>;
type World = TimeLimit<Symbolic<Rooms>>;

/// Frozen episodes, and open-loop rollouts, for each trained agent.
const TRIALS: u64 = 200;

/// Training episodes.
const EPISODES: u64 = 300;

/// Steps that an option has in the noisy rooms, half of the command line's: with 60 nearly every execution of every variant
/// succeeds (chaining probabilities of 0.96 to 1.00 over four seeds, 0.75 with own policies for dual sets), and little can be told apart.
const TIGHT: u32 = 30;

/// A room with the goal in its middle, as Ant-Reacher has it (4.2.3): one may come by the goal's far side.
const ARENA: &str = "
#############
#S          #
#           #
#           #
#           #
#           #
#     G     #
#           #
#           #
#           #
#           #
#           #
#############";

/// Steps from a corner of the arena to its goal.
const CORNER: f64 = 10.0;

/// What is compared: which of chapter 4's proposals an agent has.
#[derive(Clone, Copy)]
struct Variant {
    name: &'static str,
    dual: bool,
    subgoals: Subgoals,
    scan: bool,
}

const VARIANTS: [Variant; 6] = [
    Variant { name: "robust", dual: true, subgoals: Subgoals::DynamicProgramming, scan: true },
    Variant { name: "sampled subgoals", dual: true, subgoals: Subgoals::Sample, scan: true },
    Variant { name: "own policies for sets", dual: true, subgoals: Subgoals::Set, scan: true },
    Variant { name: "no dual sets", dual: false, subgoals: Subgoals::DynamicProgramming, scan: true },
    Variant { name: "dsc, scanned", dual: false, subgoals: Subgoals::Set, scan: true },
    Variant { name: "dsc, by values", dual: false, subgoals: Subgoals::Set, scan: false },
];

/// One number of a result, the greater the better.
type Measure = fn(&Result) -> f64;

/// What one seed came to.
#[derive(Clone, Copy, Debug, Serialize)]
struct Result {
    options: usize,
    /// Options from the start to the goal; 0 where none covers the start.
    length: usize,
    chaining_probability: f64,
    success: f64,
    /// Median over the successful episodes.
    steps: f64,
}

pub(crate) fn run(options: &Options) -> Done {
    let seeds = options.seeds.unwrap_or(10);
    let mut tables = Vec::new();
    for (title, layout) in [("from the corner", Layout::Fixed(0)), ("starts anywhere", Layout::FixedMap(0))] {
        let results: Vec<_> = VARIANTS
            .iter()
            .map(|variant| (variant.name, over_seeds(seeds, |seed| four_rooms(*variant, layout, Seed(seed)))))
            .collect();
        println!("\nfour rooms where every third move goes astray, trained {title}, {seeds} seeds");
        tables.push((title, report(&results)));
    }
    println!("\narena with the goal in its middle, from the corners: steps by the optimal {CORNER}");
    let paths: Vec<_> = VARIANTS[..3]
        .iter()
        .map(|variant| (variant.name, over_seeds(seeds, |seed| arena(*variant, Seed(seed)))))
        .collect();
    for (name, ratios) in &paths {
        println!("  {name:24} {:.2}", mean_interval(ratios));
    }
    let shorter = superiority(&paths[1].1, &paths[0].1);
    println!("  sampled paths are longer than planned ones: {shorter:.2} {:?}", Verdict::of(&shorter));
    write(options, "robust", &(tables, paths))
}

/// A variant against "robust" in one measure.
#[derive(Serialize)]
struct Comparison {
    variant: String,
    measure: &'static str,
    /// P(robust > variant).
    superiority: Estimate,
    verdict: Verdict,
}

#[derive(Serialize)]
struct Report {
    results: Vec<(&'static str, Vec<Result>)>,
    comparisons: Vec<Comparison>,
}

fn report(results: &[(&'static str, Vec<Result>)]) -> Report {
    let column = |rows: &[Result], of: Measure| rows.iter().map(of).collect::<Vec<_>>();
    println!("  {:24} options  length  chaining probability  success            steps", "");
    for (name, rows) in results {
        let successes: f64 = rows.iter().map(|r| r.success * TRIALS as f64).sum();
        println!(
            "  {name:24} {:7.1}  {:6.1}  {:20}  {:17}  {:5.1}",
            median(&column(rows, |r| r.options as f64)).unwrap_or(f64::NAN),
            median(&column(rows, |r| r.length as f64)).unwrap_or(f64::NAN),
            format!("{:.2}", mean_interval(&column(rows, |r| r.chaining_probability))),
            format!("{:.3}", wilson(successes.round() as u64, TRIALS * rows.len() as u64)),
            median(&column(rows, |r| r.steps)).unwrap_or(f64::NAN),
        );
    }
    let measures: [(&str, Measure); 3] = [
        ("chaining probability", |r| r.chaining_probability),
        ("success", |r| r.success),
        ("fewer steps", |r| -r.steps),
    ];
    let mut comparisons = Vec::new();
    for (name, rows) in &results[1..] {
        for (measure, of) in measures {
            let superiority = superiority(&column(&results[0].1, of), &column(rows, of));
            let verdict = Verdict::of(&superiority);
            println!("  robust above {name}, {measure}: {superiority:.2} {verdict:?}");
            comparisons.push(Comparison { variant: (*name).to_owned(), measure, superiority, verdict });
        }
    }
    Report { results: results.to_vec(), comparisons }
}

/// The settings of the command line's agents, chapter 4's or chapter 3's sets and what goes with them.
fn settings(variant: Variant) -> Table {
    let baseline = !variant.dual && variant.subgoals == Subgoals::Set;
    let agent = if baseline { "dsc-tabular" } else { "robust-dsc-tabular" };
    Config::defaults(agent, "rooms-noisy").expect("both are in the registries").agent
}

/// Part of these settings.
fn part<T: DeserializeOwned>(settings: &Table, name: &str) -> T {
    settings[name].clone().try_into().expect("the command line reads the same")
}

/// What of the settings of sets is read here.
#[derive(Deserialize)]
struct Radii {
    examples: usize,
    radius: f32,
    optimistic_radius: f32,
}

fn sets(variant: Variant, place: &[usize]) -> Box<dyn Initiation<Vector, usize>> {
    let Radii { examples, radius, optimistic_radius } = part(&settings(variant), "initiation");
    let (places, sure) = (Arc::new(Select::new(place)), Nearest::new(radius));
    match variant.dual {
        true => Box::new(Dual::new(places, Nearest::new(optimistic_radius), sure, examples)),
        false => Box::new(Binary::new(places, sure, examples)),
    }
}

/// What is remembered, and how much is learned from it.
#[derive(Clone, Copy, Deserialize)]
struct Memory {
    capacity: usize,
    updates_per_step: f32,
    warm_up: usize,
}

/// Trains a variant in a world, and hands it to `judge`.
fn trained<T>(
    variant: Variant,
    mut env: World,
    tight: bool,
    seed: Seed,
    judge: impl Fn(&dyn Judged, World) -> T,
) -> T {
    let settings = settings(variant);
    let chain: ChainConfig = part(&settings, "chain");
    let timeout = if tight { TIGHT } else { chain.timeout };
    let chain = ChainConfig { subgoals: variant.subgoals, freeze: !variant.dual, timeout, ..chain };
    let tables: TabularConfig = part(&settings, "policy");
    let Memory { capacity, updates_per_step, warm_up } = part(&settings, "memory");
    let pace = Pace { updates_per_step, warm_up };
    let spec = env.spec().clone();
    let sets = sets(variant, &spec.place);
    let learner = TabularQ::new(4, &tables);
    let own = || PerSkill::new(learner.clone(), TabularQ::clone, capacity, pace);
    let aim = States { features: spec.place.clone(), tolerance: chain.tolerance };
    let agent: Box<dyn Judged> = match (variant.subgoals, variant.scan) {
        (Subgoals::Set, true) => {
            Box::new(Hierarchy::new(Chaining::new(&chain, &spec, sets, own(), Scan), capacity))
        }
        (Subgoals::Set, false) => {
            let over = TabularOverSkills::new(tables.rate, part::<Epsilon>(&settings, "exploration"));
            Box::new(Hierarchy::new(Chaining::new(&chain, &spec, sets, own(), over), capacity))
        }
        _ => {
            let shared =
                Shared::new(learner, Practice::new(Replay::new(capacity).paying(Pay::ATTAINMENT), pace));
            Box::new(Hierarchy::new(Chaining::new(&chain, &spec, sets, shared, Scan).aiming(aim), capacity))
        }
    };
    let mut agent = agent;
    for number in 0..EPISODES {
        let mut ctx = Context::training(seed, number);
        episode(&mut env, &mut *agent, seed.number("train-start", number), &mut ctx, |_, _| {})
            .expect("choices of an agent for four");
    }
    judge(&*agent, env)
}

/// An agent whose skills can be executed one by one.
trait Judged: Skilled<Vector, usize> {
    /// Executes skill `k` once; whether it reached its subgoal, and how the episode ended if it did. The state is that of
    /// `env` and `s`.
    fn execute(&self, k: u32, env: &mut World, s: &mut Vector, ctx: &mut Context) -> (bool, Option<End>);
}

impl<I, P, Q, S> Judged for Hierarchy<Vector, usize, Chaining<Vector, usize, I, P, Q, S>>
where
    I: Initiation<Vector, usize>,
    P: SkillPolicy<Vector, usize, S::Goal>,
    Q: PolicyOverSkills<Vector>,
    S: Aim<Vector>,
{
    fn execute(&self, k: u32, env: &mut World, s: &mut Vector, ctx: &mut Context) -> (bool, Option<End>) {
        let (method, mut lane) = (self.method(), Lane::default());
        let call = method.call(SkillId(k), &mut lane, s, self.experience(), ctx);
        // A success is to end in the subgoal, whichever state of it was gone for.
        let any = Call { goal: None, ..call.clone() };
        for step in 1..=call.budget {
            let action = method.act(&mut lane, &call, s, ctx);
            let taken = env.step(&action).expect("choices of an agent for four");
            let mut after = Vector::new();
            env.observe(&mut after);
            let t = inroads::agents::Transition {
                before: s,
                action: &action,
                reward: taken.reward,
                after: &after,
                end: taken.end,
            };
            let (there, inside) = (method.reached(&call, &t), method.reached(&any, &t));
            *s = after;
            if there || taken.end.is_some() || step == call.budget {
                return (inside, taken.end);
            }
        }
        (false, None)
    }
}

/// One agent in the noisy rooms, judged from the corner.
fn four_rooms(variant: Variant, layout: Layout, seed: Seed) -> Result {
    let rooms = |layout| {
        let world = Rooms::new(FOUR_ROOMS, SLIP, 300).expect("the map of the registry");
        TimeLimit::new(Symbolic::new(world, layout), 300)
    };
    trained(variant, rooms(layout), true, seed, |agent, _| {
        let mut env = rooms(Layout::Fixed(0));
        let frozen: Vec<_> = (0..TRIALS).map(|i| watched(agent, &mut env, seed, i)).collect();
        let steps: Vec<_> = frozen.iter().flatten().map(|steps| f64::from(*steps)).collect();
        let chain = chain_of(agent, &mut env);
        let open_loop = |i: &u64| {
            let mut ctx = Context::evaluation(seed, TRIALS + i);
            let mut env = rooms(Layout::Fixed(0));
            let mut s = begun(&mut env, seed.number("open-loop", *i));
            for k in &chain {
                match agent.execute(*k, &mut env, &mut s, &mut ctx) {
                    (_, Some(end)) => return end == End::Terminated,
                    (false, None) => return false,
                    (true, None) => {}
                }
            }
            // The last option's subgoal is the goal, which ends the episode.
            false
        };
        let whole = (0..TRIALS).filter(open_loop).count() as f64 / TRIALS as f64;
        Result {
            options: agent.skills().len(),
            length: chain.len(),
            chaining_probability: if chain.is_empty() { 0.0 } else { whole },
            success: steps.len() as f64 / TRIALS as f64,
            steps: median(&steps).unwrap_or(300.0),
        }
    })
}

/// The first observation of an episode.
fn begun(env: &mut World, start: u64) -> Vector {
    let mut s = Vector::new();
    env.reset(start);
    env.observe(&mut s);
    s
}

/// The options that lead from the start to the goal; none where no option covers the start.
fn chain_of(agent: &dyn Judged, env: &mut World) -> Vec<u32> {
    let members = agent.members(&begun(env, 0));
    let first = members.iter().position(|inside| *inside);
    first.map_or_else(Vec::new, |index| chain_from(&agent.skills(), index as u32 + 1))
}

/// The steps of one frozen episode that does the task.
fn watched(agent: &dyn Judged, env: &mut World, seed: Seed, index: u64) -> Option<u32> {
    let mut ctx = Context::evaluation(seed, index);
    let start = seed.number("evaluate-start", index);
    let summary = episode(env, &mut *agent.frozen(), start, &mut ctx, |_, _| {}).expect("a choice of four");
    summary.success.then_some(summary.steps)
}

/// One agent in the arena, trained from anywhere: the steps that it takes from the four corners, by the optimal ones.
/// An episode that fails counts with its steps.
fn arena(variant: Variant, seed: Seed) -> f64 {
    let room = |map: &str, layout| {
        let world = Rooms::new(map, 0.0, 100).expect("the map is right");
        TimeLimit::new(Symbolic::new(world, layout), 100)
    };
    trained(variant, room(ARENA, Layout::FixedMap(0)), false, seed, |agent, _| {
        let mut total = 0.0;
        for corner in 0..4 {
            let mut env = room(&started_in(corner), Layout::Fixed(0));
            for trial in 0..TRIALS / 20 {
                let steps = watched(agent, &mut env, seed, trial);
                total += f64::from(steps.unwrap_or(100)) / CORNER;
            }
        }
        total / (4 * (TRIALS / 20)) as f64
    })
}

/// The arena with its start in one of the four corners.
fn started_in(corner: u32) -> String {
    let row = if corner < 2 { 1 } else { 11 };
    let column = if corner.is_multiple_of(2) { 1 } else { 11 };
    let mut rows: Vec<Vec<char>> =
        ARENA.trim_matches('\n').lines().map(|row| row.replace('S', " ").chars().collect()).collect();
    rows[row][column] = 'S';
    rows.iter().map(|row| row.iter().collect::<String>() + "\n").collect()
}
