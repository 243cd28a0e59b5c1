//! Worlds with known answers to the question which proto-goals an agent can control (thesis section 8.5.2).
//!
//! Each of them has one kind of thing that changes whatever the agent does: a timer ([`TimerGrid`]), lamps that light up
//! at random ([`DistractorGrid`]). Neither pays anything or ends: they are for measuring. The third probe of the thesis is
//! the [taxi](crate::taxi), whose destination never changes within an episode.

mod distractor;
mod taxi;
mod timer;

pub use distractor::{Distraction, DistractorGrid, DistractorPainter};
pub use timer::{TimerGrid, TimerPainter};

use rand::RngExt;

use crate::ProtoGoals;
use crate::registry::{Entry, Make};
use crate::world::Draw;

/// The worlds of the registry.
pub(crate) const ENTRIES: &[Entry] = &[
    Entry {
        name: "timer-grid",
        about: "a walk on 4 by 4 cells while a timer counts to 100; nothing is paid",
        make: Make::Annotated(|| Box::new(TimerGrid::new(4, 100).expect("a size that there is"))),
    },
    Entry {
        name: "distractor-grid",
        about: "a walk in one channel of a picture while the others flicker; nothing is paid",
        make: Make::Annotated(|| Box::new(DistractorGrid::new(4, 0.5).expect("a size that there is"))),
    },
];

/// A domain that knows which of its proto-goals are controllable: the truth that a measure of controllability is held
/// against (thesis figure 8.6).
pub trait Probe: ProtoGoals {
    /// For each proto-goal, whether it depends on the agent's actions if it comes to hold, or ceases to.
    fn controllable(&self) -> Vec<bool>;
}

/// Why there is no such probe.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ProbeError {
    /// Too few cells to walk on, or too many.
    #[error("a grid cannot be {0} cells wide; give a side between 2 and 32")]
    Side(u32),
    /// The timer has no readings, or too many.
    #[error("a timer cannot count to {0}; give a number between 1 and 10000")]
    Ticks(u32),
    /// No probability.
    #[error("lamps cannot light up with probability {0}; give a number between 0 and 1")]
    Odds(f64),
}

/// What the four actions are called.
const MOVES: &[&str] = &["up", "right", "down", "left"];
/// Steps right and down of the four actions.
const WAYS: [[i32; 2]; 4] = [[0, -1], [1, 0], [0, 1], [-1, 0]];

/// Somebody on a square grid without walls, which the border stops.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Walker {
    side: u32,
    at: [u32; 2],
}

impl Walker {
    fn new(side: u32) -> Result<Self, ProbeError> {
        if (2..=32).contains(&side) { Ok(Self { side, at: [0, 0] }) } else { Err(ProbeError::Side(side)) }
    }

    /// Stands anywhere.
    fn begin(&mut self, draw: Draw) {
        let mut rng = draw.start().unwrap_or_else(|| draw.layout());
        self.at = [rng.random_range(0..self.side), rng.random_range(0..self.side)];
    }

    fn go(&mut self, choice: usize) {
        for (at, way) in self.at.iter_mut().zip(WAYS[choice]) {
            *at = at.saturating_add_signed(way).min(self.side - 1);
        }
    }

    /// The number of the cell, rows from the top.
    fn cell(&self) -> usize {
        (self.at[1] * self.side + self.at[0]) as usize
    }

    fn cells(&self) -> usize {
        (self.side * self.side) as usize
    }
}

/// Column and row of the cell with this number.
fn place(side: u32, cell: usize) -> [u32; 2] {
    [cell as u32 % side, cell as u32 / side]
}
