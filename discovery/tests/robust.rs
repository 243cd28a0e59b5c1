//! Robust skill chaining where every step of the answer is known.

use std::sync::Arc;

use inroads_agents::{
    Agent, Bag, Checkpoint, Context, Pace, Practice, Replay, TabularQ, classify::Nearest, encode::Select,
    episode, experience::Pay, tabular::TabularConfig,
};
use inroads_discovery::{
    ChainConfig, Chaining, Dual, Features, Hierarchy, Shared, Skilled,
    chain::{Phase, States, Subgoals},
    over_skills::Scan,
};
use inroads_envs::{
    Environment, Seed, TimeLimit,
    corridor::Corridor,
    rooms::Rooms,
    world::{Layout, Symbolic},
};

type Sets = Dual<Vec<f32>, Nearest, Nearest>;
/// Steps remembered: all of them.
const MANY: usize = 50_000;

type Robust =
    Hierarchy<Vec<f32>, usize, Chaining<Vec<f32>, usize, Sets, Shared<TabularQ, Features>, Scan, States>>;

fn agent(env: &impl Environment, actions: usize, config: &ChainConfig, capacity: usize) -> Robust {
    let place = env.spec().place.clone();
    let tables = TabularConfig { discount: 0.9, ..TabularConfig::default() };
    let replay = Replay::new(50_000).paying(Pay::ATTAINMENT);
    let pace = Pace { updates_per_step: 2.0, warm_up: 1 };
    let policy = Shared::new(TabularQ::new(actions, &tables), Practice::new(replay, pace));
    let sets = Dual::new(Arc::new(Select::new(&place)), Nearest::new(0.6), Nearest::new(0.25), 100);
    let aim = States { features: place, tolerance: 0.25 };
    Hierarchy::new(Chaining::new(config, env.spec(), sets, policy, Scan).aiming(aim), capacity)
}

fn train(
    env: &mut impl Environment<Observation = Vec<f32>, Action = usize>,
    agent: &mut Robust,
    seed: u64,
    episodes: u64,
) {
    for number in 0..episodes {
        let mut ctx = Context::training(Seed(seed), number);
        episode(env, agent, Seed(seed).number("start", number), &mut ctx, |_, _| {}).unwrap();
    }
}

/// Five cells: the answer of `corridor.rs`, by one policy that is told where to go.
fn corridor(capacity: usize) -> (TimeLimit<Corridor>, Robust) {
    let config = ChainConfig {
        gestation: 1,
        segment: 3,
        initiation_episodes: 2,
        initiation_successes: 1,
        timeout: 20,
        pretrain: 200,
        subgoals: Subgoals::DynamicProgramming,
        freeze: false,
        goal_first: true,
        ..ChainConfig::default()
    };
    let env = TimeLimit::new(Corridor::new(5), 50);
    let agent = agent(&env, 2, &config, capacity);
    (env, agent)
}

/// Cell, action and acting skill of every step of a frozen episode.
fn trace(
    agent: &Robust,
    env: &mut impl Environment<Observation = Vec<f32>, Action = usize>,
) -> Vec<(f32, usize, usize)> {
    let mut trace = Vec::new();
    let mut ctx = Context::evaluation(Seed(0), 0);
    episode(env, &mut *agent.frozen(), 0, &mut ctx, |t, skill| trace.push((t.before[0], *t.action, skill)))
        .unwrap();
    trace
}

#[test]
fn the_chain_is_the_one_that_must_be_found() {
    let (mut env, mut agent) = corridor(MANY);
    train(&mut env, &mut agent, 7, 60);
    let chain: Vec<_> = agent.skills().iter().map(|s| (s.skill, s.enters, s.phase)).collect();
    assert_eq!(chain, [(1, None, Phase::Mature), (2, Some(1), Phase::Mature)]);
    let members: Vec<_> = (0..5).map(|cell| agent.members(&vec![cell as f32])).collect();
    assert_eq!(members, [[false, true], [false, true], [true, true], [true, false], [true, false]]);
    // The second skill goes for cell 2, in which it entered the first one's set.
    assert_eq!(trace(&agent, &mut env), [(0.0, 1, 2), (1.0, 1, 2), (2.0, 1, 1), (3.0, 1, 1)]);
}

#[test]
fn a_restored_agent_goes_on_as_the_saved_one() {
    let bytes = |agent: &Robust| {
        let mut bag = Bag::default();
        agent.save(&mut bag);
        bag
    };
    let (mut env, mut agent) = corridor(MANY);
    train(&mut env, &mut agent, 7, 20);
    let (_, mut again) = corridor(MANY);
    again.load(&bytes(&agent)).unwrap();
    trace(&again, &mut env);
    for agent in [&mut agent, &mut again] {
        for number in 20..30 {
            let mut ctx = Context::training(Seed(7), number);
            episode(&mut env, agent, number, &mut ctx, |_, _| {}).unwrap();
        }
    }
    assert!(bytes(&agent) == bytes(&again));
}

#[test]
fn what_is_forgotten_is_no_lesson_any_more() {
    // New skills are taught the past, behind what is newer; then the past is forgotten, however full the replay.
    let (mut env, mut agent) = corridor(60);
    train(&mut env, &mut agent, 7, 60);
    let skills = agent.skills();
    assert_eq!(skills.iter().map(|s| s.enters).collect::<Vec<_>>(), [None, Some(1)]);
    let oldest = agent.experience().first();
    assert!(skills.iter().all(|s| s.born < oldest), "{oldest}");
    assert_eq!(trace(&agent, &mut env).len(), 4);
}

/// An open room with the goal in its middle. The goal's skill is known to succeed from all around it, so that a subgoal
/// drawn at random may lie behind the goal; the one that is planned lies before it (4.2.3).
const ROOM: &str = "
#########
#S      #
#       #
#       #
#   G   #
#       #
#       #
#       #
#########";

/// Mean steps of frozen episodes from the corner, whose shortest path has six.
fn steps(subgoals: Subgoals, seed: u64) -> f64 {
    let room = |layout| TimeLimit::new(Symbolic::new(Rooms::new(ROOM, 0.0, 60).unwrap(), layout), 60);
    let config = ChainConfig {
        gestation: 8,
        segment: 3,
        initiation_episodes: 5,
        initiation_successes: 3,
        timeout: 20,
        pretrain: 1000,
        subgoals,
        hindsight: 8,
        freeze: false,
        goal_first: true,
        ..ChainConfig::default()
    };
    let mut env = room(Layout::FixedMap(0));
    let mut agent = agent(&env, 4, &config, MANY);
    train(&mut env, &mut agent, seed, 300);
    let mut corner = room(Layout::Fixed(0));
    let mut total = 0;
    for index in 0..20 {
        let mut ctx = Context::evaluation(Seed(seed), index);
        total += episode(&mut corner, &mut *agent.frozen(), index, &mut ctx, |_, _| {}).unwrap().steps;
    }
    f64::from(total) / 20.0
}

#[test]
fn planned_subgoals_lie_on_the_shortest_path_and_drawn_ones_need_not() {
    assert_eq!(steps(Subgoals::DynamicProgramming, 1), 6.0);
    assert!(steps(Subgoals::Sample, 1) > 6.0);
}
