//! Mazes as maps of square cells, in the start-centred convention of rllab, efficient-HRL and D4RL.
//!
//! With side S, the cell in row i and column j has its centre at x = (j − j_r) S, y = (i − i_r) S, where
//! (i_r, j_r) is the first start: that start is the origin and y grows *downwards* in the text.

use super::Rectangle;

/// A map of wall and free cells.
///
/// ```
/// let map = inroads_sim::rigid::CellMap::parse("#####\n#r.g#\n#####", 4.0)?;
/// assert_eq!(map.goals(), [[8.0, 0.0]]);
/// assert!(map.is_wall([2.0, 2.0]) && !map.is_wall([2.0, 1.9]));
/// # Ok::<(), inroads_sim::rigid::MapError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct CellMap {
    scale: f64,
    /// Row by row, all of one length.
    walls: Vec<Vec<bool>>,
    /// Row and column of the first start.
    origin: [usize; 2],
    starts: Vec<[f64; 2]>,
    goals: Vec<[f64; 2]>,
    keys: Vec<[f64; 2]>,
}

/// Why a text is not a map. Lines and columns count from 1.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MapError {
    /// A character that means nothing.
    #[error(
        "map line {line}, column {column}: {found:?} is no cell; use # or 1 for a wall, 0, . or a space for free, \
         r for a start, g for a goal, k for a key"
    )]
    Unknown {
        /// Its line.
        line: usize,
        /// Its column.
        column: usize,
        /// The character.
        found: char,
    },
    /// A row shorter or longer than the first.
    #[error(
        "map line {line}, column {column}: the row differs in length from line 1, which has {expected} cells; make \
         all rows equally long"
    )]
    Ragged {
        /// The row's line.
        line: usize,
        /// Where the shorter of the two rows has ended.
        column: usize,
        /// Cells of line 1.
        expected: usize,
    },
    /// No cell is a start.
    #[error("map lines 1 to {lines}, columns 1 to {columns}: no cell is a start; mark one with r")]
    NoStart {
        /// Lines that the text has.
        lines: usize,
        /// Columns that it has.
        columns: usize,
    },
    /// The side of a cell is not a positive finite number.
    #[error("a map's cells cannot have side {0}; give a positive finite number of metres")]
    Scale(f64),
}

impl CellMap {
    /// Reads a map, one row a line: `#` or `1` wall; `0`, `.` or space free; `r` start; `g` goal; `k` key.
    /// `scale` is the side of a cell in metres.
    ///
    /// # Errors
    /// [`MapError`] says what is wrong and where.
    pub fn parse(text: &str, scale: f64) -> Result<Self, MapError> {
        if !(scale.is_finite() && scale > 0.0) {
            return Err(MapError::Scale(scale));
        }
        let columns = text.lines().next().map_or(0, |row| row.chars().count());
        let (mut walls, mut starts, mut goals, mut keys) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for (row, cells) in text.lines().enumerate() {
            let length = cells.chars().count();
            if length != columns {
                let column = length.min(columns) + 1;
                return Err(MapError::Ragged { line: row + 1, column, expected: columns });
            }
            let mut line = Vec::with_capacity(columns);
            for (column, found) in cells.chars().enumerate() {
                match found {
                    'r' => starts.push([row, column]),
                    'g' => goals.push([row, column]),
                    'k' => keys.push([row, column]),
                    '#' | '1' | '0' | '.' | ' ' => {}
                    _ => return Err(MapError::Unknown { line: row + 1, column: column + 1, found }),
                }
                line.push(matches!(found, '#' | '1'));
            }
            walls.push(line);
        }
        let Some(&origin) = starts.first() else {
            return Err(MapError::NoStart { lines: walls.len(), columns });
        };
        let centres =
            |cells: Vec<[usize; 2]>| cells.into_iter().map(|cell| centre(cell, origin, scale)).collect();
        let [starts, goals, keys] = [starts, goals, keys].map(centres);
        Ok(Self { scale, walls, origin, starts, goals, keys })
    }

    /// The side of a cell, metres.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// The centres of the start cells, in reading order; never empty, and the first is the origin.
    pub fn starts(&self) -> &[[f64; 2]] {
        &self.starts
    }

    /// The centres of the goal cells, in reading order.
    pub fn goals(&self) -> &[[f64; 2]] {
        &self.goals
    }

    /// The centres of the cells in which a key lies, in reading order.
    pub fn keys(&self) -> &[[f64; 2]] {
        &self.keys
    }

    /// Line and column, from 1, of the first free cell at the map's edge: where a body could leave it.
    pub fn opening(&self) -> Option<[usize; 2]> {
        let [bottom, right] = [self.walls.len() - 1, self.walls[0].len() - 1];
        let at_edge =
            |[row, column]: &[usize; 2]| *row == 0 || *column == 0 || *row == bottom || *column == right;
        self.free().find(at_edge).map(|[row, column]| [row + 1, column + 1])
    }

    /// The centres of all cells that are not walls, in reading order.
    pub fn free_cells(&self) -> impl Iterator<Item = [f64; 2]> {
        self.free().map(|cell| centre(cell, self.origin, self.scale))
    }

    /// Whether a point lies in a wall, whose border belongs to it. So does all that lies outside the map, and
    /// what is not a number.
    pub fn is_wall(&self, at: [f64; 2]) -> bool {
        self.crosses_wall(at, at)
    }

    /// Whether any point of the segment lies in a wall, in the sense of [`is_wall`](Self::is_wall).
    pub fn crosses_wall(&self, from: [f64; 2], to: [f64; 2]) -> bool {
        let outline = self.outline();
        if !(outline.surrounds(from) && outline.surrounds(to)) {
            return true;
        }
        let low = [from[0].min(to[0]), from[1].min(to[1])];
        let high = [from[0].max(to[0]), from[1].max(to[1])];
        self.walls_about(low, high).any(|cell| self.block(cell, cell).meets(from, to))
    }

    /// Whether a wall may lie nearer than `reach` metres: false is certain, true is not.
    pub fn may_touch_wall(&self, at: [f64; 2], reach: f64) -> bool {
        self.may_meet_wall(at, [reach; 2])
    }

    /// Whether a wall may meet the rectangle about a point with these half sizes: false is certain, true is not.
    pub fn may_meet_wall(&self, at: [f64; 2], half: [f64; 2]) -> bool {
        let (low, high) = ([at[0] - half[0], at[1] - half[1]], [at[0] + half[0], at[1] + half[1]]);
        let outline = self.outline();
        !(outline.surrounds(low) && outline.surrounds(high)) || self.walls_about(low, high).next().is_some()
    }

    /// The least rectangle that holds all free cells.
    pub fn bounds(&self) -> Rectangle {
        let (low, high) = self.free().fold((self.origin, self.origin), |(low, high), [row, column]| {
            ([low[0].min(row), low[1].min(column)], [high[0].max(row), high[1].max(column)])
        });
        self.block(low, high)
    }

    /// The walls as few rectangles: runs of a row, joined with equal runs of the rows below.
    pub fn walls(&self) -> Vec<Rectangle> {
        let mut blocks: Vec<([usize; 2], [usize; 2])> = Vec::new();
        for (row, cells) in self.walls.iter().enumerate() {
            let mut column = 0;
            for run in cells.chunk_by(|a, b| a == b) {
                let (first, last) = (column, column + run.len() - 1);
                column += run.len();
                if !run[0] {
                    continue;
                }
                let above = blocks
                    .iter_mut()
                    .find(|(low, high)| low[1] == first && high[1] == last && high[0] + 1 == row);
                match above {
                    Some((_, high)) => high[0] = row,
                    None => blocks.push(([row, first], [row, last])),
                }
            }
        }
        blocks.into_iter().map(|(low, high)| self.block(low, high)).collect()
    }

    /// Row and column of every free cell.
    fn free(&self) -> impl Iterator<Item = [usize; 2]> {
        self.walls.iter().enumerate().flat_map(|(row, cells)| {
            cells.iter().enumerate().filter(|(_, wall)| !**wall).map(move |(column, _)| [row, column])
        })
    }

    /// The whole map.
    fn outline(&self) -> Rectangle {
        self.block([0, 0], [self.walls.len() - 1, self.walls[0].len() - 1])
    }

    /// The rectangle from one cell to another.
    fn block(&self, low: [usize; 2], high: [usize; 2]) -> Rectangle {
        let half = self.scale / 2.0;
        Rectangle {
            low: centre(low, self.origin, self.scale).map(|x| x - half),
            high: centre(high, self.origin, self.scale).map(|x| x + half),
        }
    }

    /// The wall cells that meet a rectangle within the map, and perhaps some that miss it by a hair.
    fn walls_about(&self, low: [f64; 2], high: [f64; 2]) -> impl Iterator<Item = [usize; 2]> {
        // A millionth of a cell outweighs rounding; the casts clamp what it carries out of the map.
        let first = |x: f64, origin: usize| (x / self.scale + origin as f64 + 0.5 - 1e-6) as usize;
        let last = |x: f64, origin: usize, count: usize| {
            ((x / self.scale + origin as f64 + 0.5 + 1e-6) as usize).min(count - 1)
        };
        let rows = first(low[1], self.origin[0])..=last(high[1], self.origin[0], self.walls.len());
        let columns = first(low[0], self.origin[1])..=last(high[0], self.origin[1], self.walls[0].len());
        rows.flat_map(move |row| columns.clone().map(move |column| [row, column]))
            .filter(|&[row, column]| self.walls[row][column])
    }
}

/// The centre of a cell, (x, y), from its row and column.
fn centre([row, column]: [usize; 2], origin: [usize; 2], scale: f64) -> [f64; 2] {
    [(column as f64 - origin[1] as f64) * scale, (row as f64 - origin[0] as f64) * scale]
}

#[cfg(test)]
mod tests {
    use super::*;

    const U_MAZE: &str = "11111\n1r001\n11101\n1g001\n11111";

    fn u_maze() -> CellMap {
        CellMap::parse(U_MAZE, 4.0).unwrap()
    }

    #[test]
    fn the_first_start_is_the_origin_and_y_grows_downwards() {
        let map = u_maze();
        assert_eq!((map.starts(), map.goals()), (&[[0.0, 0.0]][..], &[[0.0, 8.0]][..]));
        let free: Vec<_> = map.free_cells().collect();
        assert_eq!(free, [[0., 0.], [4., 0.], [8., 0.], [8., 4.], [0., 8.], [4., 8.], [8., 8.]]);
        assert_eq!(map.bounds(), Rectangle { low: [-2.0, -2.0], high: [10.0, 10.0] });
    }

    #[test]
    fn walls_include_their_borders_and_all_that_lies_outside() {
        let map = u_maze();
        assert!(!map.is_wall([1.999, 1.999]) && map.is_wall([2.0, 2.0]) && map.is_wall([-2.0, 0.0]));
        assert!(map.is_wall([0.0, 4.0]) && !map.is_wall([8.0, 4.0]));
        assert!(map.is_wall([1e300, 0.0]) && map.is_wall([f64::NAN, 0.0]) && map.is_wall([0.0, -1e300]));
        let open = CellMap::parse("r.", 1.0).unwrap();
        assert!(!open.is_wall([1.4, 0.4]) && open.is_wall([1.5, 0.0]) && open.is_wall([0.0, -0.5]));
    }

    #[test]
    fn a_path_through_a_wall_is_noticed_though_both_its_ends_are_free() {
        let map = u_maze();
        assert!(map.crosses_wall([0.0, 0.0], [0.0, 8.0]));
        assert!(map.crosses_wall([5.5, 1.9], [6.1, 2.5]), "across the corner (6, 2)");
        assert!(!map.crosses_wall([0.0, 0.0], [8.0, 0.0]) && !map.crosses_wall([8.0, 0.0], [8.0, 8.0]));
    }

    #[test]
    fn walls_are_covered_once() {
        let map = u_maze();
        let area: f64 = map.walls().iter().map(|w| (w.high[0] - w.low[0]) * (w.high[1] - w.low[1])).sum();
        assert_eq!(area, 18.0 * 16.0);
        for wall in map.walls() {
            assert!(map.is_wall([(wall.low[0] + wall.high[0]) / 2.0, (wall.low[1] + wall.high[1]) / 2.0]));
        }
    }

    #[test]
    fn reach_errs_on_the_side_of_walls() {
        let map = u_maze();
        assert!(!map.may_touch_wall([0.0, 0.0], 1.9) && map.may_touch_wall([0.0, 0.0], 2.1));
        assert!(map.may_touch_wall([7.0, 1.0], 1.5) && !map.may_touch_wall([7.0, 1.0], 0.9));
        assert!(map.may_meet_wall([7.0, 1.0], [1.5, 1.5]) && !map.may_meet_wall([7.0, 1.0], [0.9, 1.5]));
        assert!(map.may_touch_wall([100.0, 0.0], 0.1) && map.may_touch_wall([f64::NAN, 0.0], 0.1));
    }

    #[test]
    fn keys_and_openings_are_found() {
        let map = CellMap::parse("#####\n#rkg.\n#####", 2.0).unwrap();
        assert_eq!((map.keys(), map.goals()), (&[[2.0, 0.0]][..], &[[4.0, 0.0]][..]));
        assert_eq!((map.opening(), u_maze().opening()), (Some([2, 5]), None));
        assert!(!map.is_wall([2.0, 0.0]), "a key lies in a free cell");
    }

    #[test]
    fn a_malformed_map_names_the_place() {
        let parse = |text| CellMap::parse(text, 1.0).unwrap_err();
        assert_eq!(parse("###\n#r?"), MapError::Unknown { line: 2, column: 3, found: '?' });
        assert_eq!(parse("###\n#r\n###"), MapError::Ragged { line: 2, column: 3, expected: 3 });
        assert_eq!(parse("###\n#r##\n###"), MapError::Ragged { line: 2, column: 4, expected: 3 });
        assert_eq!(parse("###\n#.#"), MapError::NoStart { lines: 2, columns: 3 });
        assert_eq!(parse(""), MapError::NoStart { lines: 0, columns: 0 });
        assert!(parse("#?").to_string().contains("line 1, column 2: '?'"));
        for scale in [0.0, -1.0, f64::INFINITY] {
            assert_eq!(CellMap::parse("r", scale), Err(MapError::Scale(scale)));
        }
        assert!(matches!(CellMap::parse("r", f64::NAN), Err(MapError::Scale(_))));
    }
}
