//! A number a seed: a dot each, their mean as a line, its interval as a whisker.

use std::path::Path;

use super::axis::Span;
use super::canvas::{Align, Area, Canvas, Font};
use super::chart::draw_axes;
use super::error::FigureError;
use super::legend::{self, Entry, Mark};
use super::palette::{SOFT, colour, faint};
use super::text::{self, Weight};
use crate::statistics::mean_interval;

/// One chart of a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Dots {
    /// Stands above the chart.
    pub title: String,
    /// Stands left of the chart, reading upwards.
    pub y_label: String,
    /// The ends of the y axis; without it, those of the values and intervals.
    pub y_range: Option<(f64, f64)>,
    /// What is compared.
    pub columns: Vec<Column>,
}

/// The numbers of one agent.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Column {
    /// Its name in the legend.
    pub label: String,
    /// Its colour's number: 0 is black, 1 blue, 2 orange, 3 green …
    pub colour: usize,
    /// A number a seed.
    pub values: Vec<f64>,
}

const MARGIN: f32 = 18.0;
const GUTTER: f32 = 26.0;
const TICK: f32 = 14.5;
const LABEL: f32 = 16.5;
const TITLE: f32 = 19.0;
const WIDE: f32 = 440.0;
const TALL: f32 = 360.0;
/// Panels in a row.
const ACROSS: usize = 3;
/// Intervals wider than so many times the span of the values run out of the chart.
const ROOM: f64 = 1.0;

/// Draws numbers of seeds as one PNG: the panels side by side, one legend for all below, what the marks are, and a remark.
///
/// # Errors
/// [`FigureError`] when there is no panel, or the file cannot be written.
pub fn dots(path: impl AsRef<Path>, panels: &[Dots], remark: &str) -> Result<(), FigureError> {
    let path = path.as_ref();
    if panels.is_empty() {
        return Err(FigureError::Nothing { path: path.to_owned(), what: "a chart needs at least one panel" });
    }
    let across = panels.len().min(ACROSS);
    let rows = panels.len().div_ceil(across);
    let inner = across as f32 * (WIDE + GUTTER) - GUTTER;
    let mut entries: Vec<Entry> = Vec::new();
    for column in panels.iter().flat_map(|panel| &panel.columns) {
        let entry = Entry::new(Mark::Dot(colour(column.colour)), column.label.clone());
        if !entries.contains(&entry) {
            entries.push(entry);
        }
    }
    let mut note = "a dot a seed · line = mean, whisker = 95 % t-interval of the mean".to_owned();
    if !remark.is_empty() {
        note += &format!(" · {remark}");
    }
    let below = MARGIN + rows as f32 * (TALL + GUTTER) - GUTTER + 8.0;
    let legend_height = legend::height(&entries, inner);
    let height = below + legend_height + 6.0 + legend::note_height(&note, inner) + MARGIN - 4.0;
    let mut canvas = Canvas::new(path, inner + 2.0 * MARGIN, height)?;
    for (index, panel) in panels.iter().enumerate() {
        let x = MARGIN + (index % across) as f32 * (WIDE + GUTTER);
        let y = MARGIN + (index / across) as f32 * (TALL + GUTTER);
        draw(&mut canvas, panel, Area { x, y, w: WIDE, h: TALL });
    }
    let middle = MARGIN + inner / 2.0;
    legend::draw(&mut canvas, &entries, middle, below, inner);
    legend::draw_note(&mut canvas, &note, middle, below + legend_height + 6.0, inner);
    canvas.save(path)
}

fn draw(canvas: &mut Canvas, panel: &Dots, area: Area) {
    let y_span = span(panel);
    let y_ticks = y_span.ticks(5.0);
    let widest =
        y_ticks.iter().map(|(_, label)| text::width(label, TICK, Weight::Regular)).fold(0.0, f32::max);
    let (left, top) = (LABEL + 14.0 + widest + 8.0, TITLE + 17.0);
    let plot = Area { x: area.x + left, y: area.y + top, w: area.w - left - 8.0, h: area.h - top - 14.0 };
    let (title, size) = text::fit(&panel.title, TITLE, Weight::Bold, area.w);
    canvas.text(&title, (area.middle(), area.y + TITLE), Align::Centre, Font::bold(size));
    let (label, size) = text::fit(&panel.y_label, LABEL, Weight::Regular, plot.h);
    canvas.text_upwards(&label, (area.x + LABEL, plot.y + plot.h / 2.0), Font::plain(size));
    draw_axes(canvas, plot, (&[], Span { low: 0.0, high: 1.0 }), (&y_ticks, y_span));
    let at = |value: f64| plot.bottom() - (y_span.part(value) as f32).clamp(-1.0, 2.0) * plot.h;
    let wide = plot.w / panel.columns.len().max(1) as f32;
    canvas.clipped(plot.grown(1.5), |canvas| {
        for (index, column) in panel.columns.iter().enumerate() {
            draw_column(canvas, column, (plot.x + (index as f32 + 0.5) * wide, wide), at);
        }
    });
    if panel.columns.iter().all(|column| column.values.is_empty()) {
        let font = Font::plain(LABEL).coloured(SOFT);
        canvas.text("no data yet", (plot.middle(), plot.y + plot.h / 2.0), Align::Centre, font);
    }
}

fn draw_column(canvas: &mut Canvas, column: &Column, (middle, wide): (f32, f32), at: impl Fn(f64) -> f32) {
    let (ink, half) = (colour(column.colour), (0.3 * wide).min(46.0));
    let finite: Vec<f64> = column.values.iter().copied().filter(|value| value.is_finite()).collect();
    if finite.len() > 1 {
        let mean = mean_interval(&finite);
        let (low, high) = (at(mean.low), at(mean.high));
        canvas.line(&[(middle, low), (middle, high)], ink, 2.0);
        for y in [low, high] {
            canvas.line(&[(middle - 7.0, y), (middle + 7.0, y)], ink, 2.0);
        }
        canvas.line(&[(middle - half, at(mean.value)), (middle + half, at(mean.value))], ink, 3.0);
    }
    for (index, value) in finite.iter().enumerate() {
        // Side by side in the order of the seeds, so that equal numbers are all seen.
        let part = (index as f32 + 0.5) / finite.len() as f32 - 0.5;
        canvas.disc((middle + 1.6 * part * half, at(*value)), 4.6, faint(ink, 0.55));
    }
}

/// The y axis of a panel.
fn span(panel: &Dots) -> Span {
    let given = panel.y_range.and_then(|(low, high)| Span::of([low, high]));
    let values = || panel.columns.iter().flat_map(|column| column.values.iter().copied());
    let bare = Span::of(values()).unwrap_or(Span { low: 0.0, high: 1.0 }).opened();
    let room = ROOM * (bare.high - bare.low);
    let ends = panel.columns.iter().filter(|column| column.values.len() > 1).flat_map(|column| {
        let mean = mean_interval(&column.values);
        [mean.low.max(bare.low - room), mean.high.min(bare.high + room)]
    });
    let whole = Span::of(values().chain(ends)).unwrap_or(bare).opened();
    given.unwrap_or(whole).padded(0.04)
}
