//! Random network distillation: what a network has not learned yet to foretell is new (RND, Burda 2018).
//!
//! One network makes random numbers of what is seen and is never trained; another learns to foretell them. Its error
//! falls with the visits of a state, but by how much is the network's and the optimiser's affair: it is no count.

use std::collections::VecDeque;
use std::sync::Arc;

use inroads_envs::Rng;
use rand::RngExt;
use serde::{Deserialize, Serialize};

use super::{Novelty, Shared, check_network, standard::Standard};
use crate::{
    Context, Pace, checkpoint, encode,
    experience::{Moment, Seen},
    nets::{Backend, Regression, Step, TorsoConfig},
};

/// Bound of what networks read, in standard deviations (Burda 2018, section 2.4).
const CLIP: f32 = 5.0;

/// Added to the variance of what is seen: what never varied yet has a size all the same (cleanrl's ppo_rnd; Gym).
const FLOOR: f32 = 1e-8;

/// Settings of [`Rnd`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RndConfig {
    /// What makes features of what is seen, in both networks.
    pub torso: TorsoConfig,
    /// Random numbers a state; 64 (the paper 512, on larger pictures with a GPU).
    pub outputs: usize,
    /// Adam's rate; 1e-4 (the paper, and the authors' of CFN).
    pub rate: f32,
    /// Visits an update: those since the last one, and others drawn from all that are kept. With as many as there are
    /// between two updates each visit is learned from once (the paper: a quarter of them once, four times over). 32.
    pub batch: usize,
    /// Updates a visit, below one an update every few visits; 1 (Taiga 2020, as the authors of CFN run it).
    pub updates_per_visit: f32,
    /// Visits before the first update, which only say what usual numbers are; 1000 (the paper: some thousand random
    /// steps).
    pub warm_up: usize,
    /// Visits that are kept.
    pub capacity: usize,
}

impl Default for RndConfig {
    fn default() -> Self {
        Self {
            torso: TorsoConfig::default(),
            outputs: 64,
            rate: 1e-4,
            batch: 32,
            updates_per_visit: 1.0,
            warm_up: 1000,
            capacity: 400_000,
        }
    }
}

impl RndConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        self.torso.check().map_err(|why| format!("torso: {why}"))?;
        for (name, value) in [("outputs", self.outputs), ("capacity", self.capacity)] {
            if value == 0 {
                return Err(format!("{name} is 0; it must be at least 1"));
            }
        }
        check_network(self.rate, self.batch, self.updates_per_visit)
    }
}

/// How new a state is by how badly a network foretells random numbers of it: the mean square of its errors, which has no
/// scale of its own.
///
/// What networks read is brought to mean 0 and deviation 1 number by number, of pictures pixel by pixel (the paper, section
/// 2.4), over all visits: without it a random network hears only what is loud.
pub struct Rnd<O> {
    config: RndConfig,
    encoder: Shared<O>,
    usual: Standard,
    target: Regression,
    predictor: Regression,
    visits: VecDeque<Moment>,
    /// Visits ever.
    count: u64,
    /// The newest visits that nothing was learned from yet.
    fresh: usize,
    updates: u64,
}

checkpoint!([O] Rnd<O>; plain: visits, count, fresh, updates; parts: usual, target, predictor);

impl<O> Rnd<O> {
    /// Somebody who has seen nothing, with weights drawn from `rng`.
    ///
    /// # Panics
    /// When there is a layer of width 0: see [`RndConfig::check`].
    pub fn new(encoder: Shared<O>, config: &RndConfig, backend: Backend, rng: &mut Rng) -> Self {
        let mut net = || Regression::random(encoder.shape(), config.outputs, &config.torso, backend, rng);
        let (target, predictor) = (net(), net());
        let usual = Standard::new(encoder.width(), FLOOR, CLIP);
        let (config, visits) = (config.clone(), VecDeque::new());
        Self { config, encoder, usual, target, predictor, visits, count: 0, fresh: 0, updates: 0 }
    }

    /// Minibatch updates made so far.
    pub fn updates(&self) -> u64 {
        self.updates
    }

    fn rows(&self, seen: &[&O]) -> Vec<f32> {
        let mut rows = encode::rows(&*self.encoder, seen.iter().copied());
        self.usual.apply(&mut rows);
        rows
    }

    /// The states of the visits that nothing was learned from yet.
    fn fresh<'a>(&self, all: &'a dyn Seen<O>) -> Vec<&'a O> {
        let from = self.visits.len().saturating_sub(self.fresh);
        self.visits.range(from..).filter_map(|at| all.seen(*at)).collect()
    }

    /// One update on these states and others as they come.
    fn learn<'a>(&mut self, mut seen: Vec<&'a O>, all: &'a dyn Seen<O>, ctx: &mut Context) {
        seen.truncate(self.config.batch);
        for _ in seen.len()..self.config.batch {
            let at = self.visits[ctx.learning.random_range(0..self.visits.len())];
            seen.extend(all.seen(at));
        }
        let rows = self.rows(&seen);
        let targets = self.target.outputs(rows.clone());
        let errors = |outputs: &[f32]| outputs.iter().zip(&targets).map(|(x, y)| x - y).collect();
        if !self.predictor.learn(rows, errors, Step { rate: self.config.rate, ..Step::default() }) {
            ctx.check("gradient of the novelty", f32::NAN);
        }
        self.updates += 1;
    }
}

impl<O> Novelty<O> for Rnd<O> {
    fn bonus(&self, s: &O) -> f32 {
        self.bonuses(&[s])[0]
    }

    fn bonuses(&self, states: &[&O]) -> Vec<f32> {
        if states.is_empty() {
            return Vec::new();
        }
        let rows = self.rows(states);
        let (targets, guesses) = (self.target.outputs(rows.clone()), self.predictor.outputs(rows));
        let width = self.config.outputs;
        let error = |(x, y): (&[f32], &[f32])| {
            x.iter().zip(y).map(|(x, y)| (x - y).powi(2)).sum::<f32>() / width as f32
        };
        targets.chunks_exact(width).zip(guesses.chunks_exact(width)).map(error).collect()
    }

    fn visit(&mut self, at: Moment, all: &dyn Seen<O>, ctx: &mut Context) {
        if all.seen(at).is_none() {
            return;
        }
        let oldest = all.oldest();
        let over = |visits: &VecDeque<Moment>| visits.len() >= self.config.capacity;
        while self.visits.front().is_some_and(|first| first.0 < oldest) || over(&self.visits) {
            self.visits.pop_front();
        }
        self.visits.push_back(at);
        self.count += 1;
        self.fresh += 1;
        let pace = Pace { updates_per_step: self.config.updates_per_visit, warm_up: self.config.warm_up };
        let due = pace.due(self.count);
        if due == 0 {
            return;
        }
        let mut fresh = self.fresh(all);
        self.fresh = 0;
        self.usual.watch(&encode::rows(&*self.encoder, fresh.iter().copied()));
        if self.count >= pace.warm_up as u64 {
            (0..due).for_each(|_| self.learn(std::mem::take(&mut fresh), all, ctx));
        }
    }
}

impl<O> Clone for Rnd<O> {
    /// All that was learned; it learns on independently.
    fn clone(&self) -> Self {
        Self {
            config: self.config.clone(),
            encoder: Arc::clone(&self.encoder),
            usual: self.usual.clone(),
            target: self.target.clone(),
            predictor: self.predictor.clone(),
            visits: self.visits.clone(),
            ..*self
        }
    }
}

#[cfg(test)]
mod tests;
