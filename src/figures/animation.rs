//! Frames as an endless GIF that rests on its last one.

use gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};

use super::indexed::{Palette, Rgb};

/// How long the last frame stays, hundredths of a second.
const LAST: u16 = 180;

/// Encodes `count` frames of `size` pixels, each shown for `delay` hundredths of a second. Each holds only what changed
/// since the one before.
pub(super) fn encode(
    (width, height): (u16, u16),
    mut palette: Palette,
    delay: u16,
    count: usize,
    mut frame: impl FnMut(usize) -> Vec<Rgb>,
) -> Result<Vec<u8>, EncodingError> {
    // One number more than there are colours means "as before".
    let same = palette.colours().len() as u8;
    let mut encoder =
        Encoder::new(Vec::new(), width, height, &[palette.colours(), &[[0; 3]]].concat().concat())?;
    encoder.set_repeat(Repeat::Infinite)?;
    let mut before: Vec<Rgb> = Vec::new();
    for number in 0..count {
        let now = frame(number);
        let changed = |(index, colour): (usize, &Rgb)| {
            if before.get(index) == Some(colour) { same } else { palette.number(*colour) }
        };
        let indices: Vec<u8> = now.iter().enumerate().map(changed).collect();
        let delay = if number + 1 == count { LAST } else { delay };
        encoder.write_frame(&cut(&indices, width, same, delay))?;
        before = now;
    }
    encoder.into_inner()
}

/// The frame without the rows and columns at its borders that stay the same.
fn cut(indices: &[u8], width: u16, same: u8, delay: u16) -> Frame<'static> {
    let wide = usize::from(width);
    let differs = |index: &usize| indices[*index] != same;
    let mut rows = (0..indices.len()).filter(differs).map(|index| index / wide);
    let columns = (0..indices.len()).filter(differs).map(|index| index % wide);
    let (top, bottom) = (rows.clone().next().unwrap_or(0), rows.next_back().unwrap_or(0));
    let (left, right) = (columns.clone().min().unwrap_or(0), columns.max().unwrap_or(0));
    let buffer: Vec<u8> = indices
        .chunks(wide)
        .take(bottom + 1)
        .skip(top)
        .flat_map(|row| row[left..=right].iter().copied())
        .collect();
    Frame {
        delay,
        dispose: DisposalMethod::Keep,
        transparent: Some(same),
        top: top as u16,
        left: left as u16,
        width: (right - left + 1) as u16,
        height: (bottom - top + 1) as u16,
        buffer: buffer.into(),
        ..Frame::default()
    }
}
