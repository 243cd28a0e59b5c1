//! Pictures as rows that a network reads: each picture cut into square patches.

use inroads_envs::{Frame, Space};

use super::{Encoder, Shape};

/// Patches that are preferred, largest first: 8 is MiniGrid's tile and Sokoban's half; 7 goes into the authors' 84 pixels
/// a dozen times.
const SIDES: [u32; 4] = [8, 7, 6, 5];

/// A picture as its patches, which do not overlap: row by row of patches, and within each row by row of pixels, bytes
/// scaled to [0, 1].
///
/// A network's first layer is then one matrix product for all patches, and the frame stays bytes until this write.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Patches {
    side: usize,
    across: usize,
    down: usize,
    channels: usize,
}

/// Why pictures cannot be cut.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PatchError {
    /// What is seen is no picture.
    #[error("what is seen are no pictures; see the world as pixels (`--see pixels`)")]
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
        let [across, down] = [width, height].map(|pixels| (pixels / side) as usize);
        Ok(Self { side: side as usize, across, down, channels: channels as usize })
    }
}

impl Encoder<Frame> for Patches {
    fn width(&self) -> usize {
        self.across * self.down * self.side * self.side * self.channels
    }

    fn write(&self, frame: &Frame, out: &mut [f32]) {
        let strip = self.side * self.channels;
        for (y, row) in frame.bytes().chunks_exact(self.across * strip).enumerate() {
            let (patch, line) = (y / self.side * self.across, y % self.side);
            for (x, pixels) in row.chunks_exact(strip).enumerate() {
                let to = ((patch + x) * self.side + line) * strip;
                for (out, byte) in out[to..to + strip].iter_mut().zip(pixels) {
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
