//! What the outputs of a network say of a choice's return: its mean, or a distribution over fixed atoms (C51,
//! Bellemare 2017).

use serde::{Deserialize, Serialize};

use super::Loss;

/// Settings of distributions of return.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct AtomsConfig {
    /// Atoms, at least two; 0 learns means only. Rainbow has 51.
    pub number: usize,
    /// The least return that there can be; −10 (Rainbow, rewards clipped to [−1, 1]).
    pub low: f32,
    /// The greatest; 10 (Rainbow).
    pub high: f32,
}

impl Default for AtomsConfig {
    fn default() -> Self {
        Self { number: 0, low: -10.0, high: 10.0 }
    }
}

impl AtomsConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        if self.number == 1 {
            return Err("number is 1; a distribution has at least two atoms, and 0 means none".into());
        }
        let Self { low, high, .. } = *self;
        if !(low.is_finite() && high.is_finite() && low < high) {
            return Err(format!("low is {low} and high is {high}; low must be a number below high"));
        }
        Ok(())
    }
}

/// How outputs are read.
#[derive(Clone, Debug)]
pub(super) enum Returns {
    /// One output a choice, its mean return.
    Mean,
    /// Logits of the probabilities of these returns, which lie as far apart each.
    Atoms(Vec<f32>),
}

impl Returns {
    pub(super) fn new(config: &AtomsConfig) -> Self {
        let AtomsConfig { number, low, high } = *config;
        if number == 0 {
            return Self::Mean;
        }
        let apart = (high - low) / (number - 1) as f32;
        Self::Atoms((0..number).map(|i| low + i as f32 * apart).collect())
    }

    /// Outputs a choice.
    pub(super) fn outputs(&self) -> usize {
        match self {
            Self::Mean => 1,
            Self::Atoms(atoms) => atoms.len(),
        }
    }

    /// The mean return of every choice.
    pub(super) fn values(&self, outputs: &[f32]) -> Vec<f32> {
        match self {
            Self::Mean => outputs.to_vec(),
            Self::Atoms(atoms) => {
                let mean = |logits: &[f32]| softmax(logits).iter().zip(atoms).map(|(p, z)| p * z).sum();
                outputs.chunks_exact(atoms.len()).map(mean).collect()
            }
        }
    }

    /// Appends what a choice's return should be that paid `sum` and then, times `discount`, what the target network's
    /// outputs for the next choice say: r + γv, or the distribution of that on the atoms.
    pub(super) fn backed_up(&self, sum: f32, discount: f32, next: &[f32], targets: &mut Vec<f32>) {
        match self {
            Self::Mean => targets.push(sum + if discount == 0.0 { 0.0 } else { discount * next[0] }),
            Self::Atoms(atoms) => targets.extend(project(atoms, sum, discount, &softmax(next))),
        }
    }

    /// How far outputs are from a target: their loss, whose derivatives by the outputs go into `slopes`, and the size of
    /// the error, their priority.
    pub(super) fn compare(
        &self,
        outputs: &[f32],
        target: &[f32],
        loss: Loss,
        slopes: &mut [f32],
    ) -> (f32, f32) {
        match self {
            Self::Mean => {
                let error = outputs[0] - target[0];
                slopes[0] = loss.slope(error);
                (loss.value(error), error.abs())
            }
            Self::Atoms(_) => {
                let greatest = outputs.iter().copied().fold(f32::NEG_INFINITY, f32::max);
                let sum: f32 = outputs.iter().map(|x| (x - greatest).exp()).sum();
                let mut entropy = 0.0;
                for ((slope, x), target) in slopes.iter_mut().zip(outputs).zip(target) {
                    *slope = (x - greatest).exp() / sum - target;
                    entropy += target * (sum.ln() - (x - greatest));
                }
                (entropy, entropy)
            }
        }
    }
}

fn softmax(logits: &[f32]) -> Vec<f32> {
    let greatest = logits.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let powers: Vec<f32> = logits.iter().map(|x| (x - greatest).exp()).collect();
    let sum: f32 = powers.iter().sum();
    powers.iter().map(|power| power / sum).collect()
}

/// The distribution of `sum` + `discount` · z on the atoms, where z is one of them with these probabilities: each mass is
/// split between its two neighbours, the nearer the more, and what lies beyond the ends counts as the ends.
fn project(atoms: &[f32], sum: f32, discount: f32, probabilities: &[f32]) -> Vec<f32> {
    let (low, high) = (atoms[0], atoms[atoms.len() - 1]);
    let last = atoms.len() - 1;
    let mut projected = vec![0.0; atoms.len()];
    for (z, p) in atoms.iter().zip(probabilities) {
        let at = ((sum + discount * z).clamp(low, high) - low) / (high - low) * last as f32;
        let below = (at as usize).min(last);
        // On an atom, or on the last one, all of it stays there.
        let above = at - below as f32;
        projected[below] += p * (1.0 - above);
        if above > 0.0 {
            projected[(below + 1).min(last)] += p * above;
        }
    }
    projected
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(found: &[f32], expected: &[f32]) {
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-6, "{found} {expected}");
        }
    }

    fn five() -> AtomsConfig {
        AtomsConfig { number: 5, low: -1.0, high: 1.0 }
    }

    #[test]
    fn mass_is_split_between_neighbours_and_none_is_lost() {
        // algorithms.md 2.1.
        let Returns::Atoms(atoms) = Returns::new(&five()) else { panic!("there are atoms") };
        let uniform = [0.2; 5];
        near(&project(&atoms, 0.5, 0.9, &uniform), &[0.0, 0.16, 0.22, 0.24, 0.38]);
        for (sum, discount) in [(0.5, 0.9), (-7.0, 0.99), (0.0, 1.0), (0.3, 0.0), (9.0, 0.5)] {
            let mass: f32 = project(&atoms, sum, discount, &[0.1, 0.3, 0.05, 0.15, 0.4]).iter().sum();
            assert!((mass - 1.0).abs() < 1e-6, "{mass}");
        }
        // Exactly on an atom, beyond an end, and after a termination.
        near(&project(&atoms, 0.0, 1.0, &[0.1, 0.3, 0.05, 0.15, 0.4]), &[0.1, 0.3, 0.05, 0.15, 0.4]);
        near(&project(&atoms, 5.0, 0.9, &uniform), &[0.0, 0.0, 0.0, 0.0, 1.0]);
        near(&project(&atoms, 0.25, 0.0, &uniform), &[0.0, 0.0, 0.5, 0.5, 0.0]);
    }

    #[test]
    fn the_cross_entropy_falls_along_its_slopes_to_the_entropy_of_its_target() {
        let returns = Returns::new(&five());
        let target = [0.1, 0.2, 0.4, 0.3, 0.0];
        let mut logits = vec![3.0, -1.0, 0.0, 2.0, 1.0];
        let mut slopes = vec![0.0; 5];
        let at = |logits: &[f32], slopes: &mut [f32]| returns.compare(logits, &target, Loss::Huber, slopes).0;
        let (before, error) = returns.compare(&logits, &target, Loss::Huber, &mut slopes);
        assert_eq!(before, error);
        for i in 0..5 {
            let mut moved = logits.clone();
            moved[i] += 1e-2;
            let more = at(&moved, &mut [0.0; 5]);
            moved[i] -= 2e-2;
            let slope = (more - at(&moved, &mut [0.0; 5])) / 2e-2;
            assert!((slopes[i] - slope).abs() < 1e-3, "{} {slope}", slopes[i]);
        }
        for _ in 0..3000 {
            at(&logits, &mut slopes);
            logits.iter_mut().zip(&slopes).for_each(|(x, slope)| *x -= slope);
        }
        let entropy: f32 = target[..4].iter().map(|p: &f32| -p * p.ln()).sum();
        assert!((at(&logits, &mut slopes) - entropy).abs() < 1e-2);
        near(&[returns.values(&[0.0; 10])[1]], &[0.0]);
    }

    #[test]
    fn a_mean_is_backed_up_but_for_what_follows_an_end() {
        let mut targets = Vec::new();
        Returns::Mean.backed_up(1.0, 0.5, &[4.0], &mut targets);
        Returns::Mean.backed_up(1.0, 0.0, &[f32::INFINITY], &mut targets);
        assert_eq!(targets, [3.0, 1.0]);
        assert!(AtomsConfig { low: 1.0, high: 1.0, ..five() }.check().is_err());
    }
}
