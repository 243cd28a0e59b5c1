//! What a maze asks of what walks in it.

use inroads_sim::{math, rigid::Rectangle, view::Solid};

use crate::{Dimension, Rng};

/// A robot among the walls of a map, which it has known since it was built.
pub trait Robot {
    /// Everything that its future depends on, besides the map and the actions.
    type State: Clone;

    /// What it observes, x and y first, when free space has these bounds.
    fn observation(&self, bounds: Rectangle) -> Vec<Dimension>;

    /// What it can do.
    fn action(&self) -> Vec<Dimension>;

    /// Half the side of a square about its position that keeps all of it, metres.
    fn clearance(&self) -> f64;

    /// Begins an episode near a point: there but for the noise that `rng` gives; there exactly without.
    ///
    /// # Errors
    /// Why it cannot stand there. It then stands where it stood.
    fn begin(&mut self, at: [f64; 2], rng: Option<&mut Rng>) -> Result<(), String>;

    /// Carries out an action that its space admits.
    ///
    /// # Errors
    /// Why the simulator gave up. What is observed stays as it was.
    fn act(&mut self, action: &[f32]) -> Result<(), String>;

    /// Where it is, metres: the first two numbers that it observes.
    fn at(&self) -> [f32; 2];

    /// Appends what it observes.
    fn observe(&self, out: &mut Vec<f32>);

    /// Where its observation says which way it looks.
    fn heading(&self) -> Heading;

    /// Its state.
    fn save(&self) -> Self::State;

    /// Brings a state back that this robot, or one built in the same way, has saved.
    fn load(&mut self, state: &Self::State);

    /// What it looks like.
    fn draw(&self, out: &mut Vec<Solid>);
}

/// Which part of an observation says which way a robot looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Heading {
    /// An angle from the x axis towards the y axis, radians, at this index.
    Angle(usize),
    /// A unit quaternion w, x, y, z from this index on; the robot looks along its own x axis.
    Quaternion(usize),
    /// None.
    Nowhere,
}

impl Heading {
    /// The angle from the x axis towards the y axis, radians; NaN when there is none.
    pub fn of(self, observation: &[f32]) -> f32 {
        match self {
            Self::Angle(at) => observation[at],
            Self::Quaternion(at) => {
                let [w, x, y, z] = std::array::from_fn(|i| observation[at + i]);
                math::atan2f(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
            }
            Self::Nowhere => f32::NAN,
        }
    }

    /// The same where `more` components were put in before the heading.
    pub(super) fn shifted(self, more: usize) -> Self {
        match self {
            Self::Angle(at) => Self::Angle(at + more),
            Self::Quaternion(at) => Self::Quaternion(at + more),
            Self::Nowhere => Self::Nowhere,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_heading_is_read_from_an_angle_or_a_quaternion() {
        let half = 0.35_f32;
        let seen = [1.0, 2.0, 0.7, half.cos(), 0.0, 0.0, half.sin()];
        assert_eq!(Heading::Angle(1).shifted(1).of(&seen), 0.7);
        assert!((Heading::Quaternion(3).of(&seen) - 0.7).abs() < 1e-6);
        assert!(Heading::Nowhere.shifted(2).of(&seen).is_nan());
    }
}
