//! Each system trained a little by the command: it says what it came to, draws it, and goes on as if never stopped.

mod support;

use std::{fs, path::Path};

use support::{Folder, fail, inroads, succeed};

/// A system, a world that is small for it, and how it is made quick.
struct Case {
    agent: &'static str,
    world: &'static str,
    episodes: u64,
    set: &'static [&'static str],
}

impl Case {
    fn train(&self, out: &Path, episodes: u64) {
        let episodes = format!("episodes={episodes}");
        let mut command = inroads(&["train", self.agent, self.world, "--seed", "1", "--set", &episodes]);
        let set = self.set.iter().chain(&["evaluation_episodes=2", "checkpoint_every=5"]);
        set.for_each(|set| _ = command.args(["--set", set]));
        succeed(command.arg("--out").arg(out));
    }

    /// Its summary; all of these figures must be there.
    fn comes_to(&self, figures: &[&str]) -> serde_json::Value {
        let folder = Folder::new(&format!("system-{}", self.agent));
        let run = folder.join("run");
        self.train(&run, self.episodes);
        for figure in figures {
            let png = fs::read(run.join("figures").join(figure)).unwrap_or_default();
            assert!(png.starts_with(b"\x89PNG"), "{}: {figure}", self.agent);
        }
        let text = fs::read_to_string(run.join("summary.json")).expect("a run has a summary");
        let summary: serde_json::Value = serde_json::from_str(&text).expect("it is JSON");
        assert_eq!(summary["agent"], self.agent);
        assert_eq!(summary["episodes"], self.episodes);
        summary
    }

    /// Half, and the other half after a resume, is the whole.
    fn resumes(&self) {
        let folder = Folder::new(&format!("resumed-{}", self.agent));
        let (whole, halves) = (folder.join("whole"), folder.join("halves"));
        self.train(&whole, self.episodes);
        self.train(&halves, self.episodes / 2);
        let longer = format!("episodes={}", self.episodes);
        let mut command = inroads(&["train", self.agent, self.world, "--resume", "--set", &longer, "--out"]);
        succeed(command.arg(&halves));
        let metrics = |run: &Path| fs::read_to_string(run.join("metrics.jsonl")).expect("a run has metrics");
        let (whole, halves) = (metrics(&whole), metrics(&halves));
        assert_eq!(whole.lines().count() as u64, self.episodes);
        let differ = whole.lines().zip(halves.lines()).position(|(whole, halves)| whole != halves);
        assert!(whole == halves, "{}: the metrics differ from episode {differ:?} on", self.agent);
    }
}

const CHAIN: Case = Case { agent: "dsc-tabular", world: "corridor-5", episodes: 10, set: &[] };
const ROBUST: Case =
    Case { agent: "robust-dsc-tabular", world: "rooms-noisy", episodes: 20, set: &["initiation.sets=ivf"] };
const DSG: Case = Case { agent: "dsg", world: "point-umaze", episodes: 20, set: &[] };
const IM_DSG: Case = Case { agent: "im-dsg", world: "nine-cells", episodes: 60, set: &[] };
const PROTO: Case =
    Case { agent: "proto-goals", world: "sparse-taxi", episodes: 40, set: &["goals.evaluate_every=1000"] };
const ABSTRACT: Case = Case { agent: "abstract-subgoals", world: "rooms", episodes: 10, set: &[] };

#[test]
fn chains_are_told_and_drawn() {
    assert_eq!(CHAIN.comes_to(&["learning-curve.png"])["paid"], true);
    assert_eq!(ROBUST.comes_to(&["learning-curve.png"])["paid"], true);
}

#[test]
fn graphs_are_told_and_drawn() {
    let vertices = |summary: &serde_json::Value| summary["graph"]["vertices"].as_u64().expect("a count");
    let dsg = DSG.comes_to(&["skill-graph.png", "trajectories.png"]);
    assert!(vertices(&dsg) >= 10, "{dsg}");
    assert_eq!(dsg["paid"], false, "the world has no task");
    let im_dsg = IM_DSG.comes_to(&["skill-graph.png", "learning-curve.png"]);
    assert!(vertices(&im_dsg) >= 1, "{im_dsg}");
    let abstracting = ABSTRACT.comes_to(&["skill-graph.png", "kept-features.png"]);
    assert!(vertices(&abstracting) >= 2, "{abstracting}");
}

#[test]
fn goals_are_told_and_drawn() {
    let summary = PROTO.comes_to(&["goal-space.png"]);
    assert!(summary["goals"]["seen"].as_u64().is_some_and(|seen| seen > 0), "{summary}");
}

#[test]
fn a_large_goal_space_of_which_nothing_was_observed_is_not_drawn() {
    let folder = Folder::new("no-goals");
    let run = folder.join("run");
    let mut training = inroads(&["train", "proto-goals", "baba-u-maze", "--set", "episodes=1"]);
    succeed(training.args(["--set", "evaluation_episodes=1", "--out"]).arg(&run));
    assert!(run.join("summary.json").exists());
}

#[test]
fn resumed_systems_are_those_that_were_never_stopped() {
    for case in [IM_DSG, DSG, PROTO, ABSTRACT] {
        case.resumes();
    }
}

/// The share of realised plans that `inroads plan --execute` reports, of three.
fn realised(run: &Path, to: &str) -> String {
    let mut command = inroads(&["plan", "--to", to, "--execute", "--times", "3"]);
    let output = succeed(command.arg(run));
    String::from_utf8_lossy(&output.stdout).into_owned()
}

#[test]
fn executed_plans_arrive() {
    let folder = Folder::new("plans-arrive");
    let maze = folder.join("maze");
    Case { episodes: 60, ..DSG }.train(&maze, 60);
    let cells = folder.join("cells");
    IM_DSG.train(&cells, IM_DSG.episodes);
    for (run, to) in [(&maze, "4,0"), (&cells, "2,2")] {
        let text = realised(run, to);
        assert!(text.contains("3 of 3; predicted"), "{text}");
    }
    let text = fail(inroads(&["plan"]).arg(&cells));
    assert!(text.contains("no region") && text.contains("such as --to "), "{text}");
    let text = fail(inroads(&["plan", "--to", "900,0"]).arg(&maze));
    assert!(text.contains("x is 900, outside `point-umaze`"), "{text}");
    let output = succeed(inroads(&["plan", "--to", "start"]).arg(&maze));
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(text.contains("both lie in the graph") && text.contains("1.00"), "{text}");
}
