use super::*;
use crate::experience::Aim;
use crate::goal::{Ground, Region};
use crate::{Lesson, Replay, Transition};
use inroads_envs::{Dimension, End, Seed, Space, Spec};
use std::slice::from_ref;

/// States are an episode's number and a step's. Goals are both: no other state attains one.
fn ground() -> Ground {
    let dimension = |name| Dimension::linear(name, "", 0.0, 1000.0);
    let spec = Spec {
        name: "test",
        about: "",
        observation: Space::Box([dimension("episode"), dimension("step")].into()),
        action: Space::Discrete(1),
        goal: None,
        place: vec![0, 1],
        time_limit: None,
        success_reward: 0.0,
    };
    Ground::of(&spec).unwrap()
}

fn goal(episode: u64, step: u32) -> Region {
    ground().ball(vec![episode as f32, step as f32], 0.1)
}

#[allow(clippy::ptr_arg)] // what is seen is a vector
fn achieved_at(s: &Vec<f32>) -> Region {
    ground().ball(s.clone(), 0.1)
}

fn push(all: &mut Experience<Vec<f32>, usize>, episode: u64, step: u32, end: Option<End>) {
    let (before, after) = (vec![episode as f32, step as f32], vec![episode as f32, step as f32 + 1.0]);
    all.push(&Transition { before: &before, action: &0, reward: -1.0, after: &after, end });
}

/// An episode of so many steps, which ends so.
fn live(all: &mut Experience<Vec<f32>, usize>, episode: u64, steps: u32, end: End) {
    assert_eq!(all.begin(&vec![episode as f32, 0.0]), episode);
    (0..steps).for_each(|step| push(all, episode, step, (step + 1 == steps).then_some(end)));
}

/// All steps of an episode on the way to a goal that none of them attains.
fn lesson(episode: u64, steps: u32) -> Lesson<Region> {
    let (aim, goal) = (Aim::Subgoal { attained: false }, Some(goal(999, 0)));
    Lesson { episode, steps: 0..steps, aim, goal, rewards: None }
}

#[test]
fn four_of_five_are_relabelled_with_what_comes_after_them_uniformly() {
    let (mut all, mut replay) = (Experience::new(100), Replay::new(100));
    live(&mut all, 0, 5, End::Truncated);
    replay.push(lesson(0, 5));
    let mut rng = Seed(0).stream("test", 0);
    let (mut clips, mut counts) = (Vec::new(), [0.0_f64; 5]);
    replay.sample(&all, 100_000, &mut rng, &mut clips);
    let goals = HindsightConfig::default().goals(&clips, &all, achieved_at, &mut rng);
    for (clip, goal) in clips.iter().zip(&goals) {
        if let Some(goal) = goal {
            // What the last state of transition number i achieved.
            let index = goal.at()[1] as u32 - 1;
            assert!(index >= clip.at.1);
            counts[index as usize] += 1.0;
        }
    }
    let relabelled: f64 = counts.iter().sum();
    assert!((relabelled / 1e5 - 0.8).abs() < 0.01, "{relabelled}");
    for (count, expected) in counts.iter().zip([0.04, 0.09, 0.1567, 0.2567, 0.4567]) {
        assert!((count / relabelled - expected).abs() < 0.006, "{counts:?}");
    }
}

#[test]
fn the_final_strategy_takes_the_last_state_and_none_nothing() {
    let mut rng = Seed(0).stream("test", 0);
    let mut draws = |strategy| {
        let config = HindsightConfig { strategy, ..HindsightConfig::default() };
        let mut drawn: Vec<_> = (0..200).map(|_| config.draw(2, 5, &mut rng)).collect();
        drawn.sort_unstable();
        drawn.dedup();
        drawn
    };
    assert_eq!(draws(Strategy::Final), [None, Some(5)]);
    assert_eq!(draws(Strategy::Future), [None, Some(3), Some(4), Some(5)]);
    assert_eq!(draws(Strategy::None), [None]);
    assert_eq!(draws(Strategy::Achieved), [None], "its goals are lessons");
}

#[test]
fn reward_and_end_follow_from_the_new_goal() {
    let (mut all, mut replay) = (Experience::new(100), Replay::new(100).spanning(3));
    live(&mut all, 0, 5, End::Truncated);
    replay.push(lesson(0, 5));
    let mut clips = Vec::new();
    replay.sample(&all, 64, &mut Seed(0).stream("test", 0), &mut clips);
    let clip = clips.iter().find(|clip| clip.at == (0, 1) && clip.len() == 3).unwrap();
    assert_eq!(clip.discounted(0.5), (-1.75, 0.125));

    for (at, returned) in [(2, (0.0, 0.0)), (3, (-1.0, 0.0)), (4, (-1.5, 0.0)), (5, (-1.75, 0.125))] {
        let goals = [Some(goal(0, at))];
        let new = &relabelled(from_ref(clip), &goals, Pay::COST)[0];
        assert_eq!(new.discounted(0.5), returned, "attained at {at}");
        assert_eq!(new.terminal, at < 5);
        assert_eq!(new.last()[1], (at as f32).min(4.0), "cut where it was attained");
        assert_eq!((new.goal, new.first(), new.at), (goals[0].as_ref(), clip.first(), clip.at));
    }
    let goals = [Some(goal(0, 3))];
    assert_eq!(relabelled(from_ref(clip), &goals, Pay::ATTAINMENT)[0].discounted(0.5), (0.5, 0.0));
    let kept = &relabelled(from_ref(clip), &[None], Pay::COST)[0];
    assert_eq!((kept.goal, kept.terminal), (clip.goal, clip.terminal));
}

#[test]
fn the_end_that_the_old_goal_made_is_none_of_the_new_one_and_a_death_is() {
    let (observations, action) = ([vec![0.0, 0.0], vec![0.0, 1.0]], [0]);
    let end = |old: Region| {
        let rewards = Rewards::Subgoal(Pay::COST, true);
        let goals = [Some(goal(0, 7))];
        let clip = Clip::new(&observations, &action, rewards, Some(&old), true);
        relabelled(&[clip], &goals, Pay::COST)[0].terminal
    };
    assert!(!end(goal(0, 1)), "it ended because it had arrived where nobody is going now");
    assert!(end(goal(0, 9)), "it ended for another reason");
}

#[test]
fn what_leads_in_is_not_where_a_goal_is_attained() {
    let observations = [vec![0.0, 0.0], vec![0.0, 1.0], vec![0.0, 2.0], vec![0.0, 3.0]];
    let (actions, goals) = ([0, 0, 0], [Some(goal(0, 1))]);
    let clip = Clip::new(&observations, &actions, Rewards::Given(&[]), None, false);
    let new = &relabelled(&[Clip { lead: 1, ..clip }], &goals, Pay::COST)[0];
    assert!(!new.terminal && new.len() == 2 && new.reward(1) == -1.0);
}

#[test]
fn forgetting_in_the_middle_of_an_episode_never_mixes_episodes() {
    // Room for three episodes, of steps and of lessons; the newest goes on while clips are drawn.
    let (mut all, mut replay) = (Experience::new(21), Replay::new(21));
    let mut rng = Seed(0).stream("test", 0);
    let mut seen = 0;
    for episode in 0..30 {
        all.begin(&vec![episode as f32, 0.0]);
        for step in 0..7 {
            push(&mut all, episode, step, (step == 6).then_some(End::Truncated));
            replay.forget_before(all.first());
            let mut clips = Vec::new();
            replay.sample(&all, 16, &mut rng, &mut clips);
            let goals = HindsightConfig::default().goals(&clips, &all, achieved_at, &mut rng);
            for clip in relabelled(&clips, &goals, Pay::COST).iter().filter(|clip| clip.at.0 < episode) {
                let at = clip.goal.unwrap().at();
                assert!(at[0] == 999.0 || (at[0] == clip.at.0 as f32 && at[1] > clip.at.1 as f32));
                assert!(clip.observations.iter().all(|s| s[0] == clip.at.0 as f32));
                seen += 1;
            }
        }
        replay.push(lesson(episode, 7));
    }
    assert!(all.first() > 20 && seen > 2000, "{} {seen}", all.first());
}

#[test]
fn achieved_goals_are_different_new_and_drawn_by_their_weight() {
    // 0, 1, 1, 2, 3, 0.
    let observations = [0.0, 1.0, 1.0, 2.0, 3.0, 0.0].map(|x| vec![0.0, x]).to_vec();
    let episode: Episode<Vec<f32>, usize> = Episode { observations, ..Episode::default() };
    let mut rng = Seed(0).stream("test", 0);
    let mut draw = |n, weight: fn(&Region) -> f64| achieved(&episode, achieved_at, weight, n, &mut rng);
    assert_eq!(draw(5, |_| 1.0), [goal(0, 1), goal(0, 2), goal(0, 3)]);
    let heavy = |goal: &Region| if goal.at()[1] == 2.0 { 2.0 } else { 1.0 };
    let twos = (0..4000).filter(|_| draw(1, heavy) == [goal(0, 2)]).count();
    assert!((twos as i64 - 2000).abs() < 130, "four standard deviations");
}

#[test]
fn settings_that_relabel_nothing_are_refused() {
    assert_eq!(HindsightConfig::default().check(), Ok(()));
    let config = HindsightConfig { per_clip: 0, ..HindsightConfig::default() };
    assert!(config.check().unwrap_err().contains("per_clip"));
    assert_eq!(HindsightConfig { strategy: Strategy::None, ..config }.check(), Ok(()));
}
