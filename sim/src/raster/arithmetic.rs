//! How weighted pixels are summed: along a row first, then rows to one.

use super::taps::PILLOW_BITS;

/// The numbers of one scaling method. `CHANNELS` of neighbouring bytes belong to a pixel.
pub(super) trait Arithmetic {
    /// A pixel's share.
    type Weight: Copy;
    /// What a row scaled along itself consists of.
    type Middle: Copy + Default;

    /// A sum of pixels along a row.
    fn across<const CHANNELS: usize>(
        weights: &[Self::Weight],
        pixels: &[[u8; CHANNELS]],
    ) -> [Self::Middle; CHANNELS];

    /// A sum of rows, `row(0)`, `row(1)` …, as long as `out`.
    fn down<'a>(&self, weights: &[Self::Weight], row: impl Fn(usize) -> &'a [Self::Middle], out: &mut [u8])
    where
        Self: 'a;
}

/// How many bytes are summed together.
const LANES: usize = 8;

/// Sums `row(0), row(1) …` in blocks: `add` a row's numbers to sums that begin with `start`, then `finish` them.
#[inline(always)]
fn blockwise<'a, M: Copy + 'a, S: Copy>(
    count: usize,
    row: impl Fn(usize) -> &'a [M],
    out: &mut [u8],
    start: S,
    add: impl Fn(usize, S, M) -> S,
    finish: impl Fn(S) -> u8,
) {
    let lanes = |from: usize| {
        let mut sums = [start; LANES];
        for index in 0..count {
            if let Some(row) = row(index)[from..].first_chunk::<LANES>() {
                (0..LANES).for_each(|lane| sums[lane] = add(index, sums[lane], row[lane]));
            }
        }
        let mut bytes = [0; LANES];
        (0..LANES).for_each(|lane| bytes[lane] = finish(sums[lane]));
        bytes
    };
    if !in_lanes(out, lanes) {
        for (at, out) in out.iter_mut().enumerate() {
            *out = finish((0..count).fold(start, |sum, index| add(index, sum, row(index)[at])));
        }
    }
}

/// Fills bytes with what `lanes` makes of those from a place on; the last may be made twice. Not if they are too few.
#[inline(always)]
fn in_lanes(out: &mut [u8], lanes: impl Fn(usize) -> [u8; LANES]) -> bool {
    let Some(last) = out.len().checked_sub(LANES) else { return false };
    for from in (0..last).step_by(LANES).chain([last]) {
        if let Some(out) = out[from..].first_chunk_mut() {
            *out = lanes(from);
        }
    }
    true
}

/// Pillow's: fixed point, rounded to bytes after either sum.
#[derive(Clone, Debug)]
pub(super) struct Pillow;

impl Pillow {
    const HALF: i32 = 1 << (PILLOW_BITS - 1);

    /// The weighted sum of two rows, eight bytes at once: four numbers of 16 bits share a word, and a weight is cut
    /// into its upper 8 and two times 7 bits, so that no product or sum leaves its 16 bits. (Two weights are one
    /// together: at most 255 × 256, or 255 × (127 + 127).) What lower bits sum up to is carried over.
    #[inline(always)]
    fn two([a, b]: [i32; 2], above: &[u8], below: &[u8]) -> [u8; LANES] {
        /// Every second byte.
        const BYTES: u64 = 0x00FF_00FF_00FF_00FF;
        /// Nine bits: what is left of 16 after a shift by 7.
        const CARRY: u64 = 0x01FF_01FF_01FF_01FF;
        const HALF: u64 = 0x0080_0080_0080_0080;
        let (Some(above), Some(below)) = (above.first_chunk(), below.first_chunk()) else {
            return [0; LANES];
        };
        let [above, below] = [u64::from_le_bytes(*above), u64::from_le_bytes(*below)];
        let blend = |above: u64, below: u64| {
            let sum = |shift: u32, mask: i32| {
                above * (a >> shift & mask) as u64 + below * (b >> shift & mask) as u64
            };
            let middle = sum(7, 127) + (sum(0, 127) >> 7 & CARRY);
            sum(14, 511) + (middle >> 7 & CARRY) + HALF
        };
        let even = blend(above & BYTES, below & BYTES) >> 8 & BYTES;
        let odd = blend(above >> 8 & BYTES, below >> 8 & BYTES) & !BYTES;
        (even | odd).to_le_bytes()
    }

    /// Weights are not negative and their sum is one but for rounding, so this is never above 255.
    fn byte(sum: i32) -> u8 {
        (sum >> PILLOW_BITS) as u8
    }
}

impl Arithmetic for Pillow {
    type Weight = i32;
    type Middle = u8;

    fn across<const CHANNELS: usize>(weights: &[i32], pixels: &[[u8; CHANNELS]]) -> [u8; CHANNELS] {
        let mut sums = [Self::HALF; CHANNELS];
        for (pixel, weight) in pixels.iter().zip(weights) {
            (0..CHANNELS).for_each(|channel| sums[channel] += i32::from(pixel[channel]) * weight);
        }
        sums.map(Self::byte)
    }

    fn down<'a>(&self, weights: &[i32], row: impl Fn(usize) -> &'a [u8], out: &mut [u8]) {
        if let &[a, b] = weights
            && in_lanes(out, |from| Self::two([a, b], &row(0)[from..], &row(1)[from..]))
        {
            return;
        }
        let add = |index: usize, sum, byte| sum + i32::from(byte) * weights[index];
        blockwise(weights.len(), row, out, Self::HALF, add, Self::byte);
    }
}

/// OpenCV's interpolation: whole numbers, some bits dropped on the way.
#[derive(Clone, Debug)]
pub(super) struct Interpolation;

impl Arithmetic for Interpolation {
    type Weight = [i32; 2];
    type Middle = i32;

    fn across<const CHANNELS: usize>(weights: &[[i32; 2]], pixels: &[[u8; CHANNELS]]) -> [i32; CHANNELS] {
        let mut sums = [0; CHANNELS];
        for (pixel, [left, right]) in pixels.iter().zip(weights) {
            (0..CHANNELS).for_each(|channel| sums[channel] += i32::from(pixel[channel]) * (left + right));
        }
        sums
    }

    fn down<'a>(&self, weights: &[[i32; 2]], row: impl Fn(usize) -> &'a [i32], out: &mut [u8]) {
        let add = |index: usize, sum, number: i32| {
            let [above, below] = weights[index];
            sum + ((above * (number >> 4)) >> 16) + ((below * (number >> 4)) >> 16)
        };
        blockwise(weights.len(), row, out, 2, add, |sum| (sum >> 2).clamp(0, 255) as u8);
    }
}

/// OpenCV's averages, shrinking by whatever it be: single precision, rounded once, halves to even.
#[derive(Clone, Debug)]
pub(super) struct Shares;

/// Rounds, halves to even, where no instruction for it can be relied on: adding this number leaves no bits after the
/// point. Right below 2²².
fn rounded(number: f32) -> u8 {
    const SHIFT: f32 = (3 << 22) as f32;
    ((number + SHIFT) - SHIFT) as u8
}

impl Arithmetic for Shares {
    type Weight = f32;
    type Middle = f32;

    fn across<const CHANNELS: usize>(weights: &[f32], pixels: &[[u8; CHANNELS]]) -> [f32; CHANNELS] {
        let mut sums = [0.0; CHANNELS];
        for (pixel, weight) in pixels.iter().zip(weights) {
            (0..CHANNELS).for_each(|channel| sums[channel] += f32::from(pixel[channel]) * weight);
        }
        sums
    }

    fn down<'a>(&self, weights: &[f32], row: impl Fn(usize) -> &'a [f32], out: &mut [u8]) {
        blockwise(weights.len(), row, out, 0.0, |index, sum, number| sum + number * weights[index], rounded);
    }
}

/// OpenCV's averages, shrinking by whole numbers: whole sums, of which a block's size says what a byte is.
#[derive(Clone, Debug)]
pub(super) struct Blocks {
    /// Width and height of a block.
    pub(super) block: [u32; 2],
}

impl Arithmetic for Blocks {
    type Weight = ();
    type Middle = u32;

    fn across<const CHANNELS: usize>(weights: &[()], pixels: &[[u8; CHANNELS]]) -> [u32; CHANNELS] {
        let mut sums = [0; CHANNELS];
        for (pixel, ()) in pixels.iter().zip(weights) {
            (0..CHANNELS).for_each(|channel| sums[channel] += u32::from(pixel[channel]));
        }
        sums
    }

    fn down<'a>(&self, weights: &[()], row: impl Fn(usize) -> &'a [u32], out: &mut [u8]) {
        let add = |_, sum: u32, number: u32| sum + number;
        if self.block == [2, 2] {
            // OpenCV has this case for itself, and rounds halves up in it.
            blockwise(weights.len(), row, out, 2, add, |sum| (sum >> 2) as u8);
        } else {
            let share = 1.0 / (self.block[0] * self.block[1]) as f32;
            blockwise(weights.len(), row, out, 0, add, |sum| rounded(sum as f32 * share));
        }
    }
}
