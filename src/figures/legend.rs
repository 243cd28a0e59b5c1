//! What the marks of a picture mean: centred rows below it, where they can hide nothing.

use inroads_discovery::record::GoalState;

use super::canvas::{Align, Area, Canvas, Font};
use super::goal_space;
use super::graph::{self, Role};
use super::kept;
use super::maze;
use super::palette::{self, Colour, FLOOR, GOAL, SOFT, WALL, WHITE, faint};
use super::text::{self, Weight};

/// The mark that an entry explains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Mark {
    /// A bold line over its band.
    Curve(Colour),
    /// A known value: the how manyeth of its panel.
    Level(usize),
    /// A plain line.
    Line(Colour),
    /// Inside an initiation set, in the colours of up to three of them.
    Inside([Colour; 3]),
    /// Free space outside an initiation set.
    Outside,
    Goal,
    Key,
    Start,
    /// An example of success.
    Positive,
    /// An example of failure.
    Negative,
    /// Where the goal is, below other marks.
    Region,
    /// A vertex of a graph.
    Vertex,
    /// Vertices of small and of large value.
    Ramp,
    /// A special vertex.
    Ring(Role),
    /// An edge that leads there with a probability, and whether it is part of a plan.
    Arrow(f64, bool),
    /// An edge that nothing has followed.
    Hoped,
    /// A goal in a state.
    Goals(GoalState),
    /// A feature that a subgoal keeps, and one that it drops.
    Kept,
    Dropped,
    /// A column that should be empty.
    Distractor,
    /// A filled disc.
    Dot(Colour),
}

/// One mark and its words.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entry {
    pub(super) mark: Mark,
    pub(super) label: String,
}

impl Entry {
    pub(super) fn new(mark: Mark, label: impl Into<String>) -> Self {
        Self { mark, label: label.into() }
    }

    fn width(&self) -> f32 {
        self.mark.width() + GAP + text::width(&self.label, SIZE, Weight::Regular)
    }
}

const SIZE: f32 = 16.0;
const GAP: f32 = 8.0;
const BETWEEN: f32 = 30.0;
const ROW: f32 = 27.0;

impl Mark {
    fn width(self) -> f32 {
        match self {
            Self::Curve(_) | Self::Level(_) => 34.0,
            Self::Line(_) => 26.0,
            Self::Inside(_) | Self::Outside => 27.0,
            Self::Goal | Self::Key | Self::Start | Self::Dot(_) | Self::Region => 18.0,
            Self::Positive | Self::Negative | Self::Dropped => 10.0,
            Self::Vertex | Self::Ring(_) | Self::Goals(_) | Self::Kept | Self::Distractor => 20.0,
            Self::Ramp => 42.0,
            Self::Arrow(..) | Self::Hoped => 34.0,
        }
    }

    fn draw(self, canvas: &mut Canvas, x: f32, y: f32) {
        // Whole pixels keep the edges of swatches sharp.
        let x = x.round();
        let (w, middle) = (self.width(), (x + self.width() / 2.0, y));
        let swatch = Area { x, y: y - 7.0, w, h: 14.0 };
        match self {
            Self::Curve(colour) => {
                canvas.areas([swatch], faint(colour, 0.18));
                canvas.line(&[(x + 2.0, y), (x + w - 2.0, y)], colour, 3.0);
            }
            Self::Level(kind) => canvas.dashed(&[(x, y), (x + w, y)], SOFT, 1.6, kind),
            Self::Line(colour) => canvas.line(&[(x + 2.0, y), (x + w - 2.0, y)], colour, 3.0),
            Self::Inside(colours) => {
                for (index, colour) in (0u8..).zip(colours) {
                    let part = Area { x: x + f32::from(index) * w / 3.0, w: w / 3.0, ..swatch };
                    canvas.areas([part], WHITE);
                    canvas.areas([part], faint(colour, maze::INSIDE));
                }
                maze::frame(canvas, swatch, WALL, 1.0);
            }
            Self::Outside => {
                canvas.areas([swatch], FLOOR);
                maze::frame(canvas, swatch, WALL, 1.0);
            }
            Self::Goal => maze::goal(canvas, middle, 8.0),
            Self::Key => maze::key(canvas, middle, 7.0),
            Self::Start => maze::start(canvas, middle, 7.5),
            Self::Positive => maze::positive(canvas, middle),
            Self::Negative => maze::negative(canvas, middle),
            Self::Region => canvas.disc(middle, 8.0, faint(GOAL, 0.35)),
            Self::Vertex => graph::vertex(canvas, middle, 7.0, Role::Plain),
            Self::Ring(role) => graph::vertex(canvas, middle, 5.5, role),
            Self::Ramp => graph::ramp(canvas, (x, y)),
            Self::Arrow(probability, planned) => {
                graph::sample(canvas, (x, y), w, (probability, planned, false))
            }
            Self::Hoped => graph::sample(canvas, (x, y), w, (1.0, false, true)),
            Self::Goals(state) => goal_space::tile(canvas, swatch.grown(1.0), state),
            Self::Kept => canvas.areas([swatch], palette::colour(1)),
            Self::Dropped => canvas.disc(middle, 2.5, WALL),
            Self::Distractor => canvas.areas([swatch], faint(GOAL, kept::TINT)),
            Self::Dot(colour) => canvas.disc(middle, 7.0, colour),
        }
    }
}

/// Fills rows from the left, as words fill lines.
fn rows(entries: &[Entry], width: f32) -> Vec<(f32, Vec<&Entry>)> {
    let mut rows: Vec<(f32, Vec<&Entry>)> = Vec::new();
    for entry in entries {
        let needed = entry.width();
        match rows.last_mut() {
            Some((used, row)) if *used + BETWEEN + needed <= width => {
                *used += BETWEEN + needed;
                row.push(entry);
            }
            _ => rows.push((needed, vec![entry])),
        }
    }
    rows
}

/// The height that [`draw`] will take.
pub(super) fn height(entries: &[Entry], width: f32) -> f32 {
    rows(entries, width).len() as f32 * ROW
}

/// Draws the rows, centred on `x`, the first one below `y`.
pub(super) fn draw(canvas: &mut Canvas, entries: &[Entry], x: f32, y: f32, width: f32) {
    for (index, (used, row)) in rows(entries, width).into_iter().enumerate() {
        let middle = y + (index as f32 + 0.5) * ROW;
        let mut left = x - used / 2.0;
        for entry in row {
            entry.mark.draw(canvas, left, middle);
            let words = left + entry.mark.width() + GAP;
            let room = (width - entry.mark.width() - GAP).max(40.0);
            let (label, size) = text::fit(&entry.label, SIZE, Weight::Regular, room);
            canvas.text(&label, (words, middle + 5.5), Align::Left, Font::plain(size));
            left += entry.width() + BETWEEN;
        }
    }
}

/// The height that [`draw_note`] will take.
pub(super) fn note_height(note: &str, width: f32) -> f32 {
    text::wrap(note, NOTE, width).len() as f32 * NOTE_ROW
}

/// Draws a small grey remark, centred on `x`, the first line below `y`.
pub(super) fn draw_note(canvas: &mut Canvas, note: &str, x: f32, y: f32, width: f32) {
    let font = Font::plain(NOTE).coloured(SOFT);
    for (index, line) in text::wrap(note, NOTE, width).iter().enumerate() {
        canvas.text(line, (x, y + (index as f32 + 0.72) * NOTE_ROW), Align::Centre, font);
    }
}

const NOTE: f32 = 13.5;
const NOTE_ROW: f32 = 19.0;
