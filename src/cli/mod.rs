//! The command line. Arguments are parsed here; each command is a file.

mod certify;
mod claims;
mod evaluate;
mod goals;
mod list;
mod plan;
mod play;
mod plot;
mod progress;
mod render;
mod reproduce;
mod say;
mod table;
mod train;
mod truth;
mod world;

use std::{path::PathBuf, process::ExitCode};

use clap::{Parser, Subcommand};

use crate::run::RunError;

/// Skill discovery in pure Rust: train agents, look at the skills they find.
#[derive(Debug, Parser)]
#[command(name = "inroads", version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Show the agents and environments that there are
    List,
    /// Train an agent in an environment, then draw what it learned
    Train(train::Arguments),
    /// Evaluate a run's agent, frozen and without noise
    Evaluate {
        /// A run's folder
        run: PathBuf,
        /// Episodes (default: as the run's configuration has it)
        #[arg(long)]
        episodes: Option<u64>,
        /// Look at this checkpoint instead of the newest
        #[arg(long)]
        checkpoint: Option<PathBuf>,
    },
    /// Show the goals of a run's agent, or the vertices of its skill graph
    Goals {
        /// A run's folder
        run: PathBuf,
        /// Look at this checkpoint instead of the newest
        #[arg(long)]
        checkpoint: Option<PathBuf>,
    },
    /// Plan on a run's skill graph, and act the plan out
    Plan(plan::Arguments),
    /// Draw the figures of one run, or the learning curves of several together
    Plot {
        /// Runs' folders
        #[arg(required = true)]
        runs: Vec<PathBuf>,
        /// Where to draw several runs' curves
        #[arg(long, default_value = "curves.png")]
        out: PathBuf,
    },
    /// Draw one frozen episode of a run, or random actions in an environment
    Render(render::Arguments),
    /// Play in the terminal
    Play(play::Arguments),
    /// Make a figure of the thesis: do the runs that are not done, draw it, and say what it shows of the claims
    Reproduce(reproduce::Arguments),
    /// Show all claims with their verdicts, and what they cost
    Claims {
        /// The folder with a folder a figure
        #[arg(long, default_value = reproduce::RESULTS)]
        results: PathBuf,
    },
    /// Call each skill of a run from everywhere: where it succeeds, beside where its initiation set says that it may start
    Truth(truth::Arguments),
    /// Find an environment's shortest solution, and how often random actions succeed
    Certify(certify::Arguments),
}

/// Burn on one thread, unless `RAYON_NUM_THREADS` says otherwise. The products of such small networks are slower on
/// two (1.6 ms an update against 1.35), and the second core can train another seed. Results do not depend on it.
fn one_thread() {
    if std::env::var_os("RAYON_NUM_THREADS").is_none() {
        // Fails only where a pool is there already, which then stays.
        let _pool = rayon::ThreadPoolBuilder::new().num_threads(1).build_global();
    }
}

/// Runs the command line: exit code 0, or 2 when something was wrong and nothing was overwritten.
pub fn main() -> ExitCode {
    one_thread();
    let done = match Arguments::parse().command {
        Command::List => {
            list::list();
            Ok(())
        }
        Command::Train(arguments) => train::train(&arguments),
        Command::Evaluate { run, episodes, checkpoint } => {
            evaluate::evaluate(&run, episodes, checkpoint.as_deref())
        }
        Command::Goals { run, checkpoint } => goals::goals(&run, checkpoint.as_deref()),
        Command::Plan(arguments) => plan::plan(&arguments),
        Command::Plot { runs, out } => plot::plot(&runs, &out),
        Command::Render(arguments) => render::render(&arguments),
        Command::Play(arguments) => play::play(&arguments),
        Command::Reproduce(arguments) => reproduce::reproduce(&arguments),
        Command::Claims { results } => claims::claims(&results),
        Command::Truth(arguments) => truth::truth(&arguments),
        Command::Certify(arguments) => certify::certify(&arguments),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("inroads: {error}");
            ExitCode::from(2)
        }
    }
}

type Done = Result<(), RunError>;
