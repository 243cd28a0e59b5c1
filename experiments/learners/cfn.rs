//! Novelty by networks: whether it counts, and whether one explores better with it than by chance.
//!
//! First on a known distribution: 64 states, visited 1, 4, 16, 64 or 256 times in some order. Then in `visual-grid` from
//! its pictures, without a reward: how many of its 1,764 cells are visited in 50,000 steps.

mod counting;
mod grid;

use serde::Serialize;

use crate::{
    Options,
    support::{Done, write},
};

/// All of it.
#[derive(Serialize)]
struct Found {
    command: String,
    counting: Vec<counting::Row>,
    grid: grid::Found,
}

pub(crate) fn run(options: &Options) -> Done {
    let seeds = options.seeds.unwrap_or(5);
    let command = format!("cargo run --release --example learners -- cfn --seeds {seeds}");
    let counting = counting::run(seeds);
    let grid = grid::run(options, seeds)?;
    write(options, "cfn", &Found { command, counting, grid })
}

pub(crate) fn tune(options: &Options) -> Done {
    grid::tune(options)
}
