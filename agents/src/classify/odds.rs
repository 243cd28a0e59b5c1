//! A classifier of weighted examples that says how probable membership is (thesis 5.1.2).

use serde::{Deserialize, Serialize};

use super::{Classifier, Weighing, class_weights, fit_equal};
use crate::svm::{Unfit, check_paired, check_rows, check_weights};

/// Settings of [`Odds`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct OddsConfig {
    /// Greatest distance of examples that have a say. Where there is none, nothing is inside.
    pub radius: f32,
    /// Whether an example counts the less the more there are of its class, so that of two classes whose examples are
    /// weighted alike either counts the same in sum: the minority is weighted up (Japkowicz and Stephen 2002). Numbers of
    /// examples are balanced, not sums of weights: a class that is trusted less in sum stays so (equation 5.1).
    pub balance: bool,
}

impl Default for OddsConfig {
    fn default() -> Self {
        Self { radius: 0.5, balance: false }
    }
}

impl OddsConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        match self.radius >= 0.0 && self.radius.is_finite() {
            true => Ok(()),
            false => Err(format!("radius is {}; it must be 0 or above", self.radius)),
        }
    }
}

/// The share of positives, by weight, among the examples around a row.
///
/// It is the exact answer to a weighted cross-entropy. Of a model that is constant around a row, −Σ wᵢ (Yᵢ ln p +
/// (1 − Yᵢ) ln(1 − p)) is least at p = Σ wᵢ Yᵢ / Σ wᵢ; so nothing has to converge, and no scale of the weights matters.
#[derive(Clone, Debug)]
pub struct Odds {
    config: OddsConfig,
    /// Where, and the weight: above 0 of a positive, below 0 of a negative.
    examples: Vec<(Vec<f32>, f32)>,
}

crate::checkpoint!([] Odds; plain: examples; parts: );

impl Odds {
    /// One that has learned nothing yet.
    #[must_use]
    pub fn new(config: &OddsConfig) -> Self {
        Self { config: config.clone(), examples: Vec::new() }
    }
}

impl Weighing for Odds {
    fn fit_weighted(&mut self, rows: &[Vec<f32>], labels: &[bool], weights: &[f32]) -> Result<(), Unfit> {
        check_rows(rows)?;
        check_paired("labels", labels.len(), rows.len())?;
        check_weights(&weights.iter().map(|w| f64::from(*w)).collect::<Vec<_>>(), rows.len())?;
        let [negative, positive] = if self.config.balance { class_weights(labels) } else { [1.0; 2] };
        let signed =
            labels.iter().zip(weights).map(|(label, w)| if *label { w * positive } else { w * -negative });
        self.examples = rows.iter().cloned().zip(signed).collect();
        Ok(())
    }

    fn probability(&self, row: &[f32]) -> f32 {
        let reach = self.config.radius.powi(2);
        let (mut inside, mut all) = (0.0, 0.0);
        for (at, weight) in &self.examples {
            if at.iter().zip(row).map(|(a, b)| (a - b).powi(2)).sum::<f32>() <= reach {
                all += weight.abs();
                inside += weight.max(0.0);
            }
        }
        if all > 0.0 { inside / all } else { 0.0 }
    }
}

impl Classifier for Odds {
    fn fit(&mut self, positives: &[Vec<f32>], negatives: &[Vec<f32>]) -> Result<(), Unfit> {
        fit_equal(self, positives, negatives)
    }

    fn score(&self, row: &[f32]) -> f32 {
        if self.examples.is_empty() { f32::NEG_INFINITY } else { self.probability(row) - 0.5 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn odds(radius: f32, balance: bool) -> Odds {
        Odds::new(&OddsConfig { radius, balance })
    }

    #[test]
    fn the_probability_makes_the_weighted_cross_entropy_least() {
        let rows = vec![vec![0.0], vec![0.2], vec![0.4], vec![5.0]];
        let (labels, weights) = ([true, false, false, true], [0.9, 0.1, 0.5, 1.0]);
        let mut odds = odds(1.0, false);
        odds.fit_weighted(&rows, &labels, &weights).unwrap();
        let p = odds.probability(&[0.2]);
        assert!((p - 0.9 / 1.5).abs() < 1e-6);
        let loss = |p: f32| -> f32 {
            (0..3).map(|i| -weights[i] * if labels[i] { p.ln() } else { (1.0 - p).ln() }).sum()
        };
        assert!((1..1000).all(|i| loss(p) <= loss(i as f32 / 1000.0) + 1e-6));
        assert_eq!((odds.probability(&[5.5]), odds.probability(&[9.0])), (1.0, 0.0));
    }

    #[test]
    fn balance_makes_the_classes_weigh_the_same() {
        let rows: Vec<_> = (0..5).map(|_| vec![0.0]).collect();
        let (labels, weights) = ([true, false, false, false, false], [1.0; 5]);
        for (balance, expected) in [(false, 0.2), (true, 0.5)] {
            let mut odds = odds(0.5, balance);
            odds.fit_weighted(&rows, &labels, &weights).unwrap();
            assert!((odds.probability(&[0.0]) - expected).abs() < 1e-6);
        }
    }

    #[test]
    fn balance_leaves_a_class_that_is_trusted_less_its_smaller_sum() {
        // One success that is trusted by 0.2, four failures by 0.8 on average: 0.2 / (0.2 + 3.2 / 4).
        let rows: Vec<_> = (0..5).map(|_| vec![0.0]).collect();
        let (labels, weights) = ([true, false, false, false, false], [0.2, 1.0, 1.0, 0.4, 0.8]);
        let mut odds = odds(0.5, true);
        odds.fit_weighted(&rows, &labels, &weights).unwrap();
        assert!((odds.probability(&[0.0]) - 0.2).abs() < 1e-6);
    }

    #[test]
    fn negatives_alone_make_an_empty_set_and_bad_rows_change_nothing() {
        let mut odds = odds(0.5, true);
        assert_eq!(odds.score(&[0.0]), f32::NEG_INFINITY);
        odds.fit_weighted(&[vec![0.0], vec![1.0]], &[false, false], &[1.0, 0.3]).unwrap();
        assert_eq!((odds.probability(&[0.0]), odds.contains(&[1.0])), (0.0, false));
        assert_eq!(odds.fit(&[], &[vec![0.0]]), Err(Unfit::NoSamples));
        odds.fit(&[vec![0.0]], &[]).unwrap();
        assert!(odds.fit_weighted(&[vec![0.0]], &[true], &[-1.0]).is_err());
        assert!(odds.contains(&[0.3]) && !odds.contains(&[0.6]));
    }
}
