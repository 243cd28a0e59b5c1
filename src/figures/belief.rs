//! Truth beside belief on a map: left where sets say that a skill may start, right where it succeeds.

use std::path::Path;

use super::canvas::{Align, Area, Canvas, Font};
use super::error::FigureError;
use super::heat;
use super::legend::{self, Entry, Mark};
use super::map::{Map, Rect, View};
use super::maze;
use super::palette::{GOAL, INK, SOFT, colour, faint};
use super::raster::Raster;
use super::sets;
use super::text::{self, Weight};

/// What was found out in a rectangle of the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// Where.
    pub rect: Rect,
    /// A share in [0, 1]; none where there is nothing to find out, because the subgoal holds there.
    pub success: Option<f64>,
}

/// One skill.
#[derive(Clone, Debug, Default)]
pub struct Belief {
    /// Stands above its two panels, such as "skill 2 → enters skill 1".
    pub title: String,
    /// Stands below the title on the left, in grey.
    pub believed: String,
    /// The same on the right.
    pub found: String,
    /// The colour's number.
    pub colour: usize,
    /// Where it may start.
    pub may_start: Raster,
    /// Where another skill may aim; empty where that is the same.
    pub may_aim: Raster,
    /// Where it succeeds.
    pub patches: Vec<Patch>,
}

const MARGIN: f32 = 18.0;
/// Between the panels of a skill, and between skills.
const GAP: [f32; 2] = [14.0, 34.0];
const HEAD: f32 = 54.0;
/// Width of a panel.
const WIDE: f32 = 290.0;
/// Skills side by side.
const ACROSS: usize = 2;
/// How strongly a place where the subgoal holds is tinted.
const THERE: f32 = 0.35;

/// Draws two panels a skill as one PNG: its sets, and how probable success is with the outline of where it may start.
///
/// # Errors
/// [`FigureError`] when there is no skill, a raster has the wrong length, or the file cannot be written.
pub fn beliefs(path: impl AsRef<Path>, map: &Map, beliefs: &[Belief]) -> Result<(), FigureError> {
    let path = path.as_ref();
    map.check(path)?;
    for belief in beliefs {
        for Raster { nx, ny, inside } in [&belief.may_start, &belief.may_aim] {
            if nx.checked_mul(*ny) != Some(inside.len()) {
                let (title, found) = (belief.title.clone(), inside.len());
                return Err(FigureError::Raster { path: path.to_owned(), title, nx: *nx, ny: *ny, found });
            }
        }
    }
    if beliefs.is_empty() {
        let what = "truth beside belief needs at least one skill";
        return Err(FigureError::Nothing { path: path.to_owned(), what });
    }
    let across = beliefs.len().min(ACROSS);
    let [panel, pair] = [WIDE + GAP[0], 2.0 * WIDE + GAP[0] + GAP[1]];
    let tall = HEAD + WIDE * map.shape();
    let width = 2.0 * MARGIN + across as f32 * pair - GAP[1];
    let entries = entries(map, beliefs);
    let inner = width - 2.0 * MARGIN;
    let below = MARGIN + beliefs.len().div_ceil(across) as f32 * (tall + GAP[1]) - GAP[1] + 16.0;
    let legend_height = legend::height(&entries, inner);
    let mut canvas = Canvas::new(path, width, below + 34.0 + legend_height + MARGIN - 6.0)?;
    for (index, belief) in beliefs.iter().enumerate() {
        let x = MARGIN + (index % across) as f32 * pair;
        let y = MARGIN + (index / across) as f32 * (tall + GAP[1]);
        let left = Area { x, y, w: WIDE, h: tall };
        let (title, size) = text::fit(&belief.title, 17.5, Weight::Bold, panel + WIDE);
        canvas.text(&title, (x + f32::midpoint(panel, WIDE), y + 17.0), Align::Centre, Font::bold(size));
        let shade = colour(belief.colour);
        on_map(&mut canvas, map, &belief.believed, left, |canvas, view| {
            belief.may_start.draw(canvas, view, shade);
            belief.may_aim.outline(canvas, view, INK);
        });
        on_map(&mut canvas, map, &belief.found, Area { x: x + panel, ..left }, |canvas, view| {
            canvas.clipped(view.area, |canvas| {
                for patch in &belief.patches {
                    let shade = patch.success.map_or(faint(GOAL, THERE), heat::shade);
                    canvas.areas([whole(view.area(patch.rect))], shade);
                }
            });
            belief.may_start.outline(canvas, view, INK);
        });
    }
    heat::bar(&mut canvas, (width - heat::BAR) / 2.0, below);
    legend::draw(&mut canvas, &entries, width / 2.0, below + 34.0, inner);
    canvas.save(path)
}

/// One panel: floor, what `draw` puts on it, walls, goal and starts.
fn on_map(canvas: &mut Canvas, map: &Map, note: &str, area: Area, draw: impl FnOnce(&mut Canvas, &View)) {
    let (note, size) = text::fit(note, 14.0, Weight::Regular, area.w);
    canvas.text(&note, (area.middle(), area.y + 40.0), Align::Centre, Font::plain(size).coloured(SOFT));
    let view = View::fit(map.bounds, Area { y: area.y + HEAD, h: area.h - HEAD, ..area });
    maze::floor(canvas, &view);
    draw(canvas, &view);
    maze::walls(canvas, map, &view);
    canvas.clipped(view.area, |canvas| {
        maze::goals(canvas, map, &view);
        maze::starts(canvas, map, &view);
    });
}

/// The same area between whole pixels, so that no seam shows between neighbours.
fn whole(area: Area) -> Area {
    let (x, y) = (area.x.round(), area.y.round());
    Area { x, y, w: area.right().round() - x, h: area.bottom().round() - y }
}

/// Only what the picture shows.
fn entries(map: &Map, beliefs: &[Belief]) -> Vec<Entry> {
    let shades = [0, 1, 2].map(|index| colour(beliefs[index * beliefs.len() / 3].colour));
    let mut entries = vec![Entry::new(Mark::Inside(shades), "left: may start (outlined on the right)")];
    if beliefs.iter().any(|belief| !belief.may_aim.inside.is_empty()) {
        entries.push(Entry::new(Mark::Line(INK), "left: may be aimed at"));
    }
    if beliefs.iter().flat_map(|belief| &belief.patches).any(|patch| patch.success.is_none()) {
        entries.push(Entry::new(Mark::Region, "its subgoal holds already"));
    }
    entries.extend(sets::places(map));
    entries
}
