//! Variable-stiffness impedance control of a pose, as robosuite's operational-space controller does it.

use rapier3d::math::{Pose, Rotation, Vector};

/// A spring and a critically damped damper between the hand and a goal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impedance {
    /// Where the hand is pulled to.
    pub goal: Pose,
    /// Accelerations for each metre and each radian of error, along and about the world's axes, 1/s².
    pub stiffness: [f32; 6],
}

impl Impedance {
    /// Holds a pose with no force.
    pub fn slack(at: Pose) -> Self {
        Self { goal: at, stiffness: [0.0; 6] }
    }

    /// Sets the goal a little ahead of where the hand is. Robosuite's rule: the position's goal is always
    /// relative to where the hand is now, so a zero shift lets it drift, while the orientation's goal stays what
    /// it was when the turn is exactly zero.
    pub fn shift(&mut self, from: Pose, shift: Vector, turn: Vector) {
        self.goal.translation = from.translation + shift;
        if turn != Vector::ZERO {
            self.goal.rotation = Rotation::from_scaled_axis(turn) * from.rotation;
        }
    }

    /// Linear and angular acceleration, in the world's frame, that the hand is to have.
    pub fn acceleration(&self, at: Pose, linear: Vector, angular: Vector) -> (Vector, Vector) {
        let [x, y, z, u, v, w] = self.stiffness;
        let (k, l) = (Vector::new(x, y, z), Vector::new(u, v, w));
        // Critical damping.
        let (c, d) = (2.0 * k.map(f32::sqrt), 2.0 * l.map(f32::sqrt));
        let turn = shorter(self.goal.rotation * at.rotation.inverse()).to_scaled_axis();
        (k * (self.goal.translation - at.translation) - c * linear, l * turn - d * angular)
    }
}

/// The same rotation by the quaternion that turns by at most half a circle.
fn shorter(rotation: Rotation) -> Rotation {
    if rotation.w < 0.0 { -rotation } else { rotation }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A free body of unit mass and inertia under the controller, 2 ms a step.
    fn settle(control: &Impedance, steps: usize) -> (Pose, f32) {
        let (mut at, mut linear, mut angular, mut beyond) =
            (Pose::IDENTITY, Vector::ZERO, Vector::ZERO, 0.0_f32);
        for _ in 0..steps {
            let (push, twist) = control.acceleration(at, linear, angular);
            linear += push * 0.002;
            angular += twist * 0.002;
            at.translation += linear * 0.002;
            at.rotation = (Rotation::from_scaled_axis(angular * 0.002) * at.rotation).normalize();
            beyond = beyond.max(at.translation.x - control.goal.translation.x);
        }
        (at, beyond)
    }

    #[test]
    fn the_goal_is_reached_without_passing_it() {
        let mut control = Impedance { goal: Pose::IDENTITY, stiffness: [150.0; 6] };
        control.shift(Pose::IDENTITY, Vector::new(0.05, -0.02, 0.01), Vector::new(0.3, -0.2, 0.1));
        let (at, beyond) = settle(&control, 1000);
        assert!((at.translation - control.goal.translation).length() < 1e-4);
        assert!(at.rotation.angle_between(control.goal.rotation) < 2e-3 && beyond < 1e-5, "{beyond}");
    }

    #[test]
    fn a_zero_turn_keeps_the_orientation_and_a_zero_shift_drifts() {
        let mut control = Impedance::slack(Pose::IDENTITY);
        let turned = Rotation::from_rotation_z(0.4);
        let here = Pose::from_parts(Vector::X, turned);
        control.shift(here, Vector::ZERO, Vector::ZERO);
        assert_eq!(control.goal, Pose::from_translation(Vector::X));
        control.shift(here, Vector::ZERO, Vector::Z * 0.1);
        assert!(control.goal.rotation.angle_between(Rotation::from_rotation_z(0.5)) < 1e-3);
    }

    #[test]
    fn no_stiffness_no_force() {
        let control = Impedance { goal: Pose::IDENTITY, stiffness: [0.0; 6] };
        let far = Pose::from_parts(Vector::ONE, Rotation::from_rotation_x(1.0));
        assert_eq!(control.acceleration(far, Vector::ONE, Vector::ONE), (Vector::ZERO, Vector::ZERO));
    }
}
