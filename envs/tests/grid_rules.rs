//! What single cells of the grid worlds do, and what cannot be.

use inroads_envs::grid::{
    Board, Cell, Colour, Direction, Door, GridError, GridWorld, Inside, Maker, Pose, State, Task,
};
use inroads_envs::world::{Layout, World};
use inroads_envs::{End, Step};

const FORWARD: usize = 2;
const PICK_UP: usize = 3;
const DROP: usize = 4;
const TOGGLE: usize = 5;

fn world(maker: Maker) -> GridWorld {
    GridWorld::new(maker).unwrap_or_else(|why| panic!("{why}"))
}

/// A row of cells with the agent at its left end, looking along it.
fn row(cells: &[Cell], task: Task) -> GridWorld {
    let mut board = Board::new([cells.len() as u8 + 1, 1]).unwrap();
    cells.iter().enumerate().for_each(|(x, &cell)| board.set([x as u8 + 1, 0], cell));
    let state = State::new(board, Pose::default(), task).unwrap_or_else(|why| panic!("{why}"));
    let mut world = world(Maker::Own(Box::new(state)));
    world.begin(Layout::Random.draw(0));
    world
}

fn all_of<const N: usize>(world: &mut GridWorld, actions: [usize; N]) {
    for action in actions {
        world.act(action);
    }
}

fn first(world: &GridWorld) -> Cell {
    world.state().board.get([1, 0])
}

#[test]
fn boxes_are_carried_with_what_is_in_them_and_opened() {
    let full = Cell::Box(Colour::Red, Inside::Key(Colour::Blue));
    let mut world = row(&[full, Cell::Empty], Task::Take(Cell::Key(Colour::Blue)));
    assert_eq!(world.act(FORWARD).end, None);
    assert_eq!(world.state().pose.at, [0, 0], "a box is in the way");
    assert_eq!(world.act(PICK_UP).end, None, "the box is not the key");
    assert_eq!((first(&world), world.state().carried), (Cell::Empty, full));
    world.act(DROP);
    world.act(TOGGLE);
    assert_eq!((first(&world), world.state().carried), (Cell::Key(Colour::Blue), Cell::Empty));
    assert_eq!(world.act(PICK_UP).end, Some(End::Terminated));
    let mut world = row(&[Cell::Box(Colour::Red, Inside::Nothing)], Task::Take(Cell::Ball(Colour::Red)));
    world.act(TOGGLE);
    assert_eq!(first(&world), Cell::Empty);
}

#[test]
fn hands_are_full_and_ground_is_taken() {
    let task = Task::Take(Cell::Ball(Colour::Red));
    let mut world = row(&[Cell::Key(Colour::Red), Cell::Key(Colour::Blue), Cell::Floor(Colour::Red)], task);
    all_of(&mut world, [PICK_UP, FORWARD, PICK_UP]);
    assert_eq!(world.state().carried, Cell::Key(Colour::Red), "one at a time");
    world.act(DROP);
    assert_eq!(world.state().carried, Cell::Key(Colour::Red), "there is a key already");

    let mut world = row(&[Cell::Key(Colour::Red), Cell::Floor(Colour::Red)], task);
    all_of(&mut world, [PICK_UP, FORWARD, DROP]);
    assert_eq!(world.state().carried, Cell::Key(Colour::Red), "floor is an object");
    world.act(FORWARD);
    assert_eq!(world.state().pose.at, [2, 0], "on which one can stand");
    world.act(FORWARD);
    assert_eq!(world.state().pose.at, [2, 0], "beyond the edge is wall");
}

#[test]
fn doors_want_their_key() {
    let task = Task::Take(Cell::Ball(Colour::Red));
    let lock = Cell::Door(Colour::Green, Door::Locked);
    for (key, opens) in [(Colour::Green, true), (Colour::Red, false)] {
        let mut world = row(&[Cell::Key(key), lock], task);
        all_of(&mut world, [PICK_UP, FORWARD, TOGGLE]);
        let door = if opens { Door::Open } else { Door::Locked };
        assert_eq!(world.state().board.get([2, 0]), Cell::Door(Colour::Green, door));
        assert_eq!(world.state().carried, Cell::Key(key), "the key stays in hand");
    }
    let mut world = row(&[Cell::Door(Colour::Green, Door::Closed)], task);
    for door in [Door::Open, Door::Closed, Door::Open] {
        world.act(TOGGLE);
        assert_eq!(first(&world), Cell::Door(Colour::Green, door), "an unlocked door needs no key");
    }
    let mut world = row(&[lock], Task::Open([1, 0]));
    assert_eq!(world.act(TOGGLE).end, None, "a locked door does");
}

#[test]
fn lava_ends_without_success() {
    let mut world = row(&[Cell::Lava, Cell::Goal(Colour::Green)], Task::Reach);
    assert_eq!(world.act(FORWARD), Step { reward: 0.0, end: Some(End::Terminated) });
    assert!(world.facts().iter().any(|fact| fact.name == "on lava" && fact.value == 1.0));
}

#[test]
fn on_a_full_board_the_start_stays() {
    let mut board = Board::new([2, 1]).unwrap();
    board.set([0, 0], Cell::Floor(Colour::Blue));
    board.set([1, 0], Cell::Goal(Colour::Green));
    let state = State::new(board, Pose::default(), Task::Reach).unwrap();
    let mut world = world(Maker::Own(Box::new(state.clone())));
    world.begin(Layout::FixedMap(1).draw(2));
    assert_eq!(world.state(), &state);
}

#[test]
fn what_cannot_be_is_answered_with_what_can() {
    let refused = |maker: Maker, words: &[&str]| {
        let text = GridWorld::new(maker).expect_err("there is no such world").to_string();
        assert!(words.iter().all(|word| text.contains(word)), "{text}");
    };
    refused(Maker::DoorKey { size: 4 }, &["door-key", "4", "5 to 255"]);
    refused(Maker::DoorKey { size: 256 }, &["256", "5 to 255"]);
    refused(Maker::Empty { size: 0 }, &["5 to 255"]);
    refused(Maker::KeyCorridor { room: 2, rows: 3 }, &["room", "3 to 85"]);
    refused(Maker::KeyCorridor { room: 3, rows: 0 }, &["rows", "1 to 127"]);
    refused(Maker::KeyCorridor { room: 85, rows: 4 }, &["rows", "1 to 3"]);
    let sized = |what: Result<GridWorld, GridError>| assert!(matches!(what, Err(GridError::Size { .. })));
    sized(world(Maker::Unlock).limited(0));
    sized(world(Maker::Unlock).drawn(0, true));
    sized(world(Maker::Unlock).drawn(257, true));
}

#[test]
fn a_board_that_cannot_be_is_refused_by_its_cell() {
    let text = |error: GridError| error.to_string();
    let good = [[2, 5, 0], [1, 0, 0], [8, 1, 0], [7, 3, 0], [4, 4, 2], [9, 0, 0]].concat();
    assert_eq!(Board::decode([3, 2], &good).unwrap().encode(), good);
    assert!(text(Board::decode([0, 2], &[]).unwrap_err()).contains("1 to 255"));
    assert!(
        text(Board::decode([2, 2], &good).unwrap_err()).contains("18 bytes; a grid of 2 by 2 cells has 12")
    );
    for (at, bytes) in [([1, 0], [10, 0, 1]), ([0, 1], [0, 0, 0]), ([2, 1], [4, 0, 3]), ([2, 0], [5, 6, 0])] {
        let mut bad = good.clone();
        let index = 3 * (usize::from(at[0]) * 2 + usize::from(at[1]));
        bad[index..index + 3].copy_from_slice(&bytes);
        assert_eq!(Board::decode([3, 2], &bad), Err(GridError::Cell { at, bytes }));
        assert!(text(GridError::Cell { at, bytes }).contains(&format!("cell ({}, {})", at[0], at[1])));
    }
    let board = Board::decode([3, 2], &good).unwrap();
    let state = |at, task| State::new(board.clone(), Pose { at, facing: Direction::Up }, task);
    assert!(state([0, 1], Task::Reach).is_ok());
    assert!(text(state([0, 0], Task::Reach).unwrap_err()).contains("cell (0, 0)"), "in a wall");
    assert!(state([3, 0], Task::Reach).is_err(), "beyond the edge");
    assert!(text(state([0, 1], Task::Open([0, 1])).unwrap_err()).contains("door"));
    assert!(state([0, 1], Task::Take(Cell::Wall(Colour::Grey))).is_err());
    let carrying = State { carried: Cell::Lava, ..state([0, 1], Task::Reach).unwrap() };
    assert!(text(carrying.check().unwrap_err()).contains("Lava"));
    let nowhere = State::new(Board::new([2, 2]).unwrap(), Pose::default(), Task::Reach);
    assert!(text(nowhere.unwrap_err()).contains("a goal"));
}
