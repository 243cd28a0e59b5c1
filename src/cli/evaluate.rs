//! `inroads evaluate`, and the table at the end of a training.

use std::path::Path;

use super::{Done, say::say};
use crate::run::{Run, Summary};

/// Skills that are told one by one.
const SKILLS: usize = 25;

pub(super) fn evaluate(path: &Path, episodes: Option<u64>, checkpoint: Option<&Path>) -> Done {
    let mut run = Run::open(path, checkpoint)?;
    if let Some(episodes) = episodes {
        run.config.settings.evaluation_episodes = episodes;
    }
    report(&run.evaluation()?.0);
    Ok(())
}

/// Prints what a run came to.
pub(super) fn report(summary: &Summary) {
    let percent = |share: f64| format!("{:.0} %", 100.0 * share);
    let steps = |steps: Option<f64>| steps.map_or_else(|| "-".into(), |steps| format!("{steps:.0}"));
    say!(
        "{} in {}, seed {}: {} episodes, {} steps, {:.0} s",
        summary.agent,
        summary.environment,
        summary.seed,
        summary.episodes,
        summary.env_steps,
        summary.wall_seconds
    );
    if summary.paid {
        say!("  training success, last 50 episodes   {}", percent(summary.success_last_50));
        say!(
            "  frozen success, {} episodes          {}   median steps {}   by skills {}",
            summary.eval_episodes,
            percent(summary.eval_success),
            steps(summary.eval_median_steps),
            percent(summary.eval_skill_share)
        );
    } else {
        say!("  nothing was paid in any episode, so there is no success to tell of");
    }
    if let Some(chain) = summary.chain_success.filter(|_| summary.paid) {
        say!(
            "  the chain alone                      {}   median steps {}",
            percent(chain),
            steps(summary.chain_median_steps)
        );
    }
    if let Some(graph) = &summary.graph {
        say!("  skill graph                          {} vertices, {} edges", graph.vertices, graph.edges);
    }
    if let Some(goals) = &summary.goals {
        say!(
            "  goals                                {} seen, {} plausible, {} mastered",
            goals.seen,
            goals.plausible,
            goals.mastered
        );
    }
    if summary.graph.is_some() {
        // A skill a vertex, of which there may be hundreds: `inroads goals` tells of those.
        return;
    }
    for set in summary.sets.iter().take(SKILLS) {
        let skill = &set.skill;
        let target = skill.enters.map_or_else(|| "the goal".to_owned(), |k| format!("skill {k}"));
        let area =
            set.area.map_or_else(String::new, |area| format!(", covers {} of free space", percent(area)));
        say!(
            "  skill {} reaches {target}: {} of {} executions{area}",
            skill.skill,
            skill.successes,
            skill.executions
        );
    }
    if let Some(more) = summary.sets.len().checked_sub(SKILLS + 1) {
        say!("  and {} more, in summary.json", more + 1);
    }
}
