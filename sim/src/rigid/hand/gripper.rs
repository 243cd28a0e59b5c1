//! A two-finger gripper that flies freely: what stands in for a Panda arm and its hand.
//!
//! Its frame is that of the grip site, between the finger pads: z points out of the palm, y is the line along
//! which the fingers close. The left finger is the one on the side of positive y.
//!
//! Sizes are those of the Panda's hand in robosuite (`panda_gripper.xml`), its meshes replaced by boxes.

use rapier3d::glamx::Mat3;
use rapier3d::math::{Pose, Rotation, Vector};

use crate::Shape;
use crate::rigid::{Axis, Joint, Link, Mass, Model, Part};

/// How far a finger is from the middle when it is wide open, metres (the fork of robosuite resets fingers to
/// ±0.05; the hand's own limit is 0.04).
pub const OPEN: f32 = 0.05;
/// Greatest force of a finger, N (robosuite).
pub const FINGER_FORCE: f32 = 20.0;
/// What the hand weighs where it grips, kg: the operational-space inertia that an arm would show there. The
/// Panda's is 2 to 5 kg, depending on its pose; this one is the same in all poses and directions.
pub const MASS: f32 = 3.0;
/// What the hand resists turning where it grips, kg m², in all directions.
pub const INERTIA: f32 = 0.05;
/// Index of the left finger's link.
pub const LEFT: usize = 1;
/// Index of the right finger's link.
pub const RIGHT: usize = 2;
/// Half the sizes of a finger's pad, metres (robosuite's fingertip).
pub const PAD: Vector = Vector::new(0.008, 0.004, 0.008);

/// Mass of a finger, kg (robosuite).
pub(super) const FINGER_MASS: f32 = 0.1;
/// Damping of a finger, N s/m (robosuite): at full force it moves at 0.2 m/s.
const FINGER_DAMPING: f32 = 100.0;
/// Sliding friction of pads, and of all else (robosuite).
const FRICTION: [f32; 2] = [2.0, 1.0];
/// Half the sizes of a finger behind its pad, metres.
const FINGER: Vector = Vector::new(0.01, 0.006, 0.027);
/// Half the sizes of the palm, metres.
const PALM: Vector = Vector::new(0.0315, 0.102, 0.033);
/// Radius of the wrist behind the palm, metres.
const WRIST: f32 = 0.045;

/// The gripper's links: hand, left finger, right finger. Its joints in order: six of the free hand, then how far
/// the left and the right finger are open, metres, 0 to [`OPEN`].
pub fn gripper() -> Model {
    let knuckles = 0.008 - 2.0 * FINGER.z;
    let palm = at(Vector::Z * (knuckles - PALM.z));
    // The wrist starts 2 mm inside the palm, so that nothing slips between them.
    let wrist = |depth: f32| Vector::Z * (knuckles - 2.0 * PALM.z - WRIST - depth + 0.002);
    let hand = Link {
        name: "hand".into(),
        parent: None,
        place: Pose::IDENTITY,
        joint: Joint::Free,
        solids: vec![
            part(Shape::Cuboid { half: PALM }, palm, FRICTION[1]),
            part(
                Shape::Capsule { from: wrist(0.0), to: wrist(0.06), radius: WRIST },
                Pose::IDENTITY,
                FRICTION[1],
            ),
        ],
        mass: Some(Mass {
            mass: MASS - 2.0 * FINGER_MASS,
            place: Pose::IDENTITY,
            inertia: Vector::splat(INERTIA),
        }),
    };
    Model {
        name: "gripper".into(),
        links: vec![hand, finger("left finger", 1.0), finger("right finger", -1.0)],
        actuators: Vec::new(),
    }
}

/// A finger on the side of y that `side` names.
fn finger(name: &str, side: f32) -> Link {
    let outward = Vector::Y * side;
    let body = at(outward * (2.0 * PAD.y + FINGER.y) + Vector::Z * (0.008 - FINGER.z));
    Link {
        name: name.into(),
        parent: Some(0),
        place: Pose::IDENTITY,
        joint: Joint::Slide(Axis {
            axis: outward,
            anchor: Vector::ZERO,
            range: Some([0.0, OPEN]),
            damping: FINGER_DAMPING,
            armature: 0.0,
            friction: 0.0,
        }),
        solids: vec![
            part(Shape::Cuboid { half: PAD }, at(outward * PAD.y), FRICTION[0]),
            part(Shape::Cuboid { half: FINGER }, body, FRICTION[1]),
        ],
        // Of a rod of the finger's length, about its middle; placed where the pads meet, so that the hand's
        // centre of mass is where it grips.
        mass: Some(Mass {
            mass: FINGER_MASS,
            place: Pose::IDENTITY,
            inertia: Vector::splat(FINGER_MASS * FINGER.z * FINGER.z / 3.0),
        }),
    }
}

/// The pose of a hand that grips at a point, with its palm behind the point against `approach` and its fingers
/// closing along `closing`: two directions at right angles, of length 1.
pub fn pose(point: Vector, approach: Vector, closing: Vector) -> Pose {
    let rotation = Rotation::from_mat3(&Mat3::from_cols(closing.cross(approach), closing, approach));
    Pose::from_parts(point, rotation)
}

fn part(shape: Shape, pose: Pose, friction: f32) -> Part {
    Part { shape, pose, density: 0.0, friction, solid: true }
}

fn at(translation: Vector) -> Pose {
    Pose::from_translation(translation)
}
