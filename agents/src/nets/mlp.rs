//! Layers of rectified units: the shape of every network of chapter 3.

use burn::module::Module;
use burn::nn::Linear;
use burn::tensor::activation::relu;
use burn::tensor::{Device, Tensor};
use inroads_envs::Rng;

use super::init;

/// Layers of rectified units with a linear layer on top.
#[derive(Module, Debug, Default)]
pub(crate) struct Mlp {
    layers: Vec<Linear>,
}

impl Mlp {
    /// Hidden layers of these widths, and a last layer that begins within ±`last`.
    pub(crate) fn new(
        inputs: usize,
        hidden: &[usize],
        outputs: usize,
        last: f32,
        device: &Device,
        rng: &mut Rng,
    ) -> Self {
        let mut width = inputs;
        let mut layers = init::hidden(&mut width, hidden, device, rng);
        layers.push(init::uniform(width, outputs, last, device, rng));
        Self { layers }
    }

    /// Outputs, one row for each row of inputs.
    pub(crate) fn forward(&self, rows: Tensor<2>) -> Tensor<2> {
        self.forward_joined(rows, None)
    }

    /// Outputs when the first layer also gets `joined`, products of its own with something else.
    fn forward_joined(&self, rows: Tensor<2>, joined: Option<Tensor<2>>) -> Tensor<2> {
        let (first, rest) = self.layers.split_first().expect("there is a last layer");
        let product = first.forward(rows);
        let product = if let Some(joined) = joined { product + joined } else { product };
        rest.iter().fold(product, |x, layer| layer.forward(relu(x)))
    }
}

/// The value of an action at a state. The action enters at the second layer (DDPG, Lillicrap 2015, section 7) or at the
/// first (TD3, Fujimoto 2018).
///
/// That layer has one matrix for the features before it and another for the action: nothing is copied
/// together, and the actor's update, which needs the derivative by the action alone, computes no other.
#[derive(Module, Debug, Default)]
pub(crate) struct Critic {
    state: Vec<Linear>,
    features: Mlp,
    action: Vec<Linear>,
}

impl Critic {
    /// A critic with these hidden layers, of which the first `alone` see the state only.
    pub(crate) fn new(
        inputs: usize,
        actions: usize,
        hidden: &[usize],
        alone: usize,
        device: &Device,
        rng: &mut Rng,
    ) -> Self {
        let (alone, rest) = hidden.split_at(alone);
        let mut width = inputs;
        let state = init::hidden(&mut width, alone, device, rng);
        let features = Mlp::new(width, rest, 1, init::LAST, device, rng);
        // The action's weights begin within the same bounds as the features'.
        let (outputs, bound) = rest.first().map_or((1, init::LAST), |&next| (next, init::bound(width)));
        let action = Linear { bias: None, ..init::uniform(actions, outputs, bound, device, rng) };
        Self { state, features, action: vec![action] }
    }

    /// One value for each row.
    pub(crate) fn forward(&self, rows: Tensor<2>, actions: Tensor<2>) -> Tensor<2> {
        let joined = self.action.first().map(|layer| layer.forward(actions));
        self.features.forward_joined(rectified(&self.state, rows), joined)
    }
}

/// Rows after all of these layers, each followed by max(0, ·).
pub(crate) fn rectified(layers: &[Linear], rows: Tensor<2>) -> Tensor<2> {
    layers.iter().fold(rows, |x, layer| relu(layer.forward(x)))
}
