//! Random play of the ant in a maze, and whether the simulation holds: `stability [MAZE] [STEPS] [SEED]`.
//!
//! MAZE is `u`, `medium`, `large` or `four-rooms` (default `u`), STEPS control steps (default 10000). Episodes of
//! 250 steps start at free places drawn at random, from where legs just do not reach the walls. After every
//! tenth the ant is left alone for 100 steps, in which its energy must not grow.

#![allow(clippy::print_stdout)]

use std::{env, error::Error, process::ExitCode};

use inroads_sim::rigid::{
    Articulated, CellMap,
    ant::{THESIS, world},
};

#[path = "../tests/support/stability.rs"]
mod stability;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let mut arguments = env::args().skip(1);
    let maze = arguments.next().unwrap_or_else(|| "u".into());
    let steps = arguments.next().map_or(Ok(10_000), |steps| steps.parse())?;
    let seed = arguments.next().map_or(Ok(1), |seed| seed.parse())?;
    let Some((_, text, scale)) = stability::MAZES.into_iter().find(|(name, ..)| *name == maze) else {
        return Err(format!("no maze {maze:?}; use u, medium, large or four-rooms").into());
    };
    let map = CellMap::parse(text, scale)?;
    let mut ant: Articulated = world(&THESIS, Some(&map))?;
    let report = stability::play(&mut ant, &map, steps, seed);
    println!("{maze}: {report:#?}");
    Ok(if report.holds() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
