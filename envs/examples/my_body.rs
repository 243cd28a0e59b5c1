//! A body of your own, from an MJCF file, where the ant stands: in a maze.
//!
//! `cargo run --release -p inroads-envs --example my_body -- my_body.xml`
//!
//! The file needs one tree of bodies whose first has a `<freejoint/>`, and `<motor>`s with a `ctrlrange`. What is not
//! understood is refused with its line. Without a file a beetle with six legs walks.

#![allow(clippy::print_stdout, clippy::print_stderr)] // what the example is for

use std::{error::Error, process::ExitCode};

use inroads_envs::{
    Environment, TimeLimit,
    maze::{AntMaze, Body, Maze, U_MAZE},
};
use inroads_sim::rigid::{Model, Physics, ant};

const BEETLE: &str = include_str!("../../tests/fixtures/mjcf/beetle.xml");

fn main() -> ExitCode {
    match walk() {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("error: {why}");
            ExitCode::from(2)
        }
    }
}

fn walk() -> Result<(), Box<dyn Error>> {
    let text = match std::env::args().nth(1).filter(|argument| argument != "--quick") {
        Some(path) => std::fs::read_to_string(&path).map_err(|why| format!("{path}: {why}"))?,
        None => BEETLE.to_owned(),
    };
    let model = Model::from_mjcf(&text)?;
    let maze = Maze { name: "beetle-maze", about: "a body of mine in a U", ..U_MAZE };
    // `AntMaze::walked_by(&maze, &model)` has the ant's physics: one call of three sub-steps for a tenth of a second,
    // which suits strong rotors. More are slower and suit more bodies.
    let physics = Physics { calls: 5, substeps: 4, prediction: 0.05, ..ant::THESIS.physics };
    let task = AntMaze::with(&maze, |map| Body::new(&model, physics, 0.0, map))?;
    let mut task = TimeLimit::new(task, 1000);

    task.reset(0);
    let controls = task.spec().action.len();
    let mut seen = Vec::new();
    for step in 0..100 {
        // Three legs swing while the other three push; legs of the left side turn the other way.
        let action: Vec<f32> = (0..controls)
            .map(|i| {
                let (leg, side) = (i / 3, if i < controls / 2 { 1.0 } else { -1.0 });
                let phase = step as f32 + std::f32::consts::PI * (leg % 2) as f32;
                [side * (phase + 1.2).sin(), 0.5 + 0.5 * phase.cos(), 0.5][i % 3]
            })
            .collect();
        let outcome = task.step(&action)?;
        task.observe(&mut seen);
        if step % 20 == 19 || outcome.end.is_some() {
            println!(
                "after {} s at ({:.2}, {:.2}), {:.2} m high",
                0.1 * (step + 1) as f32,
                seen[0],
                seen[1],
                seen[2]
            );
        }
        if outcome.end.is_some() {
            break;
        }
    }
    Ok(())
}
