//! What becomes of a domain's picture on its way to an agent.

/// How a picture is scaled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Filter {
    /// Pillow's `BILINEAR`, as the thesis' author has it: antialiased, rows first, rounded to bytes in between.
    Pillow,
    /// OpenCV's `INTER_AREA`: averages by overlapping area.
    Area,
    /// OpenCV's `INTER_LINEAR`: two neighbours an axis, not antialiased.
    Linear,
}

/// What colours become.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Colour {
    /// Three channels, as drawn.
    #[default]
    Rgb,
    /// One channel, *before* scaling: ITU-601 luma in OpenCV's fixed point.
    Luma,
    /// One channel, *after* scaling: the mean of the three, truncated (the author's chapter 5).
    Mean,
}

/// What becomes of a domain's picture: nothing by default.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Format {
    /// What its colours become.
    pub colour: Colour,
    /// Width, height and how the picture gets there; `None` leaves it as large as the domain draws it.
    pub scale: Option<([u32; 2], Filter)>,
}

/// A format that no picture can have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "a picture of {0} by {1} pixels cannot be made; width and height lie between 1 and 4096: \
     scale it to such a size, or draw what is in it smaller"
)]
pub struct FormatError(u32, u32);

/// Greatest width and height of a picture.
const GREATEST: u32 = 4096;

impl Format {
    /// As drawn.
    pub const NATIVE: Self = Self { colour: Colour::Rgb, scale: None };
    /// What the thesis' author feeds to networks in chapters 7 and 9: 84 × 84 in colour, by Pillow.
    pub const THESIS: Self = Self { colour: Colour::Rgb, scale: Some(([84, 84], Filter::Pillow)) };
    /// What the author feeds in chapter 5: the same, its channels averaged.
    pub const THESIS_GREY: Self = Self { colour: Colour::Mean, scale: Some(([84, 84], Filter::Pillow)) };
    /// What Atari agents see: luma, averaged over areas to 84 × 84.
    pub const ATARI: Self = Self { colour: Colour::Luma, scale: Some(([84, 84], Filter::Area)) };

    /// Checks the size.
    ///
    /// # Errors
    /// [`FormatError`] when a side is 0, or above 4096 pixels.
    pub fn check(&self) -> Result<(), FormatError> {
        self.check_of([1, 1])
    }

    /// Checks the size that a picture of size `native` gets.
    ///
    /// # Errors
    /// [`FormatError`] when a side is 0, or above 4096 pixels.
    pub fn check_of(&self, native: [u32; 2]) -> Result<(), FormatError> {
        let [width, height] = self.size(native);
        match [width, height].iter().all(|side| (1..=GREATEST).contains(side)) {
            true => Ok(()),
            false => Err(FormatError(width, height)),
        }
    }

    /// Channels of the picture.
    pub fn channels(&self) -> u32 {
        match self.colour {
            Colour::Rgb => 3,
            Colour::Luma | Colour::Mean => 1,
        }
    }

    /// Width and height that a picture of size `native` gets.
    pub fn size(&self, native: [u32; 2]) -> [u32; 2] {
        self.scale.map_or(native, |(size, _)| size)
    }
}
