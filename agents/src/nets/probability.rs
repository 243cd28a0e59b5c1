//! One probability a row, with a slow target: what predicts whether an option will succeed (thesis 5.1.1).

use burn::module::Module;
use burn::optim::GradientsParams;
use burn::tensor::Device;
use burn::tensor::activation::sigmoid;
use inroads_envs::Rng;

use super::adam::{Adam, Step};
use super::mlp::Mlp;
use super::{Backend, floats, init, load_values, rows, target, values};
use crate::{Bag, Checkpoint, Corrupt};

/// Layers of rectified units under a sigmoid, their target and their optimiser. Clones learn on independently.
#[derive(Clone, Debug)]
pub(crate) struct ProbabilityNet {
    online: Mlp,
    target: Mlp,
    adam: Adam,
    inputs: usize,
    device: Device,
}

impl ProbabilityNet {
    /// A network that begins near one half everywhere.
    pub(crate) fn new(inputs: usize, hidden: &[usize], backend: Backend, rng: &mut Rng) -> Self {
        let device = backend.plain();
        let online = Mlp::new(inputs, hidden, 1, init::LAST, &device, rng);
        Self { target: online.clone(), online, adam: Adam::default(), inputs, device }
    }

    /// One probability a row.
    pub(crate) fn values(&self, states: Vec<f32>) -> Vec<f32> {
        floats(sigmoid(self.online.forward(rows(states, self.inputs, &self.device))))
    }

    /// The same of the slow target.
    pub(crate) fn target_values(&self, states: Vec<f32>) -> Vec<f32> {
        floats(sigmoid(self.target.forward(rows(states, self.inputs, &self.device))))
    }

    /// One step towards these targets in [0, 1] down the cross-entropy, in which each row counts what it weighs; its mean
    /// before the step, NaN where it was not made because its gradient was not finite.
    ///
    /// The derivative of the cross-entropy by a logit is p − y: none vanishes while the network is wrong, as those of
    /// the squared error do.
    pub(crate) fn learn(&mut self, states: Vec<f32>, targets: &[f32], weights: &[f32], step: Step) -> f32 {
        let online = self.online.clone().train();
        let logits = online.forward(rows(states, self.inputs, &self.device).autodiff());
        let now = floats(logits.clone().inner());
        let n = targets.len() as f32;
        let (mut slopes, mut loss) = (Vec::with_capacity(targets.len()), 0.0);
        for ((logit, target), weight) in now.iter().zip(targets).zip(weights) {
            let p = (1.0 + (-logit).exp()).recip();
            slopes.push(weight * (p - target) / n);
            // ln(1 + eˣ) − yx, in the form that does not overflow.
            loss += weight * (logit.max(0.0) - target * logit + (-logit.abs()).exp().ln_1p());
        }
        let pull = (logits * rows(slopes, 1, &self.device).autodiff()).sum();
        let grads = GradientsParams::from_grads(pull.backward(), &online);
        drop((pull, online)); // so that the parameters are changed in place
        let made = self.adam.step(step, &mut self.online, grads);
        if made { loss / n } else { f32::NAN }
    }

    /// The target follows by one step of size `tau`.
    pub(crate) fn follow(&mut self, tau: f32) {
        target::follow(&mut self.target, &self.online, tau);
    }
}

impl Checkpoint for ProbabilityNet {
    fn save(&self, bag: &mut Bag) {
        bag.put("online", &values(&self.online));
        bag.put("target", &values(&self.target));
        bag.put("adam", &self.adam);
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        load_values(&mut self.online, "online", bag)?;
        load_values(&mut self.target, "target", bag)?;
        self.adam = bag.get("adam")?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use inroads_envs::Seed;

    fn net(seed: u64) -> ProbabilityNet {
        ProbabilityNet::new(2, &[8], Backend::of_tests(), &mut Seed(seed).stream("weights", 0))
    }

    #[test]
    fn it_learns_soft_targets_and_its_target_lags() {
        let mut net = net(1);
        let rows = vec![0.0, 1.0, 1.0, 0.0];
        let before = net.values(rows.clone());
        assert!(before.iter().all(|p| (p - 0.5).abs() < 0.02), "{before:?}");
        let step = Step { rate: 0.01, ..Step::default() };
        let first = net.learn(rows.clone(), &[0.9, 0.2], &[1.0; 2], step);
        assert!((first - 2_f32.ln()).abs() < 0.02, "half a bit of each is {first}");
        (0..600).for_each(|_| _ = net.learn(rows.clone(), &[0.9, 0.2], &[1.0; 2], step));
        let after = net.values(rows.clone());
        assert!((after[0] - 0.9).abs() < 0.01 && (after[1] - 0.2).abs() < 0.01, "{after:?}");
        assert_eq!(net.target_values(rows.clone()), before);
        net.follow(1.0);
        assert_eq!(net.target_values(rows), after);
    }

    #[test]
    fn equal_seeds_learn_to_the_same_bits_and_checkpoints_go_on_alike() {
        let (mut one, mut two) = (net(2), net(2));
        let step = Step { rate: 0.01, ..Step::default() };
        (0..20).for_each(|_| _ = one.learn(vec![0.3, 0.4], &[1.0], &[1.0], step));
        let mut bag = Bag::default();
        one.save(&mut bag);
        let mut restored = net(3);
        restored.load(&bag).unwrap();
        (0..20).for_each(|_| _ = two.learn(vec![0.3, 0.4], &[1.0], &[1.0], step));
        for net in [&mut one, &mut two, &mut restored] {
            net.learn(vec![0.1, 0.9], &[0.0], &[1.0], step);
        }
        let bits = |net: &ProbabilityNet| net.values(vec![0.5, 0.5])[0].to_bits();
        assert_eq!(bits(&one), bits(&two));
        assert_eq!(bits(&one), bits(&restored));
    }
}
