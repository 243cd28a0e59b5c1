//! Doing runs: kept when they are done, taken up again where they were stopped.
//!
//! A run belongs to one process at a time by a lock of the system on a file beside it, which ends with the process. So
//! any number of processes may share a folder, with shards or without, and what one has left half done another goes on
//! with. Where a file system has no locks, shards alone keep processes apart.

use std::{
    fs::{self, File, TryLockError},
    io::ErrorKind,
    path::Path,
    process::Command,
    sync::{
        Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    thread,
};

use super::{Asked, EvidenceError, Plan, Shard, State};
use crate::{
    run::{Ended, Run, RunError, Summary},
    session::EpisodeMetrics,
};

/// What is told while runs are done.
#[derive(Debug)]
pub enum Told<'a> {
    /// A run begins or goes on, after so many episodes.
    Begins(&'a Asked, u64),
    /// An episode of it is over.
    Episode(&'a Asked, &'a EpisodeMetrics),
    /// It is done.
    Done(&'a Asked, &'a Summary),
    /// It was stopped, and its checkpoint is written.
    Interrupted(&'a Asked),
    /// Another process has it.
    Elsewhere(&'a Asked),
    /// It could not go on.
    Failed(&'a Asked, &'a RunError),
}

/// Does the runs of a plan.
pub struct Worker<'a> {
    /// The plan.
    pub plan: &'a Plan,
    /// Only this part of it.
    pub shard: Option<Shard>,
    /// Compute all anew.
    pub fresh: bool,
    /// How many runs at a time, each on one thread.
    pub jobs: usize,
    /// Set to stop; every run that is on its way writes a checkpoint.
    pub stop: &'a AtomicBool,
}

impl Worker<'_> {
    /// Does all runs that are not done; whether it was not stopped meanwhile.
    ///
    /// # Errors
    /// [`EvidenceError::Changed`] before anything is touched, when runs are there with other settings;
    /// [`EvidenceError::Stopped`] when some could not go on, after all others.
    pub fn work(&self, tell: &(dyn Fn(&Told<'_>) + Sync)) -> Result<bool, EvidenceError> {
        let mut runs = self.plan.part(self.shard);
        if !self.fresh {
            self.agree(&runs)?;
            runs.retain(|asked| State::of(asked) != State::Finished);
        }
        runs.reverse();
        let (left, failed) = (Mutex::new(runs), Mutex::new(Vec::new()));
        let next = || lock(&left).pop();
        let work = || {
            while let Some(asked) = next() {
                if self.stop.load(Ordering::Relaxed) {
                    return;
                }
                if let Err(why) = self.run(asked, tell) {
                    tell(&Told::Failed(asked, &why));
                    lock(&failed).push(format!("  {}: {why}", asked.name));
                }
            }
        };
        // A session is built in the thread that trains it, for not all of them can be sent to another.
        thread::scope(|scope| (0..self.jobs.max(1)).for_each(|_| _ = scope.spawn(work)));
        let failed = failed.into_inner().unwrap_or_else(PoisonError::into_inner);
        if !failed.is_empty() {
            return Err(EvidenceError::Stopped(failed));
        }
        Ok(!self.stop.load(Ordering::Relaxed))
    }

    fn agree(&self, runs: &[&Asked]) -> Result<(), EvidenceError> {
        let changed: Vec<_> = runs
            .iter()
            .filter_map(|asked| match State::of(asked) {
                State::Changed(what) => Some(format!("  {}: {what}", asked.path.display())),
                _ => None,
            })
            .collect();
        let path = self.plan.file.clone();
        if changed.is_empty() { Ok(()) } else { Err(EvidenceError::Changed { path, changed }) }
    }

    fn run(&self, asked: &Asked, tell: &(dyn Fn(&Told<'_>) + Sync)) -> Result<(), RunError> {
        let Some(_mine) = self.take(asked)? else {
            tell(&Told::Elsewhere(asked));
            return Ok(());
        };
        let mut run = match State::of(asked) {
            // Another process was quicker.
            State::Finished if !self.fresh => return Ok(()),
            State::Begun if !self.fresh => Run::resume(&asked.path, None)?,
            _ => begin(asked)?,
        };
        tell(&Told::Begins(asked, run.session.progress().0));
        match run.train(self.stop, |metrics| tell(&Told::Episode(asked, metrics)))? {
            Ended::Interrupted => tell(&Told::Interrupted(asked)),
            Ended::Complete => {
                let (summary, _) = run.summarise()?;
                run.folder.keep_newest()?;
                tell(&Told::Done(asked, &summary));
            }
        }
        Ok(())
    }

    /// Takes a run for this process, for as long as what comes back lives; none when another has it.
    fn take(&self, asked: &Asked) -> Result<Option<File>, RunError> {
        let folder = self.plan.folder.join(".locks");
        fs::create_dir_all(&folder).map_err(RunError::io("make", &folder))?;
        let path = folder.join(asked.name.replace('/', "+"));
        let file = File::create(&path).map_err(RunError::io("write", &path))?;
        match file.try_lock() {
            Ok(()) => Ok(Some(file)),
            Err(TryLockError::WouldBlock) => Ok(None),
            Err(TryLockError::Error(why)) if why.kind() == ErrorKind::Unsupported => Ok(Some(file)),
            Err(TryLockError::Error(why)) => Err(RunError::io("lock", &path)(why)),
        }
    }
}

/// Begins a run in the place of whatever is there.
fn begin(asked: &Asked) -> Result<Run, RunError> {
    if asked.path.exists() {
        fs::remove_dir_all(&asked.path).map_err(RunError::io("remove", &asked.path))?;
    }
    let run = Run::create(asked.config.clone(), &asked.path)?;
    let path = asked.path.join(COMMIT);
    fs::write(&path, commit() + "\n").map_err(RunError::io("write", &path))?;
    Ok(run)
}

/// The file in a run's folder that says which version of the code began it.
const COMMIT: &str = "commit";

/// The version of the code that began a run.
pub(super) fn begun_by(run: &Path) -> String {
    fs::read_to_string(run.join(COMMIT)).map_or_else(|_| "unknown".to_owned(), |text| text.trim().to_owned())
}

/// The version of the code: what `INROADS_COMMIT` says, as a container does, else what git says of this folder.
fn commit() -> String {
    let said = std::env::var("INROADS_COMMIT").ok().filter(|said| !said.is_empty());
    let git = || {
        let output =
            Command::new("git").args(["describe", "--always", "--dirty", "--exclude=*"]).output().ok()?;
        let text = String::from_utf8(output.stdout).ok()?.trim().to_owned();
        (output.status.success() && !text.is_empty()).then_some(text)
    };
    said.or_else(git).unwrap_or_else(|| "unknown".to_owned())
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
