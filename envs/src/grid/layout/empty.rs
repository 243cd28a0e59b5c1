//! An empty room.

use super::{Area, Cell, Colour, Direction, Pose, State};

/// From the corner at the top left, looking right, to the goal at the bottom right: nothing is drawn at random.
///
/// MiniGrid lets one see through its walls, which makes no difference: there is nothing behind them, and in a room without
/// corners in the way one sees all of the square before one.
pub(super) fn lay_out(state: &mut State) {
    Area::all(&state.board).wall_in(&mut state.board);
    let [width, height] = state.board.size();
    state.board.set([width - 2, height - 2], Cell::Goal(Colour::Green));
    state.pose = Pose { at: [1, 1], facing: Direction::Right };
}
