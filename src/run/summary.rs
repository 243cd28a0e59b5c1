//! `summary.json`: what a run came to.

use std::fs;

use inroads_discovery::record::{GoalRecord, GoalState};
use serde::{Deserialize, Serialize};

use super::{Run, RunError};
use crate::{
    draw::View,
    figures::Raster,
    session::{Protocol, Watched},
};

/// What a run came to. Success in training and frozen success are separate columns.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// The agent's name.
    pub agent: String,
    /// The environment's name.
    pub environment: String,
    /// The run's seed.
    pub seed: u64,
    /// The backend's name.
    pub backend: String,
    /// Training episodes.
    pub episodes: u64,
    /// Steps of the environment in them.
    pub env_steps: u64,
    /// Minibatch updates in them, over all networks.
    pub updates: u64,
    /// Seconds of training, over all sessions.
    pub wall_seconds: f64,
    /// Whether anything but 0 was ever paid, in training or in the frozen episodes. Where nothing was, because the world
    /// has no task or nobody came so far, shares of successes tell nothing.
    pub paid: bool,
    /// Share of successes in the last 50 training episodes (or in all, when there are fewer).
    pub success_last_50: f64,
    /// Frozen, noise-free episodes that each of the following comes from.
    pub eval_episodes: u64,
    /// Share of successes.
    pub eval_success: f64,
    /// Median steps of the successful ones; none when there are none.
    pub eval_median_steps: Option<f64>,
    /// The same by start, where episodes begin at more than one place.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub eval_by_start: Vec<StartSummary>,
    /// Mean share of steps that learned skills took.
    pub eval_skill_share: f64,
    /// Share of successes without primitive actions wherever a learned skill may start; none without skills.
    pub chain_success: Option<f64>,
    /// Median steps of those successes.
    pub chain_median_steps: Option<f64>,
    /// Number of learned skills.
    pub skills: usize,
    /// Of the evaluation's start states, the share that a learned initiation set covers.
    pub starts_covered: f64,
    /// The learned skills.
    pub sets: Vec<SetSummary>,
    /// The skill graph; none where the agent makes none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub graph: Option<GraphSummary>,
    /// The goal space; none where the agent has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub goals: Option<GoalSummary>,
}

/// How large a skill graph is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct GraphSummary {
    /// Vertices.
    pub vertices: usize,
    /// Edges that plans may use.
    pub edges: usize,
}

/// How far a goal space is; each number counts those of the next one too.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct GoalSummary {
    /// Goals that were observed.
    pub seen: usize,
    /// Goals that may be pursued.
    pub plausible: usize,
    /// Goals that are mastered.
    pub mastered: usize,
}

impl GoalSummary {
    fn of(goals: &[GoalRecord]) -> Self {
        let from = |state| goals.iter().filter(|goal| goal.state >= state).count();
        Self {
            seen: from(GoalState::Pruned),
            plausible: from(GoalState::Plausible),
            mastered: from(GoalState::Mastered),
        }
    }
}

/// Frozen episodes that began at one place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StartSummary {
    /// The place, but for noise; metres.
    pub start: [f64; 2],
    /// How many there were.
    pub episodes: u64,
    /// Share of successes.
    pub success: f64,
    /// Median steps of the successful ones; none when there are none.
    pub median_steps: Option<f64>,
}

/// Where one skill was in control, in the frozen episodes: its stretches of consecutive steps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stretches {
    /// How many there were.
    pub count: usize,
    /// Mean of where they began, in the dimensions that say where one is (`Spec::place`).
    pub began: Vec<f64>,
    /// Mean of where they ended: of a skill's successes that is its effect set. Of a dimension that is 0 or 1, such as
    /// `has_key`, the share of ones.
    pub ended: Vec<f64>,
}

/// One learned skill.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SetSummary {
    /// What the agent tells of it.
    #[serde(flatten)]
    pub skill: inroads_discovery::SkillRecord,
    /// Its initiation set's share of the free space; none where there is no map.
    pub area: Option<f64>,
    /// The same where the key is held; none where there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub area_with_key: Option<f64>,
    /// Share of both sets together that is in both of them; none where there is no key.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub overlap: Option<f64>,
    /// What it did in the frozen episodes; none where it did nothing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stretches: Option<Stretches>,
}

impl Run {
    /// Evaluates the agent and writes `summary.json`; the frozen episodes come back for pictures.
    ///
    /// # Errors
    /// [`RunError`] when the file cannot be written or the environment refused an action.
    pub fn summarise(&mut self) -> Result<(Summary, Vec<Watched>), RunError> {
        let (summary, frozen) = self.evaluation()?;
        let path = self.folder.summary();
        let text = serde_json::to_string_pretty(&summary).expect("plain data always encodes");
        fs::write(&path, text + "\n").map_err(RunError::io("write", &path))?;
        Ok((summary, frozen))
    }

    /// Evaluates the agent; nothing is written.
    ///
    /// # Errors
    /// [`RunError`] when a log cannot be read or the environment refused an action.
    pub fn evaluation(&mut self) -> Result<(Summary, Vec<Watched>), RunError> {
        let metrics = self.folder.read_metrics()?;
        let n = self.config.settings.evaluation_episodes;
        let frozen = self.evaluate(Protocol::Frozen, n)?;
        let alone = self.evaluate(Protocol::ChainAlone, n)?;
        let last = &metrics[metrics.len().saturating_sub(50)..];
        let (episodes, env_steps) = self.session.progress();
        let goals = self.session.goals();
        let starts = View::of(&self.config.settings).map(|view| view.map.starts).unwrap_or_default();
        let settings = &self.config.settings;
        let summary = Summary {
            agent: settings.agent.clone(),
            environment: settings.environment.clone(),
            seed: settings.seed,
            backend: settings.backend.to_string(),
            episodes,
            env_steps,
            updates: metrics.last().map_or(0, |m| m.updates.values().sum()),
            wall_seconds: self.folder.seconds()?,
            paid: metrics.iter().any(|m| m.reward != 0.0 || m.success)
                || frozen.iter().any(|w| w.summary.reward != 0.0 || w.summary.success),
            success_last_50: share(last.iter().map(|m| m.success)),
            eval_episodes: n,
            eval_success: share(frozen.iter().map(|w| w.summary.success)),
            eval_median_steps: median_steps(&frozen),
            eval_by_start: if starts.len() > 1 { by_start(&starts, &frozen) } else { Vec::new() },
            eval_skill_share: mean(frozen.iter().map(Watched::skill_share)),
            chain_success: (!alone.is_empty()).then(|| share(alone.iter().map(|w| w.summary.success))),
            chain_median_steps: median_steps(&alone),
            skills: self.session.skills().len(),
            starts_covered: share(frozen.iter().map(|w| w.covered)),
            sets: self.sets(&frozen),
            graph: self
                .session
                .graph()
                .map(|graph| GraphSummary { vertices: graph.vertices.len(), edges: graph.edges.len() }),
            goals: (!goals.is_empty()).then(|| GoalSummary::of(&goals)),
        };
        Ok((summary, frozen))
    }

    /// Watches `n` frozen episodes; none when the agent has nothing to act with under that protocol.
    ///
    /// # Errors
    /// [`RunError::Evaluation`] when an episode could not go on.
    pub fn evaluate(&mut self, protocol: Protocol, n: u64) -> Result<Vec<Watched>, RunError> {
        (0..n)
            .filter_map(|index| self.session.evaluate(protocol, index).transpose())
            .collect::<Result<_, _>>()
            .map_err(RunError::from)
    }

    fn sets(&self, frozen: &[Watched]) -> Vec<SetSummary> {
        let view = View::of(&self.config.settings);
        let (without, with) =
            view.as_ref().map(|view| (view.sets(self), view.sets_with_key(self))).unwrap_or_default();
        let area = |raster: &Raster| view.as_ref().map(|view| raster.share_of_free_space(&view.map));
        let skills = self.session.skills().into_iter().enumerate();
        skills
            .map(|(i, skill)| SetSummary {
                area: without.get(i).and_then(area),
                area_with_key: with.get(i).and_then(area),
                overlap: without.get(i).zip(with.get(i)).map(|(a, b)| a.overlap(b)),
                stretches: stretches(frozen, skill.skill as usize, &self.session.spec().place),
                skill,
            })
            .collect()
    }
}

/// The episodes by start: each belongs to the place that it began nearest to.
pub(super) fn by_start(starts: &[[f32; 2]], frozen: &[Watched]) -> Vec<StartSummary> {
    let nearest = |watched: &Watched| {
        let first = watched.path.first()?;
        let far = |i: &usize| (starts[*i][0] - first[0]).hypot(starts[*i][1] - first[1]);
        (0..starts.len()).min_by(|a, b| far(a).total_cmp(&far(b)))
    };
    let of = |i: usize| {
        let there: Vec<_> = frozen.iter().filter(|watched| nearest(watched) == Some(i)).cloned().collect();
        StartSummary {
            start: starts[i].map(f64::from),
            episodes: there.len() as u64,
            success: share(there.iter().map(|w| w.summary.success)),
            median_steps: median_steps(&there),
        }
    };
    (0..starts.len()).map(of).collect()
}

/// What a skill did in some episodes.
pub(super) fn stretches(watched: &[Watched], skill: usize, place: &[usize]) -> Option<Stretches> {
    let mut found: Vec<(&[f32], &[f32])> = Vec::new();
    for w in watched.iter().filter(|w| w.path.len() > w.skills.len()) {
        let mut step = 0;
        for stretch in w.skills.chunk_by(|a, b| a == b) {
            let end = step + stretch.len();
            if stretch[0] == skill {
                found.push((&w.path[step], &w.path[end]));
            }
            step = end;
        }
    }
    let (began, ended): (Vec<_>, Vec<_>) = found.into_iter().unzip();
    let middle = |of: &[&[f32]]| place.iter().map(|&d| mean(of.iter().map(|s| f64::from(s[d])))).collect();
    (!began.is_empty()).then(|| Stretches {
        count: began.len(),
        began: middle(&began),
        ended: middle(&ended),
    })
}

fn share(of: impl Iterator<Item = bool>) -> f64 {
    mean(of.map(|yes| if yes { 1.0 } else { 0.0 }))
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, n) = values.fold((0.0, 0.0), |(sum, n), x| (sum + x, n + 1.0));
    if n == 0.0 { 0.0 } else { sum / n }
}

fn median_steps(watched: &[Watched]) -> Option<f64> {
    let mut steps: Vec<_> =
        watched.iter().filter(|w| w.summary.success).map(|w| f64::from(w.summary.steps)).collect();
    steps.sort_by(f64::total_cmp);
    let middle = steps.len() / 2;
    match steps.len() {
        0 => None,
        n if n % 2 == 1 => Some(steps[middle]),
        _ => Some(f64::midpoint(steps[middle - 1], steps[middle])),
    }
}
