//! Solids made ready for rays.

use rapier3d::{
    math::{Rotation, Vector},
    parry::transformation::try_convex_hull,
};

use super::{
    Solid,
    colour::{Light, light},
    lens::Ray,
};
use crate::Shape;

/// What is lower than this may stand on the floor, metres.
pub(super) const ON_FLOOR: f32 = 0.01;
/// Faces whose normals differ by less are one (cosine).
const SAME_FACE: f32 = 0.9999;

/// A solid in world coordinates.
#[derive(Clone, Debug)]
pub(super) struct Body {
    form: Form,
    pub(super) light: Light,
    /// Whether it is a box on the floor: a wall, a table.
    pub(super) block: bool,
}

#[derive(Clone, Debug)]
enum Form {
    Ball {
        centre: Vector,
        radius: f32,
    },
    Capsule {
        from: Vector,
        along: Vector,
        radius: f32,
    },
    Cuboid {
        centre: Vector,
        axes: [Vector; 3],
        half: Vector,
    },
    Cylinder {
        centre: Vector,
        axis: Vector,
        half_height: f32,
        radius: f32,
    },
    /// All points p with normal · p ≤ offset for every face.
    Polytope {
        corners: Vec<Vector>,
        faces: Vec<(Vector, f32)>,
    },
}

impl Body {
    /// Nothing if the solid has no volume or is not made of numbers.
    pub(super) fn new(solid: &Solid) -> Option<Self> {
        let at = solid.pose.translation;
        let turn = solid.pose.rotation;
        let length = turn.length();
        if !(at.is_finite() && length.is_finite() && length > 0.0) {
            return None;
        }
        let turn: Rotation = turn.normalize();
        let positive = |size: f32| size.is_finite() && size > 0.0;
        let form = match &solid.shape {
            &Shape::Ball { radius } => positive(radius).then_some(Form::Ball { centre: at, radius })?,
            &Shape::Capsule { from, to, radius } => {
                let along = turn * (to - from);
                let sound = positive(radius) && from.is_finite() && along.is_finite();
                let from = turn * from + at;
                match along.length_squared() > 1e-6 * radius * radius {
                    _ if !sound => return None,
                    true => Form::Capsule { from, along, radius },
                    false => Form::Ball { centre: from, radius },
                }
            }
            &Shape::Cuboid { half } => {
                let axes = [Vector::X, Vector::Y, Vector::Z].map(|axis| turn * axis);
                let sound = half.to_array().into_iter().all(positive);
                sound.then_some(Form::Cuboid { centre: at, axes, half })?
            }
            &Shape::Cylinder { half_height, radius } => (positive(half_height) && positive(radius))
                .then(|| Form::Cylinder { centre: at, axis: turn * Vector::Z, half_height, radius })?,
            Shape::Hull { points } => polytope(points.iter().map(|&point| turn * point + at).collect())?,
        };
        let mut body = Self { form, light: light(solid.colour), block: false };
        let lowest = body.balls().into_iter().fold(f32::INFINITY, |low, (at, radius)| low.min(at.z - radius));
        body.block = matches!(body.form, Form::Cuboid { .. }) && lowest < ON_FLOOR;
        Some(body)
    }

    /// A colourless capsule for finding what lies along a line of some length.
    pub(super) fn line(from: Vector, along: Vector, radius: f32) -> Self {
        Self { form: Form::Capsule { from, along, radius }, light: Light::ZERO, block: false }
    }

    /// Balls, centre and radius, in whose convex hull the solid lies.
    pub(super) fn balls(&self) -> Vec<(Vector, f32)> {
        match &self.form {
            &Form::Ball { centre, radius } => vec![(centre, radius)],
            &Form::Capsule { from, along, radius } => vec![(from, radius), (from + along, radius)],
            &Form::Cuboid { centre, axes: [x, y, z], half } => {
                let signs = [-1.0_f32, 1.0];
                let ends =
                    signs.map(|a| signs.map(|b| signs.map(|c| [a, b, c]))).into_iter().flatten().flatten();
                ends.map(|[a, b, c]| (centre + x * (a * half.x) + y * (b * half.y) + z * (c * half.z), 0.0))
                    .collect()
            }
            &Form::Cylinder { centre, axis, half_height, radius } => {
                vec![(centre - axis * half_height, radius), (centre + axis * half_height, radius)]
            }
            Form::Polytope { corners, .. } => corners.iter().map(|&corner| (corner, 0.0)).collect(),
        }
    }

    /// The body with all that is no farther from it than `by`, and a little more at its edges.
    pub(super) fn grown(&self, by: f32) -> Self {
        let mut body = self.clone();
        match &mut body.form {
            Form::Ball { radius, .. } | Form::Capsule { radius, .. } => *radius += by,
            Form::Cuboid { half, .. } => *half += Vector::splat(by),
            Form::Cylinder { half_height, radius, .. } => {
                (*half_height, *radius) = (*half_height + by, *radius + by)
            }
            Form::Polytope { faces, .. } => faces.iter_mut().for_each(|(_, offset)| *offset += by),
        }
        body
    }

    /// Whether a point is in a box, or no farther from it than `slack`; never of other solids.
    pub(super) fn holds(&self, point: Vector, slack: f32) -> bool {
        let &Form::Cuboid { centre, axes, half } = &self.form else { return false };
        (0..3).all(|axis| (point - centre).dot(axes[axis]).abs() <= half[axis] + slack)
    }

    /// How far along a ray it enters the solid: negative from inside or beyond, infinite if it misses.
    pub(super) fn enter(&self, ray: &Ray) -> f32 {
        match &self.form {
            &Form::Ball { centre, radius } => enter_ball(ray, centre, radius),
            &Form::Capsule { from, along, radius } => enter_capsule(ray, from, along, radius),
            &Form::Cuboid { centre, axes, half } => {
                let offset = ray.origin - centre;
                let mut span = Span::default();
                for (axis, half) in axes.into_iter().zip(half.to_array()) {
                    span.slab(offset.dot(axis), ray.direction.dot(axis), half);
                }
                span.enter()
            }
            &Form::Cylinder { centre, axis, half_height, radius } => {
                let offset = ray.origin - centre;
                let (height, climb) = (offset.dot(axis), ray.direction.dot(axis));
                let mut span = Span::default();
                span.slab(height, climb, half_height);
                span.round(offset - axis * height, ray.direction - axis * climb, radius);
                span.enter()
            }
            Form::Polytope { faces, .. } => {
                let mut span = Span::default();
                for &(normal, offset) in faces {
                    span.half_space(normal.dot(ray.origin) - offset, normal.dot(ray.direction));
                }
                span.enter()
            }
        }
    }

    /// The outward direction, of length 1, at a point on the surface.
    pub(super) fn normal(&self, at: Vector) -> Vector {
        match &self.form {
            &Form::Ball { centre, radius } => (at - centre) / radius,
            &Form::Capsule { from, along, radius } => {
                let share = ((at - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
                (at - from - along * share) / radius
            }
            &Form::Cuboid { centre, axes, half } => {
                let offset = at - centre;
                let depth = |axis: usize| offset.dot(axes[axis]).abs() - half[axis];
                let mut face = 0;
                for axis in 1..3 {
                    if depth(axis) > depth(face) {
                        face = axis;
                    }
                }
                axes[face] * offset.dot(axes[face]).signum()
            }
            &Form::Cylinder { centre, axis, half_height, radius } => {
                let offset = at - centre;
                let height = offset.dot(axis);
                let aside = offset - axis * height;
                match height.abs() - half_height > aside.length() - radius {
                    true => axis * height.signum(),
                    false => aside / radius,
                }
            }
            Form::Polytope { faces, .. } => {
                let depth = |&(normal, offset): &(Vector, f32)| normal.dot(at) - offset;
                let nearest = faces.iter().max_by(|a, b| depth(a).total_cmp(&depth(b)));
                nearest.map_or(Vector::Z, |face| face.0)
            }
        }
    }
}

/// The part of a line within the half-spaces met so far.
struct Span {
    from: f32,
    to: f32,
}

impl Default for Span {
    fn default() -> Self {
        Self { from: f32::NEG_INFINITY, to: f32::INFINITY }
    }
}

impl Span {
    /// Keeps what is not above a plane: `height` above it at the start, changing with `climb`.
    fn half_space(&mut self, height: f32, climb: f32) {
        if climb.abs() < 1e-9 {
            if height > 0.0 {
                self.to = f32::NEG_INFINITY;
            }
        } else if climb < 0.0 {
            self.from = self.from.max(-height / climb);
        } else {
            self.to = self.to.min(-height / climb);
        }
    }

    /// Keeps what is no farther than `half` from a plane.
    fn slab(&mut self, height: f32, climb: f32, half: f32) {
        self.half_space(height - half, climb);
        self.half_space(-height - half, -climb);
    }

    /// Keeps what is no farther than `radius` from an axis; offset and direction are square to it.
    fn round(&mut self, offset: Vector, direction: Vector, radius: f32) {
        let a = direction.length_squared();
        if a < 1e-12 {
            if offset.length_squared() > radius * radius {
                self.to = f32::NEG_INFINITY;
            }
            return;
        }
        let nearest = -offset.dot(direction) / a;
        let rest = radius * radius - (offset + direction * nearest).length_squared();
        if rest < 0.0 {
            self.to = f32::NEG_INFINITY;
            return;
        }
        let reach = (rest / a).sqrt();
        self.from = self.from.max(nearest - reach);
        self.to = self.to.min(nearest + reach);
    }

    fn enter(&self) -> f32 {
        if self.from <= self.to { self.from } else { f32::INFINITY }
    }
}

fn enter_ball(ray: &Ray, centre: Vector, radius: f32) -> f32 {
    let offset = centre - ray.origin;
    let nearest = offset.dot(ray.direction);
    let rest = radius * radius - (offset - ray.direction * nearest).length_squared();
    if rest < 0.0 { f32::INFINITY } else { nearest - rest.sqrt() }
}

/// The cylinder between the ends, or else the ball at the end that the ray passes.
fn enter_capsule(ray: &Ray, from: Vector, along: Vector, radius: f32) -> f32 {
    // From the point of the ray nearest to one end: far cameras would cost digits.
    let ahead = (from - ray.origin).dot(ray.direction);
    let offset = ray.at(ahead) - from;
    let (square, climb, height) = (along.length_squared(), along.dot(ray.direction), along.dot(offset));
    let a = square - climb * climb;
    if a < 1e-6 * square {
        // Along the axis: through the nearer end.
        return enter_ball(ray, if climb > 0.0 { from } else { from + along }, radius);
    }
    // The offset is square to the direction, which leaves the shorter half of the usual terms.
    let b = -height * climb;
    let c = square * (offset.length_squared() - radius * radius) - height * height;
    let rest = b * b - a * c;
    if rest < 0.0 {
        return f32::INFINITY;
    }
    let t = (-b - rest.sqrt()) / a;
    let share = height + t * climb;
    if share <= 0.0 {
        enter_ball(ray, from, radius)
    } else if share >= square {
        enter_ball(ray, from + along, radius)
    } else {
        ahead + t
    }
}

/// The convex hull as half-spaces; nothing without volume.
fn polytope(corners: Vec<Vector>) -> Option<Form> {
    if !corners.iter().all(|corner| corner.is_finite()) || !spacious(&corners) {
        return None;
    }
    let (vertices, triangles) = try_convex_hull(&corners).ok()?;
    let mut faces: Vec<(Vector, f32)> = Vec::new();
    for triangle in triangles {
        let [a, b, c] = triangle.map(|vertex| vertices[vertex as usize]);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        if normal == Vector::ZERO || faces.iter().any(|face| face.0.dot(normal) > SAME_FACE) {
            continue;
        }
        // Over all corners, so that rounding never cuts one off.
        let offset = vertices.iter().fold(f32::NEG_INFINITY, |most, vertex| most.max(normal.dot(*vertex)));
        faces.push((normal, offset));
    }
    (faces.len() >= 4).then_some(Form::Polytope { corners: vertices, faces })
}

/// Whether some four of the points span a volume that is more than rounding.
fn spacious(corners: &[Vector]) -> bool {
    let Some(&first) = corners.first() else { return false };
    let farthest = |by: &dyn Fn(Vector) -> Vector| {
        let offsets = corners.iter().map(|&corner| by(corner - first));
        offsets.max_by(|a, b| a.length_squared().total_cmp(&b.length_squared())).unwrap_or_default()
    };
    let length = farthest(&|offset| offset);
    let along = length.normalize_or_zero();
    let width = farthest(&|offset| offset - along * offset.dot(along));
    let normal = along.cross(width.normalize_or_zero());
    let height = farthest(&|offset| normal * offset.dot(normal));
    height.length() > 1e-4 * length.length()
}
