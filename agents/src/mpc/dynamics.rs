//! A model of the dynamics, learned from steps (Nagabandi 2018; thesis 4.1.3).
//!
//! A network reads a state and an action, standardised, and predicts the standardised change of the state. In which
//! coordinates is a [`View`]'s business. With every fit the statistics are those of all the data, and the weights go on
//! from where they were.

use std::sync::Arc;

use inroads_envs::Rng;
use rand::seq::SliceRandom;
use serde::{Deserialize, Serialize};

use super::{
    Predict, View,
    standard::{Moments, Standard},
};
use crate::{
    Bag, Checkpoint, Corrupt, Experience,
    nets::{Backend, Layers, Regressor, Step},
};

/// Settings of a model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct DynamicsConfig {
    /// Widths of the hidden layers (paper and authors: 500, 500).
    pub hidden: Vec<usize>,
    /// What a hidden unit passes on of what is below zero: 0 is the paper's ReLU, 0.01 the authors' leaky one.
    pub slope: f32,
    /// Adam's rate (paper and authors: 1e-3).
    pub rate: f32,
    /// Rate at the end of a fit's last epoch, as a part of the first.
    pub last_rate: f32,
    /// Steps a minibatch (paper: 512).
    pub batch: usize,
    /// Models that share the candidates among them.
    pub models: usize,
    /// One in so many episodes is not learned from, and tells how good the model is; 0: none.
    pub held_out: u64,
}

impl Default for DynamicsConfig {
    fn default() -> Self {
        Self {
            hidden: vec![200, 200],
            slope: 0.0,
            rate: 1e-3,
            last_rate: 0.05,
            batch: 256,
            models: 1,
            held_out: 10,
        }
    }
}

impl DynamicsConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        if self.hidden.contains(&0) {
            return Err(format!("hidden is {:?}; no layer may have width 0", self.hidden));
        }
        if self.batch == 0 || self.models == 0 {
            return Err("batch or models is 0; at least one is needed of each".into());
        }
        if self.held_out == 1 {
            return Err("held_out is 1, which holds out every episode; take 0 (none) or 2 and more".into());
        }
        if !(self.rate.is_finite() && self.rate > 0.0) {
            return Err(format!("rate is {}; it must be a number above 0", self.rate));
        }
        for (name, value) in [("slope", self.slope), ("last_rate", self.last_rate)] {
            if !(0.0..=1.0).contains(&value) {
                return Err(format!("{name} is {value}; it must lie in [0, 1]"));
            }
        }
        Ok(())
    }
}

/// What a fit came to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Fit {
    /// Steps learned from.
    pub steps: usize,
    /// Mean square error of the last epoch, in standardised changes.
    pub loss: f32,
    /// The same on the episodes held out, where there are any. 1 is what the mean of the changes would come to.
    pub held_out: Option<f32>,
}

/// A model of the dynamics.
pub struct Dynamics {
    view: Arc<dyn View>,
    actions: usize,
    config: DynamicsConfig,
    nets: Vec<Regressor>,
    inputs: Standard,
    changes: Standard,
    /// Of inputs and changes, while the statistics of a model that learns by the way are not settled.
    gathered: [Moments; 2],
}

/// Steps whose statistics settle those of a model that learns by the way. They stay: what a network has learned is in their
/// units.
const SETTLED: u64 = 20_000;

/// What a network reads and what it is to predict, row by row.
#[derive(Default)]
struct Table {
    inputs: Vec<f32>,
    changes: Vec<f32>,
}

impl Dynamics {
    /// A model of states that `view` reads, for actions of so many numbers, with weights drawn from `rng`.
    ///
    /// # Panics
    /// When a hidden layer has width 0 or there are no models: see [`DynamicsConfig::check`].
    pub fn new(
        view: Arc<dyn View>,
        actions: usize,
        config: &DynamicsConfig,
        backend: Backend,
        rng: &mut Rng,
    ) -> Self {
        let (inputs, outputs) = (view.inputs() + actions, view.changes());
        let shape = Layers { inputs, hidden: &config.hidden, outputs, slope: config.slope };
        let nets = (0..config.models).map(|_| Regressor::new(shape, backend, rng)).collect();
        let (inputs, changes) = (Standard::of(&[], inputs), Standard::of(&[], outputs));
        let gathered = [Moments::default(), Moments::default()];
        Self { view, actions, config: config.clone(), nets, inputs, changes, gathered }
    }

    /// One update on these steps, each a state, an action and the next state; the mean square error before it, in
    /// standardised changes. The first 20,000 steps are not learned from (0 is the error then): their means and deviations
    /// become the units of all that follow.
    pub fn learn<'a>(&mut self, steps: impl Iterator<Item = [&'a [f32]; 3]>) -> f32 {
        let mut table = Table::default();
        for [before, action, after] in steps {
            self.view.read(before, &mut table.inputs);
            table.inputs.extend_from_slice(action);
            self.view.change(before, after, &mut table.changes);
        }
        let [inputs, changes] = &mut self.gathered;
        if inputs.rows() < SETTLED {
            inputs.add(&table.inputs, self.inputs.width());
            changes.add(&table.changes, self.changes.width());
            (self.inputs, self.changes) = (inputs.standard(), changes.standard());
            return 0.0;
        }
        self.inputs.standardise(&mut table.inputs);
        self.changes.standardise(&mut table.changes);
        let step = Step { rate: self.config.rate, ..Step::default() };
        let learn = |net: &mut Regressor| net.learn(table.inputs.clone(), table.changes.clone(), step);
        self.nets.iter_mut().map(learn).sum::<f32>() / self.config.models as f32
    }

    /// So many passes over everything that is remembered.
    pub fn fit(&mut self, all: &Experience<Vec<f32>, Vec<f32>>, epochs: usize, rng: &mut Rng) -> Fit {
        let kept = |number: u64| {
            self.config.held_out == 0 || number % self.config.held_out != self.config.held_out - 1
        };
        let mut train = self.table(all, kept);
        let mut rest = self.table(all, |number| !kept(number));
        let steps = train.changes.len() / self.changes.width();
        if steps == 0 {
            return Fit::default();
        }
        self.inputs = Standard::of(&train.inputs, self.inputs.width());
        self.changes = Standard::of(&train.changes, self.changes.width());
        for table in [&mut train, &mut rest] {
            self.inputs.standardise(&mut table.inputs);
            self.changes.standardise(&mut table.changes);
        }
        let loss = (0..self.nets.len()).map(|i| self.fit_one(i, &train, epochs, rng)).sum::<f32>();
        let held_out = (!rest.changes.is_empty()).then(|| {
            let guess = self.predicted(rest.inputs);
            let squares = guess.iter().zip(&rest.changes).map(|(a, b)| f64::from(a - b).powi(2));
            (squares.sum::<f64>() / guess.len() as f64) as f32
        });
        Fit { steps, loss: loss / self.nets.len() as f32, held_out }
    }

    /// Rows of the steps of some episodes.
    fn table(&self, all: &Experience<Vec<f32>, Vec<f32>>, chosen: impl Fn(u64) -> bool) -> Table {
        let mut table = Table::default();
        for episode in all.numbers().filter(|&number| chosen(number)).filter_map(|number| all.episode(number))
        {
            for (pair, action) in episode.observations.windows(2).zip(&episode.actions) {
                self.view.read(&pair[0], &mut table.inputs);
                table.inputs.extend_from_slice(action);
                self.view.change(&pair[0], &pair[1], &mut table.changes);
            }
        }
        table
    }

    /// The mean loss of the last epoch of one network.
    fn fit_one(&mut self, net: usize, table: &Table, epochs: usize, rng: &mut Rng) -> f32 {
        let (inputs, changes) = (self.inputs.width(), self.changes.width());
        let mut order: Vec<usize> = (0..table.changes.len() / changes).collect();
        let batches = order.len().div_ceil(self.config.batch);
        let (mut loss, all) = (0.0, (epochs * batches) as f32);
        for epoch in 0..epochs {
            order.shuffle(rng);
            loss = 0.0;
            for (i, batch) in order.chunks(self.config.batch).enumerate() {
                let rows = |from: &[f32], width: usize| {
                    batch.iter().flat_map(|&row| &from[row * width..(row + 1) * width]).copied().collect()
                };
                // The rate falls linearly, so that a fit ends where the noise of minibatches is small.
                let done = (epoch * batches + i) as f32 / all;
                let rate = self.config.rate * (1.0 + done * (self.config.last_rate - 1.0));
                let step = Step { rate, ..Step::default() };
                loss +=
                    self.nets[net].learn(rows(&table.inputs, inputs), rows(&table.changes, changes), step);
            }
        }
        loss / batches as f32
    }

    /// Standardised changes from standardised inputs. Row number i is predicted by model i modulo their number: a
    /// sequence of actions keeps its model, so that no plan can count on what only one of them believes.
    fn predicted(&self, inputs: Vec<f32>) -> Vec<f32> {
        let models = self.nets.len();
        if models == 1 {
            return self.nets[0].predict(inputs);
        }
        let (width, changes) = (self.inputs.width(), self.changes.width());
        let n = inputs.len() / width;
        let mut out = vec![0.0; n * changes];
        // No product of matrices without rows: not every backend has one.
        for (model, net) in self.nets.iter().enumerate().take(n) {
            let own = || (model..n).step_by(models);
            let rows = own().flat_map(|i| &inputs[i * width..(i + 1) * width]).copied().collect();
            let found = net.predict(rows);
            for (i, row) in own().zip(found.chunks_exact(changes)) {
                out[i * changes..(i + 1) * changes].copy_from_slice(row);
            }
        }
        out
    }
}

impl Predict for Dynamics {
    fn actions(&self) -> usize {
        self.actions
    }

    fn next(&self, states: &[f32], actions: &[f32]) -> Vec<f32> {
        let width = self.view.width();
        let n = states.len() / width;
        let mut inputs = Vec::with_capacity(n * self.inputs.width());
        for (s, action) in states.chunks_exact(width).zip(actions.chunks_exact(self.actions)) {
            self.view.read(s, &mut inputs);
            inputs.extend_from_slice(action);
        }
        self.inputs.standardise(&mut inputs);
        let mut changes = self.predicted(inputs);
        self.changes.restore(&mut changes);
        let mut next = Vec::with_capacity(states.len());
        for (s, change) in states.chunks_exact(width).zip(changes.chunks_exact(self.changes.width())) {
            self.view.apply(s, change, &mut next);
        }
        next
    }
}

impl Checkpoint for Dynamics {
    fn save(&self, bag: &mut Bag) {
        bag.put("inputs", &self.inputs);
        bag.put("changes", &self.changes);
        bag.put("gathered", &self.gathered);
        self.nets.iter().enumerate().for_each(|(i, net)| bag.put_part(&format!("model {i}"), net));
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        self.inputs = bag.get("inputs")?;
        self.changes = bag.get("changes")?;
        self.gathered = bag.get("gathered")?;
        self.nets.iter_mut().enumerate().try_for_each(|(i, net)| bag.get_part(&format!("model {i}"), net))
    }
}
