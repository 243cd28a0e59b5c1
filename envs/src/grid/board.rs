//! A board of cells.

use super::{
    Cell, Colour, GridError, Pose,
    view::{Clear, View},
};

/// A board of cells, `[x, y]` to the right and downwards from the corner at the top left. Beyond its edges there is wall.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Board {
    size: [u8; 2],
    /// [`Cell::encode`] of each, columns from the left, in each from the top: MiniGrid's order, so that an observation is
    /// a copy.
    cells: Vec<[u8; 3]>,
    clear: Clear,
}

impl Board {
    /// An empty board of so many columns and rows, at least one each.
    ///
    /// # Errors
    /// [`GridError::Size`] when there are none.
    pub fn new(size: [u8; 2]) -> Result<Self, GridError> {
        match size.contains(&0) {
            true => Err(GridError::Size { what: "sides of a board", found: 0, least: 1, greatest: 255 }),
            false => Ok(Self::empty(size)),
        }
    }

    pub(super) fn empty(size: [u8; 2]) -> Self {
        let cells = usize::from(size[0]) * usize::from(size[1]);
        Self { size, cells: vec![Cell::Empty.encode(); cells], clear: Clear::new(size) }
    }

    /// A board from MiniGrid's encoding: three bytes a cell, columns from the left, in each from the top.
    ///
    /// # Errors
    /// [`GridError`] when there are more or fewer bytes than three a cell, or names the first cell whose bytes mean
    /// nothing.
    pub fn decode(size: [u8; 2], encoding: &[u8]) -> Result<Self, GridError> {
        let mut board = Self::new(size)?;
        let (triples, rest) = encoding.as_chunks::<3>();
        if !rest.is_empty() || triples.len() != board.cells.len() {
            return Err(GridError::Length { size, found: encoding.len() });
        }
        for (index, &bytes) in triples.iter().enumerate() {
            let at = board.place(index);
            let cell = Cell::decode(bytes).ok_or(GridError::Cell { at, bytes })?;
            board.set(at, cell);
        }
        Ok(board)
    }

    /// Makes all cells empty.
    pub(super) fn wipe(&mut self) {
        self.cells.fill(Cell::Empty.encode());
        self.clear = Clear::new(self.size);
    }

    /// Columns and rows.
    pub fn size(&self) -> [u8; 2] {
        self.size
    }

    /// What stands there; beyond the edges, wall.
    pub fn get(&self, at: [u8; 2]) -> Cell {
        match self.index(at) {
            Some(index) => Cell::decode(self.cells[index]).expect("a board holds what `set` has written"),
            None => Cell::Wall(Colour::Grey),
        }
    }

    /// Whether nothing stands there.
    pub fn is_free(&self, at: [u8; 2]) -> bool {
        self.index(at).is_some_and(|index| self.cells[index] == Cell::Empty.encode())
    }

    /// Puts something there; beyond the edges, nothing happens.
    pub fn set(&mut self, at: [u8; 2], cell: Cell) {
        if let Some(index) = self.index(at) {
            self.cells[index] = cell.encode();
            self.clear.set(at, cell.clear());
        }
    }

    /// All places with what stands there, columns from the left, in each from the top.
    pub fn cells(&self) -> impl Iterator<Item = ([u8; 2], Cell)> + Clone {
        (0..self.cells.len()).map(|index| {
            let at = self.place(index);
            (at, self.get(at))
        })
    }

    /// MiniGrid's encoding: object, colour and state of each cell, columns from the left, in each from the top. What is
    /// in a box is hidden.
    pub fn encode(&self) -> Vec<u8> {
        let hidden = |&[object, colour, state]: &[u8; 3]| match object {
            super::cell::number::BOX => [object, colour, 0],
            _ => [object, colour, state],
        };
        self.cells.iter().flat_map(hidden).collect()
    }

    /// The same without hiding anything, and without copying.
    pub(super) fn triples(&self) -> &[[u8; 3]] {
        &self.cells
    }

    /// Which cells one sees from there.
    pub fn seen_from(&self, pose: Pose) -> View {
        self.clear.seen_from(pose)
    }

    /// Where a cell stands in the encoding.
    pub(super) fn index(&self, [x, y]: [u8; 2]) -> Option<usize> {
        let [width, height] = self.size;
        (x < width && y < height).then(|| usize::from(x) * usize::from(height) + usize::from(y))
    }

    fn place(&self, index: usize) -> [u8; 2] {
        let height = usize::from(self.size[1]);
        [(index / height) as u8, (index % height) as u8]
    }
}
