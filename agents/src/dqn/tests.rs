use super::*;
use crate::encode::{Patches, Select};
use crate::experience::{Pay, Rewards};
use crate::nets::TorsoConfig;
use crate::replay::PriorityConfig;
use crate::{Bag, Checkpoint, Experience, Lesson, Pace, Practice, Replay, Transition};
use inroads_envs::{End, Frame, Seed, Space};

type Row = Vec<f32>;

fn small() -> DqnConfig {
    DqnConfig {
        torso: TorsoConfig { hidden: vec![24], ..TorsoConfig::default() },
        head: 24,
        rate: 3e-3,
        adam_epsilon: 1e-8,
        discount: 0.9,
        follow_every: u64::MAX,
        loss: Loss::Squared,
        epsilon: Epsilon { start: 0.0, end: 0.0, updates: 1 },
        ..DqnConfig::default()
    }
}

/// Rainbow's network.
fn noisy_atoms() -> DqnConfig {
    let atoms = AtomsConfig { number: 11, low: -2.0, high: 2.0 };
    DqnConfig { noise: 0.5, atoms, ..small() }
}

fn with_goals(goal_width: usize, config: &DqnConfig) -> Dqn<Row> {
    let mut rng = Seed(3).stream("weights", 0);
    Dqn::with_goals(Arc::new(Select::new(&[0, 1])), goal_width, 2, config, Backend::of_tests(), &mut rng)
}

fn learner(config: &DqnConfig) -> Dqn<Row> {
    with_goals(0, config)
}

fn ctx(index: u64) -> Context {
    Context::training(Seed(7), index)
}

fn saved<O>(learner: &Dqn<O>) -> Bag {
    let mut bag = Bag::default();
    learner.save(&mut bag);
    bag
}

struct Goal([f32; 2]);

impl Encode for Goal {
    fn width(&self) -> usize {
        2
    }

    fn write(&self, out: &mut [f32]) {
        out.copy_from_slice(&self.0);
    }
}

/// Has the learner learn what each choice is worth at a state, by steps that end there.
fn teach<O: Clone>(learner: &mut Dqn<O>, lessons: &[(O, [f32; 2])], updates: u64) -> Learned {
    let steps: Vec<_> = lessons
        .iter()
        .flat_map(|(s, worth)| [0, 1].map(|choice| ([s.clone(), s.clone()], [choice], [worth[choice]])))
        .collect();
    let clips: Vec<Clip<O, usize, ()>> = steps
        .iter()
        .map(|(seen, did, paid)| Clip::new(seen, did, Rewards::Given(paid), None, true))
        .collect();
    (0..updates).map(|i| learner.learn(&clips, &mut ctx(i))).last().unwrap()
}

/// A learner whose target holds `slow` and whose online network `fast` for the choices at a state.
fn crafted(config: &DqnConfig, slow: [f32; 2], fast: [f32; 2]) -> Dqn<Row> {
    let mut learner = learner(config);
    teach(&mut learner, &[(vec![0.3, -0.2], slow)], 600);
    learner.nets.follow(1.0);
    teach(&mut learner, &[(vec![0.3, -0.2], fast)], 600);
    learner
}

#[test]
fn the_double_target_takes_the_online_choice_at_the_targets_value() {
    let (states, rewards) = ([vec![0.9, 0.9], vec![0.3, -0.2]], [1.0]);
    let target = |double, terminal| {
        let learner = crafted(&DqnConfig { double, ..small() }, [3.0, 10.0], [2.0, 1.0]);
        let clip: Clip<_, _, ()> = Clip::new(&states, &[0], Rewards::Given(&rewards), None, terminal);
        learner.targets(&[clip], &mut ctx(0))[0]
    };
    assert!((target(true, false) - 3.7).abs() < 0.01, "{}", target(true, false));
    assert!((target(false, false) - 10.0).abs() < 0.01, "{}", target(false, false));
    assert_eq!(target(true, true), 1.0);
}

#[test]
fn returns_of_several_steps_bootstrap_by_as_many_discounts() {
    // algorithms.md 14: 3 steps that pay 0, 0, 1 and then 2, discounted by .9 each, are 2.268.
    let learner = crafted(&small(), [2.0, -1.0], [2.0, -1.0]);
    let states = [vec![0.0, 0.0], vec![0.1, 0.0], vec![0.2, 0.0], vec![0.3, -0.2]];
    let clip = |steps: usize, terminal| -> Clip<'_, _, _, ()> {
        Clip::new(
            &states[3 - steps..],
            &[0, 1, 0][..steps],
            Rewards::Given(&[0.0, 0.0, 1.0][3 - steps..]),
            None,
            terminal,
        )
    };
    let targets = learner.targets(&[clip(3, false), clip(1, false), clip(3, true)], &mut ctx(0));
    for (found, expected) in targets.iter().zip([2.268, 2.8, 0.81]) {
        assert!((found - expected).abs() < 0.01, "{found} {expected}");
    }
}

#[test]
fn errors_are_those_of_each_clip_and_weights_count_them() {
    let states = [vec![0.5, 0.5], vec![0.0, 1.0]];
    let clip = |paid, weight| -> Clip<'_, _, _, ()> {
        Clip { weight, ..Clip::new(&states, &[1], Rewards::Given(paid), None, true) }
    };
    let mut one = learner(&small());
    let value = one.action_values(&states[0], None::<&()>)[1];
    let (near, far) = (clip(&[1.0], 1.0), clip(&[-4.0], 0.0));
    let learned = one.learn(&[near, far], &mut ctx(0));
    assert!((learned.errors[0] - (1.0 - value).abs()).abs() < 1e-6);
    assert!((learned.errors[1] - (4.0 + value).abs()).abs() < 1e-6);
    assert!((learned.loss - 0.25 * (1.0 - value).powi(2)).abs() < 1e-6, "half of ½e², for n is 2");
    // What weighs nothing teaches nothing.
    let mut two = learner(&small());
    two.learn(&[clip(&[1.0], 0.5), clip(&[1.0], 0.5)], &mut ctx(0));
    for (a, b) in
        one.action_values(&states[1], None::<&()>).iter().zip(two.action_values(&states[1], None::<&()>))
    {
        assert!((a - b).abs() < 1e-6, "{a} {b}");
    }
}

#[test]
fn the_target_follows_every_so_many_updates() {
    let asked = |learner: &Dqn<Row>| {
        let state = vec![0.3, -0.2];
        let ask = || learner.asked(iter::once(&state), iter::once(None::<&()>), Vec::new());
        (learner.nets.outputs(ask()), learner.nets.target_outputs(ask()))
    };
    let mut learner = learner(&DqnConfig { follow_every: 3, tau: 1.0, ..small() });
    let first = asked(&learner).1;
    teach(&mut learner, &[(vec![0.3, -0.2], [1.0, -1.0])], 2);
    assert!(asked(&learner).1 == first && asked(&learner).0 != first);
    teach(&mut learner, &[(vec![0.3, -0.2], [1.0, -1.0])], 1);
    assert_eq!(asked(&learner).1, asked(&learner).0);
}

#[test]
fn all_lanes_act_as_each_would_alone() {
    for config in [DqnConfig { epsilon: Epsilon { start: 0.4, ..small().epsilon }, ..small() }, noisy_atoms()]
    {
        let learner = learner(&config);
        let states: Vec<Row> = (0..40).map(|i| vec![(i as f32).sin(), (i as f32).cos()]).collect();
        let alone: Vec<usize> = (0..40)
            .map(|i| {
                Learner::<Row, usize, ()>::act(
                    &learner,
                    &mut Memory::new(),
                    &states[i],
                    None,
                    &mut ctx(i as u64),
                )
            })
            .collect();
        let mut rest: Vec<_> = (0..40).map(|i| (Memory::new(), ctx(i))).collect();
        let mut lanes: Vec<Lane<'_, Row, ()>> = rest
            .iter_mut()
            .zip(&states)
            .map(|((memory, ctx), s)| Lane { memory, s, goal: None, ctx })
            .collect();
        assert_eq!(learner.act_all(&mut lanes), alone);
        assert!(alone.contains(&0) && alone.contains(&1));
    }
}

#[test]
fn who_does_not_explore_takes_the_best_and_who_explores_follows_the_schedule() {
    let state = vec![0.3, -0.2];
    let share = |learner: &Dqn<Row>, explore| {
        let mut ctx = Context { explore, ..ctx(1) };
        let worse = |_: &usize| {
            Learner::<Row, usize, ()>::act(learner, &mut Memory::new(), &state, None, &mut ctx) == 1
        };
        (0..4000).filter(worse).count() as f32 / 4000.0
    };
    let mut learner =
        learner(&DqnConfig { epsilon: Epsilon { start: 1.0, end: 0.2, updates: 100 }, ..small() });
    assert!((share(&learner, true) - 0.5).abs() < 0.03, "all choices are random at first");
    teach(&mut learner, &[(state.clone(), [1.0, -1.0])], 200);
    assert!((share(&learner, true) - 0.1).abs() < 0.02, "half of a fifth");
    assert_eq!(share(&learner, false), 0.0);
}

#[test]
fn noise_explores_and_is_another_for_the_choice_than_for_its_value() {
    let state = vec![0.3, -0.2];
    let loud = learner(&DqnConfig { noise: 4.0, ..small() });
    let mut streams = ctx(0);
    let mut acts = |explore| -> Vec<usize> {
        streams.explore = explore;
        let mut act =
            |_| Learner::<Row, usize, ()>::act(&loud, &mut Memory::new(), &state, None, &mut streams);
        (0..60).map(&mut act).collect()
    };
    let noisy = acts(true);
    assert!(noisy.contains(&0) && noisy.contains(&1));
    let quiet = acts(false);
    assert!(quiet.iter().all(|choice| *choice == quiet[0]));
    // Both networks are the same one here. Were the noise the same too, the choice would be the target's own.
    let states = [state.clone(), state.clone()];
    let clip: Clip<_, _, ()> = Clip::new(&states, &[0], Rewards::Given(&[0.0]), None, false);
    let target = |noise, double, index| {
        learner(&DqnConfig { noise, double, ..small() }).targets(&[clip], &mut ctx(index))[0]
    };
    let differ = |noise| (0..30).filter(|i| target(noise, true, *i) != target(noise, false, *i)).count();
    assert!(differ(4.0) > 5 && differ(0.0) == 0);
}

#[test]
fn the_values_of_all_goals_are_those_of_each() {
    let goals = [Goal([1.0, 0.0]), Goal([0.0, 1.0])];
    for config in [small(), noisy_atoms()] {
        let mut learner = with_goals(2, &config);
        let states = [vec![0.5, 0.5], vec![0.0, 1.0]];
        // Choice 1 attains the first goal, choice 0 the other, and the task pays 0.5 for either.
        let clip = |choice: &'static [usize], goal, attained| {
            Clip::new(&states, choice, Rewards::Subgoal(Pay::ATTAINMENT, attained), goal, true)
        };
        let half = |choice: &'static [usize]| Clip::new(&states, choice, Rewards::Given(&[0.5]), None, true);
        let clips = [
            clip(&[1], Some(&goals[0]), true),
            clip(&[0], Some(&goals[0]), false),
            clip(&[1], Some(&goals[1]), false),
            clip(&[0], Some(&goals[1]), true),
            half(&[0]),
            half(&[1]),
        ];
        (0..800).for_each(|i| _ = learner.learn(&clips, &mut ctx(i)));
        let asked = [Some(&goals[0]), None, Some(&goals[1])];
        let all = learner.values(&Memory::new(), &states[0], &asked);
        let each = asked.map(|goal| learner.values(&Memory::new(), &states[0], &[goal])[0]);
        for ((all, each), expected) in all.iter().zip(each).zip([1.0, 0.5, 1.0]) {
            assert!((all - each).abs() < 1e-5 && (all - expected).abs() < 0.1, "{all} {each} {expected}");
        }
        let mut ctx = Context { explore: false, ..ctx(0) };
        let act = |goal, ctx: &mut Context| learner.act(&mut Memory::new(), &states[0], goal, ctx);
        assert_eq!((act(asked[0], &mut ctx), act(asked[2], &mut ctx)), (1, 0));
    }
    // Who reads none has one answer.
    let plain = learner(&small());
    let none: [Option<&()>; 3] = [None; 3];
    let values = plain.values(&Memory::new(), &vec![0.0, 0.0], &none);
    assert!(values.len() == 3 && values[0] == values[2]);
}

#[test]
fn pictures_are_learned_from_as_vectors_are() {
    let patches = Patches::new(&Space::Frame { width: 16, height: 16, channels: 1 }, 4).unwrap();
    let mut rng = Seed(3).stream("weights", 0);
    let mut learner: Dqn<Frame> = Dqn::new(Arc::new(patches), 2, &small(), Backend::of_tests(), &mut rng);
    let picture = |at: usize| {
        let mut frame = Frame::new([16, 16], 1);
        frame.bytes_mut()[at] = 255;
        frame
    };
    let lessons = [(picture(17), [1.0, -1.0]), (picture(200), [-0.5, 0.5])];
    let learned = teach(&mut learner, &lessons, 800);
    assert!(learned.loss < 1e-3, "{}", learned.loss);
    let values = learner.action_values(&lessons[1].0, None::<&()>);
    assert!((values[0] + 0.5).abs() < 0.05 && (values[1] - 0.5).abs() < 0.05, "{values:?}");
}

#[test]
fn distributions_tell_a_gamble_from_what_is_sure() {
    let atoms = AtomsConfig { number: 5, low: -1.0, high: 1.0 };
    let mut learner = learner(&DqnConfig { atoms, ..small() });
    let states = [vec![0.3, -0.2], vec![0.0, 0.0]];
    let clip = |choice: &'static [usize], paid| -> Clip<'_, _, _, ()> {
        Clip::new(&states, choice, Rewards::Given(paid), None, true)
    };
    let clips = [clip(&[0], &[1.0]), clip(&[0], &[-1.0]), clip(&[1], &[0.25]), clip(&[1], &[0.25])];
    let learned = (0..800).map(|i| learner.learn(&clips, &mut ctx(i))).last().unwrap();
    // The cross entropy of both is ln 2: half on −1 and 1 each, and half on 0 and 0.5 each.
    assert!(learned.errors.iter().all(|error| (error - 2_f32.ln()).abs() < 0.02), "{learned:?}");
    let values = learner.action_values(&states[0], None::<&()>);
    assert!(values[0].abs() < 0.02 && (values[1] - 0.25).abs() < 0.02, "{values:?}");
}

/// Walks at random along five places, of which the last pays 1 and ends the episode, and learns with all of Rainbow's
/// replay; the values of going right and left at the place before the last and at the one before that.
fn walked(config: &DqnConfig, steps: u32) -> [Vec<f32>; 2] {
    let mut learner: Dqn<Row> = Dqn::new(
        Arc::new(Select::new(&[0, 1, 2, 3, 4])),
        2,
        config,
        Backend::of_tests(),
        &mut Seed(1).stream("w", 0),
    );
    let place = |at: usize| (0..5).map(|i| f32::from(u8::from(i == at))).collect::<Row>();
    let replay = Replay::new(10_000).spanning(2).prioritised(PriorityConfig::default());
    let mut practice: Practice = Practice::new(replay, Pace { updates_per_step: 1.0, warm_up: 100 });
    let mut all = Experience::new(10_000);
    let (mut at, mut rng) = (0, Seed(2).stream("walk", 0));
    all.begin(&place(at));
    for step in 0..u64::from(steps) {
        let action = rng.random_range(0..2);
        let next = if action == 1 { at + 1 } else { at.saturating_sub(1) };
        let end = (next == 4).then_some(End::Terminated);
        let reward = if next == 4 { 1.0 } else { 0.0 };
        all.push(&Transition { before: &place(at), action: &action, reward, after: &place(next), end });
        practice.push(Lesson::task(all.latest(), all.length(all.latest()) - 1));
        practice.step(config.batch, &all, &mut ctx(step), |clips, ctx| learner.learn(clips, ctx));
        at = next;
        if end.is_some() {
            at = 0;
            all.begin(&place(at));
        }
    }
    [3, 2].map(|at| learner.action_values(&place(at), None::<&()>))
}

#[test]
fn the_values_of_a_walk_are_found_through_replay() {
    let config = DqnConfig { follow_every: 50, tau: 1.0, ..small() };
    let atoms = AtomsConfig { number: 21, low: 0.0, high: 1.0 };
    for config in [config.clone(), DqnConfig { atoms, noise: 0.1, ..config }] {
        let [last, before] = walked(&config, 2500);
        // Two steps of returns walk back as the walker did: only what attains it at once is sure.
        assert!((last[1] - 1.0).abs() < 0.05, "{last:?}");
        assert!(last[1] > last[0] + 0.1 && before[1] > before[0] + 0.05, "{last:?} {before:?}");
    }
}

#[test]
fn a_restored_learner_goes_on_to_the_same_bits() {
    for config in [DqnConfig { follow_every: 7, ..small() }, DqnConfig { follow_every: 7, ..noisy_atoms() }] {
        let lessons = [(vec![0.3, -0.2], [1.0, -1.0]), (vec![-0.9, 0.4], [0.0, 0.5])];
        let mut one = learner(&config);
        teach(&mut one, &lessons, 20);
        let mut two = learner(&config);
        two.load(&saved(&one)).unwrap();
        assert!(saved(&two) == saved(&one) && two.updates() == 20);
        teach(&mut one, &lessons, 20);
        teach(&mut two, &lessons, 20);
        assert!(saved(&two) == saved(&one));
        let other = learner(&DqnConfig { head: 10, ..config });
        assert!(other.clone().load(&saved(&one)).is_err(), "another network's numbers do not fit");
    }
}
