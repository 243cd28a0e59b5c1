//! A number that depends on every bit of the states that three bodies go through.
//!
//! With the feature `enhanced-determinism` it is the same on every platform: `scripts/wasm-hash` compares this
//! machine's with that of a build for wasm32 under Node. There programs can neither print nor take arguments; so
//! each call of `main` returns one more byte of the number as its exit code, the least significant first.

#![allow(clippy::print_stdout)] // what the example is for

use std::{
    error::Error,
    process::ExitCode,
    sync::{
        OnceLock,
        atomic::{AtomicUsize, Ordering},
    },
};

use inroads_sim::rigid::{CellMap, Configuration, PointRobot, ant, reacher::Arm};

const U_MAZE: &str = "#####\n#r..#\n###.#\n#g..#\n#####";

/// FNV-1a over the bytes of numbers.
struct Hash(u64);

impl Hash {
    fn add(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    fn add_state(&mut self, state: &Configuration) {
        state.q.iter().chain(&state.v).for_each(|number| self.add(&number.to_bits().to_le_bytes()));
    }
}

/// Numbers in [-1, 1) from integers alone (Knuth's linear congruence).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1_u64 << 23) as f32 - 1.0
    }
}

/// An ant, a point robot and a reacher under random actions.
fn state_hash() -> Result<u64, Box<dyn Error>> {
    let (mut hash, mut numbers) = (Hash(0xcbf2_9ce4_8422_2325), Numbers(1));
    let map = CellMap::parse(U_MAZE, 4.0)?;

    let mut ant = ant::world(&ant::THESIS, Some(&map))?;
    let mut controls = vec![0.0; ant.actuators()];
    for step in 0..500 {
        // Kept for half a second, so that it gets somewhere.
        if step % 5 == 0 {
            controls.fill_with(|| numbers.next());
        }
        ant.step(&controls)?;
        hash.add_state(ant.configuration());
    }

    let mut robot = PointRobot::new(map);
    for _ in 0..2000 {
        robot.step(numbers.next().into(), 0.25 * f64::from(numbers.next()))?;
        let state = robot.state();
        for number in [state.x, state.y, state.theta, state.vx, state.vy, state.omega] {
            hash.add(&number.to_bits().to_le_bytes());
        }
    }

    let mut arm = Arm::new();
    for step in 0..200 {
        // Pushed one way for a while, so that the elbow meets its limit.
        let bias = if step % 50 < 25 { 0.5 } else { -0.5 };
        arm.step([numbers.next(), 0.5 * numbers.next() + bias])?;
        hash.add_state(arm.state());
    }
    Ok(hash.0)
}

fn main() -> ExitCode {
    static HASH: OnceLock<u64> = OnceLock::new();
    static CALLS: AtomicUsize = AtomicUsize::new(0);
    let hash = *HASH.get_or_init(|| state_hash().expect("three bodies of ours can be simulated"));
    if cfg!(target_arch = "wasm32") {
        return ExitCode::from(hash.to_le_bytes()[CALLS.fetch_add(1, Ordering::Relaxed) % 8]);
    }
    println!("{hash:016x}");
    ExitCode::SUCCESS
}
