//! A region of the map as a grid of yes and no.

use tiny_skia::PremultipliedColorU8;

use super::canvas::Canvas;
use super::map::{Map, Rect, View};
use super::maze;
use super::palette::Colour;

/// Over which pixels around it the value of a pixel is averaged.
const REACH: [f32; 4] = [-1.5, -0.5, 0.5, 1.5];

/// How much darker the rim of a region is.
const RIM: f32 = 0.45;

/// The same of a rim alone.
const OUTLINE: f32 = 0.9;

/// Yes or no at `nx` × `ny` evenly spaced points of a map's bounds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Raster {
    /// Columns.
    pub nx: usize,
    /// Rows.
    pub ny: usize,
    /// Row by row from the *lowest* y, each row from the lowest x: the cell in column i of row j is `inside[j * nx + i]`.
    pub inside: Vec<bool>,
}

impl Raster {
    /// Asks at the middle of each cell. From about 150 columns on, the edge of a region looks smooth in
    /// [`sets()`](super::sets()).
    pub fn of(map: &Map, nx: usize, ny: usize, mut inside: impl FnMut([f32; 2]) -> bool) -> Self {
        let inside = middles(map.bounds, nx, ny).map(&mut inside).collect();
        Self { nx, ny, inside }
    }

    /// The share of the map's free space that is inside; NaN if no cell is free.
    pub fn share_of_free_space(&self, map: &Map) -> f64 {
        let cells = middles(map.bounds, self.nx, self.ny).zip(&self.inside);
        let (free, inside) = cells
            .filter(|(point, _)| map.is_free(*point))
            .fold((0_usize, 0_usize), |count, (_, inside)| (count.0 + 1, count.1 + usize::from(*inside)));
        inside as f64 / free as f64
    }

    /// The free cell of the region that is nearest to the mean of all of them: its middle, which is inside however the
    /// region is bent. None where it is empty.
    pub fn middle(&self, map: &Map) -> Option<[f32; 2]> {
        let cells = middles(map.bounds, self.nx, self.ny).zip(&self.inside);
        let inside: Vec<_> =
            cells.filter(|(p, inside)| **inside && map.is_free(*p)).map(|(p, _)| p).collect();
        let mean =
            [0, 1].map(|axis| inside.iter().map(|p| p[axis]).sum::<f32>() / inside.len().max(1) as f32);
        let far = |p: &[f32; 2]| (p[0] - mean[0]).hypot(p[1] - mean[1]);
        inside.into_iter().min_by(|a, b| far(a).total_cmp(&far(b)))
    }

    /// The share of two regions of one map together that is in both; 1 where both are empty.
    pub fn overlap(&self, other: &Self) -> f64 {
        let cells = self.inside.iter().zip(&other.inside);
        let (both, either) = cells.fold((0_usize, 0_usize), |(both, either), (a, b)| {
            (both + usize::from(*a && *b), either + usize::from(*a || *b))
        });
        if either == 0 { 1.0 } else { both as f64 / either as f64 }
    }

    /// The value of a cell; cells beyond the border are like the nearest ones.
    fn value(&self, column: i64, row: i64) -> f32 {
        let column = column.clamp(0, self.nx as i64 - 1) as usize;
        let row = row.clamp(0, self.ny as i64 - 1) as usize;
        f32::from(u8::from(self.inside[row * self.nx + column]))
    }

    /// Between 0 and 1 at a place measured in cells: linear between the middles of the four nearest.
    fn between(&self, x: f32, y: f32) -> f32 {
        let (column, row) = ((x - 0.5).floor(), (y - 0.5).floor());
        let (right, up) = (x - 0.5 - column, y - 0.5 - row);
        let (column, row) = (column as i64, row as i64);
        let low = self.value(column, row) * (1.0 - right) + self.value(column + 1, row) * right;
        let high = self.value(column, row + 1) * (1.0 - right) + self.value(column + 1, row + 1) * right;
        low * (1.0 - up) + high * up
    }

    /// Colours the inside, with a smooth edge and a darker rim. The raster must have all its values.
    pub(super) fn draw(&self, canvas: &mut Canvas, view: &View, colour: Colour) {
        self.shade(canvas, view, colour, [maze::INSIDE, RIM]);
    }

    /// Draws the rim alone.
    pub(super) fn outline(&self, canvas: &mut Canvas, view: &View, colour: Colour) {
        self.shade(canvas, view, colour, [0.0, OUTLINE]);
    }

    /// Colours inside and rim so strongly.
    fn shade(&self, canvas: &mut Canvas, view: &View, colour: Colour, [inside, strong]: [f32; 2]) {
        if self.inside.is_empty() {
            return;
        }
        let area = view.area;
        let (cells_x, cells_y) = (self.nx as f32 / area.w, self.ny as f32 / area.h);
        // An edge goes from 0 to 1 over a cell and, since each pixel is averaged over its neighbourhood, some pixels.
        let slope = 1.0 / cells_x.max(cells_y) + REACH.len() as f32;
        let pixels = canvas.pixels_mut();
        let width = pixels.width();
        let (left, right) = (area.x.round() as u32, (area.right().round() as u32).min(width));
        let (top, bottom) = (area.y.round() as u32, (area.bottom().round() as u32).min(pixels.height()));
        for y in top..bottom {
            for x in left..right {
                let (px, py) = (x as f32 + 0.5 - area.x, area.bottom() - y as f32 - 0.5);
                let near = REACH.iter().flat_map(|dx| REACH.iter().map(move |dy| (px + dx, py + dy)));
                let sum: f32 = near.map(|(px, py)| self.between(px * cells_x, py * cells_y)).sum();
                let deep = (sum / (REACH.len() * REACH.len()) as f32 - 0.5) * slope;
                let cover = (deep + 0.5).clamp(0.0, 1.0);
                let rim = (2.2 - deep.abs()).clamp(0.0, 1.0) * strong;
                let alpha = cover * (inside + rim);
                let pixel = &mut pixels.pixels_mut()[(y * width + x) as usize];
                *pixel = blend(*pixel, colour, alpha);
            }
        }
    }
}

/// A colour over an opaque pixel.
fn blend(under: PremultipliedColorU8, over: Colour, alpha: f32) -> PremultipliedColorU8 {
    let mix =
        |under: u8, over: u8| (f32::from(under) * (1.0 - alpha) + f32::from(over) * alpha).round() as u8;
    let [r, g, b] = over.rgb;
    let (r, g, b) = (mix(under.red(), r), mix(under.green(), g), mix(under.blue(), b));
    PremultipliedColorU8::from_rgba(r, g, b, 255).unwrap_or(under)
}

/// The middles of the cells, in the order of the values.
fn middles(bounds: Rect, nx: usize, ny: usize) -> impl Iterator<Item = [f32; 2]> {
    let [w, h] = bounds.size();
    (0..nx * ny).map(move |index| {
        let (column, row) = ((index % nx) as f32 + 0.5, (index / nx) as f32 + 0.5);
        [bounds.min[0] + w * column / nx as f32, bounds.min[1] + h * row / ny as f32]
    })
}
