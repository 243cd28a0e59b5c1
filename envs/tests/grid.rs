//! What must hold in every grid world: layouts can be solved, nothing gets lost, nobody stands in a wall, states come back
//! exactly, and a picture does not depend on what was painted before. What single cells do stands in `grid_rules.rs`.

use std::collections::{BTreeSet, VecDeque};

use inroads_envs::grid::{
    Board, Cell, Colour, Direction, Door, GridWorld, Inside, Maker, Pay, Pose, State, Task,
};
use inroads_envs::world::{Drawn, Layout, Painter, Pictured, Symbolic, World};
use inroads_envs::{Drawing, End, Environment, Frame, Render, Rng, Seed, Snapshot, Step, TimeLimit};
use inroads_sim::raster::Format;
use rand::RngExt;

const LEFT: usize = 0;
const RIGHT: usize = 1;
const FORWARD: usize = 2;
const PICK_UP: usize = 3;
const DROP: usize = 4;
const TOGGLE: usize = 5;

fn world(maker: Maker) -> GridWorld {
    GridWorld::new(maker).unwrap_or_else(|why| panic!("{why}"))
}

/// Worlds of all kinds, from the smallest on.
fn all() -> Vec<GridWorld> {
    let mut makers = vec![Maker::Unlock, Maker::FourRooms];
    makers.extend([5, 6, 9].map(|size| Maker::Empty { size }));
    makers.extend([5, 6, 7, 8, 16].map(|size| Maker::DoorKey { size }));
    let corridors = [(3, 1), (3, 2), (3, 3), (4, 1), (4, 3), (5, 2), (6, 3), (3, 9)];
    makers.extend(corridors.map(|(room, rows)| Maker::KeyCorridor { room, rows }));
    makers.push(Maker::Own(Box::new(strewn())));
    makers.into_iter().map(world).collect()
}

/// A board with everything on it.
fn strewn() -> State {
    let mut board = Board::new([9, 7]).unwrap();
    let cells = [
        Cell::Wall(Colour::Purple),
        Cell::Floor(Colour::Blue),
        Cell::Door(Colour::Red, Door::Closed),
        Cell::Door(Colour::Green, Door::Open),
        Cell::Door(Colour::Blue, Door::Locked),
        Cell::Key(Colour::Blue),
        Cell::Ball(Colour::Yellow),
        Cell::Box(Colour::Grey, Inside::Nothing),
        Cell::Box(Colour::Red, Inside::Key(Colour::Green)),
        Cell::Box(Colour::Purple, Inside::Ball(Colour::Blue)),
        Cell::Goal(Colour::Green),
    ];
    for (index, cell) in cells.into_iter().enumerate() {
        board.set([1 + 2 * (index as u8 % 4), 1 + 2 * (index as u8 / 4)], cell);
    }
    State::new(board, Pose { at: [0, 0], facing: Direction::Down }, Task::Reach).unwrap()
}

/// Half turns, the rest mostly forward.
fn action(rng: &mut Rng) -> usize {
    const ACTIONS: [usize; 16] = [0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 4, 5, 6];
    ACTIONS[rng.random_range(0..ACTIONS.len())]
}

/// The least actions that bring the agent before a cell, through doors that anybody can open.
fn way(state: &State, target: [u8; 2]) -> Option<Vec<usize>> {
    let [width, height] = state.board.size().map(usize::from);
    let index =
        |pose: Pose| (usize::from(pose.at[0]) * height + usize::from(pose.at[1])) * 4 + pose.facing as usize;
    let mut from: Vec<Option<(Pose, usize)>> = vec![None; width * height * 4];
    let mut next = VecDeque::from([state.pose]);
    while let Some(pose) = next.pop_front() {
        if pose.front() == target {
            let (mut at, mut actions) = (pose, Vec::new());
            while at != state.pose {
                let (before, action) = from[index(at)].expect("whatever was found was found from somewhere");
                actions.push(action);
                if action == FORWARD && matches!(state.board.get(at.at), Cell::Door(_, Door::Closed)) {
                    actions.push(TOGGLE);
                }
                at = before;
            }
            actions.reverse();
            return Some(actions);
        }
        let through = match state.board.get(pose.front()) {
            Cell::Door(_, Door::Closed) => true,
            Cell::Lava | Cell::Goal(_) => false,
            cell => cell.walkable(),
        };
        let turns = [(LEFT, pose.facing.left()), (RIGHT, pose.facing.right())];
        let turns = turns.map(|(action, facing)| (action, Pose { facing, ..pose }));
        let step = through.then_some((FORWARD, Pose { at: pose.front(), ..pose }));
        for (action, after) in turns.into_iter().chain(step) {
            if after != state.pose && from[index(after)].is_none() {
                from[index(after)] = Some((pose, action));
                next.push_back(after);
            }
        }
    }
    None
}

fn find(state: &State, wanted: impl Fn(Cell) -> bool) -> Option<[u8; 2]> {
    state.board.cells().find(|&(_, cell)| wanted(cell)).map(|(at, _)| at)
}

/// Goes before a cell and does something to it; `None` when there is no way.
fn go(world: &mut GridWorld, target: [u8; 2], action: usize) -> Option<Step> {
    let way = way(world.state(), target)?;
    for action in way {
        assert_eq!(world.act(action).end, None, "nothing ends on the way");
    }
    Some(world.act(action))
}

/// Solves a world by hand: straight on, if there is a way, else by way of the key.
fn solve(world: &mut GridWorld) -> Option<Step> {
    if let Some(last) = finish(world) {
        return Some(last);
    }
    let lock = find(world.state(), |cell| matches!(cell, Cell::Door(_, Door::Locked)))?;
    let key = find(world.state(), |cell| matches!(cell, Cell::Key(_)))?;
    go(world, key, PICK_UP)?;
    let opened = go(world, lock, TOGGLE)?;
    if opened.end.is_some() {
        return Some(opened);
    }
    // The key must go, to where it is not in the way.
    let start = world.save();
    let free: Vec<_> = start.board.cells().map(|(at, _)| at).filter(|&at| start.board.is_free(at)).collect();
    free.into_iter().find_map(|at| {
        world.load(&start);
        if let Task::Take(_) = start.task {
            go(world, at, DROP)?;
        }
        finish(world)
    })
}

/// What is left when nothing is locked.
fn finish(world: &mut GridWorld) -> Option<Step> {
    match world.state().task {
        Task::Reach => find(world.state(), |cell| matches!(cell, Cell::Goal(_)))
            .and_then(|goal| go(world, goal, FORWARD)),
        Task::Take(wanted) => {
            find(world.state(), |cell| cell == wanted).and_then(|at| go(world, at, PICK_UP))
        }
        Task::Open(_) => None,
    }
    .filter(|step| step.end.is_some())
}

#[test]
fn every_layout_can_be_solved() {
    for mut world in all() {
        for seed in 0..100 {
            for layout in [Layout::Random, Layout::FixedMap(seed)] {
                world.begin(layout.draw(1000 + seed));
                let what = format!("{}, seed {seed}, {layout:?}: {:?}", world.card().name, world.state());
                let last = solve(&mut world).unwrap_or_else(|| panic!("no way: {what}"));
                assert_eq!(last.end, Some(End::Terminated), "{what}");
                let (steps, limit) = (world.state().steps, world.card().limit.unwrap());
                let due = (1.0 - 0.9 * (f64::from(steps) / f64::from(limit))) as f32;
                assert_eq!(last.reward, due, "{what}");
            }
        }
    }
}

/// Everything that cannot vanish, sorted: what can be carried (in boxes and hands too), doors, walls, ground.
fn inventory(state: &State) -> Vec<String> {
    let mut things = Vec::new();
    let cells = state.board.cells().map(|(at, cell)| (Some(at), cell));
    for (at, cell) in cells.chain([(None, state.carried)]) {
        match cell {
            Cell::Empty | Cell::Box(_, Inside::Nothing) => {}
            Cell::Key(colour) | Cell::Box(_, Inside::Key(colour)) => things.push(format!("{colour:?} key")),
            Cell::Ball(colour) | Cell::Box(_, Inside::Ball(colour)) => {
                things.push(format!("{colour:?} ball"))
            }
            Cell::Door(colour, _) => things.push(format!("{colour:?} door at {at:?}")),
            cell => things.push(format!("{cell:?} at {at:?}")),
        }
    }
    things.sort();
    things
}

#[test]
fn nothing_gets_lost_and_nobody_stands_in_a_wall() {
    let mut carried = 0;
    for mut world in all() {
        for seed in 0..20 {
            world.begin(Layout::Random.draw(seed));
            let (before, mut rng) = (inventory(world.state()), Seed(seed).stream("act", 0));
            for _ in 0..400 {
                let step = world.act(action(&mut rng));
                let state = world.state();
                assert_eq!(state.check(), Ok(()), "{state:?}");
                assert_eq!(inventory(state), before, "{state:?}");
                carried += u32::from(state.carried != Cell::Empty);
                if step.end.is_some() {
                    break;
                }
            }
        }
    }
    assert!(carried > 1000, "hands were hardly ever full");
}

#[test]
fn a_state_comes_back_exactly() {
    for world in all() {
        let limit = world.card().limit.unwrap();
        let mut env = TimeLimit::new(Pictured::new(world, Layout::Random, Format::NATIVE).unwrap(), limit);
        let mut rng = Seed(5).stream("act", 0);
        env.reset(3);
        let (mut saved, mut seen) = (env.save(), Frame::default());
        for round in 0..60 {
            let before = env.save();
            let actions: Vec<_> = (0..rng.random_range(1..8)).map(|_| action(&mut rng)).collect();
            let mut play = |env: &mut TimeLimit<Pictured<GridWorld>>| -> Vec<_> {
                let step = |action| {
                    let step = env.step(action);
                    env.observe(&mut seen);
                    (step, env.inner().world().save(), seen.clone())
                };
                actions.iter().map(step).collect()
            };
            let first = play(&mut env);
            let after = env.save();
            // Something else in between, however long ago.
            env.load(&saved);
            play(&mut env);
            env.load(&before);
            assert_eq!(play(&mut env), first, "round {round}");
            assert_eq!(env.save(), after, "round {round}");
            if round % 7 == 0 {
                saved = before;
            }
        }
    }
}

#[test]
fn painting_on_is_painting_anew() {
    for (index, mut world) in all().into_iter().enumerate() {
        let formats = [Format::NATIVE, Format::THESIS, Format::THESIS_GREY, Format::ATARI];
        let mut painters = formats.map(|format| world.painter(format));
        let mut rng = Seed(7).stream("act", index as u64);
        let (mut on, mut anew) = (Frame::default(), Frame::new([3, 500], 3));
        for seed in 0..3 {
            world.begin(Layout::Random.draw(seed));
            for _ in 0..30 {
                for (painter, format) in painters.iter_mut().zip(formats) {
                    painter.paint(&world, &mut on);
                    world.painter(format).paint(&world, &mut anew);
                    assert!(on == anew, "{format:?} of {:?}", world.state());
                }
                if world.act(action(&mut rng)).end.is_some() {
                    break;
                }
            }
        }
    }
}

#[test]
fn highlights_can_be_left_out_and_tiles_have_any_size() {
    let paint = |world: GridWorld| {
        let mut world = world;
        world.begin(Layout::Random.draw(1));
        let mut frame = Frame::default();
        world.painter(Format::NATIVE).paint(&world, &mut frame);
        frame
    };
    let door_key = || world(Maker::DoorKey { size: 6 });
    let [with, without] = [true, false].map(|highlight| paint(door_key().drawn(8, highlight).unwrap()));
    assert_eq!((with.size(), without.size()), ([48, 48], [48, 48]));
    assert!(with != without && with == paint(door_key()));
    assert_eq!(paint(door_key().drawn(13, true).unwrap()).size(), [78, 78]);
}

#[test]
fn a_picture_that_is_too_large_is_refused_before_it_takes_memory() {
    let huge = || world(Maker::DoorKey { size: 255 }).drawn(256, true).unwrap();
    let no = Pictured::new(huge(), Layout::Random, Format::NATIVE).map(drop).unwrap_err().to_string();
    assert!(no.contains("65280 by 65280") && no.contains("scale it"), "{no}");
    let wide = world(Maker::KeyCorridor { room: 85, rows: 1 });
    assert_eq!(wide.native(), [253 * 8, 85 * 8]);
    let sizes = [(16, true), (17, false)];
    for (side, fits) in sizes {
        let wide = wide.clone().drawn(side, true).unwrap();
        assert_eq!(wide.native(), [253 * side, 85 * side]);
        assert_eq!(Pictured::new(wide, Layout::Random, Format::NATIVE).is_ok(), fits, "{side}");
    }
    // For people it is scaled down.
    let mut env = Symbolic::new(
        world(Maker::KeyCorridor { room: 3, rows: 127 }).drawn(20, true).unwrap(),
        Layout::Random,
    );
    env.reset(0);
    let Drawing::Pixels(picture) = env.drawing() else { panic!("worlds are drawn in pixels") };
    assert_eq!(picture.dimensions(), (28, 1024));
}

#[test]
fn a_painter_paints_boards_of_its_own_size_only() {
    let [wide, high] = [[9, 7], [7, 9]].map(|size| {
        let (mut board, pose) = (Board::new(size).unwrap(), Pose { at: [0, 0], facing: Direction::Down });
        board.set([2, 2], Cell::Goal(Colour::Green));
        world(Maker::Own(Box::new(State::new(board, pose, Task::Reach).unwrap())))
    });
    let mut painter = wide.painter(Format::NATIVE);
    let mut paint = |world: &GridWorld| painter.paint(world, &mut Frame::default());
    paint(&wide);
    assert!(std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| paint(&high))).is_err());
}

#[test]
fn a_fixed_map_keeps_walls_and_objects_and_moves_the_start() {
    for mut world in all() {
        let fixed = |world: &mut GridWorld, layout: Layout, seed| {
            world.begin(layout.draw(seed));
            world.save()
        };
        let one = fixed(&mut world, Layout::Fixed(42), 0);
        let mut poses = Vec::new();
        for seed in 0..60 {
            assert_eq!(fixed(&mut world, Layout::Fixed(42), seed), one, "a fixed layout is one layout");
            let map = fixed(&mut world, Layout::FixedMap(42), seed);
            assert_eq!(State { pose: one.pose, ..map.clone() }, one, "only the start differs");
            assert!(map.board.is_free(map.pose.at));
            poses.push((map.pose.at, map.pose.facing as u8));
        }
        poses.sort_unstable();
        poses.dedup();
        let free = one.board.cells().filter(|&(at, _)| one.board.is_free(at)).count();
        assert!(poses.len() >= (4 * free).min(12), "{}: {} starts", world.card().name, poses.len());
    }
}

#[test]
fn symbols_are_minigrids_encoding_with_the_agent_and_what_it_carries() {
    let mut world = world(Maker::DoorKey { size: 5 });
    world.begin(Layout::Random.draw(4));
    let key = find(world.state(), |cell| matches!(cell, Cell::Key(_))).unwrap();
    go(&mut world, key, PICK_UP).unwrap();
    let (state, mut seen) = (world.save(), vec![9.0; 3]);
    world.symbols(&mut seen);
    let [x, y] = state.pose.at.map(f32::from);
    let facing = f32::from(state.pose.facing as u8);
    assert_eq!(seen[..8], [x, y, facing, 5.0, 4.0, 0.0, 1.0, 0.0]);
    let card = world.card();
    assert_eq!(seen.len(), card.symbols.len());
    for ((&value, dimension), index) in seen.iter().zip(&card.symbols).zip(0..) {
        assert!((dimension.low..=dimension.high).contains(&value), "{index}, {}: {value}", dimension.name);
    }
    let mut board: Vec<f32> = state.board.encode().into_iter().map(f32::from).collect();
    let agent = 3 * (5 * usize::from(state.pose.at[0]) + usize::from(state.pose.at[1]));
    assert_eq!(["object", "colour", "state"], [0, 1, 2].map(|of| &*card.symbols[8 + agent + of].name));
    board[agent..agent + 3].copy_from_slice(&[10.0, 0.0, facing]);
    assert_eq!(seen[8..], board);
    assert_eq!(
        world.facts().iter().map(|fact| fact.value).collect::<Vec<_>>(),
        [x, y, 1.0, 2.0, 0.0, 0.0, facing]
    );
}

#[test]
fn the_author_pays_one() {
    let mut world = world(Maker::Empty { size: 5 }).paying(Pay::One);
    world.begin(Layout::Random.draw(0));
    assert_eq!(solve(&mut world), Some(Step { reward: 1.0, end: Some(End::Terminated) }));
}

#[test]
fn in_an_empty_room_one_sees_all_of_the_square() {
    let mut world = world(Maker::Empty { size: 9 });
    let mut rng = Seed(1).stream("act", 0);
    world.begin(Layout::Random.draw(0));
    for _ in 0..500 {
        let Pose { at: [x, y], facing } = world.state().pose;
        let (wide, deep) = match facing {
            Direction::Right => (y, 9 - x),
            Direction::Down => (x, 9 - y),
            Direction::Left => (y, x + 1),
            Direction::Up => (x, y + 1),
        };
        let wide = 1 + wide.min(3) + (8 - wide).min(3);
        assert_eq!(world.view().cells().count(), usize::from(wide * deep.min(7)), "{:?}", world.state().pose);
        world.act(action(&mut rng));
    }
}

#[test]
fn the_largest_worlds_are_worlds_too() {
    let largest = [(3, 127), (85, 3)].map(|(room, rows)| Maker::KeyCorridor { room, rows });
    for maker in largest.into_iter().chain([Maker::DoorKey { size: 255 }]) {
        let mut world = world(maker);
        world.begin(Layout::Random.draw(0));
        assert!(solve(&mut world).is_some(), "the largest are worlds too");
    }
}

#[test]
fn nobody_starts_before_the_locked_door_or_the_key() {
    let corridors = [(3, 1), (3, 3)].map(|(room, rows)| Maker::KeyCorridor { room, rows });
    for maker in corridors.into_iter().chain([Maker::Unlock]) {
        let (mut world, mut poses) = (world(maker), BTreeSet::new());
        for seed in 0..2000 {
            world.begin(Layout::Random.draw(seed));
            let State { board, pose, .. } = world.state();
            let front = board.get(pose.front());
            let in_the_way = matches!(front, Cell::Door(_, Door::Locked) | Cell::Key(_));
            assert!(!in_the_way, "{}, seed {seed}: {front:?}", world.card().name);
            poses.insert((pose.at, pose.facing as u8));
        }
        // The 16 cells of the room, in each direction; in the smallest corridor there is one, and a locked door beside it.
        let least = if world.card().name == "unlock" { 64 } else { 3 };
        assert!(poses.len() >= least, "{}: {} starts", world.card().name, poses.len());
    }
}
