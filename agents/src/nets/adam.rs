//! Adam (Kingma and Ba 2015) in one pass over each parameter.
//!
//! Burn's Adam makes about ten passes and clips each parameter by itself; this one makes one, clips by the norm
//! of the whole gradient, and keeps its moments as plain numbers in the order in which the module lists its
//! parameters, so that they can be saved and survive the growing of a network.

use std::mem::take;

use burn::module::{Module, ModuleMapper, ModuleVisitor, Param};
use burn::optim::GradientsParams;
use burn::tensor::Tensor;
use serde::{Deserialize, Serialize};

/// Decay of the mean of gradients; the paper's value, and PyTorch's.
const BETA1: f32 = 0.9;
/// Decay of the mean of squared gradients; the paper's value, and PyTorch's.
const BETA2: f32 = 0.999;
/// Moments below this are taken for zero. The moments of a dead unit decay for ever, and arithmetic on
/// denormal numbers is up to a hundred times slower; at this size none can move a parameter any more.
const NOTHING: f32 = 1e-30;

/// Adam's settings.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step {
    pub(crate) rate: f32,
    /// Added to the gradient, times the parameter (L2, as PyTorch's `weight_decay`).
    pub(crate) decay: f32,
    /// Greatest norm of the whole gradient; 0 for any.
    pub(crate) clip: f32,
    /// Added to the root.
    pub(crate) epsilon: f32,
}

impl Default for Step {
    /// The paper's values, and PyTorch's (Burn's default ε is 1e-5).
    fn default() -> Self {
        Self { rate: 1e-3, decay: 0.0, clip: 0.0, epsilon: 1e-8 }
    }
}

/// Adam's state for one network.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Adam {
    steps: u64,
    /// Means of gradients and of their squares, one pair a parameter, in the module's order.
    moments: Vec<(Vec<f32>, Vec<f32>)>,
}

impl Adam {
    /// One step of the module down these gradients; whether it was made. None is made, and nothing changes, when the square
    /// of one of them is not finite: the parameters would never be numbers again. Whoever asked for it must tell
    /// ([`Context::check`](crate::Context::check)).
    #[must_use]
    pub(crate) fn step<M: Module + Default>(
        &mut self,
        step: Step,
        module: &mut M,
        grads: GradientsParams,
    ) -> bool {
        let mut size = Size { grads: &grads, squares: (step.clip > 0.0).then_some(0.0), greatest: 0 };
        module.visit(&mut size);
        let (greatest, norm) = (f32::from_bits(size.greatest), size.squares.map(f32::sqrt));
        if !((greatest * greatest).is_finite() && norm.is_none_or(f32::is_finite)) {
            return false;
        }
        let scale = norm.map_or(1.0, |norm| (step.clip / norm.max(f32::MIN_POSITIVE)).min(1.0));
        self.steps += 1;
        // Bias corrections, folded into the rate and epsilon as the paper's section 2 suggests.
        let t = self.steps as f64;
        let first = 1.0 - f64::from(BETA1).powf(t);
        let second = (1.0 - f64::from(BETA2).powf(t)).sqrt();
        let mut update = Update {
            moments: &mut self.moments,
            index: 0,
            grads,
            scale,
            decay: step.decay,
            rate: (f64::from(step.rate) * second / first) as f32,
            epsilon: (f64::from(step.epsilon) * second) as f32,
        };
        *module = take(module).map(&mut update);
        true
    }
}

/// How large a gradient is.
struct Size<'a> {
    grads: &'a GradientsParams,
    /// The sum of its squares, where somebody asks for it.
    squares: Option<f32>,
    /// The bits of its greatest magnitude. Those of infinity are above those of all numbers and those of NaN above them, and
    /// integers are compared many at a time.
    greatest: u32,
}

impl ModuleVisitor for Size<'_> {
    fn visit_float<const D: usize>(&mut self, param: &Param<Tensor<D>>) {
        let Some(grad) = self.grads.get::<D>(param.id) else { return };
        let grad = grad.into_data();
        let grad: &[f32] = grad.as_slice().expect("our tensors are f32");
        self.greatest = grad.iter().fold(self.greatest, |most, g| most.max(g.abs().to_bits()));
        if let Some(squares) = &mut self.squares {
            *squares += grad.iter().map(|g| g * g).sum::<f32>();
        }
    }
}

struct Update<'a> {
    moments: &'a mut Vec<(Vec<f32>, Vec<f32>)>,
    index: usize,
    grads: GradientsParams,
    scale: f32,
    decay: f32,
    rate: f32,
    epsilon: f32,
}

impl ModuleMapper for Update<'_> {
    fn map_float<const D: usize>(&mut self, param: Param<Tensor<D>>) -> Param<Tensor<D>> {
        let Some(grad) = self.grads.remove::<D>(param.id) else {
            self.index += 1;
            return param;
        };
        let grad = grad.into_data();
        let grad: &[f32] = grad.as_slice().expect("our tensors are f32");
        if self.moments.len() <= self.index {
            self.moments.resize_with(self.index + 1, Default::default);
        }
        let (first, second) = &mut self.moments[self.index];
        first.resize(grad.len(), 0.0);
        second.resize(grad.len(), 0.0);
        self.index += 1;
        let Self { scale, decay, rate, epsilon, .. } = *self;
        super::edit(param, |values| {
            for (((p, g), m), v) in values.iter_mut().zip(grad).zip(first).zip(second) {
                let g = g * scale + decay * *p;
                let mean = BETA1 * *m + (1.0 - BETA1) * g;
                let square = BETA2 * *v + (1.0 - BETA2) * g * g;
                *m = if mean.abs() < NOTHING { 0.0 } else { mean };
                *v = if square < NOTHING { 0.0 } else { square };
                *p -= rate * *m / (v.sqrt() + epsilon);
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nets::{Backend, init, values};
    use burn::nn::Linear;
    use burn::tensor::Device;

    #[derive(Module, Debug, Default)]
    struct One {
        layers: Vec<Linear>,
    }

    /// A weight of 1 and a bias of 2, with these gradients.
    fn module(device: &Device) -> One {
        One { layers: vec![init::layer(vec![1.0], vec![2.0], device)] }
    }

    fn gradients(module: &One, weight: f32, bias: f32, device: &Device) -> GradientsParams {
        let mut grads = GradientsParams::new();
        let layer = &module.layers[0];
        grads.register(layer.weight.id, Tensor::<2>::from_data([[weight]], device));
        grads.register(layer.bias.as_ref().unwrap().id, Tensor::<1>::from_data([bias], device));
        grads
    }

    #[test]
    fn it_steps_as_the_paper_says() {
        let device = Backend::of_tests().plain();
        let (mut one, mut adam) = (module(&device), Adam::default());
        let step = Step { rate: 0.01, decay: 0.1, ..Step::default() };
        let (mut p, mut m, mut v) = ([1.0_f64, 2.0], [0.0; 2], [0.0; 2]);
        for (t, grads) in [[0.5, -3.0], [-0.1, 2.0], [0.0, 1e-4], [7.0, 0.3]].into_iter().enumerate() {
            let given = gradients(&one, grads[0] as f32, grads[1] as f32, &device);
            assert!(adam.step(step, &mut one, given));
            for i in 0..2 {
                let g = grads[i] + 0.1 * p[i];
                m[i] = 0.9 * m[i] + 0.1 * g;
                v[i] = 0.999 * v[i] + 0.001 * g * g;
                let power = t as i32 + 1;
                let (mean, square) =
                    (m[i] / (1.0 - 0.9_f64.powi(power)), v[i] / (1.0 - 0.999_f64.powi(power)));
                p[i] -= 0.01 * mean / (square.sqrt() + 1e-8);
                let ours = f64::from(values(&one)[i][0]);
                assert!((ours - p[i]).abs() < 1e-6, "step {power}: {ours} {}", p[i]);
            }
        }
    }

    #[test]
    fn the_clip_is_one_norm_for_all_and_what_has_no_gradient_stays() {
        let device = Backend::of_tests().plain();
        let (mut one, mut adam) = (module(&device), Adam::default());
        let given = gradients(&one, 3.0, -4.0, &device);
        assert!(adam.step(Step { rate: 0.01, clip: 1.0, ..Step::default() }, &mut one, given));
        let means: Vec<f32> = adam.moments.iter().map(|(mean, _)| mean[0]).collect();
        assert!((means[0] - 0.06).abs() < 1e-6 && (means[1] + 0.08).abs() < 1e-6, "{means:?}");

        let before = values(&one);
        assert!(adam.step(
            Step { rate: 0.01, clip: 1.0, ..Step::default() },
            &mut one,
            GradientsParams::new()
        ));
        assert_eq!(values(&one), before);
    }

    #[test]
    fn a_gradient_that_is_not_finite_changes_nothing() {
        let device = Backend::of_tests().plain();
        for clip in [0.0, 1.0] {
            let step = Step { rate: 0.01, clip, ..Step::default() };
            let (mut one, mut adam) = (module(&device), Adam::default());
            let given = gradients(&one, 3.0, -4.0, &device);
            assert!(adam.step(step, &mut one, given));
            let before = (values(&one), adam.clone());
            for wrong in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e20] {
                let given = gradients(&one, 3.0, wrong, &device);
                assert!(!adam.step(step, &mut one, given));
                assert_eq!((values(&one), adam.clone()), before);
            }
        }
    }
}
