use super::*;
use crate::Transition;
use inroads_envs::Seed;
use std::ops::Range;

/// Three episodes of the given lengths whose observations count up; the second is truncated.
fn experience(capacity: usize) -> Experience<f32, u8> {
    let mut all = Experience::new(capacity);
    let mut value = 0.0;
    for (steps, end) in [(2, End::Terminated), (3, End::Truncated), (2, End::Terminated)] {
        all.begin(&value);
        for step in 0..steps {
            let (before, after) = (value, value + 1.0);
            let end = (step + 1 == steps).then_some(end);
            all.push(&Transition { before: &before, action: &0, reward: before, after: &after, end });
            value = after;
        }
        value += 1.0;
    }
    all
}

fn task(episode: u64, steps: Range<u32>) -> Lesson {
    Lesson { episode, steps, aim: Aim::Task, goal: None, rewards: None }
}

fn all_clips(replay: &Replay, all: &Experience<f32, u8>) -> Vec<(f32, f32, f32, bool)> {
    let mut clips = Vec::new();
    replay.sample(all, 400, &mut Seed(0).stream("test", 0), &mut clips);
    let mut seen: Vec<_> =
        clips.iter().map(|c| (c.observations[0], *c.last(), c.discounted(1.0).0, c.terminal)).collect();
    seen.sort_by(|a, b| a.0.total_cmp(&b.0));
    seen.dedup();
    seen
}

#[test]
fn clips_never_cross_an_episode_and_only_terminations_are_terminal() {
    let all = experience(100);
    let mut replay = Replay::new(100);
    for (episode, steps) in [(0, 0..2), (1, 0..3), (2, 0..2)] {
        replay.push(task(episode, steps));
    }
    let expected = [(0.0, false), (1.0, true), (3.0, false), (4.0, false), (5.0, false), (7.0, false)];
    let seen = all_clips(&replay, &all);
    assert_eq!(seen.len(), 7);
    for ((from, terminal), clip) in expected.iter().zip(&seen) {
        assert_eq!(*clip, (*from, from + 1.0, *from, *terminal));
    }
}

#[test]
fn an_attained_subgoal_ends_its_lesson_and_a_missed_one_bootstraps() {
    let all = experience(100);
    let mut replay = Replay::new(100);
    let lesson = |attained, steps| Lesson { aim: Aim::Subgoal { attained }, ..task(1, steps) };
    replay.push(lesson(true, 0..2));
    replay.push(lesson(false, 2..3));
    let expected = [(3.0, 4.0, -1.0, false), (4.0, 5.0, 0.0, true), (5.0, 6.0, -1.0, false)];
    assert_eq!(all_clips(&replay, &all), expected);
    let expected = [(3.0, 4.0, 0.0, false), (4.0, 5.0, 1.0, true), (5.0, 6.0, 0.0, false)];
    assert_eq!(all_clips(&replay.paying(Pay::ATTAINMENT), &all), expected);
}

#[test]
fn the_ring_forgets_the_oldest_lessons_and_dense_rewards_replace_sparse_ones() {
    let all = experience(100);
    let mut replay = Replay::new(4);
    replay.push(task(0, 0..2));
    replay.push(Lesson { rewards: Some(Box::new([0.5, 0.25, 0.125])), ..task(1, 0..3) });
    assert_eq!(replay.len(), 3);
    let rewards: Vec<_> = all_clips(&replay, &all).iter().map(|c| c.2).collect();
    assert_eq!(rewards, [0.5, 0.25, 0.125]);
}

#[test]
fn clips_of_several_steps_end_with_their_lesson() {
    // algorithms.md 14: rewards 0, 0 and a terminal 1 are worth .81, .9 and 1 from their three states.
    let mut all = Experience::new(100);
    all.begin(&0.0);
    for (step, reward) in [0.0, 0.0, 1.0].into_iter().enumerate() {
        let (before, after) = (step as f32, step as f32 + 1.0);
        let end = (step == 2).then_some(End::Terminated);
        all.push(&Transition { before: &before, action: &0u8, reward, after: &after, end });
    }
    let returns = |lesson: Lesson, replay: Replay| {
        let mut replay = replay.spanning(3);
        replay.push(lesson);
        let mut clips = Vec::new();
        replay.sample(&all, 200, &mut Seed(0).stream("test", 0), &mut clips);
        let mut seen: Vec<_> = clips.iter().map(|c| (c.observations[0], c.discounted(0.9))).collect();
        seen.sort_by(|a, b| a.0.total_cmp(&b.0));
        seen.dedup();
        seen
    };
    let near = |found: Vec<(f32, (f32, f32))>, expected: &[(f32, f32)]| {
        assert_eq!(found.len(), expected.len());
        for ((_, found), expected) in found.iter().zip(expected) {
            assert!((found.0 - expected.0).abs() < 1e-6 && (found.1 - expected.1).abs() < 1e-6, "{found:?}");
        }
    };
    near(returns(task(0, 0..3), Replay::new(10)), &[(0.81, 0.0), (0.9, 0.0), (1.0, 0.0)]);
    // The task goes on behind the lesson; about a subgoal it bootstraps from where it was cut.
    near(returns(task(0, 0..2), Replay::new(10)), &[(0.81, 0.0), (0.9, 0.0)]);
    let missed = Lesson { aim: Aim::Subgoal { attained: false }, ..task(0, 0..2) };
    near(returns(missed, Replay::new(10).paying(Pay::ATTAINMENT)), &[(0.0, 0.81), (0.0, 0.9)]);
    let attained = Lesson { aim: Aim::Subgoal { attained: true }, ..task(0, 0..2) };
    near(returns(attained, Replay::new(10).paying(Pay::ATTAINMENT)), &[(0.9, 0.0), (1.0, 0.0)]);
}

#[test]
fn whole_episodes_are_forgotten_with_their_lessons() {
    let mut all = experience(4);
    all.begin(&0.0);
    assert_eq!(all.first(), 2, "seven steps are over a capacity of four until two episodes are gone");
    let mut replay = Replay::new(100);
    replay.push(task(1, 0..3));
    replay.push(task(2, 0..2));
    replay.forget_before(all.first());
    assert_eq!(replay.len(), 2);
    assert!(all_clips(&replay, &all).iter().all(|c| c.0 >= 7.0));
}

#[test]
fn lessons_about_the_past_are_forgotten_wherever_they_lie() {
    let mut all = experience(4);
    let mut replay = Replay::new(100);
    // The second comes late; the third comes behind it and is late as well.
    for (episode, steps) in [(2, 0..2), (0, 0..2), (1, 0..3), (2, 1..2)] {
        replay.push(task(episode, steps));
    }
    replay.forget_before(1);
    assert_eq!(replay.len(), 6, "the lesson of episode 0 had two steps");
    all.begin(&0.0);
    assert_eq!(all.first(), 2);
    replay.forget_before(all.first());
    assert_eq!(replay.len(), 3);
    let seen: Vec<_> = all_clips(&replay, &all).iter().map(|c| c.0).collect();
    assert_eq!(seen, [7.0, 8.0]);
    replay.push(task(3, 0..1));
    replay.forget_before(4);
    assert!(replay.is_empty());
}

/// One episode of seven steps, whose memory is noted every second step.
fn remembered() -> Experience<f32, u8> {
    let mut all = Experience::new(100);
    let number = all.begin(&0.0);
    for step in 0..7_u8 {
        if step.is_multiple_of(2) {
            all.note(number, &[f32::from(step)]);
        }
        let (before, after) = (f32::from(step), f32::from(step + 1));
        let end = (step == 6).then_some(End::Terminated);
        all.push(&Transition { before: &before, action: &step, reward: before, after: &after, end });
    }
    all
}

#[test]
fn steps_of_the_task_go_on_into_those_that_came_later() {
    let all = remembered();
    let mut replay: Replay = Replay::new(100).spanning(3);
    (0..7).for_each(|step| replay.push(Lesson::task(0, step)));
    let clip = |step| replay.clip(&replay.lessons[step as usize], step, &all);
    assert_eq!((clip(0).actions, clip(0).discounted(1.0)), (&[0, 1, 2][..], (3.0, 1.0)));
    // The last steps' returns are shorter, and none is left out.
    assert_eq!((clip(5).actions, clip(5).discounted(1.0)), (&[5, 6][..], (11.0, 0.0)));
    assert_eq!((clip(6).actions, clip(4).terminal, clip(3).terminal), (&[6][..], true, false));
}

#[test]
fn sequences_begin_where_memories_were_noted_and_tile_a_lesson() {
    let all = remembered();
    let mut replay: Replay = Replay::new(100).paying(Pay::ATTAINMENT).sequences(4, 2, 0);
    replay.push(Lesson { aim: Aim::Subgoal { attained: true }, ..task(0, 1..6) });
    assert_eq!(replay.len(), 6);
    let clip = |step| replay.clip(&replay.lessons[0], step, &all);
    let seen: Vec<_> = (0..3).map(|i| replay.cut.start(&(1..6), i)).collect();
    assert_eq!(seen, [1, 2, 4]);
    // The first begins between two notes: the step before leads it in.
    let first = clip(1);
    assert_eq!(
        (first.observations, first.lead, first.memory),
        (&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0][..], 1, &[0.0][..])
    );
    assert_eq!((first.len(), *first.first(), first.at, first.previous), (4, 1.0, (0, 0), None));
    let last = clip(4);
    assert_eq!((last.observations, last.lead, last.memory), (&[4.0, 5.0, 6.0][..], 0, &[4.0][..]));
    assert_eq!((last.previous, last.terminal, last.discounted(0.5)), (Some(&3), true, (0.5, 0.0)));
    let burning = replay.clone().sequences(4, 2, 3);
    let burnt = burning.clip(&burning.lessons[0], 4, &all);
    assert_eq!((burnt.at, burnt.lead, burnt.reward(1)), ((0, 0), 4, 1.0));
}

#[test]
fn what_surprises_is_drawn_again_and_priorities_move_with_their_lessons() {
    let all = experience(100);
    let mut replay = Replay::new(100).prioritised(PriorityConfig::default());
    // Late lessons about the first episode stand behind those of the second.
    for (episode, steps) in [(0, 0..2), (1, 0..3), (0, 0..1), (2, 0..2)] {
        replay.push(task(episode, steps));
    }
    let (mut clips, mut rng) = (Vec::new(), Seed(0).stream("test", 0));
    let numbers = replay.sample(&all, 64, &mut rng, &mut clips);
    let errors: Vec<_> =
        clips.iter().map(|clip| if clip.observations[0] == 4.0 { 1.0 } else { 0.0 }).collect();
    assert!(clips.iter().all(|clip| clip.weight == 1.0), "what nobody judged yet counts alike");
    drop(clips);
    replay.revise(&numbers, &errors);
    replay.forget_before(1);
    assert_eq!(replay.len(), 5);
    let mut clips = Vec::new();
    replay.sample(&all, 600, &mut rng, &mut clips);
    let often = clips.iter().filter(|clip| clip.observations[0] == 4.0).count();
    // √1.01 against four times √0.01.
    assert!((often as f32 - 600.0 * 1.005 / 1.405).abs() < 20.0, "{often}");
    assert!(clips.iter().all(|clip| (clip.weight == 1.0) == (clip.observations[0] != 4.0)));
}
