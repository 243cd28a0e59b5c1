//! An ant that walks by rhythm alone, filmed: what the simulator does without anyone who learns.
//!
//! `cargo run --release --example walking_ant` writes `walking-ant.gif`.

use std::f32::consts::TAU;

use inroads::{
    envs::registry,
    figures,
    film::{Play, View, film},
    session::Action,
};

/// Of each actuator: amplitude, phase (radians) and mean of its torque, as a share of the greatest. Found by random
/// search for the way along the first corridor.
const RHYTHM: [[f32; 3]; 8] = [
    [0.91, 1.04, -0.09],
    [0.82, 4.71, -0.01],
    [1.33, -0.13, 0.02],
    [0.81, 1.59, -0.20],
    [0.83, 2.43, -0.38],
    [0.95, 1.08, 0.15],
    [1.04, 3.24, 0.24],
    [0.82, 4.24, 0.01],
];

/// The torques of a control step: one cycle takes ten of them, a second.
fn torques(step: u16) -> Action {
    let swing =
        |[amplitude, phase, mean]: [f32; 3]| mean + amplitude * (TAU * f32::from(step) / 10.0 + phase).sin();
    Action::Vector(RHYTHM.map(|joint| swing(joint).clamp(-1.0, 1.0)).to_vec())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let quick = std::env::args().any(|argument| argument == "--quick");
    let steps = if quick { 3 } else { 110 };
    let ant = registry::make("ant-u-maze")?;
    let frames = film(ant, 0, &Play::Actions((0..steps).map(torques).collect()), View::Beside, 240)?;
    let frames: Vec<_> = frames.into_iter().step_by(2).collect();
    let path = if quick { std::env::temp_dir().join("walking-ant.gif") } else { "walking-ant.gif".into() };
    figures::film(&path, &frames, 20)?;
    eprintln!("drew {}", path.display());
    Ok(())
}
