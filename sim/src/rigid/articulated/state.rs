//! Generalised positions and velocities in MuJoCo's order and frames.

use super::{StateError, tree::Tree};
use crate::rigid::{Joint, Model};

/// How deep in a wall a restored body may be, metres: what the simulation itself allows.
pub(super) const WALL_TOLERANCE: f32 = 0.02;

/// Positions and velocities of all models, one model after the other: what MuJoCo calls `qpos` and `qvel`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Configuration {
    /// A free root has x, y, z (metres) and a quaternion w, x, y, z; then each hinge (radians) or slide (metres)
    /// in the order of the links.
    pub q: Vec<f32>,
    /// A free root has the velocity of its origin in the world's frame (m/s) and its angular velocity in its own
    /// frame (rad/s); then each hinge (rad/s) or slide (m/s) in the order of the links.
    pub v: Vec<f32>,
}

impl Configuration {
    /// The same state with quaternions of length 1, or why it is none.
    pub(super) fn admit(&self, trees: &[Tree]) -> Result<Self, StateError> {
        let (q, v) = trees.last().map_or((0, 0), |tree| (tree.q.end, tree.v.end));
        if (self.q.len(), self.v.len()) != (q, v) {
            return Err(StateError::Length { positions: self.q.len(), velocities: self.v.len(), q, v });
        }
        for (which, numbers) in [("position", &self.q), ("velocity", &self.v)] {
            if let Some(index) = numbers.iter().position(|x| !x.is_finite()) {
                return Err(StateError::NotFinite { which, index, value: numbers[index] });
            }
        }
        let mut admitted = self.clone();
        for index in trees.iter().filter(|tree| tree.free).map(|tree| tree.q.start + 3) {
            let quaternion = &mut admitted.q[index..index + 4];
            let length = quaternion.iter().map(|x| x * x).sum::<f32>().sqrt();
            if !(0.5..2.0).contains(&length) {
                return Err(StateError::Quaternion { index, length });
            }
            // What was read comes back unchanged, however far Rapier let it drift from 1.
            if (length - 1.0).abs() > 1e-4 {
                quaternion.iter_mut().for_each(|x| *x /= length);
            }
        }
        Ok(admitted)
    }
}

/// All joints at zero, free roots at their places, at rest.
pub(super) fn zero(models: &[Model], trees: &[Tree]) -> Configuration {
    let (q, v) = trees.last().map_or((0, 0), |tree| (tree.q.end, tree.v.end));
    let mut zero = Configuration { q: vec![0.0; q], v: vec![0.0; v] };
    for (model, tree) in models.iter().zip(trees) {
        let Some(root) = model.links.first().filter(|root| root.joint == Joint::Free) else { continue };
        let (at, turn) = (root.place.translation, root.place.rotation);
        zero.q[tree.q.start..tree.q.start + 7]
            .copy_from_slice(&[at.x, at.y, at.z, turn.w, turn.x, turn.y, turn.z]);
    }
    zero
}
