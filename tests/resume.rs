//! A run that was stopped and resumed is the run that was never stopped.

mod support;

use std::{
    fs,
    path::Path,
    process::{Child, Command, Stdio},
    thread::sleep,
    time::Duration,
};

use support::{Folder, inroads, newest_checkpoint, numbers, small_training, succeed};

const EPISODES: u64 = 30;

/// Starts a training and lets it go until `episodes` are in its log.
fn train_until(run: &Path, episodes: usize) -> Child {
    let mut child = small_training(run, EPISODES).stderr(Stdio::null()).spawn().expect("the command starts");
    loop {
        let log = fs::read_to_string(run.join("metrics.jsonl")).unwrap_or_default();
        if log.lines().count() >= episodes {
            return child;
        }
        let ended = child.try_wait().expect("the child can be asked");
        assert!(ended.is_none(), "the training ended before it could be stopped");
        sleep(Duration::from_millis(1));
    }
}

fn resume(run: &Path) {
    let mut command = inroads(&["train", "dsc", "point-corridor", "--resume", "--out"]);
    succeed(command.arg(run));
}

#[test]
fn a_resumed_run_is_bit_for_bit_the_run_that_was_never_stopped() {
    let folder = Folder::new("resume");
    let whole = folder.join("whole");
    succeed(&mut small_training(&whole, EPISODES));
    let metrics = fs::read(whole.join("metrics.jsonl")).unwrap();
    let weights = fs::read(newest_checkpoint(&whole)).unwrap();
    let total = *numbers(&whole.join("metrics.jsonl"), "env_steps").last().unwrap();

    for (name, signal, after) in [("early", "INT", 2), ("killed", "KILL", 10), ("late", "INT", 21)] {
        let run = folder.join(name);
        let mut child = train_until(&run, after);
        let id = child.id().to_string();
        Command::new("kill").args([&format!("-{signal}"), &id]).status().expect("kill is there");
        child.wait().unwrap();
        let left = newest_checkpoint(&run);
        let episodes: u64 = left.file_stem().unwrap().to_str().unwrap().parse().unwrap();
        assert!(episodes < EPISODES, "{name}: stopped too late to show anything");

        resume(&run);
        assert!(fs::read(run.join("metrics.jsonl")).unwrap() == metrics, "{name}: metrics differ");
        assert!(fs::read(newest_checkpoint(&run)).unwrap() == weights, "{name}: final state differs");

        // The last session ran the steps that remained after the checkpoint, and no others.
        let env_steps = numbers(&run.join("metrics.jsonl"), "env_steps");
        let before = env_steps[episodes as usize - 1];
        let ran = *numbers(&run.join("sessions.jsonl"), "steps").last().unwrap();
        assert_eq!(ran, total - before, "{name}");
    }
}
