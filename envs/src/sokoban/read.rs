//! Rooms of one's own: from gym-sokoban's two arrays, from the text format of level collections, and why not.

use std::fmt;

use super::{Cell, Room, room::SIDES};

/// Why something is no room. Rows and columns are counted from 0, in a text from its first line that is not empty.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RoomError {
    /// Too small or too large.
    #[error(
        "a room of {rows} rows and {columns} columns; both must lie between {} and {}, walls included",
        SIDES.start(), SIDES.end()
    )]
    Size {
        /// Rows that were given.
        rows: usize,
        /// Columns that were given.
        columns: usize,
    },
    /// A row is longer or shorter than it should be.
    #[error("row {row} of `{array}` has {found} cells where {expected} are needed")]
    Ragged {
        /// Which array.
        array: &'static str,
        /// Which row.
        row: usize,
        /// Its cells.
        found: usize,
        /// Cells that it should have.
        expected: usize,
    },
    /// The arrays have different numbers of rows.
    #[error("`room_fixed` has {fixed} rows, `room_state` has {state}; they are two views of one room")]
    Rows {
        /// Rows of `room_fixed`.
        fixed: usize,
        /// Rows of `room_state`.
        state: usize,
    },
    /// A cell's two codes do not go together.
    #[error(
        "row {row}, column {column}: `room_fixed` has {fixed}, `room_state` has {state}; wall 0 goes with 0, \
         floor 1 with 1 (empty), 4 (box) or 5 (player), target 2 with 2, 3 (box) or 5 (player)"
    )]
    Codes {
        /// The cell's row.
        row: usize,
        /// The cell's column.
        column: usize,
        /// What is fixed there.
        fixed: u8,
        /// What is there.
        state: u8,
    },
    /// The text has another character.
    #[error(
        "row {row}, column {column}: `{symbol}` is none of # wall, space (or - or _) floor, . target, $ box, \
         * box on target, @ player, + player on target"
    )]
    Symbol {
        /// The line of the text.
        row: usize,
        /// The character of the line.
        column: usize,
        /// The character.
        symbol: char,
    },
    /// Nobody is there.
    #[error("the room has no player")]
    NoPlayer,
    /// There are two players.
    #[error("row {row}, column {column}: a second player; there is one")]
    SecondPlayer {
        /// The second one's row.
        row: usize,
        /// The second one's column.
        column: usize,
    },
    /// There is no box, or not one for each target.
    #[error(
        "{boxes} boxes and {targets} targets; a room has as many of one as of the other, and one at least"
    )]
    Boxes {
        /// Boxes.
        boxes: u32,
        /// Targets.
        targets: u32,
    },
    /// The player could walk out.
    #[error("row {row}, column {column}: the room is open there; fence it with walls")]
    Open {
        /// A row at the edge.
        row: usize,
        /// A column at the edge.
        column: usize,
    },
}

impl Room {
    /// The room of gym-sokoban's arrays: `room_fixed` with 0 wall, 1 floor, 2 target; `room_state` with those and 3 box
    /// on target, 4 box, 5 player.
    ///
    /// # Errors
    /// [`RoomError`] names the cell.
    pub fn of_codes<R: AsRef<[u8]>>(fixed: &[R], state: &[R]) -> Result<Self, RoomError> {
        if fixed.len() != state.len() {
            return Err(RoomError::Rows { fixed: fixed.len(), state: state.len() });
        }
        let columns = fixed.first().map_or(0, |row| row.as_ref().len());
        let mut cells = Vec::with_capacity(fixed.len() * columns);
        for (row, pair) in fixed.iter().zip(state).enumerate() {
            let [fixed, state] = [pair.0.as_ref(), pair.1.as_ref()];
            for (array, found) in [("room_fixed", fixed.len()), ("room_state", state.len())] {
                if found != columns {
                    return Err(RoomError::Ragged { array, row, found, expected: columns });
                }
            }
            for (column, (&fixed, &state)) in fixed.iter().zip(state).enumerate() {
                let codes = |cell: &&Cell| (cell.fixed_code(), cell.code()) == (fixed, state);
                let cell = Cell::ALL.iter().find(codes);
                cells.push(*cell.ok_or(RoomError::Codes { row, column, fixed, state })?);
            }
        }
        Self::new([fixed.len(), columns], cells)
    }

    /// The room that a text draws, in the format of level collections (XSB): `#` wall, space (or `-`, `_`) floor, `.`
    /// target, `$` box, `*` box on target, `@` player, `+` player on target.
    ///
    /// Lines may differ in length. Floor that nobody can reach, such as what is left of a slanted wall, becomes wall.
    ///
    /// # Errors
    /// [`RoomError`] names line and character.
    pub fn parse(text: &str) -> Result<Self, RoomError> {
        let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
        let filled = |line: &&str| !line.is_empty();
        let first = lines.iter().position(filled).unwrap_or(0);
        let last = lines.iter().rposition(filled).map_or(first, |last| last + 1);
        let columns = lines.iter().map(|line| line.chars().count()).max().unwrap_or(0);
        let rows = last - first;
        // Before lines are filled up: one long line would make all others as long.
        if !SIDES.contains(&rows) || !SIDES.contains(&columns) {
            return Err(RoomError::Size { rows, columns });
        }
        let mut cells = Vec::with_capacity(rows * columns);
        for (row, line) in lines.iter().enumerate().take(last).skip(first) {
            for (column, symbol) in line.chars().enumerate() {
                cells.push(cell(symbol).ok_or(RoomError::Symbol { row: row - first, column, symbol })?);
            }
            cells.resize((row + 1 - first) * columns, Cell::Floor);
        }
        Self::fenced([rows, columns], cells)
    }

    /// A room whose unreachable floor was filled in.
    fn fenced(size: [usize; 2], mut cells: Vec<Cell>) -> Result<Self, RoomError> {
        let [rows, columns] = size;
        let player = cells.iter().position(|cell| cell.is_player());
        // Only what can be walked over between walls stays; what lies outside of them does not reach the player.
        let mut inside = vec![false; cells.len()];
        let mut ahead: Vec<usize> = player.into_iter().collect();
        while let Some(at) = ahead.pop() {
            if std::mem::replace(&mut inside[at], true) {
                continue;
            }
            let [row, column] = [at / columns, at % columns];
            let beside = [
                (row > 0).then(|| at - columns),
                (row + 1 < rows).then_some(at + columns),
                (column > 0).then(|| at - 1),
                (column + 1 < columns).then_some(at + 1),
            ];
            ahead.extend(beside.into_iter().flatten().filter(|&at| cells[at] != Cell::Wall));
        }
        for (cell, inside) in cells.iter_mut().zip(inside) {
            if player.is_some() && !inside && *cell == Cell::Floor {
                *cell = Cell::Wall;
            }
        }
        Self::new(size, cells)
    }
}

/// The text that [`Room::parse`] reads.
impl fmt::Display for Room {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        for row in self.cells().chunks(self.size()[1]) {
            writeln!(out, "{}", row.iter().map(|&cell| SYMBOLS[cell as usize]).collect::<String>())?;
        }
        Ok(())
    }
}

/// The characters of [`Cell::ALL`].
const SYMBOLS: [char; 7] = ['#', ' ', '.', '*', '$', '@', '+'];

fn cell(symbol: char) -> Option<Cell> {
    let symbol = if matches!(symbol, '-' | '_') { ' ' } else { symbol };
    SYMBOLS.iter().position(|&known| known == symbol).map(|at| Cell::ALL[at])
}
