//! The contract of [`Environment`] as a test that every domain inherits.
//!
//! ```
//! use inroads_envs::{check::{Options, check}, corridor::Corridor};
//! check(&mut Corridor::new(7), Options::default())?;
//! # Ok::<(), inroads_envs::check::Fault>(())
//! ```

use std::fmt::Debug;

use rand::RngExt;

use crate::{Dimension, End, Environment, Refused, Rng, Seed, Space, Spec};

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

/// A clause of the contract that an environment breaks.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Fault {
    /// The spec contradicts itself.
    #[error("the spec contradicts itself: {0}")]
    Spec(&'static str),
    /// An observation is not of the space in the spec.
    #[error("seed {seed}, step {step}: the observation {seen} is not of the spec's space: {why}")]
    Observation {
        /// The episode's seed.
        seed: u64,
        /// Steps taken.
        step: u32,
        /// The observation.
        seen: String,
        /// What is wrong with it.
        why: &'static str,
    },
    /// `observe` left something of what the buffer held.
    #[error("seed {seed}, step {step}: observe leaves part of what the buffer held; write all of it")]
    Buffer {
        /// The episode's seed.
        seed: u64,
        /// Steps taken.
        step: u32,
    },
    /// A reward is NaN or infinite.
    #[error("seed {seed}, step {step}: the reward is {reward}; rewards must be finite")]
    Reward {
        /// The episode's seed.
        seed: u64,
        /// Steps taken.
        step: u32,
        /// The reward.
        reward: f32,
    },
    /// The same seed and actions gave something else.
    #[error(
        "seed {seed}, step {step}: the same seed and actions gave another episode; draw only from the seed"
    )]
    Replay {
        /// The episode's seed.
        seed: u64,
        /// First step that differs.
        step: u32,
    },
    /// A legal action was refused.
    #[error("seed {seed}, step {step}: a legal action was refused: {refused}")]
    RefusedLegal {
        /// The episode's seed.
        seed: u64,
        /// Steps taken.
        step: u32,
        /// The refusal.
        refused: Refused,
    },
    /// An illegal action was carried out, or refused for the wrong reason.
    #[error("seed {seed}, step {step}: the illegal action {action} was answered with {answer}")]
    Admitted {
        /// The episode's seed.
        seed: u64,
        /// Steps taken.
        step: u32,
        /// The action.
        action: String,
        /// The answer.
        answer: String,
    },
    /// A refused action left its mark.
    #[error(
        "seed {seed}, step {step}: refused actions have changed the episode; refuse before changing anything"
    )]
    Mark {
        /// The episode's seed.
        seed: u64,
        /// First step that differs.
        step: u32,
    },
    /// `step` outside an episode was not refused as [`Refused::Over`].
    #[error("step {when} was answered with {answer}; it must be refused with Over")]
    NotOver {
        /// Before the first reset or after the end.
        when: &'static str,
        /// The answer.
        answer: String,
    },
    /// Truncation and the spec's time limit disagree.
    #[error(
        "seed {seed}: after {step} steps the episode's end is {end:?}, but the spec's time limit is {limit:?}"
    )]
    Limit {
        /// The episode's seed.
        seed: u64,
        /// Steps taken.
        step: u32,
        /// How it ended.
        end: Option<End>,
        /// The spec's limit.
        limit: Option<u32>,
    },
}

/// Observations that can be checked.
pub trait Observed: Clone + Default + PartialEq + Debug {
    /// What is wrong with an observation of this space.
    fn fault(&self, space: &Space) -> Option<&'static str>;
    /// Buffers that hold something already.
    fn used() -> Vec<Self>;
}

impl Observed for Vec<f32> {
    fn fault(&self, space: &Space) -> Option<&'static str> {
        if self.len() != space.len() {
            return Some("wrong length");
        }
        self.iter().any(|x| !x.is_finite()).then_some("not finite")
    }

    fn used() -> Vec<Self> {
        vec![vec![f32::NAN; 1000], vec![7.0]]
    }
}

/// Actions that can be drawn.
pub trait Drawn: Clone + Debug {
    /// A legal action, uniformly over the space (over [-1, 1] where a dimension has no bounds).
    fn legal(space: &Space, rng: &mut Rng) -> Self;
    /// One action for each way of being illegal.
    fn illegal(space: &Space) -> Vec<Self>;
}

impl Drawn for Vec<f32> {
    fn legal(space: &Space, rng: &mut Rng) -> Self {
        let bounded = |d: &Dimension| {
            let low = if d.low.is_finite() { d.low } else { d.high.min(-1.0) };
            (low, if d.high.is_finite() { d.high } else { low.max(1.0) })
        };
        space.dimensions().iter().map(bounded).map(|(low, high)| rng.random_range(low..=high)).collect()
    }

    fn illegal(space: &Space) -> Vec<Self> {
        let legal: Self = space.dimensions().iter().map(|d| 0.0_f32.clamp(d.low, d.high)).collect();
        let mut actions = vec![vec![], [legal.as_slice(), &[0.0]].concat()];
        for (index, dimension) in space.dimensions().iter().enumerate() {
            let mut with = |value: f32| {
                let mut action = legal.clone();
                action[index] = value;
                actions.push(action);
            };
            [f32::NAN, f32::INFINITY, f32::NEG_INFINITY].into_iter().for_each(&mut with);
            if dimension.low.is_finite() {
                with(dimension.low.next_down());
            }
            if dimension.high.is_finite() {
                with(dimension.high.next_up());
            }
        }
        actions
    }
}

impl Drawn for usize {
    fn legal(space: &Space, rng: &mut Rng) -> Self {
        match space {
            Space::Discrete(n) => rng.random_range(0..*n),
            Space::Box(_) => 0,
        }
    }

    fn illegal(space: &Space) -> Vec<Self> {
        match space {
            Space::Discrete(n) => vec![*n, Self::MAX],
            Space::Box(_) => vec![],
        }
    }
}

/// Checks a fresh environment, one that has not been reset yet.
///
/// Every episode is played three times with the same random legal actions: once, once again, and once with
/// illegal actions thrown in. All three must be the same.
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
        let trace = episode(env, seed, options, false)?;
        if let Some(step) = difference(&trace, &episode(env, seed, options, false)?) {
            return Err(Fault::Replay { seed, step });
        }
        if let Some(step) = difference(&trace, &episode(env, seed, options, true)?) {
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

/// What can be told of a moment from outside: observation, reward, end.
type Moment<O> = (O, f32, Option<End>);

/// Plays the episode that the seed names, with random legal actions that are a function of the seed too.
fn episode<E>(
    env: &mut E,
    seed: u64,
    options: Options,
    disturbed: bool,
) -> Result<Vec<Moment<E::Observation>>, Fault>
where
    E: Environment<Observation: Observed, Action: Drawn>,
{
    let (space, limit) = (env.spec().action.clone(), env.spec().time_limit);
    let mut rng = Seed(seed).stream("check", 0);
    env.reset(seed);
    let mut trace = vec![(look(env, seed, 0)?, 0.0, None)];
    for step in 1..=options.steps.max(limit.unwrap_or(0)) {
        if disturbed {
            disturb(env, seed, step - 1, &space)?;
        }
        let action = E::Action::legal(&space, &mut rng);
        let answer =
            env.step(&action).map_err(|refused| Fault::RefusedLegal { seed, step: step - 1, refused })?;
        if !answer.reward.is_finite() {
            return Err(Fault::Reward { seed, step, reward: answer.reward });
        }
        trace.push((look(env, seed, step)?, answer.reward, answer.end));
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

/// The first step at which two traces differ.
fn difference<O: PartialEq>(a: &[Moment<O>], b: &[Moment<O>]) -> Option<u32> {
    let same = a.iter().zip(b).take_while(|(a, b)| a == b).count();
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
fn look<E>(env: &E, seed: u64, step: u32) -> Result<E::Observation, Fault>
where
    E: Environment<Observation: Observed>,
{
    let mut seen = E::Observation::default();
    env.observe(&mut seen);
    if let Some(why) = seen.fault(&env.spec().observation) {
        return Err(Fault::Observation { seed, step, seen: format!("{seen:?}"), why });
    }
    for mut used in E::Observation::used() {
        env.observe(&mut used);
        if used != seen {
            return Err(Fault::Buffer { seed, step });
        }
    }
    Ok(seen)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Goal, Step, corridor::Corridor};

    /// What is broken in the toy below.
    #[derive(Clone, Copy, Debug, PartialEq)]
    enum Broken {
        Nothing,
        SpecGoal,
        Length,
        Nan,
        Buffer,
        Reward,
        Replay,
        Timid,
        Reckless,
        Marked,
        Eager,
        Tireless,
        Late,
        Early,
    }

    /// Adds its action to a number that starts anywhere, until the number is large or 10 steps are over.
    struct Toy {
        broken: Broken,
        spec: Spec,
        sum: f32,
        steps: u32,
        resets: u32,
        over: bool,
    }

    impl Toy {
        fn new(broken: Broken) -> Self {
            let dims = if broken == Broken::SpecGoal { vec![1] } else { vec![0] };
            let spec = Spec {
                name: "toy",
                about: "",
                observation: Space::Box(vec![Dimension::linear("sum", "", -5.0, 5.0)]),
                action: Space::Box(vec![Dimension::linear("add", "", -1.0, 1.0)]),
                goal: Some(Goal { dims, at: vec![2.0], tolerance: 1.0 }),
                place: vec![0],
                time_limit: Some(10),
                success_reward: 0.0,
            };
            Self { broken, spec, sum: 0.0, steps: 0, resets: 0, over: broken != Broken::Eager }
        }
    }

    impl Environment for Toy {
        type Observation = Vec<f32>;
        type Action = Vec<f32>;

        fn spec(&self) -> &Spec {
            &self.spec
        }

        fn reset(&mut self, seed: u64) {
            self.resets += 1;
            let from = if self.broken == Broken::Replay { u64::from(self.resets) } else { seed };
            self.sum = Seed(from).stream("start", 0).random_range(-1.0..1.0);
            self.steps = 0;
            self.over = false;
        }

        fn step(&mut self, action: &Vec<f32>) -> Result<Step, Refused> {
            if self.over && (self.broken != Broken::Tireless || self.resets == 0) {
                return Err(Refused::Over);
            }
            if self.broken == Broken::Marked {
                self.sum += 0.125;
            }
            if self.broken != Broken::Reckless {
                self.spec.action.admit(action)?;
            }
            if self.broken == Broken::Timid && action[0] > 0.0 {
                return Err(Refused::NotFinite { index: 0, value: action[0] });
            }
            self.sum += action.first().copied().unwrap_or_default();
            self.steps += 1;
            let limit = match self.broken {
                Broken::Late => 11,
                Broken::Early => 9,
                _ => 10,
            };
            let end = match () {
                () if self.sum > 2.0 => Some(End::Terminated),
                () if self.steps == limit => Some(End::Truncated),
                () => None,
            };
            self.over = end.is_some();
            Ok(Step { reward: if self.broken == Broken::Reward { f32::NAN } else { -1.0 }, end })
        }

        fn observe(&self, out: &mut Vec<f32>) {
            if self.broken != Broken::Buffer || out.len() > 1 {
                out.clear();
            }
            match self.broken {
                Broken::Length => out.extend([self.sum, self.sum]),
                Broken::Nan => out.push(f32::NAN),
                _ => out.push(self.sum),
            }
        }
    }

    fn verdict(broken: Broken) -> Result<(), Fault> {
        check(&mut Toy::new(broken), Options { episodes: 8, steps: 20 })
    }

    #[test]
    fn a_sound_environment_passes() {
        assert_eq!(verdict(Broken::Nothing), Ok(()));
    }

    #[test]
    fn each_broken_clause_is_caught_by_its_own_name() {
        let caught = |broken| verdict(broken).expect_err("a broken toy passed");
        assert!(matches!(caught(Broken::SpecGoal), Fault::Spec(_)));
        assert!(matches!(caught(Broken::Length), Fault::Observation { why: "wrong length", .. }));
        assert!(matches!(caught(Broken::Nan), Fault::Observation { why: "not finite", .. }));
        assert!(matches!(caught(Broken::Buffer), Fault::Buffer { .. }));
        assert!(matches!(caught(Broken::Reward), Fault::Reward { .. }));
        assert!(matches!(caught(Broken::Replay), Fault::Replay { step: 0, .. }));
        assert!(matches!(caught(Broken::Timid), Fault::RefusedLegal { .. }));
        assert!(matches!(caught(Broken::Reckless), Fault::Admitted { .. }));
        assert!(matches!(caught(Broken::Marked), Fault::Mark { step: 1, .. }));
        assert!(matches!(caught(Broken::Eager), Fault::NotOver { when: "before the first reset", .. }));
        assert!(matches!(
            caught(Broken::Tireless),
            Fault::NotOver { when: "after the end of an episode", .. }
        ));
        assert!(matches!(caught(Broken::Late), Fault::Limit { step: 10, end: None, .. }));
        assert!(matches!(caught(Broken::Early), Fault::Limit { step: 9, end: Some(End::Truncated), .. }));
    }

    /// A corridor that takes any choice for a step to the right.
    struct Careless(Corridor);

    impl Environment for Careless {
        type Observation = Vec<f32>;
        type Action = usize;

        fn spec(&self) -> &Spec {
            self.0.spec()
        }

        fn reset(&mut self, seed: u64) {
            self.0.reset(seed);
        }

        fn step(&mut self, action: &usize) -> Result<Step, Refused> {
            self.0.step(action.min(&1))
        }

        fn observe(&self, out: &mut Vec<f32>) {
            self.0.observe(out);
        }
    }

    #[test]
    fn a_choice_that_is_none_must_be_refused() {
        let fault = check(&mut Careless(Corridor::new(5)), Options::default());
        assert!(matches!(&fault, Err(Fault::Admitted { action, .. }) if action == "2"), "{fault:?}");
    }
}
