//! One episode: a [`round`] of one lane. There is no other loop; training, evaluation and pictures go through it.

use inroads_envs::{End, Environment, check::Observed};

use crate::{
    Actor, Context, Halt, Transition,
    lanes::{Alone, round},
};

/// What an episode came to.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Steps taken.
    pub steps: u32,
    /// Undiscounted sum of the task's rewards.
    pub reward: f32,
    /// How it ended.
    pub end: End,
    /// Whether the task was done ([`Spec::succeeded`](inroads_envs::Spec::succeeded)).
    pub success: bool,
    /// Why the simulator gave up on it, when it did ([`Environment::fault`]).
    pub fault: Option<String>,
}

/// Plays the episode that `seed` names. `watch` sees every transition after the actor has, and which part of
/// the actor chose the action ([`Actor::source`]).
///
/// # Errors
/// [`Halt`] at the action that the environment refused, or at an observation or a reward that is no finite number of the
/// spec's shape: the actor has not seen those. And at what it says of its own learning ([`Context::check`]).
pub fn episode<E: Environment<Observation: Observed> + ?Sized>(
    env: &mut E,
    actor: &mut (impl Actor<E::Observation, E::Action> + ?Sized),
    seed: u64,
    ctx: &mut Context,
    mut watch: impl FnMut(&Transition<E::Observation, E::Action>, usize),
) -> Result<Summary, Halt> {
    let watch = |_, t: &Transition<E::Observation, E::Action>, source| watch(t, source);
    let summaries = round(&mut [env], &mut Alone(actor), &[seed], std::slice::from_mut(ctx), watch);
    Ok(summaries.map_err(|(_, halt)| halt)?.pop().expect("there is one lane"))
}
