//! Whether a model can be built, and if not, where to mend it.

use rapier3d::math::Vector;

use super::{
    ModelError,
    build::{axis, mass},
};
use crate::{
    Shape,
    rigid::{Axis, Joint, Link, Model, Part},
};

/// Refuses what Rapier would choke on or silently get wrong.
pub(super) fn check(model: &Model) -> Result<(), ModelError> {
    let of_model = |what| ModelError::Model { model: model.name.clone(), what };
    if model.links.is_empty() {
        return Err(of_model("it has no links; give it at least a root"));
    }
    for (index, link) in model.links.iter().enumerate() {
        let wrong = place(index, link).or_else(|| materials(link)).or_else(|| {
            let axis = axis(&link.joint)?;
            motion(axis)
        });
        if let Some(what) = wrong.or_else(|| weight(model, index)) {
            return Err(ModelError::Link { model: model.name.clone(), link: link.name.clone(), what });
        }
    }
    for (actuator, drive) in model.actuators.iter().enumerate() {
        let what = match model.links.get(drive.link) {
            None => "there is no link of that index; name one of the model's",
            Some(link) if axis(&link.joint).is_none() => "its link has no hinge or slide; drive one that has",
            _ if !drive.gear.is_finite() => "its gear is not a finite number",
            _ => continue,
        };
        return Err(ModelError::Actuator { model: model.name.clone(), actuator, what });
    }
    Ok(())
}

fn place(index: usize, link: &Link) -> Option<&'static str> {
    match link.parent {
        Some(_) if index == 0 => return Some("the first link is the root and has no parent"),
        None if index > 0 => {
            return Some("only the first link has no parent; name one that stands before it");
        }
        Some(parent) if parent >= index => return Some("its parent must stand before it"),
        Some(_) if link.joint == Joint::Free => return Some("only a root can be free"),
        _ => {}
    }
    (!link.place.is_finite() || (link.place.rotation.length() - 1.0).abs() > 1e-3)
        .then_some("its place must be finite, with a rotation of length 1")
}

fn materials(link: &Link) -> Option<&'static str> {
    if let Some(mass) = &link.mass
        && !(mass.mass > 0.0
            && mass.mass.is_finite()
            && mass.inertia.is_finite()
            && mass.inertia.min_element() >= 0.0
            && mass.place.is_finite())
    {
        return Some("its mass must be positive, its moments of inertia not negative, all of them finite");
    }
    link.solids.iter().find_map(part)
}

fn part(part: &Part) -> Option<&'static str> {
    let positive = |x: &f32| *x > 0.0 && x.is_finite();
    let shape = match &part.shape {
        Shape::Ball { radius } => positive(radius),
        Shape::Capsule { from, to, radius } => from.is_finite() && to.is_finite() && positive(radius),
        Shape::Cuboid { half } => half.to_array().iter().all(positive),
        Shape::Cylinder { half_height, radius } => positive(half_height) && positive(radius),
        Shape::Hull { points } => points.iter().all(|point| point.is_finite()) && !flat(points),
    };
    if !shape {
        Some(
            "the sizes of its solids must be positive and finite, and the points of a hull not all in one plane",
        )
    } else if !(part.density >= 0.0 && part.density.is_finite()) {
        Some("a density must be finite and not negative")
    } else if !(part.friction >= 0.0 && part.friction.is_finite()) {
        Some("a coefficient of friction must be finite and not negative")
    } else if !part.pose.is_finite() {
        Some("the place of a solid must be finite")
    } else {
        None
    }
}

/// Whether points lie in one plane, or nearly so for their size.
fn flat(points: &[Vector]) -> bool {
    let Some(first) = points.first() else { return true };
    let farthest = |how_far: &dyn Fn(Vector) -> f32| {
        let away = points.iter().map(|point| *point - *first);
        away.max_by(|a, b| how_far(*a).total_cmp(&how_far(*b))).unwrap_or_default()
    };
    let line = farthest(&|away| away.length());
    let plane = line.cross(farthest(&|away| line.cross(away).length()));
    let height = farthest(&|away| plane.dot(away).abs());
    plane.dot(height).abs() <= 1e-6 * plane.length() * line.length()
}

fn motion(axis: &Axis) -> Option<&'static str> {
    let some = |x: f32| x >= 0.0 && x.is_finite();
    if !((axis.axis.length() - 1.0).abs() < 1e-3 && axis.anchor.is_finite()) {
        Some("its joint's axis must have length 1, and the anchor must be finite")
    } else if !(some(axis.damping) && some(axis.armature) && some(axis.friction)) {
        Some("damping, armature and friction of its joint must be finite and not negative")
    } else if axis.range.is_some_and(|[low, high]| !(low <= high && low.is_finite() && high.is_finite())) {
        Some("its joint's range must be finite, the least coordinate first")
    } else {
        None
    }
}

/// Whatever moves by itself needs mass, its own or that of what hangs on it.
fn weight(model: &Model, index: usize) -> Option<&'static str> {
    let link = &model.links[index];
    if link.joint == Joint::Fixed {
        return None;
    }
    let mut carried = vec![false; model.links.len()];
    carried[index] = true;
    for later in index + 1..model.links.len() {
        let parent = model.links[later].parent.and_then(|parent| carried.get(parent));
        carried[later] = parent == Some(&true);
    }
    let heavy = model.links.iter().zip(&carried).any(|(link, carried)| *carried && mass(link).mass() > 0.0);
    (!heavy).then_some("it moves but has no mass; give it a solid with a density, or a mass")
}
