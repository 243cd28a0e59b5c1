//! Values of a growing number of choices, with a slow target (double DQN, van Hasselt 2016; thesis 3.1.2).
//!
//! Each choice has a head of its own, a column `[features, 1]`. A column more in *one* matrix could change the
//! last bits of the old columns' products (the kernel depends on the width); a head more cannot.

use burn::module::Module;
use burn::nn::Linear;
use burn::optim::GradientsParams;
use burn::tensor::{Device, Tensor};
use inroads_envs::Rng;

use super::adam::{Adam, Step};
use super::mlp::rectified;
use super::{Backend, floats, init, load_values, rows, target, values};
use crate::{Bag, Checkpoint, Corrupt};

/// Shared layers of rectified units with one head a choice.
#[derive(Module, Debug, Default)]
struct Heads {
    hidden: Vec<Linear>,
    heads: Vec<Linear>,
}

impl Heads {
    fn forward(&self, rows: Tensor<2>) -> Tensor<2> {
        let features = rectified(&self.hidden, rows);
        Tensor::cat(self.heads.iter().map(|head| head.forward(features.clone())).collect(), 1)
    }
}

/// A network, its target and its optimiser. Clones learn on independently.
#[derive(Clone, Debug)]
pub(crate) struct QNetwork {
    online: Heads,
    target: Heads,
    adam: Adam,
    inputs: usize,
    features: usize,
    device: Device,
}

impl QNetwork {
    pub(crate) fn new(
        inputs: usize,
        hidden: &[usize],
        outputs: usize,
        backend: Backend,
        rng: &mut Rng,
    ) -> Self {
        let device = backend.plain();
        let mut width = inputs;
        let hidden = init::hidden(&mut width, hidden, &device, rng);
        let heads = (0..outputs).map(|_| init::by_inputs(width, 1, &device, rng)).collect();
        let online = Heads { hidden, heads };
        Self { target: online.clone(), online, adam: Adam::default(), inputs, features: width, device }
    }

    pub(crate) fn outputs(&self) -> usize {
        self.online.heads.len()
    }

    pub(crate) fn values(&self, states: Vec<f32>) -> Vec<f32> {
        floats(self.online.forward(rows(states, self.inputs, &self.device)))
    }

    pub(crate) fn target_values(&self, states: Vec<f32>) -> Vec<f32> {
        floats(self.target.forward(rows(states, self.inputs, &self.device)))
    }

    /// One step of the values of these choices towards these targets; `slope` is the derivative of the loss by
    /// the error. The errors before the step; NaN where it was not made, because its gradient was not finite.
    pub(crate) fn learn(
        &mut self,
        states: Vec<f32>,
        choices: &[usize],
        targets: &[f32],
        slope: impl Fn(f32) -> f32,
        step: Step,
    ) -> Vec<f32> {
        let (n, outputs) = (choices.len(), self.outputs());
        let online = self.online.clone().train();
        let q = online.forward(rows(states, self.inputs, &self.device).autodiff());
        let all = floats(q.clone().inner());
        let mut errors = Vec::with_capacity(n);
        // The loss's derivative by each value: 0 for the choices that were not made.
        let mut slopes = vec![0.0; n * outputs];
        for (row, (&choice, target)) in choices.iter().zip(targets).enumerate() {
            let error = all[row * outputs + choice] - target;
            slopes[row * outputs + choice] = slope(error) / n as f32;
            errors.push(error);
        }
        let loss = (q * rows(slopes, outputs, &self.device).autodiff()).sum();
        let grads = GradientsParams::from_grads(loss.backward(), &online);
        drop((loss, online));
        if !self.adam.step(step, &mut self.online, grads) {
            errors.fill(f32::NAN);
        }
        errors
    }

    /// The target follows by one step of size `tau`.
    pub(crate) fn follow(&mut self, tau: f32) {
        target::follow(&mut self.target, &self.online, tau);
    }

    /// One choice more, worth `bias` everywhere. Nothing else changes, in either network or the optimiser.
    pub(crate) fn grow(&mut self, bias: f32) {
        let head = init::layer(vec![0.0; self.features], vec![bias], &self.device);
        self.target.heads.push(head.clone());
        self.online.heads.push(head);
    }
}

impl Checkpoint for QNetwork {
    fn save(&self, bag: &mut Bag) {
        bag.put("outputs", &self.outputs());
        bag.put("online", &values(&self.online));
        bag.put("target", &values(&self.target));
        bag.put("adam", &self.adam);
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        // A network may have grown since it was configured; it never shrinks.
        let outputs: usize = bag.get("outputs")?;
        while self.outputs() < outputs {
            self.grow(0.0);
        }
        self.online.heads.truncate(outputs);
        self.target.heads.truncate(outputs);
        load_values(&mut self.online, "online", bag)?;
        load_values(&mut self.target, "target", bag)?;
        self.adam = bag.get("adam")?;
        Ok(())
    }
}
