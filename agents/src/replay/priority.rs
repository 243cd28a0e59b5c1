//! Prioritised replay (Schaul 2016): what surprised the learner is drawn more often, and counts less each time.

use std::ops::Range;

use inroads_envs::Rng;
use rand::RngExt;
use serde::{Deserialize, Serialize};

use super::SumTree;

/// How priorities are made of errors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PriorityConfig {
    /// α of P ∝ p^α; 0.5 (Rainbow, Hessel 2018, table 1; 0.6 in Schaul's paper).
    pub exponent: f32,
    /// β of the weights (N P)^−β at the first draw; 0.4 (both papers).
    pub correction: f32,
    /// Draws after which β has risen to 1.
    pub corrected_after: u64,
    /// ε of p = |error| + ε: what is known is drawn now and then too; 0.01 (the authors' library, pfrl).
    pub least: f32,
}

impl Default for PriorityConfig {
    fn default() -> Self {
        Self { exponent: 0.5, correction: 0.4, corrected_after: 100_000, least: 0.01 }
    }
}

impl PriorityConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        for (name, value) in [("exponent", self.exponent), ("correction", self.correction)] {
            if !(0.0..=1.0).contains(&value) {
                return Err(format!("{name} is {value}; it must lie in [0, 1]"));
            }
        }
        if !(self.least.is_finite() && self.least > 0.0) {
            return Err(format!(
                "least is {}; with nothing above 0 what is known is never drawn again",
                self.least
            ));
        }
        Ok(())
    }
}

/// The priorities of clips by number. A ring: number `n` stands at `n` modulo the number of places.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Priorities {
    config: PriorityConfig,
    /// p^α.
    tree: SumTree,
    /// The greatest p^α ever: what is new is drawn soon.
    greatest: f64,
    draws: u64,
}

impl Priorities {
    pub(super) fn new(config: PriorityConfig) -> Self {
        Self { config, tree: SumTree::new(1024), greatest: 1.0, draws: 0 }
    }

    fn place(&self, number: u64) -> usize {
        (number % self.tree.places() as u64) as usize
    }

    /// The priorities of these clips.
    pub(super) fn of(&self, numbers: Range<u64>) -> Vec<f64> {
        numbers.map(|number| self.tree.get(self.place(number))).collect()
    }

    /// New clips, behind all that are there from number `first` on.
    pub(super) fn enter(&mut self, first: u64, new: Range<u64>) {
        let (live, places) = (new.end - first, self.tree.places() as u64);
        if live > places {
            let old = self.of(first..new.start);
            self.tree = SumTree::new(2 * live as usize);
            (first..).zip(old).for_each(|(number, weight)| self.tree.set(self.place(number), weight));
        }
        new.for_each(|number| self.tree.set(self.place(number), self.greatest));
    }

    /// These clips are gone.
    pub(super) fn leave(&mut self, gone: Range<u64>) {
        gone.for_each(|number| self.tree.set(self.place(number), 0.0));
    }

    /// Of all these clips only so many as there are weights are left, numbered anew from the first number on.
    pub(super) fn replace(&mut self, all: Range<u64>, kept: &[f64]) {
        self.leave(all.clone());
        all.zip(kept).for_each(|(number, weight)| self.tree.set(self.place(number), *weight));
    }

    /// `n` numbers, each from a part of the total of its own, and their weights: (N P)^−β, the greatest of them 1.
    pub(super) fn draw(&self, live: Range<u64>, n: usize, rng: &mut Rng) -> (Vec<u64>, Vec<f32>) {
        let (total, places) = (self.tree.total(), self.tree.places() as u64);
        let part = total / n as f64;
        let numbers: Vec<u64> = (0..n)
            .map(|i| {
                let place = self.tree.find((i as f64 + rng.random::<f64>()) * part) as u64;
                // The one number of those alive that stands there.
                live.start + (place + places - live.start % places) % places
            })
            .collect();
        let count = (live.end - live.start) as f64;
        let exponent = -self.correction();
        let weigh = |number: &u64| (count * self.tree.get(self.place(*number)) / total).powf(exponent) as f32;
        let weights: Vec<f32> = numbers.iter().map(weigh).collect();
        let greatest = weights.iter().copied().fold(f32::MIN_POSITIVE, f32::max);
        (numbers, weights.into_iter().map(|weight| weight / greatest).collect())
    }

    /// β after the draws so far.
    fn correction(&self) -> f64 {
        let done = self.draws as f64 / self.config.corrected_after.max(1) as f64;
        let first = f64::from(self.config.correction);
        first + (1.0 - first) * done.min(1.0)
    }

    pub(super) fn revise(&mut self, live: Range<u64>, numbers: &[u64], errors: &[f32]) {
        self.draws += 1;
        for (number, error) in numbers.iter().zip(errors) {
            if live.contains(number) && error.is_finite() {
                let weight = f64::from(error.abs() + self.config.least).powf(f64::from(self.config.exponent));
                self.greatest = self.greatest.max(weight);
                self.tree.set(self.place(*number), weight);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use inroads_envs::Seed;

    /// Priorities 1, 2, 3, 4 (less ε).
    fn four(first: u64) -> Priorities {
        let config = PriorityConfig { least: 1e-9, ..PriorityConfig::default() };
        let mut priorities = Priorities::new(config);
        let numbers = first..first + 4;
        priorities.enter(first, numbers.clone());
        priorities.revise(numbers.clone(), &numbers.collect::<Vec<_>>(), &[1.0, -2.0, 3.0, 4.0]);
        priorities.draws = 0;
        priorities
    }

    #[test]
    fn they_are_drawn_and_weighed_as_the_paper_says() {
        // Computed with numpy: P = √p/Σ√p, and (4P)^−0.4 over its greatest.
        let (shares, weights) = ([0.1627, 0.2301, 0.2818, 0.3254], [1.0, 0.8706, 0.8027, 0.7579]);
        for first in [0, 1022, 5_000_000_000] {
            let (numbers, drawn) =
                four(first).draw(first..first + 4, 100_000, &mut Seed(0).stream("test", 0));
            for i in 0..4 {
                let share = numbers.iter().filter(|n| **n == first + i).count() as f64 / 1e5;
                assert!((share - shares[i as usize]).abs() < 3.0 * (0.25_f64 / 1e5).sqrt(), "{share}");
                let at = numbers.iter().position(|n| *n == first + i).unwrap();
                assert!((drawn[at] - weights[i as usize]).abs() < 1e-4, "{}", drawn[at]);
            }
        }
    }

    #[test]
    fn what_is_new_has_the_greatest_priority_and_what_is_gone_none() {
        let mut priorities = four(0);
        priorities.enter(0, 4..5);
        assert_eq!(priorities.of(4..5), [2.0]);
        priorities.leave(0..2);
        priorities.revise(2..5, &[0], &[100.0]);
        let (numbers, _) = priorities.draw(2..5, 1000, &mut Seed(0).stream("test", 0));
        assert!(numbers.iter().all(|n| (2..5).contains(n)));
        // More than there are places.
        priorities.enter(2, 5..3000);
        assert_eq!(priorities.of(4..6), [2.0, 2.0]);
        assert_eq!(priorities.of(0..2).len(), 2);
    }

    #[test]
    fn the_correction_becomes_whole() {
        let mut priorities = four(0);
        assert!((priorities.correction() - 0.4).abs() < 1e-6);
        priorities.draws = 200_000;
        assert!((priorities.correction() - 1.0).abs() < 1e-6);
        assert!(PriorityConfig { least: 0.0, ..PriorityConfig::default() }.check().is_err());
    }
}
