//! Values of choices from features and a goal: Q = V + A − mean A (Wang 2016).
//!
//! The goal joins here, behind whatever made the features. So the value of every goal from one state costs one pass of
//! that, and with a memory in it the memory knows of no goal and stays right when a step is learned from for another one
//! (`docs/results/learners.md`; the authors' R2D2 has it so).

use burn::module::Module;
use burn::nn::Linear;
use burn::tensor::activation::relu;
use burn::tensor::{Device, Tensor};
use inroads_envs::Rng;

use super::init;

/// The sizes of a head.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HeadShape {
    pub(crate) features: usize,
    /// Numbers a goal; 0 where none is read.
    pub(crate) goal: usize,
    pub(crate) hidden: usize,
    pub(crate) choices: usize,
}

/// One hidden layer, then a value and an advantage of every choice.
#[derive(Module, Debug, Default)]
pub(crate) struct Dueling {
    features: Vec<Linear>,
    /// Empty where no goal is read.
    goal: Vec<Linear>,
    value: Vec<Linear>,
    advantage: Vec<Linear>,
}

impl Dueling {
    pub(crate) fn new(shape: HeadShape, device: &Device, rng: &mut Rng) -> Self {
        let HeadShape { features, goal, hidden, choices } = shape;
        let joined = init::bound(features + goal);
        let first = init::uniform(features, hidden, joined, device, rng);
        let goal =
            (goal > 0).then(|| Linear { bias: None, ..init::uniform(goal, hidden, joined, device, rng) });
        Self {
            features: vec![first],
            goal: goal.into_iter().collect(),
            value: vec![init::uniform(hidden, 1, init::LAST, device, rng)],
            advantage: vec![init::uniform(hidden, choices, init::LAST, device, rng)],
        }
    }

    /// Values of all choices, a row for each row of features and of goals.
    pub(crate) fn forward(&self, features: Tensor<2>, goals: Option<Tensor<2>>) -> Tensor<2> {
        let product = self.features[0].forward(features);
        let joined = match (self.goal.first(), goals) {
            (Some(layer), Some(goals)) => product + layer.forward(goals),
            _ => product,
        };
        let hidden = relu(joined);
        let advantage = self.advantage[0].forward(hidden.clone());
        let mean = advantage.clone().mean_dim(1);
        self.value[0].forward(hidden) + advantage - mean
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nets::{Backend, floats, rows};
    use inroads_envs::Seed;

    #[test]
    fn a_constant_more_of_every_advantage_changes_no_value() {
        let device = Backend::of_tests().plain();
        let shape = HeadShape { features: 3, goal: 2, hidden: 8, choices: 4 };
        let mut head = Dueling::new(shape, &device, &mut Seed(2).stream("weights", 0));
        let values = |head: &Dueling| {
            let (x, g) = (rows(vec![0.3, -1.0, 2.0], 3, &device), rows(vec![1.0, 0.0], 2, &device));
            floats(head.forward(x, Some(g)))
        };
        let before = values(&head);
        let bias = head.advantage[0].bias.take().unwrap();
        head.advantage[0].bias = Some(bias.map(|bias| bias + 7.0));
        for (a, b) in before.iter().zip(values(&head)) {
            assert!((a - b).abs() < 1e-5, "{a} {b}");
        }
        assert!(before.windows(2).any(|w| w[0] != w[1]));
    }
}
