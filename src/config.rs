//! The configuration of a run: one TOML table in which every value stands, defaults included.
//!
//! A run's settings stand at the top level, its agent's in tables below. The defaults of the agent say which keys
//! there are and what type each has, so an unknown key or a wrong type is named before anything is built.

use std::{fs, path::Path, str::FromStr};

use inroads_agents::nets::Backend;
use inroads_envs::{
    registry::{AnyEnvironment, MakeError, Options, nearest},
    world::WordError,
};
use inroads_sim::rigid::Model;
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use toml::{Table, Value};

use crate::{assembly, session};

/// What is wrong with a configuration.
#[derive(Debug, thiserror::Error)]
pub enum ConfigError {
    /// A file cannot be read.
    #[error("cannot read the configuration {path}: {why}")]
    Unreadable {
        /// The file.
        path: String,
        /// What the system says.
        why: String,
    },
    /// A file is not TOML.
    #[error("{path} is not valid TOML: {why}")]
    Malformed {
        /// The file.
        path: String,
        /// What and where.
        why: String,
    },
    /// A key that no setting has.
    #[error("there is no setting `{key}`; did you mean `{nearest}`?")]
    UnknownKey {
        /// The key, from the top.
        key: String,
        /// The setting whose name is nearest.
        nearest: String,
    },
    /// A value of another type than the setting's.
    #[error("`{key}` is {found}, but must be {expected} (its default is {default})")]
    WrongType {
        /// The key, from the top.
        key: String,
        /// The type that was found.
        found: &'static str,
        /// The type of the setting.
        expected: &'static str,
        /// The setting's default.
        default: String,
    },
    /// A count below zero.
    #[error("`{key}` is {value}; it counts something, so it must be 0 or above")]
    Negative {
        /// The key, from the top.
        key: String,
        /// The value.
        value: i64,
    },
    /// A value that the setting cannot have.
    #[error("in `{table}`: {why}")]
    Impossible {
        /// The table.
        table: String,
        /// What is wrong and how to mend it.
        why: String,
    },
    /// An argument of `--set` without a value.
    #[error("`--set {0}` has no value; write `--set key=value`")]
    NoValue(String),
    /// A map or a body that makes no world.
    #[error("{0}")]
    World(String),
    /// A name that is in no registry.
    #[error("{0}")]
    UnknownName(String),
}

/// The settings that every run has, whatever its agent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// The agent's name in the registry.
    pub agent: String,
    /// The environment's name in the registry.
    pub environment: String,
    /// The seed from which every random stream of the run comes.
    pub seed: u64,
    /// The backend of Burn.
    pub backend: Backend,
    /// Training episodes. Where there are several lanes, the last round is played to its end.
    pub episodes: u64,
    /// Episodes that are played side by side, at least 1; more where the agent lives several at a time. Then actions are
    /// chosen together, and an episode does not know yet what those beside it teach.
    pub lanes: u64,
    /// Training ends after the episode that reaches this many steps of the environment; 0: no such bound.
    pub max_steps: u64,
    /// Frozen, noise-free episodes after training.
    pub evaluation_episodes: u64,
    /// Where training episodes begin: `anywhere` in the free space of a maze; empty for the environment's own starts, which
    /// frozen episodes always have (`decisions.md`: starts in training, chapter 4).
    pub starts: String,
    /// After every so many training episodes frozen ones are rolled out, and `tests.jsonl` tells of them; 0: never.
    pub test_every: u64,
    /// How many frozen episodes each time.
    pub test_episodes: u64,
    /// A checkpoint is written every so many episodes.
    pub checkpoint_every: u64,
    /// What is another in the environment than the registry has it.
    pub world: World,
}

/// A maze and a body of the user's own, as text, so that a run's folder needs no other file; and how a world is seen.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct World {
    /// The maze as a text map; empty for the environment's own.
    pub map: String,
    /// The side of a cell, metres; 0 for the environment's own.
    pub scale: f64,
    /// The body as MJCF; empty for the environment's own.
    pub body: String,
    /// How a world of cells or sprites is seen: `symbols`, `rgb`, `grey`, `rgb:84`, `grey:84`, `atari`; empty for the
    /// environment's own way.
    pub see: String,
    /// Which layouts its episodes have: `random`, `fixed:42`, `map:42`; empty for the environment's own.
    pub layout: String,
}

/// A whole configuration, checked.
#[derive(Clone, Debug, PartialEq)]
pub struct Config {
    /// The run's settings.
    pub settings: Settings,
    /// The agent's tables.
    pub agent: Table,
}

/// Steps that an agent remembers at most, unless it is told otherwise, where it sees pictures: of 40 by 40 pixels in
/// colour (DoorKey-5x5) that is half a gigabyte, of 84 by 84 in grey 0.7.
const PICTURES: i64 = 100_000;

impl World {
    /// Asks the registry with what is set here.
    ///
    /// # Errors
    /// [`ConfigError`] when the body cannot be read, or as the registry answers.
    pub fn with_options<T>(
        &self,
        ask: impl FnOnce(&Options<'_>) -> Result<T, MakeError>,
    ) -> Result<T, ConfigError> {
        let body = (!self.body.is_empty()).then(|| Model::from_mjcf(&self.body)).transpose();
        let body = body.map_err(|why| ConfigError::World(why.to_string()))?;
        let options = Options {
            map: (!self.map.is_empty()).then_some(self.map.as_str()),
            scale: (self.scale != 0.0).then_some(self.scale),
            body: body.as_ref(),
            see: word(&self.see)?,
            layout: word(&self.layout)?,
            ..Options::default()
        };
        ask(&options).map_err(|why| match why {
            MakeError::Unknown(unknown) => ConfigError::UnknownName(unknown.to_string()),
            other => ConfigError::World(other.to_string()),
        })
    }
}

/// What a user's word means; nothing when there is none.
fn word<T: FromStr<Err = WordError>>(word: &str) -> Result<Option<T>, ConfigError> {
    let meaning = (!word.is_empty()).then(|| word.parse()).transpose();
    meaning.map_err(|why: WordError| ConfigError::World(why.to_string()))
}

impl Config {
    /// The defaults of an agent in an environment: its own, with what suits the environment ([`assembly::suits`]).
    ///
    /// # Errors
    /// [`ConfigError::UnknownName`] with the nearest name.
    pub fn defaults(agent: &str, environment: &str) -> Result<Self, ConfigError> {
        let entry = assembly::agent(agent)?;
        let settings = Settings {
            agent: agent.to_owned(),
            environment: environment.to_owned(),
            seed: 0,
            backend: Backend::default(),
            episodes: 300,
            lanes: 1,
            max_steps: 0,
            evaluation_episodes: 20,
            starts: String::new(),
            test_every: 0,
            test_episodes: 1,
            checkpoint_every: 25,
            world: World {
                layout: assembly::usual_layout(agent, environment).to_owned(),
                ..World::default()
            },
        };
        let defaults = Self { settings, agent: (entry.defaults)() };
        defaults.overlaid(&assembly::suits(agent, environment).collect::<Vec<_>>())
    }

    /// The defaults with what is asked for in their place: `ask` puts it there. How the world is seen is among that, and some
    /// defaults depend on it.
    ///
    /// # Errors
    /// [`ConfigError`] names what there is not, or the key and the mend.
    pub fn asked(
        agent: &str,
        environment: &str,
        ask: impl Fn(Self) -> Result<Self, ConfigError>,
    ) -> Result<Self, ConfigError> {
        let defaults = Self::defaults(agent, environment)?;
        let world = ask(defaults.clone())?.settings.world;
        let Self { settings, agent } = defaults;
        ask(Self { settings: Settings { world, ..settings }, agent }.fitted()?)
    }

    /// The same with a memory that pictures fit in, where the environment, as it is set, is seen as pictures.
    ///
    /// # Errors
    /// [`ConfigError`] when there is no such environment.
    pub fn fitted(mut self) -> Result<Self, ConfigError> {
        if let AnyEnvironment::Frames(_) = session::environment(&self.settings)?
            && let Some(Value::Table(memory)) = self.agent.get_mut("memory")
            && let Some(Value::Integer(capacity)) = memory.get_mut("capacity")
        {
            *capacity = (*capacity).min(PICTURES);
        }
        Ok(self)
    }

    /// The same with a file's values in the place of its own.
    ///
    /// # Errors
    /// [`ConfigError`] names the file, or the key and the mend.
    pub fn with_file(self, path: &Path) -> Result<Self, ConfigError> {
        self.overlaid([&read(path)?])
    }

    /// The same with one value in the place of its own: `key=value`, the key dotted, the value TOML or a word.
    ///
    /// # Errors
    /// [`ConfigError`] names the key and the mend.
    pub fn with_assignment(self, assignment: &str) -> Result<Self, ConfigError> {
        self.with_assignments([assignment])
    }

    /// The same with several values, which are checked together: each may need the others.
    ///
    /// # Errors
    /// As [`with_assignment`](Self::with_assignment).
    pub fn with_assignments<'a>(
        self,
        assignments: impl IntoIterator<Item = &'a str>,
    ) -> Result<Self, ConfigError> {
        let tables = assignments.into_iter().map(assigned).collect::<Result<Vec<_>, _>>()?;
        self.overlaid(&tables)
    }

    /// Reads a whole configuration, as a run folder has it.
    ///
    /// # Errors
    /// [`ConfigError`] names the file, or the key and the mend.
    pub fn read(path: &Path) -> Result<Self, ConfigError> {
        let table = read(path)?;
        let name = |key: &str| table.get(key).and_then(Value::as_str).unwrap_or_default();
        Self::defaults(name("agent"), name("environment"))?.overlaid([&table])
    }

    /// Every value, as TOML.
    pub fn to_toml(&self) -> String {
        toml::to_string(&self.table()).expect("a table of plain values is always TOML")
    }

    fn table(&self) -> Table {
        let mut table = Table::try_from(&self.settings).expect("settings are plain values");
        table.extend(self.agent.clone());
        table
    }

    /// The same with the values of some tables in the place of its own, the last one's before all others'. They are checked
    /// together: each may need the others.
    ///
    /// # Errors
    /// [`ConfigError`] names the key and the mend.
    pub fn overlaid<'a>(self, overs: impl IntoIterator<Item = &'a Table>) -> Result<Self, ConfigError> {
        let mut table = self.table();
        overs.into_iter().try_for_each(|over| overlay(&mut table, over, ""))?;
        let (settings, agent) =
            table.into_iter().partition::<Table, _>(|(key, _)| !self.agent.contains_key(key));
        let settings: Settings = section(settings, "the run's settings")?;
        if settings.checkpoint_every == 0 || settings.episodes == 0 || settings.lanes == 0 {
            let why = "episodes, lanes and checkpoint_every must be at least 1".to_owned();
            return Err(ConfigError::Impossible { table: "the run's settings".into(), why });
        }
        let entry = assembly::agent(&settings.agent)?;
        (entry.check)(&agent)?;
        Ok(Self { settings, agent })
    }
}

/// The table in which `key=value` is all there is.
fn assigned(assignment: &str) -> Result<Table, ConfigError> {
    let (key, value) =
        assignment.split_once('=').ok_or_else(|| ConfigError::NoValue(assignment.to_owned()))?;
    let value = format!("v = {value}")
        .parse::<Table>()
        .ok()
        .and_then(|mut table| table.remove("v"))
        .unwrap_or_else(|| Value::String(value.to_owned()));
    let within = |value, part: &str| Value::Table(Table::from_iter([(part.to_owned(), value)]));
    match key.trim().rsplit('.').fold(value, within) {
        Value::Table(table) => Ok(table),
        _ => Err(ConfigError::NoValue(assignment.to_owned())),
    }
}

/// Reads one table of an agent's settings.
///
/// # Errors
/// [`ConfigError::Impossible`] names the table.
pub fn section<T: DeserializeOwned>(table: Table, name: &str) -> Result<T, ConfigError> {
    table.try_into().map_err(|e: toml::de::Error| ConfigError::Impossible {
        table: name.to_owned(),
        why: e.message().into(),
    })
}

fn read(path: &Path) -> Result<Table, ConfigError> {
    let shown = path.display().to_string();
    let text = fs::read_to_string(path)
        .map_err(|e| ConfigError::Unreadable { path: shown.clone(), why: e.to_string() })?;
    text.parse().map_err(|e: toml::de::Error| ConfigError::Malformed { path: shown, why: e.to_string() })
}

/// Puts the values of `over` in the place of `base`'s, which has every key there is.
fn overlay(base: &mut Table, over: &Table, prefix: &str) -> Result<(), ConfigError> {
    for (name, value) in over {
        let key = format!("{prefix}{name}");
        let names: Vec<_> = base.keys().cloned().collect();
        let Some(present) = base.get_mut(name) else {
            let nearest = nearest(name, names.iter().map(String::as_str)).unwrap_or_default();
            return Err(ConfigError::UnknownKey { key, nearest: format!("{prefix}{nearest}") });
        };
        match (present, value) {
            (Value::Table(base), Value::Table(over)) => overlay(base, over, &format!("{key}."))?,
            (Value::Integer(_), Value::Integer(n)) if *n < 0 => {
                return Err(ConfigError::Negative { key, value: *n });
            }
            (Value::Float(x), Value::Integer(n)) => *x = *n as f64,
            // The kernel's width is a word or a number.
            (present, value) if present.same_type(value) || name == "gamma" => *present = value.clone(),
            (present, value) => {
                return Err(ConfigError::WrongType {
                    key,
                    found: value.type_str(),
                    expected: present.type_str(),
                    default: present.to_string(),
                });
            }
        }
    }
    Ok(())
}
