//! The folder of a run and the files in it.

use std::{
    fs::{self, OpenOptions},
    io::{BufRead, BufReader, Write},
    path::{Path, PathBuf},
};

use inroads_agents::Bag;
use serde::{Serialize, de::DeserializeOwned};
use serde_json::json;

use super::{Growth, RunError, Summary, TestMetrics, checkpoint};
use crate::{config::Config, session::EpisodeMetrics};

/// A run's folder.
#[derive(Clone, Debug)]
pub struct Folder {
    path: PathBuf,
}

impl Folder {
    /// Makes the folder and writes its `config.toml`.
    pub(super) fn create(path: &Path, config: &Config) -> Result<Self, RunError> {
        if path.exists() {
            return Err(RunError::Exists(path.to_owned()));
        }
        let folder = Self { path: path.to_owned() };
        for part in [folder.checkpoints(), folder.figures()] {
            fs::create_dir_all(&part).map_err(RunError::io("make", &part))?;
        }
        folder.write_config(config)?;
        for file in [folder.metrics(), folder.timings()] {
            fs::write(&file, "").map_err(RunError::io("write", &file))?;
        }
        Ok(folder)
    }

    pub(super) fn write_config(&self, config: &Config) -> Result<(), RunError> {
        fs::write(self.config(), config.to_toml()).map_err(RunError::io("write", &self.config()))
    }

    /// The folder of a run that there is.
    ///
    /// # Errors
    /// [`RunError::NoRun`] when there is none.
    pub fn open(path: &Path) -> Result<Self, RunError> {
        let folder = Self { path: path.to_owned() };
        if folder.config().is_file() { Ok(folder) } else { Err(RunError::NoRun(path.to_owned())) }
    }

    /// The folder itself.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Every value of the configuration.
    pub fn config(&self) -> PathBuf {
        self.path.join("config.toml")
    }

    /// A line an episode, the same for the same seed.
    pub fn metrics(&self) -> PathBuf {
        self.path.join("metrics.jsonl")
    }

    /// A line an episode, with times.
    pub fn timings(&self) -> PathBuf {
        self.path.join("timings.jsonl")
    }

    /// A line each time that somebody trained the run: which episodes, how many steps, how long.
    pub fn sessions(&self) -> PathBuf {
        self.path.join("sessions.jsonl")
    }

    /// The goal space after 1, 2, … 9, 10, 20, … episodes, a line each; not there while the agent has no goals.
    pub fn goals(&self) -> PathBuf {
        self.path.join("goals.jsonl")
    }

    /// Frozen tests while it trained, a line each time; not there before the first.
    pub fn tests(&self) -> PathBuf {
        self.path.join("tests.jsonl")
    }

    /// The pictures.
    pub fn figures(&self) -> PathBuf {
        self.path.join("figures")
    }

    /// Where its skills succeed, beside where their sets say so; not there until somebody asks.
    pub fn truth(&self) -> PathBuf {
        self.path.join("truth.json")
    }

    /// What the run came to.
    pub fn summary(&self) -> PathBuf {
        self.path.join("summary.json")
    }

    /// The checkpoints.
    pub fn checkpoints(&self) -> PathBuf {
        self.path.join("checkpoints")
    }

    pub(super) fn write_checkpoint(&self, episode: u64, bag: &Bag) -> Result<(), RunError> {
        checkpoint::write(&self.checkpoints(), episode, bag)
    }

    /// The named checkpoint, or the newest. A corrupt one is refused, and an intact one before it offered.
    pub(super) fn checkpoint(&self, named: Option<&Path>) -> Result<(PathBuf, Bag), RunError> {
        let all = checkpoint::list(&self.checkpoints())?;
        let newest = || all.last().cloned().ok_or_else(|| RunError::NoCheckpoint(self.path.clone()));
        let file = named.map_or_else(newest, |named| Ok(named.to_owned()))?;
        match checkpoint::read(&file) {
            Ok(bag) => Ok((file, bag)),
            Err(why) => {
                let others = all.into_iter().rev().filter(|other| *other != file);
                let intact = others.into_iter().find(|other| checkpoint::read(other).is_ok());
                Err(RunError::Corrupt { file, why, intact })
            }
        }
    }

    /// Writes an episode's line into both logs.
    pub(super) fn append(&self, metrics: &EpisodeMetrics, seconds: f64) -> Result<(), RunError> {
        append(&self.metrics(), metrics)?;
        let rate = f64::from(metrics.steps) / seconds.max(1e-9);
        let timing = json!({ "episode": metrics.episode, "seconds": seconds, "steps_per_second": rate });
        append(&self.timings(), &timing)
    }

    /// Writes a line of the goal space's growth.
    pub(super) fn append_goals(&self, growth: &Growth) -> Result<(), RunError> {
        append(&self.goals(), growth)
    }

    /// Writes a line about frozen tests.
    pub(super) fn append_tests(&self, tests: &TestMetrics) -> Result<(), RunError> {
        append(&self.tests(), tests)
    }

    /// What frozen tests came to; nothing where none was asked for.
    ///
    /// # Errors
    /// [`RunError::Io`] when the file cannot be read or a line is not ours.
    pub fn read_tests(&self) -> Result<Vec<TestMetrics>, RunError> {
        if self.tests().exists() { read_lines(&self.tests()) } else { Ok(Vec::new()) }
    }

    /// How the goal space grew; nothing where the agent has no goals.
    ///
    /// # Errors
    /// [`RunError::Io`] when the file cannot be read or a line is not ours.
    pub fn read_goals(&self) -> Result<Vec<Growth>, RunError> {
        if self.goals().exists() { read_lines(&self.goals()) } else { Ok(Vec::new()) }
    }

    /// Logs one call of the training loop.
    pub(super) fn log_session(
        &self,
        first: u64,
        episodes: u64,
        steps: u64,
        seconds: f64,
    ) -> Result<(), RunError> {
        let line =
            json!({ "first_episode": first, "episodes": episodes, "steps": steps, "seconds": seconds });
        append(&self.sessions(), &line)
    }

    /// Drops all lines of the logs that were written after the first `episodes`.
    pub(super) fn rewind(&self, episodes: u64) -> Result<(), RunError> {
        drop_after::<Growth>(&self.goals(), |line| line.episodes <= episodes)?;
        drop_after::<TestMetrics>(&self.tests(), |line| line.episodes <= episodes)?;
        for file in [self.metrics(), self.timings()] {
            let text = fs::read_to_string(&file).map_err(RunError::io("read", &file))?;
            // A killed run may have left half a line; `lines` counts it, and it is among those dropped.
            let kept: Vec<_> = text.split_inclusive('\n').take(episodes as usize).collect();
            let found = kept.iter().filter(|line| line.ends_with('\n')).count() as u64;
            if found < episodes {
                return Err(RunError::Short { file, found, expected: episodes });
            }
            rewrite(&file, &kept.concat())?;
        }
        Ok(())
    }

    /// All lines of `metrics.jsonl`.
    ///
    /// # Errors
    /// [`RunError::Io`] when the file cannot be read or a line is not ours.
    pub fn read_metrics(&self) -> Result<Vec<EpisodeMetrics>, RunError> {
        read_lines(&self.metrics())
    }

    /// What the run came to.
    ///
    /// # Errors
    /// [`RunError::Io`] when it is not done, or the file is not ours.
    pub fn read_summary(&self) -> Result<Summary, RunError> {
        let text = fs::read_to_string(self.summary()).map_err(RunError::io("read", &self.summary()))?;
        serde_json::from_str(&text).map_err(|why| RunError::io("read", &self.summary())(why.into()))
    }

    /// Removes all checkpoints but the newest: a run that is done goes back nowhere.
    pub(crate) fn keep_newest(&self) -> Result<(), RunError> {
        checkpoint::keep_newest(&self.checkpoints())
    }

    /// Seconds of training, over all sessions.
    pub(super) fn seconds(&self) -> Result<f64, RunError> {
        let sessions: Vec<serde_json::Value> = read_lines(&self.sessions())?;
        Ok(sessions.iter().filter_map(|s| s["seconds"].as_f64()).sum())
    }
}

/// Drops the lines of a log, if it exists, that are not `kept`, and half a line that a killed run may have left.
fn drop_after<T: DeserializeOwned>(file: &Path, kept: impl Fn(&T) -> bool) -> Result<(), RunError> {
    if !file.exists() {
        return Ok(());
    }
    let text = fs::read_to_string(file).map_err(RunError::io("read", file))?;
    let whole = |line: &&str| serde_json::from_str::<T>(line).is_ok_and(|line| kept(&line));
    rewrite(file, &text.split_inclusive('\n').filter(whole).collect::<String>())
}

/// Puts a text in the place of a file's, which is never half written.
fn rewrite(file: &Path, text: &str) -> Result<(), RunError> {
    let beside = file.with_extension("part");
    fs::write(&beside, text).map_err(RunError::io("write", &beside))?;
    fs::rename(&beside, file).map_err(RunError::io("write", file))
}

fn append(path: &Path, line: &impl Serialize) -> Result<(), RunError> {
    let mut text = serde_json::to_string(line).expect("plain data always encodes");
    text.push('\n');
    OpenOptions::new()
        .create(true)
        .append(true)
        .open(path)
        .and_then(|mut file| file.write_all(text.as_bytes()))
        .map_err(RunError::io("write", path))
}

fn read_lines<T: DeserializeOwned>(path: &Path) -> Result<Vec<T>, RunError> {
    let file = fs::File::open(path).map_err(RunError::io("read", path))?;
    BufReader::new(file)
        .lines()
        .map(|line| Ok(serde_json::from_str(&line?)?))
        .collect::<std::io::Result<_>>()
        .map_err(RunError::io("read", path))
}
