//! Four rooms round a cross of walls.

use super::{Area, Cell, Colour, Rng, State, WALL, place, place_agent};
use rand::RngExt;

/// Columns and rows.
pub(super) const SIZE: [u8; 2] = [19, 19];
/// Column and row of the cross.
const MIDDLE: u8 = 9;

pub(super) fn lay_out(rng: &mut Rng, state: &mut State) {
    let board = &mut state.board;
    let all = Area::all(board);
    all.wall_in(board);
    for c in 0..SIZE[0] {
        board.set([MIDDLE, c], WALL);
        board.set([c, MIDDLE], WALL);
    }
    // A gap in each arm.
    for arm in [1..MIDDLE, MIDDLE + 1..SIZE[0] - 1] {
        board.set([MIDDLE, rng.random_range(arm.clone())], Cell::Empty);
        board.set([rng.random_range(arm), MIDDLE], Cell::Empty);
    }
    place_agent(rng, state, all);
    place(rng, state, all, Cell::Goal(Colour::Green));
}
