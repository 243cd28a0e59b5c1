//! TD3 (Fujimoto 2018): DDPG with two critics of which the lesser is believed, with noise in the target's actions, and
//! with an actor and targets that move less often than the critics. The option policies of chapters 4 and 6.
//!
//! All noise is in units of actions, which lie in [−1, 1]. A goal is joined to the observation at the input (TD3+HER).

use std::sync::Arc;

use inroads_envs::Rng;
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};
use serde::{Deserialize, Serialize};

use crate::actor_critic::{batch, check, targets};
use crate::encode::Inputs;
use crate::nets::{ActorCritic, Backend, Shape, Step};
use crate::noise::{NoiseConfig, NoiseKind};
use crate::{Clip, Context, Encode, Encoder, Lane, Learned, Learner, Memory, checkpoint};

/// Settings of [`Td3`]. Defaults are the paper's and those of its authors' code (sfujim/TD3), where nothing else is said.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Td3Config {
    /// Widths of the hidden layers of actor and critics; 256 and 256.
    pub hidden: Vec<usize>,
    /// Adam's rate for the actor; 3e-4.
    pub actor_rate: f32,
    /// Adam's rate for both critics; 3e-4.
    pub critic_rate: f32,
    /// γ; 0.99.
    pub discount: f32,
    /// τ of θ' ← τθ + (1−τ)θ'; 0.005.
    pub tau: f32,
    /// Clips an update; 256.
    pub batch: usize,
    /// Updates of the critics for each of the actor and of all targets; 2.
    pub delay: u32,
    /// Standard deviation of the noise in the target's actions; 0.2.
    pub smoothing: f32,
    /// Greatest size of that noise; 0.5.
    pub smoothing_clip: f32,
    /// Greatest norm of a network's gradient; 0 is no bound (authors' code has none).
    pub gradient_clip: f32,
    /// Price of the square of what enters the actor's last tanh; 0 (authors' code). Above 0 it keeps an actor that has seen
    /// no reward yet from saturating (HER, Andrychowicz 2017, appendix A).
    pub preactivation: f32,
    /// Exploration noise; Gaussian, 0.1 throughout.
    pub noise: NoiseConfig,
    /// Share of actions that are uniform while exploring; 0. HER has 0.3 (Andrychowicz 2017, appendix A).
    pub random: f32,
}

impl Default for Td3Config {
    fn default() -> Self {
        Self {
            hidden: vec![256, 256],
            actor_rate: 3e-4,
            critic_rate: 3e-4,
            discount: 0.99,
            tau: 0.005,
            batch: 256,
            delay: 2,
            smoothing: 0.2,
            smoothing_clip: 0.5,
            gradient_clip: 0.0,
            preactivation: 0.0,
            noise: NoiseConfig { kind: NoiseKind::Gaussian, start: 0.1, end: 0.1, decay_steps: 0 },
            random: 0.0,
        }
    }
}

impl Td3Config {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        check::sizes(&self.hidden, self.batch)?;
        check::positive(&[("actor_rate", self.actor_rate), ("critic_rate", self.critic_rate)])?;
        check::shares(&[("discount", self.discount), ("tau", self.tau), ("random", self.random)])?;
        check::prices(&[
            ("smoothing", self.smoothing),
            ("smoothing_clip", self.smoothing_clip),
            ("gradient_clip", self.gradient_clip),
            ("preactivation", self.preactivation),
        ])?;
        if self.delay == 0 {
            return Err(
                "delay is 0; the actor learns after every so many updates of the critics, at least 1".into(),
            );
        }
        self.noise.check()
    }

    /// Adds the target's noise to its actions, and clips them to [−1, 1].
    fn smooth(&self, actions: &mut [f32], rng: &mut Rng) {
        for action in actions {
            let draw: f32 = StandardNormal.sample(rng);
            let noise = (self.smoothing * draw).clamp(-self.smoothing_clip, self.smoothing_clip);
            *action = (*action + noise).clamp(-1.0, 1.0);
        }
    }
}

/// A deterministic policy for continuous actions in [−1, 1], learned off-policy. Until it has learned for the first time it
/// explores by uniform actions.
///
/// A clone has all that was learned, and learns on independently.
pub struct Td3<O> {
    inputs: Inputs<O>,
    /// Components of an action.
    actions: usize,
    config: Td3Config,
    nets: ActorCritic,
    updates: u64,
}

checkpoint!([O] Td3<O>; plain: updates; parts: nets);

impl<O> Td3<O> {
    /// A learner for actions of that many components that reads goals of `goal_width` numbers
    /// ([`Encode::width`]; 0: it reads none), with weights drawn from `rng`.
    ///
    /// # Panics
    /// When there is no hidden layer, or one of width 0: see [`Td3Config::check`].
    pub fn new(
        encoder: Arc<dyn Encoder<O> + Send + Sync>,
        goal_width: usize,
        actions: usize,
        config: &Td3Config,
        backend: Backend,
        rng: &mut Rng,
    ) -> Self {
        let inputs = Inputs::new(encoder, goal_width);
        let shape = Shape { inputs: inputs.width(), actions, hidden: &config.hidden, critics: 2, alone: 0 };
        let nets = ActorCritic::new(shape, backend, rng);
        Self { inputs, actions, nets, config: config.clone(), updates: 0 }
    }

    /// Minibatch updates of the critics made so far.
    pub fn updates(&self) -> u64 {
        self.updates
    }

    /// Changes an action of the actor's as it explores, if it does.
    fn explore(&self, action: &mut [f32], memory: &mut Memory, ctx: &mut Context) {
        let Td3Config { noise, random, .. } = &self.config;
        if !ctx.explore {
            return;
        }
        if self.updates == 0 || (*random > 0.0 && ctx.acting.random::<f32>() < *random) {
            action.fill_with(|| ctx.acting.random_range(-1.0..=1.0));
        } else {
            noise.perturb(action, memory, self.updates, &mut ctx.acting);
        }
    }

    /// What the clips' first actions turned out to be worth: y = r + γ(1−d) min Q'(s', clip(μ'(s') + noise)).
    fn targets<G: Encode>(&self, clips: &[Clip<O, Vec<f32>, G>], ctx: &mut Context) -> Vec<f32> {
        let after = self.inputs.rows(clips.iter().map(|clip| (clip.last(), clip.goal)));
        let mut actions = self.nets.target_actions(&after);
        self.config.smooth(&mut actions, &mut ctx.learning);
        targets(clips, self.config.discount, &self.nets.target_values(after, actions))
    }
}

impl<O, G: Encode> Learner<O, Vec<f32>, G> for Td3<O> {
    fn act(&self, memory: &mut Memory, s: &O, goal: Option<&G>, ctx: &mut Context) -> Vec<f32> {
        let mut action = self.nets.act(self.inputs.rows(std::iter::once((s, goal))));
        self.explore(&mut action, memory, ctx);
        action
    }

    fn act_all(&self, lanes: &mut [Lane<'_, O, G>]) -> Vec<Vec<f32>> {
        let actions = self.nets.act(self.inputs.rows(lanes.iter().map(|lane| (lane.s, lane.goal))));
        let mut actions: Vec<_> = actions.chunks_exact(self.actions).map(<[f32]>::to_vec).collect();
        for (action, lane) in actions.iter_mut().zip(lanes) {
            self.explore(action, lane.memory, lane.ctx);
        }
        actions
    }

    fn values(&self, _: &Memory, s: &O, goals: &[Option<&G>]) -> Vec<f32> {
        self.nets.values(self.inputs.rows(goals.iter().map(|goal| (s, *goal))))
    }

    fn values_of(&self, states: &[O], goal: Option<&G>) -> Vec<f32> {
        self.nets.values(self.inputs.rows(states.iter().map(|s| (s, goal))))
    }

    /// A clip's error is the greater of the critics' (Fujimoto 2020, LAP), and the loss the sum of theirs.
    fn learn(&mut self, clips: &[Clip<O, Vec<f32>, G>], ctx: &mut Context) -> Learned {
        if clips.is_empty() {
            return Learned::default();
        }
        let batch = batch(&self.inputs, clips, self.targets(clips, ctx));
        let config = &self.config;
        let step = |rate| Step { rate, clip: config.gradient_clip, ..Step::default() };
        let (both, made) = self.nets.learn_critics(&batch, step(config.critic_rate));
        if !made {
            ctx.check("gradient of the critics", f32::NAN);
        }
        self.updates += 1;
        if made && self.updates.is_multiple_of(u64::from(config.delay)) {
            if !self.nets.learn_actor(batch.states, step(config.actor_rate), config.preactivation) {
                ctx.check("gradient of the actor", f32::NAN);
            }
            self.nets.follow(config.tau);
        }
        let (first, second) = both.split_at(clips.len());
        let greater = |(a, b): (&f32, &f32)| if a.abs() >= b.abs() { *a } else { *b };
        Learned {
            loss: both.iter().map(|error| error.powi(2)).sum::<f32>() / clips.len() as f32,
            errors: first.iter().zip(second).map(greater).collect(),
        }
    }

    fn batch(&self) -> usize {
        self.config.batch
    }
}

impl<O> Clone for Td3<O> {
    fn clone(&self) -> Self {
        Self {
            inputs: self.inputs.clone(),
            actions: self.actions,
            config: self.config.clone(),
            nets: self.nets.clone(),
            updates: self.updates,
        }
    }
}

#[cfg(test)]
mod tests;
