//! What a person sees while a run trains.

use std::{collections::VecDeque, time::Instant};

use indicatif::{ProgressBar, ProgressStyle};

use crate::{config::Settings, session::EpisodeMetrics};

/// Episodes over which the shown success rate is taken.
const WINDOW: usize = 50;

/// A progress bar on standard error; silent where that is no terminal.
pub(super) struct Progress {
    bar: ProgressBar,
    recent: VecDeque<bool>,
    began: Instant,
    steps: u64,
}

impl Progress {
    pub(super) fn new(settings: &Settings, done: u64) -> Self {
        let bar = ProgressBar::new(settings.episodes).with_position(done);
        let style = ProgressStyle::with_template(
            "{prefix} {bar:30.cyan/dim} {pos}/{len} episodes  {msg}  [{elapsed} < {eta}]",
        );
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        bar.set_prefix(format!("{} {}", settings.agent, settings.environment));
        Self { bar, recent: VecDeque::new(), began: Instant::now(), steps: 0 }
    }

    pub(super) fn show(&mut self, metrics: &EpisodeMetrics) {
        self.steps += u64::from(metrics.steps);
        self.recent.push_back(metrics.success);
        if self.recent.len() > WINDOW {
            self.recent.pop_front();
        }
        let success = self.recent.iter().filter(|s| **s).count() as f64 / self.recent.len() as f64;
        let rate = self.steps as f64 / self.began.elapsed().as_secs_f64().max(1e-9);
        self.bar.set_message(format!(
            "success {:3.0} % (last {})  skills {}  {rate:.0} steps/s",
            100.0 * success,
            self.recent.len(),
            metrics.skills,
        ));
        self.bar.set_position(metrics.episode + 1);
        if let Some(fault) = &metrics.fault {
            self.bar.suspend(|| eprintln!("episode {}: truncated, for {fault}", metrics.episode));
        }
    }

    pub(super) fn finish(self) {
        self.bar.finish();
    }
}
