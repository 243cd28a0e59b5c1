//! Bodies as plain data: links in a tree, joints between them, solids on them, actuators at the joints.

use rapier3d::math::{Pose, Vector};

use crate::Shape;

/// A tree of links.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Its name, for messages.
    pub name: String,
    /// Parents stand before their children; the first link is the root.
    pub links: Vec<Link>,
    /// What actions act on, in the order of the action's components.
    pub actuators: Vec<Actuator>,
}

/// A rigid link and the joint by which it hangs on its parent.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// Its name, for messages.
    pub name: String,
    /// Index of its parent in [`Model::links`]; the root hangs in the world.
    pub parent: Option<usize>,
    /// Where its frame lies in its parent's (the root's: in the world) when its joint is at zero.
    pub place: Pose,
    /// How it moves against its parent.
    pub joint: Joint,
    /// What it is made of.
    pub solids: Vec<Part>,
    /// Its mass, where that is not its solids' volumes times their densities.
    pub mass: Option<Mass>,
}

/// A solid of a link.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// What it is.
    pub shape: Shape,
    /// Where it lies in the link's frame.
    pub pose: Pose,
    /// kg/m³; not read where the link says its [`Link::mass`].
    pub density: f32,
    /// Coefficient of sliding friction; the greater of two touching solids' counts (MuJoCo's rule).
    pub friction: f32,
    /// Whether it touches floor, walls and other models. Solids of one model never touch each other.
    pub solid: bool,
}

/// Mass and how it is spread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mass {
    /// kg.
    pub mass: f32,
    /// Centre of mass in the link's frame, metres, and the principal axes.
    pub place: Pose,
    /// Principal moments of inertia, kg m².
    pub inertia: Vector,
}

/// How a link moves against its parent.
#[derive(Clone, Debug, PartialEq)]
pub enum Joint {
    /// Not at all.
    Fixed,
    /// Freely; only roots can.
    Free,
    /// It turns about an axis.
    Hinge(Axis),
    /// It slides along an axis.
    Slide(Axis),
}

/// One degree of freedom. Units are those of MuJoCo: radians and N m for hinges, metres and N for slides.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Its direction in the link's frame, of length 1.
    pub axis: Vector,
    /// A point that it goes through, in the link's frame, metres.
    pub anchor: Vector,
    /// Least and greatest coordinate.
    pub range: Option<[f32; 2]>,
    /// Force against motion for each unit of speed.
    pub damping: f32,
    /// Rotor inertia, added to the diagonal of the mass matrix: kg m² (hinges), kg (slides).
    pub armature: f32,
    /// Dry friction: the force or torque below which the joint does not move.
    pub friction: f32,
}

/// A motor: a generalised force on one joint, as large as the control says.
#[derive(Clone, Debug, PartialEq)]
pub struct Actuator {
    /// Index of the link whose joint it drives.
    pub link: usize,
    /// Force (N) or torque (N m) of control 1. Controls are in [-1, 1].
    pub gear: f32,
}
