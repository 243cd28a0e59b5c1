//! A deterministic actor and a critic of its actions, with their slow targets (DDPG, Lillicrap 2015).

use burn::module::Module;
use burn::optim::GradientsParams;
use burn::tensor::activation::tanh;
use burn::tensor::{Device, Tensor};
use inroads_envs::Rng;

use super::adam::{Adam, Step};
use super::mlp::{Critic, Mlp};
use super::{Backend, floats, init, load_values, rows, target, values};
use crate::{Bag, Checkpoint, Corrupt};

/// The sizes of an actor and a critic.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shape<'a> {
    pub(crate) inputs: usize,
    pub(crate) actions: usize,
    /// Widths of the hidden layers, of which there is at least one.
    pub(crate) hidden: &'a [usize],
}

/// The four networks and the state of their optimisers. Clones learn on independently.
#[derive(Clone, Debug)]
pub(crate) struct ActorCritic {
    actor: Mlp,
    critic: Critic,
    target_actor: Mlp,
    target_critic: Critic,
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
        let Shape { inputs, actions, hidden } = shape;
        let device = backend.plain();
        let actor = Mlp::new(inputs, hidden, actions, init::LAST, &device, rng);
        let critic = Critic::new(inputs, actions, hidden, &device, rng);
        Self {
            target_actor: actor.clone(),
            target_critic: critic.clone(),
            actor,
            critic,
            actor_adam: Adam::default(),
            critic_adam: Adam::default(),
            inputs,
            actions,
            device,
        }
    }

    /// Actions at these states.
    pub(crate) fn act(&self, states: Vec<f32>) -> Vec<f32> {
        floats(policy(&self.actor, rows(states, self.inputs, &self.device)))
    }

    /// What the critic expects of the actor's actions at these states: Q(s, μ(s)).
    pub(crate) fn values(&self, states: Vec<f32>) -> Vec<f32> {
        let states = rows(states, self.inputs, &self.device);
        let actions = policy(&self.actor, states.clone());
        floats(self.critic.forward(states, actions))
    }

    /// What the target critic expects of the target actor's actions at these states: Q'(s, μ'(s)).
    pub(crate) fn target_values(&self, states: Vec<f32>) -> Vec<f32> {
        let states = rows(states, self.inputs, &self.device);
        let actions = policy(&self.target_actor, states.clone());
        floats(self.target_critic.forward(states, actions))
    }

    /// One step of the critic towards these values of these actions, and one of the actor uphill on the
    /// critic, which also pays `preactivation` times the mean square of what enters its tanh; the critic's
    /// errors before, and which gradient was not finite, so that its step was not made.
    pub(crate) fn learn(
        &mut self,
        states: Vec<f32>,
        actions: Vec<f32>,
        targets: Vec<f32>,
        critic_step: Step,
        actor_step: Step,
        preactivation: f32,
    ) -> (Vec<f32>, Option<&'static str>) {
        let states = rows(states, self.inputs, &self.device);
        let actions = rows(actions, self.actions, &self.device);
        let targets = rows(targets, 1, &self.device);

        let critic = self.critic.clone().train();
        let tracked = |t: &Tensor<2>| t.clone().autodiff();
        let error = critic.forward(tracked(&states), tracked(&actions)) - tracked(&targets);
        let errors = floats(error.clone().inner());
        let loss = (error.clone() * error).mean();
        let grads = GradientsParams::from_grads(loss.backward(), &critic);
        drop((loss, critic)); // so that the parameters are changed in place
        if !self.critic_adam.step(critic_step, &mut self.critic, grads) {
            return (errors, Some("gradient of the critic"));
        }

        // The critic is frozen here: only the actor's gradient is computed.
        let actor = self.actor.clone().train();
        let value = self.critic.clone().no_grad();
        let entering = actor.forward(tracked(&states));
        let q = value.forward(tracked(&states), tanh(entering.clone()));
        let loss = (entering.clone() * entering).mean() * preactivation - q.mean();
        let grads = GradientsParams::from_grads(loss.backward(), &actor);
        drop(actor);
        let made = self.actor_adam.step(actor_step, &mut self.actor, grads);
        (errors, (!made).then_some("gradient of the actor"))
    }

    /// The targets follow by one step of size `tau`.
    pub(crate) fn follow(&mut self, tau: f32) {
        target::follow(&mut self.target_actor, &self.actor, tau);
        target::follow(&mut self.target_critic, &self.critic, tau);
    }
}

impl Checkpoint for ActorCritic {
    fn save(&self, bag: &mut Bag) {
        bag.put("actor", &values(&self.actor));
        bag.put("critic", &values(&self.critic));
        bag.put("target actor", &values(&self.target_actor));
        bag.put("target critic", &values(&self.target_critic));
        bag.put("actor adam", &self.actor_adam);
        bag.put("critic adam", &self.critic_adam);
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        load_values(&mut self.actor, "actor", bag)?;
        load_values(&mut self.critic, "critic", bag)?;
        load_values(&mut self.target_actor, "target actor", bag)?;
        load_values(&mut self.target_critic, "target critic", bag)?;
        self.actor_adam = bag.get("actor adam")?;
        self.critic_adam = bag.get("critic adam")?;
        Ok(())
    }
}
