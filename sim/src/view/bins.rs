//! What may be seen where: a coarse grid over a frame, with the things that touch each of its cells.

use super::lens::Extent;

/// For every cell of a grid, the numbers of the things in it, in increasing order.
#[derive(Clone, Debug)]
pub(super) struct Bins {
    /// Cells per pixel.
    fineness: f32,
    columns: usize,
    rows: usize,
    /// Where in `things` each cell begins; one more than cells.
    starts: Vec<u32>,
    things: Vec<u32>,
}

impl Bins {
    /// For a frame of that width and height, in square cells of that side, all in pixels. Thing i is in cells
    /// that touch `extents[i]` and whose middle pleases `touches`.
    pub(super) fn new(
        [width, height]: [f32; 2],
        side: f32,
        extents: &[Extent],
        touches: impl Fn(usize, [f32; 2]) -> bool,
    ) -> Self {
        let count = |length: f32| (length / side) as usize + 1;
        let (columns, rows) = (count(width), count(height));
        let fineness = 1.0 / side;
        let middle = |index: usize| (index as f32 + 0.5) * side;
        let mut pairs = Vec::new();
        let mut starts = vec![0_u32; columns * rows + 1];
        for (thing, extent) in extents.iter().enumerate() {
            for row in cells(extent[1], extent[3], fineness, rows) {
                for column in cells(extent[0], extent[2], fineness, columns) {
                    if touches(thing, [middle(column), middle(row)]) {
                        let cell = row * columns + column;
                        pairs.push((cell, thing as u32));
                        starts[cell + 1] += 1;
                    }
                }
            }
        }
        for cell in 1..starts.len() {
            starts[cell] += starts[cell - 1];
        }
        let mut things = vec![0; pairs.len()];
        let mut ends = starts.clone();
        for (cell, thing) in pairs {
            things[ends[cell] as usize] = thing;
            ends[cell] += 1;
        }
        Self { fineness, columns, rows, starts, things }
    }

    /// What may be seen at a place; nothing outside the frame.
    pub(super) fn at(&self, x: f32, y: f32) -> &[u32] {
        let (column, row) = (x * self.fineness, y * self.fineness);
        let inside = column >= 0.0 && row >= 0.0 && column < self.columns as f32 && row < self.rows as f32;
        if !inside {
            return &[];
        }
        // Through i32, which processors convert in one step.
        let cell = row as i32 as usize * self.columns + column as i32 as usize;
        &self.things[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }
}

/// The columns, or rows, that an extent touches when it is grown by a pixel.
fn cells(least: f32, most: f32, fineness: f32, count: usize) -> std::ops::Range<usize> {
    // Casts saturate, so that extents of any size clamp to the grid; an empty one gives no cells.
    let first = ((least - 1.0) * fineness) as usize;
    let end = (most + 1.0) * fineness;
    first..if end >= 0.0 { (end as usize).saturating_add(1).min(count) } else { 0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn things_are_found_where_they_are_and_only_thereabouts() {
        let everywhere = [f32::NEG_INFINITY, f32::NEG_INFINITY, f32::INFINITY, f32::INFINITY];
        let nowhere = [f32::INFINITY, f32::INFINITY, f32::NEG_INFINITY, f32::NEG_INFINITY];
        let bins =
            Bins::new([100.0, 50.0], 10.0, &[[12.0, 12.0, 18.0, 28.0], everywhere, nowhere], |_, _| true);
        assert_eq!(bins.at(15.0, 15.0), [0, 1]);
        assert_eq!(bins.at(15.0, 25.0), [0, 1]);
        assert_eq!(bins.at(25.0, 15.0), [1]);
        assert_eq!(bins.at(15.0, 5.0), [1]);
        assert_eq!(bins.at(99.9, 49.9), [1]);
        assert_eq!(bins.at(-0.1, 5.0), [] as [u32; 0]);
        assert_eq!(bins.at(5.0, 70.0), [] as [u32; 0]);
        assert_eq!(bins.at(f32::NAN, 5.0), [] as [u32; 0]);
    }

    #[test]
    fn cells_may_decline() {
        let bins = Bins::new([20.0, 20.0], 10.0, &[[0.0, 0.0, 20.0, 20.0]], |_, [x, y]| x == y);
        assert_eq!((bins.at(5.0, 5.0), bins.at(15.0, 15.0)), (&[0][..], &[0][..]));
        assert!(bins.at(5.0, 15.0).is_empty() && bins.at(15.0, 5.0).is_empty());
    }
}
