//! Values of choices for who remembers: a torso, a cell, a dueling head that the goal joins, and a slow target of all three
//! (R2D2, Kapturowski 2019).
//!
//! Torso and head are in Burn's graph and the cell between them is not, so that the graph is cut in two. What the cell puts
//! out is a leaf of the head's part; its gradient goes back through time by hand, and what arrives at the torso's features
//! is the slope of that part.

use burn::module::{Module, ModuleVisitor, Param};
use burn::optim::GradientsParams;
use burn::tensor::{Device, Tensor};
use inroads_envs::Rng;

use super::adam::{Adam, Step};
use super::dueling::{Dueling, HeadShape};
use super::lstm::{Lstm, State, Trace};
use super::torso::Torso;
use super::{Backend, TorsoConfig, floats, load_values, rows, values};
use crate::encode::Shape;
use crate::{Bag, Checkpoint, Corrupt};

/// Numbers of what is seen that go through a torso at once: 2 MiB, so that what lies between its layers stays in a
/// processor's cache. An update on 32 sequences of 40 pictures of 64 × 64 × 3 takes two thirds of the time that it takes with
/// all pictures at once.
const CHUNK: usize = 1 << 19;

/// The sizes of a network.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RecurrentShape<'a> {
    pub(crate) seen: Shape,
    pub(crate) torso: &'a TorsoConfig,
    /// Numbers that the cell puts out, and that it keeps.
    pub(crate) memory: usize,
    /// Numbers a goal; 0 where none is read.
    pub(crate) goal: usize,
    /// Width of the head's hidden layer.
    pub(crate) hidden: usize,
    pub(crate) choices: usize,
}

/// Steps of sequences, in the order that [`Lstm`] has them in.
pub(crate) struct Steps<'a> {
    /// How many sequences have each step, falling.
    pub(crate) sizes: &'a [usize],
    /// Writes what is seen at a step.
    pub(crate) write: &'a dyn Fn(usize, &mut [f32]),
    /// The choice before each step.
    pub(crate) previous: &'a [Option<usize>],
}

#[derive(Module, Debug, Default)]
struct Net {
    torso: Torso,
    lstm: Lstm,
    head: Dueling,
}

/// A network, its target and its optimiser. Clones learn on independently.
#[derive(Clone, Debug)]
pub(crate) struct RecurrentNet {
    online: Net,
    target: Net,
    adam: Adam,
    /// Numbers of what is seen, features of them, choices, and numbers a goal.
    seen: usize,
    features: usize,
    choices: usize,
    goal: usize,
    device: Device,
}

/// A pass forth over sequences, with all that the pass back needs.
pub(crate) struct Pass {
    /// The values of all choices at each step.
    pub(crate) online: Vec<f32>,
    /// The target's.
    pub(crate) target: Vec<f32>,
    tracked: Net,
    /// The torso's features, by chunks of steps.
    features: Vec<Tensor<2>>,
    read: Tensor<2>,
    trace: Trace,
    put_out: Tensor<2>,
    values: Tensor<2>,
}

impl RecurrentNet {
    pub(crate) fn new(shape: RecurrentShape<'_>, backend: Backend, rng: &mut Rng) -> Self {
        let RecurrentShape { seen, torso, memory, goal, hidden, choices } = shape;
        let (device, features) = (backend.plain(), torso.features());
        let head = HeadShape { features: memory, goal, hidden, choices };
        let online = Net {
            torso: Torso::new(seen, torso, &device, rng),
            lstm: Lstm::new(features + choices, memory, &device, rng),
            head: Dueling::new(head, &device, rng),
        };
        let (target, adam) = (online.clone(), Adam::default());
        Self { online, target, adam, seen: seen.width(), features, choices, goal, device }
    }

    /// Numbers that a choice's values need of a goal's, as rows.
    fn goals(&self, goals: Vec<f32>) -> Option<Tensor<2>> {
        (self.goal > 0).then(|| rows(goals, self.goal, &self.device))
    }

    /// What the cell reads: features, and which choice was made before.
    fn read(&self, features: &[f32], previous: &[Option<usize>]) -> Tensor<2> {
        let width = self.features + self.choices;
        let mut read = vec![0.0; width * previous.len()];
        let rows_of = read.chunks_exact_mut(width).zip(features.chunks_exact(self.features)).zip(previous);
        for ((row, features), previous) in rows_of {
            row[..self.features].copy_from_slice(features);
            if let Some(choice) = previous {
                row[self.features + choice] = 1.0;
            }
        }
        rows(read, width, &self.device)
    }

    /// What each of several sequences remembers after a step. What it puts out is what [`values`](Self::values) are of.
    pub(crate) fn step(&self, seen: Vec<f32>, previous: &[Option<usize>], state: State) -> State {
        let features = floats(self.online.torso.forward(rows(seen, self.seen, &self.device)));
        let sizes = [previous.len()];
        self.online.lstm.forward(self.read(&features, previous), &sizes, state).end(&sizes)
    }

    /// The values of all choices, a row for each row of what a cell put out and of goals. One row of either stands beside
    /// all rows of the other.
    pub(crate) fn values(&self, put_out: Vec<f32>, memory: usize, goals: Vec<f32>) -> Vec<f32> {
        floats(self.online.head.forward(rows(put_out, memory, &self.device), self.goals(goals)))
    }

    /// What is seen at all steps, in chunks.
    fn chunks(&self, steps: &Steps<'_>, mut each: impl FnMut(Tensor<2>)) {
        let (all, most) = (steps.previous.len(), (CHUNK / self.seen.max(1)).max(1));
        for first in (0..all).step_by(most) {
            let mut seen = vec![0.0; most.min(all - first) * self.seen];
            let rows_of = seen.chunks_exact_mut(self.seen.max(1)).zip(first..);
            rows_of.for_each(|(row, step)| (steps.write)(step, row));
            each(rows(seen, self.seen, &self.device));
        }
    }

    /// What the network and its target each remember after some steps, without a gradient (burn-in).
    pub(crate) fn led(&self, steps: &Steps<'_>, start: State) -> [State; 2] {
        let nets = [&self.online, &self.target];
        let mut features = [Vec::new(), Vec::new()];
        self.chunks(steps, |seen| {
            for (features, net) in features.iter_mut().zip(nets) {
                features.extend(floats(net.torso.forward(seen.clone())));
            }
        });
        [0, 1].map(|i| {
            let read = self.read(&features[i], steps.previous);
            nets[i].lstm.forward(read, steps.sizes, start.clone()).end(steps.sizes)
        })
    }

    /// The values at all steps of sequences, the network's and the target's, which begin with what each of them remembers.
    pub(crate) fn forth(&self, steps: &Steps<'_>, starts: [State; 2], goals: Vec<f32>) -> Pass {
        let [start, target_start] = starts;
        let memory = start.hidden.len() / steps.sizes.first().copied().unwrap_or(1);
        let tracked = self.online.clone().train();
        let (mut kept, mut features, mut target_features) = (Vec::new(), Vec::new(), Vec::new());
        self.chunks(steps, |seen| {
            target_features.extend(floats(self.target.torso.forward(seen.clone())));
            let found = tracked.torso.forward(seen.autodiff());
            features.extend(floats(found.clone().inner()));
            kept.push(found);
        });
        let goals = self.goals(goals);
        let read = self.read(&target_features, steps.previous);
        let trace = self.target.lstm.forward(read, steps.sizes, target_start);
        let target = self.target.head.forward(rows(trace.hidden, memory, &self.device), goals.clone());

        let read = self.read(&features, steps.previous);
        let trace = self.online.lstm.forward(read.clone(), steps.sizes, start);
        let put_out = rows(trace.hidden.clone(), memory, &self.device).autodiff().require_grad();
        let values = tracked.head.forward(put_out.clone(), goals.map(Tensor::autodiff));
        let (online, target) = (floats(values.clone().inner()), floats(target));
        Pass { online, target, tracked, features: kept, read, trace, put_out, values }
    }

    /// One step down these derivatives of a loss by the values of a pass; whether it was made.
    pub(crate) fn back(&mut self, pass: Pass, sizes: &[usize], slopes: Vec<f32>, step: Step) -> bool {
        let grads = self.gradients(pass, sizes, slopes);
        self.adam.step(step, &mut self.online, grads)
    }

    /// The derivatives by all weights.
    fn gradients(&self, pass: Pass, sizes: &[usize], slopes: Vec<f32>) -> GradientsParams {
        let Pass { tracked, features, read, trace, put_out, values, .. } = pass;
        let loss = (values * rows(slopes, self.choices, &self.device).autodiff()).sum();
        let mut grads = loss.backward();
        let slopes = put_out.grad_remove(&mut grads).expect("the head reads what is put out");
        let head = GradientsParams::from_grads(grads, &tracked.head);

        let slopes = self.online.lstm.backward(trace, read, sizes, &floats(slopes));
        let mut first = 0;
        let surrogates = features.into_iter().map(|features| {
            let n = features.dims()[0];
            let slopes = slopes.read.clone().slice([first..first + n, 0..self.features]);
            first += n;
            (features * slopes.autodiff()).sum()
        });
        let loss = surrogates.reduce(|sum, more| sum + more).expect("there are steps");
        let mut grads = GradientsParams::from_grads(loss.backward(), &tracked.torso);
        tracked.head.visit(&mut Moved { from: head, to: &mut grads });
        self.online.lstm.register(slopes, &mut grads);
        grads
    }

    /// The target becomes what the network is.
    pub(crate) fn catch_up(&mut self) {
        self.target = self.online.clone();
    }
}

/// Puts one module's gradients to another's.
struct Moved<'a> {
    from: GradientsParams,
    to: &'a mut GradientsParams,
}

impl ModuleVisitor for Moved<'_> {
    fn visit_float<const D: usize>(&mut self, param: &Param<Tensor<D>>) {
        if let Some(grad) = self.from.remove::<D>(param.id) {
            self.to.register(param.id, grad);
        }
    }
}

impl Checkpoint for RecurrentNet {
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
mod tests;
