//! `inroads reproduce`.

use std::{
    path::{Path, PathBuf},
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
};

use super::{Done, progress::Progress, say::say};
use crate::evidence::{self, Plan, Record, Shard, Told, Wanted, Worker};

/// Where the figures that claims rest on lie.
pub(super) const RESULTS: &str = "docs/results";

/// What `inroads reproduce` takes.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The figure, such as 4.3 (experiments/fig-4-3.toml), or an experiment file
    figure: String,
    /// Only its first so many seeds
    #[arg(long)]
    seeds: Option<u64>,
    /// Multiply all budgets by this, to try the figure out; what is not 1 lies elsewhere and makes no claim
    #[arg(long, default_value_t = 1.0)]
    scale: f64,
    /// Compute runs anew that are done already
    #[arg(long)]
    fresh: bool,
    /// Only say what it costs and what is done; write nothing
    #[arg(long)]
    dry_run: bool,
    /// Do only every N-th run from the I-th on, I from 0, and draw nothing: 0/4 to 3/4 together are all of it
    #[arg(long, value_name = "I/N", conflicts_with = "draw")]
    shard: Option<Shard>,
    /// Do no run, only draw what is done
    #[arg(long, conflicts_with = "fresh")]
    draw: bool,
    /// How many runs at a time, each on one thread
    #[arg(long, default_value_t = 1)]
    jobs: usize,
    /// The folder of runs
    #[arg(long, default_value = "runs")]
    runs: PathBuf,
    /// Where to draw (default: docs/results/FIGURE; with --scale beside the runs)
    #[arg(long)]
    out: Option<PathBuf>,
}

pub(super) fn reproduce(arguments: &Arguments) -> Done {
    let file = evidence::find(&arguments.figure)?;
    let wanted = Wanted { seeds: arguments.seeds, scale: arguments.scale, runs: arguments.runs.clone() };
    let plan = Plan::read(&file, &wanted)?;
    if arguments.dry_run {
        say!("figure {}: {}\n{}", plan.experiment.figure, plan.experiment.title, evidence::price(&plan));
        return Ok(());
    }
    let done = if arguments.draw { Ok(true) } else { work(&plan, arguments) };
    if let Ok(false) = done {
        eprintln!(
            "stopped and saved; the same command{} goes on",
            if arguments.fresh { " without --fresh" } else { "" }
        );
        return Ok(());
    }
    if arguments.shard.is_none() && !matches!(done, Err(evidence::EvidenceError::Changed { .. })) {
        // What could not go on is missing in the picture, which says so.
        let default = || match plan.scale {
            1.0 => Path::new(RESULTS).join(&plan.experiment.figure),
            _ => plan.figure.clone(),
        };
        let out = arguments.out.clone().unwrap_or_else(default);
        report(&evidence::draw(&plan, &out, &command(arguments))?, &out);
    }
    done?;
    Ok(())
}

/// How the figure is made anew.
fn command(arguments: &Arguments) -> String {
    let seeds = arguments.seeds.map_or_else(String::new, |seeds| format!(" --seeds {seeds}"));
    let scale = if arguments.scale == 1.0 { String::new() } else { format!(" --scale {}", arguments.scale) };
    format!("inroads reproduce {}{seeds}{scale}", arguments.figure)
}

fn work(plan: &Plan, arguments: &Arguments) -> Result<bool, evidence::EvidenceError> {
    let stop = Arc::new(AtomicBool::new(false));
    let asked = Arc::clone(&stop);
    // Without a handler Ctrl-C ends the process, and the newest checkpoints stand: no reason not to begin.
    let _handled = ctrlc::set_handler(move || asked.store(true, Ordering::Relaxed));
    let &Arguments { shard, fresh, jobs, .. } = arguments;
    // A bar for each would be a muddle.
    let bar = (jobs == 1).then(|| Mutex::new(None));
    let worker = Worker { plan, shard, fresh, jobs, stop: &stop };
    worker.work(&|told| tell(told, bar.as_ref()))
}

fn tell(told: &Told<'_>, bar: Option<&Mutex<Option<Progress>>>) {
    let bar = |then: &dyn Fn(&mut Option<Progress>)| {
        if let Some(bar) = bar {
            then(&mut bar.lock().unwrap_or_else(PoisonError::into_inner));
        }
    };
    let end = || bar(&|bar| bar.take().map_or((), Progress::finish));
    match told {
        Told::Begins(asked, episodes) => {
            eprintln!(
                "{}: {}",
                asked.name,
                if *episodes == 0 { "begins".into() } else { format!("goes on after {episodes} episodes") }
            );
            bar(&|bar| *bar = Some(Progress::new(&asked.config.settings, *episodes)));
        }
        Told::Episode(_, metrics) => bar(&|bar| {
            if let Some(bar) = bar {
                bar.show(metrics);
            }
        }),
        Told::Done(asked, summary) => {
            end();
            eprintln!(
                "{}: {} episodes, {} steps, {:.0} s, frozen success {:.0} %",
                asked.name,
                summary.episodes,
                summary.env_steps,
                summary.wall_seconds,
                100.0 * summary.eval_success
            );
        }
        Told::Interrupted(asked) => {
            end();
            eprintln!("{}: stopped and saved", asked.name);
        }
        Told::Elsewhere(asked) => eprintln!("{}: another process does it", asked.name),
        Told::Failed(asked, why) => {
            end();
            eprintln!("{}: {why}", asked.name);
        }
    }
}

/// Prints what the figure shows.
fn report(record: &Record, out: &Path) {
    say!("figure {}: {}", record.figure, record.title);
    for arm in &record.arms {
        say!(
            "  {} in {}: {} runs, {} steps, {:.3} core-hours, {:.3} ms a step",
            arm.arm,
            arm.domain,
            arm.runs,
            arm.steps,
            arm.core_hours,
            arm.ms_per_step
        );
    }
    for claim in &record.claims {
        let verdict = format!("{:?}", claim.verdict).to_lowercase();
        let interval = claim.estimate.map_or_else(|| "-".to_owned(), |estimate| format!("{estimate:.2}"));
        let (counted, of) = claim.seeds;
        say!("  {verdict}: {} ({})", claim.claim, claim.domain);
        say!("    {} = {interval}, {counted} of {of} seeds, {}", claim.estimated, claim.metric);
    }
    if !record.missing.is_empty() {
        say!("  not done yet: {}", record.missing.join(", "));
    }
    eprintln!("figure and numbers are in {}", out.display());
}
