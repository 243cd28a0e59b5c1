//! Which pixels of a line make which pixel of the scaled line, and with what weight.
//!
//! All formulas are facts of Pillow's `Resample.c` (13.0) and OpenCV's `resize.cpp` (5.0), down to where they
//! compute in single precision; tests compare with both to the bit.

use std::ops::Range;

/// For each pixel of a scaled line, the pixels of the native line that it is made of, and their weights.
#[derive(Clone, Debug)]
pub(super) struct Taps<W> {
    /// The first native pixel, and where the weights of this and the following ones begin.
    starts: Vec<[u32; 2]>,
    weights: Vec<W>,
    /// One past the last weight.
    end: u32,
}

impl<W: Copy + Default + PartialEq> Taps<W> {
    /// From each scaled pixel's first native pixel and weights. Leading and trailing weights of zero do not count.
    fn collect(lines: impl Iterator<Item = (usize, Vec<W>)>) -> Self {
        let (mut starts, mut weights) = (Vec::new(), Vec::new());
        for (first, mut taps) in lines {
            while taps.len() > 1 && taps.last() == Some(&W::default()) {
                taps.pop();
            }
            let idle = taps.iter().take_while(|&&w| w == W::default()).count().min(taps.len() - 1);
            starts.push([(first + idle) as u32, weights.len() as u32]);
            weights.extend_from_slice(&taps[idle..]);
        }
        Self { starts, end: weights.len() as u32, weights }
    }
}

impl<W> Taps<W> {
    /// Whether two scaled pixels are made in the same way, the second of native pixels `by` further.
    pub(super) fn alike(&self, [a, b]: [u32; 2], by: u32) -> bool
    where
        W: PartialEq,
    {
        let [(from, weights), (other, others)] = [self.of(a), self.of(b)];
        from + by == other && weights == others
    }

    /// Pixels of the scaled line.
    pub(super) fn len(&self) -> u32 {
        self.starts.len() as u32
    }

    /// The first native pixel, and one weight for each from there on.
    pub(super) fn of(&self, pixel: u32) -> (u32, &[W]) {
        let [first, from] = self.starts[pixel as usize];
        let to = self.starts.get(pixel as usize + 1).map_or(self.end, |next| next[1]);
        (first, &self.weights[from as usize..to as usize])
    }

    /// The native pixels that these scaled ones are made of.
    pub(super) fn needs(&self, pixels: Range<u32>) -> Range<u32> {
        if pixels.is_empty() {
            return 0..0;
        }
        let (last, weights) = self.of(pixels.end - 1);
        self.of(pixels.start).0..last + weights.len() as u32
    }

    /// The scaled pixels that these native ones have a say in.
    pub(super) fn touches(&self, native: Range<u32>) -> Range<u32> {
        let reaches = |pixel: u32| self.needs(pixel..pixel + 1);
        let pixels = 0..self.len();
        let from = pixels.clone().find(|&p| reaches(p).end > native.start).unwrap_or(pixels.end);
        let to = pixels.rev().find(|&p| reaches(p).start < native.end).map_or(0, |last| last + 1);
        from..to.max(from)
    }

    /// Most native pixels that a scaled one is made of.
    pub(super) fn most(&self) -> usize {
        (0..self.len()).map(|pixel| self.of(pixel).1.len()).max().unwrap_or(0)
    }
}

/// Pillow's bits after the binary point.
pub(super) const PILLOW_BITS: u32 = 22;

/// Pillow's `BILINEAR`: a triangle that reaches one pixel, of the native or of the scaled line, whichever is wider.
pub(super) fn pillow(native: u32, scaled: u32) -> Taps<i32> {
    let scale = f64::from(native) / f64::from(scaled);
    let reach = scale.max(1.0);
    Taps::collect((0..scaled).map(|pixel| {
        let centre = (f64::from(pixel) + 0.5) * scale;
        let from = (centre - reach + 0.5).max(0.0) as u32;
        let to = ((centre + reach + 0.5) as u32).min(native);
        let triangle = |x: u32| (1.0 - ((f64::from(x) - centre + 0.5) / reach).abs()).max(0.0);
        let sum: f64 = (from..to).map(triangle).sum();
        let one = f64::from(1 << PILLOW_BITS);
        (from as usize, (from..to).map(|x| (0.5 + triangle(x) / sum * one) as i32).collect())
    }))
}

/// OpenCV's scale: not `native / scaled`, which may differ in the last bit.
fn opencv_scale(native: u32, scaled: u32) -> f64 {
    1.0 / (f64::from(scaled) / f64::from(native))
}

/// Whether OpenCV's `INTER_AREA` averages along this axis; when it enlarges along one, it interpolates along both.
pub(super) fn shrinks(native: u32, scaled: u32) -> bool {
    opencv_scale(native, scaled) >= 1.0
}

/// By how many times OpenCV shrinks, if it takes that for a whole number.
pub(super) fn whole(native: u32, scaled: u32) -> Option<u32> {
    let scale = opencv_scale(native, scaled);
    ((scale - scale.round()).abs() < f64::EPSILON).then_some(scale.round() as u32)
}

/// OpenCV's `INTER_AREA` when it shrinks by a whole number: just which pixels.
pub(super) fn blocks(scaled: u32, times: u32) -> Taps<()> {
    let starts = (0..scaled).map(|pixel| [pixel * times; 2]).collect();
    Taps { starts, weights: vec![(); (scaled * times) as usize], end: scaled * times }
}

/// OpenCV's `INTER_AREA` when it shrinks: the share of each native pixel in the scaled one.
pub(super) fn shares(native: u32, scaled: u32) -> Taps<f32> {
    /// Shares below this are none.
    const NONE: f64 = 1e-3;
    let scale = opencv_scale(native, scaled);
    Taps::collect((0..scaled).map(|pixel| {
        let from = f64::from(pixel) * scale;
        let to = from + scale;
        let width = scale.min(f64::from(native) - from);
        let last = (to.floor() as u32).min(native - 1);
        let first = (from.ceil() as u32).min(last);
        let mut weights = Vec::new();
        let before = f64::from(first) - from;
        if before > NONE {
            weights.push((before / width) as f32);
        }
        weights.extend((first..last).map(|_| (1.0 / width) as f32));
        let after = to - f64::from(last);
        if after > NONE {
            weights.push((after.min(1.0).min(width) / width) as f32);
        }
        (first as usize - usize::from(before > NONE), weights)
    }))
}

/// OpenCV's one, in interpolation.
const ONE: f32 = 2048.0;

/// OpenCV's interpolation between two neighbours; `area` is that of `INTER_AREA` where it enlarges.
///
/// A weight is what the pixel counts as left and as right neighbour: at the borders, along columns (`columns`), it
/// is both, and each is rounded for itself. Along rows the border pixel counts once.
pub(super) fn neighbours(native: u32, scaled: u32, area: bool, columns: bool) -> Taps<[i32; 2]> {
    let inverse = f64::from(scaled) / f64::from(native);
    let scale = opencv_scale(native, scaled);
    let last = i64::from(native) - 1;
    Taps::collect((0..scaled).map(|pixel| {
        let pixel = f64::from(pixel);
        let (mut left, mut part);
        if area {
            left = (pixel * scale).floor() as i64;
            part = ((pixel + 1.0) - (left as f64 + 1.0) * inverse) as f32;
            part = if part <= 0.0 { 0.0 } else { part - part.floor() };
        } else {
            let place = ((pixel + 0.5) * scale - 0.5) as f32;
            left = place.floor() as i64;
            part = place - place.floor();
        }
        if !columns && !(0..last).contains(&left) {
            (left, part) = (left.clamp(0, last), 0.0);
        }
        let weights = [1.0 - part, part].map(|part| (part * ONE).round_ties_even() as i32);
        let [from, to] = [left, left + 1].map(|pixel| pixel.clamp(0, last) as usize);
        let taps = if from == to { vec![weights] } else { vec![[weights[0], 0], [0, weights[1]]] };
        (from, taps)
    }))
}
