//! What an option policy can learn from a stretch of experience, whoever acted in it.

use std::ops::Range;

use inroads_agents::{
    Lesson,
    experience::{Aim, Episode},
};

use super::{OptionReward, repertoire::Repertoire};
use crate::{Initiation, Subgoal, hindsight::stretches};

impl<O: AsRef<[f32]> + Clone, A, I: Initiation<O, A>> Repertoire<O, A, I> {
    /// The lessons about a subgoal in some steps of episode `number`.
    pub(super) fn lessons(
        &self,
        subgoal: Subgoal,
        number: u64,
        episode: &Episode<O, A>,
        steps: Range<u32>,
        reward: OptionReward,
    ) -> Vec<Lesson> {
        let inside = |step: usize| self.inside(subgoal, &episode.observations[step]);
        let attained = |step| self.attained_by(subgoal, episode, step);
        let dense = |steps: &Range<u32>| {
            let afters = &episode.observations[steps.start as usize + 1..=steps.end as usize];
            afters.iter().map(|after| -self.distance(subgoal, after)).collect()
        };
        let lesson = |(steps, attained): (Range<u32>, bool)| Lesson {
            episode: number,
            rewards: match reward {
                OptionReward::Sparse => None,
                OptionReward::Dense => Some(dense(&steps)),
            },
            steps,
            aim: Aim::Subgoal { attained },
            goal: None,
        };
        stretches(steps, inside, attained).into_iter().map(lesson).collect()
    }
}

/// The same lesson for a policy that could read goals, and is told none.
pub(super) fn about<G>(lesson: Lesson) -> Lesson<G> {
    let Lesson { episode, steps, aim, rewards, goal: _ } = lesson;
    Lesson { episode, steps, aim, goal: None, rewards }
}
