//! Rooms in rows and columns, walls shared, and doors between neighbours.

use super::{Area, Board, Cell, Direction, Rng, colour, one_of};
use crate::grid::Door;
use rand::RngExt;

/// Rooms in rows and columns.
pub(super) struct Rooms {
    /// Cells along a side of a room, walls included.
    side: u8,
    /// How many columns and rows of rooms.
    size: [u8; 2],
    walls: Vec<Wall>,
    /// For each room, the least room that one can get to from it through doors and openings, whatever it takes to open them.
    least: Vec<usize>,
}

/// What two neighbours share.
#[derive(Clone, Copy)]
struct Wall {
    /// The room to the left of it or above.
    room: [u8; 2],
    /// From there, right or down.
    to: Direction,
    /// Where its door would be.
    door: [u8; 2],
    /// Whether there is a door or an opening.
    linked: bool,
}

impl Rooms {
    /// Walls all rooms of a board in and draws where the doors would be.
    pub(super) fn new(rng: &mut Rng, board: &mut Board, side: u8, size: [u8; 2]) -> Self {
        let mut rooms = Self { side, size, walls: Vec::new(), least: Vec::new() };
        let all = Area { at: [0, 0], size }.cells();
        rooms.least = (0..all.clone().count()).collect();
        for room in all {
            let Area { at: [x, y], .. } = rooms.area(room);
            rooms.area(room).wall_in(board);
            let (right, bottom) = (x + side - 1, y + side - 1);
            if room[0] + 1 < size[0] {
                let door = [right, rng.random_range(y + 1..bottom)];
                rooms.walls.push(Wall { room, to: Direction::Right, door, linked: false });
            }
            if room[1] + 1 < size[1] {
                let door = [rng.random_range(x + 1..right), bottom];
                rooms.walls.push(Wall { room, to: Direction::Down, door, linked: false });
            }
        }
        rooms
    }

    /// A room with the walls around it.
    pub(super) fn area(&self, room: [u8; 2]) -> Area {
        Area { at: room.map(|r| r * (self.side - 1)), size: [self.side; 2] }
    }

    /// Puts a door into the wall on that side of a room and says where.
    pub(super) fn add_door(
        &mut self,
        board: &mut Board,
        room: [u8; 2],
        to: Direction,
        door: Cell,
    ) -> [u8; 2] {
        let wall = self.wall(room, to);
        self.link(wall);
        board.set(self.walls[wall].door, door);
        self.walls[wall].door
    }

    /// Takes away the wall on that side of a room, but for its ends.
    pub(super) fn open(&mut self, board: &mut Board, room: [u8; 2], to: Direction) {
        let wall = self.wall(room, to);
        self.link(wall);
        let Wall { room, to, .. } = self.walls[wall];
        let Area { at: [x, y], .. } = self.area(room);
        let last = self.side - 1;
        for along in 1..last {
            let at = match to {
                Direction::Right => [x + last, y + along],
                _ => [x + along, y + last],
            };
            board.set(at, Cell::Empty);
        }
    }

    /// Adds closed doors, in any colour, until all rooms can be got to from each other; `locked` gets none.
    ///
    /// Each door is drawn from all walls that have none and are not the locked room's, whether or not it makes a new way:
    /// that is what MiniGrid's drawing of rooms and sides comes to.
    pub(super) fn connect(&mut self, rng: &mut Rng, board: &mut Board, locked: [u8; 2]) {
        while self.least.iter().any(|&least| least != 0) {
            let free = (0..self.walls.len()).filter(|&wall| {
                let Wall { room, to, linked, .. } = self.walls[wall];
                !linked && room != locked && neighbour(room, to) != locked
            });
            let wall = one_of(rng, free);
            self.link(wall);
            board.set(self.walls[wall].door, Cell::Door(colour(rng), Door::Closed));
        }
    }

    fn wall(&self, room: [u8; 2], to: Direction) -> usize {
        let (room, to) = match to {
            Direction::Right | Direction::Down => (room, to),
            Direction::Left | Direction::Up => (neighbour(room, to), to.back()),
        };
        self.walls
            .iter()
            .position(|wall| wall.room == room && wall.to == to)
            .expect("rooms have neighbours there")
    }

    fn link(&mut self, wall: usize) {
        let Wall { room, to, .. } = self.walls[wall];
        self.walls[wall].linked = true;
        let index = |[x, y]: [u8; 2]| usize::from(y) * usize::from(self.size[0]) + usize::from(x);
        let (a, b) = (self.least[index(room)], self.least[index(neighbour(room, to))]);
        for least in self.least.iter_mut().filter(|least| **least == a.max(b)) {
            *least = a.min(b);
        }
    }
}

fn neighbour(room: [u8; 2], to: Direction) -> [u8; 2] {
    let [dx, dy] = to.vector();
    [room[0].wrapping_add_signed(dx), room[1].wrapping_add_signed(dy)]
}
