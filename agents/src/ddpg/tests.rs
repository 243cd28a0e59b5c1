use super::*;
use crate::experience::Rewards;
use crate::{Bag, Checkpoint};
use inroads_envs::Seed;
use rand::RngExt;

struct Row;

impl Encoder<Vec<f32>> for Row {
    fn width(&self) -> usize {
        2
    }

    fn write(&self, observation: &Vec<f32>, out: &mut [f32]) {
        out.copy_from_slice(observation);
    }
}

fn small() -> DdpgConfig {
    DdpgConfig { hidden: vec![32, 24], actor_rate: 1e-3, critic_rate: 3e-3, ..Default::default() }
}

fn learner(config: &DdpgConfig) -> Ddpg<Vec<f32>> {
    Ddpg::new(Arc::new(Row), 1, config, Backend::of_tests(), &mut Seed(3).stream("weights", 0))
}

fn saved(learner: &Ddpg<Vec<f32>>) -> Bag {
    let mut bag = Bag::default();
    learner.save(&mut bag);
    bag
}

/// Update number `index` of a bandit: r = −(a − 0.3)², and the episode terminates.
fn bandit(learner: &mut Ddpg<Vec<f32>>, index: u64) -> f32 {
    let mut ctx = Context::training(Seed(7), index);
    let observations = [vec![0.2, -0.4], vec![0.1, 0.9]];
    let actions: Vec<[Vec<f32>; 1]> = (0..64).map(|_| [vec![ctx.learning.random_range(-1.0..1.0)]]).collect();
    let rewards: Vec<_> = actions.iter().map(|action| [-(action[0][0] - 0.3).powi(2)]).collect();
    let clips: Vec<_> = actions
        .iter()
        .zip(&rewards)
        .map(|(action, reward)| Clip::new(&observations, action, Rewards::Given(reward), None::<&()>, true))
        .collect();
    learner.learn(&clips, &mut ctx).loss
}

fn greedy(learner: &Ddpg<Vec<f32>>) -> f32 {
    let mut ctx = Context::evaluation(Seed(0), 0);
    learner.act(&mut Memory::new(), &vec![0.2, -0.4], None::<&()>, &mut ctx)[0]
}

#[test]
fn only_a_termination_cuts_the_target() {
    // The third is a truncation, which a clip does not call terminal.
    let observations = [Vec::<f32>::new(), vec![]];
    let rewards = Rewards::Given(&[-1.0]);
    let clips = [false, true, false].map(|ends| Clip::new(&observations, &[()], rewards, None::<&()>, ends));
    let y = targets(&clips, 0.99, &[1.0, 1.0, 1.0]);
    assert!((y[0] + 0.01).abs() < 1e-6 && y[1] == -1.0 && y[2] == y[0]);
}

#[test]
fn an_update_whose_loss_is_no_number_changes_nothing_and_is_told() {
    let mut rng = Seed(3).stream("weights", 0);
    let mut learner: Ddpg<Vec<f32>> = Ddpg::new(Arc::new(Row), 1, &small(), Backend::of_tests(), &mut rng);
    bandit(&mut learner, 0);
    let before = saved(&learner);
    let mut ctx = Context::training(Seed(0), 0);
    let observations = [vec![0.2, -0.4], vec![0.1, 0.9]];
    let rewards = Rewards::Given(&[1e30]);
    learner.learn(&[Clip::new(&observations, &[vec![0.5]], rewards, None::<&()>, true)], &mut ctx);
    let what = "loss of the critic";
    assert_eq!(ctx.fault, Some(crate::Fault::Learning { what, value: f32::INFINITY }));
    assert!(saved(&learner) == before);
}

#[test]
fn a_goal_is_read_beside_the_observation_and_none_is_zeros() {
    struct Bit(f32);
    impl Encode for Bit {
        fn width(&self) -> usize {
            1
        }

        fn write(&self, out: &mut [f32]) {
            out[0] = self.0;
        }
    }
    let mut rng = Seed(3).stream("weights", 0);
    let mut learner: Ddpg<Vec<f32>> =
        Ddpg::with_goals(Arc::new(Row), 1, 1, &small(), Backend::of_tests(), &mut rng);
    // The same step is worth 1 to one goal and nothing to the other.
    let (observations, action, goals) =
        ([vec![0.2, -0.4], vec![0.2, -0.4]], [vec![0.1]], [Bit(1.0), Bit(-1.0)]);
    let clip = |goal: usize| {
        let rewards = Rewards::Given(if goal == 0 { &[1.0] } else { &[0.0] });
        Clip::new(&observations, &action, rewards, Some(&goals[goal]), true)
    };
    let clips: Vec<_> = (0..32).map(|i| clip(i % 2)).collect();
    (0..600).for_each(|i| _ = learner.learn(&clips, &mut Context::training(Seed(0), i)));
    let asked = [Some(&goals[0]), Some(&goals[1])];
    let values = learner.values(&Memory::new(), &observations[0], &asked);
    assert!((values[0] - 1.0).abs() < 0.2 && values[1].abs() < 0.2, "{values:?}");
    let none = learner.values(&Memory::new(), &observations[0], &[None, Some(&Bit(0.0))]);
    assert_eq!(none[0], none[1]);
}

#[test]
fn it_solves_a_bandit() {
    let mut learner = learner(&DdpgConfig { hidden: vec![16, 256], critic_rate: 1e-3, ..small() });
    let first = bandit(&mut learner, 0);
    let last = (1..2000).map(|index| bandit(&mut learner, index)).last().unwrap();
    assert!((greedy(&learner) - 0.3).abs() < 0.05, "{}", greedy(&learner));
    assert!(last < first / 10.0, "{first} {last}");
}

#[test]
fn a_bootstrapped_value_approaches_its_fixed_point() {
    // −1 a step for ever, γ = 0.5: the value is −2 everywhere, and a terminal step's is −1.
    let mut learner = learner(&DdpgConfig { discount: 0.5, tau: 0.05, ..small() });
    let (going, ending) = ([vec![0.2, -0.4], vec![0.2, -0.4]], [vec![-0.9, 0.8], vec![0.2, -0.4]]);
    let actions: Vec<[Vec<f32>; 1]> = (0..64).map(|i| [vec![i as f32 / 32.0 - 1.0]]).collect();
    let clip = |i: usize| {
        let states = if i.is_multiple_of(2) { &going } else { &ending };
        Clip::new(states, &actions[i], Rewards::Given(&[-1.0]), None::<&()>, i % 2 == 1)
    };
    let clips: Vec<_> = (0..64).map(clip).collect();
    let loss =
        (0..1500).map(|i| learner.learn(&clips, &mut Context::training(Seed(0), i)).loss).last().unwrap();
    let states = vec![0.2, -0.4, -0.9, 0.8];
    let actions = learner.nets.target_actions(&states);
    let values = learner.nets.target_values(states, actions);
    assert!(loss < 1e-3, "{loss}");
    assert!((values[0] + 2.0).abs() < 0.1 && (values[1] + 1.0).abs() < 0.1, "{values:?}");
}

#[test]
fn the_same_seed_gives_the_same_bits_and_a_saved_run_goes_on_as_if_never_stopped() {
    let (mut one, mut two) = (learner(&small()), learner(&small()));
    for index in 0..50 {
        bandit(&mut one, index);
        bandit(&mut two, index);
    }
    assert!(saved(&one) == saved(&two));
    assert_eq!(one.updates(), 50);

    let other_weights = &mut Seed(99).stream("weights", 0);
    let mut resumed = Ddpg::new(Arc::new(Row), 1, &small(), Backend::of_tests(), other_weights);
    assert!(saved(&resumed) != saved(&one));
    resumed.load(&saved(&one)).unwrap();
    for index in 50..60 {
        bandit(&mut one, index);
        bandit(&mut resumed, index);
    }
    assert!(saved(&resumed) == saved(&one));
}

#[test]
fn a_clone_goes_on_from_all_that_was_learned_and_on_its_own() {
    let mut global = learner(&small());
    (0..5).for_each(|index| _ = bandit(&mut global, index));
    let before = saved(&global);
    let mut option = global.clone();
    assert!(saved(&option) == before);
    bandit(&mut option, 5);
    assert!(saved(&global) == before && saved(&option) != before);
}

#[test]
fn a_checkpoint_of_other_sizes_is_refused_and_named() {
    let wide = learner(&DdpgConfig { hidden: vec![48, 24], ..small() });
    let error = learner(&small()).load(&saved(&wide)).unwrap_err().to_string();
    assert!(error.contains("actor") && error.contains("96"), "{error}");
}

#[test]
fn exploring_adds_noise_and_settings_are_checked() {
    let learner = learner(&small());
    let act = |ctx: &mut Context| learner.act(&mut Memory::new(), &vec![0.2, -0.4], None::<&()>, ctx)[0];
    assert!(greedy(&learner).abs() < 0.1, "actions begin near zero");
    assert_ne!(act(&mut Context::training(Seed(0), 0)), greedy(&learner));

    assert_eq!(DdpgConfig::default().check(), Ok(()));
    let wrong = DdpgConfig { hidden: vec![], ..small() }.check().unwrap_err();
    assert!(wrong.contains("hidden"));
    assert!(serde_json::from_str::<DdpgConfig>("{\"taw\": 1}").unwrap_err().to_string().contains("taw"));
}

#[cfg(feature = "ndarray")]
#[test]
fn both_backends_learn_alike() {
    let weights = || Seed(3).stream("weights", 0);
    let mut flex = Ddpg::new(Arc::new(Row), 1, &small(), Backend::Flex, &mut weights());
    let mut ndarray = Ddpg::new(Arc::new(Row), 1, &small(), Backend::NdArray, &mut weights());
    for index in 0..20 {
        let (a, b) = (bandit(&mut flex, index), bandit(&mut ndarray, index));
        assert!((a - b).abs() < 1e-4 * (1.0 + a.abs()), "update {index}: {a} {b}");
    }
    assert!((greedy(&flex) - greedy(&ndarray)).abs() < 1e-3);
}
