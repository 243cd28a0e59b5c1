//! Values of choices from features and a goal: Q = V + A − mean A (Wang 2016).
//!
//! The goal joins here, behind whatever made the features. So the value of every goal from one state costs one pass of
//! that, and with a memory in it the memory knows of no goal and stays right when a step is learned from for another one
//! (`docs/results/learners.md`; the authors' R2D2 has it so).
//!
//! A choice may have several outputs, atoms of a distribution; the sum and the mean are then atom by atom, before any
//! softmax (Rainbow, Hessel 2018, section 4).

use burn::module::Module;
use burn::nn::Linear;
use burn::tensor::activation::relu;
use burn::tensor::{Device, Tensor};
use inroads_envs::Rng;

use super::init;
use super::noisy::{Factors, Noisy};

/// The sizes of a head.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HeadShape {
    pub(crate) features: usize,
    /// Numbers a goal; 0 where none is read.
    pub(crate) goal: usize,
    pub(crate) hidden: usize,
    pub(crate) choices: usize,
}

/// What a head may be made of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HeadParts {
    /// Whether there are values and advantages, or values of choices at once.
    pub(crate) split: bool,
    /// Outputs a choice.
    pub(crate) atoms: usize,
    /// σ₀ of [`Noisy`] layers; 0 for none.
    pub(crate) noise: f32,
}

impl Default for HeadParts {
    /// Dueling, and nothing else.
    fn default() -> Self {
        Self { split: true, atoms: 1, noise: 0.0 }
    }
}

/// One hidden layer, then a value and an advantage of every choice.
#[derive(Module, Debug, Default)]
pub(crate) struct Dueling {
    features: Noisy,
    /// Empty where no goal is read.
    goal: Vec<Noisy>,
    /// Empty where nothing is split.
    value: Vec<Noisy>,
    advantage: Noisy,
    /// Features, numbers a goal, hidden units, choices, outputs a choice.
    sizes: [usize; 5],
    noisy: bool,
}

impl Dueling {
    pub(crate) fn new(shape: HeadShape, device: &Device, rng: &mut Rng) -> Self {
        Self::with_parts(shape, HeadParts::default(), device, rng)
    }

    pub(crate) fn with_parts(shape: HeadShape, parts: HeadParts, device: &Device, rng: &mut Rng) -> Self {
        let HeadShape { features, goal, hidden, choices } = shape;
        let HeadParts { split, atoms, noise } = parts;
        let joined = features + goal;
        let bound = init::bound(joined);
        // Means of noisy layers begin as the paper's do, others near zero.
        let last = if noise > 0.0 { init::bound(hidden) } else { init::LAST };
        let noisy = |mean: Linear, inputs: usize| Noisy::new(mean, noise, inputs, device);
        let first = noisy(init::uniform(features, hidden, bound, device, rng), joined);
        let by_goal = (goal > 0).then(|| {
            let layer = init::uniform(goal, hidden, bound, device, rng);
            noisy(Linear { bias: None, ..layer }, joined)
        });
        let value = split.then(|| noisy(init::uniform(hidden, atoms, last, device, rng), hidden));
        let advantage = noisy(init::uniform(hidden, choices * atoms, last, device, rng), hidden);
        Self {
            features: first,
            goal: by_goal.into_iter().collect(),
            value: value.into_iter().collect(),
            advantage,
            sizes: [features, goal, hidden, choices, atoms],
            noisy: noise > 0.0,
        }
    }

    /// Factors a row of noise has; 0 where there is none.
    pub(crate) fn noise_width(&self) -> usize {
        let [features, goal, hidden, choices, atoms] = self.sizes;
        let value = if self.value.is_empty() { 0 } else { hidden + atoms };
        if self.noisy { features + goal + hidden + value + hidden + choices * atoms } else { 0 }
    }

    /// Values of all choices, a row for each row of features and of goals.
    pub(crate) fn forward(&self, features: Tensor<2>, goals: Option<Tensor<2>>) -> Tensor<2> {
        self.noisy_forward(features, goals, None)
    }

    /// The same with rows of noise, or one for all rows. One row of features serves all rows of goals.
    pub(crate) fn noisy_forward(
        &self,
        features: Tensor<2>,
        goals: Option<Tensor<2>>,
        noise: Option<Tensor<2>>,
    ) -> Tensor<2> {
        let [by_features, by_goal, width, choices, atoms] = self.sizes;
        let mut noise = noise.map(Factors::new);
        let mut take = |columns: usize| noise.as_mut().and_then(|noise| noise.take(columns));
        let (inputs, of_goal, hidden) = (take(by_features), take(by_goal), take(width));
        let product = self.features.forward(features, inputs.zip(hidden.clone()));
        let joined = match (self.goal.first(), goals) {
            (Some(layer), Some(goals)) => product + layer.forward(goals, of_goal.zip(hidden)),
            _ => product,
        };
        let hidden = relu(joined);
        let value = self.value.first().map(|layer| {
            let noise = take(width).zip(take(atoms));
            layer.forward(hidden.clone(), noise)
        });
        let noise = take(width).zip(take(choices * atoms));
        let advantage = self.advantage.forward(hidden, noise);
        let Some(value) = value else { return advantage };
        let n = advantage.dims()[0];
        let advantage = advantage.reshape([n, choices, atoms]);
        let mean = advantage.clone().mean_dim(1);
        (value.reshape([n, 1, atoms]) + advantage - mean).reshape([n, choices * atoms])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nets::noisy::head_noise;
    use crate::nets::{Backend, floats, rows};
    use inroads_envs::Seed;

    const SHAPE: HeadShape = HeadShape { features: 3, goal: 2, hidden: 8, choices: 4 };

    fn head(parts: HeadParts) -> Dueling {
        Dueling::with_parts(SHAPE, parts, &Backend::of_tests().plain(), &mut Seed(2).stream("weights", 0))
    }

    fn values(head: &Dueling, noise: Option<Vec<f32>>) -> Vec<f32> {
        let device = Backend::of_tests().plain();
        let (x, g) = (rows(vec![0.3, -1.0, 2.0], 3, &device), rows(vec![1.0, 0.0], 2, &device));
        let noise = noise.map(|noise| rows(noise, head.noise_width(), &device));
        floats(head.noisy_forward(x, Some(g), noise))
    }

    #[test]
    fn a_constant_more_of_every_advantage_changes_no_value() {
        for atoms in [1, 3] {
            let mut head = head(HeadParts { atoms, ..HeadParts::default() });
            let before = values(&head, None);
            let layer = head.advantage.mean_mut();
            let bias = layer.bias.take().unwrap();
            layer.bias = Some(bias.map(|bias| bias + 7.0));
            for (a, b) in before.iter().zip(values(&head, None)) {
                assert!((a - b).abs() < 1e-5, "{a} {b}");
            }
            assert!(before.windows(2).any(|w| w[0] != w[1]) && before.len() == 4 * atoms);
        }
        // What is not split has no such freedom.
        let mut plain = head(HeadParts { split: false, ..HeadParts::default() });
        let before = values(&plain, None);
        let layer = plain.advantage.mean_mut();
        layer.bias = layer.bias.take().map(|bias| bias.map(|bias| bias + 7.0));
        assert!((values(&plain, None)[0] - before[0] - 7.0).abs() < 1e-5);
    }

    #[test]
    fn noise_of_no_size_is_none_and_other_noise_differs_from_draw_to_draw() {
        let mut rng = Seed(0).stream("noise", 0);
        let noisy = head(HeadParts { atoms: 3, noise: 0.5, ..HeadParts::default() });
        let width = noisy.noise_width();
        // Features, goal, hidden; hidden, atoms; hidden, choices × atoms.
        assert_eq!(width, 3 + 2 + 8 + (8 + 3) + (8 + 12));
        let quiet = values(&noisy, None);
        assert_eq!(values(&noisy, Some(vec![0.0; width])), quiet);
        let [one, two] = [(); 2].map(|()| values(&noisy, Some(head_noise(width, &mut rng))));
        assert!(one != two && one != quiet);
        assert_eq!(head(HeadParts::default()).noise_width(), 0);
    }
}
