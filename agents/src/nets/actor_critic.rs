//! A deterministic actor and critics of its actions, with their slow targets: one critic (DDPG, Lillicrap 2015) or two
//! (TD3, Fujimoto 2018).

use burn::module::Module;
use burn::optim::GradientsParams;
use burn::tensor::activation::tanh;
use burn::tensor::{Device, Tensor};
use inroads_envs::Rng;

use super::adam::{Adam, Step};
use super::mlp::{Critic, Mlp};
use super::{Backend, floats, init, load_values, rows, target, values};
use crate::{Bag, Checkpoint, Corrupt};

/// The sizes of an actor and its critics.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shape<'a> {
    pub(crate) inputs: usize,
    pub(crate) actions: usize,
    /// Widths of the hidden layers, of which there is at least one.
    pub(crate) hidden: &'a [usize],
    /// How many critics there are, at least one.
    pub(crate) critics: usize,
    /// So many of a critic's hidden layers, fewer than all or all, come before the action enters.
    pub(crate) alone: usize,
}

/// What critics learn from, row by row.
#[derive(Clone, Debug)]
pub(crate) struct Batch {
    pub(crate) states: Vec<f32>,
    pub(crate) actions: Vec<f32>,
    /// What the actions turned out to be worth.
    pub(crate) targets: Vec<f32>,
    /// What each row's loss counts.
    pub(crate) weights: Vec<f32>,
}

/// Critics of the same actions, each with an opinion of its own.
#[derive(Module, Debug, Default)]
struct Critics {
    members: Vec<Critic>,
}

impl Critics {
    fn forward(&self, states: &Tensor<2>, actions: &Tensor<2>) -> Vec<Tensor<2>> {
        self.members.iter().map(|critic| critic.forward(states.clone(), actions.clone())).collect()
    }

    /// The least that any of them expects.
    fn least(&self, states: &Tensor<2>, actions: &Tensor<2>) -> Vec<f32> {
        let opinions = self.forward(states, actions).into_iter().map(floats);
        let least = |a: Vec<f32>, b: Vec<f32>| a.iter().zip(&b).map(|(a, b)| a.min(*b)).collect();
        opinions.reduce(least).expect("there is a critic")
    }
}

/// Actor and critics, their targets, and the state of their optimisers. Clones learn on independently.
#[derive(Clone, Debug)]
pub(crate) struct ActorCritic {
    actor: Mlp,
    critics: Critics,
    target_actor: Mlp,
    target_critics: Critics,
    actor_adam: Adam,
    critic_adam: Adam,
    inputs: usize,
    actions: usize,
    device: Device,
}

fn policy(actor: &Mlp, states: Tensor<2>) -> Tensor<2> {
    tanh(actor.forward(states))
}

impl ActorCritic {
    pub(crate) fn new(shape: Shape<'_>, backend: Backend, rng: &mut Rng) -> Self {
        let Shape { inputs, actions, hidden, critics, alone } = shape;
        let device = backend.plain();
        let actor = Mlp::new(inputs, hidden, actions, init::LAST, &device, rng);
        let mut critic = |_| Critic::new(inputs, actions, hidden, alone, &device, rng);
        let critics = Critics { members: (0..critics).map(&mut critic).collect() };
        Self {
            target_actor: actor.clone(),
            target_critics: critics.clone(),
            actor,
            critics,
            actor_adam: Adam::default(),
            critic_adam: Adam::default(),
            inputs,
            actions,
            device,
        }
    }

    /// Actions at these states.
    pub(crate) fn act(&self, states: Vec<f32>) -> Vec<f32> {
        floats(policy(&self.actor, self.states(states)))
    }

    /// The least that a critic expects of the actor's actions at these states: min Q(s, μ(s)).
    pub(crate) fn values(&self, states: Vec<f32>) -> Vec<f32> {
        let states = self.states(states);
        let actions = policy(&self.actor, states.clone());
        self.critics.least(&states, &actions)
    }

    /// The target actor's actions at these states: μ'(s).
    pub(crate) fn target_actions(&self, states: &[f32]) -> Vec<f32> {
        floats(policy(&self.target_actor, self.states(states.to_vec())))
    }

    /// The least that a target critic expects of these actions at these states: min Q'(s, a).
    pub(crate) fn target_values(&self, states: Vec<f32>, actions: Vec<f32>) -> Vec<f32> {
        self.target_critics.least(&self.states(states), &rows(actions, self.actions, &self.device))
    }

    fn states(&self, states: Vec<f32>) -> Tensor<2> {
        rows(states, self.inputs, &self.device)
    }

    /// One step of all critics towards a batch; their errors before, all rows of the first critic, then of the next, and
    /// whether the step was made.
    pub(crate) fn learn_critics(&mut self, batch: &Batch, step: Step) -> (Vec<f32>, bool) {
        let tracked = |values: &[f32], width| rows(values.to_vec(), width, &self.device).autodiff();
        let states = tracked(&batch.states, self.inputs);
        let actions = tracked(&batch.actions, self.actions);
        let (targets, weights) = (tracked(&batch.targets, 1), tracked(&batch.weights, 1));

        let critics = self.critics.clone().train();
        let mut errors = Vec::with_capacity(critics.members.len() * batch.targets.len());
        let losses = critics.forward(&states, &actions).into_iter().map(|values| {
            let error = values - targets.clone();
            errors.extend(floats(error.clone().inner()));
            (error.clone() * error * weights.clone()).mean()
        });
        let loss = losses.reduce(|a, b| a + b).expect("there is a critic");
        let grads = GradientsParams::from_grads(loss.backward(), &critics);
        drop((loss, critics)); // so that the parameters are changed in place
        let made = self.critic_adam.step(step, &mut self.critics, grads);
        (errors, made)
    }

    /// One step of the actor uphill on the first critic at these states, which also pays `preactivation` times the mean
    /// square of what enters its tanh; whether the step was made.
    pub(crate) fn learn_actor(&mut self, states: Vec<f32>, step: Step, preactivation: f32) -> bool {
        let states = self.states(states).autodiff();
        // The critic is frozen here: only the actor's gradient is computed.
        let actor = self.actor.clone().train();
        let value = self.critics.members[0].clone().no_grad();
        let entering = actor.forward(states.clone());
        let q = value.forward(states, tanh(entering.clone()));
        let loss = (entering.clone() * entering).mean() * preactivation - q.mean();
        let grads = GradientsParams::from_grads(loss.backward(), &actor);
        drop(actor);
        self.actor_adam.step(step, &mut self.actor, grads)
    }

    /// The targets follow by one step of size `tau`.
    pub(crate) fn follow(&mut self, tau: f32) {
        target::follow(&mut self.target_actor, &self.actor, tau);
        target::follow(&mut self.target_critics, &self.critics, tau);
    }
}

impl Checkpoint for ActorCritic {
    fn save(&self, bag: &mut Bag) {
        bag.put("actor", &values(&self.actor));
        bag.put("critic", &values(&self.critics));
        bag.put("target actor", &values(&self.target_actor));
        bag.put("target critic", &values(&self.target_critics));
        bag.put("actor adam", &self.actor_adam);
        bag.put("critic adam", &self.critic_adam);
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        load_values(&mut self.actor, "actor", bag)?;
        load_values(&mut self.critics, "critic", bag)?;
        load_values(&mut self.target_actor, "target actor", bag)?;
        load_values(&mut self.target_critics, "target critic", bag)?;
        self.actor_adam = bag.get("actor adam")?;
        self.critic_adam = bag.get("critic adam")?;
        Ok(())
    }
}
