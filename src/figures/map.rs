//! The map of a maze as plain data, and where it lies on the sheet.

use std::path::Path;

use super::canvas::Area;
use super::error::FigureError;

/// A rectangle in world units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rect {
    /// The corner with the smallest x and y.
    pub min: [f32; 2],
    /// The corner with the largest x and y.
    pub max: [f32; 2],
}

impl Rect {
    /// The rectangle around a centre, half as wide as `half[0]` and half as high as `half[1]`.
    pub fn around(centre: [f32; 2], half: [f32; 2]) -> Self {
        let [x, y] = centre;
        Self { min: [x - half[0], y - half[1]], max: [x + half[0], y + half[1]] }
    }

    /// Whether a point lies in it, borders included.
    pub fn contains(&self, [x, y]: [f32; 2]) -> bool {
        (self.min[0]..=self.max[0]).contains(&x) && (self.min[1]..=self.max[1]).contains(&y)
    }

    /// Width and height.
    pub fn size(&self) -> [f32; 2] {
        [self.max[0] - self.min[0], self.max[1] - self.min[1]]
    }
}

/// A maze seen from above.
#[derive(Clone, Debug, Default)]
pub struct Map {
    /// What is in the way.
    pub walls: Vec<Rect>,
    /// What the pictures show.
    pub bounds: Rect,
    /// The goal's centre and radius.
    pub goal: Option<([f32; 2], f32)>,
    /// Where episodes begin.
    pub starts: Vec<[f32; 2]>,
    /// Where a key lies.
    pub key: Option<[f32; 2]>,
}

impl Map {
    /// Whether a point is within the bounds and in no wall.
    pub fn is_free(&self, point: [f32; 2]) -> bool {
        self.bounds.contains(point) && !self.walls.iter().any(|wall| wall.contains(point))
    }

    /// Refuses bounds that a picture cannot have; `path` is only named in the error.
    pub(super) fn check(&self, path: &Path) -> Result<(), FigureError> {
        let [w, h] = self.bounds.size();
        if w.is_normal() && h.is_normal() && w > 0.0 && h > 0.0 {
            return Ok(());
        }
        let Rect { min, max } = self.bounds;
        let bounds = format!("x {} to {}, y {} to {}", min[0], max[0], min[1], max[1]);
        Err(FigureError::Bounds { path: path.to_owned(), bounds })
    }

    /// How much higher than wide a picture of it is, within reason.
    pub(super) fn shape(&self) -> f32 {
        let [w, h] = self.bounds.size();
        (h / w).clamp(0.25, 2.0)
    }
}

/// Where the world lies on the sheet: as large as fits, in the middle, y upwards.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    pub(super) area: Area,
    /// Pixels a world unit.
    pub(super) scale: f32,
    origin: [f32; 2],
}

impl View {
    pub(super) fn fit(bounds: Rect, area: Area) -> Self {
        let [w, h] = bounds.size();
        let scale = (area.w / w).min(area.h / h);
        let (w, h) = (w * scale, h * scale);
        let area = Area { x: area.x + (area.w - w) / 2.0, y: area.y + (area.h - h) / 2.0, w, h };
        Self { area, scale, origin: bounds.min }
    }

    /// From the world to the sheet.
    pub(super) fn at(&self, [x, y]: [f32; 2]) -> (f32, f32) {
        let (x, y) = (x - self.origin[0], y - self.origin[1]);
        (self.area.x + x * self.scale, self.area.bottom() - y * self.scale)
    }

    /// A rectangle of the world on the sheet.
    pub(super) fn area(&self, rect: Rect) -> Area {
        let ((x, bottom), (right, y)) = (self.at(rect.min), self.at(rect.max));
        Area { x, y, w: right - x, h: bottom - y }
    }
}
