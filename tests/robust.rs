//! Robust skill chaining with networks: learns, is tested while it trains, and goes on to the same bits.

mod support;

use std::{fs, path::Path, process::Command};

use inroads::run::TestMetrics;
use support::{Folder, fail, inroads, succeed};

/// A training with small networks: of plans, or of TD3 alone.
fn training(out: &Path, episodes: u64, model: bool) -> Command {
    let mut command = inroads(&["train", "robust-dsc", "point-corridor", "--out"]);
    command.arg(out);
    let sets = [
        format!("episodes={episodes}"),
        format!("control.model={model}"),
        "seed=1".into(),
        "starts=anywhere".into(),
        "test_every=5".into(),
        "test_episodes=2".into(),
        "evaluation_episodes=5".into(),
        "checkpoint_every=5".into(),
        "policy.hidden=[32, 32]".into(),
        "policy.batch=64".into(),
        "memory.warm_up=500".into(),
        "memory.updates_per_step=1".into(),
        "chain.gestation=2".into(),
        "chain.segment=5".into(),
        "chain.timeout=20".into(),
        "chain.initiation_episodes=2".into(),
        "chain.initiation_successes=2".into(),
        "control.plans.dynamics.hidden=[64]".into(),
        "control.plans.ready=1500".into(),
        "control.plans.hold=2".into(),
    ];
    for set in sets {
        command.args(["--set", &set]);
    }
    command
}

fn tests(run: &Path) -> Vec<TestMetrics> {
    let text = fs::read_to_string(run.join("tests.jsonl")).expect("tests were asked for");
    text.lines().map(|line| serde_json::from_str(line).expect("a line about tests")).collect()
}

#[test]
fn a_corridor_is_chained_with_plans_and_without() {
    let folder = Folder::new("robust");
    for (model, episodes) in [(true, 60), (false, 120)] {
        let run = folder.join(if model { "plans" } else { "policies" });
        succeed(&mut training(&run, episodes, model));
        let tests = tests(&run);
        assert_eq!(
            tests.iter().map(|t| t.episodes).collect::<Vec<_>>(),
            (1..=episodes / 5).map(|n| 5 * n).collect::<Vec<_>>()
        );
        let (last, latest) = (tests.last().unwrap(), &tests[tests.len() - 4..]);
        let success = latest.iter().map(TestMetrics::success).sum::<f64>() / 4.0;
        assert!(success >= 0.75, "{latest:?}");
        assert!(last.skills.len() >= 2 && last.chain.is_some_and(|p| p > 0.0), "{last:?}");
        assert_eq!(last.skills[1].enters, Some(1), "the second skill enters the first one's set");
    }
}

#[test]
fn tests_of_a_resumed_run_are_those_of_one_that_was_never_stopped() {
    let folder = Folder::new("robust-resume");
    let (whole, stopped) = (folder.join("whole"), folder.join("stopped"));
    succeed(&mut training(&whole, 20, true));
    succeed(&mut training(&stopped, 12, true));
    let mut resume =
        inroads(&["train", "robust-dsc", "point-corridor", "--resume", "--set", "episodes=20", "--out"]);
    succeed(resume.arg(&stopped));
    for file in ["metrics.jsonl", "tests.jsonl"] {
        assert!(
            fs::read(whole.join(file)).unwrap() == fs::read(stopped.join(file)).unwrap(),
            "{file} differs"
        );
    }
}

#[test]
fn what_does_not_go_together_is_refused() {
    let refused = |sets: &[&str]| {
        let mut command = inroads(&["train", "robust-dsc", "point-corridor", "--out", "/nowhere/at-all"]);
        sets.iter().for_each(|set| _ = command.args(["--set", set]));
        fail(&mut command)
    };
    let plans = refused(&["chain.subgoals=set", "chain.explore=task"]);
    assert!(plans.contains("set model = false"), "{plans}");
    let kinds = refused(&["chain.option_reward=sparse"]);
    assert!(kinds.contains("plans.values = false"), "{kinds}");
    let blind = refused(&["chain.subgoals=set", "control.model=false"]);
    assert!(blind.contains("explore = \"task\""), "{blind}");
    let starts = refused(&["starts=everywhere"]);
    assert!(starts.contains("it must be \"anywhere\""), "{starts}");
}
