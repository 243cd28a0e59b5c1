//! Initial weights, drawn from our own streams.
//!
//! Burn's own initialisers draw from one generator of the whole process, in the order in which parameters are
//! first used. So layers are filled here, weights before biases, in the order in which they are made.

use burn::module::Param;
use burn::nn::Linear;
use burn::tensor::{Device, Tensor, TensorData};
use inroads_envs::Rng;
use rand::RngExt;

/// Bound of the last layer of actor and critic: outputs begin near zero (DDPG, Lillicrap 2015, section 7).
pub(crate) const LAST: f32 = 3e-3;

/// A layer with weights and biases from U(±1/√inputs): hidden layers of DDPG (Lillicrap 2015, section 7), and
/// what PyTorch, and so the authors' DQN, does by default.
pub(crate) fn by_inputs(inputs: usize, outputs: usize, device: &Device, rng: &mut Rng) -> Linear {
    uniform(inputs, outputs, bound(inputs), device, rng)
}

/// 1/√inputs.
pub(crate) fn bound(inputs: usize) -> f32 {
    (inputs as f32).sqrt().recip()
}

/// Layers of these widths, each by [`by_inputs`]; `width` is that of the inputs, and then of the last layer.
pub(crate) fn hidden(width: &mut usize, widths: &[usize], device: &Device, rng: &mut Rng) -> Vec<Linear> {
    let mut layer = |&next| by_inputs(std::mem::replace(width, next), next, device, rng);
    widths.iter().map(&mut layer).collect()
}

/// A layer with weights and biases from U(±`bound`).
pub(crate) fn uniform(inputs: usize, outputs: usize, bound: f32, device: &Device, rng: &mut Rng) -> Linear {
    let mut draw = |n: usize| (0..n).map(|_| rng.random_range(-bound..=bound)).collect();
    let weight = draw(inputs * outputs);
    layer(weight, draw(outputs), device)
}

/// A layer of the given numbers; the biases say how many outputs it has.
pub(crate) fn layer(weight: Vec<f32>, bias: Vec<f32>, device: &Device) -> Linear {
    let outputs = bias.len();
    let inputs = weight.len() / outputs;
    let weight = Tensor::from_data(TensorData::new(weight, [inputs, outputs]), device);
    let bias = Tensor::from_data(TensorData::new(bias, [outputs]), device);
    Linear { weight: Param::from_tensor(weight), bias: Some(Param::from_tensor(bias)) }
}
