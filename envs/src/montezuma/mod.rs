//! A screen like the first of Montezuma's Revenge (thesis section 5.2.1): platforms, ladders, a rope, belts, a key, two
//! doors and a skull.
//!
//! **A look-alike**: no byte of the game is in it. Places and colours are those of the real screen, as others have
//! annotated it; how things move is invented, each number where it stands. No result on it is one on Montezuma's Revenge.

mod hazards;
mod options;
mod painter;
pub mod player;
mod rules;
mod scenery;
pub mod screen;
mod sprites;
mod world;

pub use hazards::{ROLL, Skull};
pub use options::{Goal, STARTS, TARGETS, THESIS, TOLERANCE, Target};
pub use painter::MontezumaPainter;
pub use player::{Hold, PIXEL, Player, Status};
pub use rules::{Belts, Rules, RulesError};
pub use world::{ACTIONS, DOOR_REWARD, FRAMES, KEY_REWARD, Key, MOURNING, Montezuma, Scene};

use crate::registry::{Entry, Make};
use crate::world::AnyWorld;

/// The worlds of the registry.
pub(crate) const ENTRIES: &[Entry] = &[
    Entry {
        name: "montezuma",
        about: "a screen like the first of Montezuma's Revenge: get the key, open a door; 100 and 300 points",
        make: Make::World(|| made(Rules::default())),
    },
    Entry {
        name: "montezuma-thesis",
        about: "montezuma as chapter 5 sees it: 84 x 84 grey, brighter of two frames, rewards clipped to 1",
        make: Make::World(|| made(Rules::THESIS)),
    },
];

fn made(rules: Rules) -> Box<dyn AnyWorld> {
    Box::new(Montezuma::new(rules).expect("the rules of the registry make a game"))
}
