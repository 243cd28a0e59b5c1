//! What always holds in Sokoban: rooms are solvable, nothing vanishes, states come back, and bad rooms are refused by
//! name.

use inroads_envs::sokoban::{Cell, Look, Reward, Room, RoomError, Settings, Sokoban, SokobanError};
use inroads_envs::world::{Drawn, Layout, Painter, World};
use inroads_envs::{End, Frame, Rng, Seed, Snapshot};
use inroads_sim::raster::Format;
use rand::RngExt;

/// The registry's sizes, and some that nobody asked for.
const SIZES: [([usize; 2], usize); 8] = [
    ([10, 10], 3),
    ([10, 10], 4),
    ([7, 7], 2),
    ([7, 7], 3),
    ([13, 11], 3),
    ([5, 4], 1),
    ([3, 9], 1),
    ([20, 24], 2),
];

fn world(size: [usize; 2], boxes: usize) -> Sokoban {
    Sokoban::new(Settings { size, boxes, ..Settings::default() }).unwrap_or_else(|why| panic!("{why}"))
}

/// A policy that goes somewhere: runs of one action.
fn wander(rng: &mut Rng, last: usize) -> usize {
    if rng.random_bool(0.6) { last } else { rng.random_range(0..9) }
}

#[test]
fn every_room_can_be_solved_and_begins_with_no_box_home() {
    for (size, boxes) in SIZES {
        let mut world = world(size, boxes);
        for seed in 0..5 {
            world.begin(Layout::Random.draw(seed));
            let what = format!("{size:?}, {boxes} boxes, seed {seed}");
            assert_eq!((world.room().size(), world.room().box_count() as usize), (size, boxes), "{what}");
            assert_eq!(world.room().on_target(), 0, "{what}");
            let solution = world.solution().expect("a room made by chance has one").to_vec();
            let (last, way) = solution.split_last().expect("something is to be done");
            for &action in way {
                assert_eq!(world.act(action.into()).end, None, "{what}");
            }
            let step = world.act((*last).into());
            assert_eq!((step.reward, step.end), (10.9, Some(End::Terminated)), "{what}");
        }
    }
}

#[test]
fn nothing_vanishes_and_nobody_walks_into_walls() {
    for (size, boxes) in SIZES {
        let mut world = world(size, boxes);
        let mut rng = Seed(9).stream("wander", 0);
        for seed in 0..4 {
            world.begin(Layout::Random.draw(seed));
            let start = world.room().clone();
            let mut action = 0;
            for _ in 0..300 {
                action = wander(&mut rng, action);
                let step = world.act(action);
                let room = world.room();
                for (before, after) in start.cells().iter().zip(room.cells()) {
                    assert_eq!(before.fixed_code(), after.fixed_code(), "walls, floor and targets stay");
                }
                assert_eq!(room.boxes().count(), boxes);
                assert_eq!(room.cells().iter().filter(|cell| cell.is_player()).count(), 1);
                assert!(room.cell(room.player()).is_player());
                let home = room.cells().iter().filter(|&&cell| cell == Cell::BoxOnTarget).count();
                assert_eq!((room.on_target() as usize, room.solved()), (home, home == boxes));
                if step.end.is_some() {
                    break;
                }
            }
        }
    }
}

#[test]
fn states_come_back() {
    let mut world = world([10, 10], 3);
    let mut rng = Seed(3).stream("wander", 0);
    for seed in 0..5 {
        world.begin(Layout::Random.draw(seed));
        let way: Vec<usize> = (0..120).map(|_| rng.random_range(0..9)).collect();
        way[..60].iter().for_each(|&action| _ = world.act(action));
        let kept = world.save();
        let first: Vec<_> =
            way[60..].iter().map(|&action| (world.act(action), world.room().clone())).collect();
        world.begin(Layout::Random.draw(seed + 100));
        world.load(&kept);
        let again: Vec<_> =
            way[60..].iter().map(|&action| (world.act(action), world.room().clone())).collect();
        assert_eq!(first, again);
    }
}

#[test]
fn layouts_are_what_they_say() {
    let mut world = world([10, 10], 3);
    let mut begin = |layout: Layout, episode| {
        world.begin(layout.draw(episode));
        world.room().clone()
    };
    let rooms: Vec<Room> = (0..10).map(|episode| begin(Layout::Random, episode)).collect();
    assert!(rooms.windows(2).all(|pair| pair[0] != pair[1]));
    let fixed = begin(Layout::Fixed(42), 0);
    assert!((1..10).all(|episode| begin(Layout::Fixed(42), episode) == fixed));
    assert_eq!(begin(Layout::Random, 42), fixed, "a layout's seed is an episode's");
    let starts: Vec<Room> = (0..30).map(|episode| begin(Layout::FixedMap(42), episode)).collect();
    assert!(starts.iter().all(|room| room.boxes().eq(fixed.boxes())));
    let mut players: Vec<_> = starts.iter().map(Room::player).collect();
    players.sort_unstable();
    players.dedup();
    assert!(players.len() > 5, "{players:?}");
}

#[test]
fn painting_on_is_painting_anew() {
    for (look, format) in
        [(Look::Sprites, Format::NATIVE), (Look::Flat(4), Format::NATIVE), (Look::Sprites, Format::THESIS)]
    {
        let mut world = Sokoban::new(Settings { look, ..Settings::default() }).unwrap();
        let mut painter = world.painter(format);
        let mut rng = Seed(5).stream("wander", 0);
        let [mut on, mut anew] = [Frame::default(), Frame::default()];
        for seed in 0..3 {
            world.begin(Layout::Random.draw(seed));
            for _ in 0..60 {
                world.act(rng.random_range(0..9));
                painter.paint(&world, &mut on);
                world.painter(format).paint(&world, &mut anew);
                assert!(on == anew);
            }
        }
    }
}

#[test]
fn what_is_paid_is_a_setting() {
    // The push to the right brings a box home, finds the way blocked, takes a box from its target.
    let rooms = ["#@$.$.#", "# @*$.#", "#.@* $#"];
    let paid = |reward| {
        rooms.map(|room| {
            let room = Room::parse(&format!("#######\n{room}\n#######")).unwrap();
            let mut world = Sokoban::of(room, Settings { reward, ..Settings::default() }).unwrap();
            let step = world.act(4);
            (step.reward, step.end)
        })
    };
    assert_eq!(paid(Reward::Peer), [(0.9, None), (-0.1, None), (-1.1, None)]);
    assert_eq!(paid(Reward::Author), [(0.1, None), (0.0, None), (-0.1, None)]);
    assert_eq!(paid(Reward::Sparse), [(0.0, None), (0.0, None), (0.0, None)]);
    let last = |reward| {
        let room = Room::parse("######\n#@$.*#\n######").unwrap();
        let mut world = Sokoban::of(room, Settings { reward, ..Settings::default() }).unwrap();
        let step = world.act(4);
        assert!(step.reward >= world.card().success_reward && step.end == Some(End::Terminated));
        step.reward
    };
    assert_eq!([Reward::Peer, Reward::Author, Reward::Sparse].map(last), [10.9, 1.1, 1.0]);
}

#[test]
fn rooms_of_ones_own() {
    let text = "
  ####
###  ####
#     $ #
# #  #$ #
# . .#@ #
#########";
    let room = Room::parse(text).unwrap();
    assert_eq!((room.size(), room.player(), room.box_count()), ([6, 9], [4, 6], 2));
    assert_eq!(room.cell([0, 0]), Cell::Wall, "what nobody can reach is wall");
    let rows = |code: fn(&Cell) -> u8| -> Vec<Vec<u8>> {
        room.cells().chunks(9).map(|row| row.iter().map(code).collect()).collect()
    };
    let same = Room::of_codes(&rows(|cell| cell.fixed_code()), &rows(|cell| cell.code()));
    assert_eq!(same.as_ref(), Ok(&room));
    assert_eq!(Room::parse(&room.to_string()).as_ref(), Ok(&room));
    let mut world = Sokoban::of(room.clone(), Settings::default()).unwrap();
    assert_eq!(world.card().symbols.len(), 2 + 54);
    world.act(1);
    world.begin(Layout::Random.draw(7));
    assert_eq!((world.room(), world.solution()), (&room, None));
}

#[test]
fn bad_rooms_are_refused_by_name() {
    let refused = |text: &str| Room::parse(text).expect_err(text).to_string();
    let says = |text: &str, words: &str| {
        let why = refused(text);
        assert!(why.contains(words), "{why}");
    };
    says("", "0 rows and 0 columns");
    says("#####\n#@$x#\n#####", "row 1, column 3: `x` is none of # wall");
    says("\n\n#####\n#@$x#\n#####", "row 1, column 3");
    says("#####\n# $.#\n#####", "no player");
    says("######\n#@$.@#\n######", "row 1, column 4: a second player");
    says("#####\n#@$ #\n#####", "1 boxes and 0 targets");
    says("#####\n#@  #\n#####", "0 boxes and 0 targets");
    says("#####\n#@$. \n#####", "row 1, column 4: the room is open there");
    says(&format!("{0}\n#@$.{1}#\n{0}", "#".repeat(105), " ".repeat(100)), "3 rows and 105 columns");
    // Filled up, the lines of this text would be 2,500,000,000 cells.
    let long = format!("#@$.{}\n{}", "#".repeat(49_996), "#\n".repeat(49_999));
    assert_eq!(Room::parse(&long), Err(RoomError::Size { rows: 50_000, columns: 50_000 }));
    says(&"####\n".repeat(101), "101 rows and 4 columns");
    let codes = |fixed: &[&[u8]], state: &[&[u8]]| Room::of_codes(fixed, state).expect_err("no room");
    let wall: &[u8] = &[0; 5];
    let clash = codes(&[wall, &[0, 1, 1, 2, 0], wall], &[wall, &[0, 5, 3, 2, 0], wall]);
    assert_eq!(clash, RoomError::Codes { row: 1, column: 2, fixed: 1, state: 3 });
    let ragged = codes(&[wall, &[0, 1, 1, 2], wall], &[wall, &[0, 5, 4, 2, 0], wall]);
    assert_eq!(ragged, RoomError::Ragged { array: "room_fixed", row: 1, found: 4, expected: 5 });
    assert_eq!(codes(&[wall, wall], &[wall]), RoomError::Rows { fixed: 2, state: 1 });
    let solved = Room::parse("#####\n#@* #\n#####").unwrap();
    assert_eq!(Sokoban::of(solved, Settings::default()).err(), Some(SokobanError::Solved));
}

#[test]
fn impossible_settings_are_refused() {
    let refused = |size, boxes, walk| {
        let settings = Settings { size, boxes, walk, ..Settings::default() };
        Sokoban::new(settings).err().unwrap_or_else(|| panic!("{size:?}, {boxes} boxes")).to_string()
    };
    assert!(refused([2, 10], 1, None).contains("2 rows and 10 columns; both must lie between 3 and 100"));
    assert!(refused([10, 101], 1, None).contains("10 rows and 101 columns"));
    assert!(refused([7, 7], 0, None).contains("0 boxes in rooms of 7 rows and 7 columns: ask for 1 to 23"));
    assert!(refused([7, 7], 24, None).contains("ask for 1 to 23; their 25 cells"));
    assert!(refused([100, 100], 300, None).contains("ask for 1 to 255"));
    // As many boxes as there is room for leave no way to pull any of them away.
    assert!(refused([7, 7], 23, None).contains("none of 1000 walks of 23 steps"));
    assert!(refused([7, 7], 2, Some(0)).contains("none of 1000 walks of 0 steps"));
    assert!(refused([7, 7], 2, Some(u32::MAX)).contains("walks of 4294967295 steps; ask for at most 100000"));
    // Rooms without space for a box, a player and a free cell.
    for (size, cells) in [([3, 3], 1), ([3, 4], 2)] {
        let why = refused(size, 1, None);
        assert!(why.contains("no box fits, ask for a room of 3 rows and 5 columns"), "{why}");
        assert!(why.contains(&format!("their {cells} cells")), "{why}");
    }
    assert!(refused([3, 5], 2, None).contains("ask for 1 to 1;"));
}
