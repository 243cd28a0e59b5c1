//! Initiation sets on the map, a small panel a skill, as in figure 3.2 of the thesis.

use std::path::Path;

use super::canvas::{Align, Area, Canvas, Font};
use super::error::FigureError;
use super::legend::{self, Entry, Mark};
use super::map::{Map, View};
use super::maze::{self, is_finite};
use super::palette::{SOFT, colour};
use super::raster::Raster;
use super::text::{self, Weight};

/// Where one skill can start.
#[derive(Clone, Debug, Default)]
pub struct SetPicture {
    /// Stands above the panel, such as "skill 2 → enters skill 1".
    pub title: String,
    /// Stands below the title in grey, such as "covers 18 % of free space".
    pub subtitle: String,
    /// The colour's number; a skill's number gives it the colour it has in [`trajectories`](super::trajectories).
    pub colour: usize,
    /// Where the classifier says yes.
    pub region: Raster,
    /// Examples of success that the classifier learnt from; may be empty.
    pub positives: Vec<[f32; 2]>,
    /// Examples of failure that the classifier learnt from; may be empty.
    pub negatives: Vec<[f32; 2]>,
}

const MARGIN: f32 = 18.0;
const GAP: f32 = 28.0;
const HEAD: f32 = 54.0;

/// Draws one panel a skill as one PNG, and a remark below. Without any skill it shows the bare map.
pub fn sets(path: impl AsRef<Path>, map: &Map, sets: &[SetPicture], note: &str) -> Result<(), FigureError> {
    let rows = sets.len().max(1).div_ceil(5);
    sets_in_columns(path, map, sets, sets.len().max(1).div_ceil(rows), note)
}

/// The same with so many panels a row (at least 1): one a skill, say, and a row for each case (figure 3.2).
pub fn sets_in_columns(
    path: impl AsRef<Path>,
    map: &Map,
    sets: &[SetPicture],
    columns: usize,
    note: &str,
) -> Result<(), FigureError> {
    let (path, columns) = (path.as_ref(), columns.max(1));
    map.check(path)?;
    for set in sets {
        let Raster { nx, ny, ref inside } = set.region;
        if nx.checked_mul(ny) != Some(inside.len()) {
            let title = set.title.clone();
            return Err(FigureError::Raster { path: path.to_owned(), title, nx, ny, found: inside.len() });
        }
    }
    let none = [SetPicture { title: "no skills yet".to_owned(), ..SetPicture::default() }];
    let shown = if sets.is_empty() { &none } else { sets };

    let rows = shown.len().div_ceil(columns);
    let wide = match columns {
        1 => 460.0,
        2 => 400.0,
        3 | 4 => 310.0,
        _ => 250.0,
    };
    let tall = HEAD + wide * map.shape();
    let width = 2.0 * MARGIN + columns as f32 * (wide + GAP) - GAP;
    let entries = entries(map, sets);
    let below = MARGIN + rows as f32 * (tall + GAP) - GAP + 14.0;
    let inner = width - 2.0 * MARGIN;
    let legend_height = legend::height(&entries, inner);
    let height = below + legend_height + legend::note_height(note, inner) + MARGIN - 6.0;

    let mut canvas = Canvas::new(path, width, height)?;
    for (row, in_row) in shown.chunks(columns).enumerate() {
        for (column, set) in in_row.iter().enumerate() {
            let x = MARGIN + column as f32 * (wide + GAP);
            let y = MARGIN + row as f32 * (tall + GAP);
            draw(&mut canvas, map, set, Area { x, y, w: wide, h: tall });
        }
    }
    legend::draw(&mut canvas, &entries, width / 2.0, below, inner);
    legend::draw_note(&mut canvas, note, width / 2.0, below + legend_height, inner);
    canvas.save(path)
}

fn draw(canvas: &mut Canvas, map: &Map, set: &SetPicture, area: Area) {
    let (title, size) = text::fit(&set.title, 17.5, Weight::Bold, area.w);
    canvas.text(&title, (area.middle(), area.y + 17.0), Align::Centre, Font::bold(size));
    let (subtitle, size) = text::fit(&set.subtitle, 15.0, Weight::Regular, area.w);
    canvas.text(&subtitle, (area.middle(), area.y + 40.0), Align::Centre, Font::plain(size).coloured(SOFT));

    let view = View::fit(map.bounds, Area { y: area.y + HEAD, h: area.h - HEAD, ..area });
    maze::floor(canvas, &view);
    set.region.draw(canvas, &view, colour(set.colour));
    maze::walls(canvas, map, &view);
    canvas.clipped(view.area, |canvas| {
        maze::goals(canvas, map, &view);
        maze::starts(canvas, map, &view);
        for point in set.negatives.iter().filter(|point| is_finite(**point)) {
            maze::negative(canvas, view.at(*point));
        }
        for point in set.positives.iter().filter(|point| is_finite(**point)) {
            maze::positive(canvas, view.at(*point));
        }
    });
}

/// Only what the picture shows.
fn entries(map: &Map, sets: &[SetPicture]) -> Vec<Entry> {
    let mut entries = Vec::new();
    if !sets.is_empty() {
        let shades = [0, 1, 2].map(|index| colour(sets[index * sets.len() / 3].colour));
        entries.push(Entry::new(Mark::Inside(shades), "inside the initiation set"));
        entries.push(Entry::new(Mark::Outside, "outside"));
    }
    if sets.iter().any(|set| !set.positives.is_empty()) {
        entries.push(Entry::new(Mark::Positive, "success example"));
    }
    if sets.iter().any(|set| !set.negatives.is_empty()) {
        entries.push(Entry::new(Mark::Negative, "failure example"));
    }
    entries.extend(places(map));
    entries
}

/// Entries for start, goal and key, where the map has them.
pub(super) fn places(map: &Map) -> impl Iterator<Item = Entry> {
    let start = (!map.starts.is_empty()).then(|| Entry::new(Mark::Start, "start"));
    let goal = map.goal.map(|_| Entry::new(Mark::Goal, "goal"));
    let key = map.key.map(|_| Entry::new(Mark::Key, "key"));
    start.into_iter().chain(goal).chain(key)
}
