//! Several episodes side by side: the same episodes where nothing is learned, exact to resume, and refused where an agent
//! lives one at a time.

mod support;

use std::{fs, path::Path, process::Command};

use support::{Folder, fail, inroads, newest_checkpoint, numbers, succeed};

/// A training of Q-learning in a corridor, in so many lanes.
fn training(out: &Path, lanes: u64, episodes: u64, sets: &[&str]) -> Command {
    let mut command = inroads(&["train", "q-learning", "corridor-5", "--seed", "2", "--out"]);
    command.arg(out).args(["--set", &format!("lanes={lanes}"), "--set", &format!("episodes={episodes}")]);
    for set in [&["checkpoint_every=4", "memory.warm_up=8"], sets].concat() {
        command.args(["--set", set]);
    }
    command
}

#[test]
fn what_an_episode_draws_depends_on_its_number_alone() {
    let folder = Folder::new("lanes");
    let runs = [1, 3].map(|lanes| {
        let run = folder.join(&lanes.to_string());
        // Nothing is learned before the warm-up is over: so each episode is what its streams make of it.
        succeed(&mut training(&run, lanes, 12, &["memory.warm_up=1000000"]));
        fs::read_to_string(run.join("metrics.jsonl")).unwrap()
    });
    assert_eq!(runs[0].lines().count(), 12);
    assert_eq!(runs[0], runs[1]);
}

#[test]
fn lanes_learn_play_whole_rounds_and_resume_exactly() {
    let folder = Folder::new("lanes-resume");
    let whole = folder.join("whole");
    succeed(&mut training(&whole, 3, 40, &[]));
    let metrics = fs::read_to_string(whole.join("metrics.jsonl")).unwrap();
    assert_eq!(numbers(&whole.join("metrics.jsonl"), "episode"), (0..42).collect::<Vec<_>>());
    // Four steps lead to the end; a tenth of them are random.
    let steps = numbers(&whole.join("metrics.jsonl"), "steps");
    assert!(steps[30..].iter().sum::<u64>() < 12 * 6, "{steps:?}");

    let run = folder.join("run");
    succeed(&mut training(&run, 3, 10, &[]));
    let resume = |sets: &[&str]| {
        let mut command = inroads(&["train", "q-learning", "corridor-5", "--resume", "--out"]);
        command.arg(&run);
        sets.iter().for_each(|set| _ = command.args(["--set", set]));
        command
    };
    succeed(&mut resume(&["episodes=40"]));
    assert_eq!(fs::read_to_string(run.join("metrics.jsonl")).unwrap(), metrics);
    assert!(fs::read(newest_checkpoint(&run)).unwrap() == fs::read(newest_checkpoint(&whole)).unwrap());
    assert!(fail(&mut resume(&["lanes=2"])).contains("only episodes and max_steps may change"));
}

#[test]
fn who_lives_one_episode_at_a_time_says_who_lives_several() {
    let folder = Folder::new("lanes-refused");
    let train = |agent, lanes| {
        let mut command = inroads(&["train", agent, "point-corridor", "--set", lanes, "--out"]);
        fail(command.arg(folder.join("run")))
    };
    let text = train("dsc", "lanes=2");
    let why = "lanes is 2, and agent `dsc` lives one episode at a time; set lanes = 1, or take an agent that lives several: ";
    let able = text.split_once(why).unwrap_or_else(|| panic!("{text}")).1.trim();
    assert!(able.split(", ").any(|name| name == "ddpg") && !able.contains("dsc"), "{text}");
    assert!(train("ddpg", "lanes=0").contains("lanes"), "no lane at all is refused too");
    assert!(!folder.join("run").exists());
}
