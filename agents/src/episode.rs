//! The episode loop. There is one; training, evaluation and pictures go through it.

use inroads_envs::{End, Environment, Refused, Step};

use crate::{Actor, Context, Transition};

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
/// The action that the environment refused; the actor has not observed it.
pub fn episode<E: Environment + ?Sized>(
    env: &mut E,
    actor: &mut (impl Actor<E::Observation, E::Action> + ?Sized),
    seed: u64,
    ctx: &mut Context,
    mut watch: impl FnMut(&Transition<E::Observation, E::Action>, usize),
) -> Result<Summary, Refused> {
    let (mut before, mut after) = (E::Observation::default(), E::Observation::default());
    let (mut steps, mut total) = (0, 0.0);
    env.reset(seed);
    env.observe(&mut before);
    actor.begin(&before, ctx);
    loop {
        let action = actor.act(&before, ctx);
        let Step { reward, end } = env.step(&action)?;
        env.observe(&mut after);
        steps += 1;
        total += reward;
        let source = actor.source();
        let transition = Transition { before: &before, action: &action, reward, after: &after, end };
        actor.observe(&transition, ctx);
        watch(&transition, source);
        if let Some(end) = end {
            let success = env.spec().succeeded(&Step { reward, end: Some(end) });
            let fault = env.fault().map(str::to_owned);
            return Ok(Summary { steps, reward: total, end, success, fault });
        }
        std::mem::swap(&mut before, &mut after);
    }
}
