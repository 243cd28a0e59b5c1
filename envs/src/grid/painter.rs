//! Draws a board: a tile a cell.

use inroads_sim::raster::{Format, Mosaic};

use super::{Cell, Direction, GridWorld, cell::number, tiles::tile};
use crate::{Frame, world::Painter};

/// Looks of a cell without an agent, not seen: nine objects, of which doors have two states more, in six colours.
const BARE: u16 = 11 * 6;
/// Looks of a cell: with no agent or one in each direction, not seen or seen.
const LOOKS: usize = 2 * 5 * BARE as usize;
/// A look whose tile nobody has drawn yet.
const UNDRAWN: u16 = u16::MAX;

/// Draws boards of one size. It draws the tile of a look when it first meets it.
#[derive(Clone, Debug)]
pub struct GridPainter {
    side: u32,
    highlight: bool,
    native: [u32; 2],
    format: Format,
    mosaic: Mosaic,
    /// The number of each look's tile.
    tiles: Vec<u16>,
    /// Each cell's look, then each cell's tile, row by row.
    shown: Vec<u16>,
}

impl GridPainter {
    /// For boards of so many columns and rows: `side` pixels a cell, `highlight` makes the cells that the agent sees
    /// lighter, and the format was checked. It panics when it is to paint a board of another size.
    pub fn new(size: [u8; 2], side: u32, highlight: bool, format: Format) -> Self {
        let cells = size.map(u32::from);
        Self {
            side,
            highlight,
            native: cells.map(|c| c * side),
            format,
            mosaic: Mosaic::new(cells, side, format),
            tiles: vec![UNDRAWN; LOOKS],
            shown: vec![0; (cells[0] * cells[1]) as usize],
        }
    }
}

/// The look of a cell's encoding. Boxes look alike whatever is in them.
fn look([object, colour, state]: [u8; 3]) -> u16 {
    let kind = match (object, state) {
        (number::DOOR, 1..) => 8 + state,
        _ => object - 1,
    };
    6 * u16::from(kind) + u16::from(colour)
}

/// The tile of a look.
fn draw(look: u16, side: u32) -> Vec<u8> {
    let (kind, colour) = ((look % BARE / 6) as u8, (look % 6) as u8);
    let more = look / BARE;
    let bytes = match kind {
        9.. => [number::DOOR, colour, kind - 8],
        _ => [kind + 1, colour, 0],
    };
    let cell = Cell::decode(bytes).expect("looks are made of cells");
    let agent = (more % 5).checked_sub(1).map(|facing| Direction::ALL[usize::from(facing)]);
    tile(cell, agent, more >= 5, side)
}

impl Painter<GridWorld> for GridPainter {
    fn shape(&self) -> ([u32; 2], u32) {
        (self.format.size(self.native), self.format.channels())
    }

    fn paint(&mut self, world: &GridWorld, out: &mut Frame) {
        let state = world.state();
        let size = state.board.size();
        let native = size.map(|cells| u32::from(cells) * self.side);
        assert_eq!(native, self.native, "a painter paints boards of one size");
        let [width, height] = size.map(usize::from);
        for (x, column) in state.board.triples().chunks_exact(height).enumerate() {
            for (y, &cell) in column.iter().enumerate() {
                self.shown[y * width + x] = look(cell);
            }
        }
        let index = |[x, y]: [u8; 2]| usize::from(y) * width + usize::from(x);
        self.shown[index(state.pose.at)] += (1 + state.pose.facing as u16) * BARE;
        if self.highlight {
            world.view().cells().for_each(|at| self.shown[index(at)] += 5 * BARE);
        }
        for shown in &mut self.shown {
            let tile = &mut self.tiles[usize::from(*shown)];
            if *tile == UNDRAWN {
                *tile = self.mosaic.add(&draw(*shown, self.side));
            }
            *shown = *tile;
        }
        out.copy(self.mosaic.show(&self.shown));
    }
}
