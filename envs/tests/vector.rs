//! Vector environments: the same as stepping each copy alone, for any number of threads.

use inroads_envs::{
    Domain, End, Environment, Frame, Refused, Seed, TimeLimit,
    corridor::Corridor,
    registry::{self, AnyEnvironment},
    vector::{AutoReset, Row, VectorEnvironment, VectorError},
    world::{Layout, Pictured},
};
use inroads_sim::raster::Format;
use rand::RngExt;

#[allow(unreachable_pub, dead_code)] // also a part of the library's own tests
#[path = "support/nine.rs"]
mod nine;

type Vectors = Box<dyn Domain<Vec<f32>, Vec<f32>>>;

fn make(name: &str) -> Vectors {
    match registry::make(name) {
        Ok(AnyEnvironment::Vectors(env)) => env,
        _ => panic!("{name} is walked with vectors"),
    }
}

/// Actions of all copies at a step.
fn actions(env: &Vectors, copies: usize, step: u64) -> Vec<Vec<f32>> {
    let mut rng = Seed(9).stream("actions", step);
    let mut one = || (0..env.spec().action.len()).map(|_| rng.random_range(-1.0..=1.0)).collect();
    (0..copies).map(|_| one()).collect()
}

/// All that a batch says, as bits and words.
fn trace<E>(
    mut envs: VectorEnvironment<E>,
    steps: u64,
    actions: impl Fn(u64) -> Vec<E::Action>,
) -> Vec<String>
where
    E: Environment<Observation: Row, Action: inroads_envs::vector::Admissible + Sync> + Send,
{
    let mut told = vec![format!("{:?}", envs.batch())];
    for step in 0..steps {
        let batch = envs.step(&actions(step)).unwrap();
        let rewards: Vec<_> = batch.rewards().iter().map(|x| x.to_bits()).collect();
        let lasts: Vec<_> = (0..rewards.len()).map(|copy| batch.last(copy)).collect();
        let (seen, ends, began) = (batch.observations(), batch.ends(), batch.began());
        // Debug tells a float's bits, but for those of a NaN.
        told.push(format!("{seen:?} {rewards:?} {ends:?} {began:?} {lasts:?}"));
    }
    told
}

#[test]
fn every_copy_does_what_it_would_do_alone() {
    const COPIES: usize = 3;
    let mut envs =
        VectorEnvironment::new((0..COPIES).map(|_| make("point-corridor")).collect(), 5, AutoReset::SameStep)
            .unwrap();
    let mut alone: Vec<_> = (0..COPIES).map(|_| make("point-corridor")).collect();
    let mut episodes = [0; COPIES];
    let mut seen = Vec::new();
    let mut begin = |copy: usize, env: &mut Vectors| {
        env.reset(Seed(Seed(5).number("copy", copy as u64)).number("episode", episodes[copy]));
        episodes[copy] += 1;
    };
    alone.iter_mut().enumerate().for_each(|(copy, env)| begin(copy, env));
    for step in 0..1000 {
        let actions = actions(&alone[0], COPIES, step);
        let batch = envs.step(&actions).unwrap();
        for (copy, env) in alone.iter_mut().enumerate() {
            let answer = env.step(&actions[copy]).unwrap();
            assert_eq!((batch.rewards()[copy], batch.ends()[copy]), (answer.reward, answer.end));
            env.observe(&mut seen);
            assert_eq!(batch.last(copy), answer.end.map(|_| &seen[..]));
            if answer.end.is_some() {
                begin(copy, env);
                env.observe(&mut seen);
            }
            assert_eq!((batch.observation(copy), batch.began()[copy]), (&seen[..], answer.end.is_some()));
        }
    }
    assert!(episodes.iter().all(|&episodes| episodes > 3), "{episodes:?}");
}

#[test]
fn copies_and_episodes_have_streams_of_their_own() {
    let make = |count| (0..count).map(|_| make("point-corridor")).collect();
    let mut three = VectorEnvironment::new(make(3), 1, AutoReset::Off).unwrap();
    let firsts: Vec<_> = (0..3).map(|copy| three.batch().observation(copy).to_vec()).collect();
    assert!(firsts[0] != firsts[1] && firsts[1] != firsts[2]);
    let five = VectorEnvironment::new(make(5), 1, AutoReset::Off).unwrap();
    assert_eq!(
        five.batch().observation(1),
        firsts[1],
        "a copy's stream does not depend on the number of copies"
    );
    let again = three.restart(&[1]).unwrap();
    assert!(again.observation(1) != firsts[1] && again.observation(0) == firsts[0]);
    let other = VectorEnvironment::new(make(1), 2, AutoReset::Off).unwrap();
    assert_ne!(other.batch().observation(0), firsts[0]);
}

/// Two corridors of three cells; the first copy arrives at its second step.
fn two(auto: AutoReset) -> VectorEnvironment<Corridor> {
    VectorEnvironment::new(vec![Corridor::new(3); 2], 0, auto).unwrap()
}

#[test]
fn without_auto_reset_an_episode_waits_for_its_restart() {
    let mut envs = two(AutoReset::Off);
    envs.step(&[1, 0]).unwrap();
    let batch = envs.step(&[1, 0]).unwrap();
    assert_eq!((batch.ends(), batch.observations()), (&[Some(End::Terminated), None][..], &[2.0, 0.0][..]));
    assert_eq!((batch.last(0), batch.began()), (Some(&[2.0][..]), &[false, false][..]));
    let over = VectorError::Refused { copy: 0, refused: Refused::Over };
    assert_eq!(envs.step(&[1, 1]).err(), Some(over));
    assert_eq!(envs.batch().observation(1), [0.0], "no copy was stepped");
    assert_eq!(envs.restart(&[0, 2]).err(), Some(VectorError::NoCopy { copy: 2, count: 2 }));
    let batch = envs.restart(&[0]).unwrap();
    assert_eq!((batch.observations(), batch.began()), (&[0.0, 0.0][..], &[true, false][..]));
    assert_eq!(envs.step(&[1, 1]).unwrap().observations(), [1.0, 1.0]);
}

#[test]
fn in_the_same_step_the_next_episode_begins_and_the_last_observation_is_kept() {
    let mut envs = two(AutoReset::SameStep);
    envs.step(&[1, 0]).unwrap();
    let batch = envs.step(&[1, 0]).unwrap();
    assert_eq!((batch.observations(), batch.began()), (&[0.0, 0.0][..], &[true, false][..]));
    assert_eq!((batch.rewards(), batch.last(0), batch.last(1)), (&[0.0, -1.0][..], Some(&[2.0][..]), None));
    let batch = envs.step(&[1, 1]).unwrap();
    assert_eq!(
        (batch.observations(), batch.ends(), batch.last(0)),
        (&[1.0, 1.0][..], &[None, None][..], None)
    );
}

#[test]
fn in_the_next_step_the_next_episode_begins_and_the_action_is_ignored() {
    let mut envs = two(AutoReset::NextStep);
    envs.step(&[1, 0]).unwrap();
    let batch = envs.step(&[1, 0]).unwrap();
    assert_eq!((batch.observations(), batch.began()), (&[2.0, 0.0][..], &[false, false][..]));
    assert_eq!(batch.last(0), Some(&[2.0][..]));
    let batch = envs.step(&[1, 1]).unwrap();
    assert_eq!((batch.observations(), batch.began()), (&[0.0, 1.0][..], &[true, false][..]));
    assert_eq!((batch.rewards(), batch.ends(), batch.last(0)), (&[0.0, -1.0][..], &[None, None][..], None));
    assert_eq!(envs.step(&[1, 1]).unwrap().observations(), [1.0, 2.0]);
}

#[test]
fn errors_name_the_copy_and_step_nothing() {
    let mut envs =
        VectorEnvironment::new((0..3).map(|_| make("point-maze")).collect(), 0, AutoReset::SameStep).unwrap();
    let before = envs.batch().clone();
    let error = envs.step(&[vec![0.5, 0.0], vec![0.5, 0.0], vec![0.0, f32::NAN]]).unwrap_err();
    assert_eq!(error.to_string(), "copy 2: action component 1 is NaN; actions must be finite numbers");
    assert_eq!(envs.step(&[vec![0.0, 0.0]]).err(), Some(VectorError::Actions { expected: 3, found: 1 }));
    assert_eq!(*envs.batch(), before);
    let mixed = vec![make("point-maze"), make("point-maze"), make("point-maze-small-steps")];
    assert_eq!(VectorEnvironment::new(mixed, 0, AutoReset::Off).err(), Some(VectorError::Unlike { copy: 2 }));
    assert_eq!(VectorEnvironment::<Vectors>::new(vec![], 0, AutoReset::Off).err(), Some(VectorError::Empty));
}

#[test]
fn the_same_seed_gives_the_same_batches() {
    for auto in [AutoReset::SameStep, AutoReset::NextStep] {
        let play = || {
            let envs =
                VectorEnvironment::new((0..5).map(|_| make("point-corridor")).collect(), 3, auto).unwrap();
            let like = make("point-corridor");
            trace(envs, 400, |step| actions(&like, 5, step))
        };
        assert_eq!(play(), play());
    }
}

/// Nine cells as pictures, 12 × 12 in colour.
fn pictures(copies: usize) -> Vec<TimeLimit<Pictured<nine::Nine>>> {
    let picture =
        || Pictured::new(nine::Nine::new(true), Layout::Random, Format::NATIVE).expect("as large as it is");
    (0..copies).map(|_| TimeLimit::new(picture(), 12)).collect()
}

/// Choices of all copies at a step.
fn choices(copies: usize, step: u64) -> Vec<usize> {
    let mut rng = Seed(9).stream("choices", step);
    (0..copies).map(|_| rng.random_range(0..4)).collect()
}

#[test]
fn pictures_of_copies_lie_one_after_the_other_and_are_those_of_each_alone() {
    const COPIES: usize = 4;
    let mut envs = VectorEnvironment::new(pictures(COPIES), 5, AutoReset::SameStep).unwrap();
    let mut alone = pictures(COPIES);
    let mut episodes = [0; COPIES];
    let mut begin = |copy: usize, env: &mut TimeLimit<_>| {
        env.reset(Seed(Seed(5).number("copy", copy as u64)).number("episode", episodes[copy]));
        episodes[copy] += 1;
    };
    alone.iter_mut().enumerate().for_each(|(copy, env)| begin(copy, env));
    let mut frame = Frame::default();
    for step in 0..200 {
        let choices = choices(COPIES, step);
        let batch = envs.step(&choices).unwrap();
        assert_eq!((batch.width(), batch.observations().len()), (12 * 12 * 3, COPIES * 12 * 12 * 3));
        for (copy, env) in alone.iter_mut().enumerate() {
            let answer = env.step(&choices[copy]).unwrap();
            env.observe(&mut frame);
            assert_eq!((batch.rewards()[copy], batch.ends()[copy]), (answer.reward, answer.end));
            assert_eq!(batch.last(copy), answer.end.map(|_| frame.bytes()));
            if answer.end.is_some() {
                begin(copy, env);
                env.observe(&mut frame);
            }
            assert_eq!(batch.observation(copy), frame.bytes());
            assert_eq!(batch.observations()[copy * batch.width()..][..batch.width()], *frame.bytes());
        }
    }
    assert!(episodes.iter().all(|&episodes| episodes > 10), "{episodes:?}");
}

#[cfg(feature = "threads")]
#[test]
fn the_batches_are_the_same_for_any_number_of_threads() {
    for (name, copies, steps) in
        [("point-corridor", 7, 400), ("point-lock-and-key", 3, 200), ("ant-u-maze", 6, 40)]
    {
        let like = make(name);
        let play = |threads| {
            let envs =
                VectorEnvironment::new((0..copies).map(|_| make(name)).collect(), 3, AutoReset::SameStep);
            trace(envs.unwrap().on_threads(threads).unwrap(), steps, |step| actions(&like, copies, step))
        };
        let one = play(1);
        for threads in [2, 3, 8] {
            assert_eq!(play(threads), one, "{name} on {threads} threads");
        }
    }
}

#[cfg(feature = "threads")]
#[test]
fn the_pictures_are_the_same_for_any_number_of_threads() {
    for (copies, auto) in [(7, AutoReset::SameStep), (4, AutoReset::NextStep), (1, AutoReset::SameStep)] {
        let play = |threads| {
            let envs = VectorEnvironment::new(pictures(copies), 3, auto).unwrap();
            trace(envs.on_threads(threads).unwrap(), 200, |step| choices(copies, step))
        };
        let one = play(1);
        for threads in [2, 3] {
            assert_eq!(play(threads), one, "{copies} copies on {threads} threads");
        }
    }
}
