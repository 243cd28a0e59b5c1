//! A corridor with rooms on either side; the ball is in one that is locked, the key in one on the other side.

use super::{Cell, Direction, Rng, State, Task, colour, place, place_agent_before_nothing, rooms::Rooms};
use crate::grid::Door;
use rand::RngExt;

/// Rooms beside each other: the left ones, the corridor, the right ones.
const COLUMNS: u8 = 3;

pub(super) fn lay_out([side, rows]: [u8; 2], rng: &mut Rng, state: &mut State) {
    let mut rooms = Rooms::new(rng, &mut state.board, side, [COLUMNS, rows]);
    (1..rows).for_each(|row| rooms.open(&mut state.board, [1, row], Direction::Up));

    let locked = [2, rng.random_range(0..rows)];
    let (lock, ball) = (colour(rng), Cell::Ball(colour(rng)));
    rooms.add_door(&mut state.board, locked, Direction::Left, Cell::Door(lock, Door::Locked));
    // MiniGrid also keeps objects from being next to the middle of the board: no cell of the rooms on either side is.
    place(rng, state, rooms.area(locked), ball);
    let row = rng.random_range(0..rows);
    place(rng, state, rooms.area([0, row]), Cell::Key(lock));

    // In the middle row's part of the corridor, and not before a door: so far there is only the locked one.
    place_agent_before_nothing(rng, state, rooms.area([1, rows / 2]));

    rooms.connect(rng, &mut state.board, locked);
    state.task = Task::Take(ball);
}
