//! Two rooms and a locked door between them.

use super::{
    Area, Cell, Direction, Rng, State, Task, colour, place, place_agent_before_nothing, rooms::Rooms,
};
use crate::grid::Door;

/// Cells along a side of a room, walls included.
pub(super) const ROOM: u8 = 6;
/// Columns and rows of the board.
pub(super) const SIZE: [u8; 2] = [2 * (ROOM - 1) + 1, ROOM];
/// The left room, where agent and key are: from the right one the key is out of reach.
pub(super) const START: Area = Area { at: [0, 0], size: [ROOM, ROOM] };

pub(super) fn lay_out(rng: &mut Rng, state: &mut State) {
    let mut rooms = Rooms::new(rng, &mut state.board, ROOM, [2, 1]);
    let colour = colour(rng);
    let at = rooms.add_door(&mut state.board, [0, 0], Direction::Right, Cell::Door(colour, Door::Locked));
    place(rng, state, START, Cell::Key(colour));
    place_agent_before_nothing(rng, state, START);
    state.task = Task::Open(at);
}
