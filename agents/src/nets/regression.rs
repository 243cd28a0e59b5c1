//! Numbers for what is seen: features with a linear layer on top, learned by least squares or not at all.
//!
//! What novelty is measured by: coins (Lobel 2023) and the outputs of a network that nobody trains (Burda 2018).

use std::mem::take;

use burn::module::{Module, ModuleMapper, Param};
use burn::nn::Linear;
use burn::optim::GradientsParams;
use burn::tensor::{Device, Tensor};
use inroads_envs::Rng;

use super::adam::{Adam, Step};
use super::torso::{Torso, TorsoConfig};
use super::{Backend, edit, floats, init, load_values, rows, values};
use crate::encode::Shape;
use crate::{Bag, Checkpoint, Corrupt};

/// A torso and a linear layer.
#[derive(Module, Debug, Default)]
struct Head {
    torso: Torso,
    last: Vec<Linear>,
}

impl Head {
    fn forward(&self, rows: Tensor<2>) -> Tensor<2> {
        let features = self.torso.forward(rows);
        self.last[0].forward(features)
    }
}

/// √6: what makes weights from U(±1/√inputs) weights from U(±√(6/inputs)).
const SPREAD: f32 = 2.449_489_8;

/// Weights whose signals keep their size through rectified layers, and biases of 0 (He 2015, equation 10).
///
/// With the usual weights and biases the outputs of an untrained network are nearly the same everywhere, so as a random
/// function it tells states apart badly. The authors of both papers have orthogonal weights of gain √2 and no biases,
/// which is the same in the mean.
struct KeepSize;

impl ModuleMapper for KeepSize {
    fn map_float<const D: usize>(&mut self, param: Param<Tensor<D>>) -> Param<Tensor<D>> {
        let factor = if D == 1 { 0.0 } else { SPREAD };
        edit(param, |values| values.iter_mut().for_each(|value| *value *= factor))
    }
}

/// A network and the state of its optimiser. Clones learn on independently.
#[derive(Clone, Debug)]
pub(crate) struct Regression {
    net: Head,
    adam: Adam,
    inputs: usize,
    device: Device,
}

impl Regression {
    /// A random function: outputs about as large as inputs.
    pub(crate) fn random(
        shape: Shape,
        outputs: usize,
        torso: &TorsoConfig,
        backend: Backend,
        rng: &mut Rng,
    ) -> Self {
        let device = backend.plain();
        let last = init::by_inputs(torso.features(), outputs, &device, rng);
        let net = Head { torso: Torso::new(shape, torso, &device, rng), last: vec![last] };
        let net = net.map(&mut KeepSize);
        Self { net, adam: Adam::default(), inputs: shape.width(), device }
    }

    /// The same function of what is seen, but for a last layer that makes nearly nothing of it: outputs begin near 0.
    pub(crate) fn quiet(mut self) -> Self {
        let shrink = |layer: Linear| {
            let factor = init::LAST;
            let weight = edit(layer.weight, |values| values.iter_mut().for_each(|value| *value *= factor));
            Linear { weight, bias: layer.bias }
        };
        self.net.last = take(&mut self.net.last).into_iter().map(shrink).collect();
        self
    }

    /// Outputs, a row for each row.
    pub(crate) fn outputs(&self, states: Vec<f32>) -> Vec<f32> {
        floats(self.net.forward(rows(states, self.inputs, &self.device)))
    }

    /// One step down the mean square of the errors: `errors` says of the outputs before the step how far each is above
    /// its target. Whether it was made.
    pub(crate) fn learn(
        &mut self,
        states: Vec<f32>,
        errors: impl FnOnce(&[f32]) -> Vec<f32>,
        step: Step,
    ) -> bool {
        let net = self.net.clone().train();
        let outputs = net.forward(rows(states, self.inputs, &self.device).autodiff());
        let [_, width] = outputs.dims();
        let mut slopes = errors(&floats(outputs.clone().inner()));
        let scale = 2.0 / slopes.len().max(1) as f32;
        slopes.iter_mut().for_each(|slope| *slope *= scale);
        let pull = (outputs * rows(slopes, width, &self.device).autodiff()).sum();
        let grads = GradientsParams::from_grads(pull.backward(), &net);
        drop((pull, net)); // so that the parameters are changed in place
        self.adam.step(step, &mut self.net, grads)
    }
}

impl Checkpoint for Regression {
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

    fn net(shape: Shape) -> Regression {
        let torso = TorsoConfig { embedding: 8, merges: vec![8], hidden: vec![32], ..TorsoConfig::default() };
        Regression::random(shape, 3, &torso, Backend::of_tests(), &mut Seed(4).stream("weights", 0))
    }

    #[test]
    fn it_learns_what_it_is_told_and_a_quiet_one_says_nothing_at_first() {
        for shape in [Shape::Row(8), Shape::Grid { down: 2, across: 2, width: 2 }] {
            let states =
                vec![0.0, 1.0, 0.5, -1.0, 1.0, 0.0, 0.0, 2.0, 1.0, 1.0, -0.5, 0.0, 0.0, 0.3, 1.0, 1.0];
            let targets = [1.0, -1.0, 0.5, 0.0, 1.0, 2.0];
            let mut net = net(shape);
            assert!(net.outputs(states.clone()).iter().any(|x| x.abs() > 0.1));
            net = net.quiet();
            assert!(net.outputs(states.clone()).iter().all(|x| x.abs() < 0.05));
            let errors = |now: &[f32]| now.iter().zip(targets).map(|(x, y)| x - y).collect::<Vec<_>>();
            let step = Step { rate: 0.01, ..Step::default() };
            (0..400).for_each(|_| assert!(net.learn(states.clone(), errors, step)));
            let left = errors(&net.outputs(states));
            assert!(left.iter().all(|error| error.abs() < 0.02), "{left:?}");
        }
    }

    #[test]
    fn a_slope_is_twice_the_mean_error() {
        // Adam's first step is the rate in the direction of the slope: a bias shows its sign.
        let mut net = net(Shape::Row(2)).quiet();
        let made = net.learn(
            vec![0.0, 0.0],
            |now| now.iter().map(|x| x - 1.0).collect(),
            Step { rate: 0.1, ..Step::default() },
        );
        assert!(made);
        for output in net.outputs(vec![0.0, 0.0]) {
            assert!((output - 0.1).abs() < 1e-3, "{output}");
        }
    }
}
