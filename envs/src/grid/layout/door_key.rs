//! A goal behind a locked door, and its key on this side.

use super::{Area, Cell, Colour, Rng, State, WALL, place, place_agent};
use crate::grid::Door;
use rand::RngExt;

pub(super) fn lay_out(rng: &mut Rng, state: &mut State) {
    let [width, height] = state.board.size();
    let board = &mut state.board;
    Area::all(board).wall_in(board);
    board.set([width - 2, height - 2], Cell::Goal(Colour::Green));
    let split = rng.random_range(2..width - 2);
    (0..height).for_each(|y| board.set([split, y], WALL));
    // As in MiniGrid, never in the last row.
    let door = [split, rng.random_range(1..height - 2)];
    board.set(door, Cell::Door(Colour::Yellow, Door::Locked));
    let left = Area { at: [0, 0], size: [split, height] };
    place_agent(rng, state, left);
    place(rng, state, left, Cell::Key(Colour::Yellow));
}
