//! Rows of numbers from rows of numbers, by least squares: what a model of the dynamics is (Nagabandi 2018).

use burn::module::Module;
use burn::nn::Linear;
use burn::optim::GradientsParams;
use burn::tensor::activation::{leaky_relu, relu};
use burn::tensor::{Device, Tensor};
use inroads_envs::Rng;

use super::adam::{Adam, Step};
use super::{Backend, floats, init, load_values, rows, values};
use crate::{Bag, Checkpoint, Corrupt};

/// The shape of a regressor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layers<'a> {
    pub(crate) inputs: usize,
    pub(crate) hidden: &'a [usize],
    pub(crate) outputs: usize,
    /// What a hidden unit passes on of what is below zero: 0 is ReLU.
    pub(crate) slope: f32,
}

/// Layers with a linear one on top, and the state of their optimiser. Clones learn on independently.
#[derive(Clone, Debug)]
pub(crate) struct Regressor {
    net: Stack,
    adam: Adam,
    slope: f32,
    inputs: usize,
    outputs: usize,
    device: Device,
}

#[derive(Module, Debug, Default)]
struct Stack {
    layers: Vec<Linear>,
}

impl Stack {
    fn forward(&self, rows: Tensor<2>, slope: f32) -> Tensor<2> {
        let (first, rest) = self.layers.split_first().expect("there is a last layer");
        let bend = |x| if slope == 0.0 { relu(x) } else { leaky_relu(x, f64::from(slope)) };
        rest.iter().fold(first.forward(rows), |x, layer| layer.forward(bend(x)))
    }
}

impl Regressor {
    /// All weights begin as PyTorch's do, and so the authors'.
    pub(crate) fn new(shape: Layers<'_>, backend: Backend, rng: &mut Rng) -> Self {
        let Layers { inputs, hidden, outputs, slope } = shape;
        let device = backend.plain();
        let mut width = inputs;
        let mut layers = init::hidden(&mut width, hidden, &device, rng);
        layers.push(init::by_inputs(width, outputs, &device, rng));
        Self { net: Stack { layers }, adam: Adam::default(), slope, inputs, outputs, device }
    }

    /// Outputs, one row for each row of inputs.
    pub(crate) fn predict(&self, inputs: Vec<f32>) -> Vec<f32> {
        floats(self.net.forward(rows(inputs, self.inputs, &self.device), self.slope))
    }

    /// One step down the mean square error of these rows; that error before the step, NaN where it was not made.
    pub(crate) fn learn(&mut self, inputs: Vec<f32>, targets: Vec<f32>, step: Step) -> f32 {
        let net = self.net.clone().train();
        let tracked = |values, width| rows(values, width, &self.device).autodiff();
        let error = net.forward(tracked(inputs, self.inputs), self.slope) - tracked(targets, self.outputs);
        let loss = (error.clone() * error).mean();
        let before = floats(loss.clone().inner())[0];
        let grads = GradientsParams::from_grads(loss.backward(), &net);
        drop((loss, net)); // so that the parameters are changed in place
        if self.adam.step(step, &mut self.net, grads) { before } else { f32::NAN }
    }
}

impl Checkpoint for Regressor {
    fn save(&self, bag: &mut Bag) {
        bag.put("net", &values(&self.net));
        bag.put("adam", &self.adam);
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        load_values(&mut self.net, "net", bag)?;
        self.adam = bag.get("adam")?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use inroads_envs::Seed;

    #[test]
    fn either_unit_fits_a_bent_line_and_only_the_leaky_one_passes_on_what_is_below_zero() {
        for slope in [0.0, 0.01] {
            let shape = Layers { inputs: 1, hidden: &[16], outputs: 2, slope };
            let mut net = Regressor::new(shape, Backend::of_tests(), &mut Seed(1).stream("weights", 0));
            let x: Vec<f32> = (0..32).map(|i| i as f32 / 16.0 - 1.0).collect();
            let y: Vec<f32> = x.iter().flat_map(|x| [x.abs(), -2.0 * x]).collect();
            let step = Step { rate: 0.01, ..Step::default() };
            let first = net.learn(x.clone(), y.clone(), step);
            let last = (0..800).map(|_| net.learn(x.clone(), y.clone(), step)).last().unwrap();
            assert!(first > 0.3 && last < 1e-3, "{slope}: {first} {last}");
            assert!((net.predict(vec![0.5])[1] + 1.0).abs() < 0.1);
        }
        let device = Backend::of_tests().plain();
        let one = || init::layer(vec![1.0], vec![0.0], &device);
        let stack = Stack { layers: vec![one(), one()] };
        let at = |slope| floats(stack.forward(rows(vec![-2.0], 1, &device), slope))[0];
        assert_eq!((at(0.0), at(0.5)), (0.0, -1.0));
    }
}
