//! Answers that are known (`reference/algorithms.md`, section 14): gambler's ruin, a frozen policy, stitching, time-outs.

use std::sync::Arc;

use inroads_envs::{Dimension, End, Rng, Seed, Space};
use rand::RngExt;

use super::*;
use crate::encode::{Choices, Scaled};
use crate::experience::{Aim, Pay};
use crate::nets::Backend;
use crate::{Experience, Lesson, Replay, Transition};

type State = Vec<f32>;

/// Remembers walks of a chain of states, and lessons about attaining its last.
struct Walks {
    all: Experience<State, usize>,
    replay: Replay,
}

impl Walks {
    fn new(closing: bool) -> Self {
        let replay = Replay::new(100_000).paying(Pay::ATTAINMENT);
        Self { all: Experience::new(100_000), replay: if closing { replay.closing() } else { replay } }
    }

    /// The states of a walk, the action taken at each but the last, and how it ended.
    fn walk(&mut self, states: &[f32], actions: &[usize], attained: bool, end: Option<End>) {
        let state = |i: usize| vec![states[i]];
        self.all.begin(&state(0));
        for (i, action) in actions.iter().enumerate() {
            let end = if i + 1 == actions.len() { end } else { None };
            let (before, after) = (state(i), state(i + 1));
            self.all.push(&Transition { before: &before, action, reward: 0.0, after: &after, end });
        }
        let steps = 0..actions.len() as u32;
        let aim = Aim::Subgoal { attained };
        self.replay.push(Lesson { episode: self.all.latest(), steps, aim, goal: None, rewards: None });
    }

    fn teach(
        &self,
        evaluator: &mut impl Evaluator<State, usize, ()>,
        updates: u32,
        policy: impl Fn(f32) -> usize,
    ) {
        let mut ctx = Context::training(Seed(11), 0);
        let policy = |s: &State, _: &mut Context| policy(s[0]);
        for _ in 0..updates {
            let mut clips = Vec::new();
            self.replay.sample(&self.all, evaluator.batch(), &mut ctx.learning, &mut clips);
            evaluator.learn(&clips, &policy, &mut ctx);
        }
    }
}

fn values(evaluator: &impl Evaluator<State, usize, ()>, states: &[f32]) -> Vec<f32> {
    let states: Vec<State> = states.iter().map(|s| vec![*s]).collect();
    evaluator.values(&states.iter().collect::<Vec<_>>(), None)
}

fn table(rate: f32) -> Table {
    Table::new(2, &TableConfig { rate, ..TableConfig::default() })
}

/// A network that reads states 0 to `states`.
fn network(states: f32) -> Sigmoid<State, usize> {
    let space = Space::Box([Dimension::linear("state", "", 0.0, states)].into());
    let config = SigmoidConfig { hidden: vec![32, 32], rate: 3e-3, tau: 0.05, ..SigmoidConfig::default() };
    let mut rng = Seed(4).stream("weights", 0);
    Sigmoid::new(
        Arc::new(Scaled::new(&space)),
        Arc::new(Choices(2)),
        0,
        &config,
        Backend::of_tests(),
        &mut rng,
    )
}

/// Action 1 goes right with probability `right` and left else, until 0 (ruin) or `n` (success).
fn gamble(from: u8, n: u8, right: f64, rng: &mut Rng) -> (Vec<f32>, bool) {
    let (mut at, mut states) = (from, vec![f32::from(from)]);
    while at != 0 && at != n {
        at = if rng.random_bool(right) { at + 1 } else { at - 1 };
        states.push(f32::from(at));
    }
    (states, at == n)
}

fn gambles(n: u8, right: f64, episodes: u32) -> Walks {
    let mut walks = Walks::new(true);
    let mut rng = Seed(8).stream("gamble", 0);
    for _ in 0..episodes {
        let from = rng.random_range(1..n);
        let (states, attained) = gamble(from, n, right, &mut rng);
        walks.walk(&states, &vec![1; states.len() - 1], attained, Some(End::Terminated));
    }
    walks
}

#[test]
fn a_gambler_who_is_not_ruined_is_one_as_often_as_the_books_say() {
    let mut table = table(0.01);
    gambles(5, 0.5, 6000).teach(&mut table, 6000, |_| 1);
    for (i, value) in values(&table, &[1.0, 2.0, 3.0, 4.0]).into_iter().enumerate() {
        let exact = (i + 1) as f32 / 5.0;
        assert!((value - exact).abs() < 0.03, "from {}: {value}, and {exact} is exact", i + 1);
    }
}

#[test]
fn a_network_says_nearly_the_same() {
    let mut network = network(5.0);
    gambles(5, 0.5, 3000).teach(&mut network, 1500, |_| 1);
    for (i, value) in values(&network, &[1.0, 2.0, 3.0, 4.0]).into_iter().enumerate() {
        let exact = (i + 1) as f32 / 5.0;
        assert!((value - exact).abs() < 0.08, "from {}: {value}, and {exact} is exact", i + 1);
    }
}

#[test]
fn a_frozen_policys_value_is_what_rolling_it_out_finds() {
    let mut table = table(0.01);
    gambles(6, 0.6, 6000).teach(&mut table, 6000, |_| 1);
    let mut rng = Seed(9).stream("gamble", 0);
    for from in 1..6 {
        let trials = 1000;
        let successes = (0..trials).filter(|_| gamble(from, 6, 0.6, &mut rng).1).count();
        let share = successes as f32 / trials as f32;
        // Three standard errors of the rollouts, and what the table's constant step size leaves open.
        let slack = 3.0 * (share * (1.0 - share) / trials as f32).sqrt() + 0.02;
        let value = values(&table, &[f32::from(from)])[0];
        assert!((value - share).abs() < slack, "from {from}: {value}, {share} ± {slack}");
    }
}

#[test]
fn steps_of_anybody_tell_what_another_policy_is_worth() {
    // Behaviour: a coin. Who always goes right arrives, who always goes left does not; on the very same steps.
    let mut walks = Walks::new(true);
    let mut rng = Seed(3).stream("behaviour", 0);
    for _ in 0..200 {
        let (states, attained) = gamble(2, 4, 0.5, &mut rng);
        let actions: Vec<_> = states.windows(2).map(|pair| usize::from(pair[1] > pair[0])).collect();
        walks.walk(&states, &actions, attained, Some(End::Terminated));
    }
    for (policy, expected) in [(1, 1.0), (0, 0.0)] {
        let mut table = table(0.2);
        walks.teach(&mut table, 300, |_| policy);
        for value in values(&table, &[1.0, 2.0, 3.0]) {
            assert!((value - expected).abs() < 0.01, "policy {policy}: {value}");
        }
    }
}

#[test]
fn a_failed_walk_gets_credit_for_the_way_it_shares_with_a_successful_one() {
    // Figure 5.1, left: 0 → 1 → 2 and astray to 9, which fails; 5 → 2 → 3, which is the subgoal. The policy now goes
    // to 3 from 2.
    let mut walks = Walks::new(true);
    walks.walk(&[0.0, 1.0, 2.0, 9.0], &[1, 1, 0], false, None);
    walks.walk(&[5.0, 2.0, 3.0], &[1, 1], true, None);
    let mut td = table(0.5);
    walks.teach(&mut td, 100, |_| 1);
    for value in values(&td, &[0.0, 1.0, 2.0, 5.0]) {
        assert!((value - 1.0).abs() < 1e-3, "{value}");
    }
    // What a classifier of outcomes says of the first two: the share of walks from there that succeeded.
    assert_eq!(td.values(&[&vec![7.0]], None::<&()>), [0.0], "a state nobody was in");
    // Had the policy gone on astray, the shared way would have no credit.
    let mut astray = table(0.5);
    walks.teach(&mut astray, 100, |s| if s == 2.0 { 0 } else { 1 });
    let expected = [0.0, 0.0, 0.0, 0.0];
    assert_eq!(values(&astray, &[0.0, 1.0, 2.0, 5.0]), expected);
}

#[test]
fn a_policy_that_never_succeeds_is_worth_nothing_if_running_out_of_time_ends_it() {
    let circle = |closing| {
        let mut walks = Walks::new(closing);
        (0..40).for_each(|_| walks.walk(&[0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 2.0, 3.0], &[1; 7], false, None));
        let mut network = network(3.0);
        walks.teach(&mut network, 800, |_| 1);
        values(&network, &[0.0, 1.0, 2.0, 3.0])
    };
    assert!(circle(true).iter().all(|value| *value < 0.05), "{:?}", circle(true));
    assert!(circle(false).iter().any(|value| *value > 0.2), "what began at a half would stay there");
}

#[test]
fn below_one_the_discount_counts_the_steps_that_are_to_go() {
    let mut walks = Walks::new(false);
    walks.walk(&[0.0, 1.0, 2.0, 3.0], &[1; 3], true, None);
    let mut table =
        Table::new(2, &TableConfig { rate: 0.5, discount: 0.9, batch: 8, ..TableConfig::default() });
    walks.teach(&mut table, 100, |_| 1);
    for (value, exact) in values(&table, &[0.0, 1.0, 2.0]).into_iter().zip([0.81, 0.9, 1.0]) {
        assert!((value - exact).abs() < 1e-4, "{value} {exact}");
    }
}

#[test]
fn earlier_is_what_it_was_a_period_ago() {
    let mut walks = Walks::new(true);
    walks.walk(&[0.0, 1.0], &[1], true, None);
    let config = TableConfig { rate: 0.5, batch: 1, period: 2, ..TableConfig::default() };
    let mut table = Table::new(2, &config);
    let mut seen = Vec::new();
    for _ in 0..4 {
        walks.teach(&mut table, 1, |_| 1);
        let states = [&vec![0.0]];
        seen.push((table.values(&states, None::<&()>)[0], table.earlier(&states, None::<&()>)[0]));
    }
    // Q: .5, .75, .875, .9375; V goes half of the way to it each time; "earlier" moves after the second and fourth.
    assert_eq!(seen, [(0.25, 0.0), (0.5, 0.5), (0.6875, 0.5), (0.8125, 0.8125)]);
}

#[test]
fn goals_have_values_of_their_own_and_checkpoints_keep_them() {
    let mut all = Experience::new(10);
    all.begin(&vec![0.0]);
    for (before, after) in [(0.0, 1.0), (1.0, 2.0)] {
        let (before, after) = (vec![before], vec![after]);
        all.push(&Transition { before: &before, action: &1, reward: 0.0, after: &after, end: None });
    }
    let mut replay: Replay<State> = Replay::new(10).paying(Pay::ATTAINMENT).closing();
    for (goal, attained) in [(2.0, true), (7.0, false)] {
        let aim = Aim::Subgoal { attained };
        replay.push(Lesson { episode: 0, steps: 0..2, aim, goal: Some(vec![goal]), rewards: None });
    }
    let mut ctx = Context::training(Seed(1), 0);
    let mut table = table(0.5);
    for _ in 0..40 {
        let mut clips = Vec::new();
        replay.sample(&all, 8, &mut ctx.learning, &mut clips);
        table.learn(&clips, &|_, _| 1, &mut ctx);
    }
    let mut bag = crate::Bag::default();
    table.save(&mut bag);
    let mut again = Table::new(2, &TableConfig::default());
    again.load(&bag).unwrap();
    for table in [&table, &again] {
        let of = |goal: f32| table.values(&[&vec![0.0]], Some(&vec![goal]))[0];
        assert!(of(2.0) > 0.99 && of(7.0) == 0.0, "{} {}", of(2.0), of(7.0));
    }
}

#[test]
fn impossible_settings_are_named() {
    let error = TableConfig { rate: 2.0, ..TableConfig::default() }.check().unwrap_err();
    assert!(error.starts_with("rate is 2"));
    let error = SigmoidConfig { batch: 0, ..SigmoidConfig::default() }.check().unwrap_err();
    assert!(error.starts_with("batch is 0"));
    assert_eq!((TableConfig::default().check(), SigmoidConfig::default().check()), (Ok(()), Ok(())));
}
