//! What a board looks like: 500 × 500 pixels, as the peers' viewer draws them.

use std::sync::Arc;

use inroads_sim::raster::{Format, Scaler, Stencil, Window};

use super::{Ball, Configuration, Pinball};
use crate::{Frame, world::Painter};

/// Pixels along a side.
const SIDE: u32 = 500;
const GROUND: [u8; 3] = [232, 232, 232];
const WALLS: [u8; 3] = [64, 64, 64];
const TARGET: [u8; 3] = [255, 0, 0];
const BALL: [u8; 3] = [0, 0, 255];

impl Configuration {
    /// Everything but the ball, as large as the viewer draws it; drawn once.
    fn still(&self) -> &Frame {
        self.still.get_or_init(|| {
            let mut frame = Frame::new([SIDE; 2], 3);
            frame.bytes_mut().as_chunks_mut().0.fill(GROUND);
            for corners in self.polygons() {
                let corners: Vec<_> = corners.iter().map(|&corner| pixel(corner)).collect();
                Stencil::polygon(&corners).fill([0, 0], WALLS, &mut frame);
            }
            let (at, radius) = self.target();
            Stencil::disc(pixels(radius) as u32).fill(pixel(at), TARGET, &mut frame);
            frame
        })
    }
}

/// A length or coordinate in whole pixels, rounded towards 0.
fn pixels(length: f64) -> i32 {
    (f64::from(SIDE) * length) as i32
}

fn pixel(point: [f64; 2]) -> [i32; 2] {
    point.map(pixels)
}

/// Draws boards: what never changes is copied, and only the pixels that the ball has a say in are computed.
///
/// Clones share all that is large.
#[derive(Clone, Debug)]
pub struct BallPainter {
    configuration: Arc<Configuration>,
    parts: Arc<Parts>,
}

/// What it takes to draw balls of one size on one board in one format.
#[derive(Debug)]
pub(super) struct Parts {
    format: Format,
    /// The board without the ball, in the format that is wanted.
    still: Frame,
    scaler: Scaler,
    ball: Stencil,
}

impl Parts {
    fn new(configuration: &Configuration, format: Format) -> Self {
        let native = configuration.still();
        let mut still = Frame::default();
        let copy = |y, pixels: &mut [u8]| pixels.copy_from_slice(native.row(y));
        Scaler::new([SIDE; 2], format).run(copy, &mut still);
        // Another one, without the memory that whole pictures need.
        let scaler = Scaler::new([SIDE; 2], format);
        Self { format, still, scaler, ball: Stencil::disc(pixels(configuration.ball()) as u32) }
    }
}

impl BallPainter {
    pub(super) fn new(configuration: Arc<Configuration>, format: Format) -> Self {
        let made = || Arc::new(Parts::new(&configuration, format));
        // Thousands of copies of an environment are seen in one format, usually the first that anybody wants.
        let first = configuration.first.get_or_init(made);
        let parts = if first.format == format { first.clone() } else { made() };
        Self { configuration, parts }
    }

    fn draw(&self, ball: Ball, out: &mut Frame) {
        let Parts { still, scaler, ball: disc, .. } = &*self.parts;
        out.copy(still);
        let at = pixel(ball.centre());
        let on = |disc: std::ops::Range<i32>, at: i32| {
            // Who restores a ball may put it anywhere.
            [disc.start, disc.end].map(|edge| edge.saturating_add(at).clamp(0, SIDE as i32) as u32)
        };
        let [[left, right], [top, bottom]] = [on(disc.columns(), at[0]), on(disc.rows(), at[1])];
        if left == right || top == bottom {
            return;
        }
        let native = self.configuration.still();
        let row = |y, columns: std::ops::Range<u32>, pixels: &mut [u8]| {
            let bytes = 3 * columns.start as usize..3 * columns.end as usize;
            pixels.copy_from_slice(&native.row(y)[bytes]);
            disc.fill_row(at, BALL, y, columns, pixels);
        };
        scaler.part(scaler.touches(Window { from: [left, top], to: [right, bottom] }), row, out);
    }
}

impl Painter<Pinball> for BallPainter {
    fn shape(&self) -> ([u32; 2], u32) {
        (self.parts.still.size(), self.parts.still.channels())
    }

    fn paint(&mut self, world: &Pinball, out: &mut Frame) {
        self.draw(world.ball(), out);
    }
}
