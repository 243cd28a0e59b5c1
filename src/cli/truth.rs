//! `inroads truth`: where each skill of a run really succeeds, beside where its initiation set says that it may start.

use std::path::PathBuf;

use indicatif::{ProgressBar, ProgressStyle};

use super::{Done, say::say, table::table};
use crate::{
    draw,
    run::Run,
    truth::{How, SkillTruth, Truth},
};

/// What `inroads truth` takes.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// A run's folder; its environment must be a maze
    run: PathBuf,
    /// Cells along the longer side of the maze
    #[arg(long, default_value_t = How::default().cells as u32, value_parser = clap::value_parser!(u32).range(1..=500))]
    cells: u32,
    /// Calls of each skill from each cell
    #[arg(long, default_value_t = How::default().times, value_parser = clap::value_parser!(u32).range(1..))]
    times: u32,
    /// Look at this checkpoint instead of the newest
    #[arg(long)]
    checkpoint: Option<PathBuf>,
}

pub(super) fn truth(arguments: &Arguments) -> Done {
    let run = Run::open(&arguments.run, arguments.checkpoint.as_deref())?;
    let how = How { cells: arguments.cells as usize, times: arguments.times };
    let bar = ProgressBar::no_length();
    let style = ProgressStyle::with_template("{bar:30.cyan/dim} {pos}/{len} cells  [{elapsed} < {eta}]");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    let truth = Truth::of(&*run.session, &run.config.settings, how, |done, all| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    })?;
    bar.finish_and_clear();
    truth.write(&run.folder.truth())?;
    let figure = run.folder.figures().join("truth.png");
    draw::truth(&run, &truth, &figure)?;
    report(&truth);
    eprintln!("every cell is in {}, the picture in {}", run.folder.truth().display(), figure.display());
    Ok(())
}

/// A row a skill.
fn report(truth: &Truth) {
    let Truth { agent, environment, seed, episodes, times, lattice, .. } = truth;
    let [w, h] = lattice.cell();
    say!(
        "{agent} in {environment}, seed {seed}, after {episodes} episodes: {times} calls from each cell of {w:.2} m × {h:.2} m"
    );
    let head = [
        "skill",
        "reaches",
        "may start",
        "aimed at",
        "succeeds",
        "inside",
        "precision",
        "recall",
        "balanced",
        "Brier",
    ];
    let head = head.map(str::to_owned).to_vec();
    table(std::iter::once(head).chain(truth.skills.iter().map(row)).collect());
    say!(
        "areas in m², where the subgoal does not hold yet; `succeeds`: at least half of the calls do; `inside`: mean success where \
         the skill may start; the rest judge that set, cell by cell"
    );
}

fn row(truth: &SkillTruth) -> Vec<String> {
    let SkillTruth { skill, score, .. } = truth;
    let area = |area: f64| format!("{area:.1}");
    let share = |share: Option<f64>| share.map_or_else(String::new, |share| format!("{share:.2}"));
    vec![
        skill.skill.to_string(),
        skill.enters.map_or_else(|| "the goal".to_owned(), |parent| format!("skill {parent}")),
        area(score.may_start),
        area(score.may_aim),
        area(score.succeeds),
        share(score.success_inside),
        share(score.precision),
        share(score.recall),
        share(score.balanced_accuracy),
        share(score.brier),
    ]
}
