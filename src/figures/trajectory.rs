//! Paths through the maze, coloured by what was acting, as in figure 3.3 of the thesis.

use std::path::Path;

use super::canvas::{Area, Canvas};
use super::error::FigureError;
use super::legend::{self, Entry, Mark};
use super::map::{Map, View};
use super::maze::{self, is_finite};
use super::palette::{colour, faint, skill_name};
use super::sets::places;

/// The path of one episode: at each point, which skill acted there (0: the global option, that is primitive actions).
///
/// The stretch from a point to the next has the colour of the skill that acted at the first of the two.
#[derive(Clone, Debug, Default)]
pub struct Trajectory {
    /// Positions and skills, in order of time.
    pub points: Vec<([f32; 2], usize)>,
}

const MARGIN: f32 = 18.0;
const WIDTH: f32 = 640.0;
/// Skills that the legend names; more, no reader tells apart by colour.
const NAMED: usize = 14;

/// Draws all trajectories on one map, as one PNG, with a legend of the skills that acted and a remark below.
pub fn trajectories(
    path: impl AsRef<Path>,
    map: &Map,
    trajectories: &[Trajectory],
    note: &str,
) -> Result<(), FigureError> {
    let path = path.as_ref();
    map.check(path)?;
    let mut skills: Vec<usize> =
        trajectories.iter().flat_map(|trajectory| trajectory.points.iter().map(|point| point.1)).collect();
    skills.sort_unstable();
    skills.dedup();
    let named =
        skills.iter().take(NAMED).map(|skill| Entry::new(Mark::Line(colour(*skill)), skill_name(*skill)));
    let entries: Vec<Entry> = named.chain(places(map)).collect();
    let unnamed = match skills.len().saturating_sub(NAMED) {
        0 => String::new(),
        1 => "and another skill".to_owned(),
        more => format!("and {more} more skills"),
    };
    let note =
        [unnamed.as_str(), note].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" · ");

    let tall = WIDTH * map.shape();
    let below = MARGIN + tall + 12.0;
    let legend_height = legend::height(&entries, WIDTH);
    let height = below + legend_height + legend::note_height(&note, WIDTH) + MARGIN - 8.0;
    let mut canvas = Canvas::new(path, WIDTH + 2.0 * MARGIN, height)?;
    let view = View::fit(map.bounds, Area { x: MARGIN, y: MARGIN, w: WIDTH, h: tall });
    maze::floor(&mut canvas, &view);
    maze::walls(&mut canvas, map, &view);
    canvas.clipped(view.area, |canvas| {
        maze::goals(canvas, map, &view);
        for trajectory in trajectories {
            draw(canvas, &view, &trajectory.points);
        }
        maze::starts(canvas, map, &view);
    });
    legend::draw(&mut canvas, &entries, MARGIN + WIDTH / 2.0, below, WIDTH);
    legend::draw_note(&mut canvas, &note, MARGIN + WIDTH / 2.0, below + legend_height, WIDTH);
    canvas.save(path)
}

fn draw(canvas: &mut Canvas, view: &View, points: &[([f32; 2], usize)]) {
    trail(canvas, view, points.iter().copied(), 2.4);
    for (at, skill) in points.iter().filter(|(at, _)| is_finite(*at)) {
        canvas.disc(view.at(*at), 2.6, colour(*skill));
    }
}

/// A line in as many pieces as the acting skill changes, interrupted where a position is not a number.
pub(super) fn trail(
    canvas: &mut Canvas,
    view: &View,
    points: impl Iterator<Item = ([f32; 2], usize)>,
    width: f32,
) {
    let mut piece: Vec<(f32, f32)> = Vec::new();
    let mut acting = 0;
    let mut end = |piece: &mut Vec<(f32, f32)>, skill| {
        if piece.len() > 1 {
            canvas.line(piece, faint(colour(skill), 0.9), width);
        }
        piece.clear();
    };
    for (at, skill) in points {
        if !is_finite(at) {
            end(&mut piece, acting);
            continue;
        }
        piece.push(view.at(at));
        if skill != acting {
            end(&mut piece, acting);
            piece.push(view.at(at));
            acting = skill;
        }
    }
    end(&mut piece, acting);
}
