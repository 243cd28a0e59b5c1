//! Where a picture is taken from.

use rapier3d::math::Vector;

use super::{Scene, lens::Lens};
use crate::rigid::Rectangle;

/// A place to look from. Pictures of one camera and scene at several sizes show the same world, only finer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Camera {
    /// Straight from above and without perspective: x to the right, y up.
    Above {
        /// The part of the floor that is seen: all of it, as large as the frame's shape allows, in the middle.
        bounds: Rectangle,
    },
    /// From the side, in perspective.
    Beside {
        /// What the middle of the picture shows, metres.
        focus: Vector,
        /// From the focus to the camera, metres.
        distance: f32,
        /// Where the camera stands as seen from its focus: radians from +x towards +y.
        azimuth: f32,
        /// How far above its focus's horizon it stands, radians: 0 level with it, π/2 straight above.
        elevation: f32,
        /// The angle between the picture's upper and lower border, radians, below π.
        field_of_view: f32,
    },
}

impl Camera {
    /// A camera straight above, see [`Camera::Above`].
    pub fn above(bounds: Rectangle) -> Self {
        Self::Above { bounds }
    }

    /// A camera at an angle, see [`Camera::Beside`].
    pub fn beside(focus: Vector, distance: f32, azimuth: f32, elevation: f32, field_of_view: f32) -> Self {
        Self::Beside { focus, distance, azimuth, elevation, field_of_view }
    }

    /// The usual camera at an angle: it looks at the scene's focus over the south side, as on a map.
    pub fn watching(scene: &Scene) -> Self {
        Self::beside(scene.focus, scene.distance, -1.95, 0.75, 0.7)
    }

    /// Where in a frame of `size` (width, height) a point of the world appears: pixels from the upper left
    /// corner, x to the right, y down. Nothing if it is behind the camera, or if the camera or the size is
    /// degenerate.
    ///
    /// ```
    /// use inroads_sim::{rigid::{Rectangle, Vector}, view::Camera};
    /// let camera = Camera::above(Rectangle { low: [0.0, 0.0], high: [4.0, 2.0] });
    /// assert_eq!(camera.project(Vector::new(4.0, 2.0, 0.0), [80, 40]), Some([80.0, 0.0]));
    /// ```
    pub fn project(&self, point: Vector, size: [u32; 2]) -> Option<[f32; 2]> {
        Lens::new(self, size, 0.0)?.project(point).filter(|at| at.iter().all(|x| x.is_finite()))
    }
}
