//! Worlds of choices that can be seen in several ways: as symbols, as a picture in colour or grey.
//!
//! A domain of this kind is a [`World`]: rules and state, nothing about how it is seen, when it is cut off, or under
//! which name. [`Symbolic`] and [`Pictured`] make an [`Environment`](crate::Environment) of it;
//! [`TimeLimit`](crate::TimeLimit) truncates. So there is one place each for refusals, symbols, frames and limits.

mod any;
mod distracted;
mod layout;
#[cfg(test)]
#[allow(unreachable_pub, dead_code)] // also a part of the integration tests
#[path = "../../tests/support/nine.rs"]
pub(crate) mod nine;
mod pictured;
mod played;
mod proto_goals;
mod symbolic;
mod words;

pub(crate) use any::{AnnotatedWorld, AnyWorld, Wanted};
pub use distracted::{Beside, Distracted, Undistracted};
pub use layout::{Draw, Layout};
pub use pictured::Pictured;
pub use proto_goals::{Annotating, ProtoGoals, Question};
pub use symbolic::Symbolic;
pub use words::WordError;

use std::borrow::Cow;

use inroads_sim::raster::{Format, Frame};

use crate::{Dimension, Snapshot, Step};

/// What there is to know of a world beforehand.
#[derive(Clone, Debug, PartialEq)]
pub struct Card {
    /// Its name.
    pub name: &'static str,
    /// One sentence.
    pub about: &'static str,
    /// What each choice does, in a word or two.
    pub actions: &'static [&'static str],
    /// What each number of [`World::symbols`] is.
    pub symbols: Vec<Dimension>,
    /// Which of them say where one is.
    pub place: Vec<usize>,
    /// Steps after which an episode is truncated, by whoever wraps it; `None`: never.
    pub limit: Option<u32>,
    /// An episode that terminates with at least this reward on its last step succeeded.
    pub success_reward: f32,
    /// Which layouts its episodes have, unless somebody wants others.
    pub layout: Layout,
    /// How it is seen, unless somebody wants it otherwise.
    pub see: See,
}

/// How a world is seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum See {
    /// As [`World::symbols`].
    #[default]
    Symbols,
    /// As a picture.
    Pixels(Format),
}

/// Rules and state of a domain whose actions are choices.
///
/// [`Snapshot`] is exact: state, what is still to be drawn at random in the episode, everything. A world of nine cells,
/// written out with all that a world may have, stands in `envs/tests/support/nine.rs`.
pub trait World: Snapshot + Clone + Send + 'static {
    /// What there is to know of it beforehand.
    fn card(&self) -> Card;

    /// Begins an episode.
    fn begin(&mut self, draw: Draw);

    /// Carries out a choice. Only called within an episode, with a choice that there is.
    fn act(&mut self, choice: usize) -> Step;

    /// Writes the state as numbers, as [`Card::symbols`] has them: all of it that rules depend on, chance and the clock
    /// apart, so that from equal symbols the same can be reached.
    fn symbols(&self, out: &mut Vec<f32>);

    /// Writes what a search takes states for the same by: equal numbers, one state. That is the symbols, unless some of
    /// them do not matter to what can still be reached (a clock), or there are too many states (continuous ones): then
    /// whoever knows the world leaves out or rounds.
    fn landmark(&self, out: &mut Vec<f32>) -> Grain {
        self.symbols(out);
        Grain::Exact
    }

    /// What is true of the state, for metrics and plots; no part of any observation.
    fn facts(&self) -> Vec<Fact>;

    /// What is told in words, a message or a mission; no part of any observation.
    fn told(&self) -> Option<String> {
        None
    }
}

/// How finely [`World::landmark`] tells states apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grain {
    /// From states with the same numbers, the same choices succeed: what a search finds is shortest.
    Exact,
    /// There are differences that it passes over: what a search finds is a solution, maybe not the shortest, and what it
    /// does not find may exist.
    Coarse,
}

/// A world that can be drawn.
pub trait Drawn: World {
    /// What draws it.
    type Painter: Painter<Self> + Clone + Send;

    /// Somebody to draw it in this format, whose size was checked.
    fn painter(&self, format: Format) -> Self::Painter;

    /// Width and height of its picture where nothing scales it. Worlds that can be drawn in any size say so here without
    /// asking for the memory that it takes.
    fn native(&self) -> [u32; 2] {
        self.painter(Format::NATIVE).shape().0
    }
}

/// Draws worlds of one shape into frames of one size. It may remember what it drew last, and draw only what differs.
pub trait Painter<W> {
    /// Width, height and channels of its frames.
    fn shape(&self) -> ([u32; 2], u32);

    /// Draws the world as it is.
    fn paint(&mut self, world: &W, out: &mut Frame);
}

/// Something that is true of a state.
#[derive(Clone, Debug, PartialEq)]
pub struct Fact {
    /// What it is, in a word or two.
    pub name: Cow<'static, str>,
    /// Its value.
    pub value: f32,
}

impl Fact {
    /// A fact.
    pub fn new(name: impl Into<Cow<'static, str>>, value: impl Into<f32>) -> Self {
        Self { name: name.into(), value: value.into() }
    }
}
