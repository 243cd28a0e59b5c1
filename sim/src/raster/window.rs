//! Rectangles of pixels.

use std::ops::Range;

/// A rectangle of pixels: `[x, y]` of its first and one past its last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// First column and row.
    pub from: [u32; 2],
    /// Column and row after the last.
    pub to: [u32; 2],
}

impl Window {
    /// Of these columns and rows.
    pub fn of(columns: Range<u32>, rows: Range<u32>) -> Self {
        Self { from: [columns.start, rows.start], to: [columns.end, rows.end] }
    }

    /// Its columns.
    pub fn columns(&self) -> Range<u32> {
        self.from[0]..self.to[0]
    }

    /// Its rows.
    pub fn rows(&self) -> Range<u32> {
        self.from[1]..self.to[1]
    }
}
