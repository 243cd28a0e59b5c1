//! How taxis look: visgrid's drawing, pixel by pixel, and what the thesis' author makes of it.

use std::ops::Range;

use inroads_sim::raster::{Format, Frame, Scaler, Window};

use super::{Town, VisualTaxi};
use crate::world::Painter;

/// Sizes in a picture, pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sizes {
    /// How thick walls are.
    wall: u32,
    /// A side of a cell.
    cell: u32,
    /// How wide a passenger is.
    character: u32,
    /// The legs of the triangles in a depot's corners.
    corner: u32,
    /// The border at the top and the left, and at the bottom and the right.
    border: [u32; 2],
    /// A side of the border's squares when somebody is aboard.
    dash: u32,
}

impl Sizes {
    /// 5 × 5 cells in 48 × 48 pixels.
    pub const SMALL: Self = Self { wall: 1, cell: 7, character: 3, corner: 1, border: [4, 3], dash: 4 };
    /// 5 × 5 cells in 64 × 64 pixels.
    pub const MEDIUM: Self = Self { cell: 11, character: 7, corner: 2, border: [2, 1], ..Self::SMALL };
    /// 5 × 5 cells in 84 × 84 pixels.
    pub const LARGE: Self = Self { wall: 2, cell: 13, character: 9, corner: 3, border: [4, 3], dash: 6 };
    /// 10 × 10 cells in 128 × 128 pixels.
    pub const WIDE: Self = Self { border: [4, 3], ..Self::MEDIUM };

    /// A side of the picture of a town with so many rows.
    pub fn side(&self, rows: u8) -> u32 {
        let rows = u32::from(rows);
        self.wall * (rows + 1) + self.cell * rows + self.border[0] + self.border[1]
    }
}

/// What becomes of the picture's colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ink {
    /// They stay.
    #[default]
    Coloured,
    /// Each channel becomes 0 where it was 255, and 255 elsewhere: the thesis author's wrapper. It comes after scaling.
    Inverted,
}

/// A passenger as they are drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rider {
    pub(crate) cell: [u8; 2],
    pub(crate) aboard: bool,
    /// Where they want to go.
    pub(crate) goal: [u8; 2],
    /// The colour of that place.
    pub(crate) colour: [u8; 3],
}

/// Draws taxis. What is scaled is remembered, and scaled again only where something differs.
#[derive(Clone, Debug)]
pub struct TaxiPainter {
    plan: Plan,
    scene: Scene,
    format: Format,
    ink: Ink,
    scaler: Scaler,
    /// The scene that the canvas shows, and that, scaled.
    shown: Option<Scene>,
    canvas: Frame,
}

impl TaxiPainter {
    pub(crate) fn new(town: Town, sizes: Sizes, ink: Ink, format: Format) -> Self {
        let plan = Plan::new(town, sizes);
        let scaler = Scaler::new([plan.side; 2], format);
        Self { plan, scene: Scene::default(), format, ink, scaler, shown: None, canvas: Frame::default() }
    }

    /// Draws a taxi and its passengers.
    pub(crate) fn draw(&mut self, taxi: [u8; 2], riders: impl Iterator<Item = Rider>, out: &mut Frame) {
        self.scene.set(&self.plan, taxi, riders);
        if self.format == Format::NATIVE {
            out.shape([self.plan.side; 2], 3);
            (0..self.plan.side).for_each(|y| self.plan.row(&self.scene, y, out.row_mut(y)));
        } else {
            self.scale();
            out.copy(&self.canvas);
        }
        if self.ink == Ink::Inverted {
            out.bytes_mut().iter_mut().for_each(|byte| *byte = if *byte == 255 { 0 } else { 255 });
        }
    }

    /// Brings the canvas up to date.
    fn scale(&mut self) {
        let Self { plan, scene, scaler, canvas, .. } = self;
        let alike =
            |shown: &&mut Scene| shown.border == scene.border && shown.stamps.len() == scene.stamps.len();
        let Some(shown) = self.shown.as_mut().filter(alike) else {
            scaler.run(|y, pixels| plan.row(scene, y, pixels), canvas);
            self.shown.get_or_insert_default().copy(scene);
            return;
        };
        let cell = plan.sizes.cell;
        for (old, new) in shown.stamps.iter().zip(&scene.stamps).filter(|(old, new)| old != new) {
            for [y, x] in [old.at, new.at] {
                let native = Window { from: [x, y], to: [x + cell, y + cell] };
                let row = |y, columns: Range<u32>, pixels: &mut [u8]| {
                    plan.part(scene, y, columns.clone(), pixels);
                };
                scaler.part(scaler.touches(native), row, canvas);
            }
        }
        shown.copy(scene);
    }
}

impl Painter<VisualTaxi> for TaxiPainter {
    fn shape(&self) -> ([u32; 2], u32) {
        (self.format.size([self.plan.side; 2]), self.format.channels())
    }

    fn paint(&mut self, world: &VisualTaxi, out: &mut Frame) {
        self.draw(world.state().taxi, world.riders(), out);
    }
}

const WHITE: u8 = 255;
/// Walls.
const WALL: [u8; 3] = [7, 13, 13];
/// The taxi and the marks on passengers.
const DARK: [u8; 3] = [26, 26, 26];

/// What is the same in every picture: walls, and the shapes of things, `cell` × `cell` pixels each.
#[derive(Clone, Debug)]
struct Plan {
    sizes: Sizes,
    side: u32,
    /// Rows of pixels: one for each row of the town's lattice, and a white one.
    rows: Vec<u8>,
    depot: Vec<Dot>,
    waiting: Vec<Dot>,
    aboard: Vec<Dot>,
    taxi: Vec<Dot>,
}

/// A pixel of a shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Dot {
    Clear,
    /// In the colour of whom it belongs to.
    Own,
    Dark,
}

/// What is where in one picture. Nothing lies over anything else: shapes leave room for each other.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Scene {
    stamps: Vec<Stamp>,
    /// The colour of whoever is aboard.
    border: Option<[u8; 3]>,
}

/// A shape in a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Stamp {
    at: [u32; 2],
    shape: Shape,
    colour: [u8; 3],
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shape {
    Depot,
    Waiting,
    Aboard,
    Taxi,
}

impl Scene {
    /// Becomes a copy of the other, in the memory that it has.
    fn copy(&mut self, other: &Self) {
        self.border = other.border;
        self.stamps.clone_from(&other.stamps);
    }

    fn set(&mut self, plan: &Plan, taxi: [u8; 2], riders: impl Iterator<Item = Rider>) {
        let sizes = &plan.sizes;
        let corner = |cell: [u8; 2]| {
            cell.map(|at| sizes.border[0] + sizes.wall + u32::from(at) * (sizes.wall + sizes.cell))
        };
        self.border = None;
        self.stamps.clear();
        self.stamps.push(Stamp { at: corner(taxi), shape: Shape::Taxi, colour: DARK });
        for Rider { cell, aboard, goal, colour } in riders {
            let shape = if aboard { Shape::Aboard } else { Shape::Waiting };
            self.border = self.border.or(aboard.then_some(colour));
            self.stamps.push(Stamp { at: corner(goal), shape: Shape::Depot, colour });
            self.stamps.push(Stamp { at: corner(cell), shape, colour });
        }
    }
}

impl Plan {
    fn new(town: Town, sizes: Sizes) -> Self {
        let side = sizes.side(town.size());
        let Sizes { wall, cell, border, .. } = sizes;
        // Which row or column of the lattice a pixel belongs to; none in the border.
        let lattice = |at: u32| {
            let inside = (border[0]..side - border[1]).contains(&at).then(|| at - border[0])?;
            let [nth, rest] = [inside / (wall + cell), inside % (wall + cell)];
            Some(2 * nth + u32::from(rest >= wall))
        };
        let mut rows = Vec::new();
        for row in 0..=2 * u32::from(town.size()) {
            for x in 0..side {
                let wall = lattice(x).is_some_and(|column| town.lattice([row, column]));
                rows.extend(if wall { WALL } else { [WHITE; 3] });
            }
        }
        rows.extend((0..3 * side).map(|_| WHITE));
        let dots = |dot: &dyn Fn(u32, u32) -> Dot| {
            (0..cell * cell).map(|at| dot(at / cell, at % cell)).collect::<Vec<Dot>>()
        };
        let middle = cell / 2;
        Self {
            sizes,
            side,
            rows,
            depot: dots(&|y, x| if sizes.in_depot(y, x) { Dot::Own } else { Dot::Clear }),
            waiting: dots(&|y, x| sizes.character_dot(y, x, x == y || x + y + 1 == cell)),
            aboard: dots(&|y, x| sizes.character_dot(y, x, x == middle || y == middle)),
            taxi: dots(&|y, x| {
                let rim = x.min(y).min(cell - 1 - x).min(cell - 1 - y) == 0;
                let taken = rim || sizes.in_depot(y, x) || sizes.in_character(y, x);
                if taken { Dot::Clear } else { Dot::Dark }
            }),
        }
    }

    /// Draws a row of pixels.
    fn row(&self, scene: &Scene, y: u32, pixels: &mut [u8]) {
        self.part(scene, y, 0..self.side, pixels);
    }

    /// Draws some columns of a row of pixels.
    fn part(&self, scene: &Scene, y: u32, columns: Range<u32>, pixels: &mut [u8]) {
        let Sizes { wall, cell, border: [first, last], dash, .. } = self.sizes;
        let within = first..self.side - last;
        let row = match within.contains(&y) {
            true => 2 * ((y - first) / (wall + cell)) + u32::from((y - first) % (wall + cell) >= wall),
            false => self.rows.len() as u32 / (3 * self.side) - 1,
        };
        let bytes = |columns: &Range<u32>| 3 * columns.start as usize..3 * columns.end as usize;
        pixels.copy_from_slice(&self.rows[(row * 3 * self.side) as usize..][bytes(&columns)]);
        // The pixels of those of these columns that are drawn.
        let mut shared = |others: Range<u32>| {
            let both = others.start.max(columns.start)..others.end.min(columns.end);
            let inside = both.start.saturating_sub(columns.start)..both.end.saturating_sub(columns.start);
            (both.start < both.end).then(|| (both, bytes(&inside)))
        };
        if let Some(colour) = scene.border {
            let edges =
                if within.contains(&y) { [0..first, within.end..self.side] } else { [0..self.side, 0..0] };
            for (columns, bytes) in edges.into_iter().filter_map(&mut shared) {
                for (x, pixel) in columns.zip(pixels[bytes].chunks_exact_mut(3)) {
                    let square = (x / dash + y / dash).is_multiple_of(2);
                    pixel.copy_from_slice(if square { &colour } else { &[0; 3] });
                }
            }
        }
        for stamp in &scene.stamps {
            let [top, left] = stamp.at;
            let Some(line) = y.checked_sub(top).filter(|&line| line < cell) else { continue };
            let Some((columns, bytes)) = shared(left..left + cell) else { continue };
            let shape = match stamp.shape {
                Shape::Depot => &self.depot,
                Shape::Waiting => &self.waiting,
                Shape::Aboard => &self.aboard,
                Shape::Taxi => &self.taxi,
            };
            let dots = &shape[(line * cell + columns.start - left) as usize..];
            for (pixel, dot) in pixels[bytes].chunks_exact_mut(3).zip(dots) {
                match dot {
                    Dot::Clear => {}
                    Dot::Own => pixel.copy_from_slice(&stamp.colour),
                    Dot::Dark => pixel.copy_from_slice(&DARK),
                }
            }
        }
    }
}

impl Sizes {
    /// Whether a pixel of a cell belongs to a depot: the cell's outline, and a triangle in each corner.
    fn in_depot(&self, y: u32, x: u32) -> bool {
        let [y, x] = [y, x].map(|at| at.min(self.cell - 1 - at));
        x.min(y) == 0 || x + y < self.corner
    }

    /// Whether a pixel of a cell belongs to a passenger: a square without its corners. As visgrid has it, more is cut off
    /// the larger the square is, and nothing of one of three pixels.
    fn in_character(&self, y: u32, x: u32) -> bool {
        let aside = (self.cell - self.character) / 2;
        let [y, x] = [y, x].map(|at| at.min(self.cell - 1 - at));
        let cut = 2 * (self.cell / 2) - self.character / 2 - 2;
        x.min(y) >= aside && x + y >= cut
    }

    fn character_dot(&self, y: u32, x: u32, marked: bool) -> Dot {
        match (self.in_character(y, x), marked) {
            (false, _) => Dot::Clear,
            (true, true) => Dot::Dark,
            (true, false) => Dot::Own,
        }
    }
}
