use super::*;
use crate::encode::Select;
use crate::experience::Rewards;
use crate::{Bag, Checkpoint};
use inroads_envs::Seed;

fn small() -> Td3Config {
    Td3Config {
        hidden: vec![32, 24],
        actor_rate: 1e-3,
        critic_rate: 3e-3,
        tau: 0.05,
        batch: 64,
        ..Td3Config::default()
    }
}

fn learner(config: &Td3Config, goal: usize) -> Td3<Vec<f32>> {
    let weights = &mut Seed(3).stream("weights", 0);
    Td3::new(Arc::new(Select::new(&[0, 1])), goal, 1, config, Backend::of_tests(), weights)
}

fn saved(learner: &Td3<Vec<f32>>) -> Bag {
    let mut bag = Bag::default();
    learner.save(&mut bag);
    bag
}

/// The numbers of one of its networks.
fn weights(learner: &Td3<Vec<f32>>, part: &str) -> Vec<Vec<f32>> {
    let mut bag = Bag::default();
    learner.nets.save(&mut bag);
    bag.get(part).unwrap()
}

/// Update number `index` of a bandit: r = −(a − 0.3)², and the episode terminates.
fn bandit(learner: &mut Td3<Vec<f32>>, index: u64) -> Learned {
    let mut ctx = Context::training(Seed(7), index);
    let observations = [vec![0.2, -0.4], vec![0.1, 0.9]];
    let actions: Vec<[Vec<f32>; 1]> = (0..64).map(|_| [vec![ctx.learning.random_range(-1.0..1.0)]]).collect();
    let rewards: Vec<_> = actions.iter().map(|action| [-(action[0][0] - 0.3).powi(2)]).collect();
    let clips: Vec<_> = actions
        .iter()
        .zip(&rewards)
        .map(|(action, reward)| Clip::new(&observations, action, Rewards::Given(reward), None::<&()>, true))
        .collect();
    learner.learn(&clips, &mut ctx)
}

fn greedy(learner: &Td3<Vec<f32>>) -> f32 {
    let mut ctx = Context::evaluation(Seed(0), 0);
    learner.act(&mut Memory::new(), &vec![0.2, -0.4], None::<&()>, &mut ctx)[0]
}

#[test]
fn the_target_believes_the_lesser_critic_and_only_a_termination_cuts_it() {
    // Critics that say 2 and 1 whatever they see.
    let mut learner = learner(&small(), 0);
    let mut bag = Bag::default();
    learner.nets.save(&mut bag);
    let mut critics: Vec<Vec<f32>> = bag.get("target critic").unwrap();
    critics.iter_mut().for_each(|values| values.fill(0.0));
    let biases: Vec<_> = critics.iter_mut().filter(|values| values.len() == 1).collect();
    assert_eq!(biases.len(), 2);
    biases.into_iter().zip([2.0, 1.0]).for_each(|(bias, value)| bias[0] = value);
    bag.put("target critic", &critics);
    learner.nets.load(&bag).unwrap();

    // The third is a truncation, which a clip does not call terminal.
    let (observations, action) = ([vec![0.0, 0.0], vec![0.0, 0.0]], [vec![0.0]]);
    let clips = [false, true, false]
        .map(|terminal| Clip::new(&observations, &action, Rewards::Given(&[-1.0]), None::<&()>, terminal));
    let y = learner.targets(&clips, &mut Context::training(Seed(0), 0));
    assert!((y[0] + 0.01).abs() < 1e-6 && y[1] == -1.0 && y[2] == y[0], "{y:?}");
}

#[test]
fn smoothing_is_clipped_and_actions_stay_in_range() {
    let config = Td3Config { smoothing: 10.0, ..small() };
    let mut rng = Seed(0).stream("test", 0);
    let mut actions = vec![0.2; 1000];
    config.smooth(&mut actions, &mut rng);
    assert!(actions.iter().all(|action| (action - 0.2).abs() <= 0.5 + 1e-6));
    assert!(actions.iter().any(|action| (action - 0.7).abs() < 1e-6));
    let mut actions = vec![0.9; 1000];
    config.smooth(&mut actions, &mut rng);
    assert!(actions.iter().all(|action| (0.4 - 1e-6..=1.0).contains(action)) && actions.contains(&1.0));
}

#[test]
fn actor_and_targets_move_with_every_second_update_and_targets_by_tau() {
    let mut learner = learner(&Td3Config { tau: 0.005, ..small() }, 0);
    let slow = ["actor", "target actor", "target critic"];
    let before = slow.map(|part| weights(&learner, part));
    let critic = weights(&learner, "critic");
    bandit(&mut learner, 0);
    assert_eq!(slow.map(|part| weights(&learner, part)), before);
    assert_ne!(weights(&learner, "critic"), critic);

    bandit(&mut learner, 1);
    for (part, before) in slow.iter().zip(&before) {
        assert_ne!(&weights(&learner, part), before, "{part}");
    }
    for (network, old) in [("actor", &before[1]), ("critic", &before[2])] {
        let (online, target) = (weights(&learner, network), weights(&learner, &format!("target {network}")));
        for ((new, old), online) in target.concat().iter().zip(old.concat()).zip(online.concat()) {
            assert!((new - (0.995 * old + 0.005 * online)).abs() < 1e-7, "{network}: {new} {old} {online}");
        }
    }
}

#[test]
fn it_solves_a_bandit() {
    let mut learner = learner(&small(), 0);
    let first = bandit(&mut learner, 0).loss;
    let last = (1..1500).map(|index| bandit(&mut learner, index).loss).last().unwrap();
    assert!((greedy(&learner) - 0.3).abs() < 0.05, "{}", greedy(&learner));
    assert!(last < first / 10.0, "{first} {last}");
}

#[test]
fn a_goal_is_joined_to_the_observation_before_and_after_a_step() {
    struct Bit(f32);
    impl Encode for Bit {
        fn width(&self) -> usize {
            1
        }

        fn write(&self, out: &mut [f32]) {
            out[0] = self.0;
        }
    }
    // Every step leads back to where it began. On the way to one goal it pays 1 and to the other nothing, for ever: with
    // γ = 0.5 that is worth 2 and 0, and only where both states are read with the same goal.
    let mut learner = learner(&Td3Config { discount: 0.5, ..small() }, 1);
    let goals = [Bit(1.0), Bit(-1.0)];
    let (observations, action) = ([vec![0.2, -0.4], vec![0.2, -0.4]], [vec![0.1]]);
    let clip = |goal: usize| {
        let rewards = Rewards::Given(if goal == 0 { &[1.0] } else { &[0.0] });
        Clip::new(&observations, &action, rewards, Some(&goals[goal]), false)
    };
    let clips: Vec<_> = (0..32).map(|i| clip(i % 2)).collect();
    (0..800).for_each(|i| _ = learner.learn(&clips, &mut Context::training(Seed(0), i)));
    let values = learner.values(&Memory::new(), &observations[0], &[Some(&goals[0]), Some(&goals[1])]);
    assert!((values[0] - 2.0).abs() < 0.3 && values[1].abs() < 0.3, "{values:?}");
}

#[test]
fn weights_scale_the_loss_and_the_greater_error_is_told() {
    let (mut light, mut none) = (learner(&small(), 0), learner(&small(), 0));
    let before = weights(&none, "critic");
    let (observations, action) = ([vec![0.2, -0.4], vec![0.2, -0.4]], [vec![0.1]]);
    let clip = Clip::new(&observations, &action, Rewards::Given(&[5.0]), None::<&()>, true);
    let mut ctx = Context::training(Seed(0), 0);
    let learned = none.learn(&[Clip { weight: 0.0, ..clip }], &mut ctx);
    assert_eq!(weights(&none, "critic"), before, "a clip of no weight teaches nothing");
    assert_eq!(learned.errors.len(), 1);
    assert!((learned.errors[0] + 5.0).abs() < 0.1, "errors are told without weights: {learned:?}");
    assert!((learned.loss - 50.0).abs() < 1.0, "the sum of both critics'");
    light.learn(&[clip], &mut ctx);
    assert_ne!(weights(&light, "critic"), before);
}

#[test]
fn the_same_seed_gives_the_same_bits_and_a_saved_run_goes_on_as_if_never_stopped() {
    let (mut one, mut two) = (learner(&small(), 0), learner(&small(), 0));
    for index in 0..51 {
        bandit(&mut one, index);
        bandit(&mut two, index);
    }
    assert!(saved(&one) == saved(&two));
    assert_eq!(one.updates(), 51);

    let other = &mut Seed(99).stream("weights", 0);
    let encoder = Arc::new(Select::new(&[0, 1]));
    let mut resumed = Td3::new(encoder, 0, 1, &small(), Backend::of_tests(), other);
    assert!(saved(&resumed) != saved(&one));
    resumed.load(&saved(&one)).unwrap();
    // Stopped between two updates of the actor, so the number of updates is part of what is saved.
    for index in 51..60 {
        bandit(&mut one, index);
        bandit(&mut resumed, index);
    }
    assert!(saved(&resumed) == saved(&one));
}

#[test]
fn it_explores_uniformly_until_it_has_learned_and_with_noise_then() {
    let mut learner = learner(&small(), 0);
    let act = |learner: &Td3<Vec<f32>>, index| {
        let mut ctx = Context::training(Seed(0), index);
        learner.act(&mut Memory::new(), &vec![0.2, -0.4], None::<&()>, &mut ctx)[0]
    };
    let wide = |learner: &Td3<Vec<f32>>| (0..200).filter(|i| act(learner, *i).abs() > 0.6).count();
    assert!((wide(&learner) as i64 - 80).abs() < 28, "four standard deviations");
    bandit(&mut learner, 0);
    assert!(greedy(&learner).abs() < 0.1 && wide(&learner) == 0);
    learner.config.random = 0.5;
    assert!((wide(&learner) as i64 - 40).abs() < 23);
}

#[test]
fn several_act_together_as_each_would_alone() {
    let mut learner = learner(&small(), 0);
    bandit(&mut learner, 0);
    let states = [vec![0.2, -0.4], vec![0.9, 0.3], vec![-0.5, 0.1]];
    let contexts =
        || [Context::training(Seed(0), 1), Context::training(Seed(0), 2), Context::evaluation(Seed(0), 3)];
    let (mut memories, mut ctxs) = ([const { Memory::new() }; 3], contexts());
    let mut lanes: Vec<Lane<'_, Vec<f32>, ()>> = memories
        .iter_mut()
        .zip(&states)
        .zip(&mut ctxs)
        .map(|((memory, s), ctx)| Lane { memory, s, goal: None, ctx })
        .collect();
    let together = learner.act_all(&mut lanes);
    for ((s, ctx), found) in states.iter().zip(&mut contexts()).zip(together) {
        let alone = learner.act(&mut Memory::new(), s, None::<&()>, ctx);
        assert!((alone[0] - found[0]).abs() < 1e-5, "{alone:?} {found:?}");
    }
}

#[test]
fn settings_are_checked() {
    assert_eq!(Td3Config::default().check(), Ok(()));
    let wrong = |config: Td3Config| config.check().unwrap_err();
    assert!(wrong(Td3Config { delay: 0, ..small() }).contains("delay"));
    assert!(wrong(Td3Config { random: 1.5, ..small() }).contains("random"));
    assert!(wrong(Td3Config { smoothing: -1.0, ..small() }).contains("smoothing"));
    assert!(serde_json::from_str::<Td3Config>("{\"taw\": 1}").unwrap_err().to_string().contains("taw"));
}

#[cfg(feature = "ndarray")]
#[test]
fn both_backends_learn_alike() {
    let of = |backend| {
        let weights = &mut Seed(3).stream("weights", 0);
        Td3::new(Arc::new(Select::new(&[0, 1])), 0, 1, &small(), backend, weights)
    };
    let (mut flex, mut ndarray) = (of(Backend::Flex), of(Backend::NdArray));
    for index in 0..20 {
        let (a, b) = (bandit(&mut flex, index).loss, bandit(&mut ndarray, index).loss);
        assert!((a - b).abs() < 1e-4 * (1.0 + a.abs()), "update {index}: {a} {b}");
    }
    assert!((greedy(&flex) - greedy(&ndarray)).abs() < 1e-3);
}
