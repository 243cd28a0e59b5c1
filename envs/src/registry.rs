//! Environments by name.

use crate::corridor::Corridor;
use crate::dense::DenseReward;
use crate::maze::{CORRIDOR, Maze, Picture, PointMaze, U_MAZE};
use crate::{Environment, Refused, Spec, Step, TimeLimit};

/// An environment of one of the kinds of observation and action that there are.
pub enum AnyEnvironment {
    /// Vectors seen, vectors done.
    Vectors(Box<dyn Environment<Observation = Vec<f32>, Action = Vec<f32>> + Send>),
    /// Vectors seen, one of several choices done.
    Choices(Box<dyn Environment<Observation = Vec<f32>, Action = usize> + Send>),
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
    make: fn() -> AnyEnvironment,
    picture: fn() -> Option<Picture>,
}

impl Entry {
    /// Builds the environment.
    pub fn make(&self) -> AnyEnvironment {
        (self.make)()
    }
}

/// All environments, in the order in which they are listed.
pub const ENTRIES: &[Entry] = &[
    Entry {
        name: U_MAZE.name,
        about: U_MAZE.about,
        // The thesis' limit.
        make: || AnyEnvironment::Vectors(Box::new(TimeLimit::new(maze(&U_MAZE), 1000))),
        picture: || Some(maze(&U_MAZE).picture().clone()),
    },
    Entry {
        name: DENSE.0,
        about: DENSE.1,
        make: || {
            let env = DenseReward::named(DENSE.0, DENSE.1, maze(&U_MAZE));
            AnyEnvironment::Vectors(Box::new(TimeLimit::new(env, 1000)))
        },
        picture: || Some(maze(&U_MAZE).picture().clone()),
    },
    Entry {
        name: CORRIDOR.name,
        about: CORRIDOR.about,
        make: || AnyEnvironment::Vectors(Box::new(TimeLimit::new(maze(&CORRIDOR), 300))),
        picture: || Some(maze(&CORRIDOR).picture().clone()),
    },
    Entry {
        name: "corridor-5",
        about: "five cells in a row, walked from one end to the other; -1 a step",
        make: || AnyEnvironment::Choices(Box::new(TimeLimit::new(Corridor::named("corridor-5", 5), 50))),
        picture: || None,
    },
];

/// Name and sentence of the Point-Maze that pays by the distance.
const DENSE: (&str, &str) =
    ("point-maze-dense", "the same maze; minus a tenth of the distance to the goal a step");

fn maze(maze: &Maze<'_>) -> PointMaze {
    PointMaze::new(maze).expect("the mazes of this crate are well formed")
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
    entry(name).map(Entry::make).ok_or_else(|| Unknown {
        name: name.to_owned(),
        nearest: nearest(name, ENTRIES.iter().map(|entry| entry.name)),
    })
}

/// The environment seen from above, for figures; `None` when there is no such environment or nothing to draw.
pub fn picture(name: &str) -> Option<Picture> {
    entry(name).and_then(|entry| (entry.picture)())
}

fn entry(name: &str) -> Option<&'static Entry> {
    ENTRIES.iter().find(|entry| entry.name == name)
}

fn all() -> String {
    ENTRIES.iter().map(|entry| entry.name).collect::<Vec<_>>().join(", ")
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
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::{Options, check};

    #[test]
    fn every_environment_keeps_the_contract_and_its_name() {
        for entry in ENTRIES {
            let env = entry.make();
            assert_eq!(env.spec().name, entry.name);
            let verdict = match env {
                AnyEnvironment::Vectors(mut env) => check(&mut env, Options::default()),
                AnyEnvironment::Choices(mut env) => check(&mut env, Options::default()),
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
        assert!(picture("point-mze").is_none() && picture("corridor-5").is_none());
        assert!(picture("point-maze").is_some());
    }

    #[test]
    fn distances_are_levenshteins() {
        assert_eq!(distance("kitten", "sitting"), 3);
        assert_eq!((distance("", "abc"), distance("abc", ""), distance("ab", "ab")), (3, 3, 0));
    }
}
