//! A gripper, an object, and the controller that moves the one against the other.

use rapier3d::math::{Pose, Rotation, Vector};

use super::clearance::{self, Placed};
use super::gripper::{FINGER_FORCE, FINGER_MASS, INERTIA, LEFT, MASS, RIGHT, gripper};
use super::{Impedance, objects::MOVES};
use crate::rigid::{
    Articulated, Contact, Limits, Model, ModelError, Party, Physics, PhysicsFault, Snapshot, StateError,
    Surroundings,
};
use crate::view::{Colour, Solid};

/// Seconds from one command to the next (robosuite's 20 Hz).
pub const CONTROL_STEP: f32 = 0.05;
/// How often the controller looks in that time. At 100 Hz the stiffest damper takes away a third of the speed a
/// look, so it is stable; robosuite looks at 500 Hz. Which grasps the oracle succeeds
/// from depends little on it: of the 250 of each task, at most 6 change at 200 Hz, at most 7 with twice the
/// sub-steps.
const LOOKS: u32 = 5;
/// Solver sub-steps between two looks.
const SUBSTEPS: u32 = 4;

/// Index of the gripper among the bodies.
const HAND: usize = 0;
/// Index of the object.
const OBJECT: usize = 1;

/// What the controller is told for one control step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Command {
    /// See [`Impedance::stiffness`]; not negative.
    pub stiffness: [f32; 6],
    /// From where the hand is to where it shall go, metres, along the world's axes.
    pub shift: Vector,
    /// How it shall turn, radians, about the world's axes: a rotation vector.
    pub turn: Vector,
    /// Force with which the fingers close (positive) or open, as a share of [`FINGER_FORCE`].
    pub grip: f32,
}

/// Where everything is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reading {
    /// Where the hand grips.
    pub hand: Pose,
    /// Velocity of that point, m/s, along the world's axes.
    pub linear: Vector,
    /// How the hand turns, rad/s, about the world's axes.
    pub angular: Vector,
    /// How far the left and the right finger are open, metres.
    pub fingers: [f32; 2],
    /// How fast they open, m/s.
    pub finger_speeds: [f32; 2],
    /// The object's joint, radians or metres.
    pub joint: f32,
    /// Its speed.
    pub joint_speed: f32,
}

/// A gripper and an object with one joint.
pub struct Workbench {
    bodies: Articulated,
    control: Impedance,
    /// Generalised forces: six of the hand, two fingers, the object's joint.
    forces: [f32; 9],
}

/// All that the future of a workbench depends on.
#[derive(Clone)]
pub struct Saved {
    bodies: Snapshot,
    control: Impedance,
}

impl Workbench {
    /// Puts a gripper, somewhere, and an object into a world. The object has a root that stands and a second link
    /// with the one joint.
    ///
    /// # Errors
    /// [`ModelError`] when the object cannot be built.
    pub fn new(object: &Model) -> Result<Self, ModelError> {
        let physics = Physics {
            control_step: CONTROL_STEP,
            calls: LOOKS,
            substeps: SUBSTEPS,
            relaxations: 1,
            prediction: 0.002,
            gravity: Physics::GRAVITY,
            limits: Limits::Hard,
        };
        let bodies = Articulated::new(&[gripper(), object.clone()], Surroundings::default(), physics)?;
        Ok(Self { bodies, control: Impedance::slack(Pose::IDENTITY), forces: [0.0; 9] })
    }

    /// Puts the hand somewhere, at rest, its fingers open by `opening` metres each and the object's joint at zero.
    ///
    /// # Errors
    /// [`StateError`] when a number is not finite.
    pub fn begin(&mut self, hand: Pose, opening: f32) -> Result<(), StateError> {
        let mut state = self.bodies.zero();
        let (at, turn) = (hand.translation, hand.rotation);
        state.q[..7].copy_from_slice(&[at.x, at.y, at.z, turn.w, turn.x, turn.y, turn.z]);
        state.q[7..9].fill(opening);
        self.bodies.restore(&state)?;
        self.control = Impedance::slack(hand);
        Ok(())
    }

    /// Carries out a command for one control step.
    ///
    /// # Errors
    /// [`PhysicsFault`] when a number is not finite or the simulation broke down.
    pub fn step(&mut self, command: &Command) -> Result<(), PhysicsFault> {
        self.control.shift(self.reading().hand, command.shift, command.turn);
        self.control.stiffness = command.stiffness;
        for _ in 0..LOOKS {
            self.push(command.grip);
            self.bodies.advance(&self.forces, CONTROL_STEP / LOOKS as f32, SUBSTEPS)?;
        }
        Ok(())
    }

    /// Computes the generalised forces: the controller's, and the hand's weight taken off it.
    fn push(&mut self, grip: f32) {
        let now = self.reading();
        let (linear, angular) = self.control.acceleration(now.hand, now.linear, now.angular);
        // All in the hand's frame from here on, but for the push; its y is the way that the left finger opens.
        let into = now.hand.rotation.inverse();
        let up = -self.bodies.physics().gravity;
        let lift = into * up * FINGER_MASS;
        let lean = (Vector::Y * (now.fingers[0] - now.fingers[1])).cross(lift);
        let push = linear * MASS + up * MASS;
        let twist = into * angular * INERTIA + lean;
        let close = grip * FINGER_FORCE;
        self.forces =
            [push.x, push.y, push.z, twist.x, twist.y, twist.z, lift.y - close, -lift.y - close, 0.0];
    }

    /// Where everything is.
    pub fn reading(&self) -> Reading {
        let state = self.bodies.configuration();
        let (q, v) = (&state.q, &state.v);
        let rotation = Rotation::from_xyzw(q[4], q[5], q[6], q[3]);
        Reading {
            hand: Pose::from_parts(Vector::new(q[0], q[1], q[2]), rotation),
            linear: Vector::new(v[0], v[1], v[2]),
            angular: rotation * Vector::new(v[3], v[4], v[5]),
            fingers: [q[7], q[8]],
            finger_speeds: [v[6], v[7]],
            joint: q[9],
            joint_speed: v[8],
        }
    }

    /// Forces between the object and the left and the right finger, N, along the contacts' normals.
    pub fn touch(&self) -> [f32; 2] {
        [LEFT, RIGHT].map(|finger| {
            let finger = Party::Link { model: HAND, link: finger };
            let of = |party| matches!(party, Party::Link { model: OBJECT, .. });
            let meets =
                |c: &Contact| (c.first == finger && of(c.second)) || (c.second == finger && of(c.first));
            self.bodies.contacts().filter(meets).map(|contact| contact.force).sum()
        })
    }

    /// Where the part of the object that moves has its frame.
    pub fn moving(&self) -> Pose {
        self.bodies.link_pose(OBJECT, MOVES)
    }

    /// How deep gripper and object are in each other, metres; 0 where they do not overlap.
    pub fn depth(&self) -> f32 {
        let (hand, object) = (self.placed(HAND), self.placed(OBJECT));
        let pairs = hand.iter().flat_map(|a| object.iter().map(move |b| clearance::depth(a, b)));
        pairs.fold(0.0, f32::max)
    }

    fn placed(&self, model: usize) -> Vec<Placed> {
        let links = self.bodies.models()[model].links.iter().enumerate();
        links.flat_map(|(l, link)| clearance::placed(link, self.bodies.link_pose(model, l))).collect()
    }

    /// Everything that the future depends on.
    pub fn save(&self) -> Saved {
        Saved { bodies: self.bodies.save(), control: self.control }
    }

    /// Goes back to what a workbench with the same object saved, to the bit.
    pub fn load(&mut self, saved: &Saved) {
        self.bodies.load(&saved.bodies);
        self.control = saved.control;
    }

    /// All solids where they are now, coloured by model (gripper, object) and link.
    pub fn solids(&self, colour: impl Fn(usize, usize) -> Colour) -> impl Iterator<Item = Solid> {
        self.bodies.solids(colour)
    }

    /// The gripper and the object.
    pub fn models(&self) -> &[Model] {
        self.bodies.models()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::hand::{gripper::OPEN, objects};

    /// Away from everything, palm downwards and askew.
    fn aloft() -> Pose {
        Pose::from_parts(
            Vector::new(0.0, 0.0, 1.5),
            Rotation::from_rotation_x(2.8) * Rotation::from_rotation_y(0.4),
        )
    }

    const STILL: Command =
        Command { stiffness: [0.0; 6], shift: Vector::ZERO, turn: Vector::ZERO, grip: 0.0 };

    #[test]
    fn the_hands_weight_is_taken_off_it() {
        let mut bench = Workbench::new(&objects::lever()).unwrap();
        bench.begin(aloft(), 0.02).unwrap();
        for _ in 0..40 {
            bench.step(&STILL).unwrap();
        }
        let now = bench.reading();
        assert!((now.hand.translation - aloft().translation).length() < 1e-3, "{now:?}");
        assert!(now.hand.rotation.angle_between(aloft().rotation) < 1e-2, "{now:?}");
        assert!(now.fingers.iter().all(|open| (open - 0.02).abs() < 1e-3), "{now:?}");
    }

    #[test]
    fn fingers_close_at_a_fifth_of_a_metre_a_second_and_stop_where_they_meet() {
        let mut bench = Workbench::new(&objects::door()).unwrap();
        bench.begin(aloft(), OPEN).unwrap();
        bench.step(&Command { grip: 1.0, ..STILL }).unwrap();
        bench.step(&Command { grip: 1.0, ..STILL }).unwrap();
        assert!(bench.reading().finger_speeds.iter().all(|speed| (speed + 0.2).abs() < 0.01));
        for _ in 0..10 {
            bench.step(&Command { grip: 1.0, ..STILL }).unwrap();
        }
        assert!(bench.reading().fingers.iter().all(|open| open.abs() < 1e-3), "{:?}", bench.reading());
        assert_eq!(bench.touch(), [0.0; 2]);
    }

    #[test]
    fn a_stiff_hand_follows_its_goal_and_a_turn_leaves_it_where_it_is() {
        let mut bench = Workbench::new(&objects::slide()).unwrap();
        bench.begin(aloft(), OPEN).unwrap();
        let go = Command { stiffness: [300.0; 6], shift: Vector::new(0.0, 0.025, 0.0), ..STILL };
        for _ in 0..20 {
            bench.step(&go).unwrap();
        }
        let moved = bench.reading();
        // The goal runs ahead by 2.5 cm; spring and damper balance at 300 x 0.025 / (2 sqrt 300) m/s at most.
        assert!((0.12..0.22).contains(&moved.linear.y) && moved.linear.x.abs() < 1e-3, "{moved:?}");
        assert!(moved.hand.rotation.angle_between(aloft().rotation) < 1e-2);
        let turn = Command { stiffness: [300.0; 6], turn: Vector::Z * 0.25, ..STILL };
        bench.begin(aloft(), OPEN).unwrap();
        for _ in 0..20 {
            bench.step(&turn).unwrap();
        }
        let turned = bench.reading();
        assert!((1.0..2.2).contains(&turned.angular.z), "{turned:?}");
        assert!((turned.hand.translation - aloft().translation).length() < 5e-3, "{turned:?}");
    }

    #[test]
    fn a_command_without_numbers_is_refused() {
        let mut bench = Workbench::new(&objects::door()).unwrap();
        bench.begin(aloft(), OPEN).unwrap();
        assert!(bench.step(&Command { grip: f32::NAN, ..STILL }).is_err());
        let nowhere = Pose::from_translation(Vector::new(f32::NAN, 0.0, 0.0));
        assert!(bench.begin(nowhere, OPEN).is_err());
    }
}
