//! Proto-goals in a world of two bits, where every verdict and every pursuit is known.
//!
//! A switch and, beside it, a coin that is tossed anew in every step, or another switch. Choice 0 turns every switch off, 1
//! turns the first one on, 2 the second one. Episodes begin with everything off and are cut off after ten steps; nothing is
//! paid. So a switch is one step away from wherever it is off, and nobody controls the coin.

use inroads_agents::{
    Bag, Checkpoint, Context, Pace, Practice, Replay, TabularQ, encode::OneHot, episode, experience::Pay,
    tabular::TabularConfig,
};
use inroads_discovery::{
    Hierarchy, Shared, Skilled, Wanted,
    proto::{LeastSquares, ProtoConfig, ProtoGoalAgent, plausible::Plausibility},
    record::GoalState::{self, Mastered, Plausible, Pruned, Unseen},
};
use inroads_envs::{Annotated, Dimension, Environment, Refused, Rng, Seed, Space, Spec, Step, TimeLimit};
use rand::RngExt;

type Seen = Annotated<Vec<f32>>;
type Agent = Hierarchy<Seen, usize, ProtoGoalAgent<Shared<TabularQ, Wanted>, LeastSquares<OneHot>>>;

const STEPS: u32 = 10;

struct TwoBits {
    spec: Spec,
    coin: bool,
    on: [bool; 2],
    chance: Rng,
}

impl TwoBits {
    fn new(coin: bool) -> TimeLimit<Self> {
        let bit = |name| Dimension::linear(name, "", 0.0, 1.0);
        let spec = Spec {
            name: "two-bits",
            about: "a switch, and a coin or another switch",
            observation: Space::Box([bit("first"), bit("second")].into()),
            action: Space::Discrete(3),
            goal: None,
            place: vec![0, 1],
            time_limit: None,
            success_reward: 1.0,
        };
        let chance = Seed(0).stream("chance", 0);
        TimeLimit::new(Self { spec, coin, on: [false; 2], chance }, STEPS)
    }
}

impl Environment for TwoBits {
    type Observation = Seen;
    type Action = usize;

    fn spec(&self) -> &Spec {
        &self.spec
    }

    fn reset(&mut self, seed: u64) {
        self.on = [false; 2];
        self.chance = Seed(seed).stream("chance", 0);
    }

    fn step(&mut self, choice: &usize) -> Result<Step, Refused> {
        self.spec.action.admit_choice(*choice)?;
        match choice {
            0 => self.on = [false; 2],
            on => self.on[on - 1] = true,
        }
        if self.coin {
            self.on[1] = self.chance.random_bool(0.5);
        }
        Ok(Step { reward: 0.0, end: None })
    }

    fn observe(&mut self, out: &mut Seen) {
        out.seen = self.on.map(|on| f32::from(u8::from(on))).to_vec();
        out.bits.clear(2);
        (0..2).filter(|bit| self.on[*bit]).for_each(|bit| out.bits.set(bit));
    }
}

/// Evaluates its goals after every fiftieth episode, gives up after that many steps, and makes no random moves on the way to
/// a goal.
fn agent(spec: &Spec, horizon: u32) -> Agent {
    let goals =
        ProtoConfig { evaluate_every: 500, horizon, task_share: 0.0, window: 20, ..ProtoConfig::default() };
    let tables = TabularConfig { rate: 1.0, epsilon: 0.0, ..TabularConfig::default() };
    let replay = Replay::new(10_000).paying(Pay::ATTAINMENT);
    let pace = Pace { updates_per_step: 1.0, warm_up: 1 };
    let policy = Shared::new(TabularQ::new(3, &tables), Practice::new(replay, pace));
    let encoder = OneHot::new(&spec.observation, &[vec![0, 1]]).unwrap();
    let judge = LeastSquares::new(Plausibility::default(), encoder, 3);
    Hierarchy::new(ProtoGoalAgent::new(&goals, policy, judge), 10_000)
}

/// What a training episode was: in each step whether the first and the second bit held, the choice, and the goal pursued
/// (counted from 1; 0: none).
fn train(env: &mut TimeLimit<TwoBits>, agent: &mut Agent, number: u64) -> Vec<([bool; 2], usize, usize)> {
    let mut ctx = Context::training(Seed(4), number);
    let mut trace = Vec::new();
    episode(env, agent, Seed(4).number("start", number), &mut ctx, |t, goal| {
        trace.push(([t.before.bits.get(0), t.before.bits.get(1)], *t.action, goal));
    })
    .unwrap();
    trace
}

fn states(agent: &Agent) -> Vec<(Vec<u32>, GoalState)> {
    agent.goals().into_iter().map(|goal| (goal.bits, goal.state)).collect()
}

#[test]
fn the_switch_becomes_a_goal_and_is_mastered_and_the_coin_is_pruned() {
    let mut env = TwoBits::new(true);
    let mut agent = agent(env.spec(), 1);
    for number in 0..80 {
        let trace = train(&mut env, &mut agent, number);
        let pursued: Vec<_> = trace.iter().map(|(_, _, goal)| *goal).collect();
        match number {
            // Nothing is a goal before the first evaluation, which comes after the fiftieth episode.
            0..50 => assert_eq!(pursued, [0; 10]),
            // Then the switch is, wherever it is off; the coin never.
            _ => {
                let off: Vec<_> = trace.iter().map(|(on, ..)| usize::from(!on[0])).collect();
                assert_eq!(pursued, off, "episode {number}");
            }
        }
        if number >= 70 {
            let learned = trace.iter().filter(|(.., goal)| *goal == 1).all(|(_, choice, _)| *choice == 1);
            assert!(learned, "the switch is turned on at once");
        }
        let [switch, coin] = match number {
            0..49 => [Unseen, Unseen],
            49 => [Plausible, Pruned],
            50..70 => continue,
            _ => [Mastered, Pruned],
        };
        assert_eq!(states(&agent), [(vec![0], switch), (vec![1], coin)], "after episode {number}");
    }
    let goals = agent.goals();
    assert_eq!((goals[0].success, goals[1].pursued), (1.0, 0));
    assert!(goals[1].attained > 100, "the coin is tossed 800 times");
}

#[test]
fn two_mastered_switches_make_a_goal_that_is_mastered_too() {
    let mut env = TwoBits::new(false);
    let mut agent = agent(env.spec(), 2);
    let mut births = Vec::new();
    for number in 0..300 {
        train(&mut env, &mut agent, number);
        if births.last().map_or(0, |(_, known)| *known) < agent.goals().len() {
            births.push((number, agent.goals().len()));
        }
    }
    assert_eq!(states(&agent), [(vec![0], Mastered), (vec![1], Mastered), (vec![0, 1], Mastered)]);
    // Both proto-goals are there from the first step, their combination with an evaluation after both are mastered.
    assert_eq!((births[0], births.len()), ((0, 2), 2));
    assert!(births[1].0 % 50 == 49 && births[1].0 > 49, "{births:?}");
    // From now on, who pursues both turns on what is off.
    let traces: Vec<_> = (300..310).flat_map(|number| train(&mut env, &mut agent, number)).collect();
    let pursued: Vec<_> = traces.iter().filter(|(.., goal)| *goal == 3).collect();
    assert!(pursued.len() > 20, "of 100 steps: {}", pursued.len());
    for (on, choice, _) in pursued {
        assert!(*choice != 0 && (*on == [false; 2] || !on[*choice - 1]), "{on:?} {choice}");
    }
}

#[test]
fn a_watched_agent_does_the_task_and_does_not_change() {
    let mut env = TwoBits::new(true);
    let mut agent = agent(env.spec(), 1);
    (0..60).for_each(|number| _ = train(&mut env, &mut agent, number));
    let bytes = |agent: &Agent| {
        let mut bag = Bag::default();
        agent.save(&mut bag);
        bag
    };
    let before = bytes(&agent);
    let mut ctx = Context::evaluation(Seed(4), 0);
    let watched = |_: &inroads_agents::Transition<'_, Seen, usize>, goal| assert_eq!(goal, 0);
    episode(&mut env, &mut *inroads_agents::Agent::frozen(&agent), 0, &mut ctx, watched).unwrap();
    assert!(bytes(&agent) == before);
    // What was saved is all there is: a restored agent goes on in the same way.
    let mut restored = self::agent(env.spec(), 1);
    restored.load(&before).unwrap();
    for number in 60..70 {
        assert_eq!(train(&mut env, &mut agent, number), train(&mut env, &mut restored, number));
    }
    assert!(bytes(&agent) == bytes(&restored));
}
