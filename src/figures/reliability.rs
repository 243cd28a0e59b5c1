//! Whether what is predicted happens so often: reliability diagrams.

use std::path::Path;

use super::axis::Span;
use super::canvas::{Align, Area, Canvas, Font};
use super::error::FigureError;
use super::legend::{self, Entry, Mark};
use super::palette::{GRID, INK, SOFT, WHITE, colour, faint};
use super::text::{self, Weight};

/// Predictions of one kind and what came of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Calibration {
    /// Its name in the legend.
    pub label: String,
    /// Its colour's number.
    pub colour: usize,
    /// Predicted probability, and what came of it: 0 or 1, or a probability that was measured.
    pub pairs: Vec<(f64, f64)>,
}

/// Predictions that are about the same.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bin {
    /// Mean of the predictions.
    pub predicted: f64,
    /// Mean of what came of them.
    pub measured: f64,
    /// How many there are.
    pub count: usize,
}

impl Calibration {
    /// The pairs that are numbers; predictions are cut off at 0 and 1.
    fn numbers(&self) -> impl Iterator<Item = (f64, f64)> {
        let pairs = self.pairs.iter().filter(|(p, o)| p.is_finite() && o.is_finite());
        pairs.map(|(p, o)| (p.clamp(0.0, 1.0), *o))
    }

    /// Brier's score, the mean squared difference (Brier, 1950): 0 is perfect, 0.25 what a constant 0.5 has of coin
    /// tosses. NaN without pairs.
    pub fn brier(&self) -> f64 {
        let (sum, count) =
            self.numbers().fold((0.0, 0_usize), |(sum, n), (p, o)| (sum + (p - o).powi(2), n + 1));
        sum / count as f64
    }

    /// Predictions of `bins` equal stretches of [0, 1], empty ones left out.
    pub fn bins(&self, bins: usize) -> Vec<Bin> {
        let mut sums = vec![Bin::default(); bins.max(1)];
        for (predicted, measured) in self.numbers() {
            let nth = ((predicted * sums.len() as f64) as usize).min(sums.len() - 1);
            let bin = &mut sums[nth];
            *bin = Bin {
                predicted: bin.predicted + predicted,
                measured: bin.measured + measured,
                count: bin.count + 1,
            };
        }
        let mean = |bin: Bin| Bin {
            predicted: bin.predicted / bin.count as f64,
            measured: bin.measured / bin.count as f64,
            ..bin
        };
        sums.into_iter().filter(|bin| bin.count > 0).map(mean).collect()
    }
}

const MARGIN: f32 = 18.0;
const TICK: f32 = 14.5;
const LABEL: f32 = 16.5;
/// Side of the diagram, and height of the counts below it.
const SIDE: f32 = 440.0;
const COUNTS: f32 = 74.0;
/// Stretches into which [0, 1] is cut.
const BINS: usize = 10;

/// Draws one diagram with all series as one PNG: points on the diagonal are right, the larger the more predictions
/// they stand for; below it how many predictions each stretch has, and in the legend Brier's score.
///
/// # Errors
/// [`FigureError`] when the file cannot be written.
pub fn reliability(path: impl AsRef<Path>, title: &str, series: &[Calibration]) -> Result<(), FigureError> {
    let path = path.as_ref();
    let left = LABEL + 14.0 + text::width("0.0", TICK, Weight::Regular) + 14.0;
    let width = 2.0 * MARGIN + left + SIDE + 24.0;
    let entries: Vec<_> =
        series.iter().map(entry).chain([Entry::new(Mark::Level(0), "as predicted")]).collect();
    let inner = width - 2.0 * MARGIN;
    let plot = Area { x: MARGIN + left, y: MARGIN + 38.0, w: SIDE, h: SIDE };
    let counts = Area { y: plot.bottom() + 14.0, h: COUNTS, ..plot };
    let below = counts.bottom() + TICK + LABEL + 30.0;
    let mut canvas = Canvas::new(path, width, below + legend::height(&entries, inner) + MARGIN - 6.0)?;

    let (title, size) = text::fit(title, 19.0, Weight::Bold, inner);
    canvas.text(&title, (width / 2.0, MARGIN + 19.0), Align::Centre, Font::bold(size));
    draw_axes(&mut canvas, plot, counts);
    let at =
        |x: f64, y: f64| (plot.x + x as f32 * plot.w, plot.bottom() - y.clamp(-1.0, 2.0) as f32 * plot.h);
    canvas.dashed(&[at(0.0, 0.0), at(1.0, 1.0)], SOFT, 1.6, 0);
    let binned: Vec<_> = series.iter().map(|series| (colour(series.colour), series.bins(BINS))).collect();
    let most = binned.iter().flat_map(|(_, bins)| bins).map(|bin| bin.count).max().unwrap_or(0);
    canvas.clipped(plot.grown(10.0), |canvas| {
        for (colour, bins) in &binned {
            let line: Vec<_> = bins.iter().map(|bin| at(bin.predicted, bin.measured)).collect();
            canvas.line(&line, faint(*colour, 0.55), 2.2);
            for (bin, at) in bins.iter().zip(line) {
                let r = 3.5 + 5.5 * (bin.count as f32 / most as f32).sqrt();
                canvas.disc(at, r + 1.2, WHITE);
                canvas.disc(at, r, *colour);
            }
        }
    });
    draw_counts(&mut canvas, series, counts, most);
    if most == 0 {
        let font = Font::plain(LABEL).coloured(SOFT);
        canvas.text("no data yet", (plot.middle(), plot.y + plot.h / 4.0), Align::Centre, font);
    }
    legend::draw(&mut canvas, &entries, width / 2.0, below, inner);
    canvas.save(path)
}

fn entry(series: &Calibration) -> Entry {
    let count = series.numbers().count();
    let score = match count {
        0 => "no predictions".to_owned(),
        1 => format!("Brier {:.3}, 1 prediction", series.brier()),
        _ => format!("Brier {:.3}, {count} predictions", series.brier()),
    };
    Entry::new(Mark::Dot(colour(series.colour)), format!("{}: {score}", series.label))
}

fn draw_axes(canvas: &mut Canvas, plot: Area, counts: Area) {
    let soft = Font::plain(TICK).coloured(SOFT);
    for (value, label) in (Span { low: 0.0, high: 1.0 }).ticks(5.0) {
        let (x, y) = (plot.x + value as f32 * plot.w, plot.bottom() - value as f32 * plot.h);
        let (x, y) = (x.round() + 0.5, y.round() + 0.5);
        canvas.line(&[(plot.x, y), (plot.right(), y)], GRID, 1.0);
        canvas.line(&[(x, plot.y), (x, plot.bottom())], GRID, 1.0);
        canvas.text(&label, (plot.x - 8.0, y + TICK * 0.36), Align::Right, soft);
        canvas.line(&[(x, counts.bottom()), (x, counts.bottom() + 5.0)], INK, 1.2);
        canvas.text(&label, (x, counts.bottom() + TICK + 9.0), Align::Centre, soft);
    }
    canvas.line(&[(plot.x, plot.y), (plot.x, plot.bottom()), (plot.right(), plot.bottom())], INK, 1.2);
    canvas.line(&[(counts.x, counts.bottom()), (counts.right(), counts.bottom())], INK, 1.2);
    let font = Font::plain(LABEL);
    canvas.text_upwards("measured", (MARGIN + LABEL, plot.y + plot.h / 2.0), font);
    canvas.text(
        "predicted probability",
        (plot.middle(), counts.bottom() + TICK + LABEL + 18.0),
        Align::Centre,
        font,
    );
    canvas.text_upwards("count", (MARGIN + LABEL, counts.y + counts.h / 2.0), Font::plain(LABEL - 2.0));
}

/// A bar a series and stretch.
fn draw_counts(canvas: &mut Canvas, series: &[Calibration], area: Area, most: usize) {
    let stretch = area.w / BINS as f32;
    let wide = (stretch - 8.0) / series.len().max(1) as f32;
    for (nth, series) in series.iter().enumerate() {
        for bin in series.bins(BINS) {
            let place = (bin.predicted * BINS as f64).floor().min(BINS as f64 - 1.0) as f32;
            let h = (area.h - TICK) * bin.count as f32 / most.max(1) as f32;
            let x = area.x + place * stretch + 4.0 + nth as f32 * wide;
            let bar = Area { x, y: area.bottom() - h, w: wide - 1.0, h };
            canvas.areas([bar], faint(colour(series.colour), 0.75));
            let count = bin.count.to_string();
            if text::width(&count, 10.5, Weight::Regular) <= wide + 4.0 {
                let at = (bar.middle(), bar.y - 3.0);
                canvas.text(&count, at, Align::Centre, Font::plain(10.5).coloured(SOFT));
            }
        }
    }
}
