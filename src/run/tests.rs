//! Runs of an agent with a graph and goals that are known by hand.

use std::{fs, path::PathBuf, sync::atomic::AtomicBool};

use inroads_agents::Summary;
use inroads_envs::End;

use super::{GoalSummary, GraphSummary, Run, RunError};
use crate::{
    config::Config,
    draw,
    run::summary::{StartSummary, Stretches, by_start, stretches},
    session::{Protocol, Watched, stub},
};

/// A run in a folder that is gone when the test is over.
struct Scratch(Run, PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("inroads-run-{name}-{}", std::process::id()));
        let _left_over = fs::remove_dir_all(&path);
        let config = Config::defaults("q-learning", "corridor-5").unwrap();
        let config = config.with_assignment("episodes=25").unwrap();
        let mut run = Run::create(config, &path).unwrap();
        run.session = stub::session();
        Self(run, path)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _best_effort = fs::remove_dir_all(&self.1);
    }
}

#[test]
fn the_growth_of_goals_is_logged_and_rewound_with_the_run() {
    let Scratch(run, path) = &mut Scratch::new("goals");
    run.train(&AtomicBool::new(false), |_| ()).unwrap();
    let growth = run.folder.read_goals().unwrap();
    let episodes = |growth: &[super::Growth]| growth.iter().map(|g| g.episodes).collect::<Vec<_>>();
    assert_eq!(episodes(&growth), [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 20]);
    // Every episode visits all cells but the first once: three visits make a goal plausible, twenty master it.
    assert_eq!(growth[0].goals.len(), 5, "the first cell is never entered");
    let text = serde_json::to_string(&growth[2].goals[0]).unwrap();
    assert_eq!(text, r#"[[1],"plausible"]"#);
    assert_eq!(serde_json::to_string(&growth[10].goals[0]).unwrap(), r#"[[1],"mastered"]"#);

    // A killed run has written half a line.
    let log = path.join("goals.jsonl");
    fs::write(&log, fs::read_to_string(&log).unwrap() + r#"{"episodes":30,"go"#).unwrap();
    run.folder.rewind(9).unwrap();
    assert_eq!(run.folder.read_goals().unwrap(), growth[..9]);
}

#[test]
fn a_run_with_a_graph_and_goals_is_summarised_and_drawn() {
    let Scratch(run, path) = &mut Scratch::new("graph");
    run.train(&AtomicBool::new(false), |_| ()).unwrap();
    let (summary, frozen) = run.summarise().unwrap();
    assert_eq!(summary.graph, Some(GraphSummary { vertices: 5, edges: 6 }));
    assert_eq!(summary.goals, Some(GoalSummary { seen: 5, plausible: 5, mastered: 4 }));
    draw::figures(run, &frozen).unwrap();
    for name in ["skill-graph.png", "goal-space.png", "learning-curve.png"] {
        let bytes = fs::read(path.join("figures").join(name)).unwrap();
        assert!(bytes.starts_with(b"\x89PNG") && bytes.len() > 2000, "{name}: {} bytes", bytes.len());
    }
    assert!(!path.join("figures/kept-features.png").exists(), "all vertices ask for the same feature");
    let watched = run.session.evaluate(Protocol::Frozen, 0).unwrap().unwrap();
    assert!(!watched.covered, "the stub has no initiation sets");
}

#[test]
fn a_run_without_a_graph_or_goals_is_drawn_without_them() {
    let Scratch(run, path) = &mut Scratch::new("bare");
    run.session = crate::session::build(&run.config).unwrap();
    run.train(&AtomicBool::new(false), |_| ()).unwrap();
    let (summary, frozen) = run.summarise().unwrap();
    assert_eq!((summary.graph, summary.goals), (None, None));
    draw::figures(run, &frozen).unwrap();
    assert!(!path.join("goals.jsonl").exists() && !path.join("figures/skill-graph.png").exists());
    assert!(matches!(draw::movie(run, &frozen[0], path), Err(RunError::NoMap(_))));
}

/// An episode through these places, by these skills.
fn watched(path: &[[f32; 2]], skills: &[usize], success: bool) -> Watched {
    let end = if success { End::Terminated } else { End::Truncated };
    let summary = Summary { steps: skills.len() as u32, reward: 0.0, end, success, fault: None };
    let path = path.iter().map(|at| at.to_vec()).collect();
    Watched { path, skills: skills.to_vec(), start: 0, actions: Vec::new(), covered: false, summary }
}

#[test]
fn a_skill_is_told_where_it_began_and_ended() {
    let one = watched(&[[0.0, 0.0], [1.0, 0.0], [2.0, 1.0], [3.0, 1.0]], &[2, 2, 1], true);
    let two = watched(&[[4.0, 0.0], [5.0, 1.0]], &[2], false);
    let found = stretches(&[one, two], 2, &[0, 1]).unwrap();
    assert_eq!(found, Stretches { count: 2, began: vec![2.0, 0.0], ended: vec![3.5, 1.0] });
    assert_eq!(stretches(&[], 2, &[0, 1]), None);
}

#[test]
fn episodes_belong_to_the_start_that_is_nearest() {
    let low = watched(&[[0.1, 0.1], [1.0, 0.0]], &[0], true);
    let high = watched(&[[-0.1, 15.9], [1.0, 16.0]], &[0], false);
    let starts = [[0.0, 0.0], [0.0, 16.0]];
    let row =
        |start, episodes, success, median_steps| StartSummary { start, episodes, success, median_steps };
    let found = by_start(&starts, &[low.clone(), high, low]);
    assert_eq!(found, [row([0.0, 0.0], 2, 1.0, Some(1.0)), row([0.0, 16.0], 1, 0.0, None)]);
}
