//! Candidate grasps: where hands may be when an episode starts.
//!
//! The thesis' candidates are grasps that a sampler proposed on the object's surface, five arm configurations
//! for each (section 5.2.2; 50 grasps x 5 in the authors' code). Ours are made by a rule over the object's
//! geometry: draw a point on a surface that fingers can span, then five wrists about it that collide with nothing.
//! Nothing in the rule asks whether the grasp is any good: some sit on what never moves, some barely catch an
//! edge, some miss.

use std::f32::consts::TAU;

use inroads_sim::{
    math,
    rigid::{
        Pose, Vector,
        hand::{Clearance, gripper},
    },
};
use rand::RngExt;

use super::{Task, TaskError};
use crate::{Rng, Seed};

/// Points, and wrists about each of them.
pub const POINTS: usize = 50;
/// See [`POINTS`].
pub const WRISTS: usize = 5;
/// Candidates of a task.
pub const GRASPS: usize = POINTS * WRISTS;

/// The spread of wrists about a point. Part of the fixture's name: other values are other candidates.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Spread {
    /// Greatest turn about the closing line against the point's direction of approach, radians.
    pub swing: f32,
    /// Greatest turn about the approach, radians: how far the fingers are from square.
    pub twist: f32,
    /// How far the pads may be behind the point (negative) or beyond it, along the approach, metres.
    pub depth: [f32; 2],
    /// How far the point may be from the middle between the fingers, metres.
    pub aside: f32,
    /// Room that the open hand keeps from everything, metres.
    pub margin: f32,
}

/// Wrists that are tried before a point is given up.
const TRIES: usize = 300;
/// Points that are tried before a task is given up.
const POINTS_TRIED: u64 = 1000;

/// A box that a hand can span, in the object's frame.
#[derive(Clone, Copy, Debug)]
pub struct Region {
    /// Its middle, metres.
    pub centre: [f32; 3],
    /// Half its sizes, metres.
    pub half: [f32; 3],
    /// Along which of the axes fingers can close on it.
    pub closings: &'static [usize],
}

impl Region {
    /// Area of the two faces that fingers close on along an axis, m².
    pub(super) fn area(&self, closing: usize) -> f32 {
        8.0 * self.half[(closing + 1) % 3] * self.half[(closing + 2) % 3]
    }
}

/// The candidates of a task: poses of the hand in the world, [`GRASPS`] of them, wrists about the same point one
/// after the other.
///
/// # Errors
/// [`TaskError`] when the task's numbers cannot be, or hands hardly fit anywhere.
pub fn grasps(task: &Task) -> Result<Vec<Pose>, TaskError> {
    task.check()?;
    let clearance = Clearance::new(&task.model());
    let mut found = Vec::with_capacity(GRASPS);
    for point in 0..POINTS_TRIED {
        if found.len() == GRASPS {
            return Ok(found);
        }
        let mut rng = Seed(0).stream(task.name, point);
        let wrist = point_on(task, &mut rng);
        let fits = |hand: &Pose| clearance.is_clear(*hand, gripper::OPEN, task.spread.margin);
        let wrists: Vec<_> =
            (0..TRIES).map(|_| task.place() * wrist(&mut rng)).filter(fits).take(WRISTS).collect();
        if wrists.len() == WRISTS {
            found.extend(wrists);
        }
    }
    Err(TaskError::Crowded { task: task.name, points: found.len() / WRISTS })
}

/// A point on a face, drawn by area, and what draws wrists about it.
fn point_on(task: &Task, rng: &mut Rng) -> impl Fn(&mut Rng) -> Pose + use<> {
    let faces = || task.regions.iter().flat_map(|r| r.closings.iter().map(move |&c| (r, c)));
    let mut left = rng.random_range(0.0..faces().map(|(r, c)| r.area(c)).sum());
    let chosen = faces().find(|(r, c)| {
        left -= r.area(*c);
        left < 0.0
    });
    // Rounding may leave a rest: then it is the last.
    let (region, closing) = chosen.or(faces().last()).expect("a checked task has faces");
    let axis = |i: usize| Vector::from_array(std::array::from_fn(|j| if i % 3 == j { 1.0 } else { 0.0 }));
    let (along, across) = (axis(closing + 1), axis(closing + 2));
    let middle = Vector::from_array(region.centre)
        + along * (region.half[(closing + 1) % 3] * rng.random_range(-1.0..1.0))
        + across * (region.half[(closing + 2) % 3] * rng.random_range(-1.0..1.0));
    let towards = rng.random_range(0.0..TAU);
    let spread = task.spread;
    // Either finger may be on either side.
    let closing = axis(closing) * if rng.random() { 1.0 } else { -1.0 };
    move |rng| {
        let mut within = |bound: f32| rng.random_range(-bound..bound);
        let (swing, twist, aside) =
            (towards + within(spread.swing), within(spread.twist), within(spread.aside));
        let depth = rng.random_range(spread.depth[0]..spread.depth[1]);
        let approach = along * math::cosf(swing) + across * math::sinf(swing);
        let sideways = closing * math::cosf(twist) + closing.cross(approach) * math::sinf(twist);
        gripper::pose(middle + approach * depth + closing * aside, approach, sideways)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::manipulation::{DOOR, LEVER, SLIDE};

    #[test]
    fn candidates_are_250_different_poses_that_touch_nothing() {
        for task in [&DOOR, &LEVER, &SLIDE] {
            let grasps = grasps(task).unwrap();
            assert_eq!(grasps.len(), 250);
            let clearance = Clearance::new(&task.model());
            assert!(grasps.iter().all(|hand| clearance.is_clear(*hand, gripper::OPEN, 0.001)));
            for (i, a) in grasps.iter().enumerate() {
                assert!(grasps[..i].iter().all(|b| a != b));
                assert!((a.rotation.length() - 1.0).abs() < 1e-4);
            }
            assert_eq!(grasps, super::grasps(task).unwrap(), "the same every time");
        }
    }

    #[test]
    fn a_task_that_no_hand_fits_is_refused() {
        let narrow = Task { spread: Spread { margin: 1.0, ..DOOR.spread }, ..DOOR };
        let error = grasps(&narrow).unwrap_err();
        assert_eq!(error, TaskError::Crowded { task: "door", points: 0 });
        let bare = Task { regions: &[], ..DOOR };
        assert_eq!(grasps(&bare).unwrap_err(), TaskError::Bare("door"));
        for aside in [0.0, f32::NAN] {
            let task = Task { spread: Spread { aside, ..DOOR.spread }, ..DOOR };
            assert_eq!(grasps(&task).unwrap_err(), TaskError::Spread("door"));
        }
    }

    #[test]
    fn wrists_lie_about_a_point_on_what_can_be_spanned() {
        for task in [&DOOR, &LEVER, &SLIDE] {
            let spread = task.spread;
            let most = spread.depth[0].abs().max(spread.depth[1]).hypot(spread.aside);
            for hand in grasps(task).unwrap() {
                let at = task.place().inverse() * hand.translation;
                let away = |region: &Region| {
                    let outside = |i: usize| ((at[i] - region.centre[i]).abs() - region.half[i]).max(0.0);
                    outside(0).hypot(outside(1)).hypot(outside(2))
                };
                assert!(task.regions.iter().any(|region| away(region) <= most + 1e-5), "{} {at}", task.name);
            }
        }
    }
}
