//! What a user can get wrong is named with its mend, ends with exit code 2, and overwrites nothing.

mod support;

use std::{fs, io};

use support::{Folder, fail, inroads, newest_checkpoint, numbers, small_training, succeed};

/// Training arguments that must be refused; the error's text. Nothing may have been written.
fn refused(arguments: &[&str]) -> String {
    let folder = Folder::new("refused");
    let run = folder.join("run");
    let text = fail(inroads(&["train"]).args(arguments).arg("--out").arg(&run));
    assert!(!run.exists(), "a refused training left a folder");
    text
}

#[test]
fn an_unknown_agent_or_environment_is_answered_with_the_nearest() {
    let text = refused(&["dcs", "point-maze"]);
    assert!(text.contains("`dcs`") && text.contains("did you mean `dsc`"), "{text}");
    let text = refused(&["dsc", "point-mace"]);
    assert!(text.contains("`point-mace`") && text.contains("`point-maze`"), "{text}");
}

#[test]
fn an_agent_that_cannot_act_there_is_answered_with_those_that_can() {
    let text = refused(&["dsc", "corridor-5"]);
    assert!(text.contains("dsc-tabular"), "{text}");
}

#[test]
fn an_agent_that_goes_for_a_place_needs_a_task_that_is_one() {
    let text = refused(&["td3-her", "ant"]);
    assert!(text.contains("`ant` has no goal") && text.contains("point-reacher"), "{text}");
}

#[test]
fn a_malformed_map_or_body_is_named_with_its_place() {
    let folder = Folder::new("world");
    let file = folder.join("file");
    let path = file.to_str().unwrap();
    fs::write(&file, "#####\n#r?g#\n#####").unwrap();
    let text = refused(&["ddpg", "point-maze", "--map", path]);
    assert!(text.contains("line 2, column 3") && text.contains("'?'"), "{text}");
    fs::write(&file, "#####\n#r.g#\n#####").unwrap();
    let text = refused(&["ddpg", "point-maze", "--map", path, "--scale", "0.2"]);
    assert!(text.contains("0.2"), "{text}");
    let text = refused(&["ddpg", "reacher", "--map", path]);
    assert!(text.contains("`reacher` takes no option `map`"), "{text}");
    fs::write(&file, "<mujoco>\n<worldbody>\n<body></bdy></worldbody></mujoco>").unwrap();
    let text = refused(&["ddpg", "ant-u-maze", "--body", path]);
    assert!(text.contains("line 3"), "{text}");
    let text = refused(&["ddpg", "ant-u-maze", "--body", folder.join("none").to_str().unwrap()]);
    assert!(text.contains("none"), "{text}");
}

#[test]
fn an_unknown_key_is_answered_with_the_nearest() {
    let text = refused(&["dsc", "point-maze", "--set", "chain.gestatoin=3"]);
    assert!(text.contains("`chain.gestatoin`") && text.contains("`chain.gestation`"), "{text}");
    let text = refused(&["dsc", "point-maze", "--set", "polcy.batch=3"]);
    assert!(text.contains("`policy`"), "{text}");
}

#[test]
fn a_wrong_type_and_an_impossible_value_are_named() {
    let text = refused(&["dsc", "point-maze", "--set", "policy.batch=many"]);
    assert!(text.contains("`policy.batch`") && text.contains("string") && text.contains("integer"), "{text}");
    let text = refused(&["dsc", "point-maze", "--set", "max_steps=-5"]);
    assert!(text.contains("`max_steps`") && text.contains("-5"), "{text}");
    let text = refused(&["dsc", "point-maze", "--set", "policy.discount=1.5"]);
    assert!(text.contains("discount") && text.contains("1.5"), "{text}");
    let text = refused(&["dsc", "point-maze", "--set", "policy.batch"]);
    assert!(text.contains("key=value"), "{text}");
    let text = refused(&["dsc", "point-maze", "--backend", "cuda"]);
    assert!(text.contains("cuda") && text.contains("flex"), "{text}");
}

#[test]
fn a_configuration_that_is_not_there_or_not_toml_is_named() {
    let folder = Folder::new("configuration");
    let file = folder.join("c.toml");
    let path = file.to_str().unwrap();
    let text = refused(&["dsc", "point-maze", "--config", path]);
    assert!(text.contains(path), "{text}");
    fs::write(&file, "[chain\ngestation = 3").unwrap();
    let text = refused(&["dsc", "point-maze", "--config", path]);
    assert!(text.contains(path) && text.contains("line 1"), "{text}");
}

#[test]
fn a_folder_in_the_way_is_left_as_it_is() {
    let folder = Folder::new("exists");
    let run = folder.join("run");
    fs::create_dir(&run).unwrap();
    fs::write(run.join("precious"), "data").unwrap();
    let text = fail(&mut small_training(&run, 2));
    assert!(text.contains("exists already") && text.contains("--resume"), "{text}");
    assert_eq!(fs::read_dir(&run).unwrap().count(), 1);
    assert_eq!(fs::read_to_string(run.join("precious")).unwrap(), "data");
}

#[test]
fn a_folder_that_is_no_run_is_named() {
    let folder = Folder::new("no-run");
    for command in ["evaluate", "plot", "render"] {
        let text = fail(inroads(&[command]).arg(folder.join("nothing")));
        assert!(text.contains("no run folder"), "{text}");
    }
}

#[test]
fn a_damaged_checkpoint_is_refused_and_the_one_before_it_offered() {
    let folder = Folder::new("damaged");
    let run = folder.join("run");
    succeed(&mut small_training(&run, 8));
    let newest = newest_checkpoint(&run);
    let whole = fs::read(&newest).unwrap();
    let resume = || {
        let mut command = inroads(&["train", "dsc", "point-corridor", "--resume", "--out"]);
        command.arg(&run);
        command
    };

    fs::write(&newest, &whole[..whole.len() / 2]).unwrap();
    let text = fail(&mut resume());
    assert!(text.contains("00000008.ckpt is corrupt") && text.contains("cut off"), "{text}");
    assert!(text.contains("--checkpoint") && text.contains("00000004.ckpt"), "{text}");
    assert_eq!(fs::read(&newest).unwrap().len(), whole.len() / 2, "the damaged file was touched");

    // The offered one works, and comes to the same end.
    let older = newest.with_file_name("00000004.ckpt");
    succeed(resume().arg("--checkpoint").arg(&older));
    assert!(fs::read(newest_checkpoint(&run)).unwrap() == whole);

    fs::write(&newest, "not a checkpoint at all").unwrap();
    fs::remove_file(&older).unwrap();
    let text = fail(&mut resume());
    assert!(text.contains("corrupt") && text.contains("no intact one"), "{text}");
}

#[test]
fn a_run_is_resumed_as_what_it_is() {
    let folder = Folder::new("disagree");
    let run = folder.join("run");
    succeed(&mut small_training(&run, 2));
    let text = fail(inroads(&["train", "ddpg", "point-corridor", "--resume", "--out"]).arg(&run));
    assert!(text.contains("`dsc`") && text.contains("`ddpg`"), "{text}");
}

#[test]
fn a_nan_action_ends_the_training_with_the_component_named() {
    let folder = Folder::new("nan");
    let run = folder.join("run");
    let mut training = small_training(&run, 20);
    training.args(["--set", "policy.actor_rate=1e38"]);
    let text = fail(&mut training);
    assert!(text.contains("action component 0 is NaN") && text.contains("gradient_clip"), "{text}");
}

#[test]
fn a_training_that_diverges_stops_at_its_last_good_episode_and_says_what_diverged() {
    let folder = Folder::new("diverges");
    let (run, good) = (folder.join("run"), folder.join("good"));
    let training = |out: &std::path::Path, episodes: u64| {
        let mut command = small_training(out, episodes);
        command.args(["--set", "policy.critic_rate=1e30", "--set", "policy.batch=32"]);
        // Nothing is learned in the first two episodes of at most 200 steps; a checkpoint comes after four.
        command.args(["--set", "memory.warm_up=450"]);
        command
    };
    let said = fail(&mut training(&run, 20));
    assert!(said.contains("the gradient of the actor is NaN"), "{said}");
    assert!(said.contains("smaller rates") && said.contains("`gradient_clip`"), "{said}");
    let episodes = numbers(&run.join("metrics.jsonl"), "episode").len() as u64;
    let steps = *numbers(&run.join("metrics.jsonl"), "env_steps").last().unwrap();
    assert!(said.contains(&format!("training stopped in episode {episodes}, step ")), "{said}");
    assert!(steps > 0 && steps < 450, "{steps}");

    // What is saved is what a run has that ended before that episode, to the bit.
    let newest = newest_checkpoint(&run);
    assert!(
        newest.ends_with(format!("{episodes:08}.ckpt")) && said.contains(newest.to_str().unwrap()),
        "{said}"
    );
    succeed(&mut training(&good, episodes));
    assert!(fs::read(&newest).unwrap() == fs::read(newest_checkpoint(&good)).unwrap());

    // It can be looked at; and who goes on meets the same fault.
    succeed(inroads(&["evaluate"]).arg(&run));
    let mut resume = inroads(&["train", "dsc", "point-corridor", "--resume", "--out"]);
    let again = fail(resume.arg(&run));
    let fault = |text: &str| text.split_once("training stopped").map(|(_, fault)| fault.to_owned());
    assert_eq!(fault(&again), fault(&said));
}

#[test]
fn whoever_has_read_enough_ends_no_command() {
    // As `inroads list | head -0` has it: nobody reads.
    let (reader, writer) = io::pipe().unwrap();
    drop(reader);
    let output = succeed(inroads(&["list"]).stdout(writer));
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
}

#[cfg(target_os = "linux")]
#[test]
fn what_cannot_be_printed_for_another_reason_is_told() {
    let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = inroads(&["list"]).stdout(full).output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1));
    assert!(text.contains("standard output"), "{text}");
}
