//! Frames that somebody else drew, as a GIF or a PNG.

use std::path::Path;

use image::RgbImage;

use super::animation;
use super::canvas::encoding;
use super::error::{FigureError, write};
use super::indexed::{Palette, Rgb};

/// Frames from which a film's colours are taken.
const SAMPLES: usize = 24;
/// GIF's 256 less the one that means "as before".
const COLOURS: usize = 255;

/// Writes frames of one size as an endless GIF, each shown for `delay` hundredths of a second.
///
/// # Errors
/// [`FigureError`] when there is no frame, or the file cannot be written.
pub fn film(path: impl AsRef<Path>, frames: &[RgbImage], delay: u16) -> Result<(), FigureError> {
    let path = path.as_ref();
    let Some(first) = frames.first() else {
        return Err(FigureError::Nothing { path: path.to_owned(), what: "a film needs at least one frame" });
    };
    let size = (first.width() as u16, first.height() as u16);
    let some = frames.iter().step_by(frames.len().div_ceil(SAMPLES)).map(pixels);
    let palette = Palette::of(some, COLOURS);
    let bytes = animation::encode(size, palette, delay, frames.len(), |number| pixels(&frames[number]))
        .map_err(|error| encoding(path, &error))?;
    write(path, &bytes)
}

/// Writes one frame as a PNG.
///
/// # Errors
/// [`FigureError`] when the file cannot be written.
pub fn still(path: impl AsRef<Path>, frame: &RgbImage) -> Result<(), FigureError> {
    let path = path.as_ref();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, frame.width(), frame.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder
        .write_header()
        .and_then(|mut writer| writer.write_image_data(frame.as_raw()))
        .map_err(|error| encoding(path, &error))?;
    write(path, &bytes)
}

fn pixels(frame: &RgbImage) -> Vec<Rgb> {
    frame.pixels().map(|pixel| pixel.0).collect()
}
