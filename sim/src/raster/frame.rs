//! A picture as agents see it.

use std::fmt;

use image::RgbImage;

/// A picture: rows from the top, in each row pixels from the left, in each pixel its channels.
///
/// Also what a domain writes into: [`Frame::shape`] makes a used buffer fit without allocating again.
#[derive(Clone, Default, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub struct Frame {
    width: u32,
    height: u32,
    channels: u32,
    bytes: Vec<u8>,
}

impl fmt::Debug for Frame {
    /// Its shape and a checksum: nobody reads thousands of bytes.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { width, height, channels, bytes } = self;
        let sum = bytes.iter().fold(0_u32, |sum, &byte| sum.rotate_left(5) ^ u32::from(byte));
        write!(f, "Frame({width}x{height}x{channels}, {sum:08x})")
    }
}

impl Frame {
    /// A black picture.
    pub fn new([width, height]: [u32; 2], channels: u32) -> Self {
        let mut frame = Self::default();
        frame.shape([width, height], channels);
        frame
    }

    /// Gives the picture this size, whatever it had before. What is in it is anything.
    pub fn shape(&mut self, [width, height]: [u32; 2], channels: u32) {
        (self.width, self.height, self.channels) = (width, height, channels);
        self.bytes.resize(width as usize * height as usize * channels as usize, 0);
    }

    /// Becomes a copy of the other, in the memory that it has.
    pub fn copy(&mut self, other: &Self) {
        self.shape(other.size(), other.channels);
        self.bytes.copy_from_slice(&other.bytes);
    }

    /// Width and height, pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// Bytes a pixel: 3 for RGB, 1 for grey.
    pub fn channels(&self) -> u32 {
        self.channels
    }

    /// All bytes, `height × width × channels`.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// All bytes, to be written.
    pub fn bytes_mut(&mut self) -> &mut [u8] {
        &mut self.bytes
    }

    /// One row, `width × channels` bytes.
    ///
    /// # Panics
    /// When there is no such row, as in all that follow.
    pub fn row(&self, y: u32) -> &[u8] {
        let bytes = (self.width * self.channels) as usize;
        &self.bytes[y as usize * bytes..][..bytes]
    }

    /// One row, to be written.
    pub fn row_mut(&mut self, y: u32) -> &mut [u8] {
        let bytes = (self.width * self.channels) as usize;
        &mut self.bytes[y as usize * bytes..][..bytes]
    }

    /// The channels of one pixel.
    pub fn pixel(&self, [x, y]: [u32; 2]) -> &[u8] {
        let channels = self.channels as usize;
        &self.row(y)[x as usize * channels..][..channels]
    }

    /// The picture for people: grey becomes RGB.
    pub fn to_rgb(&self) -> RgbImage {
        RgbImage::from_fn(self.width, self.height, |x, y| {
            let pixel = self.pixel([x, y]);
            image::Rgb(std::array::from_fn(|channel| pixel[channel.min(pixel.len() - 1)]))
        })
    }
}
