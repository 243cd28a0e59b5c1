//! A grid of equal tiles.

use super::{
    Colour, Format, Frame, Scaler,
    pieces::Pieces,
    tiles::{Changed, Tiles},
};

/// A grid of equal RGB tiles, shown through a [`Format`].
///
/// What a cell looks like is the number of a tile. [`Mosaic::show`] compares with what it showed last and draws only
/// cells that differ, so a step that changes two cells costs two cells. Results are those of drawing everything and
/// scaling it, to the bit.
///
/// Beside its picture and tiles it takes some 35 KiB, with which it remembers what scaled cells and their borders look
/// like. It is fast where pixels of many cells are made in the same way: 84 pixels of 7, 8, 10 or 16 cells, but not of
/// 19. With more than 4,096 tiles or 64 columns it remembers nothing.
#[derive(Clone, Debug)]
pub struct Mosaic {
    tiles: Tiles,
    scaler: Scaler,
    /// What the picture shows; nothing yet.
    shown: Option<Vec<u16>>,
    canvas: Frame,
    pieces: Option<Pieces>,
}

impl Mosaic {
    /// An empty mosaic of `cells` columns and rows of tiles with `side` pixels a side, through a format whose size was
    /// [checked](Format::check).
    ///
    /// # Panics
    /// When there are no cells, or none has a pixel.
    pub fn new(cells: [u32; 2], side: u32, format: Format) -> Self {
        assert!(cells.iter().all(|&cells| cells > 0), "a mosaic has cells, not {} by {}", cells[0], cells[1]);
        assert!(side > 0, "a tile of a mosaic has pixels");
        let scaler = Scaler::of_converted(cells.map(|cells| cells * side), format);
        // A mean is taken after scaling, so only where there is none can it be taken before.
        let convert = match format.colour {
            Colour::Luma => Some(Colour::Luma),
            Colour::Mean if scaler.copies() => Some(Colour::Mean),
            _ => None,
        };
        let canvas = Frame::new(scaler.size(), format.channels());
        let pieces = Pieces::new(&scaler, cells, side, canvas.channels());
        let tiles = Tiles::new(cells, side, convert);
        Self { tiles, scaler, shown: None, canvas, pieces }
    }

    /// Takes a tile, RGB rows from the top (`3 × side × side` bytes), and gives its number: 0, 1, 2 …
    ///
    /// # Panics
    /// When the tile has another size, or is the 65,537th.
    pub fn add(&mut self, tile: &[u8]) -> u16 {
        self.tiles.add(tile)
    }

    /// The picture in which cell `(x, y)` shows tile `looks[y × columns + x]`.
    ///
    /// # Panics
    /// When `looks` is not one number a cell, or there is no such tile.
    pub fn show(&mut self, looks: &[u16]) -> &Frame {
        if self.shown.as_deref() != Some(looks) {
            self.draw(looks);
        }
        &self.canvas
    }

    fn draw(&mut self, looks: &[u16]) {
        let Self { tiles, scaler, shown, canvas, pieces } = self;
        let [columns, rows] = tiles.cells().map(|cells| cells as usize);
        assert_eq!(looks.len(), columns * rows, "one tile a cell");
        let count = tiles.count();
        let greatest = looks.iter().copied().max().unwrap_or(0);
        assert!(usize::from(greatest) < count, "there are {count} tiles and no number {greatest}");

        let old = shown.get_or_insert_default();
        let changed = Changed { new: looks, old, columns };
        if scaler.copies() {
            tiles.copy_changed(changed, canvas);
        } else if let Some(pieces) = pieces {
            pieces.draw(changed, tiles, scaler, canvas);
        } else {
            tiles.scale_changed(changed, scaler, canvas);
        }
        old.clear();
        old.extend_from_slice(looks);
    }
}
