//! A binary classifier by a small network that says how probable membership is: plain, or of weighted examples (thesis
//! 5.1.2).

use inroads_envs::Rng;
use serde::{Deserialize, Serialize};

use super::{Classifier, Weighing, class_weights, fit_equal};
use crate::nets::{Backend, ProbabilityNet, Step};
use crate::svm::{Unfit, check_paired, check_rows, check_weights};

/// Settings of [`Neural`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct NeuralConfig {
    /// Widths of the hidden layers (authors: 128 and 128).
    pub hidden: Vec<usize>,
    /// Adam's rate (authors: 1e-3, with more rows).
    pub rate: f32,
    /// Rows an update at most (authors: 128).
    pub batch: usize,
    /// Updates a fit (authors: five times through all rows).
    pub updates: u32,
    /// Whether either class counts the same in sum where its examples are weighted alike (authors: yes).
    pub balance: bool,
}

impl Default for NeuralConfig {
    fn default() -> Self {
        Self { hidden: vec![64, 64], rate: 3e-3, batch: 128, updates: 100, balance: true }
    }
}

impl NeuralConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        if self.hidden.contains(&0) {
            return Err(format!("hidden is {:?}; no layer may have width 0", self.hidden));
        }
        if !(self.rate.is_finite() && self.rate > 0.0) {
            return Err(format!("rate is {}; it must be a number above 0", self.rate));
        }
        for (name, count) in [("batch", self.batch), ("updates", self.updates as usize)] {
            if count == 0 {
                return Err(format!("{name} is 0; a fit needs at least one"));
            }
        }
        Ok(())
    }
}

/// Layers of rectified units under a sigmoid, fitted by weighted cross-entropy.
///
/// Every fit begins with the same fresh weights (authors), so it is a function of its examples alone. Of one class only it
/// learns that this class is everywhere: it has no one-class fit.
#[derive(Clone, Debug)]
pub struct Neural {
    config: NeuralConfig,
    inputs: usize,
    fresh: ProbabilityNet,
    net: ProbabilityNet,
    fitted: bool,
}

crate::checkpoint!([] Neural; plain: fitted; parts: fresh, net);

impl Neural {
    /// One that has learned nothing yet, for rows of `inputs` numbers; its first weights are drawn from `rng`.
    #[must_use]
    pub fn new(inputs: usize, config: &NeuralConfig, backend: Backend, rng: &mut Rng) -> Self {
        let net = ProbabilityNet::new(inputs, &config.hidden, backend, rng);
        Self { config: config.clone(), inputs, fresh: net.clone(), net, fitted: false }
    }
}

impl Weighing for Neural {
    fn fit_weighted(&mut self, rows: &[Vec<f32>], labels: &[bool], weights: &[f32]) -> Result<(), Unfit> {
        check_rows(rows)?;
        if rows[0].len() != self.inputs {
            return Err(Unfit::Ragged { row: 0, width: rows[0].len(), expected: self.inputs });
        }
        check_paired("labels", labels.len(), rows.len())?;
        check_weights(&weights.iter().map(|w| f64::from(*w)).collect::<Vec<_>>(), rows.len())?;
        let classes = match self.config.balance {
            true => class_weights(labels).map(|weight| weight * rows.len() as f32 / 2.0),
            false => [1.0; 2],
        };
        let step = Step { rate: self.config.rate, decay: 0.0, clip: 0.0 };
        let mut net = self.fresh.clone();
        // Every so many rows make a batch, so that all batches have of either class.
        let batches = rows.len().div_ceil(self.config.batch);
        for update in 0..self.config.updates as usize {
            let chosen = || (update % batches..rows.len()).step_by(batches);
            let batch: Vec<f32> = chosen().flat_map(|i| rows[i].iter().copied()).collect();
            let targets: Vec<f32> = chosen().map(|i| f32::from(u8::from(labels[i]))).collect();
            let counts: Vec<f32> = chosen().map(|i| weights[i] * classes[usize::from(labels[i])]).collect();
            net.learn(batch, &targets, &counts, step);
        }
        (self.net, self.fitted) = (net, true);
        Ok(())
    }

    fn probability(&self, row: &[f32]) -> f32 {
        if self.fitted { self.net.values(row.to_vec())[0] } else { 0.0 }
    }
}

impl Classifier for Neural {
    fn fit(&mut self, positives: &[Vec<f32>], negatives: &[Vec<f32>]) -> Result<(), Unfit> {
        fit_equal(self, positives, negatives)
    }

    fn score(&self, row: &[f32]) -> f32 {
        if self.fitted { self.probability(row) - 0.5 } else { f32::NEG_INFINITY }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Bag, Checkpoint};
    use inroads_envs::Seed;

    fn neural(config: &NeuralConfig, seed: u64) -> Neural {
        Neural::new(2, config, Backend::of_tests(), &mut Seed(seed).stream("weights", 0))
    }

    fn small() -> NeuralConfig {
        NeuralConfig { hidden: vec![32], rate: 0.01, updates: 200, ..NeuralConfig::default() }
    }

    /// Points of a disc of radius one half, and of the square around it.
    fn disc() -> [Vec<Vec<f32>>; 2] {
        let all = (0..15 * 15).map(|i| vec![(i / 15) as f32 / 7.0 - 1.0, (i % 15) as f32 / 7.0 - 1.0]);
        let (inside, outside) = all.partition(|row: &Vec<f32>| row[0].hypot(row[1]) < 0.5);
        [inside, outside]
    }

    #[test]
    fn it_tells_a_disc_from_what_lies_around() {
        let [inside, outside] = disc();
        let mut neural = neural(&small(), 0);
        assert_eq!((neural.score(&[0.0; 2]), neural.probability(&[0.0; 2])), (f32::NEG_INFINITY, 0.0));
        neural.fit(&inside, &outside).unwrap();
        let right = inside.iter().filter(|row| neural.contains(row)).count()
            + outside.iter().filter(|row| !neural.contains(row)).count();
        assert!(right >= 215, "{right} of 225");
        assert!(neural.probability(&[0.0, 0.1]) > 0.9 && neural.probability(&[0.9, -0.9]) < 0.1);
    }

    #[test]
    fn weights_are_odds() {
        // At one place a probability is the share of the weights that are positive.
        let rows = [vec![0.3, 0.2], vec![0.3, 0.2], vec![0.3, 0.2]];
        let (labels, weights) = ([true, false, false], [0.9, 0.1, 0.5]);
        for (balance, expected) in [(false, 0.9 / 1.5), (true, 0.9 / 1.2)] {
            let mut neural = neural(&NeuralConfig { balance, ..small() }, 1);
            neural.fit_weighted(&rows, &labels, &weights).unwrap();
            let p = neural.probability(&[0.3, 0.2]);
            assert!((p - expected).abs() < 0.01, "{p} is not {expected}");
        }
        // A failure of weight 0 is none.
        let mut neural = neural(&NeuralConfig { balance: false, ..small() }, 1);
        neural.fit_weighted(&[vec![0.3, 0.2], vec![0.9, 0.9]], &[true, false], &[1.0, 0.0]).unwrap();
        assert!(neural.probability(&[0.9, 0.9]) > 0.9);
    }

    #[test]
    fn a_fit_begins_anew_and_goes_on_from_a_checkpoint_to_the_same_bits() {
        let [inside, outside] = disc();
        let bits = |neural: &Neural| neural.probability(&[0.2, 0.4]).to_bits();
        let (mut once, mut again) = (neural(&small(), 2), neural(&small(), 2));
        again.fit(&outside, &inside).unwrap();
        let mut bag = Bag::default();
        again.save(&mut bag);
        let mut restored = neural(&small(), 3);
        restored.load(&bag).unwrap();
        assert_eq!(bits(&restored), bits(&again));
        for neural in [&mut once, &mut again, &mut restored] {
            neural.fit(&inside, &outside).unwrap();
        }
        assert_eq!([bits(&once), bits(&once)], [bits(&again), bits(&restored)]);
    }

    #[test]
    fn one_class_is_everywhere_and_what_cannot_be_fitted_changes_nothing() {
        let mut neural = neural(&small(), 4);
        neural.fit_weighted(&[vec![0.0; 2], vec![1.0; 2]], &[false, false], &[1.0, 0.3]).unwrap();
        assert!(!neural.contains(&[0.0; 2]) && !neural.contains(&[0.5; 2]));
        neural.fit(&[vec![0.0; 2]], &[]).unwrap();
        assert!(neural.contains(&[0.1; 2]));
        let before = neural.score(&[0.1; 2]);
        assert_eq!(neural.fit(&[], &[vec![0.0; 2]]), Err(Unfit::NoSamples));
        assert!(neural.fit_weighted(&[vec![0.0; 2]], &[true], &[-1.0]).is_err());
        let why = neural.fit(&[vec![0.0; 3]], &[]).unwrap_err().to_string();
        assert!(why.contains('3') && why.contains('2'), "{why}");
        assert_eq!(neural.score(&[0.1; 2]), before);
        assert!(NeuralConfig { updates: 0, ..small() }.check().unwrap_err().starts_with("updates"));
        assert_eq!(NeuralConfig::default().check(), Ok(()));
    }
}
