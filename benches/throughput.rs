//! Throughput of what everything else is made of: `cargo bench --bench throughput`.
//!
//! A line a workload (median of several rounds), and all of them in `target/throughput.json`. `-- --quick` runs one
//! short round, to see that it works. Nothing is asserted here: a machine's noise is no reason to fail.
#![allow(clippy::print_stdout)] // what the command is for

use std::{
    hint::black_box,
    sync::Arc,
    time::{Duration, Instant},
};

use burn::tensor::{Device, Tensor, TensorData};
use inroads::{
    agents::{
        Clip, Context, Encoder, Learner, Memory,
        ddpg::{Ddpg, DdpgConfig},
        encode::Scaled,
        nets::Backend,
    },
    envs::{Environment, Seed, maze, registry},
    sim::rigid::{CellMap, PointRobot},
};
use rand::RngExt;

/// One line of the result.
struct Workload {
    name: &'static str,
    /// Median time of one operation, in microseconds.
    micros: f64,
}

/// How long to measure.
struct Budget {
    rounds: usize,
    round: Duration,
}

impl Budget {
    /// Times an operation, counted in batches that last about a round.
    fn time(&self, name: &'static str, mut operation: impl FnMut()) -> Workload {
        operation();
        let mut micros: Vec<f64> = (0..self.rounds)
            .map(|_| {
                let (began, mut operations) = (Instant::now(), 0u32);
                while began.elapsed() < self.round {
                    operation();
                    operations += 1;
                }
                began.elapsed().as_secs_f64() * 1e6 / f64::from(operations)
            })
            .collect();
        micros.sort_by(f64::total_cmp);
        let workload = Workload { name, micros: micros[micros.len() / 2] };
        println!("{name:<40} {:>12.3} µs {:>14.0} a second", workload.micros, 1e6 / workload.micros);
        workload
    }
}

fn main() {
    let quick = std::env::args().any(|argument| argument == "--quick");
    let budget = if quick {
        Budget { rounds: 1, round: Duration::from_millis(20) }
    } else {
        Budget { rounds: 7, round: Duration::from_millis(400) }
    };
    let mut workloads = point(&budget);
    workloads.extend(ddpg(&budget));

    let of = |name: &str| workloads.iter().find(|w| w.name == name).map_or(f64::NAN, |w| w.micros);
    let overhead = of("agents/ddpg/update") / of("agents/ddpg/update, products alone");
    println!("a DDPG update takes {overhead:.2} times its matrix products alone");
    let json: serde_json::Map<String, serde_json::Value> =
        workloads.iter().map(|w| (w.name.to_owned(), w.micros.into())).collect();
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/target/throughput.json");
    match std::fs::write(path, serde_json::Value::from(json).to_string()) {
        Ok(()) => println!("wrote {path}"),
        Err(error) => println!("could not write {path}: {error}"),
    }
}

/// The point robot among walls: physics alone, and as an environment.
fn point(budget: &Budget) -> Vec<Workload> {
    let mut rng = Seed(0).stream("bench", 0);
    let actions: Vec<Vec<f32>> =
        (0..4096).map(|_| vec![rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0)]).collect();
    let cells = CellMap::parse(maze::U_MAZE.cells, maze::U_MAZE.scale).expect("the maze is well formed");
    let mut robot = PointRobot::new(cells);
    let mut at = 0;
    let physics = budget.time("sim/point/step", || {
        at = (at + 1) % actions.len();
        let (forward, turn) = (f64::from(actions[at][0]), 0.25 * f64::from(actions[at][1]));
        black_box(robot.step(forward, turn)).expect("the action is legal");
    });
    let Ok(registry::AnyEnvironment::Vectors(mut env)) = registry::make("point-maze") else {
        unreachable!("the Point-Maze is in the registry")
    };
    let (mut seed, mut observation) = (0, Vec::new());
    env.reset(seed);
    let environment = budget.time("envs/point-maze/step and observe", || {
        at = (at + 1) % actions.len();
        let step = env.step(&actions[at]).expect("the action is legal");
        if step.end.is_some() {
            seed += 1;
            env.reset(seed);
        }
        env.observe(&mut observation);
        black_box(&observation);
    });
    vec![physics, environment]
}

/// DDPG of the paper's size (400-300, batch 64) on the Point-Maze's observations.
fn ddpg(budget: &Budget) -> Vec<Workload> {
    let spec = registry::make("point-maze").expect("it is in the registry").spec().clone();
    let encoder = Arc::new(Scaled::new(&spec.observation));
    let inputs = Encoder::<Vec<f32>>::width(&*encoder);
    let config = DdpgConfig::default();
    let mut rng = Seed(0).stream("bench", 1);
    let mut learner: Ddpg<Vec<f32>> = Ddpg::new(encoder, 2, &config, Backend::Flex, &mut rng);
    let observations: Vec<Vec<f32>> =
        (0..=config.batch).map(|_| (0..6).map(|_| rng.random_range(-1.0..1.0)).collect()).collect();
    let actions: Vec<Vec<f32>> =
        (0..config.batch).map(|_| vec![rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0)]).collect();
    let clips: Vec<Clip<Vec<f32>, Vec<f32>>> = (0..config.batch)
        .map(|i| Clip {
            observations: &observations[i..=i + 1],
            actions: &actions[i..=i],
            reward: -1.0,
            terminal: false,
        })
        .collect();
    let mut ctx = Context::training(Seed(0), 0);
    let mut memory = Memory::new();
    let acting = budget.time("agents/ddpg/act", || {
        black_box(learner.act(&mut memory, &observations[0], &mut ctx));
    });
    let update = budget.time("agents/ddpg/update", || {
        black_box(learner.learn(&clips, &mut ctx));
    });
    let products = Products::of_update(config.batch, inputs, 2, config.hidden[0], config.hidden[1]);
    let alone = budget.time("agents/ddpg/update, products alone", || products.compute());
    let row = Products::of_acting(inputs, 2, config.hidden[0], config.hidden[1]);
    let row = budget.time("agents/ddpg/act, products alone", || row.compute());
    vec![acting, update, alone, row]
}

/// Matrix products on the backend of the learners, without anything around them.
struct Products(Vec<(Tensor<2>, Tensor<2>)>);

impl Products {
    /// Products of `[m, k]` and `[k, n]`.
    fn new(shapes: Vec<[usize; 3]>) -> Self {
        let device = Device::flex();
        let matrix = |rows: usize, columns: usize| {
            let values: Vec<f32> = (0..rows * columns).map(|i| (i % 17) as f32 / 17.0 - 0.5).collect();
            Tensor::<2>::from_data(TensorData::new(values, [rows, columns]), &device)
        };
        Self(shapes.into_iter().map(|[m, k, n]| (matrix(m, k), matrix(k, n))).collect())
    }

    fn of_acting(inputs: usize, actions: usize, first: usize, second: usize) -> Self {
        Self::new(vec![[1, inputs, first], [1, first, second], [1, second, actions]])
    }

    /// Every product of an update. The action enters the critic at its second layer, by weights of its own, so the
    /// actor's pass goes back through that layer's action weights only.
    fn of_update(batch: usize, inputs: usize, actions: usize, first: usize, second: usize) -> Self {
        let actor = [[batch, inputs, first], [batch, first, second], [batch, second, actions]];
        let into_second = [batch, actions, second];
        let critic = [[batch, inputs, first], [batch, first, second], into_second, [batch, second, 1]];
        let weights = |[m, k, n]: [usize; 3]| [k, m, n];
        let entering = |[m, k, n]: [usize; 3]| [m, n, k];
        let mut shapes = Vec::new();
        shapes.extend(actor); // target actor
        shapes.extend(critic); // target critic
        shapes.extend(critic); // critic forth
        shapes.extend(critic.map(weights));
        shapes.extend([critic[1], critic[3]].map(entering)); // nothing before the first layer learns
        shapes.extend(actor); // actor forth
        shapes.extend(critic); // and through the critic
        shapes.extend([critic[3], into_second].map(entering)); // back to the action
        shapes.extend(actor.map(weights));
        shapes.extend([actor[1], actor[2]].map(entering));
        Self::new(shapes)
    }

    fn compute(&self) {
        for (a, b) in &self.0 {
            black_box(a.clone().matmul(b.clone()));
        }
    }
}
