//! The floor and what is painted on it. Borders are as sharp as the pixels allow, and no sharper.

use rapier3d::math::Vector;

use super::{
    Mark, Scene,
    bins::Bins,
    body::Body,
    colour::{self, Light, light},
    lens::{Lens, Ray},
};

/// The two shades of its squares.
const SQUARES: [Light; 2] = [light([233, 236, 241]), light([225, 229, 236])];
/// The trail.
const TRAIL: Light = light(colour::TRAIL);
/// About so many squares fit along the frame's shorter side.
const SQUARES_ACROSS: f32 = 12.0;
/// The trail's width: a share of the frame's shorter side, and at least so many pixels.
const TRAIL_WIDTH: [f32; 2] = [0.009, 1.6];
/// How much the trail covers the floor where it ends and where it begins.
const TRAIL_COVER: [f32; 2] = [0.95, 0.35];
/// The cell of the grid by which pieces of trail are found, pixels.
const CELL: f32 = 8.0;
/// The rim of a mark: its share of the radius, and how much darker it is.
const RIM: [f32; 2] = [0.12, 0.72];

/// A floor made ready for a frame.
pub(super) struct Floor<'a> {
    marks: Vec<&'a Mark>,
    /// Side of a square, metres.
    square: f32,
    strokes: Vec<Stroke>,
    bins: Bins,
    /// Half the trail's width, metres.
    half_width: f32,
}

/// A straight piece of the trail.
struct Stroke {
    from: [f32; 2],
    along: [f32; 2],
    cover: f32,
}

impl<'a> Floor<'a> {
    /// `across` is how many metres the frame's shorter side shows.
    pub(super) fn new(scene: &'a Scene, lens: &Lens, size: [f32; 2], across: f32) -> Self {
        let half_width = across * TRAIL_WIDTH[0].max(TRAIL_WIDTH[1] / size[0].min(size[1])) / 2.0;
        let strokes = strokes(&scene.trail, half_width);
        let flat = |[x, y]: [f32; 2]| Vector::new(x, y, 0.0);
        let line = |stroke: &Stroke| Body::line(flat(stroke.from), flat(stroke.along), half_width);
        let bins = lens.bins(size, CELL, &strokes.iter().map(line).collect::<Vec<_>>());
        let sound = |mark: &&Mark| {
            mark.at.iter().all(|x| x.is_finite()) && mark.radius.is_finite() && mark.radius > 0.0
        };
        let marks = scene.marks.iter().filter(sound).collect();
        Self { marks, square: round_length(across / SQUARES_ACROSS), strokes, bins, half_width }
    }

    /// The paint that a ray meets at a point of the floor; `x` and `y` are where in the frame the ray begins.
    pub(super) fn paint(&self, lens: &Lens, ray: &Ray, at: Vector, [x, y]: [f32; 2]) -> Light {
        let steps = Steps::new(lens, ray, at);
        let mut paint = self.squares(at, &steps);
        for mark in &self.marks {
            let offset = [at.x - mark.at[0], at.y - mark.at[1]];
            let from_centre = length(offset);
            if from_centre > mark.radius + steps.most {
                continue;
            }
            let pixel = steps.across(offset);
            let cover = |radius: f32| ((radius - from_centre) / pixel + 0.5).clamp(0.0, 1.0);
            let inner = cover(mark.radius * (1.0 - RIM[0]));
            let colour = light(mark.colour) * (RIM[1] + (1.0 - RIM[1]) * inner);
            paint = paint.lerp(colour, cover(mark.radius));
        }
        let mut most = 0.0_f32;
        for &stroke in self.bins.at(x, y) {
            let stroke = &self.strokes[stroke as usize];
            let offset = [at.x - stroke.from[0], at.y - stroke.from[1]];
            let share = dot(offset, stroke.along) / dot(stroke.along, stroke.along);
            let share = share.clamp(0.0, 1.0);
            let aside = [offset[0] - stroke.along[0] * share, offset[1] - stroke.along[1] * share];
            let outside = length(aside) - self.half_width;
            let cover = (0.5 - outside / steps.across(aside)).clamp(0.0, 1.0);
            most = most.max(cover * stroke.cover);
        }
        if most > 0.0 { paint.lerp(TRAIL, most) } else { paint }
    }

    fn squares(&self, at: Vector, steps: &Steps) -> Light {
        // The mean over a pixel of a wave that is 1 on even squares and −1 on odd ones.
        let wave = |x: f32, pixel: f32| {
            let (x, half) = (x / self.square, pixel / self.square / 2.0);
            let whole = floor(x);
            let share = x - whole;
            if share > half && share < 1.0 - half {
                return if whole as i32 & 1 == 0 { 1.0 } else { -1.0 };
            }
            let half = half.clamp(1e-3, 1.0);
            let half_way = |x: f32| (x / 2.0 - floor(x / 2.0) - 0.5).abs();
            (half_way(x - half) - half_way(x + half)) / half
        };
        let [along_x, along_y] = [0, 1].map(|axis| steps.right[axis].abs() + steps.down[axis].abs());
        let both = wave(at.x, along_x) * wave(at.y, along_y);
        SQUARES[0].lerp(SQUARES[1], 0.5 - 0.5 * both)
    }
}

/// How far on the floor the next pixels to the right and below lie.
struct Steps {
    right: [f32; 2],
    down: [f32; 2],
    /// No step is longer, metres.
    most: f32,
}

impl Steps {
    fn new(lens: &Lens, ray: &Ray, at: Vector) -> Self {
        let depth = match lens.near {
            Some(_) => (at - ray.origin).dot(lens.forward),
            None => 1.0,
        };
        // Along a step of the picture's plane, and from there along the ray to the floor.
        let on_floor = |step: Vector| {
            let step = step * (lens.scale * depth);
            let slide = step - ray.direction * (step.z / ray.direction.z);
            [slide.x, slide.y]
        };
        let (right, down) = (on_floor(lens.right), on_floor(lens.up));
        let most = right.into_iter().chain(down).map(f32::abs).sum();
        Self { right, down, most }
    }

    /// Metres a pixel along a direction of any length.
    fn across(&self, direction: [f32; 2]) -> f32 {
        let size = length(direction).max(f32::MIN_POSITIVE);
        let (a, b) = (dot(self.right, direction) / size, dot(self.down, direction) / size);
        (a * a + b * b).sqrt().max(1e-9)
    }
}

/// The trail without steps too short to see. What is not a number interrupts it.
fn strokes(trail: &[[f32; 2]], half_width: f32) -> Vec<Stroke> {
    let mut strokes = Vec::new();
    let mut last: Option<[f32; 2]> = None;
    for (index, &point) in trail.iter().enumerate() {
        if !point.iter().all(|x| x.is_finite()) {
            last = None;
            continue;
        }
        let along = |from: [f32; 2]| [point[0] - from[0], point[1] - from[1]];
        let newest = index + 1 == trail.len();
        if let Some(from) = last {
            let step = length(along(from));
            if step < half_width * if newest { 1e-3 } else { 1.0 } {
                continue;
            }
            let age = 1.0 - (index + 1) as f32 / trail.len() as f32;
            let cover = TRAIL_COVER[0] + (TRAIL_COVER[1] - TRAIL_COVER[0]) * age;
            strokes.push(Stroke { from, along: along(from), cover });
        }
        last = Some(point);
    }
    strokes
}

/// The greatest of 1, 2, 5, 10, 20, … (and 0.5, 0.2, …) that is no more than a length.
fn round_length(length: f32) -> f32 {
    let length = length.clamp(1e-30, 1e30);
    let mut unit = 1.0_f32;
    for _ in 0..30 {
        if unit > length {
            unit /= 10.0;
        } else if unit * 10.0 <= length {
            unit *= 10.0;
        }
    }
    [5.0, 2.0].into_iter().map(|times| times * unit).find(|&side| side <= length).unwrap_or(unit)
}

/// The greatest whole number that is no more; quicker than the standard one on machines of 2003 and the web.
fn floor(x: f32) -> f32 {
    let whole = x as i32 as f32;
    if whole > x { whole - 1.0 } else { whole }
}

fn dot(a: [f32; 2], b: [f32; 2]) -> f32 {
    a[0] * b[0] + a[1] * b[1]
}

fn length(a: [f32; 2]) -> f32 {
    dot(a, a).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_round_down_to_round_ones() {
        for (length, round) in [(1.0, 1.0), (1.9, 1.0), (2.5, 2.0), (9.0, 5.0), (37.0, 20.0), (700.0, 500.0)]
        {
            assert_eq!(round_length(length), round);
        }
        assert!((round_length(0.07) - 0.05).abs() < 1e-6 && (round_length(0.3) - 0.2).abs() < 1e-6);
        assert!(round_length(f32::NAN).is_finite() && round_length(f32::INFINITY).is_finite());
    }

    #[test]
    fn a_trail_keeps_its_newest_point_and_breaks_at_what_is_no_number() {
        let dense: Vec<_> = (0..1001).map(|i| [i as f32 * 0.001, 0.0]).collect();
        let pieces = strokes(&dense, 0.1);
        assert!(pieces.len() <= 10, "{}", pieces.len());
        let end = pieces.last().unwrap();
        assert_eq!(end.from[0] + end.along[0], 1.0);
        assert!(pieces[0].cover < end.cover);
        assert_eq!(strokes(&[[0.0, 0.0], [f32::NAN, 0.0], [1.0, 0.0], [2.0, 0.0]], 0.1).len(), 1);
    }
}
