//! What can stand in a cell, and the three bytes that MiniGrid writes for it.

/// A colour. The numbers are MiniGrid's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Colour {
    /// 0; lava is red, and so is the agent.
    Red,
    /// 1; goals are green unless somebody wants otherwise.
    Green,
    /// 2.
    Blue,
    /// 3.
    Purple,
    /// 4.
    Yellow,
    /// 5; walls are grey unless somebody wants otherwise.
    Grey,
}

impl Colour {
    /// All, in the order of their numbers.
    pub const ALL: [Self; 6] = [Self::Red, Self::Green, Self::Blue, Self::Purple, Self::Yellow, Self::Grey];

    /// Red, green and blue, 0 to 255 (MiniGrid's `COLORS`).
    pub fn rgb(self) -> [u8; 3] {
        match self {
            Self::Red => [255, 0, 0],
            Self::Green => [0, 255, 0],
            Self::Blue => [0, 0, 255],
            Self::Purple => [112, 39, 195],
            Self::Yellow => [255, 255, 0],
            Self::Grey => [100, 100, 100],
        }
    }

    /// Its name, as missions have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Red => "red",
            Self::Green => "green",
            Self::Blue => "blue",
            Self::Purple => "purple",
            Self::Yellow => "yellow",
            Self::Grey => "grey",
        }
    }

    fn decode(number: u8) -> Option<Self> {
        Self::ALL.get(usize::from(number)).copied()
    }
}

/// How a door is. The numbers are MiniGrid's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Door {
    /// 0: one can see and walk through.
    Open,
    /// 1: whoever toggles it opens it.
    Closed,
    /// 2: only who carries a key of its colour can open it, for good.
    Locked,
}

/// What comes out of a box when it is toggled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Inside {
    /// The box is gone, that is all.
    Nothing,
    /// A key.
    Key(Colour),
    /// A ball.
    Ball(Colour),
}

/// What stands in a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Cell {
    /// Nothing.
    Empty,
    /// In the way of feet and eyes.
    Wall(Colour),
    /// Coloured ground, which nothing can be put on.
    Floor(Colour),
    /// A door.
    Door(Colour, Door),
    /// Can be carried; opens doors of its colour.
    Key(Colour),
    /// Can be carried.
    Ball(Colour),
    /// Can be carried; holds something.
    Box(Colour, Inside),
    /// Whoever steps on it has succeeded.
    Goal(Colour),
    /// Whoever steps into it has failed. Always red.
    Lava,
}

/// The numbers of MiniGrid's objects; 0 is what its agents do not see, which full grids never have.
pub(super) mod number {
    pub(in super::super) const EMPTY: u8 = 1;
    pub(in super::super) const WALL: u8 = 2;
    pub(in super::super) const FLOOR: u8 = 3;
    pub(in super::super) const DOOR: u8 = 4;
    pub(in super::super) const KEY: u8 = 5;
    pub(in super::super) const BALL: u8 = 6;
    pub(in super::super) const BOX: u8 = 7;
    pub(in super::super) const GOAL: u8 = 8;
    pub(in super::super) const LAVA: u8 = 9;
    pub(in super::super) const AGENT: u8 = 10;
}

impl Cell {
    /// Object, colour and state, as MiniGrid's `encode` writes them, with one exception: the state of a box tells what
    /// is inside (0 nothing, 1 to 6 a key, 7 to 12 a ball, by colour), where MiniGrid hides it and writes 0.
    pub fn encode(self) -> [u8; 3] {
        use number::{BALL, BOX, DOOR, EMPTY, FLOOR, GOAL, KEY, LAVA, WALL};
        match self {
            Self::Empty => [EMPTY, 0, 0],
            Self::Wall(colour) => [WALL, colour as u8, 0],
            Self::Floor(colour) => [FLOOR, colour as u8, 0],
            Self::Door(colour, door) => [DOOR, colour as u8, door as u8],
            Self::Key(colour) => [KEY, colour as u8, 0],
            Self::Ball(colour) => [BALL, colour as u8, 0],
            Self::Box(colour, Inside::Nothing) => [BOX, colour as u8, 0],
            Self::Box(colour, Inside::Key(inner)) => [BOX, colour as u8, 1 + inner as u8],
            Self::Box(colour, Inside::Ball(inner)) => [BOX, colour as u8, 7 + inner as u8],
            Self::Goal(colour) => [GOAL, colour as u8, 0],
            Self::Lava => [LAVA, Colour::Red as u8, 0],
        }
    }

    /// What three bytes mean; `None` when nothing has them.
    pub fn decode([object, colour, state]: [u8; 3]) -> Option<Self> {
        use number::{BALL, BOX, DOOR, EMPTY, FLOOR, GOAL, KEY, LAVA, WALL};
        let paint = Colour::decode(colour)?;
        Some(match (object, state) {
            (EMPTY, 0) if colour == 0 => Self::Empty,
            (WALL, 0) => Self::Wall(paint),
            (FLOOR, 0) => Self::Floor(paint),
            (DOOR, 0) => Self::Door(paint, Door::Open),
            (DOOR, 1) => Self::Door(paint, Door::Closed),
            (DOOR, 2) => Self::Door(paint, Door::Locked),
            (KEY, 0) => Self::Key(paint),
            (BALL, 0) => Self::Ball(paint),
            (BOX, 0) => Self::Box(paint, Inside::Nothing),
            (BOX, 1..=6) => Self::Box(paint, Inside::Key(Colour::decode(state - 1)?)),
            (BOX, 7..=12) => Self::Box(paint, Inside::Ball(Colour::decode(state - 7)?)),
            (GOAL, 0) => Self::Goal(paint),
            (LAVA, 0) if paint == Colour::Red => Self::Lava,
            _ => return None,
        })
    }

    /// Whether one can stand there.
    pub fn walkable(self) -> bool {
        matches!(self, Self::Empty | Self::Floor(_) | Self::Goal(_) | Self::Lava | Self::Door(_, Door::Open))
    }

    /// Whether one can pick it up.
    pub fn portable(self) -> bool {
        matches!(self, Self::Key(_) | Self::Ball(_) | Self::Box(..))
    }

    /// Whether one sees what is behind it.
    pub fn clear(self) -> bool {
        !matches!(self, Self::Wall(_) | Self::Door(_, Door::Closed | Door::Locked))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_bytes_mean_at_most_one_cell_and_every_cell_has_some() {
        let mut meant = 0;
        for object in 0..=11 {
            for colour in 0..=6 {
                for state in 0..=13 {
                    let bytes = [object, colour, state];
                    if let Some(cell) = Cell::decode(bytes) {
                        assert_eq!(cell.encode(), bytes);
                        meant += 1;
                    }
                }
            }
        }
        // Wall, floor, key, ball and goal in six colours; doors in three states, boxes with thirteen contents; empty, lava.
        assert_eq!(meant, 5 * 6 + 3 * 6 + 13 * 6 + 2);
    }
}
