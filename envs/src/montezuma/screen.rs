//! Where everything is on the screen, as data.
//!
//! Boxes are `x, y, width, height` in pixels from the top left, y downwards: OC_Atari's annotations of the real game, by
//! hand (k4ntz/OC_Atari). What is not theirs says so.

/// Pixels a row.
pub const WIDTH: u32 = 160;
/// Rows.
pub const HEIGHT: u32 = 210;

/// A rectangle of whole pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Area {
    /// First column.
    pub x: i32,
    /// First row.
    pub y: i32,
    /// Columns.
    pub width: i32,
    /// Rows.
    pub height: i32,
}

impl Area {
    /// From x, y, width and height.
    pub const fn new(x: i32, y: i32, width: i32, height: i32) -> Self {
        Self { x, y, width, height }
    }

    /// The column after the last.
    pub const fn right(&self) -> i32 {
        self.x + self.width
    }

    /// The row after the last.
    pub const fn bottom(&self) -> i32 {
        self.y + self.height
    }

    /// Whether a pixel is in both.
    pub const fn meets(&self, other: &Self) -> bool {
        self.x < other.right() && other.x < self.right() && self.y < other.bottom() && other.y < self.bottom()
    }

    /// The smallest that holds both.
    pub fn with(&self, other: &Self) -> Self {
        let (x, y) = (self.x.min(other.x), self.y.min(other.y));
        Self::new(x, y, self.right().max(other.right()) - x, self.bottom().max(other.bottom()) - y)
    }
}

/// Platforms: three above, three in the middle (the second is the foot of the ladder), and the floor.
pub const PLATFORMS: [Area; 7] = [
    Area::new(0, 93, 56, 2),
    Area::new(68, 93, 23, 2),
    Area::new(104, 93, 56, 2),
    Area::new(8, 136, 28, 2),
    Area::new(76, 136, 8, 5),
    Area::new(124, 136, 28, 2),
    Area::new(16, 180, 128, 1),
];

/// The conveyor belts at either side of the ladder's foot.
pub const BELTS: [Area; 2] = [Area::new(60, 136, 15, 5), Area::new(85, 136, 15, 5)];

/// Walls: two above, two below.
pub const WALLS: [Area; 4] = [
    Area::new(0, 96, 8, 40),
    Area::new(152, 96, 8, 40),
    Area::new(0, 136, 16, 45),
    Area::new(144, 136, 16, 45),
];

/// The doors, left and right.
pub const DOORS: [Area; 2] = [Area::new(20, 54, 4, 37), Area::new(136, 54, 4, 37)];

/// The rope.
pub const ROPE: Area = Area::new(112, 96, 1, 39);

/// The key while it hangs: 7 × 15 about (16, 106).
pub const KEY: Area = Area::new(13, 99, 7, 15);

/// A ladder: its box, and where the feet of somebody at its ends are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ladder {
    /// Its box.
    pub area: Area,
    /// The feet at its top: the row of the platform that it leads to.
    pub top: i32,
    /// The feet at its foot.
    pub foot: i32,
}

impl Ladder {
    /// Its middle, as a column's left edge.
    pub const fn middle(&self) -> i32 {
        self.area.x + self.area.width / 2
    }
}

/// The ladders: middle, bottom left, bottom right.
pub const LADDERS: [Ladder; 3] = [
    Ladder { area: Area::new(72, 93, 16, 42), top: 93, foot: 136 },
    Ladder { area: Area::new(16, 136, 16, 45), top: 136, foot: 180 },
    Ladder { area: Area::new(128, 136, 16, 45), top: 136, foot: 180 },
];

/// What one can stand on: a stretch of columns, its row, how thick it is, and which belt it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Surface {
    /// From this column's left edge …
    pub from: i32,
    /// … to this one's. Who has the middle of the soles in between stands.
    pub to: i32,
    /// Its first row: where the soles are.
    pub y: i32,
    /// Rows.
    pub thick: i32,
    /// The number of the belt that it is.
    pub belt: Option<usize>,
}

const fn platform(number: usize) -> Surface {
    let Area { x, y, width, height } = PLATFORMS[number];
    Surface { from: x, to: x + width, y, thick: height, belt: None }
}

/// All that one can stand on. Between each belt and the ladder's foot the annotations leave a pixel free; no sole fits in
/// there, so it belongs to the belt.
pub const SURFACES: [Surface; 9] = [
    platform(0),
    platform(1),
    platform(2),
    platform(3),
    platform(4),
    platform(5),
    platform(6),
    Surface { from: 60, to: 76, y: 136, thick: 5, belt: Some(0) },
    Surface { from: 84, to: 100, y: 136, thick: 5, belt: Some(1) },
];

/// Width and height of the player.
pub const PLAYER: [i32; 2] = [8, 20];

/// Top left of the player where a life begins: on the middle of the upper platforms.
pub const ENTRY: [i32; 2] = [76, 73];

/// Width and height of the skull.
pub const SKULL: [i32; 2] = [7, 13];

/// The skull's first row.
pub const SKULL_Y: i32 = 166;

/// The columns between which the skull rolls: of its left edge, read off recordings.
pub const SKULL_RANGE: [i32; 2] = [52, 112];

/// Where the skull is at first: the annotations have its middle at 93.
pub const SKULL_START: i32 = 90;

/// What the game's memory would say of a player whose top left is here: x in byte 0xAA and y in 0xAB, y upwards.
pub const fn to_ram([left, top]: [i32; 2]) -> [i32; 2] {
    [left + 1, 308 - top]
}

/// Top left of the player of whom the game's memory says this.
pub const fn from_ram([x, y]: [i32; 2]) -> [i32; 2] {
    [x - 1, 308 - y]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_and_screen_agree_on_the_start_and_the_levels() {
        assert_eq!(to_ram(ENTRY), [77, 235]);
        assert_eq!(from_ram([77, 235]), ENTRY);
        for (y, feet) in [(235, 93), (192, 136), (148, 180)] {
            assert_eq!(from_ram([0, y])[1] + PLAYER[1], feet);
            assert!(SURFACES.iter().any(|surface| surface.y == feet));
        }
    }

    #[test]
    fn ladders_lead_from_surface_to_surface() {
        for ladder in LADDERS {
            for feet in [ladder.top, ladder.foot] {
                let on = |s: &Surface| s.y == feet && (s.from..=s.to).contains(&ladder.middle());
                assert!(SURFACES.iter().any(on), "{ladder:?}");
            }
        }
    }
}
