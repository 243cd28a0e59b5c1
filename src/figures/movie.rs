//! An episode as a GIF: the robot in its maze, seen from above.

use std::path::Path;

use super::animation;
use super::canvas::{Align, Area, Canvas, Font, encoding};
use super::error::{FigureError, write};
use super::indexed::{Palette, Rgb};
use super::map::{Map, View};
use super::maze::{self, is_finite};
use super::palette::{SOFT, WHITE, colour, skill_name};
use super::text::{self, Weight};
use super::trajectory::trail;

/// Where the robot is in one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose {
    /// The environment step, shown in the corner: frames may leave steps out.
    pub step: usize,
    /// Its position.
    pub at: [f32; 2],
    /// Where it looks, in radians from the x axis towards the y axis.
    pub heading: f32,
    /// The skill that acts (0: the global option, that is primitive actions).
    pub skill: usize,
}

const MARGIN: f32 = 10.0;
const WIDTH: f32 = 460.0;
const CAPTION: f32 = 34.0;
/// Hundredths of a second.
const DELAY: u16 = 7;

/// Draws one frame a pose, as an endless GIF of about 14 frames a second that rests on its last frame.
///
/// A hundred frames take about 100 kB. Each frame draws the whole trail anew, so give it some hundred frames and leave
/// steps out of longer episodes.
pub fn movie(path: impl AsRef<Path>, map: &Map, frames: &[Pose]) -> Result<(), FigureError> {
    let path = path.as_ref();
    map.check(path)?;
    if frames.is_empty() {
        return Err(FigureError::Nothing { path: path.to_owned(), what: "a movie needs at least one frame" });
    }
    let stage = Stage::new(path, map)?;
    let some = (0..frames.len()).step_by(frames.len().div_ceil(24)).map(|last| stage.frame(frames, last));
    let palette = Palette::of(some, 255);
    let bytes =
        animation::encode(stage.size(), palette, DELAY, frames.len(), |last| stage.frame(frames, last))
            .map_err(|error| encoding(path, &error))?;
    write(path, &bytes)
}

/// What stays the same in all frames.
struct Stage<'a> {
    map: &'a Map,
    view: View,
    background: tiny_skia::Pixmap,
}

impl<'a> Stage<'a> {
    fn new(path: &Path, map: &'a Map) -> Result<Self, FigureError> {
        let tall = WIDTH * map.shape();
        let mut canvas = Canvas::new(path, WIDTH + 2.0 * MARGIN, tall + 2.0 * MARGIN + CAPTION)?;
        let view = View::fit(map.bounds, Area { x: MARGIN, y: MARGIN, w: WIDTH, h: tall });
        maze::floor(&mut canvas, &view);
        maze::walls(&mut canvas, map, &view);
        Ok(Self { map, view, background: canvas.pixels().clone() })
    }

    fn size(&self) -> (u16, u16) {
        (self.background.width() as u16, self.background.height() as u16)
    }

    /// The pixels of the frame that ends with pose `last`.
    fn frame(&self, poses: &[Pose], last: usize) -> Vec<Rgb> {
        let mut canvas = Canvas::over(self.background.clone());
        let view = &self.view;
        canvas.clipped(view.area, |canvas| {
            maze::goals(canvas, self.map, view);
            trail(canvas, view, poses[..=last].iter().map(|pose| (pose.at, pose.skill)), 3.0);
            maze::starts(canvas, self.map, view);
            robot(canvas, view, &poses[last]);
        });
        let pose = &poses[last];
        let base = view.area.bottom() + CAPTION - 9.0;
        let step = format!("step {}", pose.step);
        let room = view.area.w - 34.0 - text::width(&step, 16.0, Weight::Regular);
        let (name, size) = text::fit(&skill_name(pose.skill), 16.0, Weight::Bold, room);
        canvas.disc((view.area.x + 7.0, base - 6.0), 7.0, colour(pose.skill));
        canvas.text(&name, (view.area.x + 22.0, base), Align::Left, Font::bold(size));
        canvas.text(&step, (view.area.right(), base), Align::Right, Font::plain(16.0).coloured(SOFT));
        canvas.rgb()
    }
}

/// A disc in the skill's colour with a white rim and a nose.
fn robot(canvas: &mut Canvas, view: &View, pose: &Pose) {
    if !is_finite(pose.at) {
        return;
    }
    let (x, y) = view.at(pose.at);
    let radius = 10.0;
    canvas.disc((x, y), radius + 2.0, WHITE);
    canvas.disc((x, y), radius, colour(pose.skill));
    if pose.heading.is_finite() {
        let ahead = |angle: f32, far: f32| {
            let (sin, cos) = (pose.heading + angle).sin_cos();
            (x + cos * far * radius, y - sin * far * radius)
        };
        let nose = [ahead(0.0, 0.95), ahead(2.4, 0.6), ahead(0.0, -0.2), ahead(-2.4, 0.6)];
        canvas.polygon(&nose, WHITE);
    }
}
