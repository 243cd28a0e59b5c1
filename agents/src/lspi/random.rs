//! LSTDQ for actions at random: exact, and cheap.
//!
//! The value of an action at random is `φᵀ θ̄`, where `θ̄` is the mean of the actions' weights. So the system has as many
//! unknowns as there are features, not that many for each action:
//!
//! `θ̄ = 1/|A| Σₐ (Gₐ + λI)⁻¹ Σ_{i with a} φᵢ (rᵢ + γ(1−dᵢ) φ'ᵢᵀ θ̄)`.
//!
//! Its matrix is one for all events but for the transitions that bring an event about, which are taken out one by one.
//! It is solved exactly: the second policy is greedy by these values, far from an event too, where they are tiny. (With
//! residuals of 1e-3 the gaps of the places of Taxi's passenger are 0.08 to 0.17; exactly, 0.41 to 0.49.)

use super::{Batch, dense};

/// What all events have in common, whatever the discount.
#[derive(Clone, Debug, Default)]
pub(super) struct RandomPolicy {
    /// `1/|A| (G + λI)⁻¹ φ` for each distinct transition.
    lifted: Vec<f64>,
    /// `Σ lifted · φ'ᵀ` over transitions after which the episode went on.
    matrix: Vec<f64>,
}

impl RandomPolicy {
    pub(super) fn new(batch: &Batch) -> Self {
        let size = batch.features;
        let (mut exact, mut row) = (vec![0.0; size], vec![0.0; size]);
        let mut lifted = Vec::with_capacity(batch.distinct() * size);
        let mut matrix = vec![0.0; size * size];
        for place in 0..batch.distinct() {
            widen(&batch.before[place * batch.stride..], &mut exact);
            batch.whitenings[batch.action(place)].unwhiten(&exact, &mut row);
            row.iter_mut().for_each(|x| *x /= batch.choices() as f64);
            widen(&batch.after[place * batch.stride..], &mut exact);
            let weight = f64::from(batch.counts[place] * batch.goes_on[place]);
            dense::add_product(&mut matrix, &row, &exact, weight);
            lifted.extend_from_slice(&row);
        }
        Self { lifted, matrix }
    }

    /// `θ̄` by a discount for an event that some transitions bring about, each given with how many of its likes do.
    pub(super) fn weights(&self, batch: &Batch, gamma: f64, event: &[(usize, f32)]) -> Vec<f32> {
        let size = batch.features;
        let (mut matrix, mut right, mut after) = (self.matrix.clone(), vec![0.0; size], vec![0.0; size]);
        for &(place, count) in event {
            let lifted = &self.lifted[place * size..][..size];
            right.iter_mut().zip(lifted).for_each(|(sum, x)| *sum += f64::from(count) * x);
            if batch.goes_on[place] > 0.0 {
                widen(&batch.after[place * batch.stride..], &mut after);
                dense::add_product(&mut matrix, lifted, &after, -f64::from(count));
            }
        }
        matrix.iter_mut().for_each(|x| *x *= -gamma);
        matrix.iter_mut().step_by(size + 1).for_each(|x| *x += 1.0);
        dense::solve(&mut matrix, &mut right);
        let mut weights: Vec<f32> = right.iter().map(|&x| x as f32).collect();
        weights.resize(batch.stride, 0.0);
        weights
    }
}

fn widen(row: &[f32], exact: &mut [f64]) {
    exact.iter_mut().zip(row).for_each(|(wide, &x)| *wide = f64::from(x));
}
