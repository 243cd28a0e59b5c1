//! A sum tree: drawing from a list in proportion to numbers that change (Schaul 2016, appendix B.2.1).

use serde::{Deserialize, Serialize};

/// Weights of so many places, their sums two by two, the sums of those, and so on to the total.
///
/// A change recomputes the sums above it from the two below each, not by differences: after millions of changes
/// differences would have drifted away.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(from = "Vec<f64>", into = "Vec<f64>")]
pub(crate) struct SumTree {
    /// The total at 1; the two below number `i` at 2i and 2i + 1; the places in the second half.
    sums: Vec<f64>,
}

impl SumTree {
    /// At least that many places, all of weight 0.
    pub(crate) fn new(places: usize) -> Self {
        Self { sums: vec![0.0; 2 * places.next_power_of_two()] }
    }

    /// How many places there are.
    pub(crate) fn places(&self) -> usize {
        self.sums.len() / 2
    }

    /// The sum of all weights.
    pub(crate) fn total(&self) -> f64 {
        self.sums[1]
    }

    /// The weight of a place.
    pub(crate) fn get(&self, place: usize) -> f64 {
        self.sums[self.places() + place]
    }

    /// Gives a place another weight.
    pub(crate) fn set(&mut self, place: usize, weight: f64) {
        let mut at = self.places() + place;
        self.sums[at] = weight;
        while at > 1 {
            at /= 2;
            self.sums[at] = self.sums[2 * at] + self.sums[2 * at + 1];
        }
    }

    /// The place in which `x` falls when the weights lie side by side from 0 to the total. Never one of weight 0, as long
    /// as there is another.
    pub(crate) fn find(&self, mut x: f64) -> usize {
        let mut at = 1;
        while at < self.places() {
            at *= 2;
            // A rounding error above the left sum must not lead where nothing is.
            if x >= self.sums[at] && self.sums[at + 1] > 0.0 {
                x -= self.sums[at];
                at += 1;
            }
        }
        at - self.places()
    }
}

impl From<Vec<f64>> for SumTree {
    fn from(places: Vec<f64>) -> Self {
        let mut tree = Self::new(places.len());
        let half = tree.places();
        tree.sums[half..half + places.len()].copy_from_slice(&places);
        for at in (1..half).rev() {
            tree.sums[at] = tree.sums[2 * at] + tree.sums[2 * at + 1];
        }
        tree
    }
}

impl From<SumTree> for Vec<f64> {
    fn from(tree: SumTree) -> Self {
        tree.sums[tree.places()..].to_vec()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use inroads_envs::Seed;
    use rand::RngExt;

    #[test]
    fn places_are_found_in_proportion_and_empty_ones_never() {
        let mut tree = SumTree::new(5);
        for (place, weight) in [(0, 1.0), (2, 2.0), (4, 1.0)] {
            tree.set(place, weight);
        }
        assert_eq!((tree.places(), tree.total()), (8, 4.0));
        let found: Vec<_> = [0.0, 0.99, 1.0, 2.99, 3.0, 3.99, 4.0, 9.0].map(|x| tree.find(x)).into();
        assert_eq!(found, [0, 0, 2, 2, 4, 4, 4, 4]);
        assert_eq!(SumTree::from(Vec::from(tree.clone())).sums, tree.sums);
    }

    #[test]
    fn the_total_does_not_drift() {
        let mut tree = SumTree::new(1000);
        let mut rng = Seed(0).stream("test", 0);
        for _ in 0..1_000_000 {
            tree.set(rng.random_range(0..1000), rng.random::<f64>() * 1e3);
        }
        let sum: f64 = (0..1000).map(|place| tree.get(place)).sum();
        assert!((tree.total() / sum - 1.0).abs() < 1e-9);
    }
}
