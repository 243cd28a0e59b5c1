//! Ways of seeing and layouts in words, as users write them.

use std::fmt;

use super::{Layout, See};
use inroads_sim::raster::{Colour, Filter, Format};

/// A word that is no way of seeing, or no layout.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum WordError {
    /// No way of seeing.
    #[error(
        "`{0}` is no way of seeing a world; write symbols, rgb, grey, rgb:SIDE, grey:SIDE (pixels, as the thesis' author \
         scales) or atari"
    )]
    See(String),
    /// No layout.
    #[error(
        "`{0}` says nothing of layouts; write random, fixed:SEED, or map:SEED (one map, starts anywhere)"
    )]
    Layout(String),
}

impl std::str::FromStr for See {
    type Err = WordError;

    /// Reads `symbols`, `rgb`, `grey` (luma), `rgb:84`, `grey:84` (Pillow's bilinear filter to a square; grey is the
    /// mean of the channels) or `atari` (luma, averaged to 84 × 84).
    fn from_str(word: &str) -> Result<Self, WordError> {
        let wrong = || WordError::See(word.to_owned());
        let side = |side: &str| side.parse().map(|side| Some(([side, side], Filter::Pillow)));
        Ok(Self::Pixels(match word.split_once(':') {
            None if word == "symbols" => return Ok(Self::Symbols),
            None if word == "rgb" => Format::NATIVE,
            None if word == "grey" => Format { colour: Colour::Luma, scale: None },
            None if word == "atari" => Format::ATARI,
            Some(("rgb", pixels)) => {
                Format { colour: Colour::Rgb, scale: side(pixels).map_err(|_| wrong())? }
            }
            Some(("grey", pixels)) => {
                Format { colour: Colour::Mean, scale: side(pixels).map_err(|_| wrong())? }
            }
            _ => return Err(wrong()),
        }))
    }
}

impl std::str::FromStr for Layout {
    type Err = WordError;

    /// Reads `random`, `fixed:42` or `map:42`.
    fn from_str(word: &str) -> Result<Self, WordError> {
        let wrong = || WordError::Layout(word.to_owned());
        let seed = |seed: &str| seed.parse().map_err(|_| wrong());
        match word.split_once(':') {
            None if word == "random" => Ok(Self::Random),
            Some(("fixed", number)) => Ok(Self::Fixed(seed(number)?)),
            Some(("map", number)) => Ok(Self::FixedMap(seed(number)?)),
            _ => Err(wrong()),
        }
    }
}

impl fmt::Display for Layout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Random => f.write_str("random"),
            Self::Fixed(seed) => write!(f, "fixed:{seed}"),
            Self::FixedMap(seed) => write!(f, "map:{seed}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_say_what_they_mean_and_others_are_answered_with_the_choice() {
        assert_eq!("symbols".parse(), Ok(See::Symbols));
        assert_eq!("rgb:84".parse(), Ok(See::Pixels(Format::THESIS)));
        assert_eq!("grey:84".parse(), Ok(See::Pixels(Format::THESIS_GREY)));
        assert_eq!("atari".parse(), Ok(See::Pixels(Format::ATARI)));
        for word in ["rbg", "rgb:", "rgb:-3", "", "grey:8x8"] {
            let error = word.parse::<See>().unwrap_err().to_string();
            assert!(error.contains(&format!("`{word}`")) && error.contains("rgb:SIDE"), "{error}");
        }
        for layout in [Layout::Random, Layout::Fixed(42), Layout::FixedMap(7)] {
            assert_eq!(layout.to_string().parse(), Ok(layout));
        }
        assert!("fixed".parse::<Layout>().is_err() && "map:x".parse::<Layout>().is_err());
    }
}
