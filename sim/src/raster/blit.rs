//! Copies small rectangles of bytes.

/// Copies rows of `width` bytes, of which `rows` lie one after the other in `from`, `stride` bytes apart into `to`.
#[inline(always)]
pub(super) fn unpack(width: usize, rows: usize, from: &[u8], stride: usize, to: &mut [u8]) {
    /// One arm a width: rows are short, and a copy whose length is known takes a few instructions.
    macro_rules! widths {
        ($($width:literal)*) => {
            match width {
                $($width => fixed::<$width>(rows, from, stride, to),)*
                _ => blit(width, rows, [width, stride], from, to),
            }
        };
    }
    widths!(1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 18 21 24 27 30 33 36 39 42 45 48);
}

fn fixed<const WIDTH: usize>(rows: usize, from: &[u8], stride: usize, to: &mut [u8]) {
    let (from, _) = from.as_chunks::<WIDTH>();
    for (from, to) in from[..rows].iter().zip(to.chunks_mut(stride)) {
        to[..WIDTH].copy_from_slice(from);
    }
}

/// Copies `rows` rows of `width` bytes that lie `strides` (from, to) bytes apart.
pub(super) fn blit(width: usize, rows: usize, strides: [usize; 2], from: &[u8], to: &mut [u8]) {
    for row in 0..rows {
        let from = &from[row * strides[0]..][..width];
        to[row * strides[1]..][..width].copy_from_slice(from);
    }
}
