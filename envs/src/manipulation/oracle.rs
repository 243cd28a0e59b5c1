//! A controller that knows how the object moves, and so tells which grasps can succeed.

use inroads_sim::rigid::{Rotation, Vector};

use super::observe::{HAND, HANDLE_TO_HAND};
use super::{LIMIT, Manipulation, Path, Task};
use crate::{End, Environment, Step, Sweep};

/// How far the hand is sent ahead along its path, metres: as far as the action space allows.
const AHEAD: f32 = 0.025;
/// Greatest turn that it is sent ahead, radians.
const TURN: f32 = 0.1;
/// Where the hand is farther from the handle than this, metres, it has lost the object and stands still. Without
/// this it would go on in a circle and come upon a door from behind.
const LOST: f32 = 0.25;

/// What the oracle does where it sees this: all stiff, fingers closed, the hand moves as if it were welded to the
/// part of the object that moves. It never lets go and never looks for a better grasp.
pub fn act(task: &Task, observation: &[f32]) -> Vec<f32> {
    let frame = task.place();
    let hand = Vector::from_slice(&observation[HAND..HAND + 3]);
    let gap = Vector::from_slice(&observation[HANDLE_TO_HAND..HANDLE_TO_HAND + 3]);
    let (shift, turn) = match task.path {
        _ if gap.length() > LOST => (Vector::ZERO, Vector::ZERO),
        Path::Shift(direction) => (frame.rotation * Vector::from_array(direction) * AHEAD, Vector::ZERO),
        Path::Turn { axis, through } => {
            let axis = frame.rotation * Vector::from_array(axis);
            let arm = hand - frame * Vector::from_array(through);
            // No farther than the shift allows at this distance from the axis.
            let angle = (AHEAD / axis.cross(arm).length().max(1e-3)).min(TURN);
            (Rotation::from_axis_angle(axis, angle) * arm - arm, axis * angle)
        }
    };
    let (shift, turn) = (shift / super::SHIFT, turn / super::TURN);
    let mut action = vec![1.0; 13];
    for (i, x) in [shift.x, shift.y, shift.z, turn.x, turn.y, turn.z].into_iter().enumerate() {
        action[6 + i] = x.clamp(-1.0, 1.0);
    }
    action
}

/// Whether the oracle, from this grasp, succeeds within the time limit.
///
/// What it cannot do may still be possible: a hand that lets go, moves and grips again can reach any handle. The
/// oracle's answer is about the grasp.
pub fn succeeds(env: &mut Manipulation, grasp: usize) -> bool {
    env.begin(grasp);
    let mut seen = Vec::new();
    for _ in 0..LIMIT {
        env.observe(&mut seen);
        match env.step(&act(env.task(), &seen)) {
            Ok(Step { end: Some(end), .. }) => return end == End::Terminated,
            Ok(_) => {}
            Err(_) => return false,
        }
    }
    false
}
