//! Environments are drawn, and walked in with maps and bodies of the user's own.

mod support;

use std::fs;

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
