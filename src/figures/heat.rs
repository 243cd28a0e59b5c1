//! Numbers of cells: truth beside belief on a grid.

use std::path::Path;

use super::canvas::{Align, Area, Canvas, Font};
use super::error::FigureError;
use super::legend;
use super::maze;
use super::palette::{Colour, INK, SOFT, WALL, WHITE, colour, rgb};
use super::text::{self, Weight};

/// One grid of a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Heat {
    /// Stands above the grid.
    pub title: String,
    /// Stands below it in grey.
    pub note: String,
    /// Cells a row.
    pub columns: usize,
    /// A number in [0, 1] a cell, row by row from the *top*; none is a wall.
    pub cells: Vec<Option<f64>>,
    /// The cells of a set, whose outline is drawn.
    pub inside: Vec<bool>,
    /// The cell of the goal.
    pub goal: Option<usize>,
}

const MARGIN: f32 = 18.0;
const GUTTER: f32 = 22.0;
const TITLE: f32 = 15.5;
const NOTE: f32 = 13.0;
/// A cell's side.
const SIDE: f32 = 17.0;
/// Width of the bar that says which colour is which number.
pub(super) const BAR: f32 = 240.0;

/// The colour of a number: white is 0, dark blue 1.
pub(super) fn shade(value: f64) -> Colour {
    let part = value.clamp(0.0, 1.0) as f32;
    let full = colour(1).rgb;
    let mix = |i: usize| (255.0 + (f32::from(full[i]) - 255.0) * part).round() as u8;
    rgb(mix(0), mix(1), mix(2))
}

/// Draws grids as one PNG, `across` in a row, with a bar for the colours and a line that says what they are.
///
/// # Errors
/// [`FigureError`] when there is no grid, or the file cannot be written.
pub fn heat(path: impl AsRef<Path>, grids: &[Heat], across: usize, caption: &str) -> Result<(), FigureError> {
    let path = path.as_ref();
    let rows_of = |grid: &Heat| grid.cells.len().div_ceil(grid.columns.max(1));
    let (Some(columns), Some(rows)) =
        (grids.iter().map(|g| g.columns).max(), grids.iter().map(rows_of).max())
    else {
        let what = "a picture of grids needs at least one grid";
        return Err(FigureError::Nothing { path: path.to_owned(), what });
    };
    let (wide, tall) = (columns as f32 * SIDE, rows as f32 * SIDE + TITLE + NOTE + 18.0);
    let across = across.clamp(1, grids.len());
    let down = grids.len().div_ceil(across);
    let width = (2.0 * MARGIN + across as f32 * (wide + GUTTER) - GUTTER).max(480.0);
    let left = (width - across as f32 * (wide + GUTTER) + GUTTER) / 2.0;
    let inner = width - 2.0 * MARGIN;
    let below = MARGIN + down as f32 * (tall + GUTTER);
    let height = below + 34.0 + legend::note_height(caption, inner) + MARGIN;
    let mut canvas = Canvas::new(path, width, height)?;
    for (index, grid) in grids.iter().enumerate() {
        let x = left + (index % across) as f32 * (wide + GUTTER);
        let y = MARGIN + (index / across) as f32 * (tall + GUTTER);
        grid.draw(&mut canvas, x.round(), y.round());
    }
    bar(&mut canvas, (width - BAR) / 2.0, below);
    legend::draw_note(&mut canvas, caption, width / 2.0, below + 34.0, inner);
    canvas.save(path)
}

/// The colours from 0 to 1.
pub(super) fn bar(canvas: &mut Canvas, x: f32, y: f32) {
    const STEPS: u8 = 20;
    for step in 0..STEPS {
        let w = BAR / f32::from(STEPS);
        let part = Area { x: (x + f32::from(step) * w).round(), y, w: w.ceil(), h: 14.0 };
        canvas.areas([part], shade(f64::from(step) / f64::from(STEPS - 1)));
    }
    let font = Font::plain(NOTE).coloured(SOFT);
    canvas.text("0", (x - 8.0, y + 12.0), Align::Right, font);
    canvas.text("1", (x + BAR + 8.0, y + 12.0), Align::Left, font);
}

impl Heat {
    fn draw(&self, canvas: &mut Canvas, x: f32, y: f32) {
        let wide = self.columns as f32 * SIDE;
        let (title, size) = text::fit(&self.title, TITLE, Weight::Bold, wide);
        canvas.text(&title, (x + wide / 2.0, y + TITLE - 2.0), Align::Centre, Font::bold(size));
        // Whole pixels, so that no seam shows between cells.
        let top = (y + TITLE + 6.0).round();
        let area = |index: usize| Area {
            x: x + (index % self.columns) as f32 * SIDE,
            y: top + (index / self.columns) as f32 * SIDE,
            w: SIDE,
            h: SIDE,
        };
        for (index, cell) in self.cells.iter().enumerate() {
            canvas.areas([area(index)], cell.map_or(WALL, shade));
        }
        let inside = |index: usize| self.inside.get(index).copied().unwrap_or(false);
        for index in (0..self.cells.len()).filter(|index| inside(*index)) {
            let Area { x, y, w, h } = area(index);
            let column = index % self.columns;
            let (left, right) = (x + 1.0, x + w - 1.0);
            let (up, down) = (y + 1.0, y + h - 1.0);
            let next = |there: bool, other: usize| there && inside(other);
            let edges = [
                (next(column > 0, index.wrapping_sub(1)), [(left, up), (left, down)]),
                (next(column + 1 < self.columns, index + 1), [(right, up), (right, down)]),
                (inside(index.wrapping_sub(self.columns)), [(left, up), (right, up)]),
                (inside(index + self.columns), [(left, down), (right, down)]),
            ];
            for (_, edge) in edges.iter().filter(|(shared, _)| !shared) {
                canvas.line(edge, colour(6), 2.0);
            }
        }
        if let Some(goal) = self.goal.map(area) {
            maze::goal(canvas, (goal.middle(), goal.y + SIDE / 2.0), SIDE / 2.0 - 2.0);
        }
        let bottom = top + self.cells.len().div_ceil(self.columns.max(1)) as f32 * SIDE;
        let frame = Area { x, y: top, w: wide, h: bottom - top };
        maze::frame(canvas, frame, if self.cells.is_empty() { WHITE } else { INK }, 1.0);
        let (note, size) = text::fit(&self.note, NOTE, Weight::Regular, wide);
        let font = Font::plain(size).coloured(SOFT);
        canvas.text(&note, (x + wide / 2.0, bottom + NOTE + 3.0), Align::Centre, font);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_grids_give_the_same_bytes_and_none_is_an_error() {
        let folder = std::env::temp_dir().join(format!("inroads-heat-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let grid = Heat {
            title: "truth".into(),
            columns: 3,
            cells: vec![None, Some(0.0), Some(1.0), Some(f64::NAN), None, Some(0.5)],
            inside: vec![false, true, true],
            goal: Some(2),
            ..Heat::default()
        };
        let bytes = [folder.join("a.png"), folder.join("b.png")].map(|path| {
            heat(&path, &[grid.clone(), grid.clone()], 2, "a caption").unwrap();
            std::fs::read(path).unwrap()
        });
        assert!(bytes[0] == bytes[1] && bytes[0].len() > 500);
        assert!(matches!(heat(folder.join("c.png"), &[], 2, ""), Err(FigureError::Nothing { .. })));
        std::fs::remove_dir_all(folder).unwrap();
        assert_eq!((shade(0.0), shade(1.0)), (rgb(255, 255, 255), colour(1)));
    }
}
