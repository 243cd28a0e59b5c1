//! Runs of an agent with a graph and goals that are known by hand.

use std::{fs, path::PathBuf, sync::atomic::AtomicBool};

use super::{GoalSummary, GraphSummary, Run, RunError};
use crate::{
    config::Config,
    draw,
    session::{Protocol, stub},
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
