//! Which features abstract subgoals are about (thesis section 9.2.3): a row a subgoal, a column a feature.

use std::path::Path;

use super::canvas::{Align, Area, Canvas, Font};
use super::error::FigureError;
use super::legend::{self, Entry, Mark};
use super::palette::{GOAL, GRID, INK, SOFT, WHITE, colour, faint};
use super::text::{self, Weight};

/// A column.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Feature {
    /// Its name.
    pub name: String,
    /// Whether it is known to matter to nothing, so that no subgoal should keep it.
    pub distractor: bool,
}

/// A row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Kept {
    /// The subgoal's name.
    pub label: String,
    /// Stands right of the row in grey, such as "reached 31 of 40".
    pub note: String,
    /// The value of each feature that the subgoal asks for; none where it does not care. Features beyond its end
    /// are dropped ones.
    pub values: Vec<Option<String>>,
}

const MARGIN: f32 = 18.0;
const ROW: f32 = 30.0;
const SIZE: f32 = 14.5;
/// Least width of a column.
const NARROW: f32 = 44.0;
/// How strongly the column of a distractor is tinted.
pub(super) const TINT: f32 = 0.13;

/// Draws the table as one PNG, with the mean number of features kept and how often a distractor was.
///
/// # Errors
/// [`FigureError`] when there is no feature, or the file cannot be written.
pub fn kept_features(
    path: impl AsRef<Path>,
    features: &[Feature],
    subgoals: &[Kept],
) -> Result<(), FigureError> {
    let path = path.as_ref();
    if features.is_empty() {
        let what = "a table of features needs at least one feature";
        return Err(FigureError::Nothing { path: path.to_owned(), what });
    }
    let wide = |text: &str| text::width(text, SIZE, Weight::Regular);
    let widest = |texts: &mut dyn Iterator<Item = &str>| texts.map(wide).fold(0.0, f32::max);
    let labels = widest(&mut subgoals.iter().map(|row| row.label.as_str())) + 14.0;
    let notes = widest(&mut subgoals.iter().map(|row| row.note.as_str())) + 14.0;
    let columns: Vec<f32> = (0..features.len())
        .map(|nth| {
            let mut values = subgoals.iter().filter_map(|row| row.value(nth));
            (widest(&mut values) + 16.0).max(NARROW)
        })
        .collect();
    // Names that are wider than their columns all read upwards.
    let upright = features.iter().zip(&columns).any(|(feature, room)| wide(&feature.name) > room - 8.0);
    let names = widest(&mut features.iter().map(|feature| feature.name.as_str()));
    let head = if upright { names + 16.0 } else { 30.0 };

    let table = labels + columns.iter().sum::<f32>() + notes;
    let width = (table + 2.0 * MARGIN).max(560.0);
    let entries = entries(features, subgoals);
    let note = note(features, subgoals);
    let inner = width - 2.0 * MARGIN;
    let bottom = MARGIN + head + subgoals.len().max(1) as f32 * ROW;
    let legend_height = legend::height(&entries, inner);
    let height = bottom + 14.0 + legend_height + 4.0 + legend::note_height(&note, inner) + MARGIN - 6.0;
    let mut canvas = Canvas::new(path, width, height)?;

    let mut x = (width - table) / 2.0 + labels;
    for (nth, (feature, room)) in features.iter().zip(&columns).enumerate() {
        let column = Area { x, y: MARGIN, w: *room, h: bottom - MARGIN };
        if feature.distractor {
            canvas.areas([column], faint(GOAL, TINT));
        }
        let font = Font::plain(SIZE).coloured(if feature.distractor { GOAL } else { INK });
        if upright {
            let middle = MARGIN + head - 8.0 - wide(&feature.name) / 2.0;
            canvas.text_upwards(&feature.name, (column.middle() + 0.36 * SIZE, middle), font);
        } else {
            canvas.text(&feature.name, (column.middle(), MARGIN + 20.0), Align::Centre, font);
        }
        for (row, subgoal) in subgoals.iter().enumerate() {
            let y = MARGIN + head + row as f32 * ROW;
            cell(&mut canvas, Area { x, y, w: *room, h: ROW }, subgoal.value(nth), feature.distractor);
        }
        x += room;
    }
    for (row, subgoal) in subgoals.iter().enumerate() {
        let y = MARGIN + head + row as f32 * ROW + ROW / 2.0 + 0.36 * SIZE;
        let left = (width - table) / 2.0;
        canvas.text(&subgoal.label, (left + labels - 10.0, y), Align::Right, Font::plain(SIZE));
        canvas.text(&subgoal.note, (x + 10.0, y), Align::Left, Font::plain(SIZE).coloured(SOFT));
    }
    if subgoals.is_empty() {
        let at = (width / 2.0, MARGIN + head + ROW / 2.0 + 0.36 * SIZE);
        canvas.text("no subgoals yet", at, Align::Centre, Font::plain(SIZE).coloured(SOFT));
    }
    legend::draw(&mut canvas, &entries, width / 2.0, bottom + 14.0, inner);
    legend::draw_note(&mut canvas, &note, width / 2.0, bottom + 14.0 + legend_height + 4.0, inner);
    canvas.save(path)
}

impl Kept {
    fn value(&self, feature: usize) -> Option<&str> {
        self.values.get(feature).and_then(Option::as_deref)
    }
}

fn cell(canvas: &mut Canvas, area: Area, value: Option<&str>, distractor: bool) {
    let inside = area.grown(-2.0);
    let Some(value) = value else {
        let dot = (area.middle(), area.y + area.h / 2.0);
        canvas.disc(dot, 1.8, if distractor { faint(GOAL, 0.4) } else { GRID });
        return;
    };
    canvas.areas([inside], if distractor { GOAL } else { colour(1) });
    let (value, size) = text::fit(value, SIZE, Weight::Regular, inside.w - 6.0);
    let at = (area.middle(), area.y + area.h / 2.0 + 0.36 * size);
    canvas.text(&value, at, Align::Centre, Font::plain(size).coloured(WHITE));
}

fn entries(features: &[Feature], subgoals: &[Kept]) -> Vec<Entry> {
    let mut entries = Vec::new();
    if !subgoals.is_empty() {
        entries.push(Entry::new(Mark::Kept, "kept: the value asked for"));
        entries.push(Entry::new(Mark::Dropped, "dropped"));
    }
    if features.iter().any(|feature| feature.distractor) {
        entries.push(Entry::new(Mark::Distractor, "distractor"));
    }
    entries
}

fn note(features: &[Feature], subgoals: &[Kept]) -> String {
    if subgoals.is_empty() {
        return String::new();
    }
    let kept = |row: &Kept, distractors: bool| {
        let columns = features.iter().enumerate();
        columns.filter(|(nth, f)| row.value(*nth).is_some() && (f.distractor || !distractors)).count()
    };
    let all: usize = subgoals.iter().map(|row| kept(row, false)).sum();
    let mean = all as f64 / subgoals.len() as f64;
    let mut note = format!("{mean:.1} of {} features kept on average", features.len());
    if features.iter().any(|feature| feature.distractor) {
        let with = subgoals.iter().filter(|row| kept(row, true) > 0).count();
        note += &format!(" · a distractor in {with} of {} subgoals", subgoals.len());
    }
    note
}
