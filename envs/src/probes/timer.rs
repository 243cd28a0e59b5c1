//! A walk while a timer counts.

use inroads_sim::raster::{Format, Mosaic};

use super::{MOVES, Probe, ProbeError, Walker, place};
use crate::world::{Card, Draw, Drawn, Fact, Layout, Painter, See, World};
use crate::{Bits, Dimension, Frame, ProtoGoals, Snapshot, Step};

/// A grid to walk on, and a timer that goes up by one a step whatever is done.
///
/// It reads 0 at the start, and `ticks` when the episode is truncated. Proto-goals: one a cell, one for each reading
/// from 1.
#[derive(Clone, Debug)]
pub struct TimerGrid {
    walker: Walker,
    ticks: u32,
    timer: u32,
}

impl TimerGrid {
    /// A grid of `side` by `side` cells, with a timer that counts to `ticks`: 4 and 100 in the thesis.
    ///
    /// # Errors
    /// [`ProbeError::Side`] and [`ProbeError::Ticks`].
    pub fn new(side: u32, ticks: u32) -> Result<Self, ProbeError> {
        if !(1..=10_000).contains(&ticks) {
            return Err(ProbeError::Ticks(ticks));
        }
        Ok(Self { walker: Walker::new(side)?, ticks, timer: 0 })
    }
}

impl World for TimerGrid {
    fn card(&self) -> Card {
        let last = (self.walker.side - 1) as f32;
        Card {
            name: "timer-grid",
            about: "a walk while a timer counts; nothing is paid",
            actions: MOVES,
            symbols: vec![
                Dimension::linear("x", "cells", 0.0, last),
                Dimension::linear("y", "cells", 0.0, last),
                Dimension::linear("timer", "steps", 0.0, self.ticks as f32),
            ],
            place: vec![0, 1],
            limit: Some(self.ticks),
            success_reward: 1.0,
            layout: Layout::Random,
            see: See::Symbols,
        }
    }

    fn begin(&mut self, draw: Draw) {
        self.walker.begin(draw);
        self.timer = 0;
    }

    fn act(&mut self, choice: usize) -> Step {
        self.walker.go(choice);
        // Who leaves off the limit sees the timer stand still at its last reading.
        self.timer = (self.timer + 1).min(self.ticks);
        Step { reward: 0.0, end: None }
    }

    fn symbols(&self, out: &mut Vec<f32>) {
        out.clear();
        out.extend([self.walker.at[0], self.walker.at[1], self.timer].map(|number| number as f32));
    }

    fn facts(&self) -> Vec<Fact> {
        let [x, y] = self.walker.at;
        vec![Fact::new("x", x as f32), Fact::new("y", y as f32), Fact::new("timer", self.timer as f32)]
    }
}

impl ProtoGoals for TimerGrid {
    fn proto_goals(&self) -> Vec<String> {
        let cells = (0..self.walker.cells()).map(|cell| {
            let [x, y] = place(self.walker.side, cell);
            format!("player at ({x}, {y})")
        });
        cells.chain((1..=self.ticks).map(|reading| format!("timer reads {reading}"))).collect()
    }

    fn annotate(&self, out: &mut Bits) {
        out.clear(self.walker.cells() + self.ticks as usize);
        out.set(self.walker.cell());
        if self.timer > 0 {
            out.set(self.walker.cells() + self.timer as usize - 1);
        }
    }

    fn cell(&self, bit: usize) -> Option<[usize; 2]> {
        (bit < self.walker.cells()).then(|| place(self.walker.side, bit).map(|at| at as usize))
    }
}

impl Probe for TimerGrid {
    fn controllable(&self) -> Vec<bool> {
        let cells = std::iter::repeat_n(true, self.walker.cells());
        cells.chain(std::iter::repeat_n(false, self.ticks as usize)).collect()
    }
}

impl Snapshot for TimerGrid {
    type State = ([u32; 2], u32);

    fn save(&self) -> Self::State {
        (self.walker.at, self.timer)
    }

    fn load(&mut self, &(at, timer): &Self::State) {
        (self.walker.at, self.timer) = (at, timer);
    }
}

/// Pixels along a side of a cell.
const SIDE: u32 = 8;
/// Steps that the pixels of one cell can count.
const COUNTED: u32 = SIDE * SIDE;
const GROUND: [u8; 3] = [24, 24, 24];
const PLAYER: [u8; 3] = [255, 0, 0];
const UNLIT: [u8; 3] = [48, 48, 64];
const LIT: [u8; 3] = [255, 255, 255];

/// Draws the grid, and below it the timer: a pixel for each step, cell by cell.
#[derive(Clone, Debug)]
pub struct TimerPainter {
    mosaic: Mosaic,
    looks: Vec<u16>,
    shape: [u32; 2],
    channels: u32,
}

impl Drawn for TimerGrid {
    type Painter = TimerPainter;

    fn painter(&self, format: Format) -> TimerPainter {
        let side = self.walker.side;
        let size = [side, side + self.ticks.div_ceil(COUNTED * side)];
        let mut mosaic = Mosaic::new(size, SIDE, format);
        mosaic.add(GROUND.repeat(COUNTED as usize).as_slice());
        mosaic.add(PLAYER.repeat(COUNTED as usize).as_slice());
        for lit in 0..=COUNTED as usize {
            mosaic.add(&[LIT.repeat(lit), UNLIT.repeat(COUNTED as usize - lit)].concat());
        }
        let looks = vec![0; (size[0] * size[1]) as usize];
        let shape = format.size(size.map(|cells| cells * SIDE));
        TimerPainter { mosaic, looks, shape, channels: format.channels() }
    }
}

impl Painter<TimerGrid> for TimerPainter {
    fn shape(&self) -> ([u32; 2], u32) {
        (self.shape, self.channels)
    }

    fn paint(&mut self, world: &TimerGrid, out: &mut Frame) {
        let (cells, timer) = self.looks.split_at_mut(world.walker.cells());
        cells.fill(0);
        cells[world.walker.cell()] = 1;
        for (cell, look) in (0..).zip(timer) {
            *look = 2 + world.timer.saturating_sub(cell * COUNTED).min(COUNTED) as u16;
        }
        out.copy(self.mosaic.show(&self.looks));
    }
}
