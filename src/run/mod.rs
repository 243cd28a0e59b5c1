//! A run: training with its folder, stopped and resumed without a difference.
//!
//! A run folder holds `config.toml` (every value), `metrics.jsonl` (a line an episode, without times),
//! `timings.jsonl` (a line an episode, with them), `sessions.jsonl` (a line each time somebody ran it), for agents that
//! have goals `goals.jsonl` (their states now and then), where tests are asked for `tests.jsonl`, `checkpoints/`, `figures/` and, when it is done, `summary.json`.

mod checkpoint;
mod error;
mod folder;
mod growth;
mod rollout;
mod stopped;
mod summary;

pub use error::RunError;
pub use folder::Folder;
pub use growth::Growth;
pub use rollout::{Rollout, TestMetrics, Tried};
pub use summary::{GoalSummary, GraphSummary, SetSummary, Summary};

use std::{
    path::Path,
    sync::atomic::{AtomicBool, Ordering},
    time::Instant,
};

use crate::{
    config::{Config, ConfigError},
    session::{self, EpisodeMetrics, Session},
};

/// A session with its folder.
pub struct Run {
    /// The configuration.
    pub config: Config,
    /// The folder.
    pub folder: Folder,
    /// The agent in its environment.
    pub session: Box<dyn Session>,
}

/// How a call of [`Run::train`] ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// All episodes are done.
    Complete,
    /// Somebody asked to stop; a checkpoint is written.
    Interrupted,
}

impl Run {
    /// Begins a run in a new folder.
    ///
    /// # Errors
    /// [`RunError`] when the folder exists already or cannot be made; nothing is overwritten.
    pub fn create(config: Config, path: &Path) -> Result<Self, RunError> {
        let session = session::build(&config)?;
        let folder = Folder::create(path, &config)?;
        Ok(Self { config, folder, session })
    }

    /// Takes a run up where its newest checkpoint left it, or the named one. Lines that were written after that
    /// checkpoint are dropped, and newer checkpoints: the same episodes will write them again.
    ///
    /// # Errors
    /// [`RunError`] names what is missing or corrupt, and which checkpoint is intact.
    pub fn resume(path: &Path, checkpoint: Option<&Path>) -> Result<Self, RunError> {
        let run = Self::open(path, checkpoint)?;
        let (episodes, _) = run.session.progress();
        run.folder.rewind(episodes)?;
        checkpoint::remove_after(&run.folder.checkpoints(), episodes)?;
        Ok(run)
    }

    /// Changes how long the run trains, in its folder too.
    ///
    /// # Errors
    /// [`RunError::Config`] when anything else differs.
    pub fn lengthen(&mut self, longer: &Config) -> Result<(), RunError> {
        let mut same = longer.clone();
        same.settings.episodes = self.config.settings.episodes;
        same.settings.max_steps = self.config.settings.max_steps;
        if same != self.config {
            let why = "a run goes on as it was begun: only episodes and max_steps may change".to_owned();
            return Err(ConfigError::Impossible { table: "the resumed run".into(), why }.into());
        }
        self.folder.write_config(longer)?;
        self.config = longer.clone();
        Ok(())
    }

    /// Opens a run for looking at it: nothing is written.
    ///
    /// # Errors
    /// As [`resume`](Self::resume).
    pub fn open(path: &Path, checkpoint: Option<&Path>) -> Result<Self, RunError> {
        let folder = Folder::open(path)?;
        let config = Config::read(&folder.config())?;
        let mut session = session::build(&config)?;
        let (file, bag) = folder.checkpoint(checkpoint)?;
        session.load(&bag).map_err(|why| RunError::Foreign { file, why: why.to_string() })?;
        Ok(Self { config, folder, session })
    }

    /// Trains until the configuration's end, or until `stop` is set; `watch` sees each episode.
    ///
    /// # Errors
    /// [`RunError`] when a file cannot be written. [`RunError::Stopped`] when an action was refused, or an observation, a
    /// reward or a loss is no finite number: what was learned up to the end of the last whole episode is saved then, and
    /// the run stands there.
    pub fn train(
        &mut self,
        stop: &AtomicBool,
        mut watch: impl FnMut(&EpisodeMetrics),
    ) -> Result<Ended, RunError> {
        let (first_episode, first_step) = self.session.progress();
        let began = Instant::now();
        let mut saved = first_episode;
        if first_episode == 0 {
            // Whatever happens to the first episodes, there is something to begin again from.
            self.save()?;
        }
        let mut fault = None;
        let ended = loop {
            if self.done() {
                break Ended::Complete;
            }
            if stop.load(Ordering::Relaxed) {
                break Ended::Interrupted;
            }
            let round_began = Instant::now();
            let round = match self.session.train() {
                Ok(round) => round,
                Err(stopped) => {
                    fault = Some(self.stopped(stopped));
                    saved = self.session.progress().0;
                    break Ended::Interrupted;
                }
            };
            let steps: u32 = round.iter().map(|metrics| metrics.steps).sum();
            let pace = round_began.elapsed().as_secs_f64() / f64::from(steps);
            for metrics in &round {
                self.folder.append(metrics, pace * f64::from(metrics.steps))?;
                watch(metrics);
            }
            self.test(self.session.progress().0 - round.len() as u64)?;
            self.log_goals()?;
            if self.session.progress().0 - saved >= self.config.settings.checkpoint_every {
                saved = self.save()?;
            }
        };
        let (episodes, steps) = self.session.progress();
        if saved < episodes {
            self.save()?;
        }
        let seconds = began.elapsed().as_secs_f64();
        self.folder.log_session(first_episode, episodes - first_episode, steps - first_step, seconds)?;
        fault.map_or(Ok(ended), Err)
    }

    fn done(&self) -> bool {
        let (episodes, steps) = self.session.progress();
        let settings = &self.config.settings;
        episodes >= settings.episodes || (settings.max_steps > 0 && steps >= settings.max_steps)
    }

    fn log_goals(&self) -> Result<(), RunError> {
        let (episodes, _) = self.session.progress();
        if !Growth::due(episodes) {
            return Ok(());
        }
        match self.session.goals() {
            goals if goals.is_empty() => Ok(()),
            goals => self.folder.append_goals(&Growth::of(episodes, goals)),
        }
    }

    fn save(&self) -> Result<u64, RunError> {
        let (episodes, _) = self.session.progress();
        self.folder.write_checkpoint(episodes, &self.session.save())?;
        Ok(episodes)
    }
}

#[cfg(test)]
mod tests;
