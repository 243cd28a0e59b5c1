//! What some steps of an episode teach.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::Moment;

/// What a lesson teaches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Aim {
    /// The task itself, with the task's rewards and the episode's end.
    Task,
    /// A subgoal, attained at the last step or not at all; attaining it ends the lesson for good.
    Subgoal {
        /// Whether the last step attained it.
        attained: bool,
    },
}

/// Some steps of an episode as something to learn from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lesson<G = ()> {
    /// The episode's number.
    pub episode: u64,
    /// Its steps.
    pub steps: Range<u32>,
    /// What they teach.
    pub aim: Aim,
    /// The goal that the learner is to read with them. None for the task, and for a learner that has but one subgoal.
    pub goal: Option<G>,
    /// Rewards that replace the ones that follow from the aim, one a step (dense rewards).
    pub rewards: Option<Box<[f32]>>,
}

impl<G> Lesson<G> {
    /// One step of the task.
    pub fn task(episode: u64, step: u32) -> Self {
        Self { episode, steps: step..step + 1, aim: Aim::Task, goal: None, rewards: None }
    }

    /// The same for a learner that reads no goals.
    pub fn without_goal(self) -> Lesson {
        let Self { episode, steps, aim, rewards, .. } = self;
        Lesson { episode, steps, aim, goal: None, rewards }
    }

    /// The same for a learner that reads this goal.
    pub fn with_goal<H>(self, goal: H) -> Lesson<H> {
        let Self { episode, steps, aim, rewards, .. } = self;
        Lesson { episode, steps, aim, goal: Some(goal), rewards }
    }
}

/// What the steps of a lesson about a subgoal pay.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pay {
    /// A step that does not attain it.
    pub step: f32,
    /// The step that attains it.
    pub attained: f32,
}

impl Pay {
    /// −1 a step, 0 on success (chapter 3; `decisions.md`).
    pub const COST: Self = Self { step: -1.0, attained: 0.0 };
    /// 1 on success, 0 before: a value is the discounted probability of success (chapters 4 to 9).
    pub const ATTAINMENT: Self = Self { step: 0.0, attained: 1.0 };
}

/// Rewards of a clip, one an action that is learned from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rewards<'a> {
    /// The task's, or dense ones.
    Given(&'a [f32]),
    /// Those of a subgoal, which the clip's last action attains or none does.
    Subgoal(Pay, bool),
}

/// Σ γᵗ r over some steps, and γ to their number: the two coefficients of an n-step return, and of equation 3.3, whose
/// exponent counts the steps taken (`decisions.md`).
pub fn discounted(rewards: impl Iterator<Item = f32>, gamma: f32) -> (f32, f32) {
    rewards.fold((0.0, 1.0), |(sum, discount), r| (sum + discount * r, discount * gamma))
}

/// A step (or a few, or a sequence) to learn from, borrowed from the experience.
#[derive(Clone, Copy, Debug)]
pub struct Clip<'a, O, A, G> {
    /// Observations, one more than actions.
    pub observations: &'a [O],
    /// Actions taken.
    pub actions: &'a [A],
    /// What each of them paid, but for those of the [`lead`](Self::lead).
    pub rewards: Rewards<'a>,
    /// The goal to be read; none for the task.
    pub goal: Option<&'a G>,
    /// Whether the value of what follows is zero: the task terminated or the subgoal was attained. A
    /// truncation, and an option's time-out, are not this.
    pub terminal: bool,
    /// Where the first observation is to be found.
    pub at: Moment,
    /// The action before the first observation; none at the beginning of an episode.
    pub previous: Option<&'a A>,
    /// What whoever acted remembered before the first observation; empty: nothing.
    pub memory: &'a [f32],
    /// So many steps at the beginning are not learned from: they only bring a memory up to date (burn-in).
    pub lead: usize,
    /// What the clip's loss counts in its batch: 1, or less for what was drawn more often than it is there.
    pub weight: f32,
}

impl<'a, O, A, G> Clip<'a, O, A, G> {
    /// Steps that were drawn with the others' probability, by somebody who remembers nothing.
    pub fn new(
        observations: &'a [O],
        actions: &'a [A],
        rewards: Rewards<'a>,
        goal: Option<&'a G>,
        terminal: bool,
    ) -> Self {
        let (at, previous, memory, lead, weight) = ((0, 0), None, &[][..], 0, 1.0);
        Self { observations, actions, rewards, goal, terminal, at, previous, memory, lead, weight }
    }

    /// What action number `i` paid, counted from the first after the lead.
    pub fn reward(&self, i: usize) -> f32 {
        match self.rewards {
            Rewards::Given(rewards) => rewards[i],
            Rewards::Subgoal(pay, attained) if attained && i + 1 == self.len() => pay.attained,
            Rewards::Subgoal(pay, _) => pay.step,
        }
    }

    /// Steps to learn from.
    pub fn len(&self) -> usize {
        self.actions.len() - self.lead
    }

    /// Whether there is none, as in no clip from a replay.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Σ γᵗ r over the clip, and the discount of the value of its last observation: 0 when it is terminal.
    pub fn discounted(&self, gamma: f32) -> (f32, f32) {
        let (sum, discount) = discounted((0..self.len()).map(|i| self.reward(i)), gamma);
        (sum, if self.terminal { 0.0 } else { discount })
    }

    /// The first observation that is learned from.
    pub fn first(&self) -> &'a O {
        &self.observations[self.lead]
    }

    /// The observation after the last action.
    ///
    /// # Panics
    /// When the clip is empty, which none from a replay is.
    pub fn last(&self) -> &'a O {
        self.observations.last().expect("a clip has an observation more than actions")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn returns_discount_by_the_steps_taken() {
        let of = |rewards: &[f32], gamma| discounted(rewards.iter().copied(), gamma);
        // Equation 3.3, and a return of three steps (algorithms.md 14, SMDP 1 and DQN 3).
        let (reward, discount) = of(&[-1.0, -1.0, -1.0], 0.9);
        assert!((reward + discount * -5.0 - -6.355).abs() < 1e-6);
        let (reward, discount) = of(&[0.0, 0.0, 1.0], 0.9);
        assert!((reward + discount * 2.0 - 2.268).abs() < 1e-6);
        assert_eq!(of(&[], 0.9), (0.0, 1.0));
    }
}
