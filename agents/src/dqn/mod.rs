//! Deep Q-learning: values of choices, learned from what is remembered.
//!
//! [`Dqn`] is the family (Mnih 2015): double, dueling, distributional and noisy networks as settings; returns of several
//! steps and priorities belong to the [`Replay`](crate::Replay). All of them together are Rainbow (Hessel 2018).
//! [`GrowingDqn`] is the policy over options of thesis 3.1.2, whose choices grow in number.

mod atoms;
mod config;
mod growing;
mod loss;

pub use atoms::AtomsConfig;
pub use config::{DqnConfig, Epsilon};
pub use growing::{GrowingConfig, GrowingDqn, Sample};
pub use loss::Loss;

use std::iter;
use std::sync::Arc;

use inroads_envs::Rng;
use rand::RngExt;

use self::atoms::Returns;
use crate::draw::{argmax, greatest};
use crate::encode;
use crate::nets::{Asked, Backend, DeepQ, HeadParts, HeadShape, Step, head_noise};
use crate::{Clip, Context, Encode, Encoder, Lane, Learned, Learner, Memory, checkpoint};

/// A policy over a number of choices, learned off-policy: an encoder, a torso for what it makes (vectors or pictures), and
/// a head that reads the goal too.
///
/// The task itself is read as a goal of zeros, so one learner has the task and all goals.
pub struct Dqn<O> {
    encoder: Arc<dyn Encoder<O> + Send + Sync>,
    goal_width: usize,
    actions: usize,
    config: DqnConfig,
    returns: Returns,
    nets: DeepQ,
    updates: u64,
}

impl<O> Dqn<O> {
    /// A learner without goals for that many choices, with weights drawn from `rng`.
    ///
    /// # Panics
    /// When there is a layer of width 0: see [`DqnConfig::check`].
    pub fn new(
        encoder: Arc<dyn Encoder<O> + Send + Sync>,
        actions: usize,
        config: &DqnConfig,
        backend: Backend,
        rng: &mut Rng,
    ) -> Self {
        Self::with_goals(encoder, 0, actions, config, backend, rng)
    }

    /// A learner that reads goals of `goal_width` numbers ([`Encode::width`]) behind the torso: all goals' values at one
    /// state cost one pass of that.
    ///
    /// # Panics
    /// As [`new`](Self::new).
    pub fn with_goals(
        encoder: Arc<dyn Encoder<O> + Send + Sync>,
        goal_width: usize,
        actions: usize,
        config: &DqnConfig,
        backend: Backend,
        rng: &mut Rng,
    ) -> Self {
        let returns = Returns::new(&config.atoms);
        let head = HeadShape {
            features: config.torso.features(),
            goal: goal_width,
            hidden: config.head,
            choices: actions,
        };
        let parts = HeadParts { split: config.dueling, atoms: returns.outputs(), noise: config.noise };
        let nets = DeepQ::new(encoder.shape(), &config.torso, head, parts, backend, rng);
        Self { encoder, goal_width, actions, config: config.clone(), returns, nets, updates: 0 }
    }

    /// Minibatch updates made so far.
    pub fn updates(&self) -> u64 {
        self.updates
    }

    /// The value of every choice at `s` on the way to a goal, without noise.
    pub fn action_values<G: Encode>(&self, s: &O, goal: Option<&G>) -> Vec<f32> {
        let asked = self.asked(iter::once(s), iter::once(goal), Vec::new());
        self.returns.values(&self.nets.outputs(asked))
    }

    /// What networks read of states and goals.
    fn asked<'a, G: Encode + 'a>(
        &self,
        seen: impl ExactSizeIterator<Item = &'a O>,
        goals: impl ExactSizeIterator<Item = Option<&'a G>>,
        noise: Vec<f32>,
    ) -> Asked
    where
        O: 'a,
    {
        Asked {
            states: encode::rows(&*self.encoder, seen),
            goals: encode::goal_rows(self.goal_width, goals),
            noise,
        }
    }

    /// The choices of greatest value, one of each of these lanes.
    fn greedy<G: Encode>(&self, lanes: &mut [&mut Lane<'_, O, G>]) -> Vec<usize> {
        if lanes.is_empty() {
            return Vec::new();
        }
        let mut noise = Vec::new();
        for lane in lanes.iter_mut() {
            let width = self.nets.noise_width();
            // Who does not explore has none.
            noise.extend(if lane.ctx.explore {
                head_noise(width, &mut lane.ctx.acting)
            } else {
                vec![0.0; width]
            });
        }
        let asked = self.asked(lanes.iter().map(|lane| lane.s), lanes.iter().map(|lane| lane.goal), noise);
        let values = self.returns.values(&self.nets.outputs(asked));
        let rows = values.chunks_exact(self.actions);
        lanes.iter_mut().zip(rows).map(|(lane, row)| argmax(row, &mut lane.ctx.acting)).collect()
    }

    /// The distributions of return that clips were found to lead to: a row of atoms each, or one number where there are
    /// none.
    fn targets<G: Encode>(&self, clips: &[Clip<O, usize, G>], ctx: &mut Context) -> Vec<f32> {
        let width = self.nets.noise_width();
        let mut asked = || {
            let noise = head_noise(width, &mut ctx.learning);
            self.asked(clips.iter().map(Clip::last), clips.iter().map(|clip| clip.goal), noise)
        };
        let target = self.nets.target_outputs(asked());
        let judge = if self.config.double {
            self.returns.values(&self.nets.outputs(asked()))
        } else {
            self.returns.values(&target)
        };
        let row = self.returns.outputs();
        let mut targets = Vec::with_capacity(clips.len() * row);
        for (i, clip) in clips.iter().enumerate() {
            let best = argmax(&judge[i * self.actions..][..self.actions], &mut ctx.learning);
            let next = &target[(i * self.actions + best) * row..][..row];
            let (sum, discount) = clip.discounted(self.config.discount);
            self.returns.backed_up(sum, discount, next, &mut targets);
        }
        targets
    }
}

impl<O, G: Encode> Learner<O, usize, G> for Dqn<O> {
    fn act(&self, memory: &mut Memory, s: &O, goal: Option<&G>, ctx: &mut Context) -> usize {
        self.act_all(&mut [Lane { memory, s, goal, ctx }])[0]
    }

    fn act_all(&self, lanes: &mut [Lane<'_, O, G>]) -> Vec<usize> {
        let epsilon = self.config.epsilon.at(self.updates);
        let mut chosen = vec![None; lanes.len()];
        let mut rest = Vec::with_capacity(lanes.len());
        for (lane, chosen) in lanes.iter_mut().zip(&mut chosen) {
            if lane.ctx.explore && epsilon > 0.0 && lane.ctx.acting.random::<f32>() < epsilon {
                *chosen = Some(lane.ctx.acting.random_range(0..self.actions));
            } else {
                rest.push(lane);
            }
        }
        let mut greedy = self.greedy(&mut rest).into_iter();
        chosen.into_iter().filter_map(|chosen| chosen.or_else(|| greedy.next())).collect()
    }

    fn values(&self, _: &Memory, s: &O, goals: &[Option<&G>]) -> Vec<f32> {
        if goals.is_empty() {
            return Vec::new();
        }
        let outputs = self.nets.outputs(self.asked(iter::once(s), goals.iter().copied(), Vec::new()));
        let best: Vec<_> = self.returns.values(&outputs).chunks_exact(self.actions).map(greatest).collect();
        // Who reads no goals has one answer to all of them.
        if best.len() < goals.len() { vec![best[0]; goals.len()] } else { best }
    }

    fn learn(&mut self, clips: &[Clip<O, usize, G>], ctx: &mut Context) -> Learned {
        if clips.is_empty() {
            return Learned::default();
        }
        let targets = self.targets(clips, ctx);
        let noise = head_noise(self.nets.noise_width(), &mut ctx.learning);
        let asked = self.asked(clips.iter().map(Clip::first), clips.iter().map(|clip| clip.goal), noise);
        let Self { actions, config, returns, nets, .. } = self;
        let row = returns.outputs();
        let mut learned = Learned { loss: 0.0, errors: Vec::with_capacity(clips.len()) };
        let step = Step {
            rate: config.rate,
            clip: config.gradient_clip,
            epsilon: config.adam_epsilon,
            ..Step::default()
        };
        let made = nets.learn(asked, step, |outputs| {
            // The loss's derivative by each output: 0 for the choices that were not made.
            let mut slopes = vec![0.0; outputs.len()];
            for (i, (clip, target)) in clips.iter().zip(targets.chunks_exact(row)).enumerate() {
                let at = (i * *actions + clip.actions[clip.lead]) * row;
                let share = clip.weight / clips.len() as f32;
                let (loss, error) =
                    returns.compare(&outputs[at..at + row], target, config.loss, &mut slopes[at..at + row]);
                slopes[at..at + row].iter_mut().for_each(|slope| *slope *= share);
                learned.loss += share * loss;
                learned.errors.push(error);
            }
            slopes
        });
        if !made {
            ctx.check("gradient of the values", f32::NAN);
        }
        self.updates += 1;
        if self.updates.is_multiple_of(self.config.follow_every) {
            self.nets.follow(self.config.tau);
        }
        learned
    }

    fn batch(&self) -> usize {
        self.config.batch
    }
}

impl<O> Clone for Dqn<O> {
    /// All that was learned, the optimiser included; it learns on independently.
    fn clone(&self) -> Self {
        Self {
            encoder: Arc::clone(&self.encoder),
            goal_width: self.goal_width,
            actions: self.actions,
            config: self.config.clone(),
            returns: self.returns.clone(),
            nets: self.nets.clone(),
            updates: self.updates,
        }
    }
}

checkpoint!([O] Dqn<O>; plain: updates; parts: nets);

#[cfg(test)]
mod tests;
