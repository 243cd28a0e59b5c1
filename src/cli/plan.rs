//! `inroads plan`: the way from one place to another on a run's skill graph, and whether it holds.

use std::path::PathBuf;

use inroads_discovery::record::{PlanRecord, Query};

use super::{Done, say::say};
use crate::{
    run::Run,
    session::{Spot, Travelled},
    statistics::{median, wilson},
};

/// What `inroads plan` takes.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// A run's folder
    run: PathBuf,
    /// Where the plan begins: `start`, `goal`, a vertex's number, or coordinates such as 2.5,4 (a single one ends with a
    /// comma)
    #[arg(long, default_value = "start", allow_hyphen_values = true)]
    from: Spot,
    /// Where it ends, in the same words; needed where the task has no goal region, as in rooms, nine-cells or point-umaze:
    /// `--to 3` or `--to 2,2`; `inroads goals RUN` lists the vertices
    #[arg(long, default_value = "goal", allow_hyphen_values = true)]
    to: Spot,
    /// Act it out, frozen and without noise; every episode begins at the start, and first goes to where the plan begins
    #[arg(long)]
    execute: bool,
    /// With --execute: how many episodes
    #[arg(long, default_value_t = 1, requires = "execute", value_parser = clap::value_parser!(u64).range(1..))]
    times: u64,
    /// Look at this checkpoint instead of the newest
    #[arg(long)]
    checkpoint: Option<PathBuf>,
}

pub(super) fn plan(arguments: &Arguments) -> Done {
    let Arguments { from, to, .. } = arguments;
    let mut run = Run::open(&arguments.run, arguments.checkpoint.as_deref())?;
    let plan = run.session.plan(from, to)?;
    show(from, to, &plan);
    if arguments.execute {
        let travelled: Vec<_> = (0..arguments.times)
            .map(|index| run.session.travel(from, to, index))
            .collect::<Result<_, _>>()?;
        report(from, to, &plan, &travelled);
    }
    Ok(())
}

fn show(from: &Spot, to: &Spot, plan: &PlanRecord) {
    let case = match plan.case {
        Query::Inside => "both lie in the graph",
        Query::GoalOutside => "the end lies outside the graph: a skill goes on from the last vertex",
        Query::StartOutside => "the beginning lies outside the graph: a skill goes to the first vertex",
    };
    say!("from {from} to {to}: {case}");
    for (vertex, probability) in &plan.legs {
        say!("  vertex {vertex:<6} {probability:.2}");
    }
    say!("predicted success   {:.2}", plan.probability());
}

/// Realised success beside predicted; from where the plan begins, which has to be reached first.
fn report(from: &Spot, to: &Spot, plan: &PlanRecord, travelled: &[Travelled]) {
    let departed = travelled.iter().filter(|journey| journey.departed.is_some()).count();
    let steps: Vec<f64> = travelled
        .iter()
        .filter_map(|journey| Some(f64::from(journey.arrived?) - f64::from(journey.departed?)))
        .collect();
    if departed < travelled.len() {
        say!("was at {from} in {departed} of {} episodes", travelled.len());
    }
    let Some(steps_of_half) = median(&steps) else {
        say!("realised success    0 of {departed}; predicted {:.2}", plan.probability());
        return;
    };
    let share = wilson(steps.len() as u64, departed as u64);
    say!("realised success    {share}, {} of {departed}; predicted {:.2}", steps.len(), plan.probability());
    say!("was at {to} after   {steps_of_half:.0} steps (median)");
}
