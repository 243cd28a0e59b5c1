//! What the cells of a mosaic may look like.

use std::ops::Range;

use super::{
    Colour, Frame, Scaler, Window,
    blit::{blit, unpack},
    colour,
};

/// Tiles for which memory is asked at once.
const GROWTH: usize = 8;

/// Tiles of one size, by number.
#[derive(Clone, Debug)]
pub(super) struct Tiles {
    /// Columns and rows of the mosaic.
    cells: [u32; 2],
    /// Pixels along a tile's side.
    side: u32,
    /// The grey that tiles become right away; `None`: they stay RGB.
    convert: Option<Colour>,
    channels: usize,
    bytes: Vec<u8>,
}

/// What a mosaic is to show, and what it shows: nothing at first.
#[derive(Clone, Copy)]
pub(super) struct Changed<'a> {
    pub(super) new: &'a [u16],
    pub(super) old: &'a [u16],
    pub(super) columns: usize,
}

impl Changed<'_> {
    /// Whether a cell is to look different.
    fn cell(&self, cell: usize) -> bool {
        self.old.get(cell) != Some(&self.new[cell])
    }

    /// Which of a row's at most 64 cells are to look different, a bit each.
    pub(super) fn row(&self, row: usize) -> u64 {
        let cells = row * self.columns..(row + 1) * self.columns;
        let new = &self.new[cells.clone()];
        match self.old.get(cells) {
            Some(old) if old == new => 0,
            Some(old) => (0..).zip(old.iter().zip(new)).map(|(bit, (a, b))| u64::from(a != b) << bit).sum(),
            None => u64::MAX >> (64 - self.columns),
        }
    }
}

impl Tiles {
    pub(super) fn new(cells: [u32; 2], side: u32, convert: Option<Colour>) -> Self {
        let channels = if convert.is_some() { 1 } else { 3 };
        Self { cells, side, convert, channels, bytes: Vec::new() }
    }

    pub(super) fn cells(&self) -> [u32; 2] {
        self.cells
    }

    pub(super) fn count(&self) -> usize {
        self.bytes.len() / self.channels / (self.side * self.side) as usize
    }

    pub(super) fn add(&mut self, tile: &[u8]) -> u16 {
        let pixels = (self.side * self.side) as usize;
        assert_eq!(tile.len(), 3 * pixels, "a tile has {0} by {0} pixels", self.side);
        let number = u16::try_from(self.count()).expect("a mosaic has at most 65,536 tiles");
        let start = self.bytes.len();
        // By a few tiles at a time, not twofold: there are few, and memory is for pieces made of them.
        if self.bytes.capacity() < start + pixels * self.channels {
            self.bytes.reserve_exact(GROWTH * pixels * self.channels);
        }
        if let Some(colour) = self.convert {
            self.bytes.resize(start + pixels, 0);
            colour::grey(colour, tile, &mut self.bytes[start..]);
        } else {
            self.bytes.extend_from_slice(tile);
        }
        number
    }

    /// The bytes of a tile from row `y` on.
    fn tile(&self, look: u16, y: u32) -> &[u8] {
        &self.bytes
            [(usize::from(look) * self.side as usize + y as usize) * self.side as usize * self.channels..]
    }

    /// Writes columns of a row of the picture, as large as it is drawn.
    fn row(&self, looks: &[u16], y: u32, columns: Range<u32>, mut pixels: &mut [u8]) {
        let row = (y / self.side * self.cells[0]) as usize;
        let mut x = columns.start;
        while x < columns.end {
            let (cell, within) = (x / self.side, x % self.side);
            let count = (self.side - within).min(columns.end - x);
            let tile =
                &self.tile(looks[row + cell as usize], y % self.side)[within as usize * self.channels..];
            let (now, later) = pixels.split_at_mut(count as usize * self.channels);
            now.copy_from_slice(&tile[..now.len()]);
            (pixels, x) = (later, x + count);
        }
    }

    /// Scales a window of the picture.
    fn scale(&self, looks: &[u16], scaler: &Scaler, window: Window, canvas: &mut Frame) {
        scaler.part(window, |y, columns, pixels| self.row(looks, y, columns, pixels), canvas);
    }

    /// Writes a native window that cell `x, y` and its neighbours to the left and above cover.
    pub(super) fn gather(&self, looks: &[u16], [x, y]: [u32; 2], native: Window, pixels: &mut Vec<u8>) {
        let channels = self.channels;
        let width = native.columns().len() * channels;
        let length = width * native.rows().len();
        if pixels.len() < length {
            pixels.resize(length, 0);
        }
        // Before the cell's first pixel, and from there on.
        let halves = |cell: u32, all: Range<u32>| {
            let border = cell * self.side;
            [(cell.wrapping_sub(1), all.start..all.end.min(border)), (cell, all.start.max(border)..all.end)]
        };
        for (y, rows) in halves(y, native.rows()) {
            for (x, columns) in halves(x, native.columns()) {
                if rows.is_empty() || columns.is_empty() {
                    continue;
                }
                let look = looks[(y * self.cells[0] + x) as usize];
                let from = &self.tile(look, rows.start - y * self.side);
                let from = &from[(columns.start - x * self.side) as usize * channels..];
                let to = (rows.start - native.from[1]) as usize * width;
                let to = &mut pixels[to + (columns.start - native.from[0]) as usize * channels..];
                blit(columns.len() * channels, rows.len(), [self.side as usize * channels, width], from, to);
            }
        }
    }

    /// Draws changed cells, as large as they are.
    pub(super) fn copy_changed(&self, changed: Changed<'_>, canvas: &mut Frame) {
        let [columns, side] = [self.cells[0], self.side].map(|number| number as usize);
        let width = side * self.channels;
        let stride = columns * width;
        for cell in (0..changed.new.len()).filter(|&cell| changed.cell(cell)) {
            let to = &mut canvas.bytes_mut()[cell / columns * side * stride + cell % columns * width..];
            unpack(width, side, self.tile(changed.new[cell], 0), stride, to);
        }
    }

    /// Scales what changed cells have a say in, a row of cells at a time.
    pub(super) fn scale_changed(&self, changed: Changed<'_>, scaler: &Scaler, canvas: &mut Frame) {
        for row in 0..self.cells[1] {
            let cell = |column: &u32| changed.cell((row * self.cells[0] + column) as usize);
            let columns = 0..self.cells[0];
            if let (Some(first), Some(last)) = (columns.clone().find(cell), columns.rev().find(cell)) {
                let native = Window { from: [first, row], to: [last + 1, row + 1] };
                let [from, to] = [native.from, native.to].map(|corner| corner.map(|cell| cell * self.side));
                self.scale(changed.new, scaler, scaler.touches(Window { from, to }), canvas);
            }
        }
    }
}
