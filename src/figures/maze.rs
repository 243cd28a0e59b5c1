//! The marks that all drawings on a map share.

use super::canvas::{Area, Canvas};
use super::map::{Map, View};
use super::palette::{Colour, FLOOR, GOAL, INK, KEY, WALL, WHITE, faint};

/// How strongly the inside of an initiation set is coloured.
pub(super) const INSIDE: f32 = 0.5;

/// The floor.
pub(super) fn floor(canvas: &mut Canvas, view: &View) {
    canvas.areas([view.area], FLOOR);
}

/// The walls, as one shape.
pub(super) fn walls(canvas: &mut Canvas, map: &Map, view: &View) {
    canvas.clipped(view.area, |canvas| canvas.areas(map.walls.iter().map(|wall| view.area(*wall)), WALL));
}

/// Where episodes begin.
pub(super) fn starts(canvas: &mut Canvas, map: &Map, view: &View) {
    for point in map.starts.iter().filter(|point| is_finite(**point)) {
        start(canvas, view.at(*point), 8.0);
    }
}

/// Where they should end, and the key that is fetched before.
pub(super) fn goals(canvas: &mut Canvas, map: &Map, view: &View) {
    if let Some(at) = map.key.filter(|at| is_finite(*at)) {
        key(canvas, view.at(at), 7.0);
    }
    if let Some((centre, radius)) = map.goal.filter(|(centre, _)| is_finite(*centre)) {
        goal(canvas, view.at(centre), (radius * view.scale).max(5.0));
    }
}

/// A red disc.
pub(super) fn goal(canvas: &mut Canvas, at: (f32, f32), radius: f32) {
    canvas.disc(at, radius + 1.5, WHITE);
    canvas.disc(at, radius, GOAL);
}

/// A blue disc.
pub(super) fn key(canvas: &mut Canvas, at: (f32, f32), radius: f32) {
    canvas.disc(at, radius + 1.5, WHITE);
    canvas.disc(at, radius, KEY);
}

/// A dark diamond.
pub(super) fn start(canvas: &mut Canvas, at: (f32, f32), radius: f32) {
    let diamond = |r: f32| [(at.0, at.1 - r), (at.0 + r, at.1), (at.0, at.1 + r), (at.0 - r, at.1)];
    canvas.polygon(&diamond(radius + 2.0), WHITE);
    canvas.polygon(&diamond(radius), INK);
}

/// An example of success: a dark dot.
pub(super) fn positive(canvas: &mut Canvas, at: (f32, f32)) {
    canvas.disc(at, 3.2, faint(WHITE, 0.85));
    canvas.disc(at, 2.3, INK);
}

/// An example of failure: a cross.
pub(super) fn negative(canvas: &mut Canvas, at: (f32, f32)) {
    let arm = 3.2;
    for (width, colour) in [(3.4, faint(WHITE, 0.8)), (1.5, GOAL)] {
        canvas.line(&[(at.0 - arm, at.1 - arm), (at.0 + arm, at.1 + arm)], colour, width);
        canvas.line(&[(at.0 - arm, at.1 + arm), (at.0 + arm, at.1 - arm)], colour, width);
    }
}

/// The border of an area.
pub(super) fn frame(canvas: &mut Canvas, area: Area, colour: Colour, width: f32) {
    let (x, y, right, bottom) = (area.x, area.y, area.right(), area.bottom());
    canvas.line(&[(x, y), (right, y), (right, bottom), (x, bottom), (x, y)], colour, width);
}

pub(super) fn is_finite(point: [f32; 2]) -> bool {
    point.iter().all(|value| value.is_finite())
}
