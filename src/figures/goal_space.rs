//! How a space of goals grows, as in figure 8.3 of the thesis: a small panel a time, a square a proto-goal.

use std::path::Path;

use inroads_discovery::record::GoalState;

use super::canvas::{Align, Area, Canvas, Font};
use super::error::FigureError;
use super::legend::{self, Entry, Mark};
use super::maze;
use super::palette::{Colour, FLOOR, INK, SOFT, WALL, WHITE, colour, faint, rgb};
use super::text::{self, Weight};

/// All states, from the least to the most.
const STATES: [GoalState; 4] =
    [GoalState::Unseen, GoalState::Pruned, GoalState::Plausible, GoalState::Mastered];

/// What the legend calls a state.
fn name(state: GoalState) -> &'static str {
    match state {
        GoalState::Unseen => "unseen",
        GoalState::Pruned => "seen, not pursued",
        GoalState::Plausible => "plausible",
        GoalState::Mastered => "mastered",
    }
}

fn fill(state: GoalState) -> Colour {
    match state {
        GoalState::Unseen => faint(FLOOR, 0.6),
        GoalState::Pruned => rgb(205, 209, 214),
        GoalState::Plausible => colour(2),
        GoalState::Mastered => colour(1),
    }
}

/// One proto-goal's square.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GoalSquare {
    /// What it belongs to, such as "taxi at": stands above all that have the same.
    pub group: String,
    /// Stands in the square; not drawn in cells.
    pub label: String,
    /// Its column and row, counted from the upper left, where it is about a cell of the world.
    pub cell: Option<[usize; 2]>,
}

/// The goal space at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GoalPanel {
    /// Stands above, such as "episode 200".
    pub title: String,
    /// The state of each square, in their order; squares beyond its end are unseen.
    pub states: Vec<GoalState>,
}

const MARGIN: f32 = 18.0;
const GAP: f32 = 30.0;
/// Width of a panel.
const WIDTH: f32 = 216.0;
/// Height of a panel's title.
const HEAD: f32 = 32.0;
/// Height of a group's heading.
const HEADING: f32 = 24.0;
/// Greatest side of a cell, and height of a square with a label.
const CELL: [f32; 2] = [34.0, 25.0];
/// Between squares with labels.
const BETWEEN: f32 = 5.0;
const LETTERS: f32 = 12.5;

/// Draws one panel a time as one PNG, each with its counts below it.
///
/// # Errors
/// [`FigureError`] when there is no square or no panel, or the file cannot be written.
pub fn goal_space(
    path: impl AsRef<Path>,
    squares: &[GoalSquare],
    panels: &[GoalPanel],
) -> Result<(), FigureError> {
    let path = path.as_ref();
    if squares.is_empty() || panels.is_empty() {
        let what = "a goal space needs at least one goal and one panel";
        return Err(FigureError::Nothing { path: path.to_owned(), what });
    }
    let (places, tall) = arrange(squares);
    let rows = panels.len().div_ceil(6);
    let columns = panels.len().div_ceil(rows);
    let width = 2.0 * MARGIN + (columns as f32 * (WIDTH + GAP) - GAP).max(2.5 * WIDTH);
    let left = (width - columns as f32 * (WIDTH + GAP) + GAP) / 2.0;
    let shown = |state| panels.iter().any(|panel| (0..squares.len()).any(|nth| panel.state(nth) == state));
    let entries: Vec<_> = STATES
        .into_iter()
        .filter(|state| shown(*state))
        .map(|state| Entry::new(Mark::Goals(state), name(state)))
        .collect();
    let inner = width - 2.0 * MARGIN;
    let high = HEAD + tall + COUNTS;
    let below = MARGIN + rows as f32 * (high + GAP) - GAP + 14.0;
    let mut canvas = Canvas::new(path, width, below + legend::height(&entries, inner) + MARGIN - 6.0)?;
    for (nth, panel) in panels.iter().enumerate() {
        let x = left + (nth % columns) as f32 * (WIDTH + GAP);
        let y = MARGIN + (nth / columns) as f32 * (high + GAP);
        draw(&mut canvas, squares, &places, panel, Area { x, y, w: WIDTH, h: high });
    }
    legend::draw(&mut canvas, &entries, width / 2.0, below, inner);
    canvas.save(path)
}

impl GoalPanel {
    fn state(&self, square: usize) -> GoalState {
        self.states.get(square).copied().unwrap_or(GoalState::Unseen)
    }
}

/// Height of the counts below a panel.
const COUNTS: f32 = 26.0;

/// What stands where in every panel.
struct Places {
    /// Headings and their heights in the panel.
    headings: Vec<(String, f32)>,
    /// The area of each square.
    squares: Vec<Area>,
}

/// Groups below each other; cells as a grid, others in rows as words fill lines. Also the height of it all.
fn arrange(squares: &[GoalSquare]) -> (Places, f32) {
    let mut groups: Vec<(&str, Vec<usize>)> = Vec::new();
    for (nth, square) in squares.iter().enumerate() {
        match groups.iter_mut().find(|(name, _)| *name == square.group) {
            Some((_, members)) => members.push(nth),
            None => groups.push((&square.group, vec![nth])),
        }
    }
    let empty = Area { x: 0.0, y: 0.0, w: 0.0, h: 0.0 };
    let mut places = Places { headings: Vec::new(), squares: vec![empty; squares.len()] };
    let mut y = 0.0;
    for (name, members) in groups {
        if !name.is_empty() {
            places.headings.push((name.to_owned(), y + HEADING - 9.0));
            y += HEADING;
        }
        let (cells, others): (Vec<usize>, Vec<usize>) =
            members.into_iter().partition(|&nth| squares[nth].cell.is_some());
        y = grid(squares, &cells, y, &mut places);
        y = rows(squares, &others, y, &mut places) + 6.0;
    }
    (places, y)
}

fn grid(squares: &[GoalSquare], members: &[usize], y: f32, places: &mut Places) -> f32 {
    let cells = || members.iter().filter_map(|&nth| squares[nth].cell);
    let Some(columns) = cells().map(|[column, _]| column + 1).max() else { return y };
    let rows = cells().map(|[_, row]| row + 1).max().unwrap_or(1);
    let side = (WIDTH / columns as f32).min(CELL[0]);
    let x = (WIDTH - columns as f32 * side) / 2.0;
    for &nth in members {
        let [column, row] = squares[nth].cell.unwrap_or_default();
        places.squares[nth] =
            Area { x: x + column as f32 * side, y: y + row as f32 * side, w: side, h: side };
    }
    y + rows as f32 * side
}

fn rows(squares: &[GoalSquare], members: &[usize], y: f32, places: &mut Places) -> f32 {
    let wide = |nth: usize| {
        (text::width(&squares[nth].label, LETTERS, Weight::Regular) + 12.0).clamp(CELL[1], WIDTH)
    };
    let mut lines: Vec<(f32, Vec<usize>)> = Vec::new();
    for &nth in members {
        match lines.last_mut() {
            Some((used, line)) if *used + BETWEEN + wide(nth) <= WIDTH => {
                *used += BETWEEN + wide(nth);
                line.push(nth);
            }
            _ => lines.push((wide(nth), vec![nth])),
        }
    }
    for (row, (used, line)) in lines.iter().enumerate() {
        let mut x = (WIDTH - used) / 2.0;
        for &nth in line {
            places.squares[nth] =
                Area { x, y: y + row as f32 * (CELL[1] + BETWEEN), w: wide(nth), h: CELL[1] };
            x += wide(nth) + BETWEEN;
        }
    }
    y + lines.len() as f32 * (CELL[1] + BETWEEN)
}

fn draw(canvas: &mut Canvas, squares: &[GoalSquare], places: &Places, panel: &GoalPanel, area: Area) {
    let (title, size) = text::fit(&panel.title, 17.5, Weight::Bold, area.w);
    canvas.text(&title, (area.middle(), area.y + 17.0), Align::Centre, Font::bold(size));
    let top = area.y + HEAD;
    for (heading, y) in &places.headings {
        let (heading, size) = text::fit(heading, 13.5, Weight::Regular, area.w);
        canvas.text(&heading, (area.middle(), top + y), Align::Centre, Font::plain(size).coloured(SOFT));
    }
    for (nth, square) in squares.iter().enumerate() {
        let at = places.squares[nth];
        let at = Area { x: area.x + at.x, y: top + at.y, ..at };
        let state = panel.state(nth);
        tile(canvas, at, state);
        if square.cell.is_none() {
            let ink = match state {
                GoalState::Mastered => WHITE,
                GoalState::Unseen => SOFT,
                GoalState::Pruned | GoalState::Plausible => INK,
            };
            let (label, size) = text::fit(&square.label, LETTERS, Weight::Regular, at.w - 8.0);
            let font = Font::plain(size).coloured(ink);
            canvas.text(&label, (at.middle(), at.y + at.h / 2.0 + 0.36 * size), Align::Centre, font);
        }
    }
    let count = |state| (0..squares.len()).filter(|&nth| panel.state(nth) == state).count();
    let counts = format!(
        "{} seen · {} plausible · {} mastered",
        squares.len() - count(GoalState::Unseen),
        count(GoalState::Plausible) + count(GoalState::Mastered),
        count(GoalState::Mastered)
    );
    let (counts, size) = text::fit(&counts, 13.5, Weight::Regular, area.w);
    canvas.text(
        &counts,
        (area.middle(), area.bottom() - 8.0),
        Align::Centre,
        Font::plain(size).coloured(SOFT),
    );
}

/// The square of a goal: what is seen and not pursued is crossed out.
pub(super) fn tile(canvas: &mut Canvas, area: Area, state: GoalState) {
    // Whole pixels keep the edges sharp and all squares of one size.
    let (x, y) = (area.x.round() + 0.5, area.y.round() + 0.5);
    let area = Area { x, y, w: area.w.round() - 1.0, h: area.h.round() - 1.0 };
    canvas.areas([area], fill(state));
    if state == GoalState::Pruned {
        canvas.line(
            &[(area.x + 3.0, area.bottom() - 3.0), (area.right() - 3.0, area.y + 3.0)],
            faint(WHITE, 0.9),
            1.6,
        );
    }
    maze::frame(canvas, area, WALL, 1.0);
}
