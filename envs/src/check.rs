//! The contract of [`Environment`] as a test that every domain inherits.
//!
//! ```
//! use inroads_envs::{check::{Options, check}, corridor::Corridor};
//! check(&mut Corridor::new(7), Options::default())?;
//! # Ok::<(), inroads_envs::check::Fault>(())
//! ```

mod fault;
mod kinds;
#[cfg(test)]
mod tests;

pub use fault::{Fault, Flaw};
pub use kinds::{Drawn, Observed};

use rand::RngExt;

use crate::{End, Environment, Refused, Seed, Space, Spec};

/// How long to look.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Episodes, each with its own seed and random actions.
    pub episodes: u64,
    /// Steps after which an episode that has not ended is left, unless the time limit is later.
    pub steps: u32,
}

impl Default for Options {
    fn default() -> Self {
        Self { episodes: 4, steps: 500 }
    }
}

/// How an episode is played.
#[derive(Clone, Copy, PartialEq)]
enum Manner {
    /// Looking after every step.
    Plain,
    /// Looking now and then.
    Seldom,
    /// With illegal actions thrown in.
    Disturbed,
}

/// In how many moments one looks who looks seldom.
const SELDOM: f64 = 0.3;

/// Checks a fresh environment, one that has not been reset yet.
///
/// Every episode is played four times with the same random legal actions: once, once again, once with looking
/// only now and then, and once with illegal actions thrown in. All four must be the same.
///
/// # Errors
/// The first [`Fault`] that is found.
pub fn check<E>(env: &mut E, options: Options) -> Result<(), Fault>
where
    E: Environment<Observation: Observed, Action: Drawn>,
{
    consistent(env.spec())?;
    let action = E::Action::legal(&env.spec().action, &mut Seed(0).stream("check", 0));
    outside(env, "before the first reset", &action)?;
    for seed in 0..options.episodes {
        let trace = episode(env, seed, options, Manner::Plain)?;
        let mut differs = |manner| Ok(difference(&trace, &episode(env, seed, options, manner)?));
        if let Some(step) = differs(Manner::Plain)? {
            return Err(Fault::Replay { seed, step });
        }
        if let Some(step) = differs(Manner::Seldom)? {
            return Err(Fault::Looks { seed, step });
        }
        if let Some(step) = differs(Manner::Disturbed)? {
            return Err(Fault::Mark { seed, step });
        }
    }
    Ok(())
}

/// The parts of a spec speak of each other.
fn consistent(spec: &Spec) -> Result<(), Fault> {
    let ordered = |space: &Space| space.dimensions().iter().all(|d| d.low <= d.high);
    let seen = |dims: &[usize]| dims.iter().all(|&d| d < spec.observation.len());
    let goal = spec.goal.as_ref();
    let clauses = [
        (!spec.observation.is_empty(), "nothing is seen"),
        (!spec.action.is_empty() && spec.action != Space::Discrete(0), "nothing can be done"),
        (ordered(&spec.observation) && ordered(&spec.action), "a dimension's low is above its high"),
        (seen(&spec.place), "place names a dimension that is not observed"),
        (goal.is_none_or(|g| seen(&g.dims)), "the goal names a dimension that is not observed"),
        (goal.is_none_or(|g| g.dims.len() == g.at.len()), "the goal has not one number a dimension"),
        (goal.is_none_or(|g| g.tolerance >= 0.0), "the goal's tolerance is negative"),
        (spec.time_limit != Some(0), "the time limit is 0"),
    ];
    match clauses.iter().find(|(holds, _)| !holds) {
        Some(&(_, why)) => Err(Fault::Spec(why)),
        None => Ok(()),
    }
}

/// What can be told of a moment from outside: observation, if somebody looked, reward, end.
type Moment<O> = (Option<O>, f32, Option<End>);

/// Plays the episode that the seed names, with random legal actions that are a function of the seed too.
fn episode<E>(
    env: &mut E,
    seed: u64,
    options: Options,
    manner: Manner,
) -> Result<Vec<Moment<E::Observation>>, Fault>
where
    E: Environment<Observation: Observed, Action: Drawn>,
{
    let (space, limit) = (env.spec().action.clone(), env.spec().time_limit);
    let (mut rng, mut eyes) = (Seed(seed).stream("check", 0), Seed(seed).stream("check looks", 0));
    let mut glance = |env: &mut E, step| match manner == Manner::Seldom && !eyes.random_bool(SELDOM) {
        true => Ok(None),
        false => look(env, seed, step).map(Some),
    };
    env.reset(seed);
    let mut trace = vec![(glance(env, 0)?, 0.0, None)];
    for step in 1..=options.steps.max(limit.unwrap_or(0)) {
        if manner == Manner::Disturbed {
            disturb(env, seed, step - 1, &space)?;
        }
        let action = E::Action::legal(&space, &mut rng);
        let answer =
            env.step(&action).map_err(|refused| Fault::RefusedLegal { seed, step: step - 1, refused })?;
        if !answer.reward.is_finite() {
            return Err(Fault::Reward { seed, step, reward: answer.reward });
        }
        trace.push((glance(env, step)?, answer.reward, answer.end));
        let last = limit == Some(step);
        // A simulator that gives up truncates before the limit.
        let early = answer.end == Some(End::Truncated) && !last && env.fault().is_none();
        if early || answer.end.is_none() && last {
            return Err(Fault::Limit { seed, step, end: answer.end, limit });
        }
        if answer.end.is_some() {
            outside(env, "after the end of an episode", &action)?;
            break;
        }
    }
    Ok(trace)
}

/// The first step at which two traces differ. Where one of them did not look, observations do not.
fn difference<O: PartialEq>(a: &[Moment<O>], b: &[Moment<O>]) -> Option<u32> {
    let like = |a: &Moment<O>, b: &Moment<O>| {
        (a.1, a.2) == (b.1, b.2) && (a.0.is_none() || b.0.is_none() || a.0 == b.0)
    };
    let same = a.iter().zip(b).take_while(|(a, b)| like(a, b)).count();
    (same < a.len().max(b.len())).then_some(same as u32)
}

/// Does all that is illegal.
fn disturb<E>(env: &mut E, seed: u64, step: u32, space: &Space) -> Result<(), Fault>
where
    E: Environment<Action: Drawn>,
{
    for action in E::Action::illegal(space) {
        match env.step(&action) {
            Err(refused) if refused != Refused::Over => {}
            answer => {
                let (action, answer) = (format!("{action:?}"), format!("{answer:?}"));
                return Err(Fault::Admitted { seed, step, action, answer });
            }
        }
    }
    Ok(())
}

/// Acts outside an episode.
fn outside<E: Environment>(env: &mut E, when: &'static str, action: &E::Action) -> Result<(), Fault> {
    match env.step(action) {
        Err(Refused::Over) => Ok(()),
        answer => Err(Fault::NotOver { when, answer: format!("{answer:?}") }),
    }
}

/// What there is to see, into buffers that hold this and that.
fn look<E>(env: &mut E, seed: u64, step: u32) -> Result<E::Observation, Fault>
where
    E: Environment<Observation: Observed>,
{
    let mut seen = E::Observation::default();
    env.observe(&mut seen);
    if let Some(why) = seen.flaw(&env.spec().observation) {
        return Err(Fault::Observation { seed, step, seen: seen.told(), why });
    }
    for mut used in E::Observation::used() {
        env.observe(&mut used);
        if used != seen {
            return Err(Fault::Buffer { seed, step });
        }
    }
    Ok(seen)
}
