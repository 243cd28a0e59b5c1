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
    Actor, Agent, Context, Pace, TabularQ, classify::Nearest, encode::Select, episode, tabular::TabularConfig,
};
use inroads_discovery::{
    Binary, ChainConfig, Chaining, Hierarchy, PerSkill, Skilled,
    chain::Phase,
    over_skills::{Epsilon, TabularOverSkills},
};
use inroads_envs::{Environment, Seed, TimeLimit, corridor::Corridor};

type Dsc = Hierarchy<
    Vec<f32>,
    usize,
    Chaining<Vec<f32>, Binary<Vec<f32>, Nearest>, PerSkill<TabularQ>, TabularOverSkills>,
>;

fn agent(env: &impl Environment) -> Dsc {
    let config = ChainConfig {
        gestation: 1,
        segment: 3,
        initiation_episodes: 2,
        initiation_successes: 1,
        timeout: 5,
        pretrain: 50,
        ..ChainConfig::default()
    };
    let tables = TabularConfig { discount: 0.9, ..TabularConfig::default() };
    let policy = PerSkill::new(
        TabularQ::new(2, &tables),
        TabularQ::clone,
        1000,
        Pace { updates_per_step: 1.0, warm_up: 1 },
    );
    let initiation = Binary::new(Arc::new(Select::new(&env.spec().place)), Nearest::new(0.25), 100);
    let epsilon = Epsilon { start: 0.5, end: 0.1, decisions: 200 };
    let over = TabularOverSkills::new(0.5, epsilon);
    Hierarchy::new(Chaining::new(&config, env.spec(), initiation, policy, over), 1000)
}

/// Trains until the episode after which nothing new can happen, and tells when each skill was born and fixed.
fn train(seed: u64, episodes: u64) -> (Dsc, Vec<(u64, usize)>) {
    let mut env = TimeLimit::new(Corridor::new(5), 50);
    let mut agent = agent(&env);
    let mut births = Vec::new();
    for number in 0..episodes {
        let mut ctx = Context::training(Seed(seed), number);
        let start = Seed(seed).number("start", number);
        episode(&mut env, &mut agent, start, &mut ctx, |_, _| {}).unwrap();
        let skills = agent.skills().len();
        if births.last().map_or(0, |(_, known)| *known) < skills {
            births.push((number, skills));
        }
    }
    (agent, births)
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
    assert!(bytes(&agent) == before);
}

#[test]
fn a_covered_start_ends_the_chain() {
    let (agent, _) = train(3, 200);
    assert_eq!(agent.skills().len(), 2);
}
