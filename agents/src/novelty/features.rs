//! Novelty by counting values of single features and of pairs of features: a count that generalises.
//!
//! Chapter 9 asks how new a state would be if some of its features had other values (9.2.3). Nobody has seen such a
//! state, so [`Counts`](super::Counts) of whole states call every one of them new, and the question has no answer. What
//! is counted here is smaller than a state, so most of a state that was never seen is familiar.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::Novelty;
use crate::{
    Context, checkpoint,
    experience::{Moment, Seen},
    tabular::thousandths,
};

/// Settings of [`FeatureCounts`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct FeatureCountsConfig {
    /// A pair of values is asked about only if they would have met at least so often by now were they independent.
    ///
    /// Otherwise chance makes news: of a feature that changes at random every step, most values have not yet met the
    /// value that another feature has just taken for the second time. 5 is the expected count from which on statistics
    /// trusts a cell of a contingency table (Cochran 1954).
    pub expected: f32,
    /// Pairs of values that are remembered. When there are so many, pairs that were not met before are passed over.
    pub pairs: usize,
}

impl Default for FeatureCountsConfig {
    fn default() -> Self {
        Self { expected: 5.0, pairs: 100_000 }
    }
}

impl FeatureCountsConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        if !(self.expected.is_finite() && self.expected >= 0.0) {
            return Err(format!("expected is {}; it must be 0 or above", self.expected));
        }
        Ok(())
    }
}

/// A feature's number and its value, to the nearest thousandth.
type Value = (u32, u64);

/// Counts of feature values, and of pairs of them in one state.
///
/// A state is as new as the newest thing in it: its bonus is the greatest 1/√N over its values and its pairs of values.
/// The greatest, and no mean, so that one new value stands out however many features there are, and so that the bonus
/// falls only when *everything* that is new about the state is taken away. All features are paired with all others, so
/// a visit costs the square of their number; values that are new only three together are not seen.
#[derive(Clone, Debug, Default)]
pub struct FeatureCounts {
    config: FeatureCountsConfig,
    visits: u64,
    values: BTreeMap<Value, u64>,
    pairs: BTreeMap<(Value, Value), u64>,
}

checkpoint!([] FeatureCounts; plain: visits, values, pairs; parts: );

impl FeatureCounts {
    /// Counts of nothing.
    pub fn new(config: &FeatureCountsConfig) -> Self {
        Self { config: config.clone(), ..Self::default() }
    }

    /// N of a value.
    fn value(&self, value: Value) -> u64 {
        self.values.get(&value).copied().unwrap_or(0)
    }

    /// N of a pair of values; none where it is not asked about. `counts` are those of the two.
    fn pair(&self, pair: (Value, Value), counts: (u64, u64)) -> Option<u64> {
        let expected = counts.0 as f64 * counts.1 as f64 / self.visits.max(1) as f64;
        if expected < f64::from(self.config.expected) {
            return None;
        }
        match self.pairs.get(&pair) {
            None if self.pairs.len() >= self.config.pairs => None,
            met => Some(met.copied().unwrap_or(0)),
        }
    }
}

/// The values of a state's features.
fn values(s: &[f32]) -> Vec<Value> {
    s.iter().enumerate().map(|(i, x)| (i as u32, thousandths(*x))).collect()
}

impl Novelty<Vec<f32>> for FeatureCounts {
    fn bonus(&self, s: &Vec<f32>) -> f32 {
        let values = values(s);
        let counts: Vec<_> = values.iter().map(|value| self.value(*value)).collect();
        let mut fewest = counts.iter().copied().min().unwrap_or(u64::MAX);
        for (j, second) in values.iter().enumerate() {
            for (i, first) in values[..j].iter().enumerate() {
                if let Some(count) = self.pair((*first, *second), (counts[i], counts[j])) {
                    fewest = fewest.min(count);
                }
            }
        }
        1.0 / (fewest.max(1) as f32).sqrt()
    }

    fn visit(&mut self, at: Moment, all: &dyn Seen<Vec<f32>>, _: &mut Context) {
        if let Some(s) = all.seen(at) {
            self.count(s);
        }
    }
}

impl FeatureCounts {
    /// `s` was visited.
    pub fn count(&mut self, s: &[f32]) {
        self.visits += 1;
        let values = values(s);
        for (j, second) in values.iter().enumerate() {
            *self.values.entry(*second).or_default() += 1;
            for first in &values[..j] {
                let pair = (*first, *second);
                if let Some(count) = self.pairs.get_mut(&pair) {
                    *count += 1;
                } else if self.pairs.len() < self.config.pairs {
                    self.pairs.insert(pair, 1);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counts(config: &FeatureCountsConfig, visits: &[(u64, [f32; 2])]) -> FeatureCounts {
        let mut counts = FeatureCounts::new(config);
        for (times, s) in visits {
            (0..*times).for_each(|_| counts.count(s));
        }
        counts
    }

    #[test]
    fn a_state_is_as_new_as_the_newest_value_or_pair_in_it() {
        let config = FeatureCountsConfig { expected: 0.0, ..Default::default() };
        let counts = counts(&config, &[(100, [0.0, 0.0]), (16, [1.0, 1.0]), (4, [0.0, 1.0])]);
        assert_eq!(counts.bonus(&vec![0.0, 0.0]), 0.1);
        assert_eq!(counts.bonus(&vec![1.0, 1.0]), 0.25);
        assert_eq!(counts.bonus(&vec![0.0, 1.0]), 0.5);
        // Both values are familiar, and have never met.
        assert_eq!(counts.bonus(&vec![1.0, 0.0]), 1.0);
        assert_eq!(counts.bonus(&vec![0.0, 7.0]), 1.0);
    }

    #[test]
    fn values_that_need_not_have_met_yet_make_no_news() {
        // Of 100 visits 20 had the one value and 20 the other: by chance they had met 4 times.
        let visits = [(60, [0.0, 0.0]), (20, [1.0, 0.0]), (20, [0.0, 1.0])];
        let bonus = |expected| {
            counts(&FeatureCountsConfig { expected, ..Default::default() }, &visits).bonus(&vec![1.0, 1.0])
        };
        assert_eq!((bonus(4.0), bonus(4.1)), (1.0, 1.0 / 20.0_f32.sqrt()));
    }

    #[test]
    fn a_full_memory_passes_over_new_pairs_and_keeps_counting_old_ones() {
        let config = FeatureCountsConfig { expected: 0.0, pairs: 1 };
        let counts = counts(&config, &[(4, [0.0, 0.0]), (9, [1.0, 1.0])]);
        assert_eq!(counts.bonus(&vec![0.0, 0.0]), 0.5);
        assert_eq!(counts.bonus(&vec![1.0, 1.0]), 1.0 / 3.0, "the values are counted all the same");
        assert_eq!(counts.pairs.len(), 1);
    }
}
