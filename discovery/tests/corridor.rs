//! Skill chaining in a corridor of five states, where every step of the answer is known.
//!
//! ```text
//! 0 ─ 1 ─ 2 ─ 3 ─ 4      start 0, goal 4; an initiation set is what was seen, state by state
//! ```
//!
//! With a gestation of one trajectory and segments of three observations, the skill that reaches the goal begins at 2
//! and 3, and the one that enters its set begins at 0 and 1, which covers the start: two skills, and no third.

use std::sync::Arc;

use inroads_agents::{
    Actor, Agent, Context, Pace, TabularQ, Transition, classify::Nearest, encode::Select, episode,
    tabular::TabularConfig,
};
use inroads_discovery::{
    Binary, ChainConfig, Chaining, Hierarchy, PerSkill, Skilled, Stop,
    chain::{
        Phase,
        metrics::{chain_from, leaves},
    },
    over_skills::{Epsilon, TabularOverSkills},
    record::Came,
};
use inroads_envs::{
    Dimension, End, Environment, Goal, Refused, Seed, Space, Spec, Step, TimeLimit, corridor::Corridor,
};

type Dsc = Hierarchy<
    Vec<f32>,
    usize,
    Chaining<Vec<f32>, usize, Binary<Vec<f32>, Nearest>, PerSkill<TabularQ>, TabularOverSkills>,
>;

fn usual() -> ChainConfig {
    ChainConfig {
        max_skills: 100,
        gestation: 1,
        segment: 3,
        initiation_episodes: 2,
        initiation_successes: 1,
        timeout: 5,
        pretrain: 50,
        goal_first: true,
        ..ChainConfig::default()
    }
}

fn agent(env: &impl Environment, config: &ChainConfig) -> Dsc {
    let tables = TabularConfig { discount: 0.9, ..TabularConfig::default() };
    let policy = PerSkill::new(
        TabularQ::new(2, &tables),
        TabularQ::clone,
        10_000,
        Pace { updates_per_step: 1.0, warm_up: 1 },
    );
    let initiation = Binary::new(Arc::new(Select::new(&env.spec().place)), Nearest::new(0.25), 100);
    let epsilon = Epsilon { start: 0.5, end: 0.1, decisions: 200 };
    let over = TabularOverSkills::new(0.5, epsilon);
    Hierarchy::new(Chaining::new(config, env.spec(), initiation, policy, over), 10_000)
}

/// Trains in a world, and tells in which episodes skills were born.
fn train_in(
    env: impl Environment<Observation = Vec<f32>, Action = usize>,
    seed: u64,
    episodes: u64,
) -> (Dsc, Vec<(u64, usize)>) {
    train_with(&usual(), env, seed, episodes)
}

fn train_with(
    config: &ChainConfig,
    mut env: impl Environment<Observation = Vec<f32>, Action = usize>,
    seed: u64,
    episodes: u64,
) -> (Dsc, Vec<(u64, usize)>) {
    let mut agent = agent(&env, config);
    let mut births = Vec::new();
    for number in 0..episodes {
        let mut ctx = Context::training(Seed(seed), number);
        // Even and odd starts in turn, for a world with two of them.
        let start = 2 * Seed(seed).number("start", number).div_ceil(4) + number % 2;
        episode(&mut env, &mut agent, start, &mut ctx, |_, _| {}).unwrap();
        let skills = agent.skills().len();
        if births.last().map_or(0, |(_, known)| *known) < skills {
            births.push((number, skills));
        }
    }
    (agent, births)
}

/// Five cells, until the episode after which nothing new can happen.
fn train(seed: u64, episodes: u64) -> (Dsc, Vec<(u64, usize)>) {
    train_in(TimeLimit::new(Corridor::new(5), 50), seed, episodes)
}

/// The states and the acting skills of a frozen episode.
fn trace(actor: &mut dyn Actor<Vec<f32>, usize>) -> Vec<(f32, usize, usize)> {
    let mut env = TimeLimit::new(Corridor::new(5), 50);
    let mut trace = Vec::new();
    let mut ctx = Context::evaluation(Seed(0), 0);
    episode(&mut env, actor, 0, &mut ctx, |t, skill| trace.push((t.before[0], *t.action, skill))).unwrap();
    trace
}

#[test]
fn the_chain_is_the_one_that_must_be_found() {
    let (agent, births) = train(7, 60);
    let skills = agent.skills();
    let chain: Vec<_> = skills.iter().map(|s| (s.skill, s.enters, s.phase)).collect();
    assert_eq!(chain, [(1, None, Phase::Fixed), (2, Some(1), Phase::Fixed)]);

    // The first skill is born with the first success, the second as soon as the first one's set is fixed.
    assert_eq!(births[0], (0, 1));
    assert_eq!(births[1].1, 2);
    let fixed = births[1].0;
    assert!((2..=10).contains(&fixed), "an initiation period of two executed episodes ended at {fixed}");

    let members: Vec<_> = (0..5).map(|cell| agent.members(&vec![cell as f32])).collect();
    let expected = [[false, true], [false, true], [true, true], [true, false], [true, false]];
    assert_eq!(members, expected);

    let mut alone = agent.chain_alone().expect("there are skills");
    assert_eq!(trace(&mut *alone), [(0.0, 1, 2), (1.0, 1, 2), (2.0, 1, 1), (3.0, 1, 1)]);
    let path: Vec<_> =
        trace(&mut *agent.frozen()).into_iter().map(|(cell, action, _)| (cell, action)).collect();
    assert_eq!(path, [(0.0, 1), (1.0, 1), (2.0, 1), (3.0, 1)]);
}

/// One call of a skill from a cell, and what it came to.
fn called(agent: &Dsc, skill: u32, mut cell: usize) -> Came {
    let mut trial = agent.one_call(skill).expect("it is learned");
    let mut ctx = Context::evaluation(Seed(0), 0);
    trial.begin(&vec![cell as f32], &mut ctx);
    loop {
        if let Some(came) = trial.came() {
            return came;
        }
        let before = vec![cell as f32];
        let action = trial.act(&before, &mut ctx);
        assert_eq!(trial.source(), skill as usize);
        cell = if action == 1 { cell + 1 } else { cell.saturating_sub(1) };
        let (after, done) = (vec![cell as f32], cell == 4);
        let (reward, end) = (if done { 0.0 } else { -1.0 }, done.then_some(End::Terminated));
        let t = Transition { before: &before, action: &action, reward, after: &after, end };
        trial.observe(&t, &mut ctx);
    }
}

#[test]
fn a_skill_can_be_called_alone_from_anywhere() {
    let (agent, _) = train(7, 60);
    let reached = |steps| Came { stop: Stop::Reached, steps, success: true };
    // Skill 1 goes to the goal and skill 2 into the set of skill 1, which begins at cell 2.
    assert_eq!([2, 3].map(|cell| called(&agent, 1, cell)), [reached(2), reached(1)]);
    assert_eq!([0, 1].map(|cell| called(&agent, 2, cell)), [reached(2), reached(1)]);
    // Where their subgoals hold they have nothing to do.
    assert_eq!((called(&agent, 1, 4), called(&agent, 2, 3)), (reached(0), reached(0)));
    assert!(agent.one_call(0).is_none() && agent.one_call(3).is_none(), "there are two learned skills");
    let targets: Vec<_> = (0..5).map(|cell| agent.targets(&vec![cell as f32])).collect();
    assert_eq!(targets, (0..5).map(|cell| agent.members(&vec![cell as f32])).collect::<Vec<_>>());
    assert_eq!(agent.chances(&vec![0.0]), [None, None], "such sets tell inside from outside only");
}

#[test]
fn a_call_that_nobody_wants_runs_out_of_time() {
    // Young skills of which nothing was learned: each walk to and fro ends after five steps at most.
    let (agent, births) = train(7, 1);
    assert_eq!(births, [(0, 1)]);
    for cell in 0..4 {
        let came = called(&agent, 1, cell);
        assert!(came.steps <= 5 && came.success == (came.stop == Stop::Reached), "{came:?}");
        assert!(came.stop != Stop::TimedOut || came.steps == 5);
    }
}

#[test]
fn watching_changes_nothing() {
    let (agent, _) = train(7, 20);
    let bytes = |agent: &Dsc| {
        let mut bag = inroads_agents::Bag::default();
        inroads_agents::Checkpoint::save(agent, &mut bag);
        bag
    };
    let before = bytes(&agent);
    trace(&mut *agent.frozen());
    trace(&mut *agent.chain_alone().unwrap());
    called(&agent, 1, 0);
    assert!(bytes(&agent) == before);
}

#[test]
fn a_covered_start_ends_the_chain() {
    let (agent, _) = train(3, 200);
    assert_eq!(agent.skills().len(), 2);
}

/// Segments of three observations bring two new cells to every skill, however the walk was: who enters a set at its
/// edge was beside it before, and one further before that, or already inside.
#[test]
fn the_length_of_the_chain_follows_from_the_length_of_the_corridor() {
    for cells in [5, 8, 20, 35, 50] {
        let (agent, _) =
            train_in(TimeLimit::new(Corridor::new(cells), 40 * cells as u32), 1, 4 * cells as u64 + 20);
        let chain: Vec<_> = agent.skills().iter().map(|s| (s.skill, s.enters)).collect();
        let skills = (cells as u32 - 1).div_ceil(2);
        let expected: Vec<_> = (1..=skills).map(|k| (k, (k > 1).then(|| k - 1))).collect();
        assert_eq!(chain, expected, "{cells} cells");
        let alone = {
            let mut env = TimeLimit::new(Corridor::new(cells), 40 * cells as u32);
            let mut steps = 0;
            let mut ctx = Context::evaluation(Seed(0), 0);
            episode(&mut env, &mut *agent.chain_alone().unwrap(), 0, &mut ctx, |_, skill| {
                assert!(skill > 0);
                steps += 1;
            })
            .unwrap();
            steps
        };
        assert_eq!(alone, cells - 1, "the chain alone walks straight through {cells} cells");
    }
}

/// Nine cells with the goal in the middle; episodes start at one end or the other.
struct Fork {
    spec: Spec,
    at: usize,
}

impl Fork {
    fn new() -> Self {
        let spec = Spec {
            name: "fork",
            about: "a row of nine cells with the goal in the middle",
            observation: Space::Box([Dimension::linear("cell", "", 0.0, 8.0)].into()),
            action: Space::Discrete(2),
            goal: Some(Goal { dims: vec![0], at: vec![4.0], tolerance: 0.25 }),
            place: vec![0],
            time_limit: None,
            success_reward: 0.0,
        };
        Self { spec, at: 0 }
    }
}

impl Environment for Fork {
    type Observation = Vec<f32>;
    type Action = usize;

    fn spec(&self) -> &Spec {
        &self.spec
    }

    fn reset(&mut self, seed: u64) {
        self.at = if seed.is_multiple_of(2) { 0 } else { 8 };
    }

    fn step(&mut self, action: &usize) -> Result<Step, Refused> {
        self.at = if *action == 1 { (self.at + 1).min(8) } else { self.at.saturating_sub(1) };
        Ok(match self.at == 4 {
            true => Step { reward: 0.0, end: Some(End::Terminated) },
            false => Step { reward: -1.0, end: None },
        })
    }

    fn observe(&mut self, out: &mut Vec<f32>) {
        out.clear();
        out.push(self.at as f32);
    }
}

#[test]
fn two_starts_grow_two_branches() {
    for seed in 0..5 {
        let (agent, _) = train_in(TimeLimit::new(Fork::new(), 50), seed, 80);
        let skills = agent.skills();
        assert_eq!(skills.iter().filter(|s| s.enters.is_none()).count(), 2, "two skills reach the goal");
        let mut branches: Vec<Vec<usize>> = leaves(&skills)
            .into_iter()
            .map(|leaf| {
                let chain = chain_from(&skills, leaf);
                assert_eq!(chain.len(), 2);
                let inside = |cell: &usize| {
                    let members = agent.members(&vec![*cell as f32]);
                    *cell != 4 && chain.iter().any(|k| members[*k as usize - 1])
                };
                (0..9).filter(inside).collect()
            })
            .collect();
        branches.sort();
        assert_eq!(branches, [[0, 1, 2, 3], [5, 6, 7, 8]], "seed {seed}");
    }
}

/// Two trajectories beget a skill, and every other one begins at the other end: together they make one set on either side
/// of the goal, told apart by their starts a set each.
#[test]
fn starts_far_apart_begin_branches_of_their_own() {
    let sides = |branch: f32| {
        let config = ChainConfig { gestation: 2, branch, ..usual() };
        let (agent, _) = train_with(&config, TimeLimit::new(Fork::new(), 50), 0, 80);
        let to_goal = agent.skills().into_iter().filter(|skill| skill.enters.is_none());
        let side = |k: u32, cells: [usize; 2]| {
            cells.iter().any(|cell| agent.members(&vec![*cell as f32])[k as usize - 1])
        };
        to_goal.map(|skill| (side(skill.skill, [2, 3]), side(skill.skill, [5, 6]))).collect::<Vec<_>>()
    };
    assert_eq!(sides(0.0)[0], (true, true));
    let mut apart = sides(1.0);
    apart.sort_unstable();
    assert_eq!(apart, [(false, true), (true, false)]);
}
