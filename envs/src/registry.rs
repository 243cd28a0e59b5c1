//! Environments by name.

use inroads_sim::{raster::FormatError, rigid::Model};

use crate::certificate::{self, Certificate};
use crate::maze::{
    self, MazeError, Picture, Starts,
    catalogue::{Listed, Walker},
};
use crate::world::{AnnotatedWorld, AnyWorld, Layout, Question, See, Wanted};
use crate::{Annotated, Domain, Environment, Frame, Refused, Spec, Step};
use crate::{
    ant_run, baba, corridor, grid, manipulation, montezuma, pinball, probes, reacher, recall, river, rooms,
    sokoban, taxi, visual_grid, visual_taxi,
};

/// An environment of one of the kinds of observation and action that there are.
pub enum AnyEnvironment {
    /// Vectors seen, vectors done.
    Vectors(Box<dyn Domain<Vec<f32>, Vec<f32>>>),
    /// Vectors seen, one of several choices done.
    Choices(Box<dyn Domain<Vec<f32>, usize>>),
    /// Pictures seen, one of several choices done.
    Frames(Box<dyn Domain<Frame, usize>>),
}

/// An environment whose observations tell which proto-goals hold.
pub enum AnyAnnotated {
    /// Vectors seen, one of several choices done.
    Vectors(Box<dyn Domain<Annotated<Vec<f32>>, usize>>),
    /// Pictures seen, one of several choices done.
    Frames(Box<dyn Domain<Annotated<Frame>, usize>>),
}

impl AnyEnvironment {
    /// What agents may know of it.
    pub fn spec(&self) -> &Spec {
        match self {
            Self::Vectors(env) => env.spec(),
            Self::Choices(env) => env.spec(),
            Self::Frames(env) => env.spec(),
        }
    }
}

/// One environment of the registry.
pub struct Entry {
    /// Its name.
    pub name: &'static str,
    /// One sentence.
    pub about: &'static str,
    pub(crate) make: Make,
}

/// What an environment of the registry is made of.
pub(crate) enum Make {
    /// Bodies, or what is simple enough to be made in one way only.
    Bodies { make: fn() -> AnyEnvironment, picture: fn() -> Option<Picture> },
    /// A world that can be seen in several ways.
    World(fn() -> Box<dyn AnyWorld>),
    /// A world that has proto-goals too.
    Annotated(fn() -> Box<dyn AnnotatedWorld>),
}

impl Entry {
    /// Builds the environment.
    pub fn make(&self) -> AnyEnvironment {
        let made = match self.make {
            Make::Bodies { make, .. } => Ok(make()),
            Make::World(_) | Make::Annotated(_) => self.seen(&Options::default()),
        };
        made.expect("the worlds of this crate are seen in formats that exist")
    }

    /// Builds it as it is asked for, if it is a world.
    fn seen(&self, options: &Options<'_>) -> Result<AnyEnvironment, MakeError> {
        let wanted = self.wanted(options);
        let made = match self.make {
            Make::Bodies { make, .. } => Ok(make()),
            Make::World(world) => world().seen(&wanted),
            Make::Annotated(world) => world().seen(&wanted),
        };
        made.map_err(|why| MakeError::Format { name: self.name, why })
    }

    fn wanted(&self, options: &Options<'_>) -> Wanted {
        Wanted { name: self.name, about: self.about, see: options.see, layout: options.layout }
    }

    /// Whether it takes an option.
    fn takes(&self, option: &str) -> bool {
        match (&self.make, option) {
            (Make::World(_) | Make::Annotated(_), option) => matches!(option, "see" | "layout"),
            (Make::Bodies { .. }, "see" | "layout") => false,
            (Make::Bodies { .. }, "body") => {
                Listed::find(self.name).is_some_and(|maze| !matches!(maze.walker, Walker::Point(_)))
            }
            (Make::Bodies { .. }, _) => Listed::find(self.name).is_some(),
        }
    }
}

/// All environments, in the order in which they are listed. The entries stand beside their domains.
pub fn entries() -> impl Iterator<Item = &'static Entry> {
    [
        maze::ENTRIES,
        ant_run::ENTRIES,
        reacher::ENTRIES,
        corridor::ENTRIES,
        recall::ENTRIES,
        rooms::ENTRIES,
        visual_grid::ENTRIES,
        manipulation::ENTRIES,
        grid::ENTRIES,
        sokoban::ENTRIES,
        taxi::ENTRIES,
        visual_taxi::ENTRIES,
        pinball::ENTRIES,
        river::ENTRIES,
        baba::ENTRIES,
        montezuma::ENTRIES,
        probes::ENTRIES,
    ]
    .into_iter()
    .flatten()
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
    named(name).map(Entry::make)
}

/// What a user may change: of a maze what it consists of, of a world of cells or sprites how it is seen.
/// `Options::default()` changes nothing.
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
    /// Another way of seeing a world.
    pub see: Option<See>,
    /// Other layouts of a world.
    pub layout: Option<Layout>,
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
            ("see", self.see.is_some()),
            ("layout", self.layout.is_some()),
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
    /// The environment has no proto-goals.
    #[error("`{name}` has no proto-goals; these have: {}", annotated())]
    NoProtoGoals {
        /// The environment.
        name: &'static str,
    },
    /// A world cannot be seen like that.
    #[error("`{name}`: {why}")]
    Format {
        /// The environment.
        name: &'static str,
        /// What is wrong.
        why: FormatError,
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
        "see" | "layout" => "worlds of cells and sprites do (door-key-8x8, say)",
        _ => "the mazes of point and ant do",
    }
}

/// Builds the environment of that name with a user's changes.
///
/// # Errors
/// [`MakeError`] names the option that the environment does not take, or says what is wrong with its value:
/// with a map, line and column.
pub fn make_with(name: &str, options: &Options<'_>) -> Result<AnyEnvironment, MakeError> {
    let entry = taking(name, options)?;
    match (&entry.make, changed(entry, options)) {
        (Make::Bodies { .. }, Some(maze)) => {
            maze.build(options).map_err(|why| MakeError::Maze { name: entry.name, why })
        }
        (Make::Bodies { make, .. }, None) => Ok(make()),
        (Make::World(_) | Make::Annotated(_), _) => entry.seen(options),
    }
}

/// The same with the proto-goals beside what is seen.
///
/// # Errors
/// As [`make_with`], and [`MakeError::NoProtoGoals`].
pub fn make_annotated(name: &str, options: &Options<'_>) -> Result<AnyAnnotated, MakeError> {
    let entry = taking(name, options)?;
    let Make::Annotated(world) = entry.make else { return Err(MakeError::NoProtoGoals { name: entry.name }) };
    world().annotated(&entry.wanted(options)).map_err(|why| MakeError::Format { name: entry.name, why })
}

/// What each proto-goal of an environment asks, in the order of its bits.
///
/// # Errors
/// [`MakeError::Unknown`] and [`MakeError::NoProtoGoals`].
pub fn proto_goals(name: &str) -> Result<Vec<String>, MakeError> {
    Ok(questions(name)?.into_iter().map(|question| question.text).collect())
}

/// The same with the cells that they are about.
///
/// # Errors
/// As [`proto_goals`].
pub fn questions(name: &str) -> Result<Vec<Question>, MakeError> {
    let entry = named(name)?;
    match entry.make {
        Make::Annotated(world) => Ok(world().questions()),
        Make::Bodies { .. } | Make::World(_) => Err(MakeError::NoProtoGoals { name: entry.name }),
    }
}

/// Finds out the shortest solutions of an environment with a user's changes, where it is a world, and how random
/// actions fare in it. How it is seen does not matter.
///
/// # Errors
/// As [`make_with`].
pub fn certify(
    name: &str,
    options: &Options<'_>,
    how: &certificate::Options,
) -> Result<Certificate, MakeError> {
    let entry = taking(name, options)?;
    let wanted = entry.wanted(options);
    Ok(match entry.make {
        Make::World(world) => world().certify(&wanted, how),
        Make::Annotated(world) => world().certify(&wanted, how),
        Make::Bodies { .. } => match make_with(name, options)? {
            AnyEnvironment::Vectors(mut env) => certificate::environment(&mut env, how),
            AnyEnvironment::Choices(mut env) => certificate::environment(&mut env, how),
            AnyEnvironment::Frames(mut env) => certificate::environment(&mut env, how),
        },
    })
}

/// The environment with a user's changes seen from above, for figures; none when there is nothing to draw.
///
/// # Errors
/// As [`make_with`].
pub fn picture_with(name: &str, options: &Options<'_>) -> Result<Option<Picture>, MakeError> {
    let entry = taking(name, options)?;
    match (&entry.make, changed(entry, options)) {
        (Make::Bodies { .. }, Some(maze)) => {
            maze.picture(options).map(Some).map_err(|why| MakeError::Maze { name: entry.name, why })
        }
        (Make::Bodies { picture, .. }, None) => Ok(picture()),
        (Make::World(_) | Make::Annotated(_), _) => Ok(None),
    }
}

/// The entry of that name, if it takes all options that are set.
fn taking(name: &str, options: &Options<'_>) -> Result<&'static Entry, MakeError> {
    let entry = named(name)?;
    match options.set().find(|option| !entry.takes(option)) {
        Some(option) => Err(MakeError::Option { name: entry.name, option }),
        None => Ok(entry),
    }
}

/// The maze that the options change; none when they change nothing.
fn changed(entry: &Entry, options: &Options<'_>) -> Option<Listed> {
    Listed::find(entry.name).filter(|_| *options != Options::default())
}

fn named(name: &str) -> Result<&'static Entry, Unknown> {
    entries().find(|entry| entry.name == name).ok_or_else(|| Unknown {
        name: name.to_owned(),
        nearest: nearest(name, entries().map(|entry| entry.name)),
    })
}

fn annotated() -> String {
    let have = entries().filter(|entry| matches!(entry.make, Make::Annotated(_)));
    have.map(|entry| entry.name).collect::<Vec<_>>().join(", ")
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

    fn observe(&mut self, out: &mut Self::Observation) {
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
                episodes: if entry.name.starts_with("ant") { 1 } else { 4 },
                ..Default::default()
            };
            let verdict = match env {
                AnyEnvironment::Vectors(mut env) => check(&mut env, options),
                AnyEnvironment::Choices(mut env) => check(&mut env, options),
                AnyEnvironment::Frames(mut env) => check(&mut env, options),
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
