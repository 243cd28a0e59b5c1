//! What the hand takes hold of: a door, a lever, a slide.
//!
//! Sizes, joints and masses are those of the fork of robosuite on which the thesis' robot experiments ran
//! (section 5.2.2; `babbatem/robosuite`, `door.xml`, `lever.xml`, `slide.xml`), in the object's frame.

use rapier3d::math::{Pose, Rotation, Vector};

use crate::Shape;
use crate::rigid::{Axis, Joint, Link, Mass, Model, Part};

/// Index of the link that stands: a frame, a base.
pub const STANDS: usize = 0;
/// Index of the link that moves, on the object's one joint.
pub const MOVES: usize = 1;
/// Index of the link that is there to be gripped; it is fixed to the one that moves.
pub const HANDLE: usize = 2;
/// Index of the table, fixed to what stands.
pub const TABLE: usize = 3;

/// Density where nothing else is said, kg/m³ (MuJoCo's).
const DENSITY: f32 = 1000.0;
/// Half the sizes of the table, metres.
const BOARD: Vector = Vector::new(0.4, 0.4, 0.025);

/// A door in a frame, the handle in front (negative y at rest): hinge 0 to 0.4 rad, opening towards negative y.
/// The latch is off, the handle is fixed to the panel.
pub fn door() -> Model {
    let frame = |x: f32| part(cylinder(0.3, 0.03), at(x, 0.0, 0.0));
    let handle = Vector::new(-0.175, 0.0, -0.025);
    // A bar that starts at the end of a stub that stands on the panel.
    let stub = Pose::from_parts(
        handle + Vector::new(0.0, -0.0625, 0.0),
        Rotation::from_rotation_x(std::f32::consts::FRAC_PI_2),
    );
    let bar = at(handle.x + 0.075, handle.y - 0.1, handle.z);
    object(
        "door",
        vec![frame(0.255), frame(-0.255)],
        Link {
            name: "panel".into(),
            parent: Some(0),
            place: Pose::IDENTITY,
            joint: Joint::Hinge(Axis {
                axis: Vector::Z,
                anchor: Vector::new(0.255, 0.0, 0.0),
                range: Some([0.0, 0.4]),
                damping: 1.0,
                armature: 0.0,
                friction: 1.0,
            }),
            solids: vec![
                part(cuboid(0.22, 0.02, 0.29), at(0.0, 0.0, 0.0)),
                part(cylinder(0.0625, 0.025), stub),
            ],
            // The fork turns the moments by 1.6 degrees; they are about x, y and z here.
            mass: Some(Mass {
                mass: 2.43455,
                place: at(0.029_681_6, -0.001_523_45, 0.0),
                inertia: Vector::new(0.052_161_5, 0.091_375_1, 0.043_714),
            }),
        },
        // Its mass is in the panel's.
        Part { density: 0.0, ..part(cuboid(0.075, 0.015, 0.02), bar) },
        0.3,
    )
}

/// A lever between two posts: hinge 0 to 1.75 rad, from level along y upwards.
pub fn lever() -> Model {
    let post = |x: f32| part(cuboid(0.025, 0.075, 0.025), at(x, 0.0, 0.025));
    let arm = Pose::from_parts(
        Vector::new(0.0, 0.075, 0.025),
        Rotation::from_rotation_x(std::f32::consts::FRAC_PI_2),
    );
    object(
        "lever",
        vec![part(cuboid(0.1, 0.1, 0.05), at(0.0, 0.0, -0.05)), post(0.04), post(-0.04)],
        Link {
            name: "arm".into(),
            parent: Some(0),
            place: Pose::IDENTITY,
            joint: Joint::Hinge(Axis {
                axis: Vector::X,
                anchor: Vector::new(0.0, 0.0, 0.025),
                range: Some([0.0, 1.75]),
                damping: 0.0,
                armature: 0.0,
                friction: 0.0,
            }),
            solids: vec![part(cylinder(0.075, 0.015), arm)],
            mass: None,
        },
        part(cuboid(0.015, 0.075, 0.015), at(0.0, 0.225, 0.025)),
        0.1,
    )
}

/// A carriage between two rails with a post to grip: slides 0 to 0.4 m along negative y.
pub fn slide() -> Model {
    let rail = |x: f32| part(cuboid(0.0125, 0.2, 0.0125), at(x, 0.1, 0.0425));
    object(
        "slide",
        vec![part(cuboid(0.05, 0.2, 0.0125), at(0.0, 0.1, 0.0125)), rail(0.0375), rail(-0.0375)],
        Link {
            name: "carriage".into(),
            parent: Some(0),
            place: Pose::IDENTITY,
            joint: Joint::Slide(Axis {
                axis: -Vector::Y,
                anchor: Vector::ZERO,
                range: Some([0.0, 0.4]),
                damping: 1.0,
                armature: 0.0,
                friction: 0.0,
            }),
            solids: vec![part(cuboid(0.0248, 0.05, 0.0125), at(0.0, 0.2, 0.0575))],
            mass: None,
        },
        part(cuboid(0.01, 0.01, 0.03), at(0.0, 0.2, 0.0975)),
        0.0,
    )
}

/// An object of a part that stands, one that moves, and a handle on that, on a table whose top is `depth` below
/// the object's origin.
fn object(name: &str, stands: Vec<Part>, moves: Link, handle: Part, depth: f32) -> Model {
    let fixed = |name: &str, parent, solids| Link {
        name: name.into(),
        parent,
        place: Pose::IDENTITY,
        joint: Joint::Fixed,
        solids,
        mass: None,
    };
    let board = part(Shape::Cuboid { half: BOARD }, at(0.0, 0.0, -depth - BOARD.z));
    let links = vec![
        fixed("base", None, stands),
        moves,
        fixed("handle", Some(MOVES), vec![handle]),
        fixed("table", Some(STANDS), vec![board]),
    ];
    Model { name: name.into(), links, actuators: Vec::new() }
}

fn part(shape: Shape, pose: Pose) -> Part {
    Part { shape, pose, density: DENSITY, friction: 1.0, solid: true }
}

fn cuboid(x: f32, y: f32, z: f32) -> Shape {
    Shape::Cuboid { half: Vector::new(x, y, z) }
}

fn cylinder(half_height: f32, radius: f32) -> Shape {
    Shape::Cylinder { half_height, radius }
}

fn at(x: f32, y: f32, z: f32) -> Pose {
    Pose::translation(x, y, z)
}
