//! Rooms: walls, floors, targets, boxes and one player, and what a player can do in them.

use super::RoomError;

/// What a cell holds. The first six are gym-sokoban's codes 0 to 5; there a player's target is known from a second
/// array, here from a seventh kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Cell {
    /// A wall.
    Wall,
    /// Nothing.
    Floor,
    /// A target without a box.
    Target,
    /// A box on a target.
    BoxOnTarget,
    /// A box elsewhere.
    Box,
    /// The player.
    Player,
    /// The player on a target.
    PlayerOnTarget,
}

impl Cell {
    /// All kinds.
    pub const ALL: [Self; 7] = [
        Self::Wall,
        Self::Floor,
        Self::Target,
        Self::BoxOnTarget,
        Self::Box,
        Self::Player,
        Self::PlayerOnTarget,
    ];

    /// Whether a player or a box can enter.
    pub fn is_free(self) -> bool {
        matches!(self, Self::Floor | Self::Target)
    }

    /// Whether there is a box.
    pub fn is_box(self) -> bool {
        matches!(self, Self::Box | Self::BoxOnTarget)
    }

    /// Whether the player is there.
    pub fn is_player(self) -> bool {
        matches!(self, Self::Player | Self::PlayerOnTarget)
    }

    /// Whether a target is there, covered or not.
    pub fn is_target(self) -> bool {
        matches!(self, Self::Target | Self::BoxOnTarget | Self::PlayerOnTarget)
    }

    /// gym-sokoban's number for it in `room_state`, 0 to 5.
    pub fn code(self) -> u8 {
        if self == Self::PlayerOnTarget { Self::Player as u8 } else { self as u8 }
    }

    /// gym-sokoban's number for what is fixed there: 0 wall, 1 floor, 2 target.
    pub fn fixed_code(self) -> u8 {
        match self {
            Self::Wall => 0,
            _ if self.is_target() => 2,
            _ => 1,
        }
    }

    /// The same ground with nobody on it.
    fn cleared(self) -> Self {
        if self.is_target() { Self::Target } else { Self::Floor }
    }

    /// Free ground with the player on it.
    fn with_player(self) -> Self {
        if self.is_target() { Self::PlayerOnTarget } else { Self::Player }
    }

    /// Free ground with a box on it.
    pub(super) fn with_box(self) -> Self {
        if self.is_target() { Self::BoxOnTarget } else { Self::Box }
    }
}

/// What an action moved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Moved {
    /// The player went one cell.
    pub player: bool,
    /// So did a box.
    pub pushed: bool,
}

/// A room as it is at some moment. Nothing in it can leave it: what a player could ever reach is fenced by walls.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Room {
    size: [usize; 2],
    cells: Vec<Cell>,
    player: usize,
    boxes: u32,
    /// Targets without a box.
    open: u32,
}

/// Fewest and most rows and columns of a room: walls all around leave one cell at least.
pub(super) const SIDES: std::ops::RangeInclusive<usize> = 3..=100;

impl Room {
    /// A room of `rows` × `columns` cells, row by row.
    pub(super) fn new(size: [usize; 2], cells: Vec<Cell>) -> Result<Self, RoomError> {
        let [rows, columns] = size;
        if !SIDES.contains(&rows) || !SIDES.contains(&columns) {
            return Err(RoomError::Size { rows, columns });
        }
        let mut players = (0..cells.len()).filter(|&at| cells[at].is_player());
        let player = players.next().ok_or(RoomError::NoPlayer)?;
        if let Some(second) = players.next() {
            return Err(RoomError::SecondPlayer { row: second / columns, column: second % columns });
        }
        let count = |is: fn(&Cell) -> bool| cells.iter().filter(|cell| is(cell)).count() as u32;
        let [boxes, targets] = [count(|cell| cell.is_box()), count(|cell| cell.is_target())];
        let open = targets - count(|&cell| cell == Cell::BoxOnTarget);
        if boxes == 0 || boxes != targets {
            return Err(RoomError::Boxes { boxes, targets });
        }
        let room = Self { size, cells, player, boxes, open };
        match room.reachable(|cell| cell != Cell::Wall).into_iter().find(|&at| room.at_the_edge(at)) {
            Some(at) => Err(RoomError::Open { row: at / columns, column: at % columns }),
            None => Ok(room),
        }
    }

    /// Rows and columns.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// All cells, row by row from the top.
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// What is in a row and column.
    ///
    /// # Panics
    /// When there is no such cell.
    pub fn cell(&self, [row, column]: [usize; 2]) -> Cell {
        assert!(column < self.size[1], "a row has {} cells", self.size[1]);
        self.cells[row * self.size[1] + column]
    }

    /// The player's row and column.
    pub fn player(&self) -> [usize; 2] {
        self.place(self.player)
    }

    /// Rows and columns of the boxes, row by row.
    pub fn boxes(&self) -> impl Iterator<Item = [usize; 2]> {
        (0..self.cells.len()).filter(|&at| self.cells[at].is_box()).map(|at| self.place(at))
    }

    /// How many boxes there are.
    pub fn box_count(&self) -> u32 {
        self.boxes
    }

    /// How many boxes stand on targets.
    pub fn on_target(&self) -> u32 {
        self.boxes - self.open
    }

    /// Whether all boxes stand on targets.
    pub fn solved(&self) -> bool {
        self.open == 0
    }

    /// Carries out an action: 0 nothing; 1 to 4 push up, down, left, right; 5 to 8 move so. A push with no box to push
    /// is a move; a move that finds no free cell does nothing.
    pub fn act(&mut self, action: usize) -> Moved {
        let Some(direction) = action.checked_sub(1) else { return Moved::default() };
        let step = |from: usize| step(from, direction % 4, self.size[1]);
        let next = step(self.player);
        if direction < 4 && self.cells[next].is_box() {
            // There is a cell beyond: a box that a player can reach is not at the room's edge.
            let beyond = step(next);
            if self.cells[beyond].is_free() {
                self.open += u32::from(self.cells[next] == Cell::BoxOnTarget);
                self.open -= u32::from(self.cells[beyond] == Cell::Target);
                self.cells[beyond] = self.cells[beyond].with_box();
                self.cells[next] = self.cells[next].cleared();
                self.go(next);
                return Moved { player: true, pushed: true };
            }
        }
        let free = self.cells[next].is_free();
        if free {
            self.go(next);
        }
        Moved { player: free, pushed: false }
    }

    /// Cells, counted row by row, to which the player can walk without pushing a box, its own included.
    pub(super) fn walkable(&self) -> Vec<usize> {
        self.reachable(Cell::is_free)
    }

    /// Puts the player on another free cell.
    pub(super) fn go(&mut self, to: usize) {
        self.cells[self.player] = self.cells[self.player].cleared();
        self.cells[to] = self.cells[to].with_player();
        self.player = to;
    }

    /// Becomes a copy of the other, in the memory that it has.
    pub(super) fn copy(&mut self, other: &Self) {
        self.cells.clone_from(&other.cells);
        (self.size, self.player, self.boxes, self.open) = (other.size, other.player, other.boxes, other.open);
    }

    /// Cells, in ascending order, that lead from the player's to each other.
    fn reachable(&self, passes: impl Fn(Cell) -> bool) -> Vec<usize> {
        let mut seen = vec![false; self.cells.len()];
        let mut ahead = vec![self.player];
        seen[self.player] = true;
        while let Some(at) = ahead.pop() {
            if self.at_the_edge(at) {
                continue;
            }
            for next in (0..4).map(|direction| step(at, direction, self.size[1])) {
                if !seen[next] && passes(self.cells[next]) {
                    seen[next] = true;
                    ahead.push(next);
                }
            }
        }
        (0..seen.len()).filter(|&at| seen[at]).collect()
    }

    fn at_the_edge(&self, at: usize) -> bool {
        let ([row, column], [rows, columns]) = (self.place(at), self.size);
        row == 0 || column == 0 || row + 1 == rows || column + 1 == columns
    }

    fn place(&self, at: usize) -> [usize; 2] {
        [at / self.size[1], at % self.size[1]]
    }
}

/// The cell beside one that is not at the edge; directions are up, down, left, right.
pub(super) fn step(from: usize, direction: usize, columns: usize) -> usize {
    match direction {
        0 => from - columns,
        1 => from + columns,
        2 => from - 1,
        _ => from + 1,
    }
}
