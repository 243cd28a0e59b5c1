//! Pinball against rlpy's, and its pictures against its viewer's (fixtures/pinball).
//!
//! A ball that grazes a corner magnifies the last digit of where it came from, so every decision starts from the
//! recorded state before it.

#[path = "../../tests/support/fixtures.rs"]
mod fixtures;
#[path = "../../tests/support/recorded.rs"]
mod recorded;

use inroads_envs::{
    End, Frame,
    pinball::{Ball, Configuration, Pinball, Rules},
    world::{Drawn, Painter, World},
};
use inroads_sim::raster::Format;
use serde_json::Value;

/// The agreement that is asked for; states are recorded to 1e-10.
const TOLERANCE: f64 = 1e-9;

fn text<'a>(record: &'a Value, key: &str) -> &'a str {
    record[key].as_str().unwrap_or_else(|| panic!("no text {key}"))
}

fn numbers(list: &Value) -> Vec<f64> {
    let list = list.as_array().expect("a list of numbers");
    list.iter().map(|number| number.as_f64().expect("a number")).collect()
}

fn pinball(record: &Value) -> Pinball {
    let configuration = Configuration::named(text(record, "config")).expect("one of the five");
    Pinball::new(configuration, Rules::default()).expect("sound rules")
}

/// A ball from `x y` or `x y xdot ydot`.
fn ball(of: &[f64]) -> Ball {
    match of[..] {
        [x, y] => Ball::at([x, y]),
        [x, y, xdot, ydot] => Ball { x, y, xdot, ydot },
        _ => panic!("a ball has two or four numbers"),
    }
}

#[test]
fn conformance_pinball_every_decision() {
    let mut compared = 0;
    for record in fixtures::records("pinball", "trajectories") {
        let mut world = pinball(&record);
        let mut before = ball(&numbers(&record["start_xy"]));
        let (actions, rewards) = (numbers(&record["actions"]), numbers(&record["rewards"]));
        let states = record["states_x_y_xdot_ydot"].as_array().expect("a list of states");
        assert_eq!((actions.len(), rewards.len()), (states.len(), states.len()));
        assert!(world.free(before.centre()));
        let mut ended = false;
        for (i, state) in states.iter().enumerate() {
            let what = format!("{} {}, decision {i}", text(&record, "config"), record["seed"]);
            world.restore(before).expect("a ball");
            let step = world.act(actions[i] as usize);
            let (ours, theirs) = (world.ball(), ball(&numbers(state)));
            let pairs =
                [(ours.x, theirs.x), (ours.y, theirs.y), (ours.xdot, theirs.xdot), (ours.ydot, theirs.ydot)];
            assert!(pairs.iter().all(|(a, b)| (a - b).abs() <= TOLERANCE), "{what}:\n{ours:?}\n{theirs:?}");
            assert_eq!(f64::from(step.reward), rewards[i], "{what}: reward");
            assert!(!ended, "{what}: after the end");
            ended = step.end == Some(End::Terminated);
            (before, compared) = (theirs, compared + 1);
        }
        let what = format!("{} {}: ended", text(&record, "config"), record["seed"]);
        assert_eq!(ended, record["ended"].as_bool().expect("ended"), "{what}");
    }
    assert!(compared > 0, "no decisions");
}

#[test]
fn conformance_pinball_pictures_pixel_by_pixel() {
    for record in fixtures::records("pinball", "renders") {
        let mut world = pinball(&record);
        world.restore(ball(&numbers(&record["ball_xy"]))).expect("a ball");
        let mut frame = Frame::default();
        world.painter(Format::NATIVE).paint(&world, &mut frame);
        let file = text(&record, "file");
        let (size, theirs) = recorded::picture(&fixtures::folder("").join(file));
        assert_eq!(frame.size(), size, "{file}");
        let wrong = frame.bytes().as_chunks::<3>().0.iter().zip(theirs.as_chunks().0);
        let wrong: Vec<_> =
            wrong.enumerate().filter(|(_, (a, b))| a != b).map(|(i, _)| [i % 500, i / 500]).collect();
        assert!(wrong.is_empty(), "{file}: {} pixels differ, the first at {:?}", wrong.len(), wrong[0]);
    }
}
