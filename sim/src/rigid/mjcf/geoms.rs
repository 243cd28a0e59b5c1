//! From MJCF's geoms and inertials to solids and masses.

use std::f64::consts::PI;

use mjcf_rs::{
    body::{self as mjcf, GeomType, InertiaSpec},
    compiler::{Compiler, InertiaFromGeom},
};
use rapier3d::{
    dynamics::MassProperties,
    math::{Matrix, Pose, Rotation, Vector},
};

use super::{
    MjcfError,
    vocabulary::{BodyPlaces, Place},
};
use crate::Shape;
use crate::rigid::{Mass, Part};

/// The density of geoms that say neither density nor mass, kg/m³ (MuJoCo's default).
const DENSITY: f64 = 1000.0;

/// What a body is made of, and its mass, if that is not its geoms'.
pub(super) fn read(
    compiler: &Compiler,
    body: &mjcf::Body,
    places: &BodyPlaces,
) -> Result<(Vec<Part>, Option<Mass>), MjcfError> {
    let solids: Result<Vec<_>, _> =
        body.geoms.iter().zip(&places.geoms).map(|(geom, place)| part(geom, place)).collect();
    let mass = match (compiler.inertia_from_geom, &body.inertial) {
        (InertiaFromGeom::True, _) | (InertiaFromGeom::Auto, None) => None,
        (InertiaFromGeom::False, None) if body.geoms.is_empty() && body.joints.is_empty() => None,
        (InertiaFromGeom::False, None) => {
            return Err(places.body.error(
                "the compiler is told not to take mass from geoms, and there is no <inertial>",
                "write one, or leave inertiafromgeom away",
            ));
        }
        (_, Some(inertial)) => Some(mass(inertial, &places.body)?),
    };
    Ok((solids?, mass))
}

fn part(geom: &mjcf::Geom, place: &Place) -> Result<Part, MjcfError> {
    let (shape, pose, volume) = shape(geom, place)?;
    let density = match geom.mass {
        Some(mass) => mass / volume,
        None => geom.density.unwrap_or(DENSITY),
    };
    let friction = geom.friction[0];
    if density < 0.0 || friction < 0.0 {
        return Err(place.error(
            format!("its density is {density:.3} and its friction {friction}"),
            "neither can be negative",
        ));
    }
    Ok(Part {
        shape,
        pose,
        density: density as f32,
        friction: friction as f32,
        solid: (geom.contype | geom.conaffinity) & 1 == 1,
    })
}

/// The shape, where it lies in the body's frame, and its volume in cubic metres.
fn shape(geom: &mjcf::Geom, place: &Place) -> Result<(Shape, Pose, f64), MjcfError> {
    let needed = match geom.type_ {
        GeomType::Sphere => 1,
        GeomType::Capsule | GeomType::Cylinder => 2,
        GeomType::Box => 3,
        GeomType::Ellipsoid => return Err(place.error("ellipsoids are not understood", "make it a capsule")),
        GeomType::Plane => {
            return Err(place.error("a plane cannot be part of a body", "make it a thin box"));
        }
        GeomType::Mesh | GeomType::Hfield | GeomType::Sdf => {
            return Err(place.error(
                "meshes and fields are not understood",
                "make it of spheres, capsules, cylinders and boxes",
            ));
        }
    };
    let needed = if geom.fromto.is_some() { 1 } else { needed };
    if geom.size[..needed].iter().any(|size| *size <= 0.0) {
        return Err(place.error(
            format!("its size needs {needed} numbers above 0"),
            "give its radius and half its length, or half its sides",
        ));
    }
    let [a, b, c] = geom.size;
    let pose = Pose::from(geom.pose);
    let point = |x: f64, y: f64, z: f64| Vector::new(x as f32, y as f32, z as f32);
    let ends = geom.fromto.map(|[x, y, z, u, v, w]| (point(x, y, z), point(u, v, w)));
    let half = ends.map_or(b, |(from, to)| f64::from((to - from).length()) / 2.0);
    if ends.is_some() && half < 1e-6 {
        return Err(place.error("its two ends are one point", "make it a sphere, or draw its ends apart"));
    }
    Ok(match (geom.type_, ends) {
        (GeomType::Sphere, _) => (Shape::Ball { radius: a as f32 }, pose, 4.0 / 3.0 * PI * a.powi(3)),
        (GeomType::Capsule, _) => {
            let (from, to) = ends.unwrap_or((point(0.0, 0.0, -b), point(0.0, 0.0, b)));
            let volume = PI * a * a * (2.0 * half + 4.0 / 3.0 * a);
            (Shape::Capsule { from, to, radius: a as f32 }, pose, volume)
        }
        (GeomType::Cylinder, ends) => {
            let along = ends.map_or(Pose::IDENTITY, |(from, to)| {
                let turn = Rotation::from_rotation_arc(Vector::Z, (to - from).normalize());
                Pose::from_parts((from + to) / 2.0, turn)
            });
            let shape = Shape::Cylinder { half_height: half as f32, radius: a as f32 };
            (shape, pose * along, PI * a * a * 2.0 * half)
        }
        (_, Some(_)) => return Err(place.error("a box between two points is not understood", "give its pos")),
        (_, None) => (Shape::Cuboid { half: point(a, b, c) }, pose, 8.0 * a * b * c),
    })
}

fn mass(inertial: &mjcf::Inertial, place: &Place) -> Result<Mass, MjcfError> {
    let at = Pose::from(inertial.pose);
    let mass = inertial.mass as f32;
    let (inertia, frame) = match inertial.inertia {
        InertiaSpec::Diagonal(moments) => (Vector::from(moments.map(|x| x as f32)), at.rotation),
        InertiaSpec::Full([xx, yy, zz, xy, xz, yz]) => {
            let rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]].map(|row| row.map(|x| x as f32));
            let whole =
                MassProperties::with_inertia_matrix(Vector::ZERO, mass, Matrix::from_cols_array_2d(&rows));
            (whole.principal_inertia(), at.rotation * whole.principal_inertia_local_frame)
        }
    };
    let [a, b, c] = inertia.to_array();
    // A rigid body's moments keep the triangle's inequality; a hair for rounding.
    let possible = |a: f32, b: f32, c: f32| a <= (b + c) * 1.001;
    if !(mass > 0.0 && a > 0.0 && b > 0.0 && c > 0.0)
        || !(possible(a, b, c) && possible(b, c, a) && possible(c, a, b))
    {
        return Err(place.error(
            format!("no body has mass {mass} and principal moments of inertia {a}, {b}, {c}"),
            "in <inertial>, give a mass and moments above 0, none greater than the other two together",
        ));
    }
    Ok(Mass { mass, place: Pose::from_parts(at.translation, frame), inertia })
}
