//! Rigid bodies on Rapier: walls from cell maps, and robots that push against them.
//!
//! z is up, lengths are metres, times seconds, angles radians. A robot's step is a pure function of its state
//! and its action: Rapier's warm starts and contact caches never outlive a step, so saving a robot is copying
//! a few numbers.

pub mod ant;
mod arena;
mod articulated;
mod cells;
pub mod hand;
pub mod mjcf;
mod model;
mod point;
pub mod reacher;
mod rectangle;
mod walls;

pub use articulated::{
    Articulated, Configuration, Contact, Limits, ModelError, Party, Physics, PhysicsFault, Snapshot,
    StateError, Surroundings,
};
pub use cells::{CellMap, MapError};
pub use mjcf::MjcfError;
pub use model::{Actuator, Axis, Joint, Link, Mass, Model, Part};
pub use point::{MAX_FORWARD, MAX_SPEED, MAX_SPIN, MAX_TURN, Motion, PointError, PointRobot, PointState};
pub use rapier3d::math::{Pose, Rotation, Vector};
pub use rectangle::Rectangle;
