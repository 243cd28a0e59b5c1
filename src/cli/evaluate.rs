//! `inroads evaluate`, and the table at the end of a training.

use std::path::Path;

use super::Done;
use crate::run::{Run, Summary};

pub(super) fn evaluate(path: &Path, episodes: Option<u64>, checkpoint: Option<&Path>) -> Done {
    let mut run = Run::open(path, checkpoint)?;
    if let Some(episodes) = episodes {
        run.config.settings.evaluation_episodes = episodes;
    }
    report(&run.evaluation()?.0);
    Ok(())
}

/// Prints what a run came to.
#[allow(clippy::print_stdout)] // what the command is for
pub(super) fn report(summary: &Summary) {
    let percent = |share: f64| format!("{:.0} %", 100.0 * share);
    let steps = |steps: Option<f64>| steps.map_or_else(|| "-".into(), |steps| format!("{steps:.0}"));
    println!(
        "{} in {}, seed {}: {} episodes, {} steps, {:.0} s",
        summary.agent,
        summary.environment,
        summary.seed,
        summary.episodes,
        summary.env_steps,
        summary.wall_seconds
    );
    println!("  training success, last 50 episodes   {}", percent(summary.success_last_50));
    println!(
        "  frozen success, {} episodes          {}   median steps {}   by skills {}",
        summary.eval_episodes,
        percent(summary.eval_success),
        steps(summary.eval_median_steps),
        percent(summary.eval_skill_share)
    );
    if let Some(chain) = summary.chain_success {
        println!(
            "  the chain alone                      {}   median steps {}",
            percent(chain),
            steps(summary.chain_median_steps)
        );
    }
    for set in &summary.sets {
        let skill = &set.skill;
        let target = skill.enters.map_or_else(|| "the goal".to_owned(), |k| format!("skill {k}"));
        let area =
            set.area.map_or_else(String::new, |area| format!(", covers {} of free space", percent(area)));
        println!(
            "  skill {} reaches {target}: {} of {} executions{area}",
            skill.skill, skill.successes, skill.executions
        );
    }
}
