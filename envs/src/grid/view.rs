//! What the agent sees: MiniGrid's rule of sight, in bits.
//!
//! An agent sees a square of seven by seven cells that lies before it, and it stands in the middle of the near edge. Sight
//! starts in its cell and goes from line to line, away from it. In a line it spreads sideways through cells that one can
//! see through, up to and including the first on each side that one cannot; and each cell that it has passed through
//! shows the three cells before it in the next line.
//!
//! MiniGrid sweeps each line to the right and then to the left. Both sweeps together reach all of each run of clear
//! cells in which a cell was seen before, which is what is computed here; it follows that right and left are alike, and
//! that lines can be read along the board's own axes.

use super::{Direction, Pose};

/// Cells along a side of the square that an agent sees.
const SIDE: u8 = 7;
/// Cells of it on either side of the agent.
const HALF: u8 = SIDE / 2;
/// All bits of a line.
const LINE: u16 = (1 << SIDE) - 1;

/// Which cells of a board one can see through: a bit each, once by rows and once by columns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Clear {
    size: [u8; 2],
    /// Bytes a line.
    stride: usize,
    /// The rows, then the columns. Bit `c + HALF` of a line is its cell `c`, so that the bits about a cell begin at its
    /// number; all bits beyond the board are 0, like wall.
    bits: Vec<u8>,
}

impl Clear {
    /// Of an empty board.
    pub(super) fn new(size: [u8; 2]) -> Self {
        // A line is read two bytes at a time, of which the second may be the one after its last.
        let stride = (usize::from(size[0].max(size[1])) + usize::from(2 * HALF)) / 8 + 2;
        let line = |cells: u8| -> Vec<u8> {
            let on_board = usize::from(HALF)..usize::from(HALF) + usize::from(cells);
            let bit = |byte: usize, bit: usize| u8::from(on_board.contains(&(8 * byte + bit))) << bit;
            (0..stride).map(|byte| (0..8).map(|k| bit(byte, k)).sum()).collect()
        };
        let [rows, columns] = [line(size[0]).repeat(size[1].into()), line(size[1]).repeat(size[0].into())];
        Self { size, stride, bits: [rows, columns].concat() }
    }

    pub(super) fn set(&mut self, [x, y]: [u8; 2], clear: bool) {
        for (line, along) in [(usize::from(y), x), (self.column(x), y)] {
            let bit = usize::from(along) + usize::from(HALF);
            let byte = &mut self.bits[line * self.stride + bit / 8];
            *byte = *byte & !(1 << (bit % 8)) | u8::from(clear) << (bit % 8);
        }
    }

    /// The line of a column: columns come after the rows.
    fn column(&self, x: u8) -> usize {
        usize::from(self.size[1]) + usize::from(x)
    }

    /// Seven bits of a line, of which `middle` is the fourth.
    fn about(&self, line: usize, middle: u8) -> u16 {
        let byte = line * self.stride + usize::from(middle) / 8;
        u16::from_le_bytes([self.bits[byte], self.bits[byte + 1]]) >> (middle % 8) & LINE
    }

    pub(super) fn seen_from(&self, pose: Pose) -> View {
        let mut view = View::new(self.size, pose);
        let [_, middle] = view.axes(pose.at);
        // In the agent's line only its own cell is seen at first.
        let mut seen: u16 = 1 << HALF;
        for k in 0..view.deep {
            let line = match pose.facing {
                Direction::Right => self.column(pose.at[0] + k),
                Direction::Left => self.column(pose.at[0] - k),
                Direction::Down => usize::from(pose.at[1] + k),
                Direction::Up => usize::from(pose.at[1] - k),
            };
            let through = touched(self.about(line, middle), seen);
            let wider = (through << 1 | through | through >> 1) & LINE;
            view.lines[usize::from(k)] = (seen | wider) & view.inside;
            if wider == 0 {
                break;
            }
            seen = wider;
        }
        view
    }
}

/// The runs of ones of `clear` that have at least one bit of `seen` in them.
fn touched(clear: u16, seen: u16) -> u16 {
    let seeds = clear & seen;
    // A carry runs from the lowest seed of a run up through all of its ones and clears them, but for other seeds.
    let up = clear & !(clear + seeds) | seeds;
    // Downwards by doubling: one, two, then four cells at a time through cells that are clear.
    let mut down = up | clear & (up >> 1);
    let two = clear & (clear >> 1);
    down |= two & (down >> 2);
    let four = two & (two >> 2);
    down | four & (down >> 4)
}

/// The cells that an agent sees.
#[derive(Clone, Copy, Debug)]
pub struct View {
    pose: Pose,
    /// Lines of the square that lie on the board.
    deep: u8,
    /// Bits of a line that lie on the board.
    inside: u16,
    /// From the agent's line on: which of the seven cells about its own row or column are seen, from the left or from the
    /// top.
    lines: [u16; SIDE as usize],
}

impl View {
    /// Nothing yet.
    fn new(size: [u8; 2], pose: Pose) -> Self {
        let [x, y] = pose.at;
        let ahead = match pose.facing {
            Direction::Right => size[0] - x,
            Direction::Down => size[1] - y,
            Direction::Left => x + 1,
            Direction::Up => y + 1,
        };
        let mut view = Self { pose, deep: ahead.min(SIDE), inside: 0, lines: [0; SIDE as usize] };
        let ([_, middle], [_, across]) = (view.axes(pose.at), view.axes(size));
        let (below, above) = (HALF.saturating_sub(middle), (across - middle).min(HALF + 1) + HALF);
        view.inside = (1 << above) - (1 << below);
        view
    }

    /// Columns and rows as: along the agent's heading, and across it. Its own inverse.
    fn axes(&self, [x, y]: [u8; 2]) -> [u8; 2] {
        match self.pose.facing {
            Direction::Right | Direction::Left => [x, y],
            Direction::Down | Direction::Up => [y, x],
        }
    }

    /// The cells: all lie on the board.
    pub fn cells(self) -> impl Iterator<Item = [u8; 2]> {
        let [along, middle] = self.axes(self.pose.at);
        let back = matches!(self.pose.facing, Direction::Left | Direction::Up);
        self.lines.into_iter().zip(0..self.deep).flat_map(move |(line, k)| {
            let along = if back { along - k } else { along + k };
            Bits(line).map(move |bit| self.axes([along, middle + bit - HALF]))
        })
    }
}

/// The numbers of the ones of a word.
struct Bits(u16);

impl Iterator for Bits {
    type Item = u8;

    fn next(&mut self) -> Option<u8> {
        let bit = self.0.trailing_zeros() as u8;
        (self.0 != 0).then(|| {
            self.0 &= self.0 - 1;
            bit
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Board, Cell, Colour};
    use super::*;
    use crate::Seed;
    use rand::RngExt;

    #[test]
    fn runs_are_touched_as_one_would_do_it_by_hand() {
        for clear in 0..=LINE {
            for seen in 0..=LINE {
                let mut by_hand = clear & seen;
                for _ in 0..SIDE {
                    by_hand |= clear & (by_hand << 1 | by_hand >> 1);
                }
                assert_eq!(touched(clear, seen), by_hand, "{clear:07b} {seen:07b}");
            }
        }
    }

    /// MiniGrid's rule as envs.md a.3 has it, cell by cell: columns from the agent's left, rows from the far one.
    fn swept(board: &Board, pose: Pose) -> Vec<[u8; 2]> {
        let (ahead, aside) = (pose.facing.vector(), pose.facing.right().vector());
        let place = |column: i16, row: i16| -> [i16; 2] {
            std::array::from_fn(|axis| {
                let from = |v: [i8; 2], times: i16| i16::from(v[axis]) * times;
                i16::from(pose.at[axis]) + from(ahead, 6 - row) + from(aside, column - 3)
            })
        };
        let on_board =
            |at: [i16; 2]| (0..2).all(|axis| (0..i16::from(board.size()[axis])).contains(&at[axis]));
        let clear = |column, row| {
            let at = place(column, row);
            on_board(at) && board.get(at.map(|c| c as u8)).clear()
        };
        let mut seen = [[false; 7]; 7];
        seen[3][6] = true;
        for row in (0..7_i16).rev() {
            let sweeps = (0..6_i16).map(|c| (c, c + 1)).chain((1..7_i16).rev().map(|c| (c, c - 1)));
            for (column, next) in sweeps {
                if seen[column as usize][row as usize] && clear(column, row) {
                    seen[next as usize][row as usize] = true;
                    if row > 0 {
                        seen[next as usize][row as usize - 1] = true;
                        seen[column as usize][row as usize - 1] = true;
                    }
                }
            }
        }
        let all = (0..7).flat_map(|column| (0..7).map(move |row| (column, row)));
        let mut cells: Vec<[u8; 2]> = all
            .filter(|&(column, row)| seen[column][row])
            .map(|(column, row)| place(column as i16, row as i16))
            .filter(|&at| on_board(at))
            .map(|at| at.map(|c| c as u8))
            .collect();
        cells.sort_unstable();
        cells
    }

    #[test]
    fn bits_see_what_minigrids_sweeps_see() {
        let mut rng = Seed(3).stream("sight", 0);
        for round in 0..4000 {
            let size = std::array::from_fn(|_| rng.random_range(1..=if round % 50 == 0 { 255 } else { 12 }));
            let mut board = Board::empty(size);
            let walls = rng.random_range(0.0..0.6);
            for x in 0..size[0] {
                for y in 0..size[1] {
                    if rng.random_bool(walls) {
                        board.set([x, y], Cell::Wall(Colour::Grey));
                    }
                }
            }
            for facing in Direction::ALL {
                let pose = Pose { at: size.map(|length| rng.random_range(0..length)), facing };
                let mut cells: Vec<_> = board.seen_from(pose).cells().collect();
                cells.sort_unstable();
                assert_eq!(cells, swept(&board, pose), "{size:?} {pose:?}");
            }
        }
    }
}
