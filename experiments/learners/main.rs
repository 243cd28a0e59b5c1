//! The evidence for the learners: each experiment prints a table and writes `docs/results/learners/NAME.json`.
//!
//! ```text
//! cargo run --release --example learners -- NAME [--seeds N] [--out FOLDER]
//! ```

#![allow(clippy::print_stdout)] // what the command is for

mod cfn;
mod dqn;
mod mpc;
mod r2d2_frames;
mod recall;
#[path = "../support.rs"]
mod support;
mod td3_ant;
mod td3_reacher;

use std::{path::PathBuf, process::ExitCode};

use clap::Parser;

/// What runs an experiment.
type Experiment = fn(&Options) -> support::Done;

/// Experiments by name.
const EXPERIMENTS: &[(&str, Experiment)] = &[
    ("cfn", cfn::run),
    ("cfn-tuning", cfn::tune),
    ("dqn", dqn::run),
    ("mpc", mpc::run),
    ("mpc-walk", mpc::walk),
    ("r2d2-frames", r2d2_frames::run),
    ("recall", recall::run),
    ("td3-ant", td3_ant::run),
    ("td3-reacher", td3_reacher::run),
];

/// Runs one experiment, or all of them.
#[derive(Debug, Parser)]
struct Options {
    /// Which; `all` for all of them
    name: String,
    /// Seeds an agent (default: what the experiment has)
    #[arg(long)]
    seeds: Option<u64>,
    /// Where results are written
    #[arg(long, default_value = "docs/results/learners")]
    out: PathBuf,
}

fn main() -> ExitCode {
    let options = Options::parse();
    let chosen: Vec<_> =
        EXPERIMENTS.iter().filter(|(name, _)| options.name == "all" || *name == options.name).collect();
    if chosen.is_empty() {
        let names: Vec<_> = EXPERIMENTS.iter().map(|(name, _)| *name).collect();
        eprintln!("there is no experiment `{}`; there are: all, {}", options.name, names.join(", "));
        return ExitCode::from(2);
    }
    for (name, run) in chosen {
        println!("== {name}");
        if let Err(error) = run(&options) {
            eprintln!("{name}: {error}");
            return ExitCode::from(2);
        }
    }
    ExitCode::SUCCESS
}
