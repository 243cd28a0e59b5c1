//! One call of a learned skill, from wherever an environment of the caller's begins.

use inroads_agents::{Context, Halt, Transition};
use inroads_discovery::record::{Came, Skilled};
use inroads_envs::{Annotated, Environment, Frame, Refused, Step, registry::AnyEnvironment};

use super::pair::Seen;
use crate::assembly::Vector;

/// What was believed of a skill where it was called, and what the call came to.
#[derive(Clone, Debug, PartialEq)]
pub struct Attempt {
    /// Whether its initiation set says that it may start there.
    pub may_start: bool,
    /// Whether another skill might aim at that state.
    pub may_aim: bool,
    /// How probable success was held to be; none where sets only tell inside from outside.
    pub chance: Option<f32>,
    /// What it came to.
    pub came: Came,
}

/// An observation, and the environments of the registry in which it is what actions `A` lead to.
pub(super) trait Kind<A>: Seen {
    /// The environment, if it is of this kind.
    fn of(env: &mut AnyEnvironment) -> Option<&mut dyn Environment<Observation = Self, Action = A>>;
}

impl Kind<Vector> for Vector {
    fn of(env: &mut AnyEnvironment) -> Option<&mut dyn Environment<Observation = Self, Action = Vector>> {
        if let AnyEnvironment::Vectors(env) = env { Some(&mut **env) } else { None }
    }
}

impl Kind<usize> for Vector {
    fn of(env: &mut AnyEnvironment) -> Option<&mut dyn Environment<Observation = Self, Action = usize>> {
        if let AnyEnvironment::Choices(env) = env { Some(&mut **env) } else { None }
    }
}

impl Kind<usize> for Frame {
    fn of(env: &mut AnyEnvironment) -> Option<&mut dyn Environment<Observation = Self, Action = usize>> {
        if let AnyEnvironment::Frames(env) = env { Some(&mut **env) } else { None }
    }
}

impl Kind<usize> for Annotated<Vector> {
    /// Those with proto-goals are another kind of the registry's.
    fn of(_: &mut AnyEnvironment) -> Option<&mut dyn Environment<Observation = Self, Action = usize>> {
        None
    }
}

/// Calls a skill where the episode `start` of an environment begins; none when there is no such skill. A call is a part of an
/// episode, which is left when the call is over: so this is not the loop of episodes.
pub(super) fn attempt<O: Seen, A: Clone>(
    agent: &dyn Skilled<O, A>,
    env: &mut dyn Environment<Observation = O, Action = A>,
    skill: u32,
    start: u64,
    ctx: &mut Context,
) -> Result<Option<Attempt>, Halt> {
    let nth = agent.skills().iter().position(|record| record.skill == skill);
    let (Some(nth), Some(mut trial)) = (nth, agent.one_call(skill)) else { return Ok(None) };
    let (mut before, mut after, mut taken) = (O::default(), O::default(), 0);
    env.reset(start);
    env.observe(&mut before);
    let (members, targets, chances) =
        (agent.members(&before), agent.targets(&before), agent.chances(&before));
    trial.begin(&before, ctx);
    let came = loop {
        if let Some(came) = trial.came() {
            break came;
        }
        let action = trial.act(&before, ctx);
        taken += 1;
        let halt = |refused: Refused| Halt { step: taken, fault: refused.into() };
        let Step { reward, end } = env.step(&action).map_err(halt)?;
        env.observe(&mut after);
        trial.observe(&Transition { before: &before, action: &action, reward, after: &after, end }, ctx);
        std::mem::swap(&mut before, &mut after);
    };
    Ok(Some(Attempt { may_start: members[nth], may_aim: targets[nth], chance: chances[nth], came }))
}
