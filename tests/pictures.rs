//! Agents that see pictures, by the command: trained, stopped and gone on, watched, drawn; and those that do not, refused.

mod support;

use std::{fs, path::Path, process::Command};

use support::{Folder, fail, inroads, newest_checkpoint, succeed};

/// Tabular learning of one layout of DoorKey-5x5 from pictures of 40 by 40 pixels.
fn training(out: &Path, episodes: u64) -> Command {
    let mut command = inroads(&["train", "counts-q", "door-key-5x5", "--see", "rgb", "--layout", "fixed:42"]);
    command.arg("--out").arg(out);
    for set in [&format!("episodes={episodes}"), "checkpoint_every=20", "evaluation_episodes=5"] {
        command.args(["--set", set]);
    }
    command
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn a_table_learns_to_open_the_door_from_pictures_and_everything_that_can_be_drawn_is() {
    let folder = Folder::new("pictures");
    let run = folder.join("run");
    let output = succeed(&mut training(&run, 200));
    let said = text(&output.stderr);
    assert!(
        said.contains("seen as pictures, which have no coordinates") && said.contains("inroads render"),
        "{said}"
    );
    let summary: serde_json::Value =
        serde_json::from_slice(&fs::read(run.join("summary.json")).unwrap()).unwrap();
    assert_eq!(summary["eval_success"], 1.0, "{summary}");
    assert_eq!(summary["eval_skill_share"], 0.0);
    let config = fs::read_to_string(run.join("config.toml")).unwrap();
    assert!(config.contains("capacity = 100000\n"), "pictures of 4800 bytes: {config}");

    let figures = run.join("figures");
    assert!(figures.join("learning-curve.png").exists() && !figures.join("trajectories.png").exists());
    succeed(inroads(&["render", "--episode", "3"]).arg(&run));
    let film = fs::read(figures.join("episode-3.gif")).unwrap();
    assert!(film.starts_with(b"GIF89a") && film.len() > 5000, "{} bytes", film.len());
    succeed(inroads(&["plot"]).arg(&run));
    let told = text(&succeed(inroads(&["evaluate"]).arg(&run)).stdout);
    assert!(told.contains("frozen success, 5 episodes          100 %"), "{told}");

    // 15,000 pictures of 4800 bytes, of which each is almost the one before it.
    let bytes = fs::metadata(newest_checkpoint(&run)).unwrap().len();
    assert!(bytes < 6_000_000, "{bytes} bytes");
    for command in ["plan", "goals"] {
        let said = fail(inroads(&[command]).arg(&run));
        assert!(said.contains("skill graph"), "{said}");
    }
}

#[test]
fn a_resumed_run_of_pictures_is_the_run_that_was_never_stopped() {
    let folder = Folder::new("pictures-resume");
    let (whole, parts) = (folder.join("whole"), folder.join("parts"));
    succeed(&mut training(&whole, 30));
    succeed(&mut training(&parts, 13));
    let mut resume =
        inroads(&["train", "counts-q", "door-key-5x5", "--resume", "--set", "episodes=30", "--out"]);
    succeed(resume.arg(&parts));
    for file in ["metrics.jsonl", "checkpoints/00000030.ckpt"] {
        assert!(fs::read(whole.join(file)).unwrap() == fs::read(parts.join(file)).unwrap(), "{file} differs");
    }
}

#[test]
fn an_agent_that_reads_no_pictures_is_answered_with_those_that_do() {
    let folder = Folder::new("pictures-refused");
    let run = folder.join("run");
    let refused = |agent: &str, environment: &str, more: &[&str]| {
        let mut command = inroads(&["train", agent, environment, "--see", "rgb", "--out"]);
        let said = fail(command.arg(&run).args(more));
        assert!(!run.exists(), "a refused training left a folder");
        said
    };
    for (agent, environment) in [("dsc-tabular", "door-key-5x5"), ("proto-goals", "river")] {
        let said = refused(agent, environment, &[]);
        assert!(
            said.contains(&format!("`{agent}` does not read")) && said.contains("q-learning, counts-q"),
            "{said}"
        );
        assert!(said.contains("--see symbols"), "{said}");
    }
    let said = refused("counts-q", "door-key-5x5", &["--set", "novelty.counts=features"]);
    assert!(said.contains("pictures have no features") && said.contains("novelty.counts"), "{said}");
}
