//! How rooms look: sprites of our own in the colours of gym-sokoban's, or its flat colours.

use inroads_sim::raster::{Format, Frame, Mosaic};

use super::{Cell, Sokoban};
use crate::world::Painter;

/// How cells are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// Sprites of 16 × 16 pixels. Those of gym-sokoban are not ours to copy: these have its colours and mean the same.
    Sprites,
    /// One colour a cell, so many pixels a side, to the bit gym-sokoban's "tiny world": 1 to 40, or the
    /// nearest to that.
    Flat(u32),
}

impl Look {
    /// Pixels a side of a cell.
    pub fn side(self) -> u32 {
        match self {
            Self::Sprites => SPRITE,
            Self::Flat(side) => side.clamp(1, MOST_FLAT),
        }
    }

    fn colour(self, cell: Cell, at: [u32; 2]) -> [u8; 3] {
        match self {
            Self::Sprites => sprite(cell, at),
            Self::Flat(_) => flat(cell),
        }
    }
}

/// Draws rooms.
#[derive(Clone, Debug)]
pub struct SokobanPainter {
    mosaic: Mosaic,
    shape: ([u32; 2], u32),
    looks: Vec<u16>,
}

impl SokobanPainter {
    pub(super) fn new([rows, columns]: [usize; 2], look: Look, format: Format) -> Self {
        let (cells, side) = ([columns as u32, rows as u32], look.side());
        let mut mosaic = Mosaic::new(cells, side, format);
        for cell in Cell::ALL {
            let pixel = |at: u32| look.colour(cell, [at % side, at / side]);
            let tile: Vec<u8> = (0..side * side).flat_map(pixel).collect();
            mosaic.add(&tile);
        }
        let shape = (format.size(cells.map(|cells| cells * side)), format.channels());
        Self { mosaic, shape, looks: Vec::new() }
    }
}

impl Painter<Sokoban> for SokobanPainter {
    fn shape(&self) -> ([u32; 2], u32) {
        self.shape
    }

    fn paint(&mut self, world: &Sokoban, out: &mut Frame) {
        self.looks.clear();
        self.looks.extend(world.room().cells().iter().map(|&cell| cell as u16));
        out.copy(self.mosaic.show(&self.looks));
    }
}

/// Pixels a side of a sprite (gym-sokoban).
const SPRITE: u32 = 16;

/// Most pixels a side of a flat cell: as many as fit 100 cells into 4096 pixels.
const MOST_FLAT: u32 = 40;

/// gym-sokoban's colours of its tiny world.
fn flat(cell: Cell) -> [u8; 3] {
    match cell {
        Cell::Wall => [0, 0, 0],
        Cell::Floor => [243, 248, 238],
        Cell::Target => [254, 126, 125],
        Cell::BoxOnTarget => [254, 95, 56],
        Cell::Box => [142, 121, 56],
        Cell::Player => [160, 212, 56],
        Cell::PlayerOnTarget => [219, 212, 56],
    }
}

// The dominant colours of gym-sokoban's sprites.
const BLACK: [u8; 3] = [0, 0, 0];
const BRICK: [u8; 3] = [176, 61, 0];
const MORTAR: [u8; 3] = [176, 154, 142];
const RED: [u8; 3] = [239, 22, 22];
const YELLOW: [u8; 3] = [215, 196, 0];
const ORANGE: [u8; 3] = [215, 114, 0];
const HOME: [u8; 3] = [238, 0, 0];
const GREEN: [u8; 3] = [41, 202, 26];

/// The pixel of a sprite, from its top left corner.
fn sprite(cell: Cell, at: [u32; 2]) -> [u8; 3] {
    match cell {
        Cell::Wall => bricks(at),
        Cell::Floor => BLACK,
        Cell::Target => ring(at),
        Cell::Box => crate_of(at, ORANGE),
        Cell::BoxOnTarget => crate_of(at, HOME),
        Cell::Player => figure(at).unwrap_or(BLACK),
        Cell::PlayerOnTarget => figure(at).unwrap_or_else(|| ring(at)),
    }
}

/// Courses of four pixels, every other one shifted by half a brick, with mortar on two sides of each brick.
fn bricks([x, y]: [u32; 2]) -> [u8; 3] {
    let shift = if y / 4 % 2 == 0 { 0 } else { 4 };
    if y % 4 == 3 || (x + shift) % 8 == 7 { MORTAR } else { BRICK }
}

/// How far a pixel is from the nearest edge of its sprite.
fn inward([x, y]: [u32; 2]) -> u32 {
    x.min(y).min(SPRITE - 1 - x).min(SPRITE - 1 - y)
}

/// A red border, two pixels wide.
fn ring(at: [u32; 2]) -> [u8; 3] {
    if (1..3).contains(&inward(at)) { RED } else { BLACK }
}

/// Planks in a frame, with one across.
fn crate_of([x, y]: [u32; 2], frame: [u8; 3]) -> [u8; 3] {
    match inward([x, y]) {
        0 => BLACK,
        1 | 2 => frame,
        _ if x.abs_diff(y) < 2 => frame,
        _ if x % 4 == 3 => BLACK,
        _ => YELLOW,
    }
}

/// Head, arms, body and two legs.
fn figure([x, y]: [u32; 2]) -> Option<[u8; 3]> {
    // Mirrored about the middle: 0 beside it, 7 at the edge.
    let aside = if x < SPRITE / 2 { SPRITE / 2 - 1 - x } else { x - SPRITE / 2 };
    let part = match y {
        2 | 5 => aside < 2,
        3 | 4 => aside < 3,
        7 => aside < 5,
        8 | 9 => aside < 2 || aside == 4,
        6 | 10 => aside < 2,
        11..=13 => aside == 1 || aside == 2 && y == 13,
        _ => false,
    };
    part.then_some(GREEN)
}
