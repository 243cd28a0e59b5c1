//! A walk in one channel of a picture, while the two others flicker.

use inroads_sim::raster::{Format, Mosaic};
use rand::{RngExt, SeedableRng};

use super::{MOVES, Probe, ProbeError, Walker, place};
use crate::world::{Card, Draw, Drawn, Fact, Layout, Painter, See, World};
use crate::{Bits, Dimension, Frame, ProtoGoals, Rng, Snapshot, Step};

/// A picture of a few pixels: its red channel shows the player, each pixel of green and blue lights up by chance, anew
/// in every step and whatever is done (a "noisy TV").
///
/// Proto-goals: one for each pixel of each channel, red first.
#[derive(Clone, Debug)]
pub struct DistractorGrid {
    walker: Walker,
    odds: f64,
    lamps: Bits,
    chance: Rng,
}

/// All that changes in an episode of a [`DistractorGrid`].
#[derive(Clone, Debug, PartialEq)]
pub struct Distraction {
    at: [u32; 2],
    lamps: Bits,
    chance: Rng,
}

impl DistractorGrid {
    /// A picture of `side` by `side` pixels, in which a lamp is lit with probability `odds`. The thesis says neither.
    ///
    /// # Errors
    /// [`ProbeError::Side`] and [`ProbeError::Odds`].
    pub fn new(side: u32, odds: f64) -> Result<Self, ProbeError> {
        if !(0.0..=1.0).contains(&odds) {
            return Err(ProbeError::Odds(odds));
        }
        let walker = Walker::new(side)?;
        Ok(Self { walker, odds, lamps: Bits::new(2 * walker.cells()), chance: Rng::seed_from_u64(0) })
    }

    fn flicker(&mut self) {
        let lamps = 2 * self.walker.cells();
        self.lamps.clear(lamps);
        (0..lamps).filter(|_| self.chance.random_bool(self.odds)).for_each(|lamp| self.lamps.set(lamp));
    }

    /// What each lamp is called.
    fn lamps(&self) -> impl Iterator<Item = String> {
        let (side, cells) = (self.walker.side, self.walker.cells());
        (0..2 * cells).map(move |lamp| {
            let [x, y] = place(side, lamp % cells);
            format!("{} ({x}, {y})", if lamp < cells { "green" } else { "blue" })
        })
    }
}

impl World for DistractorGrid {
    fn card(&self) -> Card {
        let last = (self.walker.side - 1) as f32;
        let lamp = |name: String| Dimension { name: name.into(), ..Dimension::linear("", "", 0.0, 1.0) };
        let player = [Dimension::linear("x", "cells", 0.0, last), Dimension::linear("y", "cells", 0.0, last)];
        Card {
            name: "distractor-grid",
            about: "a walk in one channel of a picture while the others flicker; nothing is paid",
            actions: MOVES,
            symbols: player.into_iter().chain(self.lamps().map(lamp)).collect(),
            place: vec![0, 1],
            limit: Some(100),
            success_reward: 1.0,
            layout: Layout::Random,
            see: See::Symbols,
        }
    }

    fn begin(&mut self, draw: Draw) {
        self.walker.begin(draw);
        self.chance = draw.play();
        self.flicker();
    }

    fn act(&mut self, choice: usize) -> Step {
        self.walker.go(choice);
        self.flicker();
        Step { reward: 0.0, end: None }
    }

    fn symbols(&self, out: &mut Vec<f32>) {
        out.clear();
        out.extend(self.walker.at.map(|at| at as f32));
        out.extend((0..self.lamps.len()).map(|lamp| f32::from(u8::from(self.lamps.get(lamp)))));
    }

    fn facts(&self) -> Vec<Fact> {
        let [x, y] = self.walker.at;
        vec![Fact::new("x", x as f32), Fact::new("y", y as f32)]
    }
}

impl ProtoGoals for DistractorGrid {
    fn proto_goals(&self) -> Vec<String> {
        let player = (0..self.walker.cells()).map(|cell| {
            let [x, y] = place(self.walker.side, cell);
            format!("red ({x}, {y})")
        });
        player.chain(self.lamps()).collect()
    }

    fn annotate(&self, out: &mut Bits) {
        let cells = self.walker.cells();
        out.clear(3 * cells);
        out.set(self.walker.cell());
        self.lamps.ones().for_each(|lamp| out.set(cells + lamp));
    }

    fn cell(&self, bit: usize) -> Option<[usize; 2]> {
        Some(place(self.walker.side, bit % self.walker.cells()).map(|at| at as usize))
    }
}

impl Probe for DistractorGrid {
    fn controllable(&self) -> Vec<bool> {
        let cells = self.walker.cells();
        (0..3 * cells).map(|bit| bit < cells).collect()
    }
}

impl Snapshot for DistractorGrid {
    type State = Distraction;

    fn save(&self) -> Distraction {
        Distraction { at: self.walker.at, lamps: self.lamps.clone(), chance: self.chance.clone() }
    }

    fn load(&mut self, state: &Distraction) {
        self.walker.at = state.at;
        self.lamps.clone_from(&state.lamps);
        self.chance.clone_from(&state.chance);
    }
}

/// Pixels of the frame along a side of what is one pixel of the world.
const SIDE: u32 = 8;

/// Draws the three channels.
#[derive(Clone, Debug)]
pub struct DistractorPainter {
    mosaic: Mosaic,
    looks: Vec<u16>,
    shape: [u32; 2],
    channels: u32,
}

impl Drawn for DistractorGrid {
    type Painter = DistractorPainter;

    fn painter(&self, format: Format) -> DistractorPainter {
        let mut mosaic = Mosaic::new([self.walker.side; 2], SIDE, format);
        for look in 0..8_u8 {
            let colour: [u8; 3] = std::array::from_fn(|channel| 255 * (look >> channel & 1));
            mosaic.add(&colour.repeat((SIDE * SIDE) as usize));
        }
        let shape = format.size([self.walker.side * SIDE; 2]);
        DistractorPainter { mosaic, looks: vec![0; self.walker.cells()], shape, channels: format.channels() }
    }
}

impl Painter<DistractorGrid> for DistractorPainter {
    fn shape(&self) -> ([u32; 2], u32) {
        (self.shape, self.channels)
    }

    fn paint(&mut self, world: &DistractorGrid, out: &mut Frame) {
        let cells = self.looks.len();
        for (cell, look) in self.looks.iter_mut().enumerate() {
            let lit = |channel: usize| u16::from(world.lamps.get(channel * cells + cell));
            *look = u16::from(cell == world.walker.cell()) | lit(0) << 1 | lit(1) << 2;
        }
        out.copy(self.mosaic.show(&self.looks));
    }
}
