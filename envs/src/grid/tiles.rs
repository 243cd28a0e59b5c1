//! MiniGrid's pictures of cells, drawn by its rules (envs.md a.3).
//!
//! A tile is drawn three times as large, each subpixel in the colour of the last shape that holds its centre, and then
//! averaged. Shapes are given in units of the tile's side.

use super::{Cell, Colour, Direction, Door};

/// Subpixels along a pixel's side.
const FINE: u32 = 3;
const BLACK: [u8; 3] = [0; 3];
/// The lines at the left and at the top of each tile.
const LINES: [u8; 3] = [100; 3];
/// How far a subpixel that the agent sees goes towards white.
const LIGHT: f64 = 0.3;

/// The tile of a cell in RGB, rows from the top, `side` pixels a side: with the agent in it or not, seen by it or not.
pub fn tile(cell: Cell, agent: Option<Direction>, seen: bool, side: u32) -> Vec<u8> {
    let fine = FINE * side;
    let mut canvas = Canvas { fine, pixels: vec![BLACK; (fine * fine) as usize] };
    canvas.fill(rectangle([0.0, 0.031], [0.0, 1.0]), LINES);
    canvas.fill(rectangle([0.0, 1.0], [0.0, 0.031]), LINES);
    canvas.cell(cell);
    if let Some(facing) = agent {
        canvas.fill(triangle(facing), Colour::Red.rgb());
    }
    if seen {
        let lighter = |c: u8| (f64::from(c) + LIGHT * f64::from(255 - c)) as u8;
        canvas.pixels.iter_mut().for_each(|pixel| *pixel = pixel.map(lighter));
    }
    canvas.averaged(side)
}

struct Canvas {
    /// Subpixels a side.
    fine: u32,
    pixels: Vec<[u8; 3]>,
}

impl Canvas {
    /// Gives all subpixels whose centres a shape holds a colour.
    fn fill(&mut self, shape: impl Fn(f64, f64) -> bool, colour: [u8; 3]) {
        let fine = f64::from(self.fine);
        for (index, pixel) in self.pixels.iter_mut().enumerate() {
            let [x, y] = [index as u32 % self.fine, index as u32 / self.fine];
            if shape((f64::from(x) + 0.5) / fine, (f64::from(y) + 0.5) / fine) {
                *pixel = colour;
            }
        }
    }

    /// A square in the middle, from `edge` to `1 - edge` (which `far` gives, as it was typed).
    fn square(&mut self, edge: f64, far: f64, colour: [u8; 3]) {
        self.fill(rectangle([edge, far], [edge, far]), colour);
    }

    fn cell(&mut self, cell: Cell) {
        match cell {
            Cell::Empty => {}
            Cell::Wall(colour) | Cell::Goal(colour) => self.square(0.0, 1.0, colour.rgb()),
            Cell::Floor(colour) => self.square(0.031, 1.0, scaled(colour, 0.5)),
            Cell::Door(colour, door) => self.door(colour, door),
            Cell::Key(colour) => {
                let colour = colour.rgb();
                self.fill(rectangle([0.50, 0.63], [0.31, 0.88]), colour);
                self.fill(rectangle([0.38, 0.50], [0.59, 0.66]), colour);
                self.fill(rectangle([0.38, 0.50], [0.81, 0.88]), colour);
                self.fill(disc([0.56, 0.28], 0.19), colour);
                self.fill(disc([0.56, 0.28], 0.064), BLACK);
            }
            Cell::Ball(colour) => self.fill(disc([0.5, 0.5], 0.31), colour.rgb()),
            Cell::Box(colour, _) => {
                self.square(0.12, 0.88, colour.rgb());
                self.square(0.18, 0.82, BLACK);
                self.fill(rectangle([0.16, 0.84], [0.47, 0.53]), colour.rgb());
            }
            Cell::Lava => {
                self.square(0.0, 1.0, [255, 128, 0]);
                for wave in 0..3 {
                    let (low, high) = (0.3 + 0.2 * f64::from(wave), 0.4 + 0.2 * f64::from(wave));
                    let points = [[0.1, low], [0.3, high], [0.5, low], [0.7, high], [0.9, low]];
                    points.windows(2).for_each(|ends| self.fill(line(ends[0], ends[1], 0.03), BLACK));
                }
            }
        }
    }

    fn door(&mut self, colour: Colour, door: Door) {
        let paint = colour.rgb();
        match door {
            Door::Open => {
                self.fill(rectangle([0.88, 1.0], [0.0, 1.0]), paint);
                self.fill(rectangle([0.92, 0.96], [0.04, 0.96]), BLACK);
            }
            Door::Closed => {
                self.square(0.0, 1.0, paint);
                self.square(0.04, 0.96, BLACK);
                self.square(0.08, 0.92, paint);
                self.square(0.12, 0.88, BLACK);
                self.fill(disc([0.75, 0.5], 0.08), paint);
            }
            Door::Locked => {
                self.square(0.0, 1.0, paint);
                self.square(0.06, 0.94, scaled(colour, 0.45));
                self.fill(rectangle([0.52, 0.75], [0.50, 0.56]), paint);
            }
        }
    }

    /// Each pixel the mean of its subpixels, a row at a time, truncated.
    fn averaged(&self, side: u32) -> Vec<u8> {
        let subpixel = |x: u32, y: u32, c: usize| f64::from(self.pixels[(y * self.fine + x) as usize][c]);
        let third = |sum: f64| sum / f64::from(FINE);
        let mut tile = Vec::with_capacity((3 * side * side) as usize);
        for (y, x) in (0..side).flat_map(|y| (0..side).map(move |x| (FINE * y, FINE * x))) {
            for c in 0..3 {
                let row = |dy| third((0..FINE).map(|dx| subpixel(x + dx, y + dy, c)).sum());
                tile.push(third((0..FINE).map(row).sum()) as u8);
            }
        }
        tile
    }
}

fn scaled(colour: Colour, by: f64) -> [u8; 3] {
    colour.rgb().map(|c| (by * f64::from(c)) as u8)
}

fn rectangle([left, right]: [f64; 2], [top, bottom]: [f64; 2]) -> impl Fn(f64, f64) -> bool {
    move |x, y| x >= left && x <= right && y >= top && y <= bottom
}

fn disc([cx, cy]: [f64; 2], radius: f64) -> impl Fn(f64, f64) -> bool {
    move |x, y| (x - cx) * (x - cx) + (y - cy) * (y - cy) <= radius * radius
}

/// All points within `reach` of a piece of a line. MiniGrid has its ends in single precision.
fn line(from: [f64; 2], to: [f64; 2], reach: f64) -> impl Fn(f64, f64) -> bool {
    let ([ax, ay], [bx, by]) = (from.map(single), to.map(single));
    let (dx, dy) = (bx - ax, by - ay);
    let squared = dx * dx + dy * dy;
    move |x, y| {
        let along = (((x - ax) * dx + (y - ay) * dy) / squared).clamp(0.0, 1.0);
        let (px, py) = (x - ax - along * dx, y - ay - along * dy);
        px * px + py * py <= reach * reach
    }
}

/// The agent. MiniGrid has its corners in single precision, and turns the points rather than the triangle.
fn triangle(facing: Direction) -> impl Fn(f64, f64) -> bool {
    let [a, b, c] = [[0.12, 0.19], [0.87, 0.50], [0.12, 0.81]].map(|corner| corner.map(single));
    let to = move |p: [f64; 2]| [p[0] - a[0], p[1] - a[1]];
    let dot = |p: [f64; 2], q: [f64; 2]| p[0] * q[0] + p[1] * q[1];
    let (v0, v1) = (to(c), to(b));
    let (d00, d01, d11) = (dot(v0, v0), dot(v0, v1), dot(v1, v1));
    let scale = 1.0 / (d00 * d11 - d01 * d01);
    move |x, y| {
        let (x, y) = (x - 0.5, y - 0.5);
        let (x, y) = match facing {
            Direction::Right => (x, y),
            Direction::Down => (y, -x),
            Direction::Left => (-x, -y),
            Direction::Up => (-y, x),
        };
        let v2 = to([0.5 + x, 0.5 + y]);
        let (d02, d12) = (dot(v0, v2), dot(v1, v2));
        let (u, v) = ((d11 * d02 - d01 * d12) * scale, (d00 * d12 - d01 * d02) * scale);
        u >= 0.0 && v >= 0.0 && u + v < 1.0
    }
}

fn single(number: f64) -> f64 {
    f64::from(number as f32)
}
