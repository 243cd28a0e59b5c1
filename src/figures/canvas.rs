//! A white sheet and the few marks that the pictures are made of. Pixels; y downwards.

use std::path::Path;

use image::RgbImage;
use tiny_skia::{
    FillRule, LineCap, LineJoin, Mask, Paint, PathBuilder, Pixmap, PremultipliedColorU8, Stroke, StrokeDash,
    Transform,
};

use super::error::{FigureError, write};
use super::indexed::{Palette, Rgb};
use super::palette::{Colour, INK};
use super::text::{self, Weight};

/// A rectangle on the sheet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Area {
    pub(super) x: f32,
    pub(super) y: f32,
    pub(super) w: f32,
    pub(super) h: f32,
}

impl Area {
    pub(super) fn right(self) -> f32 {
        self.x + self.w
    }

    pub(super) fn bottom(self) -> f32 {
        self.y + self.h
    }

    pub(super) fn middle(self) -> f32 {
        self.x + self.w / 2.0
    }

    /// The area, larger by `by` on each side.
    pub(super) fn grown(self, by: f32) -> Self {
        Self { x: self.x - by, y: self.y - by, w: self.w + 2.0 * by, h: self.h + 2.0 * by }
    }

    fn path(self) -> Option<tiny_skia::Path> {
        tiny_skia::Rect::from_xywh(self.x, self.y, self.w, self.h).map(PathBuilder::from_rect)
    }
}

/// Where a text stands relative to its anchor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Align {
    Left,
    Centre,
    Right,
}

/// How a text looks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Font {
    pub(super) size: f32,
    pub(super) weight: Weight,
    pub(super) colour: Colour,
}

impl Font {
    /// Dark regular letters.
    pub(super) fn plain(size: f32) -> Self {
        Self { size, weight: Weight::Regular, colour: INK }
    }

    /// Dark bold letters.
    pub(super) fn bold(size: f32) -> Self {
        Self { weight: Weight::Bold, ..Self::plain(size) }
    }

    /// The same letters in another colour.
    pub(super) fn coloured(self, colour: Colour) -> Self {
        Self { colour, ..self }
    }
}

/// A sheet to draw on.
pub(super) struct Canvas {
    pixels: Pixmap,
    clip: Option<Mask>,
}

impl Canvas {
    /// A white sheet; `path` is only named in the error.
    pub(super) fn new(path: &Path, width: f32, height: f32) -> Result<Self, FigureError> {
        let (width, height) = (width.round() as u32, height.round() as u32);
        // Far below GIF's limit, and it keeps a picture of thousands of panels from taking all memory.
        let small = width <= 16_000 && height <= 16_000;
        let pixels = Pixmap::new(width, height).filter(|_| small);
        let mut pixels = pixels.ok_or_else(|| FigureError::Size { path: path.to_owned(), width, height })?;
        pixels.fill(tiny_skia::Color::WHITE);
        Ok(Self { pixels, clip: None })
    }

    /// A sheet that is already drawn on.
    pub(super) fn over(pixels: Pixmap) -> Self {
        Self { pixels, clip: None }
    }

    pub(super) fn pixels(&self) -> &Pixmap {
        &self.pixels
    }

    /// The colours, row by row from the top.
    pub(super) fn rgb(&self) -> Vec<Rgb> {
        self.pixels.data().chunks_exact(4).map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect()
    }

    pub(super) fn pixels_mut(&mut self) -> &mut Pixmap {
        &mut self.pixels
    }

    /// Runs `draw` with marks cut off at the edges of `area`.
    pub(super) fn clipped(&mut self, area: Area, draw: impl FnOnce(&mut Self)) {
        let mask = Mask::new(self.pixels.width(), self.pixels.height()).zip(area.path());
        let before = self.clip.take();
        self.clip = mask.map(|(mut mask, path)| {
            mask.fill_path(&path, FillRule::Winding, true, Transform::identity());
            mask
        });
        draw(self);
        self.clip = before;
    }

    /// Fills a shape.
    pub(super) fn fill(&mut self, path: &tiny_skia::Path, colour: Colour, transform: Transform) {
        self.pixels.fill_path(path, &paint(colour), FillRule::Winding, transform, self.clip.as_ref());
    }

    /// Fills areas as one shape, so that neighbours show no seam.
    pub(super) fn areas(&mut self, areas: impl IntoIterator<Item = Area>, colour: Colour) {
        let mut path = PathBuilder::new();
        for area in areas {
            if let Some(rect) = tiny_skia::Rect::from_xywh(area.x, area.y, area.w, area.h) {
                path.push_rect(rect);
            }
        }
        if let Some(path) = path.finish() {
            self.fill(&path, colour, Transform::identity());
        }
    }

    /// Fills a polygon.
    pub(super) fn polygon(&mut self, points: &[(f32, f32)], colour: Colour) {
        if let Some(path) = chain(points, true) {
            self.fill(&path, colour, Transform::identity());
        }
    }

    /// A line through points.
    pub(super) fn line(&mut self, points: &[(f32, f32)], colour: Colour, width: f32) {
        self.stroke(points, colour, width, None);
    }

    /// A dashed line through points; even kinds have long dashes, odd ones are dotted.
    pub(super) fn dashed(&mut self, points: &[(f32, f32)], colour: Colour, width: f32, kind: usize) {
        let pattern = if kind.is_multiple_of(2) { vec![8.0, 5.0] } else { vec![2.0, 4.0] };
        self.stroke(points, colour, width, StrokeDash::new(pattern, 0.0));
    }

    fn stroke(&mut self, points: &[(f32, f32)], colour: Colour, width: f32, dash: Option<StrokeDash>) {
        let Some(path) = chain(points, false) else { return };
        let line_cap = if dash.is_some() { LineCap::Butt } else { LineCap::Round };
        let stroke = Stroke { width, line_cap, line_join: LineJoin::Round, dash, ..Stroke::default() };
        self.pixels.stroke_path(&path, &paint(colour), &stroke, Transform::identity(), self.clip.as_ref());
    }

    /// A filled disc.
    pub(super) fn disc(&mut self, (x, y): (f32, f32), radius: f32, colour: Colour) {
        if let Some(path) = PathBuilder::from_circle(x, y, radius) {
            self.fill(&path, colour, Transform::identity());
        }
    }

    /// A circle.
    pub(super) fn ring(&mut self, (x, y): (f32, f32), radius: f32, colour: Colour, width: f32) {
        if let Some(path) = PathBuilder::from_circle(x, y, radius) {
            let stroke = Stroke { width, ..Stroke::default() };
            let (paint, clip) = (paint(colour), self.clip.as_ref());
            self.pixels.stroke_path(&path, &paint, &stroke, Transform::identity(), clip);
        }
    }

    /// A picture, its pixels as squares, so strong: 0 is white, 1 its own colours.
    pub(super) fn picture(&mut self, picture: &RgbImage, area: Area, strength: f32) {
        let width = self.pixels.width();
        let columns = (area.x.round() as u32)..(area.right().round() as u32).min(width);
        let rows = (area.y.round() as u32)..(area.bottom().round() as u32).min(self.pixels.height());
        if picture.width() == 0 || picture.height() == 0 {
            return;
        }
        let nearest = |at: u32, from: f32, length: f32, count: u32| {
            (((at as f32 + 0.5 - from) / length * count as f32) as u32).min(count - 1)
        };
        for y in rows {
            for x in columns.clone() {
                let at_x = nearest(x, area.x, area.w, picture.width());
                let at_y = nearest(y, area.y, area.h, picture.height());
                let faded = |value: u8| 255 - ((255.0 - f32::from(value)) * strength).round() as u8;
                let [r, g, b] = picture.get_pixel(at_x, at_y).0.map(faded);
                if let Some(colour) = PremultipliedColorU8::from_rgba(r, g, b, 255) {
                    self.pixels.pixels_mut()[(y * width + x) as usize] = colour;
                }
            }
        }
    }

    /// A line of text whose baseline goes through `y`.
    pub(super) fn text(&mut self, text: &str, (x, y): (f32, f32), align: Align, font: Font) {
        let start = x - shift(text, align, font);
        if let Some(path) = text::outline(text, start, y, font.size, font.weight) {
            self.fill(&path, font.colour, Transform::identity());
        }
    }

    /// A centred line of text that reads upwards, its baseline through `x`.
    pub(super) fn text_upwards(&mut self, text: &str, (x, y): (f32, f32), font: Font) {
        let start = x - shift(text, Align::Centre, font);
        if let Some(path) = text::outline(text, start, y, font.size, font.weight) {
            self.fill(&path, font.colour, Transform::from_rotate_at(-90.0, x, y));
        }
    }

    /// Writes the sheet as a PNG.
    pub(super) fn save(&self, path: &Path) -> Result<(), FigureError> {
        let rgb = self.rgb();
        let mut palette = Palette::of([rgb.clone()], 256);
        let indices: Vec<u8> = rgb.into_iter().map(|colour| palette.number(colour)).collect();
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.pixels.width(), self.pixels.height());
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_palette(palette.colours().concat());
        encoder.set_compression(png::Compression::High);
        encoder.set_filter(png::Filter::NoFilter);
        let mut writer = encoder.write_header().map_err(|error| encoding(path, &error))?;
        writer.write_image_data(&indices).map_err(|error| encoding(path, &error))?;
        writer.finish().map_err(|error| encoding(path, &error))?;
        write(path, &bytes)
    }
}

/// An encoder's complaint as our error.
pub(super) fn encoding(path: &Path, error: &dyn std::error::Error) -> FigureError {
    FigureError::Encode { path: path.to_owned(), reason: error.to_string() }
}

fn shift(text: &str, align: Align, font: Font) -> f32 {
    let width = text::width(text, font.size, font.weight);
    match align {
        Align::Left => 0.0,
        Align::Centre => width / 2.0,
        Align::Right => width,
    }
}

fn paint(colour: Colour) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    let [r, g, b] = colour.rgb;
    paint.set_color_rgba8(r, g, b, (colour.alpha * 255.0).round() as u8);
    paint
}

fn chain(points: &[(f32, f32)], closed: bool) -> Option<tiny_skia::Path> {
    let mut path = PathBuilder::new();
    let (first, rest) = points.split_first()?;
    path.move_to(first.0, first.1);
    for point in rest {
        path.line_to(point.0, point.1);
    }
    if closed {
        path.close();
    }
    path.finish()
}
