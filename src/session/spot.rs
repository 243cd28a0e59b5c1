//! Places as people name them: the ends of plans.

use std::{fmt, str::FromStr};

use inroads_discovery::record::{GraphRecord, Place, Skilled};
use inroads_envs::{Goal, Space, Spec};

use super::{Stopped, pair::Seen};

/// How near one is there where bodies move and the task has no region of its own, in units of the place: the mazes' 0.6 m
/// (thesis 6.2).
const NEAR: f32 = 0.6;

/// A place as a person names it.
#[derive(Clone, Debug, PartialEq)]
pub enum Spot {
    /// Where an episode begins.
    Start,
    /// The task's goal, where it is a region.
    Goal,
    /// A vertex of the skill graph.
    Vertex(u32),
    /// Like the start, but for the dimensions that say where one is ([`Spec::place`]).
    At(Vec<f32>),
}

/// A word that names no place.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{0}` is no place; say `start`, `goal`, a vertex's number, or coordinates with commas such as 2.5,4 (a single one \
     ends with a comma)"
)]
pub struct NoSpot(String);

/// Why there is no plan.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlanError {
    /// The agent has no graph.
    #[error("this run's agent has no skill graph to plan on; `inroads list` says which agents make one")]
    NoGraph,
    /// The graph has no such vertex.
    #[error("there is no vertex {vertex}; the graph has {}", vertices(.known))]
    NoVertex {
        /// The number.
        vertex: u32,
        /// Those that there are.
        known: Vec<u32>,
    },
    /// The task's goal is no region.
    #[error(
        "the goal of `{name}` is no region that could be planned to; give --to a vertex{}, or coordinates with commas",
        example(.known)
    )]
    NoGoal {
        /// The environment.
        name: &'static str,
        /// The graph's vertices.
        known: Vec<u32>,
    },
    /// A coordinate is outside the world.
    #[error("{dimension} is {found}, outside `{name}`: it goes from {low} to {high}")]
    Outside {
        /// The environment.
        name: &'static str,
        /// The coordinate's name.
        dimension: String,
        /// What was given.
        found: f32,
        /// The least value.
        low: f32,
        /// The greatest.
        high: f32,
    },
    /// Too few or too many coordinates.
    #[error("{found} coordinates say no place in `{name}`; give {}: {wanted}", wanted.split(',').count())]
    Coordinates {
        /// The environment.
        name: &'static str,
        /// How many were given.
        found: usize,
        /// The names of those that are needed.
        wanted: String,
    },
    /// What is seen has no coordinates.
    #[error("`{0}` is seen as pictures, in which no place has coordinates; say `start` or a vertex's number")]
    Pictures(&'static str),
    /// Coordinates are not all that the agent observes.
    #[error("the agent is told more than coordinates in `{0}`; give a vertex")]
    More(&'static str),
    /// No way leads there.
    #[error("no way leads from {from} to {to} on the skill graph; `inroads goals` shows its vertices")]
    NoWay {
        /// Where it should begin.
        from: Spot,
        /// Where it should end.
        to: Spot,
    },
    /// The episode could not go on.
    #[error("stopped on the way in {0}")]
    Stopped(#[from] Stopped),
}

/// Vertices in words.
fn vertices(known: &[u32]) -> String {
    match known {
        [] => "none yet".to_owned(),
        [one] => format!("only vertex {one}"),
        [first, .., last] => format!("{} from {first} to {last}", known.len()),
    }
}

/// How a vertex of these is given.
fn example(known: &[u32]) -> String {
    match known.last() {
        None => " once there is one".to_owned(),
        Some(last) => format!(" such as --to {last} ({})", vertices(known)),
    }
}

/// The numbers of a graph's vertices, in order.
fn known(graph: &GraphRecord) -> Vec<u32> {
    let mut known: Vec<u32> = graph.vertices.iter().map(|known| known.vertex).collect();
    known.sort_unstable();
    known
}

impl FromStr for Spot {
    type Err = NoSpot;

    fn from_str(word: &str) -> Result<Self, NoSpot> {
        let no = || NoSpot(word.to_owned());
        match word.trim() {
            "start" => Ok(Self::Start),
            "goal" => Ok(Self::Goal),
            list if list.contains(',') => {
                let numbers = list.strip_suffix(',').unwrap_or(list).split(',');
                let numbers: Result<Vec<f32>, _> = numbers.map(|number| number.trim().parse()).collect();
                let numbers = numbers.map_err(|_| no())?;
                numbers.iter().all(|x| x.is_finite()).then_some(Self::At(numbers)).ok_or_else(no)
            }
            number => number.parse().map(Self::Vertex).map_err(|_| no()),
        }
    }
}

impl fmt::Display for Spot {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Start => write!(out, "the start"),
            Self::Goal => write!(out, "the goal"),
            Self::Vertex(vertex) => write!(out, "vertex {vertex}"),
            Self::At(numbers) => {
                let numbers: Vec<_> = numbers.iter().map(f32::to_string).collect();
                write!(out, "({})", numbers.join(", "))
            }
        }
    }
}

/// A place of a known environment and graph.
pub(super) enum Located<O> {
    /// A vertex.
    Vertex(u32),
    /// An observation, and what is as good as it; none where nothing else is.
    State(O, Option<Goal>),
}

impl Spot {
    /// The place in an environment whose episode begins with `first`.
    pub(super) fn located<O: Seen>(
        &self,
        first: &O,
        graph: &GraphRecord,
        spec: &Spec,
    ) -> Result<Located<O>, PlanError> {
        let tolerance = match (&spec.goal, &spec.action) {
            (Some(goal), _) => goal.tolerance,
            // Places are cells.
            (None, Space::Discrete(_)) => 0.0,
            (None, _) => NEAR,
        };
        match self {
            Self::Vertex(vertex) if graph.vertices.iter().any(|known| known.vertex == *vertex) => {
                Ok(Located::Vertex(*vertex))
            }
            Self::Vertex(vertex) => Err(PlanError::NoVertex { vertex: *vertex, known: known(graph) }),
            Self::Start => {
                let region = first.seen().map(|seen| {
                    let at = spec.place.iter().map(|&d| seen[d]).collect();
                    Goal { dims: spec.place.clone(), at, tolerance }
                });
                Ok(Located::State(first.clone(), region))
            }
            Self::Goal => {
                let none = || PlanError::NoGoal { name: spec.name, known: known(graph) };
                moved(first, spec.goal.clone().ok_or_else(none)?, spec)
            }
            Self::At(_) if first.seen().is_none() => Err(PlanError::Pictures(spec.name)),
            Self::At(at) if at.len() == spec.place.len() => {
                within(at, spec)?;
                moved(first, Goal { dims: spec.place.clone(), at: at.clone(), tolerance }, spec)
            }
            Self::At(at) => {
                let name = |d: &usize| &*spec.observation.dimensions()[*d].name;
                let wanted: Vec<_> = spec.place.iter().map(name).collect();
                Err(PlanError::Coordinates { name: spec.name, found: at.len(), wanted: wanted.join(",") })
            }
        }
    }
}

/// Refuses a point that the world does not have.
fn within(at: &[f32], spec: &Spec) -> Result<(), PlanError> {
    for (&d, &found) in spec.place.iter().zip(at) {
        let dimension = &spec.observation.dimensions()[d];
        let (low, high) = (dimension.low, dimension.high);
        if !(low..=high).contains(&found) {
            let dimension = dimension.name.to_string();
            return Err(PlanError::Outside { name: spec.name, dimension, found, low, high });
        }
    }
    Ok(())
}

/// The first observation, moved to a point.
fn moved<O: Seen>(first: &O, to: Goal, spec: &Spec) -> Result<Located<O>, PlanError> {
    let mut seen = first.seen().ok_or(PlanError::Pictures(spec.name))?.clone();
    to.dims.iter().zip(&to.at).for_each(|(&d, &at)| seen[d] = at);
    let state = O::wholly(&seen).ok_or(PlanError::More(spec.name))?;
    Ok(Located::State(state.clone(), Some(to)))
}

impl<O: Seen> Located<O> {
    /// As agents take it.
    pub(super) fn place(&self) -> Place<'_, O> {
        match self {
            Self::Vertex(vertex) => Place::Vertex(*vertex),
            Self::State(state, _) => Place::State(state),
        }
    }

    /// Whether `s` is there. In a vertex is who need not go anywhere to reach it.
    pub(super) fn holds<A>(&self, agent: &(impl Skilled<O, A> + ?Sized), s: &O) -> bool {
        match self {
            Self::Vertex(_) => {
                agent.plan(&Place::State(s), &self.place()).is_some_and(|plan| plan.legs.is_empty())
            }
            Self::State(state, region) => match region.as_ref().zip(s.seen()) {
                Some((region, seen)) => region.reached(seen),
                None => s == state,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_places() {
        let spot = |word: &str| word.parse::<Spot>().unwrap();
        assert_eq!([spot("start"), spot("goal"), spot(" 12 ")], [Spot::Start, Spot::Goal, Spot::Vertex(12)]);
        assert_eq!(spot("2.5,-4"), Spot::At(vec![2.5, -4.0]));
        assert_eq!(spot("3,"), Spot::At(vec![3.0]));
        for word in ["", "-1", "here", "1,x", "1,,2", "nan,1", ","] {
            let error = word.parse::<Spot>().unwrap_err().to_string();
            assert!(error.starts_with(&format!("`{word}` is no place; say `start`")), "{error}");
        }
    }
}
