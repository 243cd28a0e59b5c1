//! Grey from colours.

use super::Colour;

/// ITU-601 luma of an RGB colour, as OpenCV has it: weights of 15 bits, rounded.
pub(super) fn luma([red, green, blue]: [u8; 3]) -> u8 {
    let sum = 9798 * u32::from(red) + 19235 * u32::from(green) + 3735 * u32::from(blue);
    ((sum + (1 << 14)) >> 15) as u8
}

/// The mean of three channels, truncated.
pub(super) fn mean(colour: [u8; 3]) -> u8 {
    (colour.iter().map(|&channel| u16::from(channel)).sum::<u16>() / 3) as u8
}

/// Makes RGB pixels grey, one way or the other.
pub(super) fn grey(how: Colour, pixels: &[u8], out: &mut [u8]) {
    let pixels = out.iter_mut().zip(pixels.as_chunks().0);
    if how == Colour::Luma {
        pixels.for_each(|(out, &colour)| *out = luma(colour));
    } else {
        pixels.for_each(|(out, &colour)| *out = mean(colour));
    }
}

/// Makes RGB pixels grey where they are: they come to lie in the first third.
pub(super) fn luma_in_place(pixels: &mut [u8]) {
    for pixel in 0..pixels.len() / 3 {
        pixels[pixel] = luma([pixels[3 * pixel], pixels[3 * pixel + 1], pixels[3 * pixel + 2]]);
    }
}
