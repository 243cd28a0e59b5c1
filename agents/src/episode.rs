//! The episode loop. There is one; training, evaluation and pictures go through it.

use inroads_envs::{End, Environment, Step, check::Observed};

use crate::{Actor, Context, Fault, Halt, Transition};

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
    let (mut before, mut after) = (E::Observation::default(), E::Observation::default());
    let (mut steps, mut total) = (0, 0.0);
    env.reset(seed);
    look(env, &mut before).map_err(|fault| Halt { step: 0, fault })?;
    actor.begin(&before, ctx);
    loop {
        steps += 1;
        let halt = |fault| Halt { step: steps, fault };
        let action = actor.act(&before, ctx);
        let Step { reward, end } = env.step(&action).map_err(|refused| halt(refused.into()))?;
        if !reward.is_finite() {
            return Err(halt(Fault::Reward(reward)));
        }
        look(env, &mut after).map_err(halt)?;
        total += reward;
        let source = actor.source();
        let transition = Transition { before: &before, action: &action, reward, after: &after, end };
        actor.observe(&transition, ctx);
        watch(&transition, source);
        if let Some(fault) = ctx.fault.take() {
            return Err(halt(fault));
        }
        if let Some(end) = end {
            let success = env.spec().succeeded(&Step { reward, end: Some(end) });
            let fault = env.fault().map(str::to_owned);
            return Ok(Summary { steps, reward: total, end, success, fault });
        }
        std::mem::swap(&mut before, &mut after);
    }
}

/// Looks, and judges what there is to see.
fn look<E>(env: &mut E, out: &mut E::Observation) -> Result<(), Fault>
where
    E: Environment<Observation: Observed> + ?Sized,
{
    env.observe(out);
    out.flaw(&env.spec().observation).map_or(Ok(()), |flaw| Err(flaw.into()))
}
