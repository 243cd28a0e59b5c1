use inroads_envs::{Environment, Seed, corridor::Corridor};
use rand::RngExt;

use super::*;
use crate::{
    Bag, Checkpoint,
    experience::{Pay, Rewards},
    goal::Ground,
    mpc::Plain,
};

/// Knows what a place on a line is worth on the way to a goal, where a step goes a tenth at most.
struct Known {
    /// 1: −1 a step. −1: the farther the better.
    sign: f32,
}

checkpoint!([] Known; plain: ; parts: );

impl Learner<Vec<f32>, Vec<f32>, Region> for Known {
    fn act(&self, _: &mut Memory, _: &Vec<f32>, _: Option<&Region>, _: &mut Context) -> Vec<f32> {
        panic!("who is planned for is asked for no actions")
    }

    fn values(&self, _: &Memory, s: &Vec<f32>, goals: &[Option<&Region>]) -> Vec<f32> {
        goals.iter().map(|goal| -10.0 * self.sign * goal.expect("a goal").distance(s)).collect()
    }

    fn learn(&mut self, _: &[Clip<'_, Vec<f32>, Vec<f32>, Region>], _: &mut Context) -> Learned {
        Learned::default()
    }

    fn batch(&self) -> usize {
        128
    }
}

fn goal(at: f32) -> Region {
    Ground::of(Corridor::new(8).spec()).expect("a corridor has bounds").ball(vec![at], 0.05)
}

fn config(reward: Reward, values: bool) -> PlannedConfig {
    let dynamics = DynamicsConfig { hidden: vec![16], rate: 5e-3, ..DynamicsConfig::default() };
    let refining = Refining { horizon: 3, candidates: 40, rounds: 2, elites: 5, ..Refining::default() };
    PlannedConfig { dynamics, refining, reward, values, ready: 400, hold: 3, ..PlannedConfig::default() }
}

/// One that plans on what it has learned of a line.
fn learned(sign: f32, config: &PlannedConfig) -> Planned<Known> {
    let view = Arc::new(Plain::new(&[false], &[]));
    let mut rng = Seed(2).stream("weights", 0);
    let mut planned = Planned::new(Known { sign }, view, 1, config, Backend::of_tests(), &mut rng);
    let mut ctx = Context::training(Seed(2), 0);
    for _ in 0..config.ready {
        practise(&mut planned, &mut ctx);
    }
    planned
}

/// An update on random steps.
fn practise(planned: &mut Planned<Known>, ctx: &mut Context) {
    let somewhere = goal(0.0);
    let steps: Vec<_> = (0..128)
        .map(|_| {
            let (x, a) = (ctx.learning.random_range(-2.0..2.0), ctx.learning.random_range(-1.0..=1.0_f32));
            ([vec![x], vec![x + 0.1 * a]], [vec![a]])
        })
        .collect();
    let clip = |(observations, actions)| {
        Clip::new(observations, actions, Rewards::Subgoal(Pay::COST, false), Some(&somewhere), false)
    };
    let clips: Vec<_> = steps.iter().map(|(o, a)| clip((o.as_slice(), a.as_slice()))).collect();
    planned.learn(&clips, ctx);
    assert_eq!(ctx.fault, None);
}

/// Where it is after some steps from 0 on the way to 1, not exploring.
fn walk(planned: &Planned<Known>, steps: usize) -> f32 {
    let (mut x, mut memory, mut ctx) = (0.0, Memory::new(), Context::evaluation(Seed(3), 0));
    for _ in 0..steps {
        x += 0.1 * planned.act(&mut memory, &vec![x], Some(&goal(1.0)), &mut ctx)[0];
    }
    x
}

#[test]
fn beyond_the_horizon_values_lead_and_within_it_distances_do() {
    // The goal is ten steps away, a plan has three.
    let by_values = learned(1.0, &config(Reward::Sparse, true));
    assert!((0.9..1.1).contains(&walk(&by_values, 14)), "{}", walk(&by_values, 14));
    let misled = learned(-1.0, &config(Reward::Sparse, true));
    assert!(walk(&misled, 8) < -0.5, "{}", walk(&misled, 8));
    let by_distance = learned(-1.0, &config(Reward::Dense, false));
    assert!((0.9..1.1).contains(&walk(&by_distance, 14)), "{}", walk(&by_distance, 14));
}

#[test]
fn actions_are_random_pushes_until_the_model_is_ready() {
    let mut planned = learned(1.0, &config(Reward::Sparse, true));
    planned.updates = planned.config.ready - 1;
    let (mut memory, mut ctx) = (Memory::new(), Context::evaluation(Seed(4), 0));
    let mut act = || planned.act(&mut memory, &vec![0.0], Some(&goal(1.0)), &mut ctx)[0];
    let pushes: Vec<f32> = (0..60).map(|_| act()).collect();
    assert!(pushes.iter().any(|a| *a < -0.3), "a plan would go on: {pushes:?}");
    let kept = pushes.chunk_by(|a, b| a == b).map(<[f32]>::len).max();
    assert!(kept >= Some(2), "pushes last: {pushes:?}");
}

#[test]
fn a_restored_one_goes_on_to_the_same_bits() {
    let config = config(Reward::Sparse, true);
    let mut planned = learned(1.0, &config);
    let mut bag = Bag::default();
    planned.save(&mut bag);
    let view = Arc::new(Plain::new(&[false], &[]));
    let mut rng = Seed(9).stream("weights", 0);
    let mut again = Planned::new(Known { sign: 1.0 }, view, 1, &config, Backend::of_tests(), &mut rng);
    again.load(&bag).unwrap();
    for planned in [&mut planned, &mut again] {
        practise(planned, &mut Context::training(Seed(5), 1));
    }
    assert_eq!(walk(&planned, 5).to_bits(), walk(&again, 5).to_bits());
}

#[test]
fn plans_that_would_be_blind_are_refused() {
    let error = config(Reward::Sparse, false).check().unwrap_err();
    assert!(error.contains("values = true"), "{error}");
    assert_eq!(config(Reward::Dense, false).check(), Ok(()));
}
