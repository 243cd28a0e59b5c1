//! `inroads truth` tells where skills succeed, and leaves the run as it was.

mod support;

use std::{fs, path::Path};

use serde_json::Value;
use support::{Folder, fail, inroads, newest_checkpoint, small_training, succeed};

/// Episodes before and after somebody asks.
const EPISODES: [u64; 2] = [16, 20];

/// Goes on to the second number.
fn go_on(run: &Path) {
    let mut command = inroads(&["train", "dsc", "point-corridor", "--resume", "--out"]);
    succeed(command.arg(run).args(["--set", &format!("episodes={}", EPISODES[1])]));
}

#[test]
fn a_run_goes_on_as_if_nobody_had_asked() {
    let folder = Folder::new("truth");
    let [asked, other] = ["asked", "other"].map(|name| folder.join(name));
    for run in [&asked, &other] {
        succeed(&mut small_training(run, EPISODES[0]));
    }
    let before = fs::read(newest_checkpoint(&asked)).unwrap();
    let output = succeed(inroads(&["truth", "--cells", "12", "--times", "2"]).arg(&asked));
    let table = String::from_utf8(output.stdout).unwrap();
    assert!(table.contains("may start") && table.contains("the goal"), "{table}");
    assert!(fs::read(newest_checkpoint(&asked)).unwrap() == before);
    assert!(fs::metadata(asked.join("figures/truth.png")).unwrap().len() > 1000);

    let text = fs::read_to_string(asked.join("truth.json")).unwrap();
    let truth: Value = serde_json::from_str(&text).unwrap();
    assert_eq!((&truth["episodes"], &truth["times"]), (&EPISODES[0].into(), &2.into()));
    let skills = truth["skills"].as_array().unwrap();
    assert!(!skills.is_empty());
    for skill in skills {
        // 12 m × 4 m of free space, in cells of a metre.
        let cells = skill["cells"].as_array().unwrap();
        assert_eq!(cells.len(), 48);
        for cell in cells {
            let count = |what: &str| cell[what].as_u64().unwrap();
            assert_eq!(count("tried") + count("there"), 2, "{cell}");
            assert!(count("succeeded") <= count("tried") && count("may_start") <= count("tried"), "{cell}");
        }
    }
    // The first skill reaches the goal: in the cells about (8, 0) it has nothing to do.
    let first = skills[0]["cells"].as_array().unwrap();
    let there = first.iter().filter(|cell| cell["there"] == 2).count();
    assert!(skills[0]["enters"].is_null() && there < 8, "{there}");

    // The same again is the same to the byte, and the run goes on like the other.
    succeed(inroads(&["truth", "--cells", "12", "--times", "2"]).arg(&asked));
    assert!(fs::read_to_string(asked.join("truth.json")).unwrap() == text);
    for run in [&asked, &other] {
        go_on(run);
    }
    let file = |run: &Path| fs::read(run.join("metrics.jsonl")).unwrap();
    assert!(file(&asked) == file(&other));
    assert!(fs::read(newest_checkpoint(&asked)).unwrap() == fs::read(newest_checkpoint(&other)).unwrap());
}

#[test]
fn runs_without_a_map_or_without_skills_say_so() {
    let folder = Folder::new("no-truth");
    for (agent, environment, why) in [
        ("dsc-tabular", "corridor-5", "`corridor-5` has no map"),
        ("ddpg", "point-corridor", "agent `ddpg` has no skill after 2 episodes"),
    ] {
        let run = folder.join(agent);
        let mut training = inroads(&["train", agent, environment, "--set", "episodes=2", "--out"]);
        succeed(training.arg(&run));
        let text = fail(inroads(&["truth"]).arg(&run));
        assert!(text.contains(why), "{text}");
        assert!(!run.join("truth.json").exists());
    }
    let text = fail(&mut inroads(&["truth", "runs/none"]));
    assert!(text.contains("no run folder"), "{text}");
}
