//! Deep skill graphs on seven cells in a row, where the whole graph is known.
//!
//! ```text
//! 0 ─ 1 ─ 2 ─ 3 ─ 4 ─ 5 ─ 6      start 0, no task; places are drawn from [0, 7)
//! ```
//!
//! Regions must be three cells apart and an expansion goes three: so they are 0, 3 and 6. Sets are what was seen, cell by
//! cell, and an option begins in at most three: so a chain between two regions is two options, the last one from the three
//! cells before and with its end, the first one from where the chain begins.

use std::sync::Arc;

use inroads_agents::{Actor, Agent, Bag, Checkpoint, Context, classify::Nearest, encode::Select, episode};
use inroads_discovery::{
    Binary, Hierarchy, Skilled,
    graph::{AbstractMdp, AbstractMdpConfig, DeepGraph, DeepGraphConfig, Dijkstra, Ground, Planner, Region},
    policy::Given,
    record::{Place, Query},
};
use inroads_envs::{Dimension, Environment, Refused, Seed, Space, Spec, Step, TimeLimit};

/// Cells in a row, left with −1 and right with 1, without a task.
struct Row {
    spec: Spec,
    at: f32,
}

impl Row {
    fn new() -> TimeLimit<Self> {
        let spec = Spec {
            name: "row",
            about: "seven cells in a row",
            observation: Space::Box([Dimension::linear("cell", "", 0.0, 7.0)].into()),
            action: Space::Box([Dimension::linear("way", "", -1.0, 1.0)].into()),
            goal: None,
            place: vec![0],
            time_limit: None,
            success_reward: 0.0,
        };
        TimeLimit::new(Self { spec, at: 0.0 }, 40)
    }
}

impl Environment for Row {
    type Observation = Vec<f32>;
    type Action = Vec<f32>;

    fn spec(&self) -> &Spec {
        &self.spec
    }

    fn reset(&mut self, _: u64) {
        self.at = 0.0;
    }

    fn step(&mut self, action: &Vec<f32>) -> Result<Step, Refused> {
        self.at = (self.at + action[0]).clamp(0.0, 6.0);
        Ok(Step { reward: 0.0, end: None })
    }

    fn observe(&mut self, out: &mut Vec<f32>) {
        out.clear();
        out.push(self.at);
    }
}

type Walk = fn(&Vec<f32>, &Region) -> Vec<f32>;
type Dsg = Hierarchy<Vec<f32>, Vec<f32>, DeepGraph<Vec<f32>, Binary<Vec<f32>, Nearest>, Given<Walk>>>;

fn agent() -> Dsg {
    built(config(), Box::new(Dijkstra::default()))
}

fn config() -> DeepGraphConfig {
    DeepGraphConfig {
        tolerance: 0.25,
        spacing: 3.0,
        expand_every: 2,
        extension: 3,
        horizon: 6,
        patience: 20,
        gestation: 2,
        segment: 3,
        ..DeepGraphConfig::default()
    }
}

fn built(config: DeepGraphConfig, planner: Box<dyn Planner>) -> Dsg {
    let env = Row::new();
    let sets = Binary::new(Arc::new(Select::new(&[0])), Nearest::new(0.25), 100);
    let walk: Walk = |s, goal| vec![if goal.at()[0] > s[0] { 1.0 } else { -1.0 }];
    let ground = Ground::of(env.spec()).expect("cells have bounds");
    let graph = DeepGraph::new(&config, env.spec(), ground, planner, sets, Given::new(walk));
    Hierarchy::new(graph, 10_000)
}

fn train(agent: &mut Dsg, seed: u64, episodes: std::ops::Range<u64>) {
    let mut env = Row::new();
    for number in episodes {
        let mut ctx = Context::training(Seed(seed), number);
        episode(&mut env, agent, number, &mut ctx, |_, _| {}).unwrap();
    }
}

/// Of each option the cells that it may begin in, and those that it ends in.
fn options(agent: &Dsg) -> Vec<(Vec<usize>, Vec<usize>)> {
    let graph = agent.graph().unwrap();
    let skills = agent.skills();
    let cells =
        |k: usize| -> Vec<usize> { (0..7).filter(|cell| agent.members(&vec![*cell as f32])[k]).collect() };
    let ends = |enters: u32| match skills.iter().position(|other| other.skill == enters) {
        Some(parent) => cells(parent),
        None => vec![graph.vertices[enters as usize - 1].kept[0].1 as usize],
    };
    let mut options: Vec<_> =
        skills.iter().enumerate().map(|(k, skill)| (cells(k), ends(skill.enters.unwrap()))).collect();
    options.sort();
    options
}

fn bytes(agent: &Dsg) -> Bag {
    let mut bag = Bag::default();
    agent.save(&mut bag);
    bag
}

#[test]
fn the_graph_is_the_one_that_must_be_found() {
    for seed in 0..4 {
        let mut agent = agent();
        train(&mut agent, seed, 0..60);
        let graph = agent.graph().unwrap();
        let mut regions: Vec<_> = graph.vertices.iter().flat_map(|v| v.kept.iter().map(|k| k.1)).collect();
        regions.sort_by(f32::total_cmp);
        assert_eq!(regions, [0.0, 3.0, 6.0], "seed {seed}");
        let expected = [
            (vec![0, 1], vec![1, 2, 3]),
            (vec![0, 1, 2], vec![0]),
            (vec![1, 2, 3], vec![3]),
            (vec![2, 3], vec![0, 1, 2]),
            (vec![3, 4], vec![4, 5, 6]),
            (vec![3, 4, 5], vec![3]),
            (vec![4, 5, 6], vec![6]),
            (vec![5, 6], vec![3, 4, 5]),
        ];
        assert_eq!(options(&agent), expected, "seed {seed}");
    }
}

#[test]
fn plans_are_gone_as_they_are_made_and_the_three_cases_are_told_apart() {
    let mut agent = agent();
    train(&mut agent, 1, 0..60);
    let [start, end] = [vec![0.0], vec![6.0]];
    let skill = |cells: &[usize]| {
        let of =
            |k: &usize| (0..7).all(|cell| agent.members(&vec![cell as f32])[*k] == cells.contains(&cell));
        let k = (0..agent.skills().len()).find(of).expect("there is such an option");
        agent.skills()[k].skill
    };
    let there = [skill(&[0, 1]), skill(&[1, 2, 3]), skill(&[3, 4]), skill(&[4, 5, 6])];

    // Numbers of skills are those of vertices and one.
    let plan = agent.plan(&Place::State(&start), &Place::State(&end)).unwrap();
    assert_eq!((plan.case, plan.outside), (Query::Inside, 1.0));
    let skills: Vec<_> = plan.legs.iter().map(|(v, _)| v + 1).collect();
    assert_eq!(skills[..4], there, "{skills:?}");
    assert!(plan.probability() > 0.7 && plan.probability() < 1.0);

    let mut actor = agent.pursue(&Place::State(&end)).unwrap();
    let mut trace = Vec::new();
    let mut ctx = Context::evaluation(Seed(0), 0);
    episode(&mut Row::new(), &mut *actor, 0, &mut ctx, |t, k| trace.push((t.before[0], k as u32))).unwrap();
    let [a, b, c, d] = there;
    assert_eq!(trace[..6], [(0.0, a), (1.0, b), (2.0, b), (3.0, c), (4.0, d), (5.0, d)]);

    let stay = agent.plan(&Place::State(&vec![1.0]), &Place::State(&vec![1.2])).unwrap();
    assert_eq!((stay.case, stay.legs.len(), stay.probability()), (Query::Inside, 0, 1.0));
    let beyond = agent.plan(&Place::State(&start), &Place::State(&vec![6.9])).unwrap();
    assert_eq!((beyond.case, beyond.legs[..4].to_vec()), (Query::GoalOutside, plan.legs[..4].to_vec()));
    assert!(beyond.outside < 1.0);
    let lost = agent.plan(&Place::State(&vec![9.0]), &Place::State(&start)).unwrap();
    // To the region at 6 without an option, back by four, and then it is in the region at 0.
    let graph = agent.graph().unwrap();
    let region = |at: f32| graph.vertices.iter().find(|v| v.kept == [(0, at)]).unwrap().vertex;
    let back = [[5, 6].as_slice(), &[3, 4, 5], &[2, 3], &[0, 1, 2]].map(|cells| skill(cells) - 1);
    let legs: Vec<_> = lost.legs.iter().map(|(v, _)| *v).collect();
    assert_eq!(lost.case, Query::StartOutside);
    assert_eq!(legs, [&[region(6.0)][..], &back, &[region(0.0)]].concat());
}

/// Where an actor is in an episode, from its first step to its end.
fn cells(actor: &mut dyn Actor<Vec<f32>, Vec<f32>>) -> Vec<f32> {
    let mut cells = vec![0.0];
    let mut ctx = Context::evaluation(Seed(3), 0);
    episode(&mut Row::new(), actor, 0, &mut ctx, |t, _| cells.push(t.after[0])).unwrap();
    cells
}

#[test]
fn the_abstract_process_plans_the_same_ways() {
    let process = AbstractMdpConfig { optimism: 0.0, ..AbstractMdpConfig::default() };
    for seed in 0..4 {
        let mut agent = built(config(), Box::new(AbstractMdp::new(&process)));
        train(&mut agent, seed, 0..60);
        let regions = agent.graph().unwrap().vertices.iter().filter(|v| !v.kept.is_empty()).count();
        assert_eq!((regions, agent.skills().len()), (3, 8), "seed {seed}");
        let graph = agent.graph().unwrap();
        for (from, to) in [(0.0, 6.0), (6.0, 0.0), (0.0, 3.0), (3.0, 6.0)] {
            let plan = agent.plan(&Place::State(&vec![from]), &Place::State(&vec![to])).unwrap();
            assert_eq!(plan.case, Query::Inside);
            let last = &graph.vertices[plan.legs.last().unwrap().0 as usize];
            assert!(plan.probability() > 0.5 && last.kept == [(0, to)], "{from} to {to}: {plan:?}");
        }
        let mut actor = agent.pursue(&Place::State(&vec![6.0])).unwrap();
        assert_eq!(cells(&mut *actor)[..7], [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0], "seed {seed}");
    }
}

#[test]
fn a_watched_agent_without_a_task_goes_from_region_to_region() {
    let mut agent = agent();
    train(&mut agent, 1, 0..60);
    let cells = cells(&mut *agent.frozen());
    // Every step leads on: to the other end, or back from a region.
    let turns = cells.windows(3).filter(|c| c[0] == c[2]).map(|c| c[1]);
    let turns: Vec<_> = turns.collect();
    assert!(turns.len() > 2 && turns.iter().all(|at| at % 3.0 == 0.0), "{cells:?}");
}

#[test]
fn a_watched_agent_gives_up_what_leads_nowhere() {
    // The start is all that it may know: it goes out to any place for a while, and comes back.
    let mut agent = built(DeepGraphConfig { max_vertices: 1, ..config() }, Box::new(Dijkstra::default()));
    train(&mut agent, 1, 0..3);
    assert_eq!(agent.graph().unwrap().vertices.len(), 1);
    let cells = cells(&mut *agent.frozen());
    let left = cells.windows(2).filter(|c| c[0] == 0.0 && c[1] > 0.0).count();
    assert!(left > 2, "{cells:?}");
}

#[test]
fn a_saved_graph_goes_on_as_if_nothing_had_happened() {
    let mut one = agent();
    train(&mut one, 5, 0..12);
    let before = bytes(&one);
    let mut other = agent();
    other.load(&before).unwrap();
    train(&mut one, 5, 12..20);
    train(&mut other, 5, 12..20);
    assert!(bytes(&one) == bytes(&other) && bytes(&one) != before);
}
