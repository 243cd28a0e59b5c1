//! Baba Is You, the U-maze (thesis section 8.5.4), on a small engine of its rules.
//!
//! The level is a stand-in: the thesis' was never published. See `docs/environments/baba.md`.

mod kinds;
mod level;
mod paint;
mod rules;
mod symbols;
mod world;

pub use kinds::{Kind, Noun, Property, Word};
pub use level::{Level, LevelError, U_MAZE};
pub use paint::Tiles;
pub use rules::{Rules, Unit};
pub use world::{Baba, State, WAYS};

use crate::registry::{Entry, Make};

/// The worlds of the registry.
pub(crate) const ENTRIES: &[Entry] = &[Entry {
    name: "baba-u-maze",
    about: "Baba Is You: push a word into place, so that the wall is the goal (thesis figure 8.7).",
    make: Make::Annotated(|| Box::new(Baba::new(Level::parse(U_MAZE).expect("the U-maze is a level")))),
}];
