//! The two-link arm of Gymnasium's Reacher: rigid links in a plane, each with a motor at its joint.
//!
//! Sizes, rotor inertia, damping and gear are those of Gymnasium's `reacher.xml`. The rotors (1 kg m²) outweigh
//! the links (some 10⁻⁴ kg m²), so the joints hardly feel each other. The second joint's limit is soft, as MuJoCo
//! has it: at 14 rad/s it gives by 0.1 rad and throws the joint back at an eighth of its speed. Rapier's limits do
//! neither, which puts the joint off by 14 % of its travel in the recorded episodes; so the limit is a torque of
//! ours here.

use rapier3d::math::{Pose, Vector};

use super::{
    Actuator, Articulated, Axis, Configuration, Joint, Limits, Link, Model, Part, Physics, PhysicsFault,
    StateError, Surroundings,
};
use crate::{
    Shape,
    view::{Colour, Solid},
};

/// From one action to the next, seconds: two of MuJoCo's time steps.
pub const CONTROL_STEP: f32 = 0.02;
/// Length of each link, metres.
pub const LENGTH: f32 = 0.1;
/// From the second joint to the middle of the fingertip, metres.
pub const FINGERTIP: f32 = 0.11;
/// Torque of control 1, N m.
pub const GEAR: f32 = 200.0;
/// The second joint stays between minus and plus this, radians, but for what its soft limit gives.
pub const BEND: f32 = 3.0;

/// Radius of links and fingertip, metres.
const RADIUS: f32 = 0.01;
/// Height of the arm above the table, metres.
const HEIGHT: f32 = 0.01;
/// Density, kg/m³ (MuJoCo's default).
const DENSITY: f32 = 1000.0;
/// Rotor inertia of each joint, kg m².
const ARMATURE: f32 = 1.0;
/// Damping of each joint, N m s.
const DAMPING: f32 = 1.0;
/// Solver sub-steps in a control step. Semi-implicit Euler is half a sub-step late in its positions: with 16 that
/// is at most 0.7 % of a joint's travel in the recorded episodes, with 8 it is 1.2 %, with 4 2.9 %.
const SUBSTEPS: u32 = 16;

/// MuJoCo's soft limits: the joint decelerates as −b v − k r, with the speed v against the limit and the angle r
/// beyond it. Both follow from the time constant 0.02 s, the damping ratio 1 and the impedance (`solref` and
/// `solimp`, whose defaults the file keeps).
const IMPEDANCE: f32 = 0.95;
const STIFFNESS: f32 = 1.0 / (IMPEDANCE * IMPEDANCE * 0.02 * 0.02);
const RESISTANCE: f32 = 2.0 / (IMPEDANCE * 0.02);

/// The arm as data.
pub fn model() -> Model {
    let solid = |shape, x| Part {
        shape,
        pose: Pose::from_translation(Vector::X * x),
        density: DENSITY,
        friction: 1.0,
        solid: false,
    };
    let link = || solid(Shape::Capsule { from: Vector::ZERO, to: Vector::X * LENGTH, radius: RADIUS }, 0.0);
    let joint = |range| {
        Joint::Hinge(Axis {
            axis: Vector::Z,
            anchor: Vector::ZERO,
            range,
            damping: DAMPING,
            armature: ARMATURE,
            friction: 0.0,
        })
    };
    Model {
        name: "reacher".to_owned(),
        links: vec![
            Link {
                name: "body0".to_owned(),
                parent: None,
                place: Pose::from_translation(Vector::Z * HEIGHT),
                joint: joint(None),
                solids: vec![link()],
                mass: None,
            },
            Link {
                name: "body1".to_owned(),
                parent: Some(0),
                place: Pose::from_translation(Vector::X * LENGTH),
                joint: joint(Some([-BEND, BEND])),
                solids: vec![link(), solid(Shape::Ball { radius: RADIUS }, FINGERTIP)],
                mass: None,
            },
        ],
        actuators: vec![Actuator { link: 0, gear: GEAR }, Actuator { link: 1, gear: GEAR }],
    }
}

/// The arm, in a world without a floor.
pub struct Arm {
    world: Articulated,
}

impl Default for Arm {
    fn default() -> Self {
        Self::new()
    }
}

impl Arm {
    /// An arm stretched along x, at rest.
    pub fn new() -> Self {
        let mut model = model();
        // Ours, in `limit`.
        if let Joint::Hinge(axis) = &mut model.links[1].joint {
            axis.range = None;
        }
        let physics = Physics {
            control_step: CONTROL_STEP,
            calls: 1,
            substeps: SUBSTEPS,
            relaxations: 1,
            // Nothing touches anything.
            prediction: 0.01,
            gravity: Physics::GRAVITY,
            limits: Limits::Hard,
        };
        let world = Articulated::new(&[model], Surroundings::default(), physics);
        Self { world: world.expect("the arm is well formed") }
    }

    /// Angles and angular velocities of the two joints, radians and radians a second. Angles are not wrapped.
    pub fn state(&self) -> &Configuration {
        self.world.configuration()
    }

    /// Takes up a state; what follows depends on it and on nothing that came before.
    ///
    /// # Errors
    /// [`StateError`] when there are not two angles and two velocities, all finite.
    pub fn restore(&mut self, to: &Configuration) -> Result<(), StateError> {
        self.world.restore(to)
    }

    /// One control step. Controls beyond [-1, 1] count as the nearest of the two.
    ///
    /// # Errors
    /// [`PhysicsFault`] when a control is not finite, or the simulation broke down.
    pub fn step(&mut self, controls: [f32; 2]) -> Result<(), PhysicsFault> {
        let state = self.state();
        // How far the joint can get within the step, and a little more.
        let reach = state.v[1].abs() * CONTROL_STEP + GEAR / ARMATURE * CONTROL_STEP * CONTROL_STEP;
        if state.q[1].abs() + reach < BEND || controls.iter().any(|control| !control.is_finite()) {
            return self.world.step(&controls);
        }
        let [shoulder, elbow] = controls.map(|control| GEAR * control.clamp(-1.0, 1.0));
        let seconds = CONTROL_STEP / SUBSTEPS as f32;
        (0..SUBSTEPS).try_for_each(|_| {
            let state = self.state();
            let limit = limit(state.q[1], state.v[1], elbow, seconds);
            self.world.advance(&[shoulder, elbow + limit], seconds, 1)
        })
    }

    /// Where the fingertip is, metres from the first joint.
    pub fn fingertip(&self) -> [f32; 2] {
        let tip = self.world.link_pose(0, 1).transform_point(Vector::X * FINGERTIP);
        [tip.x, tip.y]
    }

    /// Its solids where they are now, coloured by link.
    pub fn solids(&self, colour: impl Fn(usize) -> Colour) -> impl Iterator<Item = Solid> {
        self.world.solids(move |_, link| colour(link))
    }
}

/// Torque of the second joint's limit over the next `seconds`, N m, at an angle and a speed and under a motor's
/// torque. It is such that the acceleration is MuJoCo's mixture of the free one and the limit's, by impedance; and
/// implicit in the speed, which keeps it stable at any length of step.
fn limit(angle: f32, speed: f32, torque: f32, seconds: f32) -> f32 {
    let beyond = angle.abs() - BEND;
    if beyond <= 0.0 {
        return 0.0;
    }
    let out = angle.signum();
    let (speed, free) = (out * speed, out * (torque - DAMPING * speed) / ARMATURE);
    let wanted = -RESISTANCE * speed - STIFFNESS * (beyond + seconds * speed);
    let implicit = 1.0 + IMPEDANCE * seconds * (RESISTANCE + STIFFNESS * seconds);
    let mixed = ((1.0 - IMPEDANCE) * free + IMPEDANCE * wanted) / implicit;
    // A limit only pushes back.
    out * ARMATURE * (mixed - free).min(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(q: [f32; 2], v: [f32; 2]) -> Configuration {
        Configuration { q: q.to_vec(), v: v.to_vec() }
    }

    #[test]
    fn the_fingertip_is_where_trigonometry_puts_it() {
        let mut arm = Arm::new();
        let [x, y] = arm.fingertip();
        assert!((x - 0.21).abs() < 1e-6 && y == 0.0, "stretched along x, {x} {y}");
        arm.restore(&at([0.4, -1.3], [0.0; 2])).unwrap();
        let [x, y] = arm.fingertip();
        let (a, b) = (0.4_f32, 0.4_f32 - 1.3);
        assert!((x - LENGTH * a.cos() - FINGERTIP * b.cos()).abs() < 1e-6);
        assert!((y - LENGTH * a.sin() - FINGERTIP * b.sin()).abs() < 1e-6);
    }

    #[test]
    fn the_elbow_stops_where_mujoco_stops_it() {
        let mut arm = Arm::new();
        arm.restore(&at([0.0, 2.8], [0.0, 14.0])).unwrap();
        let angles: Vec<_> = (0..25).map(|_| (arm.step([0.0; 2]).unwrap(), arm.state().q[1]).1).collect();
        let most = angles.iter().copied().fold(0.0, f32::max);
        // MuJoCo 4.0 from the same state, seen every 0.02 s: up to 3.096, and 2.417 in the end, with a time step of
        // 1 ms; 3.073 and 2.561 with the file's 10 ms.
        assert!((most - 3.096).abs() < 0.02, "gave to {most}");
        assert!((angles[24] - 2.417).abs() < 0.05, "came back to {}", angles[24]);
    }

    #[test]
    fn motors_turn_the_joints_as_fast_as_their_inertia_says() {
        let mut arm = Arm::new();
        arm.step([0.5, 0.0]).unwrap();
        // 100 N m on 1 kg m² and damping 1 for 0.02 s.
        let speed = 100.0 * (1.0 - (-0.02_f32).exp());
        assert!((arm.state().v[0] / speed - 1.0).abs() < 2e-3, "{} {speed}", arm.state().v[0]);
        assert!(arm.state().v[1].abs() < 1e-2);
        arm.step([f32::NAN, 0.0]).unwrap_err();
    }

    #[test]
    fn what_follows_a_restore_does_not_depend_on_what_came_before() {
        let run = |before: f32| {
            let mut arm = Arm::new();
            (0..20).for_each(|_| arm.step([before, -before]).unwrap());
            arm.restore(&at([1.0, 2.9], [-3.0, 9.0])).unwrap();
            (0..20).for_each(|i| arm.step([0.3, (i % 3) as f32 - 1.0]).unwrap());
            arm.state().clone()
        };
        assert_eq!(run(0.9), run(-0.2));
    }
}
