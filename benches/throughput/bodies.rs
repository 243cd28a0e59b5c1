//! What simulating costs: bodies alone, and as environments.

use std::hint::black_box;

use inroads::{
    envs::{
        Domain, Environment, Refused, Seed, Spec, Step,
        maze::maps,
        registry,
        vector::{AutoReset, VectorEnvironment},
    },
    sim::rigid::{Articulated, CellMap, PointRobot, ant},
};
use rand::RngExt;

use crate::workload::{CYCLE, Workload};

/// Actions that are drawn beforehand: drawing is not what is measured.
const ACTIONS: usize = 4096;

/// Environments of the registry that are measured: one of each kind of body, and the ant in every maze.
const ENVIRONMENTS: [&str; 7] =
    ["point-maze", "ant-u-maze", "ant-medium-maze", "ant-large-maze", "ant-four-rooms", "reacher", "door"];

/// Ants that are stepped together.
const COPIES: usize = 64;
/// Their steps on the caller's thread.
pub(crate) const ONE_THREAD: &str = "envs/vector/ant-u-maze, 1 thread";
/// Their steps on two threads.
pub(crate) const TWO_THREADS: &str = "envs/vector/ant-u-maze, 2 threads";

/// All workloads without tensors.
pub(crate) fn bodies() -> Vec<Workload> {
    let mut all = vec![
        point(),
        ant("sim/ant/step, open floor", None),
        ant("sim/ant/step, u-maze", Some((maps::U, 4.0))),
        ant("sim/ant/step, medium maze", Some((maps::MEDIUM, 4.0))),
        ant("sim/ant/step, large maze", Some((maps::LARGE, 4.0))),
        ant("sim/ant/step, four rooms", Some((maps::FOUR_ROOMS, 3.0))),
        ant_saved(),
        ant_restored(),
    ];
    all.extend(ENVIRONMENTS.map(environment));
    all.extend([vector(ONE_THREAD, 1), vector(TWO_THREADS, 2)]);
    all
}

/// The point robot among walls: physics alone.
fn point() -> Workload {
    let cells = CellMap::parse(maps::U, 4.0).expect("the maze is well formed");
    let actions = actions(&[[-1.0, 1.0], [-0.25, 0.25]]);
    let robot = PointRobot::new(cells);
    let start = robot.state();
    Workload::steps(
        "sim/point/step",
        CYCLE,
        robot,
        move |robot| robot.restore(start).expect("the start is free"),
        move |robot, at| {
            let [forward, turn] = [0, 1].map(|k| f64::from(actions[at % ACTIONS][k]));
            black_box(robot.step(forward, turn)).expect("the action is legal");
        },
    )
}

/// The ant with the thesis' physics: physics alone, from the zero state. Walls are a map and the side of its cells, metres.
fn ant(name: &str, walls: Option<(&str, f64)>) -> Workload {
    let world = ant_among(walls);
    let (start, actions) = (world.zero(), actions(&[[-1.0, 1.0]; 8]));
    Workload::steps(
        name,
        CYCLE,
        world,
        move |world| world.restore(&start).expect("the start is free"),
        move |world, at| world.step(black_box(&actions[at % ACTIONS])).expect("the action is legal"),
    )
}

fn ant_among(walls: Option<(&str, f64)>) -> Articulated {
    let walls = walls.map(|(map, scale)| CellMap::parse(map, scale).expect("the maze is well formed"));
    ant::world(&ant::THESIS, walls.as_ref()).expect("the ant is well formed")
}

/// Save an exact state, and go back to it.
fn ant_saved() -> Workload {
    let mut world = ant_among(Some((maps::U, 4.0)));
    // Among contacts: an ant that lies on its feet.
    (0..10).for_each(|_| world.step(&[0.0; 8]).expect("the action is legal"));
    Workload::repeated("sim/ant/save and load, u-maze", move || {
        let saved = black_box(world.save());
        world.load(&saved);
    })
}

/// Take up a state as if nothing had been before.
fn ant_restored() -> Workload {
    let mut world = ant_among(Some((maps::U, 4.0)));
    let zero = world.zero();
    Workload::repeated("sim/ant/restore, u-maze", move || {
        world.restore(black_box(&zero)).expect("the state is legal");
    })
}

/// An environment through its interface: step, observe, and reset when an episode is over.
fn environment(name: &str) -> Workload {
    let env = made(name);
    let actions = actions(&ranges(env.spec()));
    Workload::steps(
        &format!("envs/{name}/step and observe"),
        CYCLE,
        (env, Vec::new()),
        |(env, _)| env.reset(0),
        move |(env, observation), at| {
            let step = env.step(&actions[at % ACTIONS]).expect("the action is legal");
            if step.end.is_some() {
                env.reset(1);
            }
            env.observe(observation);
            black_box(observation);
        },
    )
}

/// Copies of the ant in its smallest maze, stepped together.
fn vector(name: &str, threads: usize) -> Workload {
    let copies = (0..COPIES).map(|_| SameStart(made("ant-u-maze"))).collect();
    let env = VectorEnvironment::new(copies, 0, AutoReset::SameStep)
        .and_then(|env| env.on_threads(threads))
        .expect("copies are alike, and the system gives threads");
    let all: Vec<usize> = (0..COPIES).collect();
    let actions: Vec<Vec<Vec<f32>>> =
        actions(&ranges(env.spec())).chunks_exact(COPIES).map(<[_]>::to_vec).collect();
    Workload::steps(
        name,
        CYCLE / COPIES,
        env,
        move |env| {
            env.restart(&all).expect("they exist");
        },
        move |env, at| {
            black_box(env.step(&actions[at % actions.len()]).expect("the actions are legal"));
        },
    )
    .at_once(COPIES, threads)
}

/// A domain whose episodes all begin alike, so that a cycle is the same work every time.
struct SameStart(Box<dyn Domain<Vec<f32>, Vec<f32>>>);

impl Environment for SameStart {
    type Observation = Vec<f32>;
    type Action = Vec<f32>;

    fn spec(&self) -> &Spec {
        self.0.spec()
    }

    fn reset(&mut self, _: u64) {
        self.0.reset(0);
    }

    fn step(&mut self, action: &Vec<f32>) -> Result<Step, Refused> {
        self.0.step(action)
    }

    fn observe(&mut self, out: &mut Vec<f32>) {
        self.0.observe(out);
    }
}

/// An environment of the registry.
fn made(name: &str) -> Box<dyn Domain<Vec<f32>, Vec<f32>>> {
    match registry::make(name) {
        Ok(registry::AnyEnvironment::Vectors(env)) => env,
        _ => unreachable!("`{name}` is in the registry, and its actions are vectors"),
    }
}

/// Ranges of the action's components.
fn ranges(spec: &Spec) -> Vec<[f32; 2]> {
    spec.action.dimensions().iter().map(|d| [d.low, d.high]).collect()
}

/// Random actions within ranges.
fn actions(ranges: &[[f32; 2]]) -> Vec<Vec<f32>> {
    let mut rng = Seed(0).stream("bench", 0);
    (0..ACTIONS).map(|_| ranges.iter().map(|&[low, high]| rng.random_range(low..=high)).collect()).collect()
}
