//! Sokoban against gym-sokoban (fixtures/sokoban): every recorded step from its recorded room, the pictures of the tiny
//! world, and, as far as few records allow, what its generator makes.

#[path = "../../tests/support/fixtures.rs"]
mod fixtures;
#[path = "../../tests/support/recorded.rs"]
mod recorded;

use std::collections::BTreeMap;

use inroads_envs::sokoban::{Cell, Look, Room, Settings, Sokoban};
use inroads_envs::world::{Drawn, Layout, Painter, Symbolic, World};
use inroads_envs::{End, Environment, Frame, TimeLimit};
use inroads_sim::raster::Format;
use serde_json::Value;

fn room(record: &Value, state: &str) -> Room {
    let codes = |array: &str| -> Vec<Vec<u8>> {
        serde_json::from_value(record[array].clone()).expect("an array of rows of codes")
    };
    Room::of_codes(&codes("room_fixed"), &codes(state)).unwrap_or_else(|why| panic!("{why}"))
}

/// `room_fixed` or `room_state` of a room.
fn array(room: &Room, code: fn(&Cell) -> u8) -> Value {
    let rows = room.cells().chunks(room.size()[1]);
    rows.map(|row| row.iter().map(code).collect::<Value>()).collect()
}

/// Row, column and code of the cells that differ.
fn changes(before: &Room, after: &Room) -> Value {
    let codes = before.cells().iter().zip(after.cells()).map(|(before, after)| [before.code(), after.code()]);
    let changed = codes.enumerate().filter(|(_, [before, after])| before != after);
    changed
        .map(|(at, [_, code])| Value::from(vec![at / before.size()[1], at % before.size()[1], code.into()]))
        .collect()
}

fn number(record: &Value, key: &str) -> usize {
    record[key].as_u64().unwrap_or_else(|| panic!("no number {key}")) as usize
}

#[test]
fn conformance_sokoban_every_step() {
    for record in fixtures::records("sokoban", "episodes") {
        let seed = &record["seed"];
        let start = room(&record, "room_state0");
        assert_eq!(serde_json::json!(start.size()), record["dim_room"], "seed {seed}");
        assert_eq!(start.box_count() as usize, number(&record, "num_boxes"), "seed {seed}");
        assert_eq!(serde_json::json!(start.player()), record["player0"], "seed {seed}");
        let limit = number(&record, "max_steps") as u32;
        let world = Sokoban::of(start, Settings::default()).expect("a room to be solved");
        let mut env = TimeLimit::new(Symbolic::new(world, Layout::Random), limit);
        env.reset(0);
        let actions: Vec<usize> = serde_json::from_value(record["actions"].clone()).expect("actions");
        let steps = record["steps"].as_array().expect("steps");
        assert!(!steps.is_empty() && steps.len() == actions.len(), "seed {seed}");
        for (number, (action, expected)) in actions.iter().zip(steps).enumerate() {
            let before = env.inner().world().room().clone();
            let step = env.step(action).unwrap_or_else(|why| panic!("seed {seed}, step {number}: {why}"));
            let room = env.inner().world().room();
            let mut alone = before.clone();
            let moved = alone.act(*action);
            assert_eq!(&alone, room, "seed {seed}, step {number}");
            assert_eq!(step.end == Some(End::Terminated), room.solved(), "seed {seed}, step {number}");
            let reward = expected[0].as_f64().expect("a reward") as f32;
            let found = (step.reward, step.end.is_some(), moved.player, moved.pushed, changes(&before, room));
            let flag = |at: usize| expected[at] == 1;
            assert_eq!(
                found,
                (reward, flag(1), flag(2), flag(3), expected[4].clone()),
                "seed {seed}, step {number}"
            );
        }
        let room = env.inner().world().room();
        assert_eq!(array(room, |cell| cell.code()), record["room_state_end"], "seed {seed}");
        assert_eq!(array(room, |cell| cell.fixed_code()), record["room_fixed"], "seed {seed}");
    }
}

#[test]
fn conformance_sokoban_pictures() {
    for record in fixtures::records("sokoban", "renders") {
        let file = record["file"].as_str().expect("a file");
        let look = Look::Flat(number(&record, "scale") as u32);
        let settings = Settings { look, ..Settings::default() };
        let room = room(&record, "room_state");
        // A room that is solved is no world; any other of its size draws it.
        let mut world = Sokoban::new(Settings { size: room.size(), boxes: 1, ..settings }).expect("rooms");
        inroads_envs::Snapshot::load(&mut world, &room);
        let mut frame = Frame::default();
        world.painter(Format::NATIVE).paint(&world, &mut frame);
        let (size, bytes) = recorded::picture(&fixtures::folder("").join(file));
        assert_eq!((frame.size(), frame.channels()), (size, 3), "{file}");
        assert!(frame.bytes() == bytes, "{file} differs");
    }
}

/// Free cells, and how far boxes are from the targets that they came from.
#[derive(Default)]
struct Sample {
    floor: Vec<f64>,
    distance: Vec<f64>,
}

/// What a walk of 34 steps hollows out differs by a quarter from room to room, and there are few records: means are
/// compared to four standard errors, which would notice another stamp, another length of the walk or boxes that are not
/// pulled as far as they can be.
#[test]
fn conformance_sokoban_rooms_are_alike() {
    let mut theirs: BTreeMap<(Vec<u64>, usize), Sample> = BTreeMap::new();
    for record in fixtures::records("sokoban", "episodes") {
        let size: Vec<u64> = serde_json::from_value(record["dim_room"].clone()).expect("a size");
        assert_eq!(
            number(&record, "gen_steps") as u64,
            17 * (size[0] + size[1]) / 10,
            "the length of the walk"
        );
        let room = room(&record, "room_state0");
        assert_eq!(room.on_target(), 0, "every box is off its target");
        let pairs: Vec<[[usize; 2]; 2]> =
            serde_json::from_value(record["box_mapping_target_to_box"].clone()).expect("pairs of cells");
        assert!(pairs.iter().all(|&[target, at]| room.cell(target).is_target() && room.cell(at).is_box()));
        let sample = theirs.entry((size, number(&record, "num_boxes"))).or_default();
        sample.floor.push(free(&room));
        let apart = |[a, b]: &[[usize; 2]; 2]| (a[0].abs_diff(b[0]) + a[1].abs_diff(b[1])) as f64;
        sample.distance.push(pairs.iter().map(apart).sum());
    }
    for ((size, boxes), theirs) in theirs {
        let settings = Settings { size: [size[0] as usize, size[1] as usize], boxes, ..Settings::default() };
        let mut world = Sokoban::new(settings).expect("rooms");
        let mut ours = Sample::default();
        for seed in 0..300 {
            world.begin(Layout::Random.draw(seed));
            ours.floor.push(free(world.room()));
            ours.distance.push(pushed(&world));
        }
        near(&ours.floor, &theirs.floor, "free cells");
        near(&ours.distance, &theirs.distance, "distance");
    }
}

fn free(room: &Room) -> f64 {
    room.cells().iter().filter(|&&cell| cell != Cell::Wall).count() as f64
}

/// How far boxes come when the world's solution is played, each from where it begins to where it ends.
fn pushed(world: &Sokoban) -> f64 {
    let mut room = world.room().clone();
    let mut boxes: Vec<[[usize; 2]; 2]> = room.boxes().map(|at| [at, at]).collect();
    for &action in world.solution().expect("a room made by chance") {
        let before = room.player();
        let moved = room.act(action.into());
        let after = room.player();
        if moved.pushed {
            let pushed = boxes.iter_mut().find(|[_, now]| *now == after).expect("a box where the player is");
            pushed[1] = std::array::from_fn(|axis| 2 * after[axis] - before[axis]);
        }
    }
    assert!(room.solved(), "the solution solves");
    boxes.iter().map(|[a, b]| (a[0].abs_diff(b[0]) + a[1].abs_diff(b[1])) as f64).sum()
}

fn near(ours: &[f64], theirs: &[f64], what: &str) {
    let mean = |sample: &[f64]| sample.iter().sum::<f64>() / sample.len() as f64;
    let [a, b] = [mean(ours), mean(theirs)];
    let deviation = mean(&ours.iter().map(|x| (x - a).powi(2)).collect::<Vec<_>>()).sqrt();
    let error = deviation * (1.0 / ours.len() as f64 + 1.0 / theirs.len() as f64).sqrt();
    assert!((a - b).abs() < 4.0 * error, "{what}: {a:.2} ± {error:.2} here, {b:.2} there");
}
