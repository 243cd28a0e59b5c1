//! Several episodes side by side, in as many environments: whoever computes on matrices computes their actions together.
//!
//! A round is one episode in each lane, and is over when all of them are. Between rounds nothing is half done, so that is
//! when checkpoints are taken. An agent learns of the steps in the order of the lanes; so a round is a function of what was
//! learned before it and of the numbers of its episodes, like an episode.

use std::ops::DerefMut;

use inroads_envs::{Environment, Step, check::Observed};

use crate::{Actor, Context, Fault, Halt, Summary, Transition};

/// Who can act in several episodes that go on side by side.
pub trait Crowd<O, A> {
    /// An episode begins in that lane at `s`. Those of a round begin in the order of their lanes, before anybody acts.
    fn begin_lane(&mut self, lane: usize, s: &O, ctx: &mut Context);

    /// Puts the actions of the lanes that still run behind what `actions` holds, in the order of `running`. Observations
    /// and contexts are those of all lanes, by their numbers; `running` ascends.
    fn act_lanes(&mut self, running: &[usize], s: &[O], ctxs: &mut [Context], actions: &mut Vec<A>);

    /// What came of the last action in that lane.
    fn observe_lane(&mut self, lane: usize, t: &Transition<O, A>, ctx: &mut Context);

    /// Which part of the agent chose the last action in that lane ([`Actor::source`]).
    fn source_of(&self, lane: usize) -> usize {
        let _ = lane;
        0
    }
}

/// An actor that has but one episode at a time, in the only lane.
#[derive(Debug)]
pub struct Alone<'a, T: ?Sized>(pub &'a mut T);

impl<O, A, T: Actor<O, A> + ?Sized> Crowd<O, A> for Alone<'_, T> {
    fn begin_lane(&mut self, _: usize, s: &O, ctx: &mut Context) {
        self.0.begin(s, ctx);
    }

    fn act_lanes(&mut self, running: &[usize], s: &[O], ctxs: &mut [Context], actions: &mut Vec<A>) {
        actions.extend(running.iter().map(|&lane| self.0.act(&s[lane], &mut ctxs[lane])));
    }

    fn observe_lane(&mut self, _: usize, t: &Transition<O, A>, ctx: &mut Context) {
        self.0.observe(t, ctx);
    }

    fn source_of(&self, _: usize) -> usize {
        self.0.source()
    }
}

/// Plays the episodes that `seeds` name, one in each environment; what they came to, in the order of the lanes. `watch` sees
/// every transition after the agent has: its lane, itself, and which part of the agent chose the action.
///
/// # Errors
/// The lane that cannot go on, and why: an action that was refused, an observation that is not of the spec's space, a reward
/// or a loss that is no finite number. Nobody has learned from it.
///
/// # Panics
/// When there are fewer seeds or contexts than environments.
pub fn round<E: Environment<Observation: Observed> + ?Sized>(
    envs: &mut [impl DerefMut<Target = E>],
    agent: &mut (impl Crowd<E::Observation, E::Action> + ?Sized),
    seeds: &[u64],
    ctxs: &mut [Context],
    mut watch: impl FnMut(usize, &Transition<E::Observation, E::Action>, usize),
) -> Result<Vec<Summary>, (usize, Halt)> {
    let (mut before, mut after) = (vec![E::Observation::default(); envs.len()], E::Observation::default());
    for (lane, env) in envs.iter_mut().enumerate() {
        env.reset(seeds[lane]);
        look(&mut **env, &mut before[lane]).map_err(|fault| (lane, Halt { step: 0, fault }))?;
        agent.begin_lane(lane, &before[lane], &mut ctxs[lane]);
    }
    let mut tallies = vec![(0, 0.0); envs.len()];
    let mut summaries = vec![None; envs.len()];
    let (mut running, mut actions) = ((0..envs.len()).collect::<Vec<_>>(), Vec::new());
    while !running.is_empty() {
        actions.clear();
        agent.act_lanes(&running, &before, ctxs, &mut actions);
        for (&lane, action) in running.iter().zip(&actions) {
            let env = &mut *envs[lane];
            let (steps, total) = &mut tallies[lane];
            *steps += 1;
            let halt = |fault| (lane, Halt { step: *steps, fault });
            let step @ Step { reward, end } = env.step(action).map_err(|refused| halt(refused.into()))?;
            if !reward.is_finite() {
                return Err(halt(Fault::Reward(reward)));
            }
            look(env, &mut after).map_err(halt)?;
            *total += reward;
            let source = agent.source_of(lane);
            let transition = Transition { before: &before[lane], action, reward, after: &after, end };
            agent.observe_lane(lane, &transition, &mut ctxs[lane]);
            watch(lane, &transition, source);
            if let Some(fault) = ctxs[lane].fault.take() {
                return Err((lane, Halt { step: *steps, fault }));
            }
            summaries[lane] = end.map(|end| Summary {
                steps: *steps,
                reward: *total,
                end,
                success: env.spec().succeeded(&step),
                fault: env.fault().map(str::to_owned),
            });
            std::mem::swap(&mut before[lane], &mut after);
        }
        running.retain(|&lane| summaries[lane].is_none());
    }
    Ok(summaries.into_iter().flatten().collect())
}

/// Looks, and judges what there is to see.
fn look<E>(env: &mut E, out: &mut E::Observation) -> Result<(), Fault>
where
    E: Environment<Observation: Observed> + ?Sized,
{
    env.observe(out);
    out.flaw(&env.spec().observation).map_or(Ok(()), |flaw| Err(flaw.into()))
}

#[cfg(test)]
mod tests;
