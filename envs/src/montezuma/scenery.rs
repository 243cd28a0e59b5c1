//! What of the screen never changes, as colours of the palette: made by the compiler, so that no copy has one of its own.

use super::screen::{Area, BELTS, HEIGHT, LADDERS, PLATFORMS, ROPE, WALLS, WIDTH};
use super::sprites::{BLACK, GREEN, YELLOW};

/// A picture in colours of the palette.
pub(super) type Picture = [[u8; WIDTH as usize]; HEIGHT as usize];

/// The screen without doors, key, skull, player and numbers.
pub(super) static SCENERY: Picture = scenery();

/// How something is filled: the pattern is a function of column and row, counted within it. The patterns are invented.
#[derive(Clone, Copy)]
enum Fill {
    Plain(u8),
    /// Rows of bricks.
    Bricks,
    /// Slanting stripes between two edges.
    Belt,
    /// Two rails, and a rung every fourth row.
    Ladder,
}

impl Fill {
    const fn colour(self, x: i32, y: i32, area: &Area) -> Option<u8> {
        match self {
            Self::Plain(colour) => Some(colour),
            Self::Bricks if y % 6 == 5 || (x + y / 6 % 2 * 4) % 8 == 7 => Some(BLACK),
            Self::Belt if y > 0 && y < area.height - 1 && (x + y) % 3 == 0 => Some(BLACK),
            Self::Bricks | Self::Belt => Some(GREEN),
            Self::Ladder if x < 2 || x >= area.width - 2 || y % 4 == 2 => Some(GREEN),
            Self::Ladder => None,
        }
    }
}

const fn fill(mut picture: Picture, area: Area, how: Fill) -> Picture {
    let mut y = area.y;
    while y < area.bottom() {
        let mut x = area.x;
        while x < area.right() {
            if let Some(colour) = how.colour(x - area.x, y - area.y, &area) {
                picture[y as usize][x as usize] = colour;
            }
            x += 1;
        }
        y += 1;
    }
    picture
}

const fn fill_all(mut picture: Picture, areas: &[Area], how: Fill) -> Picture {
    let mut number = 0;
    while number < areas.len() {
        picture = fill(picture, areas[number], how);
        number += 1;
    }
    picture
}

const fn scenery() -> Picture {
    let picture = [[BLACK; WIDTH as usize]; HEIGHT as usize];
    let picture = fill_all(picture, &WALLS, Fill::Bricks);
    let picture = fill_all(picture, &PLATFORMS, Fill::Plain(GREEN));
    let picture = fill_all(picture, &BELTS, Fill::Belt);
    let ladders = [LADDERS[0].area, LADDERS[1].area, LADDERS[2].area];
    let picture = fill_all(picture, &ladders, Fill::Ladder);
    fill(picture, ROPE, Fill::Plain(YELLOW))
}
