//! The 52 numbers that an agent sees.
//!
//! They are those of the fork of robosuite (proprioception 32, raw joint angles 7, object 13). The free hand has
//! no arm, so seven coordinates of the hand stand where the fork has seven joint angles: where the hand is (x, y, z
//! from the object's origin, metres), how it is turned from the task's upright hand (a rotation vector about the
//! world's axes, radians), and how wide it is open (metres).

use inroads_sim::{
    math,
    rigid::{Pose, Rotation, Vector, hand::Reading, hand::gripper},
};

use super::Task;
use crate::{Dimension, Space};

/// Numbers in an observation.
pub const LENGTH: usize = 52;
/// Where the hand's position is among them: x, y, z in the world, metres.
pub const HAND: usize = 21;
/// Where the handle's way from the hand begins: x, y, z, metres.
pub const HANDLE_TO_HAND: usize = 48;
/// Where the object's joint is among them: radians or metres.
pub const JOINT: usize = 51;

/// How far from the handle a hand may be sent, metres along each axis of the world.
pub(super) const REACH: f32 = 0.6;

/// Writes the observation.
pub(super) fn observe(task: &Task, now: &Reading, moving: Pose, out: &mut Vec<f32>) {
    let place = task.place();
    let at = now.hand.translation;
    let handle = moving * Vector::from_array(task.handle);
    let [a, b] = task.upright.map(Vector::from_array);
    let upright = place.rotation * gripper::pose(Vector::ZERO, a, b).rotation;
    let quaternion = canonical(now.hand.rotation.to_array());
    let turned = canonical((now.hand.rotation * upright.inverse()).to_array());
    let turned = Rotation::from_array(turned).to_scaled_axis();
    let from = at - place.translation;
    let [left, right] = now.fingers;
    let joints = [from.x, from.y, from.z, turned.x, turned.y, turned.z, left + right];
    let (v, w) = (now.linear, now.angular);

    out.clear();
    out.extend(joints.map(math::cosf));
    out.extend(joints.map(math::sinf));
    out.extend([v.x, v.y, v.z, w.x, w.y, w.z, now.finger_speeds[0] + now.finger_speeds[1]]);
    out.extend(at.to_array());
    out.extend(quaternion);
    // Robosuite's fingers open in opposite directions.
    out.extend([left, -right, now.finger_speeds[0], -now.finger_speeds[1]]);
    out.extend(joints);
    out.extend(place.translation.to_array());
    out.extend(handle.to_array());
    out.extend((place.translation - at).to_array());
    out.extend((handle - at).to_array());
    out.push(now.joint);
}

/// The quaternion (x, y, z, w) of the same rotation whose w is not negative.
fn canonical(quaternion: [f32; 4]) -> [f32; 4] {
    if quaternion[3] < 0.0 { quaternion.map(|x| -x) } else { quaternion }
}

/// The observation's space, with the ranges that hands and objects usually keep.
pub(super) fn space(task: &Task) -> Space {
    const COS: [&str; 7] = ["cos_x", "cos_y", "cos_z", "cos_rx", "cos_ry", "cos_rz", "cos_open"];
    const SIN: [&str; 7] = ["sin_x", "sin_y", "sin_z", "sin_rx", "sin_ry", "sin_rz", "sin_open"];
    let line = Dimension::linear;
    let mut all = Vec::with_capacity(LENGTH);
    all.extend(COS.map(|name| line(name, "", -1.0, 1.0)));
    all.extend(SIN.map(|name| line(name, "", -1.0, 1.0)));
    all.extend(["vx", "vy", "vz"].map(|name| line(name, "m/s", -1.0, 1.0)));
    all.extend(["wx", "wy", "wz"].map(|name| line(name, "rad/s", -4.0, 4.0)));
    all.push(line("opening", "m/s", -0.4, 0.4));
    let around = |centre: [f32; 3], names: [&'static str; 3]| {
        std::array::from_fn::<_, 3, _>(|i| line(names[i], "m", centre[i] - REACH, centre[i] + REACH))
    };
    let handle = (task.place() * Vector::from_array(task.handle)).to_array();
    all.extend(around(handle, ["hand_x", "hand_y", "hand_z"]));
    all.extend(["qx", "qy", "qz", "qw"].map(|name| line(name, "", -1.0, 1.0)));
    all.push(line("left", "m", 0.0, gripper::OPEN));
    all.push(line("right", "m", -gripper::OPEN, 0.0));
    all.extend(["left_speed", "right_speed"].map(|name| line(name, "m/s", -0.2, 0.2)));
    let offset: [f32; 3] = std::array::from_fn(|i| handle[i] - task.at[i]);
    all.extend(around(offset, ["x", "y", "z"]));
    all.extend(["rx", "ry", "rz"].map(|name| line(name, "rad", -std::f32::consts::PI, std::f32::consts::PI)));
    all.push(line("open", "m", 0.0, 2.0 * gripper::OPEN));
    all.extend(around(task.at, ["object_x", "object_y", "object_z"]));
    all.extend(around(handle, ["handle_x", "handle_y", "handle_z"]));
    all.extend(around(offset.map(|x| -x), ["object_dx", "object_dy", "object_dz"]));
    all.extend(around([0.0; 3], ["handle_dx", "handle_dy", "handle_dz"]));
    let unit = if matches!(task.path, super::Path::Shift(_)) { "m" } else { "rad" };
    all.push(line("joint", unit, 0.0, task.end));
    Space::Box(all.into())
}
