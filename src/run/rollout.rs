//! Frozen tests while a run trains: a line of `tests.jsonl` each time (thesis 3.2.1, 4.2.4).

use inroads_discovery::{SkillRecord, chain::metrics::chaining_probability};
use serde::{Deserialize, Serialize};

use super::{Run, RunError};
use crate::session::{Protocol, Watched};

/// Number of the first evaluation episode that is a test: those before it are the summary's.
const FIRST: u64 = 1 << 32;

/// What the agent was worth after so many training episodes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TestMetrics {
    /// Training episodes up to then.
    pub episodes: u64,
    /// Steps of the environment in them.
    pub env_steps: u64,
    /// The frozen episodes, none of which is ever the same as another.
    pub rollouts: Vec<Rollout>,
    /// The learned skills.
    pub skills: Vec<Tried>,
    /// Chaining probability (equation 4.2); none while no skill has been executed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chain: Option<f64>,
}

/// One frozen episode.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rollout {
    /// Whether the task was done.
    pub success: bool,
    /// Its steps.
    pub steps: u32,
    /// Sum of its rewards.
    #[serde(rename = "return")]
    pub reward: f32,
}

/// How often a skill was executed in training, and with what success.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Tried {
    /// Its number, from 1.
    pub skill: u32,
    /// The skill whose set it enters; none when it aims at the task's goal.
    pub enters: Option<u32>,
    /// Times it was executed.
    pub executions: u64,
    /// Times it reached its subgoal.
    pub successes: u64,
}

impl From<&Watched> for Rollout {
    fn from(Watched { summary, .. }: &Watched) -> Self {
        Self { success: summary.success, steps: summary.steps, reward: summary.reward }
    }
}

impl From<&SkillRecord> for Tried {
    fn from(record: &SkillRecord) -> Self {
        let SkillRecord { skill, enters, executions, successes, .. } = *record;
        Self { skill, enters, executions, successes }
    }
}

impl TestMetrics {
    /// Share of the rollouts that did the task.
    pub fn success(&self) -> f64 {
        let done = self.rollouts.iter().filter(|rollout| rollout.success).count();
        done as f64 / self.rollouts.len().max(1) as f64
    }
}

impl Run {
    /// Rolls the tests out that the episodes since `before` have made due, and logs them.
    pub(super) fn test(&mut self, before: u64) -> Result<(), RunError> {
        let (episodes, env_steps) = self.session.progress();
        let settings = &self.config.settings;
        let (every, each) = (settings.test_every, settings.test_episodes);
        if every == 0 || episodes / every == before / every {
            return Ok(());
        }
        let first = FIRST + episodes / every * each;
        let mut rollouts = Vec::new();
        for index in first..first + each {
            let watched = self.session.evaluate(Protocol::Frozen, index)?;
            rollouts.extend(watched.as_ref().map(Rollout::from));
        }
        let skills = self.session.skills();
        let chain = chaining_probability(&skills);
        let skills = skills.iter().map(Tried::from).collect();
        self.folder.append_tests(&TestMetrics { episodes, env_steps, rollouts, skills, chain })
    }
}
