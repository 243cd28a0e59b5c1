//! What an experiment file can ask to be drawn.

use serde::{Deserialize, Serialize};

use super::{Metric, Quantity};

/// What curves are drawn over.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    /// Steps of the environment.
    #[default]
    Steps,
    /// Training episodes.
    Episodes,
}

/// Which options of an agent are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Options {
    /// All of them.
    #[default]
    All,
    /// Those that aim at the task's goal.
    Goal,
}

/// Of which runs of an arm there are pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Choice {
    /// Of the median one by the experiment's metric; of two in the middle, the lower one.
    #[default]
    Median,
    /// Of the first five.
    Each,
}

/// A picture. Those of many runs are one file, `FILE.png`, with a panel a domain; those of single runs are a file a
/// domain, `FILE-DOMAIN.png`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Draw {
    /// Curves with every seed: one column of panels a quantity, one row a domain; or, of one quantity, a panel a domain.
    Curves {
        /// The file.
        file: String,
        /// What is drawn.
        of: Vec<Quantity>,
        /// Over what.
        #[serde(default)]
        over: Axis,
        /// Over how many points each value is averaged with those before it.
        #[serde(default)]
        smoothing: usize,
    },
    /// A dot a seed, and their mean with its interval.
    Dots {
        /// The file.
        file: String,
        /// What is drawn; the experiment's metric when left out.
        metric: Option<Metric>,
    },
    /// Initiation sets on the map.
    Sets {
        /// The file.
        file: String,
        /// Only of these arms; all when left out.
        #[serde(default)]
        arms: Vec<String>,
        /// Which options.
        #[serde(default)]
        options: Options,
        /// Of which runs.
        #[serde(default)]
        runs: Choice,
        /// A feature of the observation by its name, and the values that it has: a row of pictures each.
        #[serde(default)]
        feature: String,
        /// The values.
        #[serde(default)]
        values: Vec<f32>,
    },
    /// Paths of frozen episodes on the map, coloured by the skill that acts. A file a domain and arm.
    Trajectories {
        /// The file.
        file: String,
        /// Only of these arms; all when left out.
        #[serde(default)]
        arms: Vec<String>,
        /// How many episodes.
        episodes: u64,
    },
}

impl Draw {
    /// The stem of its file.
    pub fn file(&self) -> &str {
        match self {
            Self::Curves { file, .. }
            | Self::Dots { file, .. }
            | Self::Sets { file, .. }
            | Self::Trajectories { file, .. } => file,
        }
    }
}
