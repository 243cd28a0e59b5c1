//! Open-loop programs for the ant, and what is measured while they run.

use inroads_sim::rigid::{
    Articulated, Configuration,
    ant::{self, Preset},
};
use serde_json::Value;

#[path = "numbers.rs"]
mod random;

pub(crate) use random::Numbers;

/// Gymnasium's start: the zero state, positions moved by up to `noise`, velocities normal with that deviation.
pub(crate) fn start(world: &Articulated, noise: f32, seed: u64) -> Configuration {
    let (mut state, mut numbers) = (world.zero(), Numbers::new(seed));
    state.q.iter_mut().for_each(|q| *q += noise * numbers.uniform());
    state.v.iter_mut().for_each(|v| *v += noise * numbers.normal());
    state
}

/// a_j(t) = clip(bias_j + amp_j sin(2π f t + phase_j)), t = 0, dt, 2 dt, ...
#[derive(Clone, Debug)]
pub(crate) struct Program {
    frequency: f64,
    amplitude: Vec<f64>,
    phase: Vec<f64>,
    bias: Vec<f64>,
    seconds: f64,
    step: f64,
    pub(crate) noise: f32,
    pub(crate) starts: u64,
    /// How many starts ended upside down when it was recorded.
    pub(crate) upside_down: u64,
    pub(crate) recorded: Measures<Band>,
}

/// Least, mean and greatest over starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Band {
    pub(crate) min: f64,
    pub(crate) mean: f64,
    pub(crate) max: f64,
}

/// What is measured of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Measures<T> {
    /// Distance from start to end on the floor, metres.
    pub(crate) net: T,
    /// Length of the way on the floor, control step by control step, metres.
    pub(crate) path: T,
    /// Least height of the torso after any control step, metres.
    pub(crate) lowest: T,
    /// Greatest height of the torso after any control step, metres.
    pub(crate) highest: T,
}

impl Measures<Band> {
    pub(crate) fn read(program: &Value) -> Self {
        Self {
            net: Band::read(&program["net_displacement_m"]),
            path: Band::read(&program["path_length_m"]),
            lowest: Band::read(&program["min_torso_z"]),
            highest: Band::read(&program["max_torso_z"]),
        }
    }
}

impl<T> Measures<T> {
    pub(crate) fn named(self) -> [(&'static str, T); 4] {
        [("net", self.net), ("path", self.path), ("lowest", self.lowest), ("highest", self.highest)]
    }
}

/// One run of a program.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Run {
    pub(crate) measures: Measures<f64>,
    /// From start to end on the floor, metres.
    pub(crate) moved: [f64; 2],
    pub(crate) upside_down: bool,
}

impl Program {
    /// All programs of a document of fixtures.
    pub(crate) fn all(document: &Value) -> Vec<Self> {
        document["open_loop_programs"]
            .as_array()
            .expect("open_loop_programs")
            .iter()
            .map(Self::read)
            .collect()
    }

    fn read(program: &Value) -> Self {
        let number = |key: &str| program[key].as_f64().unwrap_or_else(|| panic!("no number {key}"));
        let bias = numbers(&program["bias"]);
        Self {
            frequency: number("freq_hz"),
            amplitude: numbers(&program["amp"]),
            phase: numbers(&program["phase"]),
            bias: if bias.is_empty() { vec![0.0; 8] } else { bias },
            seconds: number("seconds"),
            step: number("control_dt"),
            noise: number("init_noise") as f32,
            starts: number("seeds") as u64,
            upside_down: number("ended_upside_down") as u64,
            recorded: Measures::read(program),
        }
    }

    pub(crate) fn action(&self, step: usize) -> Vec<f32> {
        let time = step as f64 * self.step;
        let wave = |j: usize| {
            let angle = std::f64::consts::TAU * self.frequency * time + self.phase[j];
            (self.bias[j] + self.amplitude[j] * angle.sin()).clamp(-1.0, 1.0) as f32
        };
        (0..self.amplitude.len()).map(wave).collect()
    }

    /// Whether a record describes this program.
    pub(crate) fn is(&self, record: &Value) -> bool {
        record["freq_hz"].as_f64() == Some(self.frequency)
            && numbers(&record["amp"]) == self.amplitude
            && numbers(&record["phase"]) == self.phase
    }

    /// Runs the program from a noisy start.
    pub(crate) fn run(&self, world: &mut Articulated, seed: u64) -> Run {
        let from = start(world, self.noise, seed);
        world.restore(&from).expect("a start");
        let steps = (self.seconds / self.step).round() as usize;
        let at = |world: &Articulated| [0, 1, 2].map(|axis| f64::from(world.configuration().q[axis]));
        let (first, mut last) = (at(world), at(world));
        let (mut path, mut lowest, mut highest) = (0.0, f64::INFINITY, f64::NEG_INFINITY);
        for step in 0..steps {
            world.step(&self.action(step)).expect("a step");
            let now = at(world);
            path += (now[0] - last[0]).hypot(now[1] - last[1]);
            lowest = now[2].min(lowest);
            highest = now[2].max(highest);
            last = now;
        }
        let moved = [last[0] - first[0], last[1] - first[1]];
        let net = moved[0].hypot(moved[1]);
        Run { measures: Measures { net, path, lowest, highest }, moved, upside_down: upside_down(world) }
    }

    /// Runs the program from as many noisy starts as were recorded.
    pub(crate) fn runs(&self, preset: &Preset) -> Vec<Run> {
        let mut world = ant::world(preset, None).expect("the ant");
        (0..self.starts).map(|seed| self.run(&mut world, 1 + seed)).collect()
    }
}

/// Whether the torso's z axis points down.
pub(crate) fn upside_down(world: &Articulated) -> bool {
    let q = &world.configuration().q;
    1.0 - 2.0 * (q[4] * q[4] + q[5] * q[5]) < 0.0
}

impl Band {
    pub(crate) fn read(band: &Value) -> Self {
        let number = |key: &str| band[key].as_f64().unwrap_or_else(|| panic!("no number {key}"));
        Self { min: number("min"), mean: number("mean"), max: number("max") }
    }

    pub(crate) fn of(values: impl Iterator<Item = f64> + Clone) -> Self {
        let count = values.clone().count() as f64;
        Self {
            min: values.clone().fold(f64::INFINITY, f64::min),
            mean: values.clone().sum::<f64>() / count,
            max: values.fold(f64::NEG_INFINITY, f64::max),
        }
    }
}

/// The mean of each measure over runs.
pub(crate) fn means(runs: &[Run]) -> Measures<f64> {
    let mean = |of: fn(&Measures<f64>) -> f64| {
        runs.iter().map(|run| of(&run.measures)).sum::<f64>() / runs.len() as f64
    };
    Measures {
        net: mean(|m| m.net),
        path: mean(|m| m.path),
        lowest: mean(|m| m.lowest),
        highest: mean(|m| m.highest),
    }
}

/// The mean movement, metres.
pub(crate) fn moved(runs: &[Run]) -> [f64; 2] {
    [0, 1].map(|axis| runs.iter().map(|run| run.moved[axis]).sum::<f64>() / runs.len() as f64)
}

pub(crate) fn numbers(list: &Value) -> Vec<f64> {
    list.as_array().into_iter().flatten().map(|x| x.as_f64().expect("a number")).collect()
}
