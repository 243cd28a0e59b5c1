//! Letters as outlines, so that they are as smooth as every other shape and can stand on their side.

use std::sync::LazyLock;

use tiny_skia::{Path, PathBuilder};
use ttf_parser::{Face, GlyphId, OutlineBuilder};

/// How bold letters are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Weight {
    Regular,
    Bold,
}

static REGULAR: LazyLock<Option<Face<'static>>> =
    LazyLock::new(|| Face::parse(dejavu::sans::regular(), 0).ok());
static BOLD: LazyLock<Option<Face<'static>>> = LazyLock::new(|| Face::parse(dejavu::sans::bold(), 0).ok());

/// The embedded font. It always parses (a test says so); were it broken, pictures would lack letters, not fail.
pub(super) fn face(weight: Weight) -> Option<&'static Face<'static>> {
    match weight {
        Weight::Regular => REGULAR.as_ref(),
        Weight::Bold => BOLD.as_ref(),
    }
}

/// Calls `visit` with each glyph of the text and where it starts, in font units; returns where the text ends.
fn walk(face: &Face, text: &str, mut visit: impl FnMut(GlyphId, f32)) -> f32 {
    let mut at = 0.0;
    let mut last = None;
    for letter in text.chars() {
        let glyph = face.glyph_index(letter).unwrap_or(GlyphId(0));
        at += last.map_or(0.0, |last| kerning(face, last, glyph));
        visit(glyph, at);
        at += f32::from(face.glyph_hor_advance(glyph).unwrap_or(0));
        last = Some(glyph);
    }
    at
}

fn kerning(face: &Face, left: GlyphId, right: GlyphId) -> f32 {
    let tables = face.tables().kern.into_iter().flat_map(|kern| kern.subtables);
    let mut plain = tables.filter(|table| table.horizontal && !table.variable);
    plain.find_map(|table| table.glyphs_kerning(left, right)).map_or(0.0, f32::from)
}

/// The width of a line of text, in pixels.
pub(super) fn width(text: &str, size: f32, weight: Weight) -> f32 {
    let Some(face) = face(weight) else { return 0.0 };
    walk(face, text, |_, _| ()) * size / f32::from(face.units_per_em())
}

/// The outline of a line of text that starts at (`x`, `y`) on its baseline.
pub(super) fn outline(text: &str, x: f32, y: f32, size: f32, weight: Weight) -> Option<Path> {
    let face = face(weight)?;
    let scale = size / f32::from(face.units_per_em());
    let mut pen = Pen { path: PathBuilder::new(), x, y, scale };
    walk(face, text, |glyph, at| {
        pen.x = x + at * scale;
        face.outline_glyph(glyph, &mut pen);
    });
    pen.path.finish()
}

/// Rounding must not cost a letter.
const SLACK: f32 = 0.5;

/// The text and size that fit into `room` pixels: first smaller letters (by up to a quarter), then fewer.
pub(super) fn fit(text: &str, size: f32, weight: Weight, room: f32) -> (String, f32) {
    let needed = width(text, size, weight);
    if needed <= room + SLACK || needed <= 0.0 {
        return (text.to_owned(), size);
    }
    let size = size * (room / needed).clamp(0.75, 1.0);
    let mut kept: Vec<char> = text.chars().collect();
    let mut shown = text.to_owned();
    while !kept.is_empty() && width(&shown, size, weight) > room + SLACK {
        kept.pop();
        shown = kept.iter().collect::<String>().trim_end().to_owned() + "…";
    }
    (shown, size)
}

/// Breaks a text into lines of at most `room` pixels, between words.
pub(super) fn wrap(text: &str, size: f32, room: f32) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if width(&format!("{line} {word}"), size, Weight::Regular) <= room => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Draws glyph outlines (y upwards, font units) into a path (y downwards, pixels).
struct Pen {
    path: PathBuilder,
    x: f32,
    y: f32,
    scale: f32,
}

impl Pen {
    fn at(&self, x: f32, y: f32) -> (f32, f32) {
        (self.x + x * self.scale, self.y - y * self.scale)
    }
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.path.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.path.line_to(x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let ((x1, y1), (x, y)) = (self.at(x1, y1), self.at(x, y));
        self.path.quad_to(x1, y1, x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let ((x1, y1), (x2, y2), (x, y)) = (self.at(x1, y1), self.at(x2, y2), self.at(x, y));
        self.path.cubic_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.path.close();
    }
}
