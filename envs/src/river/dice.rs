//! Chance as something that can be enumerated.

use rand::RngExt;

use crate::Rng;

/// What rules ask when something happens by chance.
pub trait Dice {
    /// One of `0..sides`, all equally likely. `sides` is at least 1.
    fn below(&mut self, sides: u32) -> u32;
}

impl Dice for Rng {
    fn below(&mut self, sides: u32) -> u32 {
        self.random_range(0..sides)
    }
}

/// Dice that show, throw by throw, everything that they can show: depth first, each course of events once.
#[derive(Clone, Debug, Default)]
pub(super) struct EveryThrow {
    /// What was shown, of how many sides, in the course of events at hand.
    throws: Vec<(u32, u32)>,
    thrown: usize,
}

impl EveryThrow {
    /// How likely the course of events is that was just played.
    pub(super) fn chance(&self) -> f64 {
        self.throws.iter().map(|&(_, sides)| 1.0 / f64::from(sides)).product()
    }

    /// Turns to the next course of events; `false` when all were played.
    pub(super) fn advance(&mut self) -> bool {
        self.thrown = 0;
        while let Some((shown, sides)) = self.throws.pop() {
            if shown + 1 < sides {
                self.throws.push((shown + 1, sides));
                return true;
            }
        }
        false
    }
}

impl Dice for EveryThrow {
    fn below(&mut self, sides: u32) -> u32 {
        if self.thrown == self.throws.len() {
            self.throws.push((0, sides));
        }
        self.thrown += 1;
        self.throws[self.thrown - 1].0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_course_of_events_is_played_once() {
        let mut dice = EveryThrow::default();
        let mut seen = Vec::new();
        let mut total = 0.0;
        loop {
            // A second throw only after a first of 1.
            let first = dice.below(2);
            seen.push(if first == 1 { (first, dice.below(3)) } else { (first, 9) });
            total += dice.chance();
            if !dice.advance() {
                break;
            }
        }
        assert_eq!(seen, [(0, 9), (1, 0), (1, 1), (1, 2)]);
        assert!((total - 1.0).abs() < 1e-12);
    }
}
