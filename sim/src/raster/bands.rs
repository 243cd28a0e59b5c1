//! Which cells of a mosaic which pixels of its scaled picture depend on.

use std::ops::Range;

use super::Scaler;

/// Neighbouring columns (or rows) of a scaled picture that depend on one cell, and perhaps on the one before.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Band {
    pub(super) cell: u32,
    /// Whether some depend on the cell before, too.
    pub(super) before: bool,
    pub(super) pixels: Range<u32>,
    /// The native pixels that they depend on.
    pub(super) native: Range<u32>,
    /// Bands of the same number, never 0, are made in the same way, only of other cells.
    pub(super) phase: u8,
}

/// The bands of an axis in order: two a cell (`split`), of which only the first may depend on the cell before, or one.
/// `None` when a pixel depends on more than two cells, a cell has no pixel for itself, or bands are too many.
pub(super) fn bands(scaler: &Scaler, axis: usize, side: u32, split: bool) -> Option<Vec<Band>> {
    let mut bands: Vec<Band> = Vec::new();
    for pixel in 0..scaler.size()[axis] {
        let native = scaler.reach(axis, pixel);
        let [first, cell] = [native.start / side, (native.end - 1) / side];
        if first + 1 < cell {
            return None;
        }
        let before = first < cell;
        if cell > bands.last().map_or(0, |band| band.cell + 1) {
            return None;
        }
        match bands.last_mut() {
            Some(band) if band.cell == cell && (!split || band.before == before) => {
                band.pixels.end = pixel + 1;
                band.native.end = native.end;
            }
            _ => bands.push(Band { cell, before, pixels: pixel..pixel + 1, native, phase: 0 }),
        }
    }
    for index in 0..bands.len() {
        let (known, rest) = bands.split_at_mut(index);
        let other = known.iter().find(|known| alike(scaler, axis, side, known, &rest[0]));
        rest[0].phase = match other {
            Some(other) => other.phase,
            None => u8::try_from(index + 1).ok()?,
        };
    }
    Some(bands)
}

/// Whether two bands, the second further on, are made in the same way.
fn alike(scaler: &Scaler, axis: usize, side: u32, a: &Band, b: &Band) -> bool {
    let mut pixels = a.pixels.clone().zip(b.pixels.clone());
    (a.before, a.pixels.len()) == (b.before, b.pixels.len())
        && pixels.all(|(x, y)| scaler.alike(axis, [x, y], (b.cell - a.cell) * side))
}
