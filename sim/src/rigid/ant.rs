//! MuJoCo's ant: a ball with four legs of two hinges each, as in Gymnasium's `ant.xml`.
//!
//! Body, masses, joints and the order of actuators and coordinates are those of the file; `THESIS` and
//! `GYMNASIUM` are the two ways in which it has been run. How close both come to MuJoCo is measured by
//! `tests/conformance_ant.rs`.

use rapier3d::math::{Pose, Vector};

use super::{
    Actuator, Articulated, Axis, CellMap, Joint, Limits, Link, Model, ModelError, Part, Physics, Surroundings,
};
use crate::Shape;

/// How the ant is run.
#[derive(Clone, Debug, PartialEq)]
pub struct Preset {
    /// How time passes.
    pub physics: Physics,
    /// Torque of control 1, N m.
    pub gear: f32,
    /// Height of the floor, metres.
    pub floor: f32,
}

/// As in the thesis, D4RL and efficient HRL: ten actions a second, 30 N m. MuJoCo's time step is 20 ms there.
pub const THESIS: Preset = Preset {
    physics: Physics {
        control_step: 0.1,
        calls: 1,
        substeps: 3,
        relaxations: 2,
        prediction: 0.3,
        gravity: Physics::GRAVITY,
        limits: Limits::Springy { time_constant: 0.04 },
    },
    gear: 30.0,
    floor: FLOOR,
};

/// As in Gymnasium's Ant-v2 to v5: twenty actions a second, 150 N m. MuJoCo's time step is 10 ms there.
pub const GYMNASIUM: Preset = Preset {
    physics: Physics {
        control_step: 0.05,
        calls: 2,
        substeps: 4,
        relaxations: 2,
        prediction: 0.2,
        gravity: Physics::GRAVITY,
        limits: Limits::Springy { time_constant: 0.02 },
    },
    gear: 150.0,
    floor: FLOOR,
};

/// MuJoCo's contacts push from 20 mm before they touch, the margins of foot and floor, and are soft: feet stand
/// 17 to 20 mm above the floor. Ours are hard, but found once in a call: where a foot rolls in the meantime, it
/// ends up to 10 mm too low. So the floor is raised by about the middle.
const FLOOR: f32 = 0.0175;
/// kg/m³ of everything.
const DENSITY: f32 = 5.0;
/// Radius of the torso, metres.
const TORSO: f32 = 0.25;
/// Height of the torso's middle at the start, metres.
const START: f32 = 0.75;
/// Radius of the legs, metres.
const LEG: f32 = 0.08;
/// Reach of a limb's upper parts along x and along y, metres; the foot is twice as long.
const REACH: f32 = 0.2;
/// Rotor inertia (kg m²) and damping (N m s) of every hinge.
const HINGE: f32 = 1.0;
/// How far hips turn either way, degrees.
const HIP: f32 = 30.0;
/// How far ankles bend at least and at most, degrees.
const ANKLE: [f32; 2] = [30.0, 70.0];
/// The direction of legs 1 to 4 (front left, front right, back left, back right), and the axis and sense of
/// their ankles.
const LEGS: [([f32; 2], [f32; 2], f32); 4] = [
    ([1.0, 1.0], [-1.0, 1.0], 1.0),
    ([-1.0, 1.0], [1.0, 1.0], -1.0),
    ([-1.0, -1.0], [-1.0, 1.0], -1.0),
    ([1.0, -1.0], [1.0, 1.0], 1.0),
];
/// The legs in the order of the actuators.
const DRIVEN: [usize; 4] = [3, 0, 1, 2];

/// The ant, whose controls of 1 are torques of `gear` N m.
///
/// State: 15 positions and 14 velocities, the root's and then hip and ankle of legs 1 to 4. Controls: hip and
/// ankle of legs 4, 1, 2, 3.
pub fn model(gear: f32) -> Model {
    let torso = Link {
        name: "torso".into(),
        parent: None,
        place: Pose::from_translation(Vector::Z * START),
        joint: Joint::Free,
        solids: vec![part(Shape::Ball { radius: TORSO })],
        mass: None,
    };
    let mut links = vec![torso];
    for (leg, (towards, axis, sense)) in LEGS.into_iter().enumerate() {
        let reach = Vector::new(towards[0], towards[1], 0.0) * REACH;
        let ankle = Vector::new(axis[0], axis[1], 0.0).normalize();
        let bend = ANKLE.map(|degrees| (sense * degrees).to_radians());
        let bend = if sense > 0.0 { bend } else { [bend[1], bend[0]] };
        let hip = HIP.to_radians();
        let root = links.len();
        let limb = |part, parent, place, joint, length| Link {
            name: format!("{part} {}", leg + 1),
            parent: Some(parent),
            place: Pose::from_translation(place),
            joint,
            solids: vec![capsule(length)],
            mass: None,
        };
        links.push(limb("thigh", 0, Vector::ZERO, Joint::Fixed, reach));
        links.push(limb("shin", root, reach, hinge(Vector::Z, [-hip, hip]), reach));
        links.push(limb("foot", root + 1, reach, hinge(ankle, bend), 2.0 * reach));
    }
    let driven = DRIVEN.into_iter().flat_map(|leg| [3 * leg + 2, 3 * leg + 3]);
    let actuators = driven.map(|link| Actuator { link, gear }).collect();
    Model { name: "ant".into(), links, actuators }
}

/// An ant on its floor, between walls if there are any, at the file's start: all joints at zero, which is outside
/// the range of the ankles, so that they are thrown out and the ant hops.
///
/// # Errors
/// [`ModelError`] when `preset` is not one of ours and cannot be simulated.
pub fn world(preset: &Preset, walls: Option<&CellMap>) -> Result<Articulated, ModelError> {
    let around = Surroundings { floor: Some(preset.floor), walls };
    Articulated::new(&[model(preset.gear)], around, preset.physics.clone())
}

fn hinge(axis: Vector, range: [f32; 2]) -> Joint {
    Joint::Hinge(Axis {
        axis,
        anchor: Vector::ZERO,
        range: Some(range),
        damping: HINGE,
        armature: HINGE,
        friction: 0.0,
    })
}

fn capsule(to: Vector) -> Part {
    part(Shape::Capsule { from: Vector::ZERO, to, radius: LEG })
}

fn part(shape: Shape) -> Part {
    Part { shape, pose: Pose::IDENTITY, density: DENSITY, friction: 1.0, solid: true }
}
