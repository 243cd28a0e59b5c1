//! Whether an open hand fits somewhere, and how deep bodies are in each other.

use rapier3d::math::{Pose, Vector};
use rapier3d::parry::query;
use rapier3d::prelude::SharedShape;

use super::gripper::{PAD, gripper};
use crate::rigid::{Joint, Link, Model, articulated::solid};

/// A solid and where it is.
pub(super) type Placed = (Pose, SharedShape);

/// An object with its joint at zero, and hands that are held against it.
pub struct Clearance {
    gripper: Model,
    object: Vec<Placed>,
}

impl Clearance {
    /// Of an object.
    pub fn new(object: &Model) -> Self {
        // Parents stand before their children, so their places are known.
        let mut places = Vec::<Pose>::with_capacity(object.links.len());
        for link in &object.links {
            let base = link.parent.map_or(Pose::IDENTITY, |parent| places[parent]);
            places.push(base * link.place);
        }
        let object =
            object.links.iter().zip(&places).flat_map(|(link, &place)| placed(link, place)).collect();
        Self { gripper: gripper(), object }
    }

    /// Whether a hand with its fingers open by `opening` metres each stays `margin` metres away from all solids.
    pub fn is_clear(&self, hand: Pose, opening: f32, margin: f32) -> bool {
        self.gripper.links.iter().all(|link| {
            let slid = match &link.joint {
                Joint::Slide(axis) => axis.axis * opening,
                _ => Vector::ZERO,
            };
            let place = hand * Pose::from_translation(slid);
            placed(link, place).all(|part| self.object.iter().all(|other| distance(&part, other) > margin))
        })
    }

    /// Whether the pads would meet something on their way from `opening` to the middle.
    pub fn is_between(&self, hand: Pose, opening: f32) -> bool {
        let swept = (hand, SharedShape::cuboid(PAD.x, opening, PAD.z));
        self.object.iter().any(|other| distance(&swept, other) <= 0.0)
    }
}

/// The solids of a link that is somewhere.
pub(super) fn placed(link: &Link, place: Pose) -> impl Iterator<Item = Placed> + '_ {
    link.solids.iter().filter_map(move |part| {
        let (shape, own) = solid(&part.shape)?;
        Some((place * part.pose * own, shape))
    })
}

/// Distance between two solids; 0 where they overlap.
fn distance(a: &Placed, b: &Placed) -> f32 {
    query::distance(&a.0, &*a.1, &b.0, &*b.1).map_or(f32::INFINITY, |found| found.distance)
}

/// How deep two solids are in each other, metres; 0 where they are apart.
pub(super) fn depth(a: &Placed, b: &Placed) -> f32 {
    let contact = query::contact(&a.0, &*a.1, &b.0, &*b.1, 0.0).ok().flatten();
    contact.map_or(0.0, |contact| (-contact.dist).max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::hand::{gripper::OPEN, gripper::pose, objects};

    #[test]
    fn an_open_hand_fits_round_the_post_and_a_closed_one_does_not() {
        let clearance = Clearance::new(&objects::slide());
        let post = Vector::new(0.0, 0.2, 0.1);
        let above = pose(post, -Vector::Z, Vector::X);
        assert!(clearance.is_clear(above, OPEN, 0.002) && clearance.is_between(above, OPEN));
        assert!(!clearance.is_clear(above, 0.0, 0.0));
        // The finger's tip would be in a rail.
        let deep = pose(post - Vector::Z * 0.06, -Vector::Z, Vector::X);
        assert!(!clearance.is_clear(deep, OPEN, 0.0));
        let beside = pose(post + Vector::Y * 0.1, -Vector::Z, Vector::X);
        assert!(clearance.is_clear(beside, OPEN, 0.0) && !clearance.is_between(beside, OPEN));
    }

    #[test]
    fn depth_is_how_far_solids_overlap() {
        let ball = |x: f32| (Pose::translation(x, 0.0, 0.0), SharedShape::ball(1.0));
        assert!((depth(&ball(0.0), &ball(1.5)) - 0.5).abs() < 1e-5);
        assert_eq!(depth(&ball(0.0), &ball(2.5)), 0.0);
    }
}
