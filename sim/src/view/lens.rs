//! A camera made ready for a frame: from pixels to rays, and from points to pixels.

use rapier3d::math::Vector;

use super::{Camera, bins::Bins, body::Body};

/// What is nearer to a camera in perspective than this share of its distance is not seen.
const NEAR: f32 = 0.02;

/// A half-line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray {
    pub(super) origin: Vector,
    /// Of length 1.
    pub(super) direction: Vector,
}

impl Ray {
    pub(super) fn at(&self, t: f32) -> Vector {
        self.origin + self.direction * t
    }
}

/// A rectangle of pixels: least x, least y, greatest x, greatest y.
pub(super) type Extent = [f32; 4];

/// Nothing.
const NONE: Extent = [f32::INFINITY, f32::INFINITY, f32::NEG_INFINITY, f32::NEG_INFINITY];
/// Everything.
const ALL: Extent = [f32::NEG_INFINITY, f32::NEG_INFINITY, f32::INFINITY, f32::INFINITY];

/// How pixels and rays belong together.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lens {
    pub(super) eye: Vector,
    pub(super) right: Vector,
    pub(super) up: Vector,
    pub(super) forward: Vector,
    /// The middle of the picture, pixels.
    pub(super) centre: [f32; 2],
    /// Metres a pixel: everywhere if `near` is none, else at one metre in front of the eye.
    pub(super) scale: f32,
    /// Where the visible begins, metres in front of the eye; none without perspective.
    pub(super) near: Option<f32>,
}

impl Lens {
    /// For a frame of that width and height. A camera above stands at height `top`. Nothing for cameras that
    /// see nothing: no size, no distance, no number.
    pub(super) fn new(camera: &Camera, size: [u32; 2], top: f32) -> Option<Self> {
        let [width, height] = size.map(|x| x as f32);
        let centre = [width / 2.0, height / 2.0];
        let lens = match *camera {
            Camera::Above { bounds } => {
                let span = |axis: usize| (bounds.high[axis] - bounds.low[axis]) as f32;
                let middle = |axis: usize| ((bounds.high[axis] + bounds.low[axis]) / 2.0) as f32;
                Self {
                    eye: Vector::new(middle(0), middle(1), top),
                    right: Vector::X,
                    up: Vector::Y,
                    forward: -Vector::Z,
                    centre,
                    scale: (span(0) / width).max(span(1) / height),
                    near: None,
                }
            }
            Camera::Beside { focus, distance, azimuth, elevation, field_of_view } => {
                if !(0.0 < field_of_view && field_of_view < std::f32::consts::PI) {
                    return None;
                }
                let (sine, cosine) = azimuth.sin_cos();
                let (rise, level) = elevation.sin_cos();
                let back = Vector::new(cosine * level, sine * level, rise);
                let right = Vector::new(-sine, cosine, 0.0);
                Self {
                    eye: focus + back * distance,
                    right,
                    up: back.cross(right),
                    forward: -back,
                    centre,
                    scale: 2.0 * (field_of_view / 2.0).tan() / height,
                    near: Some(distance * NEAR),
                }
            }
        };
        let sound = lens.eye.is_finite()
            && lens.right.is_finite()
            && lens.up.is_finite()
            && lens.scale.is_finite()
            && lens.scale > 0.0
            && lens.near.is_none_or(|near| near.is_finite() && near > 0.0);
        sound.then_some(lens)
    }

    /// What a place in the frame sees.
    pub(super) fn ray(&self, x: f32, y: f32) -> Ray {
        let (a, b) = ((x - self.centre[0]) * self.scale, (self.centre[1] - y) * self.scale);
        let aside = self.right * a + self.up * b;
        match self.near {
            Some(_) => Ray { origin: self.eye, direction: (self.forward + aside).normalize() },
            None => Ray { origin: self.eye + aside, direction: self.forward },
        }
    }

    /// Where in the frame a point is seen; nothing if it is nearer than the visible.
    pub(super) fn project(&self, point: Vector) -> Option<[f32; 2]> {
        let from_eye = point - self.eye;
        let mut scale = self.scale;
        if let Some(near) = self.near {
            let depth = from_eye.dot(self.forward);
            if depth <= near || depth.is_nan() {
                return None;
            }
            scale *= depth;
        }
        let (a, b) = (from_eye.dot(self.right), from_eye.dot(self.up));
        Some([self.centre[0] + a / scale, self.centre[1] - b / scale])
    }

    /// A rectangle that surely shows all of the convex hull of some balls.
    pub(super) fn extent(&self, balls: impl IntoIterator<Item = (Vector, f32)>) -> Extent {
        let (mut extent, mut behind) = (NONE, false);
        for (centre, radius) in balls {
            let (right, up, forward) = (self.right * radius, self.up * radius, self.forward * radius);
            for corner in 0..8_u8 {
                let sign = |bit: u8| if corner & bit == 0 { -1.0 } else { 1.0 };
                match self.project(centre + right * sign(1) + up * sign(2) + forward * sign(4)) {
                    Some([x, y]) => {
                        extent = [extent[0].min(x), extent[1].min(y), extent[2].max(x), extent[3].max(y)];
                    }
                    None => behind = true,
                }
            }
        }
        if behind && extent != NONE { ALL } else { extent }
    }

    /// Which bodies may be seen where, by cells of that side, in a frame of that size.
    pub(super) fn bins(&self, size: [f32; 2], side: f32, bodies: &[Body]) -> Bins {
        let balls: Vec<_> = bodies.iter().map(Body::balls).collect();
        let extents: Vec<_> = balls.iter().map(|balls| self.extent(balls.iter().copied())).collect();
        // Where the ray through a cell's middle misses a body by more than the cell is wide there, all others
        // miss the body too. From the middle to a corner, with a pixel to spare:
        let reach = (side * 0.71 + 1.0) * self.scale;
        let grown: Vec<_> = bodies
            .iter()
            .zip(&balls)
            .map(|(body, balls)| {
                let depth = |(centre, radius): &(Vector, f32)| (centre - self.eye).dot(self.forward) + radius;
                let deepest = balls.iter().map(depth).fold(0.0, f32::max);
                body.grown(if self.near.is_some() { reach * deepest } else { reach })
            })
            .collect();
        Bins::new(size, side, &extents, |body, [x, y]| grown[body].enter(&self.ray(x, y)) < f32::INFINITY)
    }
}
