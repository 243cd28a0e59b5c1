//! What can go wrong with an experiment.

use std::path::PathBuf;

use crate::config::ConfigError;

/// What is wrong with an experiment, and how to mend it.
#[derive(Debug, thiserror::Error)]
pub enum EvidenceError {
    /// There is no such figure.
    #[error(
        "there is no figure `{name}`: {path} is missing. There are: {others}. Or name a file that ends in .toml"
    )]
    NoFigure {
        /// What was asked for.
        name: String,
        /// Where it would be.
        path: PathBuf,
        /// The figures that there are.
        others: String,
    },
    /// An experiment file cannot be used.
    #[error("{path}: {why}")]
    File {
        /// The file.
        path: PathBuf,
        /// The key, what is wrong with it, and the mend.
        why: String,
    },
    /// The settings of an arm in a domain cannot be.
    #[error("{path}: arm `{arm}` in domain `{domain}`: {why}")]
    Settings {
        /// The file.
        path: PathBuf,
        /// The arm.
        arm: String,
        /// The domain.
        domain: String,
        /// What is wrong.
        why: Box<ConfigError>,
    },
    /// Runs are there that the file does not ask for any more.
    #[error(
        "{} there with other settings than {path} asks for now; nothing was touched. Take them back, or compute them anew \
         with --fresh:\n{}", runs(.changed.len()), .changed.join("\n")
    )]
    Changed {
        /// The file.
        path: PathBuf,
        /// A line a run: its folder, and what differs.
        changed: Vec<String>,
    },
    /// Some runs stopped, the others were done.
    #[error("{} not done:\n{}", runs(.0.len()), .0.join("\n"))]
    Stopped(Vec<String>),
    /// A shard that cannot be.
    #[error("`{0}` is no shard; write I/N with I from 0 to N - 1, such as 0/4")]
    Shard(String),
    /// No claims.
    #[error("no figure's JSON lies in {0}; make one with `inroads reproduce FIGURE`")]
    NoClaims(PathBuf),
}

fn runs(count: usize) -> String {
    if count == 1 { "1 run is".to_owned() } else { format!("{count} runs are") }
}
