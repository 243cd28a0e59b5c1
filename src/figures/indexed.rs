//! Pictures with a table of at most 256 colours: what GIF demands, and a third of the size as PNG.

use std::collections::{HashMap, HashSet};

/// Red, green, blue.
pub(super) type Rgb = [u8; 3];

/// How many levels of red, green and blue count as alike.
const NEIGHBOURHOOD: u8 = 16;

/// A table of colours.
pub(super) struct Palette {
    colours: Vec<Rgb>,
    known: HashMap<Rgb, u8>,
}

impl Palette {
    /// The most frequent colours of some pictures, at most `most` (up to 256) of them: first one of each small
    /// neighbourhood of colours, so that no hue is lost to the many mixtures of another one's edges, then the others.
    pub(super) fn of(pictures: impl IntoIterator<Item = Vec<Rgb>>, most: usize) -> Self {
        let mut counts: HashMap<Rgb, usize> = HashMap::new();
        for picture in pictures {
            for run in picture.chunk_by(|a, b| a == b) {
                *counts.entry(run[0]).or_default() += run.len();
            }
        }
        let mut counts: Vec<_> = counts.into_iter().collect();
        counts.sort_unstable_by_key(|(colour, count)| (std::cmp::Reverse(*count), *colour));
        let mut seen = HashSet::new();
        let frequent = counts.into_iter().map(|(colour, _)| colour);
        let (mut colours, others): (Vec<Rgb>, Vec<Rgb>) =
            frequent.partition(|colour| seen.insert(colour.map(|value| value / NEIGHBOURHOOD)));
        colours.extend(others);
        colours.truncate(most);
        Self { colours, known: HashMap::new() }
    }

    /// The colours.
    pub(super) fn colours(&self) -> &[Rgb] {
        &self.colours
    }

    /// The number of the nearest colour.
    pub(super) fn number(&mut self, colour: Rgb) -> u8 {
        let colours = &self.colours;
        *self.known.entry(colour).or_insert_with(|| {
            let far = |other: &Rgb| -> i32 {
                colour.iter().zip(other).map(|(a, b)| (i32::from(*a) - i32::from(*b)).pow(2)).sum()
            };
            (0..colours.len()).min_by_key(|&index| far(&colours[index])).unwrap_or(0) as u8
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frequent_colours_stay_and_rare_ones_take_the_nearest() {
        let picture = vec![[255, 0, 0], [255, 0, 0], [0, 0, 255], [0, 0, 255], [0, 0, 255], [200, 10, 0]];
        let mut palette = Palette::of([picture], 2);
        assert_eq!(palette.colours(), [[0, 0, 255], [255, 0, 0]]);
        assert_eq!([[200, 10, 0], [0, 0, 255]].map(|colour| palette.number(colour)), [1, 0]);
    }
}
