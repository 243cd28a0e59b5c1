//! The visual taxi against visgrid (fixtures/visgrid): every recorded step, the walls, and the pictures.

#[path = "../../tests/support/fixtures.rs"]
mod fixtures;
#[path = "../../tests/support/recorded.rs"]
mod recorded;

use inroads_envs::visual_taxi::{Passenger, Settings, Sizes, Starts, State, Town, VisualTaxi};
use inroads_envs::world::{Drawn, Layout, Painter, World};
use inroads_envs::{End, Frame, Snapshot};
use inroads_sim::raster::Format;
use serde_json::{Value, json};

fn settings(size: &Value) -> Settings {
    match size.as_u64() {
        Some(5) => Settings::FIVE,
        Some(10) => Settings::TEN,
        _ => panic!("no town of size {size}"),
    }
}

/// Taxi row and column; for each passenger row, column, aboard, goal.
fn state(numbers: &Value) -> State {
    let numbers: Vec<u8> = serde_json::from_value(numbers.clone()).expect("a state");
    let passengers = numbers[2..].chunks_exact(4);
    assert!(passengers.remainder().is_empty(), "{numbers:?}");
    let passenger = |of: &[u8]| Passenger { cell: [of[0], of[1]], aboard: of[2] == 1, goal: of[3] };
    State { taxi: [numbers[0], numbers[1]], passengers: passengers.map(passenger).collect() }
}

fn numbers(world: &VisualTaxi) -> Value {
    let mut symbols = Vec::new();
    world.symbols(&mut symbols);
    symbols.into_iter().map(|number| number as u64).collect()
}

#[test]
fn conformance_visgrid_every_step() {
    let mut replayed = 0;
    for record in fixtures::records("visgrid", "episodes") {
        if record["wall_grid"].is_array() {
            continue; // The next test's.
        }
        let seed = &record["seed"];
        let flag = |key: &str| record[key].as_bool().unwrap_or_else(|| panic!("no {key}"));
        let starts = if flag("exploring_starts") { Starts::Exploring } else { Starts::Classic };
        let first = state(&record["states"][0]);
        let settings = Settings {
            depot_dropoff_only: flag("depot_dropoff_only"),
            passengers: first.passengers.len(),
            starts,
            ..settings(&record["size"])
        };
        let depots = settings.town.depots();
        let names: Vec<_> = depots.iter().map(|depot| depot.name).collect();
        assert_eq!(json!(names), record["depot_names_sorted"], "seed {seed}");
        for depot in depots {
            assert_eq!(json!(depot.cell), record["depots_rc"][depot.name], "seed {seed}, {}", depot.name);
        }
        if starts == Starts::Classic {
            let cells = || first.passengers.iter().map(|passenger| passenger.cell).chain([first.taxi]);
            assert!(cells().all(|cell| depots.iter().any(|depot| depot.cell == cell)), "seed {seed}");
            assert!(first.passengers.iter().all(|passenger| passenger.cell != first.taxi), "seed {seed}");
        }
        let mut world = VisualTaxi::new(settings).expect("fewer passengers than depots");
        world.load(&first);
        let actions: Vec<usize> = serde_json::from_value(record["actions"].clone()).expect("actions");
        assert!(!actions.is_empty(), "seed {seed}");
        for (number, &action) in actions.iter().enumerate() {
            let what = format!("seed {seed}, step {number}");
            assert_eq!(json!(world.legal().map(u8::from)), record["action_masks"][number], "{what}");
            let step = world.act(action);
            assert_eq!(numbers(&world), record["states"][number + 1], "{what}");
            assert_eq!(
                f64::from(step.reward),
                record["rewards"][number].as_f64().expect("a reward"),
                "{what}"
            );
            let terminated = u8::from(step.end == Some(End::Terminated));
            assert_eq!(json!(terminated), record["terminated"][number], "{what}");
            replayed += 1;
        }
        assert_eq!(json!(world.legal().map(u8::from)), record["action_masks"][actions.len()], "seed {seed}");
    }
    assert!(replayed > 0, "there are episodes");
}

/// The lattices are in the repository's set for certain; others may have the episodes only.
#[test]
fn conformance_visgrid_walls() {
    let mut compared = 0;
    for record in fixtures::records("visgrid", "episodes") {
        let Some(rows) = record["wall_grid"].as_array() else { continue };
        let town = settings(&record["size"]).town;
        let side = 2 * u32::from(town.size()) + 1;
        let lattice = (0..side).map(|row| {
            (0..side).map(|column| Value::from(u8::from(town.lattice([row, column])))).collect::<Value>()
        });
        assert_eq!(lattice.collect::<Value>(), Value::from(rows.clone()), "size {}", town.size());
        assert_eq!(town, if side == 11 { Town::FIVE } else { Town::TEN });
        compared += 1;
    }
    assert!(compared > 0 || fixtures::from_elsewhere(), "no lattices");
}

/// Walls, cells, characters, corners, borders and dashes of each way of drawing.
const KNOWN: [(Sizes, [u32; 7]); 4] = [
    (Sizes::SMALL, [1, 7, 3, 1, 4, 3, 4]),
    (Sizes::MEDIUM, [1, 11, 7, 2, 2, 1, 4]),
    (Sizes::LARGE, [2, 13, 9, 3, 4, 3, 6]),
    (Sizes::WIDE, [1, 11, 7, 2, 4, 3, 4]),
];

/// The same as visgrid writes it.
fn dims(
    [wall, cell, character, depot, top_left, bottom_right, dash]: [u32; 7],
    [width, height]: [u32; 2],
) -> Value {
    json!({
        "wall_width": wall,
        "cell_width": cell,
        "character_width": character,
        "depot_width": depot,
        "border_widths": [top_left, bottom_right],
        "dash_width": dash,
        "img_shape": [height, width],
    })
}

#[test]
fn conformance_visgrid_pictures() {
    for record in fixtures::records("visgrid", "renders") {
        let file = record["file"].as_str().expect("a file");
        let (size, bytes) = recorded::picture(&fixtures::folder("").join(file));
        assert_eq!(record["shape"], json!([size[1], size[0], 3]), "{file}");
        let settings = settings(&record["size"]);
        let known = KNOWN.into_iter().find(|(_, numbers)| record["dims"] == dims(*numbers, size));
        let (sizes, _) = known.unwrap_or_else(|| panic!("{file}: unknown sizes {}", record["dims"]));
        let state = state(&record["state"]);
        let passengers = state.passengers.len();
        let mut world = VisualTaxi::new(Settings { sizes, passengers, ..settings }).expect("few passengers");
        world.load(&state);
        let mut frame = Frame::default();
        world.painter(Format::NATIVE).paint(&world, &mut frame);
        assert_eq!((frame.size(), frame.channels()), (size, 3), "{file}");
        assert!(frame.bytes() == bytes, "{file} differs");
    }
}

/// Classic starts are drawn uniformly, and drawn again only while everybody is where they want to go.
#[test]
fn of_several_passengers_some_may_have_arrived_at_the_start() {
    let mut world = VisualTaxi::new(Settings { passengers: 3, ..Settings::FIVE }).unwrap();
    let (episodes, depots) = (4000_u32, Town::FIVE.depots());
    let mut arrived = [0_u32; 4];
    for seed in 0..episodes {
        world.begin(Layout::Random.draw(seed.into()));
        let passengers = &world.state().passengers;
        let there = passengers.iter().filter(|one| one.cell == depots[usize::from(one.goal)].cell);
        arrived[there.count()] += 1;
    }
    // Of the 24 orders of four goals 11, 9, 3, 1 send 0, 1, 2, 3 of three passengers to where they are.
    let expected = [11.0, 9.0, 3.0, 0.0].map(|orders| f64::from(episodes) * orders / 23.0);
    for (&found, expected) in arrived.iter().zip(expected) {
        assert!((f64::from(found) - expected).abs() <= 4.0 * expected.sqrt(), "{arrived:?}, not {expected}");
    }
}

/// Episodes start as the records say they may.
#[test]
fn starts_are_of_their_kind() {
    for (starts, seed) in
        [Starts::Classic, Starts::Exploring].into_iter().flat_map(|s| (0..500).map(move |n| (s, n)))
    {
        for passengers in [1, 3] {
            let mut world = VisualTaxi::new(Settings { starts, passengers, ..Settings::FIVE }).unwrap();
            world.begin(Layout::Random.draw(seed));
            let State { taxi, passengers } = world.state();
            let depots = Town::FIVE.depots();
            let goal = |passenger: &Passenger| depots[usize::from(passenger.goal)].cell;
            assert!(
                passengers.iter().any(|one| one.aboard || one.cell != goal(one)),
                "something is to be done"
            );
            let mut cells: Vec<_> = passengers.iter().map(|one| one.cell).collect();
            cells.sort_unstable();
            cells.dedup();
            assert_eq!(cells.len(), passengers.len());
            if starts == Starts::Classic {
                assert!(passengers.iter().all(|one| !one.aboard && one.cell != *taxi));
                assert!(
                    cells.iter().chain([taxi]).all(|&cell| depots.iter().any(|depot| depot.cell == cell))
                );
            }
        }
    }
}
