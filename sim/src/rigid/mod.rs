//! Rigid bodies on Rapier: walls from cell maps, and robots that push against them.
//!
//! z is up, lengths are metres, times seconds, angles radians. A robot's step is a pure function of its state
//! and its action: Rapier's warm starts and contact caches never outlive a step, so saving a robot is copying
//! a few numbers.

mod arena;
mod cells;
mod point;
mod rectangle;
mod walls;

pub use cells::{CellMap, MapError};
pub use point::{MAX_FORWARD, MAX_SPEED, MAX_SPIN, MAX_TURN, Motion, PointError, PointRobot, PointState};
pub use rectangle::Rectangle;
