//! How episodes begin: MiniGrid's layouts, and anybody's own.
//!
//! MiniGrid draws a place again and again until it is free. Here the free ones are counted and one of them is drawn,
//! which is the same distribution and always comes to an end.

mod door_key;
mod empty;
mod four_rooms;
mod key_corridor;
mod rooms;
mod unlock;

use rand::RngExt;

use super::{Board, Cell, Colour, Direction, GridError, Pose, State, Task, world::between};
use crate::Rng;

/// What makes the layouts of a world.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Maker {
    /// An empty square room, from corner to corner; `size` cells a side with the walls, 5 to 255.
    Empty {
        /// Cells a side, walls included.
        size: u32,
    },
    /// Two rooms and a locked door between them, which must be opened.
    Unlock,
    /// Four rooms round a cross of walls, each wall with a gap.
    FourRooms,
    /// A room behind a locked door; `size` cells a side with the walls, 5 to 255.
    DoorKey {
        /// Cells a side, walls included.
        size: u32,
    },
    /// A corridor with `rows` rooms on either side, one of them locked, with a ball in it.
    KeyCorridor {
        /// Cells along a side of a room, walls included, 3 to 85.
        room: u32,
        /// Rooms a side, 1 or more; the height `rows (room - 1) + 1` is at most 255.
        rows: u32,
    },
    /// Always this.
    Own(Box<State>),
}

/// A maker whose sizes were checked.
#[derive(Clone, Debug)]
pub(super) enum Map {
    Empty(u8),
    Unlock,
    FourRooms,
    DoorKey(u8),
    KeyCorridor { room: u8, rows: u8 },
    Own(Box<State>),
}

impl Map {
    pub(super) fn new(maker: Maker) -> Result<Self, GridError> {
        let side = |what, size| between(what, size, 5, 255).map(|size| size as u8);
        Ok(match maker {
            Maker::Empty { size } => Self::Empty(side("cells along a side of the room", size)?),
            Maker::Unlock => Self::Unlock,
            Maker::FourRooms => Self::FourRooms,
            Maker::DoorKey { size } => Self::DoorKey(side("cells along a side of door-key", size)?),
            Maker::KeyCorridor { room, rows } => {
                let room = between("cells along a side of a room of key-corridor", room, 3, 85)?;
                let rows = between("rows of rooms of that size in key-corridor", rows, 1, 254 / (room - 1))?;
                Self::KeyCorridor { room: room as u8, rows: rows as u8 }
            }
            Maker::Own(state) => state.check().map(|()| Self::Own(state))?,
        })
    }

    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::Empty(_) => "empty",
            Self::Unlock => "unlock",
            Self::FourRooms => "four-rooms",
            Self::DoorKey(_) => "door-key",
            Self::KeyCorridor { .. } => "key-corridor",
            Self::Own(_) => "grid",
        }
    }

    pub(super) fn about(&self) -> &'static str {
        match self {
            Self::Empty(_) => "an empty room, from one corner to the other",
            Self::Unlock => "take the key and open the locked door",
            Self::FourRooms => "four rooms with gaps between them, and a goal somewhere",
            Self::DoorKey(_) => "take the key, unlock the door, reach the goal behind it",
            Self::KeyCorridor { .. } => {
                "find the key in the rooms of a corridor, unlock the ball's room, take the ball"
            }
            Self::Own(_) => "a grid of somebody's own",
        }
    }

    /// Columns and rows.
    pub(super) fn size(&self) -> [u8; 2] {
        match self {
            Self::Empty(side) | Self::DoorKey(side) => [*side; 2],
            Self::Unlock => unlock::SIZE,
            Self::FourRooms => four_rooms::SIZE,
            Self::KeyCorridor { room, rows } => [3 * (room - 1) + 1, rows * (room - 1) + 1],
            Self::Own(state) => state.board.size(),
        }
    }

    /// MiniGrid's limit to the steps of an episode.
    pub(super) fn limit(&self) -> u32 {
        let square = |side: u8| u32::from(side) * u32::from(side);
        match self {
            Self::Empty(side) => 4 * square(*side),
            Self::Unlock => 8 * square(unlock::ROOM),
            // What MiniGrid takes where a domain says nothing.
            Self::FourRooms | Self::Own(_) => 100,
            Self::DoorKey(side) => 10 * square(*side),
            Self::KeyCorridor { room, .. } => 30 * square(*room),
        }
    }

    /// What the agent is told to do, in MiniGrid's words.
    pub(super) fn mission(&self, state: &State) -> String {
        let object = |cell: Cell| match cell {
            Cell::Key(colour) => format!("{} key", colour.name()),
            Cell::Ball(colour) => format!("{} ball", colour.name()),
            Cell::Box(colour, _) => format!("{} box", colour.name()),
            _ => "thing".into(),
        };
        match (self, state.task) {
            (_, Task::Take(wanted)) => format!("pick up the {}", object(wanted)),
            (_, Task::Open(_)) => "open the door".into(),
            (Self::Empty(_), _) => "get to the green goal square".into(),
            (Self::DoorKey(_), _) => "use the key to open the door and then get to the goal".into(),
            _ => "reach the goal".into(),
        }
    }

    /// Makes the state the beginning of an episode.
    pub(super) fn lay_out(&self, rng: &mut Rng, state: &mut State) {
        if let Self::Own(own) = self {
            state.clone_from(own);
            return;
        }
        state.board.wipe();
        // The corner is a wall everywhere: until the agent has its place it is in nobody's way.
        (state.pose, state.carried) = (Pose::default(), Cell::Empty);
        (state.task, state.steps) = (Task::Reach, 0);
        match self {
            Self::Empty(_) => empty::lay_out(state),
            Self::Unlock => unlock::lay_out(rng, state),
            Self::FourRooms => four_rooms::lay_out(rng, state),
            Self::DoorKey(_) => door_key::lay_out(rng, state),
            Self::KeyCorridor { room, rows } => key_corridor::lay_out([*room, *rows], rng, state),
            Self::Own(_) => {}
        }
    }

    /// Puts the agent on any empty cell, looking anywhere; of the built-in layouts, on one from which the task can be done.
    /// On somebody's own board nobody knows that, and without an empty cell it stays where it is.
    pub(super) fn start_anywhere(&self, rng: &mut Rng, state: &mut State) {
        let area = match self {
            Self::Unlock => unlock::START,
            _ => Area::all(&state.board),
        };
        if area.cells().any(|at| state.board.is_free(at)) {
            place_agent(rng, state, area);
        }
    }
}

/// A rectangle of cells: the first column and row, and how many.
#[derive(Clone, Copy, Debug)]
struct Area {
    at: [u8; 2],
    size: [u8; 2],
}

impl Area {
    fn all(board: &Board) -> Self {
        Self { at: [0, 0], size: board.size() }
    }

    /// Its cells, row by row.
    fn cells(self) -> impl Iterator<Item = [u8; 2]> + Clone {
        let ([x, y], [width, height]) = (self.at, self.size);
        (y..y + height).flat_map(move |y| (x..x + width).map(move |x| [x, y]))
    }

    /// Walls along its four sides.
    fn wall_in(self, board: &mut Board) {
        let ([x, y], [width, height]) = (self.at, self.size);
        let (right, bottom) = (x + width - 1, y + height - 1);
        (x..=right).for_each(|x| [y, bottom].into_iter().for_each(|y| board.set([x, y], WALL)));
        (y..=bottom).for_each(|y| [x, right].into_iter().for_each(|x| board.set([x, y], WALL)));
    }
}

const WALL: Cell = Cell::Wall(Colour::Grey);

/// One of them, each as likely. None is only drawn from layouts that are too small, which [`Map::new`] refuses.
fn one_of<T>(rng: &mut Rng, choices: impl Iterator<Item = T> + Clone) -> T {
    let count = choices.clone().count();
    assert!(count > 0, "a layout of a legal size has room for what is in it");
    choices.clone().nth(rng.random_range(0..count)).expect("there are so many")
}

fn colour(rng: &mut Rng) -> Colour {
    one_of(rng, Colour::ALL.into_iter())
}

/// Puts something into an empty cell of the area in which the agent does not stand.
fn place(rng: &mut Rng, state: &mut State, area: Area, cell: Cell) {
    let (board, agent) = (&state.board, state.pose.at);
    let free = area.cells().filter(|&at| board.is_free(at) && at != agent);
    let at = one_of(rng, free);
    state.board.set(at, cell);
}

/// Puts the agent into an empty cell of the area, looking anywhere.
fn place_agent(rng: &mut Rng, state: &mut State, area: Area) {
    let board = &state.board;
    let at = one_of(rng, area.cells().filter(|&at| board.is_free(at)));
    state.pose = Pose { at, facing: one_of(rng, Direction::ALL.into_iter()) };
}

/// The same, before an empty cell or a wall, as MiniGrid has it where there are rooms in rows and columns.
fn place_agent_before_nothing(rng: &mut Rng, state: &mut State, area: Area) {
    let board = &state.board;
    let free = area.cells().filter(|&at| board.is_free(at));
    let poses = free
        .flat_map(|at| Direction::ALL.map(|facing| Pose { at, facing }))
        .filter(|pose| matches!(board.get(pose.front()), Cell::Empty | Cell::Wall(_)));
    state.pose = one_of(rng, poses);
}
