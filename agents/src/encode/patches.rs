//! Pictures as rows that a network reads: each picture as its square patches.

use inroads_envs::{Frame, Space};

use super::{Encoder, Shape};

/// Patches that are preferred, largest first: 8 is MiniGrid's tile and Sokoban's half; 7 goes into the authors' 84 pixels
/// a dozen times.
const SIDES: [u32; 4] = [8, 7, 6, 5];

/// A picture as its patches: row by row of patches, and within each row by row of pixels, bytes scaled to [0, 1]. They tile
/// the picture or, for a convolution, overlap.
///
/// A network's first layer is then one matrix product for all patches, and the frame stays bytes until this write.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Patches {
    side: usize,
    /// Pixels from one patch to the next.
    stride: usize,
    across: usize,
    down: usize,
    channels: usize,
    /// Bytes a row of the picture.
    line: usize,
}

/// Why pictures cannot be cut.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PatchError {
    /// What is seen is no picture.
    #[error("what is seen are no pictures; see the world as pixels (`--see rgb`)")]
    NoPicture,
    /// The picture's sides are no multiples of the patch's.
    #[error(
        "a picture of {width} by {height} cannot be cut into patches of {side}; choose a side that divides both"
    )]
    Ragged {
        /// Pixels a row.
        width: u32,
        /// Rows.
        height: u32,
        /// The patch's side, pixels.
        side: u32,
    },
    /// The picture is smaller than what is to look at it.
    #[error(
        "a picture of {width} by {height} is too small: these kernels need one of {least} by {least} or more"
    )]
    Small {
        /// Pixels a row.
        width: u32,
        /// Rows.
        height: u32,
        /// Pixels that each side must have.
        least: u32,
    },
}

impl Patches {
    /// The encoder for pictures of a space, cut into patches of `side` pixels; 0 takes the largest usual one that divides
    /// both sides.
    ///
    /// # Errors
    /// [`PatchError`] when it is no picture, or patches of that side do not tile it.
    pub fn new(space: &Space, side: u32) -> Result<Self, PatchError> {
        let Space::Frame { width, height, channels } = *space else { return Err(PatchError::NoPicture) };
        let divides = |side: u32| side > 0 && width.is_multiple_of(side) && height.is_multiple_of(side);
        let usual = || SIDES.into_iter().find(|side| divides(*side)).unwrap_or(1);
        let side = if side == 0 { usual() } else { side };
        if !divides(side) {
            return Err(PatchError::Ragged { width, height, side });
        }
        Self::overlapping(&Space::Frame { width, height, channels }, side, side)
    }

    /// The encoder for patches of `side` pixels, `stride` pixels from each other: what a convolution with such a kernel looks
    /// at. As there, pixels at the right and at the bottom that fill no patch are not seen.
    ///
    /// # Errors
    /// [`PatchError`] when it is no picture, or smaller than a patch.
    ///
    /// # Panics
    /// When `side` or `stride` is 0.
    pub fn overlapping(space: &Space, side: u32, stride: u32) -> Result<Self, PatchError> {
        assert!(side > 0 && stride > 0, "patches have a side and a stride");
        let Space::Frame { width, height, channels } = *space else { return Err(PatchError::NoPicture) };
        if width.min(height) < side {
            return Err(PatchError::Small { width, height, least: side });
        }
        let [across, down] = [width, height].map(|pixels| ((pixels - side) / stride + 1) as usize);
        let [side, stride, width, channels] = [side, stride, width, channels].map(|n| n as usize);
        Ok(Self { side, stride, across, down, channels, line: width * channels })
    }
}

impl Encoder<Frame> for Patches {
    fn width(&self) -> usize {
        self.across * self.down * self.side * self.side * self.channels
    }

    fn write(&self, frame: &Frame, out: &mut [f32]) {
        let strip = self.side * self.channels;
        let corners = (0..self.down).flat_map(|y| (0..self.across).map(move |x| [y, x]));
        for (patch, [y, x]) in out.chunks_exact_mut(self.side * strip).zip(corners) {
            let corner = self.stride * (y * self.line + x * self.channels);
            let lines = frame.bytes()[corner..].chunks(self.line);
            for (out, bytes) in patch.chunks_exact_mut(strip).zip(lines) {
                for (out, byte) in out.iter_mut().zip(bytes) {
                    *out = f32::from(*byte) * (1.0 / 255.0);
                }
            }
        }
    }

    fn shape(&self) -> Shape {
        Shape::Grid { down: self.down, across: self.across, width: self.side * self.side * self.channels }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_becomes_its_patches_and_loses_nothing() {
        let space = Space::Frame { width: 4, height: 6, channels: 2 };
        let patches = Patches::new(&space, 2).unwrap();
        assert_eq!(patches.shape(), Shape::Grid { down: 3, across: 2, width: 8 });
        let mut frame = Frame::new([4, 6], 2);
        frame.bytes_mut().iter_mut().enumerate().for_each(|(i, byte)| *byte = i as u8);
        let mut row = vec![-1.0; patches.width()];
        patches.write(&frame, &mut row);
        let bytes: Vec<_> = row.iter().map(|x| (x * 255.0).round() as u8).collect();
        assert_eq!(bytes[..8], [0, 1, 2, 3, 8, 9, 10, 11]);
        assert_eq!(bytes[8..16], [4, 5, 6, 7, 12, 13, 14, 15]);
        assert_eq!(bytes[40..], [36, 37, 38, 39, 44, 45, 46, 47]);
    }

    #[test]
    fn patches_of_a_convolution_overlap_and_leave_out_what_fills_none() {
        let space = Space::Frame { width: 6, height: 5, channels: 1 };
        let patches = Patches::overlapping(&space, 3, 2).unwrap();
        assert_eq!(patches.shape(), Shape::Grid { down: 2, across: 2, width: 9 });
        let mut frame = Frame::new([6, 5], 1);
        frame.bytes_mut().iter_mut().enumerate().for_each(|(i, byte)| *byte = i as u8);
        let mut row = vec![-1.0; patches.width()];
        patches.write(&frame, &mut row);
        let bytes: Vec<_> = row.iter().map(|x| (x * 255.0).round() as u8).collect();
        assert_eq!(bytes[..9], [0, 1, 2, 6, 7, 8, 12, 13, 14]);
        assert_eq!(bytes[9..18], [2, 3, 4, 8, 9, 10, 14, 15, 16]);
        assert_eq!(bytes[27..], [14, 15, 16, 20, 21, 22, 26, 27, 28]);
        let small = Patches::overlapping(&space, 6, 1).unwrap_err().to_string();
        assert!(small.contains("6 by 5") && small.contains("6 by 6"), "{small}");
    }

    #[test]
    fn the_side_is_the_largest_usual_one_that_tiles_the_picture() {
        let side = |width, height| {
            Patches::new(&Space::Frame { width, height, channels: 3 }, 0).map(|patches| patches.side)
        };
        assert_eq!([side(64, 64), side(84, 84), side(40, 40), side(11, 13)], [Ok(8), Ok(7), Ok(8), Ok(1)]);
        let ragged = Patches::new(&Space::Frame { width: 84, height: 84, channels: 3 }, 8).unwrap_err();
        assert!(ragged.to_string().contains("84 by 84") && ragged.to_string().contains('8'));
        assert_eq!(Patches::new(&Space::Discrete(2), 0), Err(PatchError::NoPicture));
    }
}
