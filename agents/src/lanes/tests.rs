use std::{cell::RefCell, rc::Rc};

use inroads_envs::{End, Seed, TimeLimit, corridor::Corridor};
use rand::RngExt;

use super::*;
use crate::{
    Agent, Bag, Checkpoint, Clip, Corrupt, Curious, Experience, Flat, Lane, Learned, Learner, Memory, Pace,
    Practice, Replay, TabularQ, episode, tabular::TabularConfig,
};

/// Walks at random, and remembers how often it was asked.
#[derive(Clone, Default)]
struct Wanderer {
    learned: u64,
}

impl Checkpoint for Wanderer {
    fn save(&self, bag: &mut Bag) {
        bag.put("learned", &self.learned);
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        self.learned = bag.get("learned")?;
        Ok(())
    }
}

impl Learner<Vec<f32>, usize, ()> for Wanderer {
    fn act(&self, memory: &mut Memory, _: &Vec<f32>, _: Option<&()>, ctx: &mut Context) -> usize {
        memory.resize(1, 0.0);
        memory[0] += 1.0;
        ctx.acting.random_range(0..2)
    }

    fn values(&self, _: &Memory, _: &Vec<f32>, goals: &[Option<&()>]) -> Vec<f32> {
        vec![0.0; goals.len()]
    }

    fn learn(&mut self, clips: &[Clip<Vec<f32>, usize, ()>], _: &mut Context) -> Learned {
        self.learned += clips.len() as u64;
        Learned::default()
    }

    fn batch(&self) -> usize {
        4
    }
}

fn corridor() -> Box<TimeLimit<Corridor>> {
    Box::new(TimeLimit::new(Corridor::new(4), 30))
}

fn contexts(numbers: std::ops::Range<u64>) -> Vec<Context> {
    numbers.map(|number| Context::training(Seed(7), number)).collect()
}

/// Before, action, after, end.
type Seen = (Vec<f32>, usize, Vec<f32>, Option<End>);

fn noted(t: &Transition<Vec<f32>, usize>) -> Seen {
    (t.before.clone(), *t.action, t.after.clone(), t.end)
}

fn wandering() -> Flat<Vec<f32>, usize, Wanderer> {
    let replay = Replay::new(1000).sequences(4, 2, 0);
    let practice = Practice::new(replay, Pace { updates_per_step: 1.0, warm_up: 0 });
    Flat::new(Curious::new(Wanderer::default(), practice), 1000)
}

#[test]
fn an_episode_beside_others_is_the_one_that_it_is_alone() {
    let alone: Vec<(Vec<Seen>, Summary)> = (0..5)
        .map(|number| {
            let mut seen = Vec::new();
            let ctx = &mut Context::training(Seed(7), number);
            let summary =
                episode(&mut *corridor(), &mut wandering(), number, ctx, |t, _| seen.push(noted(t))).unwrap();
            (seen, summary)
        })
        .collect();
    let mut together = vec![Vec::new(); 5];
    let mut envs: Vec<_> = (0..5).map(|_| corridor()).collect();
    let seeds: Vec<_> = (0..5).collect();
    let watch = |lane: usize, t: &Transition<Vec<f32>, usize>, _| together[lane].push(noted(t));
    let summaries = round(&mut envs, &mut wandering(), &seeds, &mut contexts(0..5), watch).unwrap();
    let lengths: Vec<_> = summaries.iter().map(|summary| summary.steps).collect();
    assert!(lengths.iter().any(|steps| *steps != lengths[0]), "{lengths:?}");
    assert_eq!(together.into_iter().zip(summaries).collect::<Vec<_>>(), alone);
}

#[test]
fn every_lane_writes_its_own_episode_and_keeps_its_own_memory() {
    let mut agent = wandering();
    let mut envs: Vec<_> = (0..3).map(|_| corridor()).collect();
    let mut order = Vec::new();
    let watch = |lane: usize, _: &Transition<Vec<f32>, usize>, _| order.push(lane);
    let summaries = round(&mut envs, &mut agent, &[0, 1, 2], &mut contexts(0..3), watch).unwrap();
    assert_eq!(order[..3], [0, 1, 2]);
    let bag = saved(&agent);
    let all: Experience<Vec<f32>, usize> = bag.get("experience").unwrap();
    for (number, summary) in summaries.iter().enumerate() {
        let episode = all.episode(number as u64).unwrap();
        assert_eq!((episode.actions.len() as u32, episode.end), (summary.steps, Some(summary.end)));
        // Before step 2 it was asked twice, whatever the other lanes did; before step 0 it remembers nothing.
        let expected: Vec<_> = (2..summary.steps).step_by(2).map(|step| (step, vec![step as f32])).collect();
        assert_eq!(episode.memories.clone().into_iter().collect::<Vec<_>>(), expected);
    }
    // An update a step of any lane, as soon as the steps suffice for a batch.
    let steps: u32 = summaries.iter().map(|summary| summary.steps).sum();
    let (_, updates) = agent.updates()[0];
    assert!(updates + 4 > u64::from(steps) && updates < u64::from(steps), "{updates} of {steps}");
}

/// Q-learning in two corridors at a time.
fn learner() -> Flat<Vec<f32>, usize, TabularQ> {
    let practice = Practice::new(Replay::new(1000).spanning(3), Pace { updates_per_step: 1.0, warm_up: 8 });
    Flat::new(Curious::new(TabularQ::new(2, &TabularConfig::default()), practice), 1000)
}

/// Rounds of two lanes from the `from`th on; the steps of each.
fn rounds(agent: &mut Flat<Vec<f32>, usize, TabularQ>, numbers: std::ops::Range<u64>) -> Vec<[u32; 2]> {
    let mut envs = [corridor(), corridor()];
    let mut one = |number| {
        let (seeds, mut ctxs) = ([2 * number, 2 * number + 1], contexts(2 * number..2 * number + 2));
        let summaries = round(&mut envs, agent, &seeds, &mut ctxs, |_, _, _| {}).unwrap();
        [summaries[0].steps, summaries[1].steps]
    };
    numbers.map(&mut one).collect()
}

fn saved(agent: &impl Checkpoint) -> Bag {
    let mut bag = Bag::default();
    agent.save(&mut bag);
    bag
}

#[test]
fn two_lanes_learn_and_go_on_from_a_checkpoint_to_the_same_bits() {
    let mut whole = learner();
    let before = rounds(&mut whole, 0..20);
    let mut resumed = learner();
    resumed.load(&saved(&whole)).unwrap();
    let after = rounds(&mut whole, 20..40);
    assert_eq!(rounds(&mut resumed, 20..40), after);
    assert!(saved(&resumed) == saved(&whole));
    // Three steps lead to the end.
    let sum = |rounds: &[[u32; 2]]| rounds.iter().flatten().sum::<u32>();
    assert!(sum(&after[10..]) <= 20 * 4 && sum(&before[..10]) > sum(&after[10..]), "{before:?} {after:?}");
    let ctx = &mut Context::evaluation(Seed(7), 0);
    let summary = episode(&mut *corridor(), &mut *whole.frozen(), 0, ctx, |_, _| {}).unwrap();
    assert_eq!((summary.steps, summary.success), (3, true));
}

#[test]
fn lanes_are_acted_for_together() {
    struct Together(Rc<RefCell<Vec<usize>>>);
    impl Checkpoint for Together {
        fn save(&self, _: &mut Bag) {}
        fn load(&mut self, _: &Bag) -> Result<(), Corrupt> {
            Ok(())
        }
    }
    impl Learner<Vec<f32>, usize, ()> for Together {
        fn act(&self, _: &mut Memory, _: &Vec<f32>, _: Option<&()>, _: &mut Context) -> usize {
            unreachable!("lanes are acted for together")
        }
        fn values(&self, _: &Memory, _: &Vec<f32>, goals: &[Option<&()>]) -> Vec<f32> {
            vec![0.0; goals.len()]
        }
        fn act_all(&self, lanes: &mut [Lane<'_, Vec<f32>, ()>]) -> Vec<usize> {
            self.0.borrow_mut().push(lanes.len());
            lanes.iter_mut().map(|lane| lane.ctx.acting.random_range(0..2)).collect()
        }
        fn learn(&mut self, _: &[Clip<Vec<f32>, usize, ()>], _: &mut Context) -> Learned {
            Learned::default()
        }
        fn batch(&self) -> usize {
            1
        }
    }
    let asked = Rc::default();
    let practice = Practice::new(Replay::new(1000), Pace { updates_per_step: 0.0, warm_up: 0 });
    let mut agent = Flat::new(Curious::new(Together(Rc::clone(&asked)), practice), 1000);
    let mut envs = [corridor(), corridor()];
    let summaries = round(&mut envs, &mut agent, &[0, 1], &mut contexts(0..2), |_, _, _| {}).unwrap();
    let (both, longest) =
        (summaries[0].steps.min(summaries[1].steps), summaries[0].steps.max(summaries[1].steps));
    let mut expected = vec![2; both as usize];
    expected.resize(longest as usize, 1);
    assert_eq!(*asked.borrow(), expected);
}
