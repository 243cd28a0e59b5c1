//! Environments are drawn, and walked in with maps and bodies of the user's own.

mod support;

use std::{fs, io::Write, process::Stdio};

use support::{Folder, fail, inroads, succeed};

#[test]
fn random_actions_in_an_environment_are_drawn() {
    let folder = Folder::new("draw");
    for (view, name) in [("above", "a.gif"), ("beside", "b.png")] {
        let out = folder.join(name);
        succeed(inroads(&["render", "ant-u-maze", "--steps", "4", "--view", view, "--out"]).arg(&out));
        let bytes = fs::read(&out).unwrap();
        let magic: &[u8] = if name.ends_with("gif") { b"GIF89a" } else { b"\x89PNG" };
        assert!(bytes.starts_with(magic) && bytes.len() > 1000, "{name}: {} bytes", bytes.len());
    }
}

#[test]
fn a_body_from_a_file_walks_where_the_ant_does() {
    let folder = Folder::new("own-body");
    let out = folder.join("beetle.png");
    let body = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fixtures/mjcf/beetle.xml");
    let mut render = inroads(&["render", "ant-u-maze", "--steps", "3", "--body", body, "--out"]);
    succeed(render.arg(&out));
    assert!(fs::read(&out).unwrap().starts_with(b"\x89PNG"));
}

#[test]
fn a_run_keeps_the_map_that_it_was_given() {
    let folder = Folder::new("own-map");
    let (map, run) = (folder.join("map.txt"), folder.join("run"));
    fs::write(&map, "######\n#r..g#\n######").unwrap();
    let mut training = inroads(&["train", "ddpg", "point-corridor", "--set", "episodes=2", "--scale", "3"]);
    succeed(training.arg("--map").arg(&map).arg("--out").arg(&run));
    fs::remove_file(&map).unwrap();
    let config = fs::read_to_string(run.join("config.toml")).unwrap();
    assert!(config.contains("#r..g#") && config.contains("scale = 3.0"), "{config}");
    succeed(inroads(&["evaluate"]).arg(&run));
    succeed(inroads(&["render", "--view", "above"]).arg(&run));
    assert!(run.join("figures/episode-0.gif").exists());
    let text = fail(inroads(&["render", "--scale", "2"]).arg(&run));
    assert!(text.contains("keeps the map"), "{text}");
}

#[test]
fn a_person_plays_with_letters_when_keys_come_from_a_file() {
    let mut play =
        inroads(&["play", "corridor-5"]).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    // The seventh letter comes when the episode is over; the next episode begins at the start again.
    play.stdin.take().unwrap().write_all(b"rrlrrrr\nlq").unwrap();
    let text = String::from_utf8(play.wait_with_output().unwrap().stdout).unwrap();
    let lines: Vec<_> = text.lines().collect();
    assert_eq!(lines[3], "episode 0, step 3: left, reward -1, sum -3");
    assert_eq!(lines[6], "episode 0, step 6: right, reward 0, sum -5 · over: success");
    assert_eq!(lines[7], lines[6]);
    assert_eq!(lines[9], "episode 1, step 1: left, reward -1, sum -1");
    assert_eq!(lines.len(), 10);
}

#[test]
fn what_cannot_be_played_says_why() {
    let text = fail(&mut inroads(&["play", "point-maze"]));
    assert!(text.contains("`point-maze` is moved by numbers"), "{text}");
    let text = fail(&mut inroads(&["play", "corridor-5", "--see", "rgb"]));
    assert!(text.contains("`corridor-5` takes no option `see`"), "{text}");
}

#[test]
fn a_certificate_is_a_line_of_json_and_a_slip_in_a_name_costs_no_work() {
    let output = succeed(&mut inroads(&["certify", "corridor-5", "--episodes", "200"]));
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&found["name"], &found["random"]["episodes"]), (&"corridor-5".into(), &200.into()));
    assert!(String::from_utf8_lossy(&output.stderr).contains("of 200 episodes"));
    let output = inroads(&["certify", "corridor-5", "coridor-5"]).output().unwrap();
    assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0));
}

#[test]
fn a_person_walks_to_the_goal_of_a_grid_world_and_is_told_the_mission() {
    let mut play =
        inroads(&["play", "empty-5x5"]).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    play.stdin.take().unwrap().write_all(b"ffuff").unwrap();
    let text = String::from_utf8(play.wait_with_output().unwrap().stdout).unwrap();
    assert!(text.lines().next().unwrap().contains("get to the green goal square"), "{text}");
    assert!(text.lines().nth(5).unwrap().contains("step 5: forward, reward 0.955"), "{text}");
    assert!(text.lines().nth(5).unwrap().contains("over: success"), "{text}");
}

#[test]
fn worlds_are_drawn_so_wide_as_is_asked_and_seen_as_is_asked() {
    let folder = Folder::new("worlds");
    let out = folder.join("w.gif");
    succeed(inroads(&["render", "sokoban", "--steps", "3", "--width", "320", "--out"]).arg(&out));
    let bytes = fs::read(&out).unwrap();
    assert_eq!((&bytes[..6], &bytes[6..10]), (&b"GIF89a"[..], &[64, 1, 64, 1][..]), "320 by 320");
    // As it is seen: a grid of 64 pixels would be 128 wide.
    succeed(inroads(&["render", "door-key-8x8", "--see", "grey:84", "--width", "170", "--out"]).arg(&out));
    assert_eq!(fs::read(&out).unwrap()[6..10], [168, 0, 168, 0]);
    let text = fail(&mut inroads(&["render", "sokoban", "--see", "rgb:0"]));
    assert!(text.contains("0 by 0") && text.contains("between 1 and 4096"), "{text}");
    let text = fail(&mut inroads(&["train", "im-dsg", "sokoban", "--see", "rgb:84"]));
    assert!(text.contains("--see symbols"), "{text}");
    let text = fail(&mut inroads(&["play", "sokoban", "--layout", "fixed"]));
    assert!(text.contains("`fixed`") && text.contains("fixed:SEED"), "{text}");
}

#[test]
fn a_tabular_agent_learns_a_grid_world_and_its_run_is_drawn() {
    let folder = Folder::new("grid-run");
    let run = folder.join("run");
    let mut training = inroads(&["train", "q-learning", "door-key-5x5-thesis", "--see", "symbols"]);
    succeed(training.args(["--set", "episodes=300", "--out"]).arg(&run));
    let config = fs::read_to_string(run.join("config.toml")).unwrap();
    assert!(config.contains("see = \"symbols\""), "{config}");
    let summary = fs::read_to_string(run.join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    assert_eq!(summary["eval_success"], 1.0, "{summary}");
    succeed(inroads(&["render"]).arg(&run));
    assert!(run.join("figures/episode-0.gif").exists());
}
