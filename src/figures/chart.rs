//! Learning curves: every seed as a thin line, their summary as a bold one with its band.

use std::path::Path;

use super::axis::Span;
use super::canvas::{Align, Area, Canvas, Font};
use super::caption;
use super::error::FigureError;
use super::legend;
use super::palette::{Colour, GRID, INK, SOFT, WHITE, colour, faint};
use super::summary::{Place, Summary, clean, summarise};
use super::text::{self, Weight};

/// One chart of a picture.
#[derive(Clone, Debug, Default)]
pub struct Panel {
    /// Stands above the chart.
    pub title: String,
    /// Stands below the chart, such as "environment steps".
    pub x_label: String,
    /// Stands left of the chart, reading upwards.
    pub y_label: String,
    /// The ends of the x axis; without it, the smallest and largest place of all seeds, or 0 where that is near.
    pub x_range: Option<(f64, f64)>,
    /// The ends of the y axis; without it, the smallest and largest value of all seeds.
    pub y_range: Option<(f64, f64)>,
    /// Whether the y axis is one of logarithms; what is not above 0 lies below it.
    pub log: bool,
    /// What the bold line and the band are.
    pub summary: Summary,
    /// Each value is averaged with the ones before it, over this many points; 0 and 1 leave it as it is.
    pub smoothing: usize,
    /// What is compared.
    pub series: Vec<Series>,
    /// Dashed (the second: dotted) lines to compare with, such as the optimum or a random policy.
    pub levels: Vec<Level>,
}

/// The runs of one agent.
#[derive(Clone, Debug, Default)]
pub struct Series {
    /// Its name in the legend.
    pub label: String,
    /// Its colour's number: 0 is black, 1 blue, 2 orange, 3 green …
    pub colour: usize,
    /// One list of (x, y) a seed; the lists may differ in length and places.
    pub runs: Vec<Vec<(f64, f64)>>,
}

/// A known value to compare with.
#[derive(Clone, Debug, Default)]
pub struct Level {
    /// Its name in the legend.
    pub label: String,
    /// The value.
    pub y: f64,
}

/// How panels lie on a sheet, and what else stands below them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sheet {
    /// Panels in a row, at least 1.
    pub columns: usize,
    /// A remark, such as which runs are missing; may be empty.
    pub remark: String,
}

const MARGIN: f32 = 18.0;
const GUTTER: f32 = 26.0;
const TICK: f32 = 14.5;
const LABEL: f32 = 16.5;
const TITLE: f32 = 19.0;
/// Height of a panel with its labels.
const TALL: f32 = 400.0;

/// Draws learning curves as one PNG: the panels side by side (over three in rows), one legend for all below, and a
/// line that says what the marks are.
///
/// A summary is drawn only where *all* seeds have data: a seed that ended early ends it, and does not make it jump.
///
/// ```no_run
/// use inroads::figures::{Panel, Series, Summary, curves};
///
/// let seeds = vec![vec![(0.0, 0.0), (1e4, 0.4), (2e4, 0.9)], vec![(0.0, 0.0), (1e4, 0.6), (2e4, 1.0)]];
/// let panel = Panel {
///     title: "U-maze".into(),
///     x_label: "environment steps".into(),
///     y_label: "success rate".into(),
///     y_range: Some((0.0, 1.0)),
///     summary: Summary::MeanAndInterval,
///     series: vec![Series { label: "DSC".into(), colour: 1, runs: seeds }],
///     ..Panel::default()
/// };
/// curves("curves.png", &[panel])?;
/// # Ok::<(), inroads::figures::FigureError>(())
/// ```
pub fn curves(path: impl AsRef<Path>, panels: &[Panel]) -> Result<(), FigureError> {
    let columns = if panels.len() == 4 { 2 } else { panels.len().min(3) };
    curves_on(path, panels, &Sheet { columns, remark: String::new() })
}

/// The same on a sheet of one's own.
pub fn curves_on(path: impl AsRef<Path>, panels: &[Panel], sheet: &Sheet) -> Result<(), FigureError> {
    let path = path.as_ref();
    if panels.is_empty() {
        return Err(FigureError::Nothing { path: path.to_owned(), what: "a chart needs at least one panel" });
    }
    let columns = sheet.columns.clamp(1, panels.len());
    let rows = panels.len().div_ceil(columns);
    let width = if columns == 1 { 820.0 } else { 1400.0 };
    let inner = width - 2.0 * MARGIN;
    let (entries, mut note) = (caption::entries(panels), caption::note(panels));
    if !sheet.remark.is_empty() {
        note += &format!(" · {}", sheet.remark);
    }
    let legend_height = legend::height(&entries, inner);
    let below = MARGIN + rows as f32 * (TALL + GUTTER) - GUTTER + 12.0;
    let height = below + legend_height + 6.0 + legend::note_height(&note, inner) + MARGIN - 4.0;

    let mut canvas = Canvas::new(path, width, height)?;
    let wide = (inner - (columns - 1) as f32 * GUTTER) / columns as f32;
    for (index, panel) in panels.iter().enumerate() {
        let x = MARGIN + (index % columns) as f32 * (wide + GUTTER);
        let y = MARGIN + (index / columns) as f32 * (TALL + GUTTER);
        draw_panel(&mut canvas, panel, Area { x, y, w: wide, h: TALL });
    }
    legend::draw(&mut canvas, &entries, width / 2.0, below, inner);
    legend::draw_note(&mut canvas, &note, width / 2.0, below + legend_height + 6.0, inner);
    canvas.save(path)
}

/// A series ready to draw.
struct Drawn {
    colour: Colour,
    runs: Vec<Vec<(f64, f64)>>,
    places: Vec<Place>,
}

fn draw_panel(canvas: &mut Canvas, panel: &Panel, area: Area) {
    let drawn: Vec<Drawn> = panel
        .series
        .iter()
        .map(|series| {
            let runs: Vec<_> = series.runs.iter().map(|run| clean(run, panel.smoothing)).collect();
            let places = summarise(&runs, panel.summary);
            Drawn { colour: colour(series.colour), runs, places }
        })
        .collect();
    let points = || drawn.iter().flat_map(|series| series.runs.iter().flatten());
    let empty = points().next().is_none();
    let given = panel.x_range.and_then(|(low, high)| Span::of([low, high]));
    let found = || Span::of(points().map(|point| point.0)).unwrap_or(Span { low: 0.0, high: 1.0 });
    let mut x_span = given.unwrap_or_else(found);
    if x_span.low > 0.0 && x_span.low < 0.25 * x_span.high {
        x_span.low = 0.0;
    }
    // Where a value stands along the axis: itself or its logarithm, which puts 0 below everything.
    let height = |y: f64| if panel.log { y.max(0.0).log10() } else { y };
    let given = panel.y_range.and_then(|(low, high)| Span::of([low, high].map(height)));
    let levels = panel.levels.iter().map(|level| level.y);
    let y_span = given.or_else(|| Span::of(points().map(|point| point.1).chain(levels).map(height)));
    let (x_span, y_span) =
        (x_span.opened(), y_span.unwrap_or(Span { low: 0.0, high: 1.0 }).opened().padded(0.03));

    let y_ticks = match panel.log {
        _ if empty => Vec::new(),
        true => y_span.powers(),
        false => y_span.ticks(5.0),
    };
    let widest =
        y_ticks.iter().map(|(_, label)| text::width(label, TICK, Weight::Regular)).fold(0.0, f32::max);
    let left = LABEL + 14.0 + widest + 8.0;
    let (top, bottom, right) = (TITLE + 17.0, TICK + LABEL + 26.0, 24.0);
    let plot = Area { x: area.x + left, y: area.y + top, w: area.w - left - right, h: area.h - top - bottom };

    let room = 2.0 * (plot.middle() - area.x).min(area.right() - plot.middle());
    let (title, size) = text::fit(&panel.title, TITLE, Weight::Bold, room);
    canvas.text(&title, (plot.middle(), area.y + TITLE), Align::Centre, Font::bold(size));
    let (label, size) = text::fit(&panel.x_label, LABEL, Weight::Regular, plot.w);
    canvas.text(&label, (plot.middle(), area.bottom() - 6.0), Align::Centre, Font::plain(size));
    let (label, size) = text::fit(&panel.y_label, LABEL, Weight::Regular, plot.h);
    canvas.text_upwards(&label, (area.x + LABEL, plot.y + plot.h / 2.0), Font::plain(size));

    let at = |x: f64, y: f64| {
        let (x, y) = (x_span.part(x) as f32, y_span.part(height(y)) as f32);
        // Far outside is as good as outside, and keeps huge bands from overflowing the rasteriser.
        (plot.x + x * plot.w, plot.bottom() - y.clamp(-5.0, 6.0) * plot.h)
    };
    let x_ticks = if empty { Vec::new() } else { x_span.ticks(f64::from(plot.w / 95.0)) };
    draw_axes(canvas, plot, (&x_ticks, x_span), (&y_ticks, y_span));
    canvas.clipped(plot.grown(1.5), |canvas| draw_curves(canvas, panel, &drawn, plot, at));
    if empty {
        let font = Font::plain(LABEL).coloured(SOFT);
        canvas.text("no data yet", (plot.middle(), plot.y + plot.h / 2.0), Align::Centre, font);
    }
}

/// Ticks and grid lines of a plot; the places along the axes are spans' own.
pub(super) fn draw_axes(
    canvas: &mut Canvas,
    plot: Area,
    (x_ticks, x_span): (&[(f64, String)], Span),
    (y_ticks, y_span): (&[(f64, String)], Span),
) {
    let font = Font::plain(TICK).coloured(SOFT);
    for (value, label) in y_ticks {
        let y = (plot.bottom() - y_span.part(*value) as f32 * plot.h).round() + 0.5;
        canvas.line(&[(plot.x, y), (plot.right(), y)], GRID, 1.0);
        canvas.text(label, (plot.x - 8.0, y + TICK * 0.36), Align::Right, font);
    }
    for (value, label) in x_ticks {
        let x = (plot.x + x_span.part(*value) as f32 * plot.w).round() + 0.5;
        canvas.line(&[(x, plot.bottom()), (x, plot.bottom() + 5.0)], INK, 1.2);
        canvas.text(label, (x, plot.bottom() + TICK + 9.0), Align::Centre, font);
    }
    canvas.line(&[(plot.x, plot.y), (plot.x, plot.bottom()), (plot.right(), plot.bottom())], INK, 1.2);
}

fn draw_curves(
    canvas: &mut Canvas,
    panel: &Panel,
    drawn: &[Drawn],
    plot: Area,
    at: impl Fn(f64, f64) -> (f32, f32),
) {
    for (index, level) in panel.levels.iter().enumerate().filter(|(_, level)| level.y.is_finite()) {
        let y = at(0.0, level.y).1;
        canvas.dashed(&[(plot.x, y), (plot.right(), y)], SOFT, 1.6, index);
    }
    for series in drawn {
        let edge = |high: bool| {
            let bands = series.places.iter().filter_map(move |place| Some((place.x, place.band?)));
            bands.map(move |(x, band)| (x, if high { band.1 } else { band.0 })).map(|(x, y)| at(x, y))
        };
        let outline: Vec<_> = edge(true).chain(edge(false).collect::<Vec<_>>().into_iter().rev()).collect();
        canvas.polygon(&outline, faint(series.colour, 0.14));
    }
    for series in drawn {
        for run in &series.runs {
            let line: Vec<_> = run.iter().map(|&(x, y)| at(x, y)).collect();
            let alpha = (3.0 / series.runs.len() as f32).clamp(0.15, 0.42);
            draw_line(canvas, &line, faint(series.colour, alpha), 1.1);
        }
    }
    for series in drawn {
        let line: Vec<_> = series.places.iter().map(|place| at(place.x, place.centre)).collect();
        draw_line(canvas, &line, faint(WHITE, 0.7), 4.6);
        draw_line(canvas, &line, series.colour, 3.0);
    }
}

/// A line, or a dot where there is only one point.
fn draw_line(canvas: &mut Canvas, line: &[(f32, f32)], colour: Colour, width: f32) {
    match line {
        [] => {}
        [point] => canvas.disc(*point, width * 1.6, colour),
        _ => canvas.line(line, colour, width),
    }
}
