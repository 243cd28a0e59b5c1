//! What can go wrong with a run.

use std::path::{Path, PathBuf};

use inroads_envs::Refused;

use crate::{config::ConfigError, session::Stopped};

/// What is wrong with a run, and how to mend it.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The configuration is at fault.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The environment refused an action of a film.
    #[error("the environment refused an action: {0}")]
    Refused(#[from] Refused),
    /// An episode of an evaluation could not go on.
    #[error("evaluation stopped in {0}")]
    Evaluation(#[from] Stopped),
    /// Training could not go on.
    #[error("training stopped in {stopped}. What was learned before that episode is saved: {file}")]
    Stopped {
        /// What happened, and when.
        stopped: Stopped,
        /// The checkpoint.
        file: PathBuf,
    },
    /// Training could not go on, nor be saved.
    #[error("training stopped in {stopped}. The episodes since the newest checkpoint are lost: {why}")]
    StoppedUnsaved {
        /// What happened, and when.
        stopped: Stopped,
        /// Why the end of the last whole episode could not be saved.
        why: Box<Self>,
    },
    /// An episode that was lived again went otherwise.
    #[error(
        "episode {episode}, lived again from {file}, was another one; an environment or an agent draws from elsewhere than \
         its seed"
    )]
    Unlike {
        /// The episode.
        episode: u64,
        /// The checkpoint before it.
        file: PathBuf,
    },
    /// A folder is in the way.
    #[error("{0} exists already and nothing in it was touched; choose another --out, or go on with --resume")]
    Exists(PathBuf),
    /// There is no such run.
    #[error("{0} is no run folder (it has no config.toml); give the folder that `train` wrote")]
    NoRun(PathBuf),
    /// Neither a run nor an environment.
    #[error(
        "{what} is no run folder and no environment; give the folder that `train` wrote, or a name from `inroads list` \
         (the nearest is `{nearest}`)"
    )]
    NothingToRender {
        /// What was asked for.
        what: String,
        /// The environment whose name is nearest.
        nearest: &'static str,
    },
    /// A run without any checkpoint.
    #[error("{0} has no checkpoint to go on from; begin again in another folder")]
    NoCheckpoint(PathBuf),
    /// A checkpoint that is damaged.
    #[error("checkpoint {file} is corrupt ({why}) and was refused; {}", offer(.intact.as_deref()))]
    Corrupt {
        /// The damaged file.
        file: PathBuf,
        /// What is wrong with it.
        why: String,
        /// An older checkpoint that is intact.
        intact: Option<PathBuf>,
    },
    /// A checkpoint that is intact, but of another agent or version.
    #[error("checkpoint {file} does not fit this run's configuration: {why}")]
    Foreign {
        /// The file.
        file: PathBuf,
        /// What does not fit.
        why: String,
    },
    /// A metrics file that has fewer episodes than the checkpoint.
    #[error(
        "{file} has {found} lines, but the checkpoint was written after {expected} episodes; restore the file"
    )]
    Short {
        /// The file.
        file: PathBuf,
        /// Lines that are there.
        found: u64,
        /// Lines that must be.
        expected: u64,
    },
    /// The system would not read or write a file.
    #[error("cannot {doing} {path}: {why}")]
    Io {
        /// What was tried.
        doing: &'static str,
        /// With which file.
        path: PathBuf,
        /// What the system says.
        why: std::io::Error,
    },
    /// There is no plan.
    #[error(transparent)]
    Plan(#[from] crate::session::PlanError),
    /// There are no goals to look at.
    #[error("agent `{0}` has neither goals nor a skill graph; its skills are in summary.json")]
    NoGoals(String),
    /// There is no skill to act with.
    #[error("this run's agent has no learned skill to act with; leave --chain-alone out")]
    NoSkills,
    /// There is no skill that could be called.
    #[error(
        "agent `{agent}` has no skill after {episodes} episodes that could be called from a place; agents that chain skills have \
         some once they have learned them (`inroads list` says which; --resume trains further)"
    )]
    NoCalls {
        /// The agent.
        agent: String,
        /// Episodes of training.
        episodes: u64,
    },
    /// An environment that cannot be drawn.
    #[error("`{0}` has no map to draw on")]
    NoMap(String),
    /// An experiment is at fault.
    #[error(transparent)]
    Evidence(#[from] crate::evidence::EvidenceError),
    /// A picture could not be drawn.
    #[error(transparent)]
    Figure(#[from] crate::figures::FigureError),
}

impl RunError {
    /// Wraps an error of the system with what was tried.
    pub(crate) fn io(doing: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.to_owned();
        move |why| Self::Io { doing, path, why }
    }
}

fn offer(intact: Option<&Path>) -> String {
    match intact {
        Some(path) => {
            format!("the one before it is intact: go on from it with --checkpoint {}", path.display())
        }
        None => "there is no intact one before it; begin again in another folder".to_owned(),
    }
}
