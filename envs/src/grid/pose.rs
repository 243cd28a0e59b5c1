//! Where the agent is and where it looks.

/// A direction. The numbers are MiniGrid's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Direction {
    /// 0, to greater x.
    #[default]
    Right,
    /// 1, to greater y.
    Down,
    /// 2, to smaller x.
    Left,
    /// 3, to smaller y.
    Up,
}

impl Direction {
    /// All, in the order of their numbers: clockwise.
    pub const ALL: [Self; 4] = [Self::Right, Self::Down, Self::Left, Self::Up];

    /// The next clockwise.
    pub fn right(self) -> Self {
        Self::ALL[(self as usize + 1) % 4]
    }

    /// The next anticlockwise.
    pub fn left(self) -> Self {
        Self::ALL[(self as usize + 3) % 4]
    }

    /// The opposite.
    pub fn back(self) -> Self {
        Self::ALL[(self as usize + 2) % 4]
    }

    /// A step, x and y.
    pub fn vector(self) -> [i8; 2] {
        match self {
            Self::Right => [1, 0],
            Self::Down => [0, 1],
            Self::Left => [-1, 0],
            Self::Up => [0, -1],
        }
    }
}

/// Where the agent is and where it looks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Pose {
    /// Its cell, x and y.
    pub at: [u8; 2],
    /// Its direction.
    pub facing: Direction,
}

impl Pose {
    /// The cell before it. At an edge of the board it lies beyond, where there is wall.
    pub fn front(self) -> [u8; 2] {
        // No board has a column 255, so 0 - 1 is beyond the edge too.
        let [dx, dy] = self.facing.vector();
        [self.at[0].wrapping_add_signed(dx), self.at[1].wrapping_add_signed(dy)]
    }
}
