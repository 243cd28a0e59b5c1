//! Linear layers whose weights may be noisy, so that who acts on them explores (Fortunato 2018, section 3.1).
//!
//! The noise of a weight is a product of one number of its input and one of its output ("factorised"). So y = x(μ + σ∘ffᵀ)
//! is two products with matrices that stay as they are, and each row of a batch may have noise of its own.

use burn::module::Module;
use burn::nn::Linear;
use burn::tensor::{Device, Tensor};
use inroads_envs::Rng;
use rand_distr::{Distribution, StandardNormal};

use super::init;

/// So many factors f(ξ) = sgn(ξ)√|ξ| of standard normal ξ.
pub(crate) fn head_noise(factors: usize, rng: &mut Rng) -> Vec<f32> {
    let factor = |x: f32| x.abs().sqrt().copysign(x);
    (0..factors).map(|_| factor(StandardNormal.sample(rng))).collect()
}

/// A linear layer, and where it is noisy another one of the noise's sizes.
#[derive(Module, Debug, Default)]
pub(crate) struct Noisy {
    /// μ.
    mean: Vec<Linear>,
    /// σ; empty where there is no noise.
    spread: Vec<Linear>,
}

impl Noisy {
    /// A layer that begins as `mean`, with noise of σ = `size`/√`inputs` on every number of it; none of size 0.
    pub(crate) fn new(mean: Linear, size: f32, inputs: usize, device: &Device) -> Self {
        let spread = (size > 0.0).then(|| {
            let sigma = size * init::bound(inputs);
            let [rows, columns] = mean.weight.dims();
            let spread = init::layer(vec![sigma; rows * columns], vec![sigma; columns], device);
            if mean.bias.is_some() { spread } else { Linear { bias: None, ..spread } }
        });
        Self { mean: vec![mean], spread: spread.into_iter().collect() }
    }

    /// Rows of outputs. Factors of inputs and of outputs are a row each for every row, or one row for all.
    pub(crate) fn forward(&self, rows: Tensor<2>, noise: Option<(Tensor<2>, Tensor<2>)>) -> Tensor<2> {
        let product = self.mean[0].forward(rows.clone());
        match (self.spread.first(), noise) {
            (Some(spread), Some((inputs, outputs))) => product + spread.forward(rows * inputs) * outputs,
            _ => product,
        }
    }

    /// The layer without its noise.
    #[cfg(test)]
    pub(crate) fn mean_mut(&mut self) -> &mut Linear {
        &mut self.mean[0]
    }
}

/// Rows of factors, taken from column by column.
pub(crate) struct Factors {
    rows: Tensor<2>,
    taken: usize,
}

impl Factors {
    pub(crate) fn new(rows: Tensor<2>) -> Self {
        Self { rows, taken: 0 }
    }

    /// The next columns; none of none.
    pub(crate) fn take(&mut self, columns: usize) -> Option<Tensor<2>> {
        self.taken += columns;
        (columns > 0).then(|| self.rows.clone().narrow(1, self.taken - columns, columns))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nets::{Backend, floats, rows};
    use inroads_envs::Seed;

    #[test]
    fn weights_and_biases_have_the_noise_of_their_input_and_output() {
        let device = Backend::of_tests().plain();
        let mean = init::layer(vec![1.0, 2.0, 3.0, 4.0], vec![0.5, -0.5], &device);
        let layer = Noisy::new(mean, 0.4, 4, &device);
        let noise = || Some((rows(vec![1.0, -2.0], 2, &device), rows(vec![3.0, 0.5], 2, &device)));
        let found = floats(layer.forward(rows(vec![1.0, 10.0], 2, &device), noise()));
        // σ is 0.4/√4 = 0.2; weight (i, j) is μ + 0.2 f_i f_j, bias j is μ + 0.2 f_j.
        let weight = |mu: f32, input: f32, output: f32| mu + 0.2 * input * output;
        for (j, output) in [3.0, 0.5].into_iter().enumerate() {
            let (first, second, bias) = ([1.0, 2.0][j], [3.0, 4.0][j], [0.5, -0.5][j]);
            let expected =
                weight(first, 1.0, output) + 10.0 * weight(second, -2.0, output) + (bias + 0.2 * output);
            assert!((found[j] - expected).abs() < 1e-5, "{} {expected}", found[j]);
        }
    }

    #[test]
    fn factors_are_roots_of_normal_draws() {
        let drawn = head_noise(100_000, &mut Seed(0).stream("test", 0));
        let mean = |of: &dyn Fn(f32) -> f32| drawn.iter().map(|x| of(*x)).sum::<f32>() / drawn.len() as f32;
        // E f = 0, E f⁴ = E ξ² = 1.
        assert!(mean(&|x| x).abs() < 0.01 && (mean(&|x| x.powi(4)) - 1.0).abs() < 0.02);
    }
}
