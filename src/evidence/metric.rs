//! What is drawn and compared, read from a run's logs.

use serde::{Deserialize, Serialize};

use crate::run::{Folder, RunError, Summary, TestMetrics};

/// Options from which on a run counts for the chaining probability (figure 4.3): before the third one, the product has a
/// term or two, and says little of a chain.
const CHAIN: usize = 3;

/// What is measured along a run, or at its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// The return of a training episode, exploration included.
    Return,
    /// Whether a training episode succeeded.
    Success,
    /// Mean return of a frozen test's rollouts.
    TestReturn,
    /// Share of a frozen test's rollouts that succeeded.
    TestSuccess,
    /// Mean steps of a frozen test's rollouts; a failure has as many as it was given. Fewer are better.
    TestSteps,
    /// Chaining probability (equation 4.2), from the third option on.
    Chain,
    /// Learned options.
    Options,
    /// At the end: the share of free space that the initiation sets of options for the task's goal cover, in the mean.
    GoalArea,
    /// At the end: share of successes of frozen episodes.
    FinalSuccess,
    /// At the end: the same by learned options alone wherever one may start.
    FinalChain,
}

/// How a run is told in one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Metric {
    /// The mean of what.
    pub of: Quantity,
    /// Only of the last so many values; of all when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub last: Option<usize>,
}

/// A value along a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Training episodes up to then.
    pub episodes: u64,
    /// Steps of the environment in them.
    pub steps: u64,
    /// The value.
    pub value: f64,
}

impl Quantity {
    /// What stands at an axis.
    pub(super) fn label(self) -> &'static str {
        match self {
            Self::Return => "return of training episodes",
            Self::Success => "success in training",
            Self::TestReturn => "return of frozen tests",
            Self::TestSuccess => "success of frozen tests",
            Self::TestSteps => "steps of frozen tests",
            Self::Chain => "chaining probability",
            Self::Options => "learned options",
            Self::GoalArea => "share of free space in the goal option's set",
            Self::FinalSuccess => "frozen success at the end",
            Self::FinalChain => "success of the chain alone at the end",
        }
    }

    /// Whether it is a share between 0 and 1.
    pub(super) fn is_share(self) -> bool {
        !matches!(self, Self::Return | Self::TestReturn | Self::TestSteps | Self::Options)
    }

    /// Whether less of it is better.
    pub(super) fn is_cost(self) -> bool {
        self == Self::TestSteps
    }

    /// Its values along a finished run; nothing where the run has none.
    ///
    /// # Errors
    /// [`RunError::Io`] when a log cannot be read.
    pub fn along(self, folder: &Folder) -> Result<Vec<Point>, RunError> {
        match self {
            Self::Return => trained(folder, |m| f64::from(m.reward)),
            Self::Success => trained(folder, |m| if m.success { 1.0 } else { 0.0 }),
            Self::TestReturn => tested(folder, |t| mean(t.rollouts.iter().map(|r| f64::from(r.reward)))),
            Self::TestSuccess => tested(folder, |t| (!t.rollouts.is_empty()).then(|| t.success())),
            Self::TestSteps => tested(folder, |t| mean(t.rollouts.iter().map(|r| f64::from(r.steps)))),
            Self::Chain => tested(folder, |t| t.chain.filter(|_| t.skills.len() >= CHAIN)),
            Self::Options => tested(folder, |t| Some(t.skills.len() as f64)),
            Self::GoalArea => ended(folder, |s| {
                mean(s.sets.iter().filter(|set| set.skill.enters.is_none()).filter_map(|set| set.area))
            }),
            Self::FinalSuccess => ended(folder, |s| Some(s.eval_success)),
            Self::FinalChain => ended(folder, |s| s.chain_success),
        }
    }
}

impl Metric {
    /// The number of a finished run; none where it has none, as a run whose chain never had three options.
    ///
    /// # Errors
    /// [`RunError::Io`] when a log cannot be read.
    pub fn of(self, folder: &Folder) -> Result<Option<f64>, RunError> {
        let points = self.of.along(folder)?;
        let from = points.len().saturating_sub(self.last.unwrap_or(points.len()));
        Ok(mean(points[from..].iter().map(|point| point.value)))
    }

    /// In words.
    pub(super) fn words(self) -> String {
        match self.last {
            None => format!("mean of {}", self.of.label()),
            Some(1) => format!("last of {}", self.of.label()),
            Some(last) => format!("mean of the last {last} of {}", self.of.label()),
        }
    }
}

fn trained(
    folder: &Folder,
    value: impl Fn(&crate::session::EpisodeMetrics) -> f64,
) -> Result<Vec<Point>, RunError> {
    let metrics = folder.read_metrics()?;
    let point = |m: &_| value(m);
    Ok(metrics
        .iter()
        .map(|m| Point { episodes: m.episode + 1, steps: m.env_steps, value: point(m) })
        .collect())
}

fn tested(folder: &Folder, value: impl Fn(&TestMetrics) -> Option<f64>) -> Result<Vec<Point>, RunError> {
    let tests = folder.read_tests()?;
    let point = |t: &TestMetrics| Some(Point { episodes: t.episodes, steps: t.env_steps, value: value(t)? });
    Ok(tests.iter().filter_map(point).collect())
}

fn ended(folder: &Folder, value: impl Fn(&Summary) -> Option<f64>) -> Result<Vec<Point>, RunError> {
    let summary = folder.read_summary()?;
    let point = |value| Point { episodes: summary.episodes, steps: summary.env_steps, value };
    Ok(value(&summary).map(point).into_iter().collect())
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    (count > 0.0).then(|| sum / count)
}
