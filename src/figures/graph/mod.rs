//! A graph of skills (figures 6.4 and 7.4 of the thesis): vertices where they are in the world, arrows as strong as
//! they are likely to lead there.

mod layout;
mod marks;

use std::path::Path;

use image::RgbImage;

use super::canvas::{Align, Area, Canvas, Font};
use super::error::FigureError;
use super::legend::{self, Entry, Mark};
use super::map::{Map, View};
use super::maze;
use super::palette::{GOAL, GRID, SOFT, WALL, faint};
use super::sets::places;
use super::text::{self, Weight};
use layout::Layout;
pub(super) use marks::{ramp, sample, vertex};

/// A graph as plain data.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    /// Stands above the picture.
    pub title: String,
    /// Stands below the title in grey, such as "after 200 episodes".
    pub subtitle: String,
    /// What the vertices' numbers are, for the legend: "visits", say.
    pub value: String,
    /// The vertices.
    pub vertices: Vec<Vertex>,
    /// The edges, which are directed.
    pub edges: Vec<Edge>,
}

/// A vertex.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Vertex {
    /// Stands in it, or beside it where it is too small: best a number.
    pub label: String,
    /// Where it is: metres on a map, column and row (downwards) on a picture or lattice. A vertex that is nowhere
    /// stands below the others.
    pub at: Option<[f32; 2]>,
    /// What its size and colour show; not negative.
    pub value: f64,
    /// What is special about it.
    pub role: Role,
}

/// What is special about a vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Role {
    /// Nothing.
    #[default]
    Plain,
    /// Episodes begin there.
    Start,
    /// The task ends there.
    Goal,
    /// From there the graph is made larger.
    Expansion,
}

/// A directed edge.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Edge {
    /// Where it begins, as an index of [`Graph::vertices`].
    pub from: usize,
    /// Where it ends.
    pub to: usize,
    /// How likely following it leads there, in [0, 1].
    pub probability: f64,
    /// Nothing has ever followed it: the probability is a hope.
    pub hoped: bool,
    /// It is part of the plan that the picture shows.
    pub planned: bool,
}

/// What a graph is drawn on.
#[derive(Clone, Copy, Debug)]
pub enum Ground<'a> {
    /// A map; positions are its metres.
    Map(&'a Map),
    /// The picture of a world that has so many columns and rows of cells.
    Picture {
        /// The picture, of any size.
        picture: &'a RgbImage,
        /// Columns and rows.
        cells: [u32; 2],
    },
    /// An empty lattice, as large as the positions need.
    Lattice,
    /// Nothing: vertices stand in columns, by their number of edges from the start.
    Layers,
}

const MARGIN: f32 = 18.0;
const WIDTH: f32 = 760.0;
/// Height of title and subtitle.
const HEAD: f32 = 54.0;

/// Draws a graph as one PNG with a legend. Edges from or to no vertex are left out.
///
/// # Errors
/// [`FigureError`] when the map's bounds enclose no area, or the file cannot be written.
pub fn graph(path: impl AsRef<Path>, ground: Ground<'_>, graph: &Graph) -> Result<(), FigureError> {
    let path = path.as_ref();
    if let Ground::Map(map) = ground {
        map.check(path)?;
    }
    let top = MARGIN + if graph.title.is_empty() && graph.subtitle.is_empty() { 0.0 } else { HEAD };
    let layout = Layout::of(ground, graph, (MARGIN, top, WIDTH));
    let entries = entries(ground, graph);
    let wide = layout.area.w.max(320.0);
    let below = layout.bottom + 12.0;
    let height = below + legend::height(&entries, wide) + MARGIN - 8.0;
    let mut canvas = Canvas::new(path, wide + 2.0 * MARGIN, height)?;

    let middle = MARGIN + wide / 2.0;
    let (title, size) = text::fit(&graph.title, 17.5, Weight::Bold, wide);
    canvas.text(&title, (middle, MARGIN + 17.0), Align::Centre, Font::bold(size));
    let (subtitle, size) = text::fit(&graph.subtitle, 15.0, Weight::Regular, wide);
    canvas.text(&subtitle, (middle, MARGIN + 40.0), Align::Centre, Font::plain(size).coloured(SOFT));

    draw_ground(&mut canvas, ground, &layout);
    marks::edges(&mut canvas, graph, &layout);
    marks::vertices(&mut canvas, graph, &layout);
    legend::draw(&mut canvas, &entries, middle, below, wide);
    canvas.save(path)
}

fn draw_ground(canvas: &mut Canvas, ground: Ground<'_>, layout: &Layout) {
    let area = layout.area;
    match ground {
        Ground::Map(map) => {
            let view = View::fit(map.bounds, area);
            maze::floor(canvas, &view);
            maze::walls(canvas, map, &view);
            canvas.clipped(view.area, |canvas| {
                if let Some((centre, radius)) = map.goal.filter(|(centre, _)| maze::is_finite(*centre)) {
                    canvas.disc(view.at(centre), (radius * view.scale).max(5.0), faint(GOAL, 0.35));
                }
                maze::starts(canvas, map, &view);
            });
        }
        Ground::Picture { picture, .. } => {
            canvas.picture(picture, area, FADED);
            maze::frame(canvas, area, WALL, 1.0);
        }
        Ground::Lattice => lines(canvas, area, layout.cell),
        Ground::Layers => {}
    }
}

/// How much of a picture's colour is left under a graph.
const FADED: f32 = 0.32;

fn lines(canvas: &mut Canvas, area: Area, cell: f32) {
    let places = |from: f32, length: f32| {
        (0..=(length / cell).round() as u32).map(move |line| from + line as f32 * cell)
    };
    for x in places(area.x, area.w) {
        canvas.line(&[(x, area.y), (x, area.bottom())], GRID, 1.2);
    }
    for y in places(area.y, area.h) {
        canvas.line(&[(area.x, y), (area.right(), y)], GRID, 1.2);
    }
}

/// Only what the picture shows.
fn entries(ground: Ground<'_>, graph: &Graph) -> Vec<Entry> {
    let mut entries = Vec::new();
    let values = graph.vertices.iter().map(|vertex| vertex.value).filter(|value| value.is_finite());
    let greatest = values.clone().fold(f64::NEG_INFINITY, f64::max);
    let least = values.fold(f64::INFINITY, f64::min);
    if !graph.value.is_empty() && greatest > least {
        let [least, greatest] = [least, greatest].map(number);
        entries.push(Entry::new(Mark::Ramp, format!("{}, {least} to {greatest}", graph.value)));
    } else if !graph.vertices.is_empty() {
        entries.push(Entry::new(Mark::Vertex, "vertex"));
    }
    let roles = [(Role::Start, "start"), (Role::Goal, "goal"), (Role::Expansion, "grows from here")];
    for (role, label) in roles {
        if graph.vertices.iter().any(|vertex| vertex.role == role) {
            entries.push(Entry::new(Mark::Ring(role), label));
        }
    }
    if graph.edges.iter().any(|edge| !edge.hoped && !edge.planned) {
        let strengths = [(0.2, "leads there with 0.2"), (0.6, "0.6"), (1.0, "1.0")];
        entries.extend(strengths.map(|(p, label)| Entry::new(Mark::Arrow(p, false), label)));
    }
    if graph.edges.iter().any(|edge| edge.hoped) {
        entries.push(Entry::new(Mark::Hoped, "never followed"));
    }
    if graph.edges.iter().any(|edge| edge.planned) {
        entries.push(Entry::new(Mark::Arrow(1.0, true), "plan"));
    }
    let roles = |role| graph.vertices.iter().any(|vertex| vertex.role == role);
    if let Ground::Map(map) = ground {
        entries.extend(places(map).filter_map(|entry| match entry.mark {
            // A vertex with the role says it already.
            Mark::Goal => (!roles(Role::Goal)).then(|| Entry::new(Mark::Region, "goal")),
            _ => (!roles(Role::Start)).then_some(entry),
        }));
    }
    entries
}

/// A number as people write it: no decimals where it has none or is large.
fn number(value: f64) -> String {
    if value.fract() == 0.0 || value.abs() >= 100.0 { format!("{value:.0}") } else { format!("{value:.2}") }
}
