//! The bit-flipping worlds of hindsight's paper (Andrychowicz 2017, section 3.1): n bits, each action flips one, and a step
//! pays −1 until all bits are as the goal has them. With hindsight a small Q-network solves them; without, it never sees
//! anything but −1 where there are many bits.

use inroads_agents::{
    Agent, Aimed, Bag, Checkpoint, Clip, Context, Corrupt, Encode, Goal, Key, Learned, Learner, Memory, Pace,
    Practice, Replay, TabularQ,
    dqn::{GrowingConfig, GrowingDqn, Loss, Sample},
    draw::argmax,
    episode,
    hindsight::{HindsightConfig, Strategy},
    nets::Backend,
    tabular::TabularConfig,
};
use inroads_envs::{Dimension, End, Environment, Refused, Seed, Space, Spec, Step, TimeLimit};
use rand::RngExt;
use serde::{Deserialize, Serialize};

/// γ of the paper.
const DISCOUNT: f32 = 0.98;
/// Share of random actions while exploring (the paper has 0.2).
const EPSILON: f32 = 0.2;

struct BitFlip {
    spec: Spec,
    bits: Vec<f32>,
}

impl BitFlip {
    /// Bits are −1 or 1; the goal is that all are 1.
    fn limited(n: usize) -> TimeLimit<Self> {
        let bit = Dimension::linear("bit", "", -1.0, 1.0);
        let spec = Spec {
            name: "bit-flip",
            about: "",
            observation: Space::Box(vec![bit; n].into()),
            action: Space::Discrete(n),
            goal: None,
            place: Vec::new(),
            time_limit: None,
            success_reward: 0.0,
        };
        TimeLimit::new(Self { spec, bits: vec![1.0; n] }, n as u32)
    }
}

impl Environment for BitFlip {
    type Observation = Vec<f32>;
    type Action = usize;

    fn spec(&self) -> &Spec {
        &self.spec
    }

    fn reset(&mut self, seed: u64) {
        let mut rng = Seed(seed).stream("start", 0);
        while self.bits.iter().all(|bit| *bit > 0.0) {
            self.bits.iter_mut().for_each(|bit| *bit = if rng.random() { 1.0 } else { -1.0 });
        }
    }

    fn step(&mut self, action: &usize) -> Result<Step, Refused> {
        self.bits[*action] = -self.bits[*action];
        let done = self.bits.iter().all(|bit| *bit > 0.0);
        Ok(Step { reward: f32::from(u8::from(done)) - 1.0, end: done.then_some(End::Terminated) })
    }

    fn observe(&mut self, out: &mut Vec<f32>) {
        out.clone_from(&self.bits);
    }
}

/// "All bits like these."
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Like(Vec<f32>);

impl Goal<Vec<f32>> for Like {
    fn reached(&self, s: &Vec<f32>) -> bool {
        *s == self.0
    }
}

impl Encode for Like {
    fn width(&self) -> usize {
        self.0.len()
    }

    fn write(&self, out: &mut [f32]) {
        out.copy_from_slice(&self.0);
    }
}

impl Key for Like {
    fn key(&self) -> u128 {
        self.0.key()
    }
}

/// Double DQN that reads the goal beside the bits.
struct Dqn(GrowingDqn);

fn row(s: &[f32], goal: Option<&Like>) -> Vec<f32> {
    [s, &goal.expect("there is always one").0].concat()
}

impl Learner<Vec<f32>, usize, Like> for Dqn {
    fn act(&self, _: &mut Memory, s: &Vec<f32>, goal: Option<&Like>, ctx: &mut Context) -> usize {
        if ctx.explore && ctx.acting.random::<f32>() < EPSILON {
            return ctx.acting.random_range(0..self.0.outputs());
        }
        argmax(&self.0.values(&row(s, goal)), &mut ctx.acting)
    }

    fn values(&self, _: &Memory, s: &Vec<f32>, goals: &[Option<&Like>]) -> Vec<f32> {
        let best = |goal: &Option<&Like>| self.0.values(&row(s, *goal)).into_iter().fold(f32::MIN, f32::max);
        goals.iter().map(best).collect()
    }

    fn learn(&mut self, clips: &[Clip<Vec<f32>, usize, Like>], _: &mut Context) -> Learned {
        let before: Vec<_> = clips.iter().map(|clip| row(clip.first(), clip.goal)).collect();
        let after: Vec<_> = clips.iter().map(|clip| row(clip.last(), clip.goal)).collect();
        let sample = |i: usize| Sample {
            before: &before[i],
            choice: clips[i].actions[0],
            reward: clips[i].reward(0),
            discount: DISCOUNT,
            after: &after[i],
            admissible: Vec::new(),
            terminal: clips[i].terminal,
        };
        let samples: Vec<_> = (0..clips.len()).map(sample).collect();
        Learned { loss: self.0.learn(&samples), errors: Vec::new() }
    }

    fn batch(&self) -> usize {
        self.0.batch()
    }
}

impl Checkpoint for Dqn {
    fn save(&self, bag: &mut Bag) {
        self.0.save(bag);
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        self.0.load(bag)
    }
}

fn dqn(n: usize) -> Dqn {
    let config = GrowingConfig {
        hidden: vec![64],
        rate: 1e-3,
        tau: 0.02,
        batch: 64,
        loss: Loss::Huber,
        ..GrowingConfig::default()
    };
    Dqn(GrowingDqn::new(2 * n, n, &config, Backend::default(), &mut Seed(0).stream("weights", 0)))
}

fn agent<L: Learner<Vec<f32>, usize, Like>>(
    n: usize,
    learner: L,
    strategy: Strategy,
) -> Aimed<Vec<f32>, usize, Like, L> {
    let hindsight = HindsightConfig { strategy, ..HindsightConfig::default() };
    let practice = Practice::new(Replay::new(50_000), Pace { updates_per_step: 0.5, warm_up: 500 });
    Aimed::new(
        learner,
        Like(vec![1.0; n]),
        Box::new(|s: &Vec<f32>| Like(s.clone())),
        hindsight,
        practice,
        50_000,
    )
}

/// Trains for these episodes.
fn train(n: usize, agent: &mut impl Agent<Vec<f32>, usize>, episodes: std::ops::Range<u64>) {
    let mut env = BitFlip::limited(n);
    for index in episodes {
        let mut ctx = Context::training(Seed(0), index);
        episode(&mut env, agent, Seed(0).number("train", index), &mut ctx, |_, _| {}).unwrap();
    }
}

/// Of 200 frozen episodes, how many end with the goal.
fn solved(n: usize, agent: &impl Agent<Vec<f32>, usize>) -> usize {
    let mut env = BitFlip::limited(n);
    let solved = |index: &u64| {
        let mut ctx = Context::evaluation(Seed(0), *index);
        let start = Seed(0).number("evaluate", *index);
        episode(&mut env, &mut *agent.frozen(), start, &mut ctx, |_, _| {}).unwrap().success
    };
    (0..200).filter(solved).count()
}

#[test]
fn hindsight_flips_eight_bits() {
    for strategy in [Strategy::Future, Strategy::Final, Strategy::Achieved] {
        let mut agent = agent(8, dqn(8), strategy);
        train(8, &mut agent, 0..1000);
        let solved = solved(8, &agent);
        assert!(solved >= 190, "{strategy:?}: {solved} of 200");
    }
}

#[test]
fn without_hindsight_fifteen_bits_are_too_many() {
    let mut agent = agent(15, dqn(15), Strategy::None);
    train(15, &mut agent, 0..1000);
    let solved = solved(15, &agent);
    assert!(solved <= 4, "{solved} of 200");
}

fn saved(agent: &impl Checkpoint) -> Bag {
    let mut bag = Bag::default();
    agent.save(&mut bag);
    bag
}

#[test]
fn a_saved_agent_goes_on_to_the_same_bits() {
    for strategy in [Strategy::Future, Strategy::Achieved] {
        let new = || agent(6, TabularQ::new(6, &TabularConfig::default()), strategy);
        let mut one = new();
        train(6, &mut one, 0..150);
        let mut two = new();
        two.load(&saved(&one)).unwrap();
        train(6, &mut one, 150..200);
        assert!(saved(&one) != saved(&two));
        train(6, &mut two, 150..200);
        assert!(saved(&one) == saved(&two), "{strategy:?}");
    }
}
