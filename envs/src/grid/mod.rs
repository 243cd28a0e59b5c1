//! The grid worlds of MiniGrid (Chevalier-Boisvert et al. 2023), thesis chapters 5, 7 and 9.
//!
//! - `cell`, `board`, `pose`, `state`: what there is;
//! - `world`: the rules; `view`: what the agent sees;
//! - `layout`: how episodes begin;
//! - `tiles`, `painter`: what it looks like.
//!
//! Everything is MiniGrid 3.2.0's, but for what NumPy's generator would have drawn.

mod board;
mod cell;
mod error;
mod factored;
mod layout;
mod painter;
mod pose;
mod state;
mod tiles;
mod view;
mod world;

pub use board::Board;
pub use cell::{Cell, Colour, Door, Inside};
pub use error::GridError;
pub use factored::FactoredDoorKey;
pub use layout::Maker;
pub use painter::GridPainter;
pub use pose::{Direction, Pose};
pub use state::{State, Task};
pub use tiles::tile;
pub use view::View;
pub use world::{GridWorld, Pay};

use crate::registry::{Entry, Make};
use crate::world::{AnyWorld, Distracted, Layout, See};
use inroads_sim::raster::Format;

/// A world of the list below.
fn listed(maker: Maker) -> GridWorld {
    GridWorld::new(maker).expect("the sizes of the list are possible")
}

/// The same as the thesis' author has it, with his limit.
fn thesis(maker: Maker, limit: u32) -> Box<dyn AnyWorld> {
    Box::new(listed(maker).thesis().limited(limit).expect("the limits of the list are above 0"))
}

/// Door-key as factors.
fn factored(size: u32) -> FactoredDoorKey {
    FactoredDoorKey::new(size).expect("the sizes of the list are possible")
}

/// Values that the distractor of a distracted world takes on. Few: what learns by tables learns everything so many times.
const DISTRACTIONS: u8 = 4;

/// Steps that the author gives door-key (thesis section 7.3.1).
const DOOR_KEY: u32 = 200;
/// Steps that he gives key-corridor.
const KEY_CORRIDOR: u32 = 1000;

const fn entry(name: &'static str, about: &'static str, world: fn() -> Box<dyn AnyWorld>) -> Entry {
    Entry { name, about, make: Make::World(world) }
}

/// The worlds of the registry.
pub(crate) const ENTRIES: &[Entry] = &[
    entry("empty-5x5", "MiniGrid: an empty room, from one corner to the other", || {
        Box::new(listed(Maker::Empty { size: 5 }))
    }),
    entry("empty-8x8", "MiniGrid: an empty room, from one corner to the other", || {
        Box::new(listed(Maker::Empty { size: 8 }))
    }),
    entry("unlock", "MiniGrid: take the key and open the locked door", || Box::new(listed(Maker::Unlock))),
    entry("four-rooms", "MiniGrid: four rooms with gaps between them, and a goal somewhere", || {
        Box::new(listed(Maker::FourRooms))
    }),
    entry("door-key-5x5", "MiniGrid: a key, a locked door, a goal behind it", || {
        Box::new(listed(Maker::DoorKey { size: 5 }))
    }),
    entry("door-key-6x6", "MiniGrid: a key, a locked door, a goal behind it", || {
        Box::new(listed(Maker::DoorKey { size: 6 }))
    }),
    entry("door-key-8x8", "MiniGrid: a key, a locked door, a goal behind it", || {
        Box::new(listed(Maker::DoorKey { size: 8 }))
    }),
    entry("door-key-16x16", "MiniGrid: a key, a locked door, a goal behind it", || {
        Box::new(listed(Maker::DoorKey { size: 16 }))
    }),
    entry("key-corridor-s3r1", "MiniGrid: a corridor, a key in one room, a ball in a locked one", || {
        Box::new(listed(Maker::KeyCorridor { room: 3, rows: 1 }))
    }),
    entry("key-corridor-s3r2", "MiniGrid: a corridor, a key in one room, a ball in a locked one", || {
        Box::new(listed(Maker::KeyCorridor { room: 3, rows: 2 }))
    }),
    entry("key-corridor-s3r3", "MiniGrid: a corridor, a key in one room, a ball in a locked one", || {
        Box::new(listed(Maker::KeyCorridor { room: 3, rows: 3 }))
    }),
    entry("key-corridor-s4r3", "MiniGrid: a corridor, a key in one room, a ball in a locked one", || {
        Box::new(listed(Maker::KeyCorridor { room: 4, rows: 3 }))
    }),
    entry("key-corridor-s5r3", "MiniGrid: a corridor, a key in one room, a ball in a locked one", || {
        Box::new(listed(Maker::KeyCorridor { room: 5, rows: 3 }))
    }),
    entry("key-corridor-s6r3", "MiniGrid: a corridor, a key in one room, a ball in a locked one", || {
        Box::new(listed(Maker::KeyCorridor { room: 6, rows: 3 }))
    }),
    entry("four-rooms-thesis", "as in thesis chapter 5: one map, starts anywhere, 84 by 84 in grey", || {
        let world = listed(Maker::FourRooms).paying(Pay::One).laid_out(Layout::FixedMap(42));
        Box::new(world.seen(See::Pixels(Format::THESIS_GREY)))
    }),
    entry(
        "door-key-5x5-thesis",
        "as in thesis chapter 7 but smaller: success pays 1, one layout, 84 by 84",
        || thesis(Maker::DoorKey { size: 5 }, DOOR_KEY),
    ),
    entry(
        "door-key-6x6-thesis",
        "as in thesis chapter 7 but smaller: success pays 1, one layout, 84 by 84",
        || thesis(Maker::DoorKey { size: 6 }, DOOR_KEY),
    ),
    entry(
        "door-key-8x8-thesis",
        "as in thesis chapter 7: success pays 1, one layout, 84 by 84 in colour",
        || thesis(Maker::DoorKey { size: 8 }, DOOR_KEY),
    ),
    entry(
        "key-corridor-s3r3-thesis",
        "as in thesis chapters 7 and 9: success pays 1, one layout, 84 by 84",
        || thesis(Maker::KeyCorridor { room: 3, rows: 3 }, KEY_CORRIDOR),
    ),
    entry("door-key-5x5-factored", "as in thesis chapter 7 but smaller, seen as nine numbers", || {
        Box::new(factored(5))
    }),
    entry("door-key-6x6-factored", "as in thesis chapter 7 but smaller, seen as nine numbers", || {
        Box::new(factored(6))
    }),
    entry(
        "door-key-5x5-factored-distracted",
        "door-key-5x5-factored and a number that changes at random in every step",
        || Box::new(Distracted::new(factored(5), DISTRACTIONS)),
    ),
    entry(
        "door-key-6x6-factored-distracted",
        "door-key-6x6-factored and a number that changes at random in every step",
        || Box::new(Distracted::new(factored(6), DISTRACTIONS)),
    ),
];
