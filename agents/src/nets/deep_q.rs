//! Values of choices from what is seen and a goal, with a slow target: the networks of the DQN family.

use burn::module::Module;
use burn::optim::GradientsParams;
use burn::tensor::{Device, Tensor};
use inroads_envs::Rng;

use super::adam::{Adam, Step};
use super::dueling::{Dueling, HeadParts, HeadShape};
use super::torso::{Torso, TorsoConfig};
use super::{Backend, floats, load_values, rows, target, values};
use crate::encode::Shape;
use crate::{Bag, Checkpoint, Corrupt};

/// What networks are asked about.
#[derive(Clone, Debug)]
pub(crate) struct Asked {
    /// Rows of what is seen; one row serves all goals.
    pub(crate) states: Vec<f32>,
    /// Rows of goals; empty where none are read.
    pub(crate) goals: Vec<f32>,
    /// Rows of noise, or one row for all; empty for none.
    pub(crate) noise: Vec<f32>,
}

#[derive(Module, Debug, Default)]
struct Body {
    torso: Torso,
    head: Dueling,
}

impl Body {
    fn forward(&self, states: Tensor<2>, goals: Option<Tensor<2>>, noise: Option<Tensor<2>>) -> Tensor<2> {
        self.head.noisy_forward(self.torso.forward(states), goals, noise)
    }
}

/// A network, its target and its optimiser. Clones learn on independently.
#[derive(Clone, Debug)]
pub(crate) struct DeepQ {
    online: Body,
    target: Body,
    adam: Adam,
    inputs: usize,
    goal: usize,
    noise: usize,
    device: Device,
}

impl DeepQ {
    pub(crate) fn new(
        shape: Shape,
        torso: &TorsoConfig,
        head: HeadShape,
        parts: HeadParts,
        backend: Backend,
        rng: &mut Rng,
    ) -> Self {
        let device = backend.plain();
        let torso = Torso::new(shape, torso, &device, rng);
        let online = Body { torso, head: Dueling::with_parts(head, parts, &device, rng) };
        Self {
            noise: online.head.noise_width(),
            target: online.clone(),
            online,
            adam: Adam::default(),
            inputs: shape.width(),
            goal: head.goal,
            device,
        }
    }

    /// Numbers a row of noise has; 0 where there is none.
    pub(crate) fn noise_width(&self) -> usize {
        self.noise
    }

    /// The outputs for all choices, row by row.
    pub(crate) fn outputs(&self, asked: Asked) -> Vec<f32> {
        let [states, goals, noise] = self.tensors(asked);
        floats(self.online.forward(states.expect("somebody is asked about"), goals, noise))
    }

    /// The same of the slow target.
    pub(crate) fn target_outputs(&self, asked: Asked) -> Vec<f32> {
        let [states, goals, noise] = self.tensors(asked);
        floats(self.target.forward(states.expect("somebody is asked about"), goals, noise))
    }

    /// States, goals, noise; none where there are no numbers.
    fn tensors(&self, asked: Asked) -> [Option<Tensor<2>>; 3] {
        let parts = [(asked.states, self.inputs), (asked.goals, self.goal), (asked.noise, self.noise)];
        parts.map(|(numbers, width)| (!numbers.is_empty()).then(|| rows(numbers, width, &self.device)))
    }

    /// One step down a loss, whose derivatives by the outputs `slopes` finds from these; whether it was made.
    pub(crate) fn learn(
        &mut self,
        asked: Asked,
        step: Step,
        slopes: impl FnOnce(&[f32]) -> Vec<f32>,
    ) -> bool {
        let online = self.online.clone().train();
        let [states, goals, noise] = self.tensors(asked).map(|part| part.map(Tensor::autodiff));
        let outputs = online.forward(states.expect("somebody is asked about"), goals, noise);
        let width = outputs.dims()[1];
        let slopes = slopes(&floats(outputs.clone().inner()));
        let loss = (outputs * rows(slopes, width, &self.device).autodiff()).sum();
        let grads = GradientsParams::from_grads(loss.backward(), &online);
        drop((loss, online)); // so that the parameters are changed in place
        self.adam.step(step, &mut self.online, grads)
    }

    /// The target follows by one step of size `tau`.
    pub(crate) fn follow(&mut self, tau: f32) {
        target::follow(&mut self.target, &self.online, tau);
    }
}

impl Checkpoint for DeepQ {
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
