//! What there is to draw, as plain data.

use rapier3d::math::{Pose, Vector};

use crate::{rigid::Rectangle, shape::Shape};

/// Red, green, blue.
pub type Colour = [u8; 3];

/// A coloured solid.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    /// What it is.
    pub shape: Shape,
    /// Where it is in the world.
    pub pose: Pose,
    /// Its colour.
    pub colour: Colour,
}

/// A disc painted on the floor: a goal, a key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark {
    /// Its centre, metres.
    pub at: [f32; 2],
    /// Its radius, metres.
    pub radius: f32,
    /// Its colour.
    pub colour: Colour,
}

/// A world at one moment. z is up, metres.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// What stands on the floor (z = 0) or hangs in the air. A box on the floor is taken for a wall: where it
    /// hides what is about the focus, it is drawn as of glass.
    pub solids: Vec<Solid>,
    /// What is painted on the floor, later marks over earlier ones.
    pub marks: Vec<Mark>,
    /// A line on the floor: where somebody has been, oldest first; it fades with age. A point that is not made
    /// of finite numbers interrupts it.
    pub trail: Vec<[f32; 2]>,
    /// The part of the floor that a picture from above shows.
    pub bounds: Rectangle,
    /// What a camera at an angle looks at. It sees about 0.7 times `distance` of the world there.
    pub focus: Vector,
    /// How far the camera is from its focus, metres.
    pub distance: f32,
}
