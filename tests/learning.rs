//! Deep skill chaining learns the Point-Maze, on either backend: the main job in small.

mod support;

use std::fs;

use support::{Folder, inroads, succeed};

fn learns(backend: &str) {
    let folder = Folder::new(&format!("learning-{backend}"));
    let run = folder.join("run");
    let mut training = inroads(&["train", "dsc", "point-maze", "--backend", backend, "--out"]);
    succeed(training.arg(&run).args(["--set", "episodes=80"]));

    let text = fs::read_to_string(run.join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&text).unwrap();
    let number = |key: &str| summary[key].as_f64().unwrap_or_else(|| panic!("{key} in {text}"));
    assert_eq!(number("episodes"), 80.0);
    // Noise alone succeeds in a quarter of the episodes.
    assert!(number("success_last_50") >= 0.9, "{text}");
    assert!(number("skills") >= 2.0, "{text}");
    let figures = ["learning-curve.png", "initiation-sets.png", "trajectories.png"];
    assert!(figures.iter().all(|name| run.join("figures").join(name).is_file()));

    succeed(inroads(&["render"]).arg(&run));
    assert!(run.join("figures/episode-0.gif").is_file());
    let table = succeed(inroads(&["evaluate"]).arg(&run)).stdout;
    assert!(String::from_utf8_lossy(&table).contains("the chain alone"));
}

#[test]
fn a_chain_is_learned_on_flex() {
    learns("flex");
}

#[test]
#[cfg(feature = "ndarray")]
fn a_chain_is_learned_on_ndarray() {
    learns("ndarray");
}
