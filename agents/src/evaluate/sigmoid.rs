//! Policy evaluation by a small network with a sigmoid on top, so that it predicts a probability (thesis 5.1.1).

use std::sync::Arc;

use inroads_envs::Rng;
use serde::{Deserialize, Serialize};

use super::{Evaluator, Policy, check};
use crate::nets::{Backend, ProbabilityNet, Step};
use crate::{Clip, Context, Encode, Encoder, checkpoint};

/// Settings of [`Sigmoid`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SigmoidConfig {
    /// Widths of the hidden layers (authors, with MuJoCo: 256 and 256).
    pub hidden: Vec<usize>,
    /// Adam's rate (authors: 1e-4, for their larger networks).
    pub rate: f32,
    /// γ; 1 is a probability of success (thesis), below 1 it falls with the steps that are still to go (authors' code:
    /// 0.99).
    pub discount: f32,
    /// τ of θ' ← τθ + (1−τ)θ', at every update (authors: 5e-3, with more updates).
    pub tau: f32,
    /// Clips an update (authors: 32).
    pub batch: usize,
}

impl Default for SigmoidConfig {
    fn default() -> Self {
        Self { hidden: vec![64, 64], rate: 1e-3, discount: 1.0, tau: 0.02, batch: 32 }
    }
}

impl SigmoidConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        if self.hidden.contains(&0) {
            return Err(format!("hidden is {:?}; no layer may have width 0", self.hidden));
        }
        if !(self.rate.is_finite() && self.rate > 0.0) {
            return Err(format!("rate is {}; it must be a number above 0", self.rate));
        }
        if !(0.0..=1.0).contains(&self.tau) {
            return Err(format!("tau is {}; it must lie in [0, 1]", self.tau));
        }
        check(self.discount, self.batch)
    }
}

/// An encoder that many may share.
type Shared<T> = Arc<dyn Encoder<T> + Send + Sync>;

/// Fitted Q-evaluation by a network that learns by cross-entropy, with a target network.
///
/// It reads a state, a goal and an action. "Whatever the policy does" is an action to it too, so that V(s) can be asked
/// where nobody can say what the policy would do; it is learned beside the others, towards Q(s, π(s)).
#[derive(Clone)]
pub struct Sigmoid<O, A> {
    config: SigmoidConfig,
    states: Shared<O>,
    actions: Shared<A>,
    /// Numbers a goal; 0 where none is read.
    goal: usize,
    net: ProbabilityNet,
}

checkpoint!([O, A] Sigmoid<O, A>; plain: ; parts: net);

impl<O, A> Sigmoid<O, A> {
    /// A network with weights drawn from `rng`, for goals of `goal` numbers (0: none is read).
    pub fn new(
        states: Shared<O>,
        actions: Shared<A>,
        goal: usize,
        config: &SigmoidConfig,
        backend: Backend,
        rng: &mut Rng,
    ) -> Self {
        let inputs = states.width() + goal + actions.width() + 1;
        let net = ProbabilityNet::new(inputs, &config.hidden, backend, rng);
        Self { config: config.clone(), states, actions, goal, net }
    }

    /// Adds a row; without an action it is whatever the policy does.
    fn write<G: Encode>(&self, s: &O, goal: Option<&G>, action: Option<&A>, rows: &mut Vec<f32>) {
        let from = rows.len();
        let (state, width) = (self.states.width(), self.actions.width());
        rows.resize(from + state + self.goal + width + 1, 0.0);
        let (read, rest) = rows[from..].split_at_mut(state);
        self.states.write(s, read);
        let (read, rest) = rest.split_at_mut(self.goal);
        if let (Some(goal), false) = (goal, read.is_empty()) {
            goal.write(read);
        }
        match action {
            Some(action) => self.actions.write(action, &mut rest[..width]),
            None => rest[width] = 1.0,
        }
    }

    fn rows<G: Encode>(&self, states: &[&O], goal: Option<&G>) -> Vec<f32> {
        let mut rows = Vec::new();
        states.iter().for_each(|s| self.write(s, goal, None, &mut rows));
        rows
    }
}

impl<O, A, G: Encode> Evaluator<O, A, G> for Sigmoid<O, A> {
    fn values(&self, states: &[&O], goal: Option<&G>) -> Vec<f32> {
        if states.is_empty() { Vec::new() } else { self.net.values(self.rows(states, goal)) }
    }

    fn earlier(&self, states: &[&O], goal: Option<&G>) -> Vec<f32> {
        if states.is_empty() { Vec::new() } else { self.net.target_values(self.rows(states, goal)) }
    }

    fn learn(&mut self, clips: &[Clip<O, A, G>], policy: &Policy<'_, O, A>, ctx: &mut Context) -> f32 {
        if clips.is_empty() {
            return 0.0;
        }
        // Of each clip what was done, then of each what the policy does; asked of the target: what follows, and what
        // the policy's own action is worth.
        let (mut learned, mut asked) = (Vec::new(), Vec::new());
        for clip in clips {
            self.write(clip.first(), clip.goal, Some(&clip.actions[clip.lead]), &mut learned);
            self.write(clip.last(), clip.goal, Some(&policy(clip.last(), ctx)), &mut asked);
        }
        for clip in clips {
            let s = clip.first();
            self.write(s, clip.goal, None, &mut learned);
            self.write(s, clip.goal, Some(&policy(s, ctx)), &mut asked);
        }
        let mut targets = self.net.target_values(asked);
        for (target, clip) in targets.iter_mut().zip(clips) {
            let (cumulant, discount) = clip.discounted(self.config.discount);
            *target = (cumulant + discount * *target).clamp(0.0, 1.0);
        }
        let step = Step { rate: self.config.rate, ..Step::default() };
        let weights: Vec<f32> = clips.iter().chain(clips).map(|clip| clip.weight).collect();
        let loss = self.net.learn(learned, &targets, &weights, step);
        ctx.check("loss of the evaluator", loss);
        self.net.follow(self.config.tau);
        loss
    }

    fn batch(&self) -> usize {
        self.config.batch
    }
}
