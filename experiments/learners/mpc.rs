//! Model-based control in the open ant arena (thesis 4.1.3): fifty random episodes, one fit, ten goals at 5 m.
//!
//! Nothing is learned after the fit. Beside the default: the papers' random actions, drawn anew at every step; no random
//! actions among the planned ones. And on the same states what the plans of the default planner and of random shooting are
//! worth.

use std::{f32::consts::TAU, sync::Arc};

use inroads::{
    agents::{
        Bag, Checkpoint, Context, Memory, Mpc, episode,
        mpc::{
            Candidates, FreeBody, MpcConfig, Planner, PlannerKind, Predict, Problem, Reach, Refining, Reward,
            Shooting, View,
        },
        nets::Backend,
    },
    envs::{
        Environment, Goal, Goals, Seed, TimeLimit,
        maze::{
            AntMaze, Maze, Starts,
            catalogue::{ANT_REACHER, FREE_ARENA},
        },
    },
    statistics::mean_interval,
};
use serde::Serialize;

use crate::{
    Options,
    support::{Done, over_seeds, write},
};

/// Goals, in as many directions.
const GOALS: u64 = 10;
/// Their distance from the start, metres.
const FAR: f32 = 5.0;
/// Steps that there are for one.
const LIMIT: u32 = 300;
/// Steps of a random episode.
const WALK: u32 = 1000;
/// Where the velocity begins in what the ant observes.
const VELOCITY: usize = 15;
/// States in which plans are compared are so many steps apart, and so many a seed.
const APART: usize = 20;
const STATES: usize = 30;

/// Goals that are walked to with each planner; random shooting thinks for about a second a step.
const WALKED: u64 = 3;

/// What is compared.
struct Variant {
    name: &'static str,
    hold: u32,
    epsilon: f32,
}

const VARIANTS: [Variant; 3] = [
    Variant { name: "default", hold: 10, epsilon: 0.1 },
    Variant { name: "random actions anew each step", hold: 1, epsilon: 0.1 },
    Variant { name: "no random actions among the planned", hold: 10, epsilon: 0.0 },
];

/// What one seed came to.
#[derive(Serialize)]
struct Trial {
    /// Mean square one-step error in standardised changes on the episodes held out.
    held_out: f32,
    reached: usize,
    /// Steps to each goal; none where it was not reached.
    steps: Vec<Option<u32>>,
}

/// What plans are worth, in the mean over states.
#[derive(Clone, Copy, Default, Serialize)]
struct Worth {
    /// By the model: Σ γ^{t−1} R.
    model: f64,
    /// In the simulator.
    truth: f64,
    /// Predicted states a plan.
    predictions: usize,
}

pub(crate) fn run(options: &Options) -> Done {
    let seeds = options.seeds.unwrap_or(5);
    let mut trials = Vec::new();
    println!(
        "{GOALS} goals at {FAR} m within {LIMIT} steps, after 50 random episodes and one fit; {seeds} seeds"
    );
    println!("  {:38} goals reached by seed   median steps  one-step error", "");
    for variant in &VARIANTS {
        let results = over_seeds(seeds, |seed| trial(variant, &trained(variant, Seed(seed)), Seed(seed)).0);
        report(variant.name, &results);
        trials.push((variant.name, results));
    }
    let worths = over_seeds(seeds, |seed| compared(Seed(seed)));
    println!("plans of 7 actions on the same {STATES} states a seed, mean of Σ 0.95^(t−1) R");
    println!("  {:38} by the model     in truth   predictions", "");
    for (i, (name, _)) in planners().iter().enumerate() {
        let column = |of: fn(&Worth) -> f64| {
            mean_interval(&worths.iter().map(|seed| of(&seed[i])).collect::<Vec<_>>())
        };
        let predictions = worths[0][i].predictions;
        println!("  {name:38} {:.2}  {:.2}  {predictions}", column(|w| w.model), column(|w| w.truth));
    }
    let names: Vec<_> = planners().iter().map(|(name, _)| *name).collect();
    write(options, "mpc", &serde_json::json!({ "goals": trials, "planners": names, "plans": worths }))
}

/// What a planner came to on its way to goals.
#[derive(Serialize)]
struct Walk {
    /// Predicted states a plan.
    predictions: usize,
    /// Steps to each goal; none where it was not reached.
    steps: Vec<Option<u32>>,
}

/// Success and steps with each planner, with the same model, on the same goals, and no random actions.
pub(crate) fn walk(options: &Options) -> Done {
    let seeds = options.seeds.unwrap_or(2);
    println!(
        "{WALKED} goals at {FAR} m within {LIMIT} steps, the same model for all planners; {seeds} seeds"
    );
    let walks = over_seeds(seeds, |seed| walked(Seed(seed)));
    for (i, (name, planner)) in walkers().iter().enumerate() {
        let all: Vec<_> = walks.iter().flat_map(|seed| &seed[i].steps).collect();
        let mut steps: Vec<_> = all.iter().copied().flatten().collect();
        steps.sort_unstable();
        let median = steps.get(steps.len() / 2).map_or("-".to_owned(), ToString::to_string);
        let (reached, predictions) = (steps.len(), planner.planner().predictions());
        println!(
            "  {name:38} {reached} of {}, median {median} steps, {predictions} predictions a plan {all:?}",
            all.len()
        );
    }
    let names: Vec<_> = walkers().into_iter().map(|(name, _)| name).collect();
    write(options, "mpc-walk", &serde_json::json!({ "planners": names, "walks": walks }))
}

/// The agent with other planners.
fn walkers() -> Vec<(&'static str, MpcConfig)> {
    let plain = MpcConfig { epsilon: 0.0, ..MpcConfig::default() };
    let refining = |candidates: usize, horizon: usize| {
        let short = Refining { candidates, elites: candidates / 10, horizon, ..Refining::default() };
        MpcConfig {
            refining: if horizon == 7 { Refining { discount: 0.95, ..short } } else { short },
            ..plain.clone()
        }
    };
    let default = Refining::default();
    vec![
        ("default: refining, 3 rounds of 250 × 15", refining(default.candidates, default.horizon)),
        ("refining, 3 rounds of 80 × 15", refining(80, default.horizon)),
        ("refining, 3 rounds of 250 × 7", refining(250, 7)),
        ("refining, 3 rounds of 80 × 7", refining(80, 7)),
        ("random shooting, 14,000 × 7", MpcConfig { planner: PlannerKind::Shooting, ..plain.clone() }),
    ]
}

/// What each planner comes to with the model of one agent.
fn walked(seed: Seed) -> Vec<Walk> {
    let (agent, mut learned) = (trained(&VARIANTS[0], seed), Bag::default());
    agent.save(&mut learned);
    let mut env = arena(ANT_REACHER, LIMIT);
    let mut walks = Vec::new();
    for (name, config) in walkers() {
        let mut walker = untrained(&config, &env, seed);
        walker.load(&learned).expect("they differ in the planner alone");
        let mut steps = Vec::new();
        for number in 0..WALKED {
            let goal = goal(number);
            env.set_goal(&goal.at).expect("the arena is wider than 5 m");
            let (start, mut ctx) = (seed.number("evaluate-start", number), Context::evaluation(seed, number));
            let summary = episode(&mut env, &mut walker.towards(goal), start, &mut ctx, |_, _| {})
                .expect("planned actions are admitted");
            steps.push(summary.success.then_some(summary.steps));
            eprintln!("  {name} {seed:?}: {steps:?}");
        }
        walks.push(Walk { predictions: config.planner().predictions(), steps });
    }
    walks
}

fn report(name: &str, results: &[Trial]) {
    let reached: Vec<_> = results.iter().map(|trial| trial.reached).collect();
    let mut steps: Vec<_> = results.iter().flat_map(|trial| trial.steps.iter().flatten()).collect();
    steps.sort_unstable();
    let median = steps.get(steps.len() / 2).map_or("-".to_owned(), ToString::to_string);
    let error = results.iter().map(|trial| trial.held_out).sum::<f32>() / results.len() as f32;
    println!("  {name:38} {:22}  {median:>12}  {error:14.3}", format!("{reached:?}"));
}

/// The arena, with starts in its middle.
fn arena(maze: Maze<'static>, limit: u32) -> TimeLimit<AntMaze> {
    let maze = Maze { starts: Starts::Map, ..maze };
    TimeLimit::new(AntMaze::new(&maze).expect("a maze of the registry"), limit)
}

fn goal(number: u64) -> Goal {
    let direction = TAU * (number as f32 / GOALS as f32 + 0.015);
    Goal { dims: vec![0, 1], at: vec![FAR * direction.cos(), FAR * direction.sin()], tolerance: 0.6 }
}

/// An agent that has learned nothing yet.
fn untrained(config: &MpcConfig, env: &impl Environment, seed: Seed) -> Mpc {
    let (width, actions) = (env.spec().observation.len(), env.spec().action.len());
    let view: Arc<dyn View> = Arc::new(FreeBody::new(width, VELOCITY));
    let mut rng = seed.stream("initialise", 0);
    Mpc::new(view, actions, goal(0), config, Backend::default(), &mut rng)
}

/// An agent after its random episodes and its fit.
fn trained(variant: &Variant, seed: Seed) -> Mpc {
    let mut env = arena(FREE_ARENA, WALK);
    let config = MpcConfig { hold: variant.hold, epsilon: variant.epsilon, ..MpcConfig::default() };
    let mut agent = untrained(&config, &env, seed);
    for number in 0..config.warm_up {
        let mut ctx = Context::training(seed, number);
        episode(&mut env, &mut agent, seed.number("train-start", number), &mut ctx, |_, _| {})
            .expect("random actions are admitted");
    }
    agent
}

/// Every goal once, and states on the way to each.
fn trial(variant: &Variant, agent: &Mpc, seed: Seed) -> (Trial, Vec<(u64, Vec<f32>)>) {
    let mut env = arena(ANT_REACHER, LIMIT);
    let (mut steps, mut states) = (Vec::new(), Vec::new());
    for number in 0..GOALS {
        let goal = goal(number);
        env.set_goal(&goal.at).expect("the arena is wider than 5 m");
        let (mut ctx, mut taken) = (Context::evaluation(seed, number), 0);
        let watch = |t: &inroads::agents::Transition<Vec<f32>, Vec<f32>>, _| {
            if taken % APART == 0 {
                states.push((number, t.before.clone()));
            }
            taken += 1;
        };
        let start = seed.number("evaluate-start", number);
        let summary = episode(&mut env, &mut agent.towards(goal), start, &mut ctx, watch)
            .expect("planned actions are admitted");
        steps.push(summary.success.then_some(summary.steps));
    }
    let reached = steps.iter().flatten().count();
    eprintln!("  {} {seed:?}: {reached} {steps:?} {:?}", variant.name, agent.last_fit());
    (Trial { held_out: agent.last_fit().held_out.unwrap_or(f32::NAN), reached, steps }, states)
}

/// Planners with the papers' horizon and discount.
fn planners() -> [(&'static str, Box<dyn Planner>); 3] {
    let refining = |candidates| {
        let elites = candidates / 10;
        Refining { horizon: 7, discount: 0.95, candidates, elites, ..Refining::default() }
    };
    [
        ("random shooting, 14,000 sequences", Box::new(Shooting::default())),
        ("refining, 3 rounds of 250", Box::new(refining(250))),
        ("refining, 3 rounds of 80", Box::new(refining(80))),
    ]
}

/// What the planners' plans are worth on the same states, each without a plan to begin with.
fn compared(seed: Seed) -> Vec<Worth> {
    let agent = trained(&VARIANTS[0], seed);
    let (_, states) = trial(&VARIANTS[0], &agent, seed);
    let mut ant = AntMaze::new(&FREE_ARENA).expect("a maze of the registry");
    let (model, states) = (agent.dynamics(), &states[..STATES.min(states.len())]);
    let judged = |(i, (_, planner)): (usize, &(&str, Box<dyn Planner>))| {
        let mut worth = Worth { predictions: planner.predictions(), ..Worth::default() };
        for (j, (number, s)) in states.iter().enumerate() {
            let goal = goal(*number);
            let objective = Reach { goal: &goal, reward: Reward::Dense, values: None };
            let problem = Problem { model, objective: &objective, s };
            let mut rng = seed.stream("plans", (i * STATES + j) as u64);
            let plan = planner.plan(&problem, &mut Memory::new(), &mut rng);
            let truth = Problem { model: &Simulator::new(&mut ant), ..problem };
            let plan = Candidates::one(&plan, model.actions());
            worth.model += f64::from(plan.returns(&problem, 0.95)[0]) / states.len() as f64;
            worth.truth += f64::from(plan.returns(&truth, 0.95)[0]) / states.len() as f64;
        }
        worth
    };
    planners().iter().enumerate().map(judged).collect()
}

/// The simulator as a model that is exact, but for warm starts and contacts, which a state does not tell.
struct Simulator<'a>(std::cell::RefCell<&'a mut AntMaze>);

impl<'a> Simulator<'a> {
    fn new(ant: &'a mut AntMaze) -> Self {
        Self(std::cell::RefCell::new(ant))
    }
}

impl Predict for Simulator<'_> {
    fn actions(&self) -> usize {
        self.0.borrow().spec().action.len()
    }

    fn next(&self, states: &[f32], actions: &[f32]) -> Vec<f32> {
        let mut ant = self.0.borrow_mut();
        let (mut next, mut seen) = (Vec::new(), Vec::new());
        let width = ant.spec().observation.len();
        for (s, action) in states.chunks_exact(width).zip(actions.chunks_exact(ant.spec().action.len())) {
            let mut now = ant.configuration().clone();
            let (q, v) = s.split_at(now.q.len());
            now.q.copy_from_slice(q);
            now.v.copy_from_slice(v);
            ant.restore(&now).expect("an ant has been there");
            ant.step(&action.to_vec()).expect("planned actions are admitted");
            ant.observe(&mut seen);
            next.extend_from_slice(&seen);
        }
        next
    }
}
