//! Runs without a graph or goals say so, and what names no place is refused.

mod support;

use support::{Folder, fail, inroads, succeed};

#[test]
fn a_run_without_a_graph_has_no_plan_and_no_goals() {
    let folder = Folder::new("no-graph");
    let run = folder.join("run");
    let mut training = inroads(&["train", "q-learning", "corridor-5", "--set", "episodes=2", "--out"]);
    succeed(training.arg(&run));
    let text = fail(inroads(&["plan", "--from", "start", "--to", "goal", "--execute"]).arg(&run));
    assert!(text.contains("no skill graph") && text.contains("inroads list"), "{text}");
    let text = fail(inroads(&["goals"]).arg(&run));
    assert!(text.contains("`q-learning` has neither goals nor a skill graph"), "{text}");
}

#[test]
fn what_names_no_place_is_refused_with_what_would() {
    let text = fail(&mut inroads(&["plan", "runs/none", "--to", "there"]));
    assert!(text.contains("`there` is no place") && text.contains("a vertex's number"), "{text}");
    let text = fail(&mut inroads(&["plan", "runs/none", "--times", "3"]));
    assert!(text.contains("--execute"), "{text}");
    for command in ["plan", "goals"] {
        let text = fail(&mut inroads(&[command, "runs/none"]));
        assert!(text.contains("no run folder"), "{text}");
    }
}
