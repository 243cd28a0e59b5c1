//! Coin flip networks: a count that a network learns (CFN, Lobel, Bagaria and Konidaris 2023; thesis 7.2.2.1).
//!
//! At each visit of a state some coins are flipped, and a network learns to foretell them. It cannot; the best that it can
//! say is the mean of all flips at that state, whose square is 1/N in the mean. So the root of the mean square of
//! what it says is 1/√N, without anybody counting, and it generalises as the network does.

mod visits;

use std::sync::Arc;

use inroads_envs::Rng;
use rand::RngExt;
use serde::{Deserialize, Serialize};

use self::visits::Visits;
use super::{Novelty, Shared, check_network, standard::Standard};
use crate::{
    Bag, Checkpoint, Context, Corrupt, Pace, checkpoint, encode,
    experience::{Moment, Seen},
    nets::{Backend, Regression, Step, TorsoConfig},
};

/// Added to the variance of the prior's outputs (the authors' code).
const FLOOR: f32 = 1e-4;

/// Settings of [`Cfn`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CfnConfig {
    /// What makes features of what is seen.
    pub torso: TorsoConfig,
    /// d: coins a visit, 1 to 32; 20 (the authors' code).
    pub coins: u32,
    /// Adam's rate; 1e-3 (our check, `algorithms.md` 4.2, and the authors' ant; they have 1e-4 on grids, with batches of
    /// 1024).
    pub rate: f32,
    /// Visits an update; 128 (the authors 1024, on a GPU).
    pub batch: usize,
    /// Updates a visit, below one an update every few visits; 1 (the authors).
    pub updates_per_visit: f32,
    /// Visits before the first update; 1000 (the authors).
    pub warm_up: usize,
    /// Visits that are kept; 400,000 (the authors, on grids). One that falls out counts no longer.
    pub capacity: usize,
    /// Whether a network that is never trained is added, so that what was never seen looks new (section 4.2 of the paper).
    pub prior: bool,
}

impl Default for CfnConfig {
    fn default() -> Self {
        Self {
            torso: TorsoConfig::default(),
            coins: 20,
            rate: 1e-3,
            batch: 128,
            updates_per_visit: 1.0,
            warm_up: 1000,
            capacity: 400_000,
            prior: true,
        }
    }
}

impl CfnConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        self.torso.check().map_err(|why| format!("torso: {why}"))?;
        if !(1..=32).contains(&self.coins) {
            return Err(format!("coins is {}; flip 1 to 32", self.coins));
        }
        if self.capacity == 0 {
            return Err("capacity is 0; at least one visit must be kept".into());
        }
        check_network(self.rate, self.batch, self.updates_per_visit)
    }

    fn pace(&self) -> Pace {
        Pace { updates_per_step: self.updates_per_visit, warm_up: self.warm_up }
    }
}

/// How new a state is by the coins that were flipped at its visits: about 1/√N, clipped to 1.
///
/// Visits are kept as moments with their coins, never as states, and go when their episode is forgotten. They are
/// replayed by priority, without a correction: what was seldom learned from, and what looks new.
pub struct Cfn<O> {
    config: CfnConfig,
    encoder: Shared<O>,
    learned: Regression,
    prior: Option<Prior>,
    visits: Visits,
    /// Visits ever.
    count: u64,
    /// The newest visits that the prior has not watched yet.
    fresh: usize,
    updates: u64,
}

/// A random function of what is seen, each output of mean 0 and variance 1 over all visits: about 1 where nothing was
/// learned yet, and learned away where something was.
#[derive(Clone, Debug)]
struct Prior {
    net: Regression,
    usual: Standard,
}

impl Prior {
    fn outputs(&self, rows: Vec<f32>) -> Vec<f32> {
        let mut outputs = self.net.outputs(rows);
        self.usual.apply(&mut outputs);
        outputs
    }
}

checkpoint!([] Prior; plain: ; parts: net, usual);

/// A coin as the network learns it: −1 or 1.
fn side(coins: u32, coin: usize) -> f32 {
    if coins >> coin & 1 == 1 { 1.0 } else { -1.0 }
}

impl<O> Cfn<O> {
    /// Somebody who has seen nothing, with weights drawn from `rng`.
    ///
    /// # Panics
    /// When there is a layer of width 0: see [`CfnConfig::check`].
    pub fn new(encoder: Shared<O>, config: &CfnConfig, backend: Backend, rng: &mut Rng) -> Self {
        let outputs = config.coins as usize;
        let mut net = || Regression::random(encoder.shape(), outputs, &config.torso, backend, rng);
        let learned = net().quiet();
        let prior =
            config.prior.then(|| Prior { net: net(), usual: Standard::new(outputs, FLOOR, f32::INFINITY) });
        let visits = Visits::new(config.capacity);
        Self { config: config.clone(), encoder, learned, prior, visits, count: 0, fresh: 0, updates: 0 }
    }

    /// Minibatch updates made so far.
    pub fn updates(&self) -> u64 {
        self.updates
    }

    /// The mean square of each of these rows of outputs: 1/N.
    fn shares(&self, outputs: &[f32]) -> Vec<f32> {
        let coins = self.config.coins as usize;
        outputs.chunks_exact(coins).map(|row| row.iter().map(|x| x * x).sum::<f32>() / coins as f32).collect()
    }

    /// The prior watches the visits that it has not.
    fn watch(&mut self, all: &dyn Seen<O>) {
        let fresh = std::mem::take(&mut self.fresh);
        let Some(prior) = &mut self.prior else { return };
        let seen: Vec<&O> = self.visits.newest(fresh).filter_map(|visit| all.seen(visit.at)).collect();
        if !seen.is_empty() {
            let outputs = prior.net.outputs(encode::rows(&*self.encoder, seen.into_iter()));
            prior.usual.watch(&outputs);
        }
    }

    /// One update on visits drawn by priority.
    fn learn(&mut self, all: &dyn Seen<O>, ctx: &mut Context) {
        let numbers = self.visits.draw(self.config.batch, &mut ctx.learning, |at| all.seen(at).is_some());
        let visits: Vec<_> = numbers.iter().filter_map(|number| self.visits.get(*number)).collect();
        let seen: Vec<&O> = visits.iter().filter_map(|visit| all.seen(visit.at)).collect();
        if seen.is_empty() {
            return;
        }
        let rows = encode::rows(&*self.encoder, seen.into_iter());
        let added = self.prior.as_ref().map(|prior| prior.outputs(rows.clone()));
        let coins = self.config.coins as usize;
        let mut said = Vec::new();
        let step = Step { rate: self.config.rate, ..Step::default() };
        let made = self.learned.learn(
            rows,
            |outputs| {
                said.extend_from_slice(outputs);
                if let Some(added) = &added {
                    said.iter_mut().zip(added).for_each(|(output, prior)| *output += prior);
                }
                let error = |(i, output): (usize, &f32)| output - side(visits[i / coins].coins, i % coins);
                said.iter().enumerate().map(error).collect()
            },
            step,
        );
        if !made {
            ctx.check("gradient of the novelty", f32::NAN);
        }
        let shares = self.shares(&said);
        self.visits.revise(&numbers, &shares);
        self.updates += 1;
    }
}

impl<O> Novelty<O> for Cfn<O> {
    fn bonus(&self, s: &O) -> f32 {
        self.bonuses(&[s])[0]
    }

    fn bonuses(&self, states: &[&O]) -> Vec<f32> {
        if states.is_empty() {
            return Vec::new();
        }
        let rows = encode::rows(&*self.encoder, states.iter().copied());
        let mut outputs = match &self.prior {
            None => vec![0.0; states.len() * self.config.coins as usize],
            Some(prior) => prior.outputs(rows.clone()),
        };
        outputs.iter_mut().zip(self.learned.outputs(rows)).for_each(|(output, learned)| *output += learned);
        self.shares(&outputs).into_iter().map(|share| share.sqrt().min(1.0)).collect()
    }

    fn visit(&mut self, at: Moment, all: &dyn Seen<O>, ctx: &mut Context) {
        if all.seen(at).is_none() {
            return;
        }
        self.visits.forget_before(all.oldest());
        self.visits.push(at, ctx.learning.random());
        self.count += 1;
        self.fresh += 1;
        let pace = self.config.pace();
        let due = pace.due(self.count);
        if due > 0 {
            self.watch(all);
        }
        if self.count >= pace.warm_up as u64 {
            (0..due).for_each(|_| self.learn(all, ctx));
        }
    }
}

impl<O> Clone for Cfn<O> {
    /// All that was learned; it learns on independently.
    fn clone(&self) -> Self {
        Self {
            config: self.config.clone(),
            encoder: Arc::clone(&self.encoder),
            learned: self.learned.clone(),
            prior: self.prior.clone(),
            visits: self.visits.clone(),
            ..*self
        }
    }
}

impl<O> Checkpoint for Cfn<O> {
    fn save(&self, bag: &mut Bag) {
        bag.put_part("learned", &self.learned);
        if let Some(prior) = &self.prior {
            bag.put_part("prior", prior);
        }
        bag.put("visits", &self.visits);
        bag.put("count", &(self.count, self.fresh, self.updates));
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        bag.get_part("learned", &mut self.learned)?;
        if let Some(prior) = &mut self.prior {
            bag.get_part("prior", prior)?;
        }
        self.visits = bag.get("visits")?;
        (self.count, self.fresh, self.updates) = bag.get("count")?;
        Ok(())
    }
}

#[cfg(test)]
mod tests;
