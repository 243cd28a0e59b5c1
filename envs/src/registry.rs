//! Environments by name.

use inroads_sim::rigid::Model;

use crate::maze::{
    self, MazeError, Picture, Starts,
    catalogue::{Listed, Walker},
};
use crate::{Domain, Environment, Refused, Spec, Step, corridor, manipulation, reacher};

/// An environment of one of the kinds of observation and action that there are.
pub enum AnyEnvironment {
    /// Vectors seen, vectors done.
    Vectors(Box<dyn Domain<Vec<f32>, Vec<f32>>>),
    /// Vectors seen, one of several choices done.
    Choices(Box<dyn Domain<Vec<f32>, usize>>),
}

impl AnyEnvironment {
    /// What agents may know of it.
    pub fn spec(&self) -> &Spec {
        match self {
            Self::Vectors(env) => env.spec(),
            Self::Choices(env) => env.spec(),
        }
    }
}

/// One environment of the registry.
pub struct Entry {
    /// Its name.
    pub name: &'static str,
    /// One sentence.
    pub about: &'static str,
    pub(crate) make: fn() -> AnyEnvironment,
    pub(crate) picture: fn() -> Option<Picture>,
}

impl Entry {
    /// Builds the environment.
    pub fn make(&self) -> AnyEnvironment {
        (self.make)()
    }
}

/// All environments, in the order in which they are listed. The entries stand beside their domains.
pub fn entries() -> impl Iterator<Item = &'static Entry> {
    [maze::ENTRIES, reacher::ENTRIES, corridor::ENTRIES, manipulation::ENTRIES].into_iter().flatten()
}

/// There is no environment of that name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no environment `{name}`; did you mean `{}`? All environments: {}", nearest.unwrap_or_default(), all())]
pub struct Unknown {
    /// The name.
    pub name: String,
    /// The nearest name that there is.
    pub nearest: Option<&'static str>,
}

/// Builds the environment of that name.
///
/// # Errors
/// [`Unknown`] names the nearest one, and all.
pub fn make(name: &str) -> Result<AnyEnvironment, Unknown> {
    entry(name).map(Entry::make)
}

/// What a user may change of a maze. `Options::default()` changes nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Options<'a> {
    /// Another map, as [`CellMap::parse`](inroads_sim::rigid::CellMap::parse) reads it.
    pub map: Option<&'a str>,
    /// Another side of a cell, metres.
    pub scale: Option<f64>,
    /// Another goal, metres from the map's first start.
    pub goal: Option<[f64; 2]>,
    /// Other starts.
    pub starts: Option<Starts<'a>>,
    /// Another body in the ant's place.
    pub body: Option<&'a Model>,
}

impl Options<'_> {
    /// The names of the options that are set.
    fn set(&self) -> impl Iterator<Item = &'static str> {
        [
            ("map", self.map.is_some()),
            ("scale", self.scale.is_some()),
            ("goal", self.goal.is_some()),
            ("starts", self.starts.is_some()),
            ("body", self.body.is_some()),
        ]
        .into_iter()
        .filter_map(|(name, set)| set.then_some(name))
    }
}

/// Why an environment cannot be built as it is asked for.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MakeError {
    /// There is no environment of that name.
    #[error(transparent)]
    Unknown(#[from] Unknown),
    /// The environment does not take an option.
    #[error("`{name}` takes no option `{option}`; {}", takers(option))]
    Option {
        /// The environment.
        name: &'static str,
        /// The option.
        option: &'static str,
    },
    /// An option has a value that makes no maze.
    #[error("`{name}`: {why}")]
    Maze {
        /// The environment.
        name: &'static str,
        /// What is wrong.
        why: MazeError,
    },
}

/// Who takes an option.
fn takers(option: &str) -> &'static str {
    match option {
        "body" => "the mazes of the ant do",
        _ => "the mazes of point and ant do",
    }
}

/// Builds the environment of that name with a user's changes.
///
/// # Errors
/// [`MakeError`] names the option that the environment does not take, or says what is wrong with its value:
/// with a map, line and column.
pub fn make_with(name: &str, options: &Options<'_>) -> Result<AnyEnvironment, MakeError> {
    let entry = entry(name)?;
    match changed(entry, options)? {
        Some(maze) => maze.build(options).map_err(|why| MakeError::Maze { name: entry.name, why }),
        None => Ok(entry.make()),
    }
}

/// The environment with a user's changes seen from above, for figures; none when there is nothing to draw.
///
/// # Errors
/// As [`make_with`].
pub fn picture_with(name: &str, options: &Options<'_>) -> Result<Option<Picture>, MakeError> {
    let entry = entry(name)?;
    match changed(entry, options)? {
        Some(maze) => {
            maze.picture(options).map(Some).map_err(|why| MakeError::Maze { name: entry.name, why })
        }
        None => Ok((entry.picture)()),
    }
}

/// The maze that the options change; none when they change nothing.
fn changed(entry: &'static Entry, options: &Options<'_>) -> Result<Option<Listed>, MakeError> {
    let maze = Listed::find(entry.name);
    let takes = |option: &str| match (maze, option) {
        (None, _) => false,
        (Some(maze), "body") => !matches!(maze.walker, Walker::Point(_)),
        (Some(_), _) => true,
    };
    match options.set().find(|option| !takes(option)) {
        Some(option) => Err(MakeError::Option { name: entry.name, option }),
        None => Ok(maze.filter(|_| *options != Options::default())),
    }
}

fn entry(name: &str) -> Result<&'static Entry, Unknown> {
    entries().find(|entry| entry.name == name).ok_or_else(|| Unknown {
        name: name.to_owned(),
        nearest: nearest(name, entries().map(|entry| entry.name)),
    })
}

fn all() -> String {
    entries().map(|entry| entry.name).collect::<Vec<_>>().join(", ")
}

/// The candidate that the fewest insertions, deletions and replacements turn into `name`.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    candidates.into_iter().min_by_key(|candidate| distance(name, candidate))
}

/// Levenshtein's distance, one row of the table at a time.
fn distance(a: &str, b: &str) -> usize {
    let mut row: Vec<usize> = (0..=b.chars().count()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = std::mem::replace(&mut row[0], i + 1);
        for (j, y) in b.chars().enumerate() {
            let replaced = diagonal + usize::from(x != y);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.chars().count()]
}

impl<E: Environment + ?Sized> Environment for Box<E> {
    type Observation = E::Observation;
    type Action = E::Action;

    fn spec(&self) -> &Spec {
        (**self).spec()
    }

    fn reset(&mut self, seed: u64) {
        (**self).reset(seed);
    }

    fn step(&mut self, action: &Self::Action) -> Result<Step, Refused> {
        (**self).step(action)
    }

    fn observe(&self, out: &mut Self::Observation) {
        (**self).observe(out);
    }

    fn fault(&self) -> Option<&str> {
        (**self).fault()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::{self, check};

    #[test]
    fn every_environment_keeps_the_contract_and_its_name() {
        for entry in entries() {
            let env = entry.make();
            assert_eq!(env.spec().name, entry.name);
            // A thousand steps of an ant take a tenth of a second; one seed, played three times, has to do.
            let options = check::Options {
                episodes: if entry.name.starts_with("ant-") { 1 } else { 4 },
                ..Default::default()
            };
            let verdict = match env {
                AnyEnvironment::Vectors(mut env) => check(&mut env, options),
                AnyEnvironment::Choices(mut env) => check(&mut env, options),
            };
            verdict.unwrap_or_else(|fault| panic!("{}: {fault}", entry.name));
        }
    }

    #[test]
    fn an_unknown_name_is_answered_with_the_nearest() {
        let error = make("point-mze").err().unwrap();
        assert_eq!(error.nearest, Some("point-maze"));
        let text = error.to_string();
        assert!(text.contains("did you mean `point-maze`?") && text.contains("corridor-5"), "{text}");
        let picture = |name| picture_with(name, &super::Options::default());
        assert!(picture("point-mze").is_err());
        assert!(picture("corridor-5").unwrap().is_none() && picture("point-maze").unwrap().is_some());
    }

    #[test]
    fn distances_are_levenshteins() {
        assert_eq!(distance("kitten", "sitting"), 3);
        assert_eq!((distance("", "abc"), distance("abc", ""), distance("ab", "ab")), (3, 3, 0));
    }
}
