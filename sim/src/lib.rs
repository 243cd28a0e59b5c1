//! Bodies, walls and pixels: the simulators of Inroads.
//!
//! This room knows geometry and physics, and nothing of rewards, episodes or tensors.

pub mod math;
pub mod raster;
pub mod rigid;
mod shape;
pub mod view;

pub use shape::Shape;
