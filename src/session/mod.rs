//! An agent in an environment, whatever their kinds.

mod attempt;
mod pair;
mod spot;
#[cfg(test)]
pub(crate) mod stub;
#[cfg(test)]
mod tests;
mod travel;

pub use attempt::Attempt;
pub use spot::{PlanError, Spot};
pub use travel::Travelled;

use inroads_agents::{Bag, Corrupt, Fault, Summary};
use inroads_discovery::record::{GoalRecord, GraphRecord, PlanRecord, SkillRecord};
use inroads_envs::{
    Annotated, Environment, Frame, Refused, Seed, Spec,
    maze::Starts,
    registry::{self, AnyAnnotated, AnyEnvironment, Options},
};
use serde::{Deserialize, Serialize};

use self::{attempt::Kind, pair::Pair};
use crate::{
    assembly::{self, AgentEntry, Build, Vector},
    config::{Config, ConfigError, Settings, World},
};

/// One line of `metrics.jsonl`: a training episode. No times: the same seed writes the same lines.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EpisodeMetrics {
    /// The episode's number, from 0.
    pub episode: u64,
    /// Steps of the environment up to and with this episode.
    pub env_steps: u64,
    /// Its steps.
    pub steps: u32,
    /// Sum of its rewards.
    #[serde(rename = "return")]
    pub reward: f32,
    /// Whether the task was done.
    pub success: bool,
    /// Learned skills after its round.
    pub skills: usize,
    /// Steps of it that learned skills took.
    pub skill_steps: u32,
    /// Updates made up to and with its round, by network.
    pub updates: std::collections::BTreeMap<String, u64>,
    /// Why the simulator gave up on the episode, when it did; it was truncated then.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fault: Option<String>,
}

/// An action of any kind.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Numbers.
    Vector(Vector),
    /// One of several choices.
    Choice(usize),
}

impl From<Vector> for Action {
    fn from(action: Vector) -> Self {
        Self::Vector(action)
    }
}

impl From<usize> for Action {
    fn from(action: usize) -> Self {
        Self::Choice(action)
    }
}

/// A watched episode, for figures and films.
#[derive(Clone, Debug, PartialEq)]
pub struct Watched {
    /// Every observation, the last included; nothing where pictures are seen, which have no coordinates to be drawn.
    pub path: Vec<Vector>,
    /// The skill that took each step (0: a primitive action).
    pub skills: Vec<usize>,
    /// The seed that the episode began with.
    pub start: u64,
    /// What was done; with the seed it is the whole episode.
    pub actions: Vec<Action>,
    /// Whether the initiation set of a learned skill has the first state.
    pub covered: bool,
    /// What it came to.
    pub summary: Summary,
}

impl Watched {
    /// Share of its steps that learned skills took.
    pub fn skill_share(&self) -> f64 {
        let skilled = self.skills.iter().filter(|skill| **skill > 0).count();
        skilled as f64 / self.skills.len().max(1) as f64
    }

    /// Every observation with the skill that acted there; the last one's is the one before's.
    pub fn acted(&self) -> impl ExactSizeIterator<Item = (&Vector, usize)> {
        let last = self.skills.len().saturating_sub(1);
        self.path.iter().enumerate().map(move |(step, s)| (s, self.skills[step.min(last)]))
    }
}

/// An episode that could not go on: which, when, why, and what may mend it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("episode {episode}, step {step} of the environment: {fault}; {}", mend(.fault))]
pub struct Stopped {
    /// The episode's number.
    pub episode: u64,
    /// Steps of the environment up to then: in training since its beginning, else in this episode.
    pub step: u64,
    /// What happened.
    pub fault: Fault,
}

/// What may help.
fn mend(fault: &Fault) -> &'static str {
    match fault {
        Fault::Observation(_) | Fault::Reward(_) => {
            "mend the environment: `envs::check::check` finds what is wrong with it"
        }
        Fault::Refused(Refused::NotFinite { .. }) | Fault::Learning { .. } => {
            "training diverged: try smaller rates of what learned it (settings that end in `rate`) or a bound of its gradient \
             (`gradient_clip`)"
        }
        Fault::Refused(_) => "agent and environment disagree on what can be done",
    }
}

/// How an evaluation acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Protocol {
    /// As the agent would, without noise and without learning.
    Frozen,
    /// The same, without primitive actions wherever a learned skill may start.
    ChainAlone,
}

/// An agent in an environment, whatever their kinds.
pub trait Session {
    /// What is known of the environment.
    fn spec(&self) -> &Spec;

    /// Trains for a round: an episode a lane.
    ///
    /// # Errors
    /// [`Stopped`] at an action that was refused, or at an observation, a reward or a loss that is no finite number. The
    /// session is in the midst of the episode then: [`load`](Self::load) what was saved before it.
    fn train(&mut self) -> Result<Vec<EpisodeMetrics>, Stopped>;

    /// Episodes trained so far, and steps of the environment in them.
    fn progress(&self) -> (u64, u64);

    /// Evaluation episode number `index`; none when the agent has nothing to act with under that protocol.
    ///
    /// # Errors
    /// [`Stopped`] at an action that was refused, or at what is no finite number.
    fn evaluate(&mut self, protocol: Protocol, index: u64) -> Result<Option<Watched>, Stopped>;

    /// The agent's skills.
    fn skills(&self) -> Vec<SkillRecord>;

    /// Of all skills: whether the observation is in its initiation set. Nothing where agents see other things than vectors.
    fn members(&self, observation: &Vector) -> Vec<bool>;

    /// Of all skills: whether another skill may aim at the observation in order to enter its initiation set. Nothing where agents
    /// see other things than vectors.
    fn targets(&self, observation: &Vector) -> Vec<bool>;

    /// Calls a learned skill once, frozen and without noise, where the episode that `start` names begins in an environment of the
    /// same kind; the random streams are those that `index` names. None when there is no such skill, skills cannot be called one
    /// by one, or the environment is of another kind. Neither the agent nor the session's environment changes.
    ///
    /// # Errors
    /// [`Stopped`] at an action that was refused.
    fn attempt(
        &self,
        skill: u32,
        env: &mut AnyEnvironment,
        start: u64,
        index: u64,
    ) -> Result<Option<Attempt>, Stopped>;

    /// The agent's skill graph, if it has one.
    fn graph(&self) -> Option<GraphRecord>;

    /// The agent's goal space; nothing when it has none.
    fn goals(&self) -> Vec<GoalRecord>;

    /// The way from one place to another by the agent's skill graph. The start is that of evaluation episode 0.
    ///
    /// # Errors
    /// [`PlanError`] when there is no graph, no such place or no way.
    fn plan(&mut self, from: &Spot, to: &Spot) -> Result<PlanRecord, PlanError>;

    /// Evaluation episode number `index`, on the way to one place and from there to another, by plans on the skill graph
    /// that are made anew wherever the agent finds itself. An episode begins at its own start, so `from` has to be
    /// reached too, within the same time limit.
    ///
    /// # Errors
    /// [`PlanError`] when there is no graph or no such place, or the episode could not go on.
    fn travel(&mut self, from: &Spot, to: &Spot, index: u64) -> Result<Travelled, PlanError>;

    /// Everything learned, with the progress.
    fn save(&self) -> Bag;

    /// Restores what was saved.
    ///
    /// # Errors
    /// [`Corrupt`] names the part.
    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt>;
}

/// Builds the session of a configuration.
///
/// # Errors
/// [`ConfigError`] when a name is unknown, or the agent cannot act in the environment.
pub fn build(config: &Config) -> Result<Box<dyn Session>, ConfigError> {
    let settings = &config.settings;
    let entry = assembly::agent(&settings.agent)?;
    if entry.annotated.is_some() && entry.continuous.is_none() && entry.discrete.is_none() {
        let made = settings.world.with_options(|o| registry::make_annotated(&settings.environment, o))?;
        return match made {
            AnyAnnotated::Vectors(env) => annotated(vec![env], config),
            AnyAnnotated::Frames(_) => Err(blind(settings)),
        };
    }
    match environment(settings)? {
        AnyEnvironment::Vectors(env) => {
            let same = |env| if let AnyEnvironment::Vectors(env) = env { Some(env as _) } else { None };
            let lanes = lanes::<BoxedEnvironment<Vector, Vector>>(env, settings, same)?;
            lanes.pair(config, |entry| entry.continuous)
        }
        AnyEnvironment::Choices(env) => {
            let same = |env| if let AnyEnvironment::Choices(env) = env { Some(env as _) } else { None };
            let lanes = lanes::<BoxedEnvironment<Vector, usize>>(env, settings, same)?;
            lanes.pair(config, |entry| entry.discrete)
        }
        AnyEnvironment::Frames(_) if entry.pictured.is_none() => Err(blind(settings)),
        AnyEnvironment::Frames(env) => {
            let same = |env| if let AnyEnvironment::Frames(env) = env { Some(env as _) } else { None };
            let lanes = lanes::<BoxedEnvironment<Frame, usize>>(env, settings, same)?;
            lanes.pair(config, |entry| entry.pictured)
        }
    }
}

/// The environments of a run: one a lane, and one for evaluations where training episodes begin elsewhere.
struct Lanes<E> {
    training: Vec<E>,
    evaluation: Option<E>,
}

/// The environments of a run that evaluates in `stage`. `same` takes another one for what they all are.
fn lanes<E>(
    stage: E,
    settings: &Settings,
    same: fn(AnyEnvironment) -> Option<E>,
) -> Result<Lanes<E>, ConfigError> {
    let made = |_| training_environment(settings).map(same);
    let lanes = |from: u64| (from..settings.lanes).map(made).collect::<Result<Option<Vec<_>>, _>>();
    let unlike = "an environment is of the same kind wherever its episodes begin";
    Ok(match settings.starts.is_empty() {
        true => {
            let mut training = vec![stage];
            training.extend(lanes(1)?.expect(unlike));
            Lanes { training, evaluation: None }
        }
        false => Lanes { training: lanes(0)?.expect(unlike), evaluation: Some(stage) },
    })
}

/// What is said to an agent that reads no pictures where there are only those.
fn blind(settings: &Settings) -> ConfigError {
    let Settings { agent, environment, .. } = settings;
    let seeing = names(|entry| entry.pictured.is_some());
    ConfigError::World(format!(
        "`{environment}` is seen as pictures, which agent `{agent}` does not read; these do: {seeing}. Or see it as symbols: \
         --see symbols"
    ))
}

/// The names of some agents.
fn names(of: impl Fn(&AgentEntry) -> bool) -> String {
    assembly::agents().filter(|entry| of(entry)).map(|entry| entry.name).collect::<Vec<_>>().join(", ")
}

/// Builds the environment of a run.
///
/// # Errors
/// As [`world`].
pub fn environment(settings: &Settings) -> Result<AnyEnvironment, ConfigError> {
    world(&settings.environment, &settings.world)
}

/// Builds the environment that a run trains in: the same, with episodes that begin where [`Settings::starts`] says.
fn training_environment(settings: &Settings) -> Result<AnyEnvironment, ConfigError> {
    let starts = match settings.starts.as_str() {
        "" => None,
        "anywhere" => Some(Starts::Anywhere),
        other => {
            let why =
                format!("starts is \"{other}\"; it must be \"anywhere\", or empty for the environment's own");
            return Err(ConfigError::Impossible { table: "the run's settings".into(), why });
        }
    };
    settings.world.with_options(|own| registry::make_with(&settings.environment, &Options { starts, ..*own }))
}

/// Builds an environment of the registry with a map, scale or body of the user's own.
///
/// # Errors
/// [`ConfigError`] when there is no such environment, or the map or body is at fault.
pub fn world(name: &str, own: &World) -> Result<AnyEnvironment, ConfigError> {
    own.with_options(|options| registry::make_with(name, options))
}

/// Builds the session of environments of your own, with continuous actions: one, or as many alike as there are
/// [`Settings::lanes`].
///
/// # Errors
/// [`ConfigError`] when the agent is unknown, or cannot act with such actions or in several lanes.
pub fn continuous(
    envs: Vec<BoxedEnvironment<Vector, Vector>>,
    config: &Config,
) -> Result<Box<dyn Session>, ConfigError> {
    own(envs, config, |entry| entry.continuous)
}

/// Builds the session of environments of your own, whose actions are choices.
///
/// # Errors
/// As [`continuous`].
pub fn discrete(
    envs: Vec<BoxedEnvironment<Vector, usize>>,
    config: &Config,
) -> Result<Box<dyn Session>, ConfigError> {
    own(envs, config, |entry| entry.discrete)
}

/// Builds the session of an environment of your own that tells which proto-goals hold, and whose actions are choices.
///
/// # Errors
/// As [`continuous`].
pub fn annotated(
    envs: Vec<BoxedEnvironment<Annotated<Vector>, usize>>,
    config: &Config,
) -> Result<Box<dyn Session>, ConfigError> {
    own(envs, config, |entry| entry.annotated)
}

/// Builds the session of an environment of your own that is seen as pictures, and whose actions are choices.
///
/// # Errors
/// As [`continuous`].
pub fn pictured(
    envs: Vec<BoxedEnvironment<Frame, usize>>,
    config: &Config,
) -> Result<Box<dyn Session>, ConfigError> {
    own(envs, config, |entry| entry.pictured)
}

/// An environment with observations of type `O` and actions of type `A`.
pub type BoxedEnvironment<O, A> = Box<dyn Environment<Observation = O, Action = A> + Send>;

/// A session of somebody's own environments, which are evaluated in where they are trained in.
fn own<O: Kind<A> + 'static, A: Clone + Into<Action> + 'static>(
    training: Vec<BoxedEnvironment<O, A>>,
    config: &Config,
    of: fn(&AgentEntry) -> Option<Build<O, A>>,
) -> Result<Box<dyn Session>, ConfigError> {
    if !config.settings.starts.is_empty() {
        let why =
            "starts chooses among the registry's; environments of your own begin where they do".to_owned();
        return Err(ConfigError::Impossible { table: "the run's settings".into(), why });
    }
    Lanes { training, evaluation: None }.pair(config, of)
}

impl<O: Kind<A> + 'static, A: Clone + Into<Action> + 'static> Lanes<BoxedEnvironment<O, A>> {
    /// The session of these environments and the configuration's agent.
    fn pair(
        self,
        config: &Config,
        of: fn(&AgentEntry) -> Option<Build<O, A>>,
    ) -> Result<Box<dyn Session>, ConfigError> {
        let Self { training: envs, evaluation } = self;
        let settings = &config.settings;
        let Some(build) = of(assembly::agent(&settings.agent)?) else {
            return Err(ConfigError::UnknownName(format!(
                "agent `{}` cannot act in `{}`, whose observations or actions are of another kind; these can: {}",
                settings.agent,
                settings.environment,
                names(|entry| of(entry).is_some())
            )));
        };
        if envs.len() as u64 != settings.lanes {
            let why = format!("lanes is {}, and there are {} environments", settings.lanes, envs.len());
            return Err(ConfigError::Impossible { table: "the run's settings".into(), why });
        }
        let seed = Seed(settings.seed);
        let mut agent = build(envs[0].spec(), &config.agent, settings.backend, seed)?;
        if settings.lanes > 1 && agent.crowd().is_none() {
            let usual = |e: &&AgentEntry| {
                of(e).and_then(|build| build(envs[0].spec(), &(e.defaults)(), settings.backend, seed).ok())
            };
            let able =
                assembly::agents().filter(|e| usual(e).is_some_and(|mut agent| agent.crowd().is_some()));
            let why = format!(
                "lanes is {}, and agent `{}` lives one episode at a time; set lanes = 1, or take an agent that lives several: {}",
                settings.lanes,
                settings.agent,
                able.map(|e| e.name).collect::<Vec<_>>().join(", ")
            );
            return Err(ConfigError::Impossible { table: "the run's settings".into(), why });
        }
        Ok(Box::new(Pair::new(envs, evaluation, agent, seed)))
    }
}
