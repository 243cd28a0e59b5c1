//! Ground and boulders.

/// Columns of the map. Positions are `[x, y]`, x from the left, y from the top.
pub const COLUMNS: usize = 25;
/// Rows of the map.
pub const ROWS: usize = 7;
/// Cells of the map.
pub const CELLS: usize = COLUMNS * ROWS;
/// The column where the river begins: west of it is the bank of the start.
pub const BANK: usize = 18;
/// The stairs down.
pub const GOAL: Place = [24, 2];
/// What the hero's choices are, and where they lead: MiniHack's order, which is `k l j h u n b y` on the keyboard.
pub const WAYS: [(&str, Place); 8] = [
    ("north", [0, -1]),
    ("east", [1, 0]),
    ("south", [0, 1]),
    ("west", [-1, 0]),
    ("north-east", [1, -1]),
    ("south-east", [1, 1]),
    ("south-west", [-1, 1]),
    ("north-west", [-1, -1]),
];
/// Rows of the rivers with lava that are of water.
const WET_ROWS: [usize; 2] = [2, 4];

/// A position or a difference of two.
pub type Place = [i8; 2];

/// What a cell is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Ground {
    /// To be walked on.
    Floor,
    /// The hero falls in and crawls out.
    Water,
    /// The hero dies.
    Lava,
}

/// Ground and boulders of all cells, row by row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Map {
    ground: [Ground; CELLS],
    boulders: [u8; CELLS],
}

impl Map {
    /// A map without boulders, its river so many columns wide.
    pub(super) fn new(wide: usize, lava: bool) -> Self {
        let mut ground = [Ground::Floor; CELLS];
        for row in 0..ROWS {
            let liquid = if lava && !WET_ROWS.contains(&row) { Ground::Lava } else { Ground::Water };
            ground[row * COLUMNS + BANK..][..wide].fill(liquid);
        }
        Self { ground, boulders: [0; CELLS] }
    }

    /// The number of a cell; none when it is not on the map.
    pub fn cell([x, y]: Place) -> Option<usize> {
        let on = (0..COLUMNS as i8).contains(&x) && (0..ROWS as i8).contains(&y);
        on.then(|| y as usize * COLUMNS + x as usize)
    }

    /// Where a cell is.
    pub fn place(cell: usize) -> Place {
        [(cell % COLUMNS) as i8, (cell / COLUMNS) as i8]
    }

    /// What a cell is of.
    pub fn ground(&self, cell: usize) -> Ground {
        self.ground[cell]
    }

    /// How many boulders lie on a cell, or in the water there, unseen. They do not fall into the water again of themselves.
    pub fn boulders(&self, cell: usize) -> u8 {
        self.boulders[cell]
    }

    /// All boulders of the map.
    pub fn all_boulders(&self) -> u32 {
        self.boulders.iter().map(|&boulders| u32::from(boulders)).sum()
    }

    /// Puts a boulder on a cell, whatever is there.
    pub fn add_boulder(&mut self, cell: usize) {
        self.boulders[cell] += 1;
    }

    /// Takes one away.
    pub(super) fn take_boulder(&mut self, cell: usize) {
        self.boulders[cell] -= 1;
    }

    /// Makes floor of a cell.
    pub fn fill(&mut self, cell: usize) {
        self.ground[cell] = Ground::Floor;
    }

    /// Whether somebody can stand there: floor without a boulder.
    pub fn free(&self, cell: usize) -> bool {
        self.ground[cell] == Ground::Floor && self.boulders[cell] == 0
    }

    /// The free cells among the eight around a place.
    pub fn around(&self, place: Place) -> impl Iterator<Item = usize> {
        WAYS.iter().filter_map(move |(_, way)| Self::cell(add(place, *way))).filter(|&cell| self.free(cell))
    }
}

/// The sum of two differences, or of a place and a difference.
pub(super) fn add([x, y]: Place, [dx, dy]: Place) -> Place {
    [x + dx, y + dy]
}

/// The square of the distance between two places, cells.
pub(super) fn apart(a: Place, b: Place) -> i32 {
    let [dx, dy] = [i32::from(a[0]) - i32::from(b[0]), i32::from(a[1]) - i32::from(b[1])];
    dx * dx + dy * dy
}
