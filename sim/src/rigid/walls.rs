//! The walls of a cell map as one fixed collider.

use rapier3d::prelude::*;

use super::{CellMap, Rectangle};

/// One compound of boxes from `half_height` below `z` to as much above it, or nothing when the map has no walls.
/// They should stand well above and below a robot, so that none is ever pushed out over the top.
pub(super) fn collider(map: &CellMap, z: f32, half_height: f32) -> Option<ColliderBuilder> {
    let boxes: Vec<_> = map.walls().iter().map(|wall| upright(wall, z, half_height)).collect();
    // Friction 1 is that of the point robot's model file in rllab.
    (!boxes.is_empty()).then(|| ColliderBuilder::compound(boxes).friction(1.0))
}

fn upright(wall: &Rectangle, z: f32, half_height: f32) -> (Pose, SharedShape) {
    let half = |axis: usize| ((wall.high[axis] - wall.low[axis]) / 2.0) as f32;
    let middle = |axis: usize| ((wall.high[axis] + wall.low[axis]) / 2.0) as f32;
    let place = Pose::from_translation(Vector::new(middle(0), middle(1), z));
    (place, SharedShape::cuboid(half(0), half(1), half_height))
}
