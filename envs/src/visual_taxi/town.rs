//! The towns that taxis drive in: cells, walls between them, depots.

/// A place where passengers wait or want to go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Depot {
    /// Its colour's name.
    pub name: &'static str,
    /// Its row and column.
    pub cell: [u8; 2],
    /// Its colour.
    pub colour: [u8; 3],
}

/// A square of cells with depots, fenced, and with walls between columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Town {
    size: u8,
    walls: &'static [Wall],
    depots: &'static [Depot],
}

/// A wall between two columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Wall {
    /// The column to its left.
    right_of: u8,
    /// The first and the last row that it passes.
    rows: [u8; 2],
}

const fn wall(right_of: u8, first: u8, last: u8) -> Wall {
    Wall { right_of, rows: [first, last] }
}

const fn depot(name: &'static str, row: u8, column: u8, colour: [u8; 3]) -> Depot {
    Depot { name, cell: [row, column], colour }
}

// The colours are visgrid's (names of the xkcd survey and of CSS, mixed).
const RED: [u8; 3] = [255, 0, 0];
const GREEN: [u8; 3] = [0, 128, 0];
const BLUE: [u8; 3] = [0, 0, 255];
const YELLOW: [u8; 3] = [255, 215, 0];
const GREY: [u8; 3] = [192, 192, 192];
const MAGENTA: [u8; 3] = [191, 0, 191];
const CYAN: [u8; 3] = [0, 191, 191];
const ORANGE: [u8; 3] = [249, 115, 6];

impl Town {
    /// Dietterich's (2000): 5 × 5 cells, four depots.
    pub const FIVE: Self = Self {
        size: 5,
        walls: &[wall(1, 0, 1), wall(0, 3, 4), wall(2, 3, 4)],
        depots: &[
            depot("blue", 4, 3, BLUE),
            depot("green", 0, 4, GREEN),
            depot("red", 0, 0, RED),
            depot("yellow", 4, 0, YELLOW),
        ],
    };

    /// 10 × 10 cells after Diuk et al. (2008), with visgrid's eight depots.
    pub const TEN: Self = Self {
        size: 10,
        walls: TEN_WALLS,
        depots: &[
            depot("blue", 8, 0, BLUE),
            depot("cyan", 0, 8, CYAN),
            depot("gray", 3, 3, GREY),
            depot("green", 9, 4, GREEN),
            depot("magenta", 4, 6, MAGENTA),
            depot("orange", 9, 9, ORANGE),
            depot("red", 0, 0, RED),
            depot("yellow", 0, 5, YELLOW),
        ],
    };

    /// The same with seven depots, as the thesis says (section 9.3): without orange, which is visgrid's own.
    pub const TEN_WITH_SEVEN: Self = Self {
        depots: &[
            depot("blue", 8, 0, BLUE),
            depot("cyan", 0, 8, CYAN),
            depot("gray", 3, 3, GREY),
            depot("green", 9, 4, GREEN),
            depot("magenta", 4, 6, MAGENTA),
            depot("red", 0, 0, RED),
            depot("yellow", 0, 5, YELLOW),
        ],
        ..Self::TEN
    };

    /// Rows, and columns.
    pub fn size(&self) -> u8 {
        self.size
    }

    /// The depots, sorted by name.
    pub fn depots(&self) -> &'static [Depot] {
        self.depots
    }

    /// The cell beside another: directions are left, right, up, down. None where a wall is between, or the fence.
    pub fn beside(&self, [row, column]: [u8; 2], direction: usize) -> Option<[u8; 2]> {
        match direction {
            0 => (column > 0 && !self.walled(row, column - 1)).then(|| [row, column - 1]),
            1 => (column + 1 < self.size && !self.walled(row, column)).then(|| [row, column + 1]),
            2 => (row > 0).then(|| [row - 1, column]),
            _ => (row + 1 < self.size).then(|| [row + 1, column]),
        }
    }

    /// Whether there is wall at a place of the lattice, `2 × size + 1` places a side: places odd in both are cells, even
    /// in both are posts, and between two cells is their wall.
    pub fn lattice(&self, [row, column]: [u32; 2]) -> bool {
        let last = 2 * u32::from(self.size);
        match (row % 2, column % 2) {
            (0, 0) => true,
            (1, 1) => false,
            (0, _) => row == 0 || row == last,
            _ => column == 0 || column == last || self.walled((row / 2) as u8, (column / 2 - 1) as u8),
        }
    }

    /// Whether there is a wall to the right of a cell that is not the last of its row.
    fn walled(&self, row: u8, column: u8) -> bool {
        self.walls.iter().any(|wall| wall.right_of == column && (wall.rows[0]..=wall.rows[1]).contains(&row))
    }
}

const TEN_WALLS: &[Wall] =
    &[wall(2, 0, 3), wall(0, 6, 9), wall(3, 6, 9), wall(5, 2, 5), wall(7, 0, 3), wall(7, 6, 9)];
