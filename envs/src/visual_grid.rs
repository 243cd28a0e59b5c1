//! An empty grid seen as a picture: the visual grid world of the paper on coin flips (Lobel, Bagaria and Konidaris 2023,
//! section 5.1), in which the answer to "how often was this state seen" is known.
//!
//! 42 × 42 cells, seen as 84 × 84 grey pixels: a white square of two by two on black is where one is, and nothing else is
//! drawn, not even the goal.

use inroads_sim::raster::{Colour, Format, Mosaic};
use rand::RngExt;

use crate::registry::{Entry, Make};
use crate::world::{Card, Draw, Drawn, Fact, Layout, Painter, See, World};
use crate::{Dimension, End, Frame, Snapshot, Step};

/// The worlds of the registry.
pub(crate) const ENTRIES: &[Entry] = &[Entry {
    name: "visual-grid",
    about: "42 by 42 empty cells from corner to corner, made to be seen as a picture; 1 for arriving, else nothing",
    make: Make::World(|| Box::new(VisualGrid::default())),
}];

/// Cells a side (the paper's).
pub const SIDE: u8 = 42;

/// Steps an episode (the paper's): the far corner is 82 away.
pub const LIMIT: u32 = 150;

/// How the paper's agents see it: each cell two by two pixels, grey.
pub const GREY: See = See::Pixels(Format { colour: Colour::Luma, scale: None });

/// Cells without walls. Choices: left, right, up, down; the border stops one. Arriving in the corner at the bottom right
/// pays 1 and ends the episode.
///
/// With a fixed layout one starts at the top left, else anywhere.
#[derive(Clone, Debug, Default)]
pub struct VisualGrid {
    at: [u8; 2],
}

/// The corner at the bottom right.
const GOAL: [u8; 2] = [SIDE - 1; 2];

impl VisualGrid {
    /// Where one is: column and row, from the top left.
    pub fn at(&self) -> [u8; 2] {
        self.at
    }
}

impl World for VisualGrid {
    fn card(&self) -> Card {
        let index = |name| Dimension::linear(name, "", 0.0, f32::from(SIDE - 1));
        Card {
            name: "visual-grid",
            about: "an empty grid of cells",
            actions: &["left", "right", "up", "down"],
            symbols: vec![index("column"), index("row")],
            place: vec![0, 1],
            limit: Some(LIMIT),
            success_reward: 1.0,
            layout: Layout::Fixed(0),
            see: See::Symbols,
        }
    }

    fn begin(&mut self, draw: Draw) {
        let anywhere = if draw.fixed() { draw.start() } else { Some(draw.layout()) };
        self.at = anywhere.map_or([0, 0], |mut rng| {
            // All cells but the last, which is the goal.
            let cell = rng.random_range(0..u16::from(SIDE) * u16::from(SIDE) - 1);
            [cell % u16::from(SIDE), cell / u16::from(SIDE)].map(|index| index as u8)
        });
    }

    fn act(&mut self, choice: usize) -> Step {
        let [x, y] = &mut self.at;
        match choice {
            0 => *x = x.saturating_sub(1),
            1 => *x = (*x + 1).min(SIDE - 1),
            2 => *y = y.saturating_sub(1),
            _ => *y = (*y + 1).min(SIDE - 1),
        }
        match self.at == GOAL {
            true => Step { reward: 1.0, end: Some(End::Terminated) },
            false => Step { reward: 0.0, end: None },
        }
    }

    fn symbols(&self, out: &mut Vec<f32>) {
        out.clear();
        out.extend(self.at.map(f32::from));
    }

    fn facts(&self) -> Vec<Fact> {
        let [x, y] = self.at.map(f32::from);
        vec![Fact::new("cell", y * f32::from(SIDE) + x)]
    }
}

impl Snapshot for VisualGrid {
    type State = [u8; 2];

    fn save(&self) -> [u8; 2] {
        self.at
    }

    fn load(&mut self, state: &[u8; 2]) {
        self.at = *state;
    }
}

/// Pixels a cell's side.
const TILE: u32 = 2;

/// Draws the grid: white where one is, on black.
#[derive(Clone, Debug)]
pub struct GridPainter {
    mosaic: Mosaic,
    shape: ([u32; 2], u32),
    looks: Vec<u16>,
}

impl Drawn for VisualGrid {
    type Painter = GridPainter;

    fn painter(&self, format: Format) -> GridPainter {
        let cells = [u32::from(SIDE); 2];
        let mut mosaic = Mosaic::new(cells, TILE, format);
        for colour in [0, 255] {
            mosaic.add(&[colour; (3 * TILE * TILE) as usize]);
        }
        let shape = (format.size(cells.map(|cells| cells * TILE)), format.channels());
        GridPainter { mosaic, shape, looks: Vec::new() }
    }
}

impl Painter<VisualGrid> for GridPainter {
    fn shape(&self) -> ([u32; 2], u32) {
        self.shape
    }

    fn paint(&mut self, world: &VisualGrid, out: &mut Frame) {
        self.looks.clear();
        self.looks.resize(usize::from(SIDE) * usize::from(SIDE), 0);
        let [x, y] = world.at.map(usize::from);
        self.looks[y * usize::from(SIDE) + x] = 1;
        out.copy(self.mosaic.show(&self.looks));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::{AnyEnvironment, Options, make_with};
    use crate::{Environment, world::Symbolic};

    #[test]
    fn the_far_corner_is_82_steps_away_and_the_border_stops_one() {
        let mut env = Symbolic::new(VisualGrid::default(), Layout::Fixed(0));
        env.reset(7);
        let mut walk = |choice: usize, times: usize| {
            let last = (0..times).map(|_| env.step(&choice).unwrap()).last().unwrap();
            (env.world().at(), last)
        };
        let on = Step { reward: 0.0, end: None };
        assert_eq!((walk(0, 2), walk(2, 2)), (([0, 0], on), ([0, 0], on)), "it starts in the corner");
        assert_eq!(walk(1, 50), ([41, 0], on));
        assert_eq!(walk(3, 40), ([41, 40], on));
        assert_eq!(walk(3, 1), ([41, 41], Step { reward: 1.0, end: Some(End::Terminated) }));
    }

    #[test]
    fn a_start_anywhere_is_drawn_where_none_is_fixed() {
        for layout in [Layout::Random, Layout::FixedMap(3)] {
            let mut grid = VisualGrid::default();
            let starts: Vec<_> = (0..50)
                .map(|seed| {
                    grid.begin(layout.draw(seed));
                    grid.at()
                })
                .collect();
            assert!(starts.iter().any(|at| *at != starts[0]) && !starts.contains(&GOAL), "{layout}");
        }
    }

    #[test]
    fn a_cell_is_four_white_pixels() {
        let options = Options { see: Some(GREY), ..Options::default() };
        let Ok(AnyEnvironment::Frames(mut env)) = make_with("visual-grid", &options) else {
            panic!("it is seen as a picture")
        };
        assert_eq!(env.spec().time_limit, Some(LIMIT));
        env.reset(0);
        for choice in [1, 1, 3] {
            env.step(&choice).unwrap();
        }
        let mut frame = Frame::default();
        env.observe(&mut frame);
        let white: Vec<_> = (0..84 * 84).filter(|i| frame.bytes()[*i] == 255).collect();
        assert_eq!(frame.bytes().len(), 84 * 84);
        assert_eq!(white, [2 * 84 + 4, 2 * 84 + 5, 3 * 84 + 4, 3 * 84 + 5]);
        assert_eq!(frame.bytes().iter().filter(|byte| **byte == 0).count(), 84 * 84 - 4);
    }
}
