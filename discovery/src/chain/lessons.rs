//! What an option policy can learn from a stretch of experience, whoever acted in it.

use std::ops::Range;

use inroads_agents::{
    Lesson,
    experience::{Aim, Episode},
};

use super::{OptionReward, repertoire::Repertoire};
use crate::{Initiation, Subgoal};

impl<O: AsRef<[f32]>, I: Initiation<O>> Repertoire<O, I> {
    /// The lessons about a subgoal in some steps of episode `number`: each stretch until the subgoal is attained,
    /// or until the steps end without. Steps inside the subgoal teach nothing: no skill is executed there.
    pub(super) fn lessons<A>(
        &self,
        subgoal: Subgoal,
        number: u64,
        episode: &Episode<O, A>,
        steps: Range<u32>,
        reward: OptionReward,
    ) -> Vec<Lesson> {
        let mut lessons = Vec::new();
        let mut from = None;
        for step in steps.clone() {
            if self.inside(subgoal, &episode.observations[step as usize]) {
                continue;
            }
            let start = *from.get_or_insert(step);
            let attained = self.attained_by(subgoal, episode, step as usize);
            if attained || step + 1 == steps.end {
                let steps = start..step + 1;
                let rewards = match reward {
                    OptionReward::Sparse => None,
                    OptionReward::Dense => {
                        let afters = &episode.observations[start as usize + 1..=step as usize + 1];
                        Some(afters.iter().map(|after| -self.distance(subgoal, after)).collect())
                    }
                };
                lessons.push(Lesson { episode: number, steps, aim: Aim::Subgoal { attained }, rewards });
                from = None;
            }
        }
        lessons
    }
}
