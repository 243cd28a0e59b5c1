//! R2D2 (Kapturowski 2019): Q-learning from sequences by somebody who remembers. The learner of policies from frames in
//! chapters 7 and 9 of the thesis.
//!
//! ```text
//! what is seen ─ torso ─┐                     goal ─┐
//!     previous choice ──┴─ LSTM ── what it puts out ┴─ dueling head ─ values of choices
//! ```
//!
//! The goal joins *behind* the cell (the authors' code). So a memory knows of no goal: steps can be learned from for another
//! one in hindsight, and the state noted where a sequence begins is still what the cell would have remembered. And all goals'
//! values at a state cost one pass of torso and cell.
//!
//! The paper's cell also reads the previous reward. Ours does not, on purpose: relabelled for another goal the same steps pay
//! differently, and every noted state would be wrong.
//!
//! Sequences come from [`Replay::sequences`](crate::Replay::sequences) and may differ in length; there is no padding, so none
//! can be learned from. The first [`lead`](crate::Clip::lead) steps of each only bring the memory up to date, in the network
//! and in its target, without loss or gradient (burn-in; none by default, `decisions.md`).

mod config;
mod exploration;
mod packing;
mod remembered;
mod targets;

pub use config::R2d2Config;
pub use exploration::ladder;

use std::sync::Arc;

use inroads_envs::Rng;
use rand::RngExt;

use self::exploration::epsilon;
use self::packing::Packing;
use self::remembered::Remembered;
use self::targets::{Returns, Scale, double, priority, targets};
use crate::draw::{argmax, greatest};
use crate::encode::{goal_rows, rows};
use crate::nets::{Backend, RecurrentNet, RecurrentShape, State, Step, Steps};
use crate::{Clip, Context, Encode, Encoder, Lane, Learned, Learner, Memory};

/// Values of choices, for the task and for goals, learned from sequences of steps.
///
/// What it remembers in an episode is in the caller's [`Memory`]: what the cell put out and keeps, the previous choice, and
/// the rung of the exploration's ladder. An empty memory is the beginning of an episode.
pub struct R2d2<O> {
    encoder: Arc<dyn Encoder<O> + Send + Sync>,
    goal_width: usize,
    choices: usize,
    config: R2d2Config,
    nets: RecurrentNet,
    updates: u64,
}

impl<O> R2d2<O> {
    /// A learner for that many choices, with weights drawn from `rng`.
    ///
    /// # Panics
    /// When the settings make no network: see [`R2d2Config::check`].
    pub fn new(
        encoder: Arc<dyn Encoder<O> + Send + Sync>,
        choices: usize,
        config: &R2d2Config,
        backend: Backend,
        rng: &mut Rng,
    ) -> Self {
        Self::with_goals(encoder, 0, choices, config, backend, rng)
    }

    /// A learner that reads goals of `goal_width` numbers ([`Encode::width`]).
    ///
    /// # Panics
    /// As [`new`](Self::new).
    pub fn with_goals(
        encoder: Arc<dyn Encoder<O> + Send + Sync>,
        goal_width: usize,
        choices: usize,
        config: &R2d2Config,
        backend: Backend,
        rng: &mut Rng,
    ) -> Self {
        let shape = RecurrentShape {
            seen: encoder.shape(),
            torso: &config.torso,
            memory: config.memory,
            goal: goal_width,
            hidden: config.head,
            choices,
        };
        let nets = RecurrentNet::new(shape, backend, rng);
        Self { encoder, goal_width, choices, config: config.clone(), nets, updates: 0 }
    }

    /// Minibatch updates made so far.
    pub fn updates(&self) -> u64 {
        self.updates
    }

    /// What these memories hold, as the network reads it.
    fn state<'a>(&self, memories: impl Iterator<Item = &'a [f32]>) -> State {
        let (mut hidden, mut cell) = (Vec::new(), Vec::new());
        for memory in memories {
            let end = hidden.len() + self.config.memory;
            if let Some(remembered) = Remembered::read(memory, self.config.memory) {
                hidden.extend_from_slice(remembered.hidden);
                cell.extend_from_slice(remembered.cell);
            }
            hidden.resize(end, 0.0);
            cell.resize(end, 0.0);
        }
        State { hidden, cell }
    }

    /// The rows of a state in another order.
    fn picked(&self, state: &State, order: impl Iterator<Item = usize> + Clone) -> State {
        let width = self.config.memory;
        let pick = |values: &[f32]| -> Vec<f32> {
            order.clone().flat_map(|i| &values[i * width..(i + 1) * width]).copied().collect()
        };
        State { hidden: pick(&state.hidden), cell: pick(&state.cell) }
    }

    /// What network and target each remember where each clip's steps begin that are learned from.
    fn starts<G>(&self, clips: &[Clip<O, usize, G>]) -> [State; 2] {
        let noted = self.state(clips.iter().map(|clip| clip.memory));
        let packing = Packing::new(&clips.iter().map(|clip| clip.lead).collect::<Vec<_>>());
        if packing.sizes.is_empty() {
            return [noted.clone(), noted];
        }
        let steps = packing.rows();
        let write = |row: usize, out: &mut [f32]| {
            let (clip, step) = steps[row];
            self.encoder.write(&clips[clip].observations[step], out);
        };
        let previous: Vec<_> = steps.iter().map(|(clip, step)| before(&clips[*clip], *step)).collect();
        let steps = Steps { sizes: &packing.sizes, write: &write, previous: &previous };
        let led = self.nets.led(&steps, self.picked(&noted, packing.order.iter().copied()));
        let place = |clip| packing.order.iter().position(|i| *i == clip).expect("the order has all clips");
        led.map(|state| self.picked(&state, (0..clips.len()).map(place)))
    }
}

/// The choice before a step of a clip.
fn before<O, G>(clip: &Clip<O, usize, G>, step: usize) -> Option<usize> {
    step.checked_sub(1).map_or(clip.previous, |step| Some(&clip.actions[step])).copied()
}

impl<O, G: Encode> Learner<O, usize, G> for R2d2<O> {
    fn act(&self, memory: &mut Memory, s: &O, goal: Option<&G>, ctx: &mut Context) -> usize {
        self.act_all(&mut [Lane { memory, s, goal, ctx }])[0]
    }

    fn act_all(&self, lanes: &mut [Lane<'_, O, G>]) -> Vec<usize> {
        if lanes.is_empty() {
            return Vec::new();
        }
        let width = self.config.memory;
        let state = self.state(lanes.iter().map(|lane| &lane.memory[..]));
        let previous = |lane: &Lane<'_, O, G>| Remembered::read(lane.memory, width).map(|found| found.choice);
        let previous: Vec<_> = lanes.iter().map(previous).collect();
        let state = self.nets.step(rows(&*self.encoder, lanes.iter().map(|lane| lane.s)), &previous, state);
        let goals = goal_rows(self.goal_width, lanes.iter().map(|lane| lane.goal));
        let values = self.nets.values(state.hidden.clone(), width, goals);

        let states = state.hidden.chunks_exact(width).zip(state.cell.chunks_exact(width));
        let acting = lanes.iter_mut().zip(values.chunks_exact(self.choices)).zip(states);
        let acted = acting.map(|((lane, values), (hidden, cell))| {
            let ctx = &mut *lane.ctx;
            let rung = match (Remembered::read(lane.memory, width), self.config.rungs) {
                (Some(remembered), _) => remembered.rung,
                (None, 0) => 0,
                (None, rungs) => ctx.acting.random_range(0..rungs),
            };
            // Drawn behind the pass: the memory goes on whoever chooses.
            let random = ctx.explore && ctx.acting.random::<f32>() < self.epsilon(rung);
            let choice = match random {
                true => ctx.acting.random_range(0..self.choices),
                false => argmax(values, &mut ctx.acting),
            };
            Remembered { hidden, cell, choice, rung }.write(lane.memory);
            choice
        });
        acted.collect()
    }

    fn values(&self, memory: &Memory, s: &O, goals: &[Option<&G>]) -> Vec<f32> {
        if goals.is_empty() {
            return Vec::new();
        }
        let width = self.config.memory;
        let previous = Remembered::read(memory, width).map(|remembered| remembered.choice);
        let state = self.state(std::iter::once(&memory[..]));
        let state = self.nets.step(rows(&*self.encoder, std::iter::once(s)), &[previous], state);
        let read = goal_rows(self.goal_width, goals.iter().copied());
        let values = self.nets.values(state.hidden, width, read);
        let scale = self.scale();
        let worth = |values: &[f32]| scale.unscaled(f64::from(greatest(values))) as f32;
        // One row, where no goal is read.
        values.chunks_exact(self.choices).map(worth).cycle().take(goals.len()).collect()
    }

    fn learn(&mut self, clips: &[Clip<O, usize, G>], ctx: &mut Context) -> Learned {
        if clips.is_empty() {
            return Learned::default();
        }
        let packing = Packing::new(&clips.iter().map(|clip| clip.len() + 1).collect::<Vec<_>>());
        let rows = packing.rows();
        let write = |row: usize, out: &mut [f32]| {
            let (clip, step) = rows[row];
            self.encoder.write(&clips[clip].observations[clips[clip].lead + step], out);
        };
        let previous: Vec<_> =
            rows.iter().map(|(clip, step)| before(&clips[*clip], clips[*clip].lead + step)).collect();
        let starts = self.starts(clips).map(|state| self.picked(&state, packing.order.iter().copied()));
        let goals = goal_rows(self.goal_width, rows.iter().map(|(clip, _)| clips[*clip].goal));
        let steps = Steps { sizes: &packing.sizes, write: &write, previous: &previous };
        let pass = self.nets.forth(&steps, starts, goals);

        let choices = self.choices;
        let at = |row: usize| row * choices..(row + 1) * choices;
        let mut slopes = vec![0.0; pass.online.len()];
        let (mut loss, mut errors) = (0.0, vec![0.0; clips.len()]);
        for (place, &i) in packing.order.iter().enumerate() {
            let clip = &clips[i];
            let rewards: Vec<f32> = (0..clip.len()).map(|step| clip.reward(step)).collect();
            let value = |step: usize| {
                let row = at(packing.row(place, step));
                double(&pass.online[row.clone()], &pass.target[row])
            };
            let weight = clip.weight / clips.len() as f32;
            let mut own = Vec::with_capacity(clip.len());
            for (step, y) in targets(&rewards, clip.terminal, value, self.returns()).iter().enumerate() {
                let chosen = packing.row(place, step) * choices + clip.actions[clip.lead + step];
                let error = pass.online[chosen] - y;
                slopes[chosen] = weight * error;
                loss += 0.5 * weight * error * error;
                own.push(error);
            }
            errors[i] = priority(&own, self.config.greatest_share);
        }
        let R2d2Config { rate, adam_epsilon: epsilon, gradient_clip: clip, .. } = self.config;
        let step = Step { rate, epsilon, clip, ..Step::default() };
        if !self.nets.back(pass, &packing.sizes, slopes, step) {
            ctx.check("gradient of the values", f32::NAN);
        }
        self.updates += 1;
        if self.updates.is_multiple_of(self.config.follow_every) {
            self.nets.catch_up();
        }
        Learned { loss, errors }
    }

    fn batch(&self) -> usize {
        self.config.batch
    }
}

impl<O> R2d2<O> {
    fn epsilon(&self, rung: u32) -> f32 {
        epsilon(self.config.epsilon, self.config.rungs, rung, self.updates)
    }

    fn scale(&self) -> Scale {
        if self.config.rescale { Scale::Rescaled } else { Scale::Plain }
    }

    fn returns(&self) -> Returns {
        let R2d2Config { returns, discount, .. } = self.config;
        Returns { steps: returns as usize, discount: f64::from(discount), scale: self.scale() }
    }
}

impl<O> Clone for R2d2<O> {
    fn clone(&self) -> Self {
        let (encoder, config, nets) = (Arc::clone(&self.encoder), self.config.clone(), self.nets.clone());
        Self { encoder, config, nets, ..*self }
    }
}

crate::checkpoint!([O] R2d2<O>; plain: updates; parts: nets);

#[cfg(test)]
mod tests;
