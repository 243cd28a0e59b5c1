//! An agent in an environment, whatever their kinds.

use inroads_agents::{Actor, Bag, Context, Corrupt, Summary, episode};
use inroads_discovery::SkillRecord;
use inroads_envs::{
    Environment, Refused, Seed, Spec,
    registry::{self, AnyEnvironment},
};
use serde::{Deserialize, Serialize};

use crate::{
    assembly::{self, AGENTS, BoxedAgent, Build, Vector},
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
    /// Learned skills after it.
    pub skills: usize,
    /// Steps of it that learned skills took.
    pub skill_steps: u32,
    /// Updates made so far, by network.
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

/// A watched episode, for pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct Watched {
    /// Every observation, and the skill that acted there (0: a primitive action); the last one's is the one
    /// before's.
    pub path: Vec<(Vector, usize)>,
    /// The seed that the episode began with.
    pub start: u64,
    /// What was done; with the seed it is the whole episode.
    pub actions: Vec<Action>,
    /// What it came to.
    pub summary: Summary,
}

impl Watched {
    /// Share of its steps that learned skills took.
    pub fn skill_share(&self) -> f64 {
        let steps = self.path.len() - 1;
        let skilled = self.path[..steps].iter().filter(|(_, skill)| *skill > 0).count();
        skilled as f64 / steps.max(1) as f64
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

    /// Trains for one episode.
    ///
    /// # Errors
    /// The action that the environment refused.
    fn train(&mut self) -> Result<EpisodeMetrics, Refused>;

    /// Episodes trained so far, and steps of the environment in them.
    fn progress(&self) -> (u64, u64);

    /// Evaluation episode number `index`; none when the agent has nothing to act with under that protocol.
    ///
    /// # Errors
    /// The action that the environment refused.
    fn evaluate(&mut self, protocol: Protocol, index: u64) -> Result<Option<Watched>, Refused>;

    /// The agent's skills.
    fn skills(&self) -> Vec<SkillRecord>;

    /// Of all skills: whether the observation is in its initiation set.
    fn members(&self, observation: &Vector) -> Vec<bool>;

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
    match environment(&config.settings)? {
        AnyEnvironment::Vectors(env) => continuous(env, config),
        AnyEnvironment::Choices(env) => discrete(env, config),
        AnyEnvironment::Frames(_) => Err(ConfigError::World(format!(
            "`{}` is seen as pictures, which no agent reads yet; see it as symbols: --see symbols",
            config.settings.environment
        ))),
    }
}

/// Builds the environment of a run.
///
/// # Errors
/// As [`world`].
pub fn environment(settings: &Settings) -> Result<AnyEnvironment, ConfigError> {
    world(&settings.environment, &settings.world)
}

/// Builds an environment of the registry with a map, scale or body of the user's own.
///
/// # Errors
/// [`ConfigError`] when there is no such environment, or the map or body is at fault.
pub fn world(name: &str, own: &World) -> Result<AnyEnvironment, ConfigError> {
    own.with_options(|options| registry::make_with(name, options))
}

/// Builds the session of an environment of your own, with continuous actions.
///
/// # Errors
/// [`ConfigError`] when the agent is unknown, or cannot act with such actions.
pub fn continuous(env: BoxedEnvironment<Vec<f32>>, config: &Config) -> Result<Box<dyn Session>, ConfigError> {
    let build = assembly::agent(&config.settings.agent)?.continuous;
    pair(env, build, config, |e| e.continuous.is_some())
}

/// Builds the session of an environment of your own, whose actions are choices.
///
/// # Errors
/// As [`continuous`].
pub fn discrete(env: BoxedEnvironment<usize>, config: &Config) -> Result<Box<dyn Session>, ConfigError> {
    let build = assembly::agent(&config.settings.agent)?.discrete;
    pair(env, build, config, |e| e.discrete.is_some())
}

/// An environment with actions of type `A`.
pub type BoxedEnvironment<A> = Box<dyn Environment<Observation = Vector, Action = A> + Send>;

fn pair<A: Clone + Into<Action> + 'static>(
    env: BoxedEnvironment<A>,
    build: Option<Build<A>>,
    config: &Config,
    fits: fn(&assembly::AgentEntry) -> bool,
) -> Result<Box<dyn Session>, ConfigError> {
    let settings = &config.settings;
    let Some(build) = build else {
        let fitting: Vec<_> = AGENTS.iter().filter(|e| fits(e)).map(|e| e.name).collect();
        return Err(ConfigError::UnknownName(format!(
            "agent `{}` cannot act in `{}`, whose actions are of another kind; these can: {}",
            settings.agent,
            settings.environment,
            fitting.join(", ")
        )));
    };
    let seed = Seed(settings.seed);
    let agent = build(env.spec(), &config.agent, settings.backend, seed)?;
    Ok(Box::new(Pair { env, agent, seed, episodes: 0, env_steps: 0 }))
}

struct Pair<A> {
    env: BoxedEnvironment<A>,
    agent: BoxedAgent<A>,
    seed: Seed,
    episodes: u64,
    env_steps: u64,
}

impl<A: Clone + Into<Action>> Session for Pair<A> {
    fn spec(&self) -> &Spec {
        self.env.spec()
    }

    fn train(&mut self) -> Result<EpisodeMetrics, Refused> {
        let number = self.episodes;
        let mut ctx = Context::training(self.seed, number);
        let mut skill_steps = 0;
        let start = self.seed.number("train-start", number);
        let summary = episode(&mut *self.env, &mut *self.agent, start, &mut ctx, |_, source| {
            skill_steps += u32::from(source > 0);
        })?;
        self.episodes += 1;
        self.env_steps += u64::from(summary.steps);
        Ok(EpisodeMetrics {
            episode: number,
            env_steps: self.env_steps,
            steps: summary.steps,
            reward: summary.reward,
            success: summary.success,
            skills: self.agent.skills().len(),
            skill_steps,
            updates: self.agent.updates().into_iter().map(|(name, n)| (name.to_owned(), n)).collect(),
            fault: summary.fault,
        })
    }

    fn progress(&self) -> (u64, u64) {
        (self.episodes, self.env_steps)
    }

    fn evaluate(&mut self, protocol: Protocol, index: u64) -> Result<Option<Watched>, Refused> {
        let actor: Option<Box<dyn Actor<Vector, A> + '_>> = match protocol {
            Protocol::Frozen => Some(self.agent.frozen()),
            Protocol::ChainAlone => self.agent.chain_alone(),
        };
        let Some(mut actor) = actor else { return Ok(None) };
        let mut ctx = Context::evaluation(self.seed, index);
        let start = self.seed.number("evaluate-start", index);
        let (mut path, mut actions) = (Vec::new(), Vec::new());
        let summary = episode(&mut *self.env, &mut *actor, start, &mut ctx, |t, source| {
            if path.is_empty() {
                path.push((t.before.clone(), source));
            }
            if let Some((_, skill)) = path.last_mut() {
                *skill = source;
            }
            path.push((t.after.clone(), source));
            actions.push(t.action.clone().into());
        })?;
        Ok(Some(Watched { path, start, actions, summary }))
    }

    fn skills(&self) -> Vec<SkillRecord> {
        self.agent.skills()
    }

    fn members(&self, observation: &Vector) -> Vec<bool> {
        self.agent.members(observation)
    }

    fn save(&self) -> Bag {
        let mut bag = Bag::default();
        bag.put("progress", &(self.episodes, self.env_steps));
        bag.put_part("agent", &*self.agent);
        bag
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        (self.episodes, self.env_steps) = bag.get("progress")?;
        bag.get_part("agent", &mut *self.agent)
    }
}
