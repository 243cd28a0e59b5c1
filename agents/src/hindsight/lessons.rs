//! What a subgoal can be taught by steps that somebody took on whatever errand, as lessons.

use std::ops::Range;

use crate::{
    Goal, Lesson,
    experience::{Aim, Episode},
};

/// The stretches of some steps that teach a subgoal: each until the subgoal is attained, and the last one until the
/// steps end without. Steps that begin inside the subgoal teach nothing: no skill is executed there.
///
/// `inside` says of a step whether it begins inside the subgoal, `attained` whether it attains it.
pub fn stretches(
    steps: Range<u32>,
    inside: impl Fn(usize) -> bool,
    attained: impl Fn(usize) -> bool,
) -> Vec<(Range<u32>, bool)> {
    let mut stretches = Vec::new();
    let mut from = None;
    for step in steps.clone() {
        if inside(step as usize) {
            continue;
        }
        let start = *from.get_or_insert(step);
        let attained = attained(step as usize);
        if attained || step + 1 == steps.end {
            stretches.push((start..step + 1, attained));
            from = None;
        }
    }
    stretches
}

/// What some steps of episode `number` teach of getting to `goal`: one lesson a [stretch](stretches), without dense
/// rewards.
///
/// # Panics
/// When the episode has fewer steps.
pub fn lessons<O, A, G: Goal<O>>(
    goal: &G,
    number: u64,
    episode: &Episode<O, A>,
    steps: Range<u32>,
) -> Vec<Lesson<G>> {
    let first = steps.start as usize;
    let states = &episode.observations[first..=steps.end as usize];
    let inside: Vec<_> = states.iter().map(|s| goal.reached(s)).collect();
    let lesson = |(steps, attained): (Range<u32>, bool)| Lesson {
        episode: number,
        steps,
        aim: Aim::Subgoal { attained },
        goal: Some(goal.clone()),
        rewards: None,
    };
    let found = stretches(steps, |step| inside[step - first], |step| inside[step + 1 - first]);
    found.into_iter().map(lesson).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::goal::Ground;
    use inroads_envs::Environment;
    use inroads_envs::corridor::Corridor;

    #[test]
    fn each_stretch_ends_with_the_subgoal_and_none_begins_in_it() {
        // States 0 to 7; the subgoal is {3, 4}.
        let inside = |state: usize| state == 3 || state == 4;
        let found = stretches(0..7, inside, |step| inside(step + 1));
        assert_eq!(found, [(0..3, true), (5..7, false)]);
        assert!(stretches(3..5, inside, |step| inside(step + 1)).is_empty());
    }

    #[test]
    fn a_stretch_becomes_a_lesson_about_its_goal() {
        let observations: Vec<_> = (0..8).map(|x| vec![x as f32]).collect();
        let (actions, rewards) = (vec![0; 7], vec![0.0; 7]);
        let episode = Episode { observations, actions, rewards, ..Episode::default() };
        let goal = Ground::of(Corridor::new(8).spec()).unwrap().ball(vec![4.0], 0.5);
        let found = lessons(&goal, 9, &episode, 2..7);
        let lesson = |steps, attained| Lesson {
            episode: 9,
            steps,
            aim: Aim::Subgoal { attained },
            goal: Some(goal.clone()),
            rewards: None,
        };
        assert_eq!(found, [lesson(2..4, true), lesson(5..7, false)]);
    }
}
