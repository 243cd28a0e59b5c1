//! What is kept of a skill beside its initiation set and its policy.

use inroads_agents::Experience;
use serde::{Deserialize, Serialize};

use crate::Subgoal;

/// An observation of the experience: its episode and how many steps came before it.
pub type Moment = (u64, u32);

/// The observation of a moment that is still remembered.
pub(crate) fn observation<O, A>(all: &Experience<O, A>, (episode, step): Moment) -> Option<&O> {
    all.episode(episode)?.observations.get(step as usize)
}

/// How far a skill's initiation set is learned (3.1.3).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Phase {
    /// Its initiation period: executions still change the set.
    Refining,
    /// The set is fixed, and a salient event that another skill may aim at.
    Fixed,
    /// The set may be aimed at, and executions go on changing it (chapters 4 and 5).
    Mature,
}

/// One skill's row.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Skill {
    /// Where it ends.
    pub subgoal: Subgoal,
    /// How far its set is learned.
    pub phase: Phase,
    /// The training episode in which it was created.
    pub born: u64,
    /// Times it was executed.
    pub executions: u64,
    /// Times it reached its subgoal.
    pub successes: u64,
    /// Training episodes in which it was executed, while refining.
    pub episodes: u32,
    /// The last of them.
    pub last_episode: Option<u64>,
    /// Effect set β̂: where its newest successful executions entered its subgoal.
    pub effects: Vec<Moment>,
    /// The newest positive examples of its initiation set: states that it is known to succeed from.
    pub positives: Vec<Moment>,
}

/// Effects that are remembered: the authors keep the last 20.
const EFFECTS: usize = 20;

/// Positive examples that subgoals are drawn from: those of about ten executions with the authors' segments of 20.
const POSITIVES: usize = 200;

/// Adds to a list that forgets the oldest.
fn remember(list: &mut Vec<Moment>, new: &[Moment], capacity: usize) {
    list.extend_from_slice(new);
    list.drain(..list.len().saturating_sub(capacity));
}

impl Skill {
    pub(crate) fn new(subgoal: Subgoal, phase: Phase, born: u64) -> Self {
        Self {
            subgoal,
            phase,
            born,
            executions: 0,
            successes: 0,
            episodes: 0,
            last_episode: None,
            effects: Vec::new(),
            positives: Vec::new(),
        }
    }

    /// Counts one execution, in `episode`, that entered the subgoal at `entered` or failed.
    pub(crate) fn executed(&mut self, episode: u64, entered: Option<Moment>) {
        self.executions += 1;
        if self.last_episode != Some(episode) {
            self.last_episode = Some(episode);
            self.episodes += 1;
        }
        if let Some(entered) = entered {
            self.successes += 1;
            self.affected(&[entered]);
        }
    }

    /// Remembers where its subgoal was entered.
    pub(super) fn affected(&mut self, entered: &[Moment]) {
        remember(&mut self.effects, entered, EFFECTS);
    }

    /// Remembers states that it is known to succeed from.
    pub(super) fn succeeds_from(&mut self, moments: &[Moment]) {
        remember(&mut self.positives, moments, POSITIVES);
    }
}
