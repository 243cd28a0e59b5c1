//! One sun, and what stands in its light.

use rapier3d::math::Vector;

use super::{
    bins::Bins,
    body::Body,
    lens::{Lens, Ray},
};

/// Towards the sun along the picture's right, along the floor away from the viewer, and upwards. It stands in
/// the upper left of a picture from above, as drawings of relief have it, ...
const OVER_MAP: Vector = Vector::new(-0.45, 0.45, 1.0);
/// ... and over the viewer's left shoulder otherwise, so that the sides that are seen are lit.
const OVER_SHOULDER: Vector = Vector::new(-0.7, -0.45, 1.0);
/// About so many cells along the longer side of what can cast a shadow.
const CELLS: f32 = 128.0;
/// How far a shadow's cause must be at least, metres: rounding casts none.
const CLEAR: f32 = 1e-4;

/// The sun over a scene.
pub(super) struct Sun {
    pub(super) towards: Vector,
    /// A picture without perspective, from the sun, of all that casts shadows.
    lens: Lens,
    bins: Bins,
}

impl Sun {
    /// The sun as a viewer likes it.
    pub(super) fn new(bodies: &[Body], viewer: &Lens) -> Self {
        let place = if viewer.near.is_none() { OVER_MAP } else { OVER_SHOULDER };
        let away = Vector::Z.cross(viewer.right);
        let towards = (viewer.right * place.x + away * place.y + Vector::Z * place.z).normalize();
        let right = towards.cross(Vector::Z).normalize();
        let mut lens = Lens {
            eye: Vector::ZERO,
            right,
            up: right.cross(-towards),
            forward: -towards,
            centre: [0.0; 2],
            scale: 1.0,
            near: None,
        };
        // All of it, in metres; then in cells.
        let [left, top, right, bottom] = lens.extent(bodies.iter().flat_map(Body::balls));
        let size = [right - left, bottom - top].map(|side| side.max(0.0));
        lens.scale = (size[0].max(size[1]) / CELLS).max(1e-6);
        lens.centre = [-left / lens.scale, -top / lens.scale];
        let bins = lens.bins(size.map(|side| side / lens.scale), 1.0, bodies);
        Self { towards, lens, bins }
    }

    /// Whether anything but body `but` stands between a point and the sun.
    pub(super) fn shadowed(&self, bodies: &[Body], at: Vector, but: Option<usize>) -> bool {
        let Some([x, y]) = self.lens.project(at) else { return false };
        let ray = Ray { origin: at, direction: self.towards };
        self.bins.at(x, y).iter().map(|&body| body as usize).any(|body| {
            let enter = if but == Some(body) { f32::INFINITY } else { bodies[body].enter(&ray) };
            enter > CLEAR && enter < f32::INFINITY
        })
    }
}
