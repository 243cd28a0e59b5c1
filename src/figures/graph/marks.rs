//! Vertices and arrows.

use std::collections::BTreeSet;

use super::super::canvas::{Align, Area, Canvas, Font};
use super::super::palette::{Colour, GOAL, INK, WHITE, colour, faint, shade};
use super::super::text::{self, Weight};
use super::{Edge, Graph, Layout, Role};

/// Vertices above which only special ones have their labels.
const LABELLED: usize = 80;
/// Least size of letters.
const SMALL: f32 = 8.5;
/// Edges above which all are drawn weaker.
const CROWD: f32 = 120.0;
/// How much of its strength an edge has that nothing has followed.
const HOPED: f32 = 0.55;
/// Radius of the largest vertex below which no edge makes a detour around vertices: there is no room.
const TIGHT: f32 = 7.0;

/// The edges, strong ones over weak ones, planned ones over all.
pub(super) fn edges(canvas: &mut Canvas, graph: &Graph, layout: &Layout) {
    let count = graph.vertices.len();
    let strength = (CROWD / graph.edges.len().max(1) as f32).powf(0.7).clamp(0.2, 1.0);
    let there: BTreeSet<(usize, usize)> = graph.edges.iter().map(|edge| (edge.from, edge.to)).collect();
    let fits = |edge: &&Edge| edge.from < count && edge.to < count && edge.from != edge.to;
    let mut edges: Vec<&Edge> = graph.edges.iter().filter(fits).collect();
    edges.sort_by(|a, b| a.planned.cmp(&b.planned).then(a.probability.total_cmp(&b.probability)));
    for edge in edges {
        let both = there.contains(&(edge.to, edge.from));
        let bend = bend(layout, edge, both);
        let [from, to] = [edge.from, edge.to].map(|index| (layout.at[index], radius(graph, layout, index)));
        let strength = if edge.hoped { HOPED * strength } else { strength };
        arrow(canvas, from, to, bend, look(edge.probability, edge.planned, strength), edge.hoped);
    }
}

/// How far the middle of an edge is off the straight line, pixels: to tell both ways apart, and around vertices that
/// would lie on it.
fn bend(layout: &Layout, edge: &Edge, both: bool) -> f32 {
    let (from, to) = (layout.at[edge.from], layout.at[edge.to]);
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let length = dx.hypot(dy).max(1e-3);
    let on_it = |(index, &(x, y)): (usize, &(f32, f32))| {
        let (x, y) = (x - from.0, y - from.1);
        let (along, beside) = ((x * dx + y * dy) / length, (x * dy - y * dx) / length);
        index != edge.from
            && index != edge.to
            && beside.abs() < layout.radius
            && (layout.radius..length - layout.radius).contains(&along)
    };
    let on_it = layout.radius >= TIGHT && layout.at.iter().enumerate().any(on_it);
    match (on_it, both) {
        (true, _) => (0.16 * length).max((3.2 * layout.radius).min(0.3 * length)),
        (false, true) => (0.09 * length).clamp(4.0, 22.0),
        (false, false) => 0.0,
    }
}

/// Width and colour of an edge, weaker where there are many.
fn look(probability: f64, planned: bool, strength: f32) -> (f32, Colour) {
    let p = if probability.is_finite() { probability.clamp(0.0, 1.0) as f32 } else { 0.0 };
    match planned {
        true => (2.2 + 1.6 * p, colour(6)),
        false => ((0.8 + 2.0 * p) * strength.sqrt(), faint(INK, (0.14 + 0.66 * p) * strength)),
    }
}

/// An arrow from the rim of one disc to the rim of another, bent to its left.
fn arrow(
    canvas: &mut Canvas,
    ((x, y), start): ((f32, f32), f32),
    ((to_x, to_y), end): ((f32, f32), f32),
    bend: f32,
    (width, colour): (f32, Colour),
    dashed: bool,
) {
    let (dx, dy) = (to_x - x, to_y - y);
    let length = dx.hypot(dy);
    let head = 5.0 + 2.0 * width;
    if length < start + end + head {
        return;
    }
    // The control point of a parabola whose middle is off by `bend`.
    let control = (x + dx / 2.0 + 2.0 * bend * dy / length, y + dy / 2.0 - 2.0 * bend * dx / length);
    let point = |t: f32| {
        let mix = |a: f32, b: f32, c: f32| (1.0 - t) * ((1.0 - t) * a + t * b) + t * ((1.0 - t) * b + t * c);
        (mix(x, control.0, to_x), mix(y, control.1, to_y))
    };
    let from = |(px, py): (f32, f32)| (px - x).hypot(py - y);
    let left = |(px, py): (f32, f32)| (px - to_x).hypot(py - to_y);
    let curve: Vec<(f32, f32)> = (0..=64).map(|nth| point(nth as f32 / 64.0)).collect();
    let tip = curve.iter().copied().find(|at| left(*at) <= end + 2.0).unwrap_or((to_x, to_y));
    let back = (tip.0 - control.0, tip.1 - control.1);
    let back = (back.0 / back.0.hypot(back.1).max(1e-3), back.1 / back.0.hypot(back.1).max(1e-3));
    let neck = (tip.0 - back.0 * head, tip.1 - back.1 * head);
    let shaft = curve.into_iter().filter(|at| from(*at) >= start + 1.0 && left(*at) > end + 2.0 + head);
    let shaft: Vec<_> = shaft.chain([neck]).collect();
    if dashed {
        canvas.dashed(&shaft, colour, width.max(1.1), 0);
    } else {
        canvas.line(&shaft, colour, width);
    }
    let half = 0.42 * head;
    canvas.polygon(
        &[
            tip,
            (neck.0 - back.1 * half, neck.1 + back.0 * half),
            (neck.0 + back.1 * half, neck.1 - back.0 * half),
        ],
        colour,
    );
}

/// An arrow of the legend.
pub(in super::super) fn sample(canvas: &mut Canvas, (x, y): (f32, f32), width: f32, how: (f64, bool, bool)) {
    let (probability, planned, hoped) = how;
    let look = look(probability, planned, if hoped { HOPED } else { 1.0 });
    arrow(canvas, ((x, y), 0.0), ((x + width, y), 0.0), 0.0, look, hoped);
}

/// The share of the greatest value.
fn part(graph: &Graph, index: usize) -> f32 {
    let greatest = graph.vertices.iter().map(|vertex| vertex.value).filter(|value| value.is_finite());
    let greatest = greatest.fold(0.0, f64::max);
    let value = graph.vertices[index].value;
    if greatest > 0.0 && value.is_finite() { (value / greatest).clamp(0.0, 1.0) as f32 } else { 0.0 }
}

/// Areas grow as the values do.
fn radius(graph: &Graph, layout: &Layout, index: usize) -> f32 {
    layout.radius * (0.62 + 0.38 * part(graph, index).sqrt())
}

/// The vertices with their labels, special ones on top.
pub(super) fn vertices(canvas: &mut Canvas, graph: &Graph, layout: &Layout) {
    let mut order: Vec<usize> = (0..graph.vertices.len()).collect();
    order.sort_by_key(|&index| graph.vertices[index].role);
    for index in order {
        let vertex = &graph.vertices[index];
        let (at, r) = (layout.at[index], radius(graph, layout, index));
        disc(canvas, at, r, shade(part(graph, index)));
        ring(canvas, at, r, vertex.role);
    }
    for (index, vertex) in graph.vertices.iter().enumerate() {
        if vertex.role != Role::Plain || graph.vertices.len() <= LABELLED {
            let part = part(graph, index);
            label(canvas, &vertex.label, layout.at[index], radius(graph, layout, index), part);
        }
    }
}

fn disc(canvas: &mut Canvas, at: (f32, f32), r: f32, fill: Colour) {
    canvas.disc(at, r + 1.2, WHITE);
    canvas.disc(at, r, fill);
    canvas.ring(at, r, INK, 1.1);
}

/// A vertex of the legend.
pub(in super::super) fn vertex(canvas: &mut Canvas, at: (f32, f32), r: f32, role: Role) {
    disc(canvas, at, r, shade(0.15));
    ring(canvas, at, r, role);
}

/// The rim of a special vertex.
fn ring(canvas: &mut Canvas, at: (f32, f32), r: f32, role: Role) {
    let colour = match role {
        Role::Plain => return,
        Role::Start => INK,
        Role::Goal => GOAL,
        Role::Expansion => colour(2),
    };
    canvas.ring(at, r + 3.4, WHITE, 5.0);
    canvas.ring(at, r + 3.2, colour, 3.2);
}

/// Discs of three values.
pub(in super::super) fn ramp(canvas: &mut Canvas, (x, y): (f32, f32)) {
    for (dx, r, value) in [(5.0, 4.5, 0.0), (18.0, 6.0, 0.5), (34.0, 7.5, 1.0)] {
        disc(canvas, (x + dx, y), r, shade(value));
    }
}

/// In the disc where it fits, else beside it.
fn label(canvas: &mut Canvas, label: &str, (x, y): (f32, f32), r: f32, part: f32) {
    let size = (1.05 * r).min(13.0);
    let wide = text::width(label, size, Weight::Regular);
    let size = size.min(size * 1.7 * r / wide.max(1e-3));
    if size >= SMALL {
        let ink = if part > 0.3 { WHITE } else { INK };
        canvas.text(label, (x, y + 0.36 * size), Align::Centre, Font::plain(size).coloured(ink));
        return;
    }
    let size = 12.0;
    let wide = text::width(label, size, Weight::Regular);
    let (left, middle) = (x + r + 3.0, y - r);
    let behind = Area { x: left - 1.5, y: middle - 0.62 * size, w: wide + 3.0, h: 1.2 * size };
    canvas.areas([behind], faint(WHITE, 0.75));
    canvas.text(label, (left, middle + 0.36 * size), Align::Left, Font::plain(size));
}
