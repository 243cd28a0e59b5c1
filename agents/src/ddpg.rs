//! DDPG (Lillicrap 2015): the policy inside every option of chapter 3 (thesis 3.1.1).
//!
//! Learned from clips of one step by y = r + γ(1−d)Q'(s', μ'(s')), where d is a *termination*: truncations
//! and time-outs bootstrap. The authors' actor has batch normalisation, which the thesis does not mention and
//! most later implementations dropped (Fujimoto 2018, CleanRL); ours has none.

use std::sync::Arc;

use inroads_envs::Rng;
use serde::{Deserialize, Serialize};

use crate::actor_critic::{batch, check, targets};
use crate::encode::Inputs;
use crate::nets::{ActorCritic, Backend, Shape, Step};
use crate::noise::NoiseConfig;
use crate::{Clip, Context, Encode, Encoder, Learned, Learner, Memory, checkpoint};

/// Settings of [`Ddpg`]. Defaults are those of the authors' code (`authors.md`, section 1), which are the DDPG
/// paper's but for τ (0.001 there); the decay of the critic is the exception.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct DdpgConfig {
    /// Widths of the hidden layers of actor and critic; 400 and 300 (authors' code, paper section 7).
    pub hidden: Vec<usize>,
    /// Adam's rate for the actor; 1e-4 (authors' code, paper).
    pub actor_rate: f32,
    /// Adam's rate for the critic; 1e-3 (authors' code, paper).
    pub critic_rate: f32,
    /// γ; 0.99 (authors' code, paper).
    pub discount: f32,
    /// τ of θ' ← τθ + (1−τ)θ'; 0.01 (authors' code).
    pub tau: f32,
    /// Clips an update; 64 (authors' code, paper).
    pub batch: usize,
    /// L2 decay of the critic's parameters, added to the gradient. The authors' code and the paper have 1e-2;
    /// 0 here, because within Adam that flattens values: with it the best action of a bandit r = −(a − 0.3)²
    /// is learned as 0.18, whatever the seed and the size of the network.
    pub critic_decay: f32,
    /// Greatest norm of a network's gradient; 0 is no bound (authors' code and paper have none).
    pub gradient_clip: f32,
    /// Price of the square of what enters the actor's last tanh; 0 (authors' code, paper). Above 0 it keeps an actor
    /// that has seen no reward yet from saturating, where its gradient vanishes and noise is clipped away (HER,
    /// Andrychowicz 2017, appendix A).
    pub preactivation: f32,
    /// Exploration noise.
    pub noise: NoiseConfig,
    /// Exploration noise of a [`fork`](Ddpg::fork): what already knows something explores less.
    pub fork_noise: NoiseConfig,
}

impl Default for DdpgConfig {
    fn default() -> Self {
        Self {
            hidden: vec![400, 300],
            actor_rate: 1e-4,
            critic_rate: 1e-3,
            discount: 0.99,
            tau: 0.01,
            batch: 64,
            critic_decay: 0.0,
            gradient_clip: 0.0,
            preactivation: 0.0,
            noise: NoiseConfig::default(),
            fork_noise: NoiseConfig::default(),
        }
    }
}

impl DdpgConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        check::sizes(&self.hidden, self.batch)?;
        check::positive(&[("actor_rate", self.actor_rate), ("critic_rate", self.critic_rate)])?;
        check::shares(&[("discount", self.discount), ("tau", self.tau)])?;
        check::prices(&[
            ("critic_decay", self.critic_decay),
            ("gradient_clip", self.gradient_clip),
            ("preactivation", self.preactivation),
        ])?;
        self.noise.check()?;
        self.fork_noise.check()
    }
}

/// A deterministic policy for continuous actions in [−1, 1], learned off-policy.
///
/// A clone has all that was learned, moments of the optimiser and number of updates included, and learns on
/// independently; a new option begins as a [`fork`](Self::fork) of the global one (thesis 3.1.2).
pub struct Ddpg<O> {
    inputs: Inputs<O>,
    config: DdpgConfig,
    nets: ActorCritic,
    updates: u64,
}

checkpoint!([O] Ddpg<O>; plain: updates; parts: nets);

impl<O> Ddpg<O> {
    /// A learner for actions of that many components, with weights drawn from `rng`.
    ///
    /// # Panics
    /// When there is no hidden layer, or one of width 0: see [`DdpgConfig::check`].
    pub fn new(
        encoder: Arc<dyn Encoder<O> + Send + Sync>,
        actions: usize,
        config: &DdpgConfig,
        backend: Backend,
        rng: &mut Rng,
    ) -> Self {
        Self::with_goals(encoder, 0, actions, config, backend, rng)
    }

    /// A learner that reads goals of `goal_width` numbers ([`Encode::width`]) beside the observation.
    ///
    /// # Panics
    /// As [`new`](Self::new).
    pub fn with_goals(
        encoder: Arc<dyn Encoder<O> + Send + Sync>,
        goal_width: usize,
        actions: usize,
        config: &DdpgConfig,
        backend: Backend,
        rng: &mut Rng,
    ) -> Self {
        let inputs = Inputs::new(encoder, goal_width);
        let hidden = &config.hidden;
        let shape = Shape { inputs: inputs.width(), actions, hidden, critics: 1, alone: 1 };
        let nets = ActorCritic::new(shape, backend, rng);
        Self { inputs, nets, config: config.clone(), updates: 0 }
    }

    /// Minibatch updates made so far.
    pub fn updates(&self) -> u64 {
        self.updates
    }

    /// A clone of what was learned that begins its own exploration.
    pub fn fork(&self) -> Self {
        let config = DdpgConfig { noise: self.config.fork_noise, ..self.config.clone() };
        Self { config, updates: 0, ..self.clone() }
    }
}

impl<O, G: Encode> Learner<O, Vec<f32>, G> for Ddpg<O> {
    fn act(&self, memory: &mut Memory, s: &O, goal: Option<&G>, ctx: &mut Context) -> Vec<f32> {
        let mut action = self.nets.act(self.inputs.rows(std::iter::once((s, goal))));
        if ctx.explore {
            self.config.noise.perturb(&mut action, memory, self.updates, &mut ctx.acting);
        }
        action
    }

    fn values(&self, _: &Memory, s: &O, goals: &[Option<&G>]) -> Vec<f32> {
        self.nets.values(self.inputs.rows(goals.iter().map(|goal| (s, *goal))))
    }

    fn values_of(&self, states: &[O], goal: Option<&G>) -> Vec<f32> {
        self.nets.values(self.inputs.rows(states.iter().map(|s| (s, goal))))
    }

    fn learn(&mut self, clips: &[Clip<O, Vec<f32>, G>], ctx: &mut Context) -> Learned {
        if clips.is_empty() {
            return Learned::default();
        }
        let config = &self.config;
        let after = self.inputs.rows(clips.iter().map(|clip| (clip.last(), clip.goal)));
        let actions = self.nets.target_actions(&after);
        let next = self.nets.target_values(after, actions);
        let batch = batch(&self.inputs, clips, targets(clips, config.discount, &next));

        let clip = config.gradient_clip;
        let critic = Step { rate: config.critic_rate, decay: config.critic_decay, clip, ..Step::default() };
        let actor = Step { rate: config.actor_rate, clip, ..Step::default() };
        let (errors, made) = self.nets.learn_critics(&batch, critic);
        let learned = Learned::of(errors);
        ctx.check("loss of the critic", learned.loss);
        if !made {
            ctx.check("gradient of the critic", f32::NAN);
            return learned;
        }
        if !self.nets.learn_actor(batch.states, actor, config.preactivation) {
            ctx.check("gradient of the actor", f32::NAN);
            return learned;
        }
        self.nets.follow(config.tau);
        self.updates += 1;
        learned
    }

    fn batch(&self) -> usize {
        self.config.batch
    }
}

impl<O> Clone for Ddpg<O> {
    fn clone(&self) -> Self {
        Self {
            inputs: self.inputs.clone(),
            config: self.config.clone(),
            nets: self.nets.clone(),
            updates: self.updates,
        }
    }
}

#[cfg(test)]
mod tests;
