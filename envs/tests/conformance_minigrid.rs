//! The grid worlds against MiniGrid 3.2.0 (fixtures/minigrid): every recorded step, tile and frame to the bit, and how
//! often layouts are drawn.

#[path = "../../tests/support/fixtures.rs"]
mod fixtures;
#[path = "../../tests/support/recorded.rs"]
mod recorded;

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::Path,
};

use inroads_envs::grid::{
    Board, Cell, Direction, Door, GridPainter, GridWorld, Inside, Maker, Pose, State, Task, tile,
};
use inroads_envs::world::{Layout, Painter, Symbolic, World};
use inroads_envs::{End, Environment, Frame, Snapshot, TimeLimit};
use inroads_sim::raster::Format;
use serde_json::Value;

/// MiniGrid rounds rewards to doubles, we to floats.
const REWARD: f64 = 1e-6;

fn number(value: &Value) -> u64 {
    value.as_u64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn bytes(values: &Value) -> Vec<u8> {
    let values = values.as_array().unwrap_or_else(|| panic!("{values} is no list"));
    values.iter().map(|value| number(value).try_into().expect("a byte")).collect()
}

/// The maker of MiniGrid's environment of that name.
fn maker(name: &str) -> Maker {
    let name = name.trim_start_matches("MiniGrid-").trim_end_matches("-v0");
    let size = |text: &str| text.parse().unwrap_or_else(|_| panic!("{name} has no size"));
    if let Some(sizes) = name.strip_prefix("DoorKey-") {
        return Maker::DoorKey { size: size(sizes.split_once('x').expect("two sizes").0) };
    }
    if let Some(sizes) = name.strip_prefix("KeyCorridorS") {
        let (room, rows) = sizes.split_once('R').expect("two sizes");
        return Maker::KeyCorridor { room: size(room), rows: size(rows) };
    }
    if let Some(sizes) = name.strip_prefix("Empty-") {
        return Maker::Empty { size: size(sizes.split_once('x').expect("two sizes").0) };
    }
    match name {
        "FourRooms" => Maker::FourRooms,
        "Unlock" => Maker::Unlock,
        _ => panic!("no maker makes {name}"),
    }
}

/// What stands on the only cell of its kind.
fn only(board: &Board, wanted: impl Fn(Cell) -> bool) -> Option<([u8; 2], Cell)> {
    let mut found = board.cells().filter(|&(_, cell)| wanted(cell));
    let first = found.next();
    assert_eq!(found.next(), None, "there is more than one");
    first
}

/// The state that a record tells of: a board, and the agent's x, y and direction.
fn state(name: &str, size: [u8; 2], board: &Value, agent: &Value) -> State {
    let board = Board::decode(size, &bytes(board)).unwrap_or_else(|why| panic!("{name}: {why}"));
    let agent = bytes(agent);
    let pose = Pose { at: [agent[0], agent[1]], facing: Direction::ALL[usize::from(agent[2])] };
    let task = match maker(name) {
        Maker::KeyCorridor { .. } => {
            only(&board, |cell| matches!(cell, Cell::Ball(_))).map(|it| Task::Take(it.1))
        }
        Maker::Unlock => only(&board, |cell| matches!(cell, Cell::Door(..))).map(|it| Task::Open(it.0)),
        _ => Some(Task::Reach),
    };
    // Where the ball is already in hand nothing is left to do.
    State { board, pose, carried: Cell::Empty, task: task.unwrap_or_default(), steps: 0 }
}

fn size(record: &Value) -> [u8; 2] {
    ["w", "h"].map(|side| number(&record[side]) as u8)
}

fn crc(bytes: &[u8]) -> u32 {
    let mut crc = flate2::Crc::new();
    crc.update(bytes);
    crc.sum()
}

/// Puts something into a box.
fn fill(board: &mut Board, at: [u8; 2], inside: [u8; 3]) {
    let inside = match Cell::decode(inside) {
        Some(Cell::Key(colour)) => Inside::Key(colour),
        Some(Cell::Ball(colour)) => Inside::Ball(colour),
        other => panic!("{other:?} is in no box"),
    };
    let Cell::Box(colour, _) = board.get(at) else { panic!("there is no box at {at:?}") };
    board.set(at, Cell::Box(colour, inside));
}

/// Replays one recorded episode: on the bare world, and through the wrappers that an agent meets.
fn replay(record: &Value) -> usize {
    let name = record["env"].as_str().expect("env");
    let limit = number(&record["max_steps"]) as u32;
    let mut start = state(name, size(record), &record["grid0"], &record["agent0"]);
    for hidden in record["contents"].as_array().into_iter().flatten().map(bytes) {
        fill(&mut start.board, [hidden[0], hidden[1]], [hidden[2], hidden[3], 0]);
    }
    assert_eq!(start.check(), Ok(()), "{name}");

    let mut world = GridWorld::new(maker(name)).unwrap().limited(limit).unwrap();
    world.load(&start);
    assert_eq!(world.mission(), record["mission"].as_str().expect("mission"), "{name}");
    let own = GridWorld::new(Maker::Own(Box::new(start.clone()))).unwrap().limited(limit).unwrap();
    let mut env = TimeLimit::new(Symbolic::new(own, Layout::Random), limit);
    env.reset(0);

    let mut before = start.board.encode();
    let (actions, steps) = (record["actions"].as_array().unwrap(), record["steps"].as_array().unwrap());
    assert_eq!(actions.len(), steps.len(), "{name}");
    for (i, (action, theirs)) in actions.iter().zip(steps).enumerate() {
        let what = format!("{name}, seed {}, step {i}", record["seed"]);
        let action = number(action) as usize;
        let step = world.act(action);
        let limited = env.step(&action).unwrap_or_else(|refused| panic!("{what}: {refused}"));
        let state = world.state();
        assert_eq!(env.inner().world().state(), state, "{what}: state through the wrappers");

        let pose = [state.pose.at[0], state.pose.at[1], state.pose.facing as u8];
        assert_eq!(Value::from(pose.to_vec()), Value::from(&theirs.as_array().unwrap()[..3]), "{what}: pose");
        let [object, colour, _] = if state.carried == Cell::Empty { [0; 3] } else { state.carried.encode() };
        assert_eq!(
            [number(&theirs[3]), number(&theirs[4])],
            [u64::from(object), u64::from(colour)],
            "{what}: carried"
        );

        let reward = theirs[5].as_f64().expect("a reward");
        assert!((f64::from(step.reward) - reward).abs() <= REWARD, "{what}: reward {}", step.reward);
        assert_eq!(limited.reward, step.reward, "{what}: reward through the wrappers");
        let (terminated, truncated) = (number(&theirs[6]) == 1, number(&theirs[7]) == 1);
        assert_eq!(step.end == Some(End::Terminated), terminated, "{what}: terminated");
        assert_ne!(step.end, Some(End::Truncated), "{what}: a world does not truncate");
        assert_eq!(state.steps >= limit, truncated, "{what}: truncated");
        let end = match (terminated, truncated) {
            (true, _) => Some(End::Terminated),
            (false, true) => Some(End::Truncated),
            (false, false) => None,
        };
        assert_eq!(limited.end, end, "{what}: end");

        let after = state.board.encode();
        assert_eq!(Value::from(changes(&before, &after, size(record))), theirs[8], "{what}: changed cells");
        assert_eq!(u64::from(crc(&after)), number(&theirs[9]), "{what}: checksum of the grid");
        before = after;
    }
    assert_eq!(before, bytes(&record["grid_end"]), "{name}: grid at the end");
    steps.len()
}

/// Cells that differ: x, y, object, colour, state.
fn changes(before: &[u8], after: &[u8], [_, height]: [u8; 2]) -> Vec<Value> {
    let cells = before.chunks_exact(3).zip(after.chunks_exact(3)).enumerate();
    let changed = cells.filter(|(_, (before, after))| before != after);
    changed
        .map(|(index, (_, cell))| {
            let (x, y) = (index / usize::from(height), index % usize::from(height));
            Value::from(vec![x, y, cell[0].into(), cell[1].into(), cell[2].into()])
        })
        .collect()
}

/// Replays all episodes of a file.
fn conforms(file: &str) {
    let records = fixtures::records("minigrid", file);
    let steps: usize = records.iter().map(replay).sum();
    assert!(steps > 0, "{file} holds no steps");
}

#[test]
fn conformance_minigrid_steps_of_four_rooms() {
    conforms("FourRooms");
}

#[test]
fn conformance_minigrid_steps_of_door_key() {
    conforms("DoorKey-5x5");
    conforms("DoorKey-8x8");
}

#[test]
fn conformance_minigrid_steps_of_key_corridor() {
    conforms("KeyCorridorS3R3");
    conforms("KeyCorridorS4R3");
}

/// What we show of the state that a record tells of.
fn frame(record: &Value) -> Frame {
    let name = record["env"].as_str().expect("env");
    let (side, seen) =
        (number(&record["tile_size"]) as u32, record["highlight"].as_bool().expect("highlight"));
    let mut state = state(name, size(record), &record["grid"], &record["agent"]);
    let carried = bytes(&record["carrying"]);
    if carried[0] != 0 {
        state.carried = Cell::decode([carried[0], carried[1], 0]).expect("something to carry");
    }
    let mut world = GridWorld::new(maker(name)).unwrap();
    world.load(&state);
    let mut frame = Frame::default();
    GridPainter::new(size(record), side, seen, Format::NATIVE).paint(&world, &mut frame);
    assert_eq!(u64::from(crc(frame.bytes())), number(&record["crc32"]), "{name}, {state:?}");
    frame
}

#[test]
fn conformance_minigrid_frames_to_the_pixel() {
    for record in fixtures::records("minigrid", "renders") {
        let (file, ours) = (record["file"].as_str().expect("file"), frame(&record));
        let (size, theirs) = recorded::picture(&fixtures::folder("minigrid").join("renders").join(file));
        assert_eq!(
            Value::from(vec![ours.size()[1], ours.size()[0], ours.channels()]),
            record["shape"],
            "{file}"
        );
        assert_eq!(ours.size(), size, "{file}");
        let differ = ours.bytes().iter().zip(&theirs).filter(|(a, b)| a != b).count();
        assert_eq!(differ, 0, "{file}: {differ} bytes differ");
    }
}

/// Records that the shared fixtures lack: of Unlock, Empty and other sizes, and of boards strewn with boxes, lava and the
/// rest. They lie in the repository, wherever the others are, with the script that made them.
fn extra(name: &str) -> Vec<Value> {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/fixtures/minigrid/extra"));
    let file = fs::File::open(folder.join(name)).unwrap_or_else(|why| panic!("{name}: {why}"));
    let lines = serde_json::Deserializer::from_reader(flate2::read::GzDecoder::new(file)).into_iter();
    let records: Vec<Value> = lines.map(|line| line.unwrap_or_else(|why| panic!("{name}: {why}"))).collect();
    assert!(!records.is_empty(), "{name} is empty");
    records
}

#[test]
fn conformance_minigrid_extra_steps_and_frames() {
    let episodes = ["small.jsonl.gz", "strewn.jsonl.gz"].map(extra).concat();
    episodes.iter().for_each(|record| assert!(replay(record) > 0));
    let opened = |record: &&Value| record["contents"].as_array().is_some_and(|boxes| !boxes.is_empty());
    assert!(episodes.iter().filter(opened).count() > 0, "no box had anything in it");
    extra("frames.jsonl.gz").iter().for_each(|record| drop(frame(record)));
}

#[test]
fn conformance_minigrid_tiles_to_the_pixel() {
    let other = std::env::var_os("INROADS_FIXTURES").is_some();
    if other && !fixtures::folder("minigrid").join("tiles.jsonl.gz").exists() {
        return; // only our own records have them, and they hold all there are
    }
    let mut lava = 0;
    for record in fixtures::records("minigrid", "tiles") {
        let what = format!(
            "{}, agent {}, seen {}, {} pixels",
            record["obj"], record["agent_dir"], record["highlight"], record["tile_size"]
        );
        let cell = bytes(&record["obj"]);
        let cell =
            Cell::decode([cell[0], cell[1], cell[2]]).unwrap_or_else(|| panic!("{what}: no such cell"));
        let agent = record["agent_dir"].as_u64().map(|facing| Direction::ALL[facing as usize]);
        let (seen, side) = (record["highlight"].as_bool().unwrap(), number(&record["tile_size"]) as u32);
        let theirs = recorded::base64(record["rgb"]["u8_b64"].as_str().unwrap());
        let ours = tile(cell, agent, seen, side);
        assert_eq!(Value::from(vec![side, side, 3]), record["rgb"]["shape"], "{what}");
        let differ: Vec<_> =
            (0..ours.len().max(theirs.len())).filter(|&i| ours.get(i) != theirs.get(i)).collect();
        assert!(differ.is_empty(), "{what}: {} bytes differ, the first of them {}", differ.len(), differ[0]);
        lava += usize::from(cell == Cell::Lava);
    }
    assert!(lava > 0, "no tile of lava was compared");
}

/// How often each value of each choice came.
type Histograms = BTreeMap<String, BTreeMap<String, u64>>;

fn count(histograms: &mut Histograms, choice: &str, value: impl ToString) {
    *histograms.entry(choice.into()).or_default().entry(value.to_string()).or_default() += 1;
}

/// Counts what one layout has, under the names of the records.
fn choices(maker: &Maker, state: &State, out: &mut Histograms) {
    let cells = |wanted: fn(Cell) -> bool| -> Vec<[u8; 2]> {
        state.board.cells().filter(|&(_, cell)| wanted(cell)).map(|(at, _)| at).collect()
    };
    let [x, y] = state.pose.at;
    count(out, "agent_dir", state.pose.facing as u8);
    match maker {
        Maker::FourRooms => {
            let gaps = |line: usize| {
                let free =
                    move |at: &[u8; 2]| state.board.get(*at) != Cell::Wall(inroads_envs::grid::Colour::Grey);
                (0..19_u8).map(move |c| if line == 0 { [9, c] } else { [c, 9] }).filter(free)
            };
            gaps(0).for_each(|[_, y]| count(out, "vertical_wall_gap_y", y));
            gaps(1).for_each(|[x, _]| count(out, "horizontal_wall_gap_x", x));
            count(out, "n_gaps", gaps(0).count() + gaps(1).count());
        }
        Maker::DoorKey { .. } => {
            let (door, key) =
                (cells(|c| matches!(c, Cell::Door(..)))[0], cells(|c| matches!(c, Cell::Key(_)))[0]);
            count(out, "split_x", door[0]);
            count(out, "door_y", door[1]);
            count(out, "key_x", key[0]);
            count(out, "key_y", key[1]);
            count(out, "agent_x", x);
            count(out, "agent_y", y);
        }
        Maker::KeyCorridor { room, .. } => {
            let pitch = *room as u8 - 1;
            let doors = cells(|cell| matches!(cell, Cell::Door(..)));
            let (lock, locked) = only(&state.board, |c| matches!(c, Cell::Door(_, Door::Locked))).unwrap();
            let (ball_at, ball) = only(&state.board, |cell| matches!(cell, Cell::Ball(_))).unwrap();
            let key = cells(|cell| matches!(cell, Cell::Key(_)))[0];
            let (Cell::Door(locked, _), Cell::Ball(ball)) = (locked, ball) else {
                panic!("no door, no ball")
            };
            count(out, "n_doors", doors.len());
            count(out, "n_doors_left_or_corridor_side", doors.iter().filter(|at| at[0] <= pitch).count());
            count(out, "locked_room_row", lock[1] / pitch);
            count(out, "locked_color", locked.name());
            count(out, "ball_color", ball.name());
            count(out, "ball_col_row", format!("({}, {})", ball_at[0] / pitch, ball_at[1] / pitch));
            count(out, "key_row", key[1] / pitch);
            count(out, "key_x", key[0]);
            count(out, "agent_xy", format!("({x}, {y})"));
        }
        _ => panic!("there are no records of {maker:?}"),
    }
}

/// How many layouts are drawn of each domain: so many that nearly all of the difference is the records' own chance.
const DRAWN: u64 = 20_000;
/// Standard deviations that a share may differ by: one in 150,000 does so by chance.
const SIGMAS: f64 = 4.5;

#[test]
fn conformance_minigrid_layouts_are_drawn_as_often() {
    let document = fixtures::document("minigrid", "layout_stats.json");
    let domains = document.as_object().expect("a table of domains");
    assert!(!domains.is_empty());
    for (name, theirs) in domains {
        let maker = maker(name);
        let mut world = GridWorld::new(maker.clone()).unwrap();
        let mut ours = Histograms::new();
        for seed in 0..DRAWN {
            world.begin(Layout::Random.draw(seed));
            choices(&maker, world.state(), &mut ours);
        }
        let theirs = theirs["hist"].as_object().expect("histograms");
        let names: BTreeSet<_> = theirs.keys().collect();
        assert_eq!(ours.keys().collect::<BTreeSet<_>>(), names, "{name}: what is counted");
        for (choice, theirs) in theirs {
            let theirs: BTreeMap<String, u64> = theirs
                .as_object()
                .expect("a histogram")
                .iter()
                .map(|(k, n)| (k.clone(), number(n)))
                .collect();
            compare(&format!("{name}, {choice}"), &ours[choice], &theirs);
        }
    }
}

/// Two histograms of one distribution: each share within some standard deviations, and all together by chi-square.
fn compare(what: &str, ours: &BTreeMap<String, u64>, theirs: &BTreeMap<String, u64>) {
    let total = |histogram: &BTreeMap<String, u64>| histogram.values().sum::<u64>() as f64;
    let (n, m) = (total(ours), total(theirs));
    let mut square = 0.0;
    let values: BTreeSet<_> = ours.keys().chain(theirs.keys()).collect();
    for value in &values {
        let of = |histogram: &BTreeMap<String, u64>| histogram.get(*value).copied().unwrap_or(0) as f64;
        let (a, b) = (of(ours), of(theirs));
        let share = (a + b) / (n + m);
        let spread = (share * (1.0 - share) * (1.0 / n + 1.0 / m)).sqrt();
        let difference = (a / n - b / m).abs();
        assert!(
            difference <= SIGMAS * spread,
            "{what}: {value} came {a} times of {n}, MiniGrid's {b} of {m}"
        );
        square += (a / n - b / m).powi(2) / (share * (1.0 / n + 1.0 / m));
    }
    // Chi-square has mean k and variance 2k; Wilson and Hilferty's cube root makes it normal.
    let freedom = values.len() as f64 - 1.0;
    if freedom > 0.0 {
        let spread = 2.0 / (9.0 * freedom);
        let sigmas = ((square / freedom).cbrt() - (1.0 - spread)) / spread.sqrt();
        assert!(sigmas <= SIGMAS, "{what}: chi-square {square} with {freedom} degrees of freedom");
    }
}
