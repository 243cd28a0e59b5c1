//! One key for the counterfactuals: a corridor in which every step of the answer is known.
//!
//! ```text
//! key 0 ─ 1 ─ 2 ─ 3 ─ 4 ─ 5 ─ 6 goal      start 3; the goal lets nobody in without the key
//! ```
//!
//! What is seen is the cell, whether the key was taken, and a number that changes at random in every step. What is new
//! is known at any time, so the goals that must be made of it are known too: first "be where the key is", then "be at the
//! goal", each with whichever number.

use std::sync::Arc;

use inroads_agents::{Agent, Novelty};
use inroads_agents::{
    Bag, Checkpoint, Context, Curious, Experience, Pace, Practice, Replay, TabularQ, Transition, episode,
    experience::Pay,
    novelty::{Counts, FeatureCounts, FeatureCountsConfig},
    tabular::TabularConfig,
};
use inroads_discovery::{
    Abstracting, AbstractingConfig, Features, GraphExplorer, Hierarchy, Shared, Skilled,
    frontier::{Frontier, Novel},
    graph::{Direct, ExplorerConfig},
    naming::{Counterfactual, CounterfactualConfig, Name, Whole},
    over_skills::{Epsilon, TabularOverSkills},
    record::Place,
};
use inroads_envs::{Dimension, End, Environment, Refused, Rng, Seed, Space, Spec, Step, TimeLimit};
use rand::{RngExt, SeedableRng};

/// The corridor.
struct OneKey {
    spec: Spec,
    cell: u8,
    key: bool,
    number: u8,
    chance: Rng,
}

const START: u8 = 3;
const GOAL: u8 = 6;
const NUMBERS: u8 = 3;

impl OneKey {
    fn new() -> Self {
        let dimensions = [("cell", 6.0), ("key", 1.0), ("number", 2.0)];
        let space: Arc<[_]> = dimensions.map(|(name, high)| Dimension::linear(name, "", 0.0, high)).into();
        let spec = Spec {
            name: "one-key",
            about: "a corridor with a key",
            observation: Space::Box(space),
            action: Space::Discrete(2),
            goal: None,
            place: vec![0],
            time_limit: None,
            success_reward: 1.0,
        };
        Self { spec, cell: START, key: false, number: 0, chance: Rng::seed_from_u64(0) }
    }
}

impl Environment for OneKey {
    type Observation = Vec<f32>;
    type Action = usize;

    fn spec(&self) -> &Spec {
        &self.spec
    }

    fn reset(&mut self, seed: u64) {
        (self.cell, self.key, self.chance) = (START, false, Seed(seed).stream("numbers", 0));
        self.number = self.chance.random_range(0..NUMBERS);
    }

    fn step(&mut self, action: &usize) -> Result<Step, Refused> {
        let to = if *action == 0 { self.cell.saturating_sub(1) } else { self.cell + 1 };
        self.cell = if to == GOAL && !self.key { self.cell } else { to };
        self.key |= self.cell == 0;
        self.number = self.chance.random_range(0..NUMBERS);
        let there = self.cell == GOAL;
        Ok(Step { reward: f32::from(u8::from(there)), end: there.then_some(End::Terminated) })
    }

    fn observe(&mut self, out: &mut Vec<f32>) {
        out.clear();
        out.extend([self.cell, u8::from(self.key), self.number].map(f32::from));
    }
}

type Outer = Novel<Vec<f32>, TabularQ, Box<dyn Name<Vec<f32>, Features>>>;
type Agents = Hierarchy<
    Vec<f32>,
    usize,
    Abstracting<Vec<f32>, Features, Shared<TabularQ, Features>, Outer, TabularQ, TabularOverSkills>,
>;

const PACE: Pace = Pace { updates_per_step: 2.0, warm_up: 0 };

fn frontier(novelty: Box<dyn Novelty<Vec<f32>>>, naming: Box<dyn Name<Vec<f32>, Features>>) -> Outer {
    let tables = TabularConfig { discount: 0.95, ..TabularConfig::default() };
    let curious = Curious::new(TabularQ::new(2, &tables), Practice::new(Replay::new(10_000), PACE))
        .with_novelty(novelty, 0.01);
    Novel::new(curious, naming, 1.0)
}

fn counted() -> Box<dyn Novelty<Vec<f32>>> {
    Box::new(FeatureCounts::new(&FeatureCountsConfig::default()))
}

fn counterfactual() -> Box<dyn Name<Vec<f32>, Features>> {
    Box::new(Counterfactual::new(&CounterfactualConfig::default()))
}

fn agent(naming: Box<dyn Name<Vec<f32>, Features>>) -> Agents {
    let tables = TabularConfig { discount: 0.95, ..TabularConfig::default() };
    let replay = Replay::new(10_000).paying(Pay::ATTAINMENT);
    let policy = Shared::new(TabularQ::new(2, &tables), Practice::new(replay, PACE));
    let config = ExplorerConfig { horizon: 12, explore_for: 8, ..ExplorerConfig::default() };
    let explorer = GraphExplorer::new(&config, Box::new(Direct), policy, frontier(counted(), naming));
    let task = Curious::new(TabularQ::new(2, &tables), Practice::new(Replay::new(10_000), PACE));
    let over = TabularOverSkills::new(0.5, Epsilon { start: 1.0, end: 0.1, decisions: 300 });
    Hierarchy::new(Abstracting::new(&AbstractingConfig::default(), explorer, task, over), 10_000)
}

/// What a frontier makes of walks one after the other: of each, the features that its goal has kept.
fn proposals(mut frontier: Outer, walks: &[Vec<[u8; 3]>]) -> Vec<Option<Vec<(u32, f32)>>> {
    let mut all: Experience<Vec<f32>, usize> = Experience::new(100_000);
    let mut ctx = Context::training(Seed(0), 0);
    let mut found = Vec::new();
    for walk in walks {
        let states: Vec<Vec<f32>> = walk.iter().map(|s| s.map(f32::from).into()).collect();
        all.begin(&states[0]);
        for (at, pair) in states.windows(2).enumerate() {
            let [before, after] = pair else { unreachable!() };
            all.push(&Transition { before, action: &0, reward: 0.0, after, end: None });
            frontier.step(&all, &mut ctx);
            if at + 2 == states.len() {
                let goal: Option<Features> =
                    Frontier::<_, usize, _>::propose(&frontier, &states[1..], &mut ctx);
                found.push(goal.map(|goal| goal.kept));
            }
        }
    }
    found
}

/// A walk to and fro between cells 1 and 5 without the key, in which all numbers occur.
fn to_and_fro(steps: usize) -> Vec<[u8; 3]> {
    let cells = [3, 2, 1, 2, 3, 4, 5, 4];
    (0..steps).map(|step| [cells[step % 8], 0, (step / 8 % 3) as u8]).collect()
}

#[test]
fn the_goals_are_those_that_must_be_found() {
    let walks = [
        to_and_fro(241),
        to_and_fro(25),
        // Cell 0, and from there on the key. Both are new; the cell was visited once, the key carried in three states.
        vec![[3, 0, 0], [2, 0, 1], [1, 0, 2], [0, 1, 0], [1, 1, 2], [2, 1, 1]],
        // With the key to and fro, until that is familiar, and then to the goal.
        to_and_fro(241).into_iter().map(|[cell, _, number]| [cell, 1, number]).collect(),
        vec![[3, 1, 0], [4, 1, 1], [5, 1, 2], [6, 1, 0]],
    ];
    let found = proposals(frontier(counted(), counterfactual()), &walks);
    let expected = [None, None, Some(vec![(0, 0.0)]), None, Some(vec![(0, 6.0)])];
    assert_eq!(found, expected);
}

#[test]
fn counts_of_whole_states_or_goals_of_whole_states_keep_no_few_features() {
    let key = vec![[3, 0, 0], [2, 0, 1], [1, 0, 2], [1, 1, 2]];
    let walks = [to_and_fro(241), key];
    let last = |novelty, naming| proposals(frontier(novelty, naming), &walks).pop().flatten();
    let whole = || Box::new(Whole { tolerance: 0.5 });
    assert_eq!(last(counted(), counterfactual()), Some(vec![(1, 1.0)]));
    assert_eq!(last(counted(), whole()).map(|kept| kept.len()), Some(3));
    assert_eq!(last(Box::<Counts>::default(), whole()).map(|kept| kept.len()), Some(3));
}

fn train(seed: u64, naming: Box<dyn Name<Vec<f32>, Features>>) -> Agents {
    let mut env = TimeLimit::new(OneKey::new(), 60);
    let mut agent = agent(naming);
    for number in 0..150 {
        let mut ctx = Context::training(Seed(seed), number);
        episode(&mut env, &mut agent, Seed(seed).number("start", number), &mut ctx, |_, _| {}).unwrap();
    }
    agent
}

fn steps(agent: &Agents) -> Vec<u32> {
    let mut env = TimeLimit::new(OneKey::new(), 60);
    let of = |index| {
        let mut ctx = Context::evaluation(Seed(0), index);
        episode(&mut env, &mut *agent.frozen(), index, &mut ctx, |_, _| {}).unwrap()
    };
    (0..5).map(of).map(|summary| summary.steps).collect()
}

#[test]
fn fewer_features_are_kept_than_there_are_and_the_task_is_learned() {
    let abstracted = train(1, counterfactual());
    let graph = abstracted.graph().expect("it has a graph");
    let goals: Vec<_> = graph.vertices.iter().map(|v| &v.kept[..]).collect();
    assert!(goals.contains(&&[(1, 1.0)][..]) && goals.contains(&&[(0, 6.0)][..]), "{goals:?}");
    assert!(graph.vertices.iter().all(|v| v.at.len() == 3 && v.visits > 0), "each was attained");
    // The fewest are nine: three to the key, six to the goal. Values that are equal are chosen among at random.
    assert!(steps(&abstracted).iter().all(|steps| (9..=11).contains(steps)), "{:?}", steps(&abstracted));
    assert!(graph.vertices.iter().all(|v| v.kept.len() < 3), "every goal passes over something");
    let whole = train(1, Box::new(Whole { tolerance: 0.5 })).graph().expect("it has a graph");
    assert!(!whole.vertices.is_empty() && whole.vertices.iter().all(|v| v.kept.len() == 3));
}

#[test]
fn ways_on_the_graph_are_told_and_taken_though_nobody_plans() {
    let agent = train(1, counterfactual());
    let graph = agent.graph().expect("it has a graph");
    let of = |kept: (u32, f32)| graph.vertices.iter().find(|v| v.kept == [kept]).expect("it is found").vertex;
    let (key, goal) = (of((1, 1.0)), of((0, 6.0)));
    let start = vec![f32::from(START), 0.0, 0.0];
    let plan = agent.plan(&Place::State(&start), &Place::Vertex(key)).expect("there is a way to the key");
    assert_eq!((plan.legs.last().map(|(v, _)| *v), plan.outside), (Some(key), 1.0));
    // Over vertex 2 ("be at cell 2"), which is nearest. Of the two latest states there, one had the key already.
    assert!(plan.probability() > 0.4, "{plan:?}");
    let on = agent.plan(&Place::Vertex(key), &Place::Vertex(goal)).expect("and from there to the goal");
    assert!(on.probability() > 0.5, "{on:?}");

    let mut cells = Vec::new();
    let mut ctx = Context::evaluation(Seed(0), 0);
    let mut env = TimeLimit::new(OneKey::new(), 60);
    let mut sent = agent.pursue(&Place::Vertex(key)).expect("somebody goes there");
    episode(&mut env, &mut *sent, 0, &mut ctx, |t, _| cells.push(t.after[0])).unwrap();
    assert_eq!(cells[..3], [2.0, 1.0, 0.0]);
}

#[test]
fn a_restored_agent_learns_on_as_if_nothing_had_happened() {
    let bytes = |agent: &Agents| {
        let mut bag = Bag::default();
        agent.save(&mut bag);
        bag
    };
    let mut one = train(2, counterfactual());
    let mut other = agent(counterfactual());
    other.load(&bytes(&one)).unwrap();
    for agent in [&mut one, &mut other] {
        let mut env = TimeLimit::new(OneKey::new(), 60);
        let mut ctx = Context::training(Seed(2), 150);
        episode(&mut env, agent, 7, &mut ctx, |_, _| {}).unwrap();
    }
    assert!(bytes(&one) == bytes(&other));
}
