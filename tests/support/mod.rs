//! What tests of the command need: a folder of their own, and small fast runs.
#![allow(dead_code)] // each test binary uses its part

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output},
};

/// A folder that is gone when the test is over.
pub(crate) struct Folder(PathBuf);

impl Folder {
    pub(crate) fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("inroads-test-{name}-{}", std::process::id()));
        let _left_over = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).expect("the system's temporary folder can be written");
        Self(path)
    }

    pub(crate) fn join(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _best_effort = fs::remove_dir_all(&self.0);
    }
}

/// The command, ready for more arguments.
pub(crate) fn inroads(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_inroads"));
    command.args(arguments).env("RAYON_NUM_THREADS", "1");
    command
}

/// A training of `dsc` with small networks, so that a test takes seconds.
pub(crate) fn small_training(out: &Path, episodes: u64) -> Command {
    let mut command = inroads(&["train", "dsc", "point-corridor", "--out"]);
    command.arg(out);
    let sets = [
        "seed=3".into(),
        format!("episodes={episodes}"),
        "checkpoint_every=4".into(),
        "evaluation_episodes=3".into(),
        "policy.hidden=[32, 32]".into(),
        "over_options.hidden=[32]".into(),
        "memory.warm_up=100".into(),
        "chain.gestation=2".into(),
        "chain.pretrain=50".into(),
    ];
    for set in sets {
        command.args(["--set", &set]);
    }
    command
}

/// Runs to the end and asserts that all went well.
pub(crate) fn succeed(command: &mut Command) -> Output {
    let output = command.output().expect("the command starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    output
}

/// Runs to the end and asserts exit code 2; the error's text.
pub(crate) fn fail(command: &mut Command) -> String {
    let output = command.output().expect("the command starts");
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{text}");
    text
}

/// The newest checkpoint of a run.
pub(crate) fn newest_checkpoint(run: &Path) -> PathBuf {
    let mut files: Vec<_> = fs::read_dir(run.join("checkpoints"))
        .expect("a run has checkpoints")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    files.sort();
    files.pop().expect("at least one checkpoint")
}

/// The values of one field of a file of JSON lines.
pub(crate) fn numbers(file: &Path, field: &str) -> Vec<u64> {
    let text = fs::read_to_string(file).expect("the file is there");
    text.lines()
        .map(|line| serde_json::from_str::<serde_json::Value>(line).expect("a line of JSON")[field].as_u64())
        .map(|number| number.expect("a number"))
        .collect()
}
