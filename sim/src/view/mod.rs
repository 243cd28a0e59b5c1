//! Pictures of worlds for people: from above, and in perspective. Nothing that an agent sees comes from here.
//!
//! A small ray caster: every pixel asks which solid it sees first and whether the sun shines there; pixels on
//! borders ask eight times. Grids over the picture and over the sun's view of the world keep the questions
//! short. No clock, no thread, no file: it runs wherever the simulators run.

mod bins;
mod body;
mod camera;
pub mod colour;
mod draw;
mod floor;
mod lens;
mod scene;
mod stage;
mod sun;

pub use camera::Camera;
pub use draw::draw;
pub use scene::{Colour, Mark, Scene, Solid};
