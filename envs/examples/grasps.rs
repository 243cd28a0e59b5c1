//! Asks the oracle which grasps of Door, Lever and Slide can succeed, says how fast that went, and writes the maps
//! where they are told to: `cargo run --release --example grasps -- tests/fixtures/manipulation`.
#![allow(clippy::print_stdout)]

use std::{error::Error, fs, path::Path, time::Instant};

use inroads_envs::{
    Environment, Sweep,
    manipulation::{DOOR, LEVER, Manipulation, POINTS, SLIDE, Spread, WRISTS, oracle},
};

/// A map as the tests read it.
#[derive(serde::Serialize)]
struct Record<'a> {
    task: &'a str,
    spread: Spread,
    /// A row for each point, a column for each wrist.
    good: Vec<String>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1);
    for task in [&DOOR, &LEVER, &SLIDE] {
        let mut env = Manipulation::new(task)?;
        let begun = Instant::now();
        (0..env.starts()).step_by(WRISTS).for_each(|start| env.begin(start));
        let reset = begun.elapsed() / POINTS as u32;
        let begun = Instant::now();
        let idle = vec![0.0; env.spec().action.len()];
        for _ in 0..1000 {
            env.step(&idle)?;
        }
        let speed = 1000.0 / begun.elapsed().as_secs_f64();
        let good: Vec<_> = (0..env.starts()).map(|start| oracle::succeeds(&mut env, start)).collect();
        let share = 100.0 * good.iter().filter(|good| **good).count() as f64 / good.len() as f64;
        println!("{}: {share:.1} % of the grasps, {speed:.0} steps/s, {reset:.1?} a reset", task.name);
        let row =
            |wrists: &[bool]| wrists.iter().map(|good| if *good { '1' } else { '0' }).collect::<String>();
        let map: Vec<_> = good.chunks(WRISTS).map(row).collect();
        match &folder {
            Some(folder) => {
                let record = Record { task: task.name, spread: task.spread, good: map };
                let text = serde_json::to_string_pretty(&record)? + "\n";
                fs::write(Path::new(folder).join(task.name).with_extension("json"), text)?;
            }
            None => println!("{}", map.join(" ")),
        }
    }
    Ok(())
}
