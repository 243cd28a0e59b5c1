//! The oracles of `algorithms.md`, section 14, "Model-based", and what an agent needs beside them.

use std::sync::Arc;

use inroads_envs::{End, Goal, Seed};
use rand::RngExt;

use super::*;
use crate::{Actor, Agent, Bag, Checkpoint, Context, Experience, Memory, Transition, nets::Backend};

/// A model whose states are `width` numbers and whose actions are one.
struct Exact(usize, fn(&[f32], f32) -> Vec<f32>);

impl Predict for Exact {
    fn actions(&self) -> usize {
        1
    }

    fn next(&self, states: &[f32], actions: &[f32]) -> Vec<f32> {
        states.chunks_exact(self.0).zip(actions).flat_map(|(s, &a)| self.1(s, a)).collect()
    }
}

/// Place and speed under a force, a tenth of a second a step.
fn double_integrator(s: &[f32], a: f32) -> Vec<f32> {
    let speed = s[1] + 0.1 * a;
    vec![s[0] + 0.1 * speed, speed]
}

/// Two coupled, damped numbers that an action pushes.
fn linear(s: &[f32], a: f32) -> Vec<f32> {
    vec![0.9 * s[0] + 0.2 * s[1], -0.1 * s[0] + 0.8 * s[1] + 0.5 * a]
}

fn place(at: f32, tolerance: f32) -> Goal {
    Goal { dims: vec![0], at: vec![at], tolerance }
}

/// Episodes of random actions, each begun at random within ±1.
fn walks(step: fn(&[f32], f32) -> Vec<f32>, episodes: u64, steps: usize) -> Experience<Vec<f32>, Vec<f32>> {
    let mut all = Experience::new(1_000_000);
    for number in 0..episodes {
        let mut rng = Seed(5).stream("walk", number);
        let mut before: Vec<f32> = (0..2).map(|_| rng.random_range(-1.0..1.0)).collect();
        all.begin(&before);
        for i in 1..=steps {
            let action = vec![rng.random_range(-1.0..=1.0)];
            let after = step(&before, action[0]);
            let end = (i == steps).then_some(End::Truncated);
            all.push(&Transition { before: &before, action: &action, reward: 0.0, after: &after, end });
            before = after;
        }
    }
    all
}

fn small() -> DynamicsConfig {
    DynamicsConfig { hidden: vec![32], rate: 5e-3, batch: 64, ..DynamicsConfig::default() }
}

fn model(config: &DynamicsConfig, seed: u64) -> Dynamics {
    let view = Arc::new(Plain::new(&[false; 2], &[]));
    Dynamics::new(view, 1, config, Backend::of_tests(), &mut Seed(seed).stream("weights", 0))
}

#[test]
fn a_linear_system_is_learned_one_step_ahead_and_ten() {
    for models in [1, 2] {
        let mut model = model(&DynamicsConfig { models, ..small() }, 1);
        let fit = model.fit(&walks(linear, 50, 40), 40, &mut Seed(1).stream("fit", 0));
        assert_eq!(fit.steps, 45 * 40);
        assert!(fit.held_out.unwrap() < 1e-3, "R² is {}", 1.0 - fit.held_out.unwrap());
        let mut rng = Seed(2).stream("rollouts", 0);
        let (mut wrong, mut moved) = (0.0, 0.0);
        for _ in 0..50 {
            let start: Vec<f32> = (0..2).map(|_| rng.random_range(-1.0..1.0)).collect();
            let (mut guess, mut truth) = (start.clone(), start.clone());
            for _ in 0..10 {
                let action = rng.random_range(-1.0..=1.0);
                guess = model.next(&guess, &[action]);
                truth = linear(&truth, action);
            }
            let far = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f32>();
            wrong += far(&guess, &truth);
            moved += far(&start, &truth);
        }
        let share = (wrong / moved).sqrt();
        assert!(share < 0.05, "ten steps ahead it errs by {share} of the way");
    }
}

/// Steps to the goal at 1 with the exact model, at most 100.
fn steps_to_one(planner: &dyn Planner) -> usize {
    let (model, goal) = (Exact(2, double_integrator), place(1.0, 0.05));
    let objective = Reach { goal: &goal, reward: Reward::Dense, values: None };
    let (mut s, mut memory, mut rng) = (vec![0.0, 0.0], Memory::new(), Seed(3).stream("plan", 0));
    for step in 0..100 {
        if goal.reached(&s) {
            return step;
        }
        let plan =
            planner.plan(&Problem { model: &model, objective: &objective, s: &s }, &mut memory, &mut rng);
        s = double_integrator(&s, plan[0]);
    }
    100
}

#[test]
fn both_planners_take_a_double_integrator_to_its_goal() {
    // Full force all the way takes 14 steps.
    let (refining, shooting) =
        (Refining::default(), Shooting { horizon: 15, candidates: 500, discount: 0.95 });
    let (refined, shot) = (steps_to_one(&refining), steps_to_one(&shooting));
    assert!((14..=18).contains(&refined), "{refined}");
    assert!((14..=40).contains(&shot), "{shot}");
}

#[test]
fn a_value_of_nothing_changes_no_plan() {
    let (model, goal) = (Exact(2, double_integrator), place(1.0, 0.05));
    let nothing = |states: &[f32]| vec![0.0; states.len() / 2];
    let planners: [&dyn Planner; 2] =
        [&Refining::default(), &Shooting { candidates: 50, ..Shooting::default() }];
    for planner in planners {
        let plan = |values: Option<Values<'_>>| {
            let objective = Reach { goal: &goal, reward: Reward::Dense, values };
            let problem = Problem { model: &model, objective: &objective, s: &[0.3, -0.2] };
            planner.plan(&problem, &mut Memory::new(), &mut Seed(4).stream("plan", 0))
        };
        assert_eq!(plan(None), plan(Some(&nothing)));
    }
}

#[test]
fn beyond_the_horizon_a_sparse_reward_moves_nobody_and_a_value_does() {
    let (model, goal) = (Exact(1, |s, a| vec![s[0] + 0.1 * a]), place(10.0, 0.1));
    let steps_to_go = |states: &[f32]| states.iter().map(|x| (x - 10.0) / 0.1).collect::<Vec<f32>>();
    let shooting = Shooting { horizon: 3, candidates: 100, discount: 1.0 };
    let refining = Refining { horizon: 3, ..Refining::default() };
    let first = |planner: &dyn Planner, values: Option<Values<'_>>, i: u64| {
        let objective = Reach { goal: &goal, reward: Reward::Sparse, values };
        let problem = Problem { model: &model, objective: &objective, s: &[0.0] };
        planner.plan(&problem, &mut Memory::new(), &mut Seed(6).stream("plan", i))[0]
    };
    // Of 400 uniform numbers in four equal bins, each holds 100 ± 5 standard deviations of 8.7.
    let mut bins = [0; 4];
    (0..400).for_each(|i| bins[((first(&shooting, None, i) + 1.0) * 2.0).min(3.0) as usize] += 1);
    assert!(bins.iter().all(|n| (57..=143).contains(n)), "{bins:?}");
    let mean = (0..100).map(|i| first(&refining, None, i)).sum::<f32>() / 100.0;
    assert!(mean.abs() < 0.1, "{mean}");
    assert!((0..20).all(|i| first(&shooting, Some(&steps_to_go), i) > 0.0));
    assert!((0..20).all(|i| first(&refining, Some(&steps_to_go), i) > 0.8));
}

#[test]
fn the_first_predicted_state_has_weight_one_and_the_value_the_horizons_power() {
    struct Place;
    impl Objective for Place {
        fn rewards(&self, states: &[f32], out: &mut [f32]) {
            out.copy_from_slice(states);
        }

        fn values(&self, states: &[f32]) -> Option<Vec<f32>> {
            Some(states.iter().map(|x| 10.0 * x).collect())
        }
    }
    let model = Exact(1, |s, a| vec![s[0] + a]);
    let problem = Problem { model: &model, objective: &Place, s: &[0.0] };
    // Two sequences side by side: (1, 1, 1) and (0, −1, 0).
    let mut both = Candidates::new(2, 3, 1);
    both.numbers().copy_from_slice(&[1.0, 0.0, 1.0, -1.0, 1.0, 0.0]);
    // 1 + ½·2 + ¼·3 + ⅛·30 and 0 − ½ − ¼ − ⅛·10.
    assert_eq!(both.returns(&problem, 0.5), [6.5, -2.0]);
    assert_eq!(both.sequence(1), [0.0, -1.0, 0.0]);
    assert_eq!(Candidates::one(&[0.0, -1.0, 0.0], 1).returns(&problem, 0.5), [-2.0]);
    let lost = Exact(1, |_, _| vec![f32::NAN]);
    assert_eq!(both.returns(&Problem { model: &lost, ..problem }, 0.5), [f32::NEG_INFINITY; 2]);
}

#[test]
fn states_at_the_goal_have_the_greatest_value_and_pay_nothing() {
    let (goal, doubtful) =
        (place(1.0, 0.1), |states: &[f32]| states.iter().map(|x| -x).collect::<Vec<f32>>());
    let states = [1.05, 0.5, 3.0];
    for (reward, paid) in [(Reward::Dense, [0.0, -0.5, -2.0]), (Reward::Sparse, [0.0, -1.0, -1.0])] {
        let reach = Reach { goal: &goal, reward, values: Some(&doubtful) };
        let mut out = [0.0; 3];
        reach.rewards(&states, &mut out);
        assert_eq!(out, paid);
        assert_eq!(reach.values(&states), Some(vec![-0.5, -0.5, -3.0]));
    }
}

/// An agent that has had some random episodes of the double integrator, or not yet all of them.
fn agent(seed: u64) -> Mpc {
    let refining = Refining { candidates: 60, elites: 8, ..Refining::default() };
    let config =
        MpcConfig { dynamics: small(), refining, warm_up: 6, first_epochs: 60, ..MpcConfig::default() };
    assert_eq!(config.check(), Ok(()));
    let view = Arc::new(Plain::new(&[false; 2], &[0]));
    Mpc::new(view, 1, place(1.0, 0.1), &config, Backend::of_tests(), &mut Seed(seed).stream("weights", 0))
}

/// One episode of training of 40 steps; where it ended.
fn train(agent: &mut Mpc, number: u64) -> Vec<f32> {
    let mut ctx = Context::training(Seed(8), number);
    let mut before = vec![0.0, 0.0];
    agent.begin(&before, &mut ctx);
    for i in 1..=40 {
        let action = agent.act(&before, &mut ctx);
        let after = double_integrator(&before, action[0]);
        let end = (i == 40).then_some(End::Truncated);
        let t = Transition { before: &before, action: &action, reward: 0.0, after: &after, end };
        agent.observe(&t, &mut ctx);
        before = after;
    }
    before
}

#[test]
fn an_agent_plans_with_what_it_has_learned_and_towards_any_goal() {
    let mut agent = agent(1);
    (0..6).for_each(|number| _ = train(&mut agent, number));
    assert_eq!((agent.updates(), agent.last_fit().steps), (vec![("model", 1)], 240));
    for at in [1.0, -1.0] {
        let mut planning = agent.towards(place(at, 0.1));
        let (mut s, mut ctx) = (vec![0.0, 0.0], Context::evaluation(Seed(9), 0));
        planning.begin(&s, &mut ctx);
        let there = (0..60).any(|_| {
            s = double_integrator(&s, planning.act(&s, &mut ctx)[0]);
            (s[0] - at).abs() <= 0.1
        });
        assert!(there, "{s:?} is not {at}");
    }
}

#[test]
fn a_saved_agent_goes_on_to_the_same_bits() {
    let mut one = agent(1);
    (0..7).for_each(|number| _ = train(&mut one, number));
    let saved = |agent: &Mpc| {
        let mut bag = Bag::default();
        agent.save(&mut bag);
        bag
    };
    let mut resumed = agent(2);
    assert!(saved(&resumed) != saved(&one));
    resumed.load(&saved(&one)).unwrap();
    let (a, b) = (train(&mut one, 7), train(&mut resumed, 7));
    assert_eq!(a, b);
    assert!(saved(&one) == saved(&resumed));
}

#[test]
fn impossible_settings_are_named() {
    let wrong = |config: MpcConfig| config.check().unwrap_err();
    let dynamics = |change: fn(&mut DynamicsConfig)| {
        let mut config = MpcConfig::default();
        change(&mut config.dynamics);
        wrong(config)
    };
    assert!(dynamics(|d| d.hidden = vec![0]).contains("dynamics.hidden"));
    assert!(dynamics(|d| d.batch = 0).contains("dynamics.batch"));
    assert!(dynamics(|d| d.held_out = 1).contains("held_out"));
    assert!(dynamics(|d| d.rate = 0.0).contains("rate"));
    assert!(dynamics(|d| d.slope = 2.0).contains("slope"));
    let refining = |refining| wrong(MpcConfig { refining, ..MpcConfig::default() });
    assert!(refining(Refining { elites: 0, ..Refining::default() }).contains("refining.elites"));
    assert!(refining(Refining { rounds: 0, ..Refining::default() }).contains("refining.rounds"));
    assert!(refining(Refining { deviation: 0.0, ..Refining::default() }).contains("refining.deviation"));
    assert!(refining(Refining { smoothing: 1.0, ..Refining::default() }).contains("refining.smoothing"));
    assert!(refining(Refining { discount: 2.0, ..Refining::default() }).contains("refining.discount"));
    let shooting = |shooting| wrong(MpcConfig { shooting, ..MpcConfig::default() });
    assert!(shooting(Shooting { horizon: 0, ..Shooting::default() }).contains("shooting.horizon"));
    assert!(shooting(Shooting { candidates: 0, ..Shooting::default() }).contains("shooting.candidates"));
    assert!(wrong(MpcConfig { hold: 0, ..MpcConfig::default() }).contains("hold"));
    assert!(wrong(MpcConfig { epsilon: 2.0, ..MpcConfig::default() }).contains("epsilon"));
}
