//! Random walks in domains, in which something is done for the first time: a key taken, a door opened, a passenger
//! picked up.
//!
//! At first the choice that does it is left out, so that all else is familiar. The truth is the one number that the step
//! changed beside the distractor, and that had never had this value.

use inroads::envs::{
    Seed,
    grid::FactoredDoorKey,
    taxi::{Rules, Taxi},
    world::{Distracted, Layout, World},
};
use rand::RngExt;

use super::score::{Event, Line, lines as score};
use crate::support::over_seeds;

/// Steps without the choice that does it.
const PAST: usize = 3000;
/// States of the exploration that ends with the event, at most.
const PATH: usize = 20;
/// Layouts a seed.
const LAYOUTS: u64 = 5;
/// Steps of an episode.
const EPISODE: usize = 200;

/// A kind of event: what the left-out choice does, and to which number.
#[derive(Clone, Copy)]
struct Kind {
    name: &'static str,
    left_out: usize,
    feature: usize,
    value: f32,
}

const KEY: Kind = Kind { name: "door-key: the first key", left_out: 3, feature: 3, value: 1.0 };
const DOOR: Kind = Kind { name: "door-key: the first open door", left_out: 5, feature: 8, value: 0.0 };
const ABOARD: Kind = Kind { name: "taxi: the first passenger", left_out: 4, feature: 2, value: 4.0 };

/// Walks in a world until the event happens.
fn event<W: World>(mut world: W, kind: Kind, layout: Layout, seed: Seed) -> Event {
    let choices = world.card().actions.len();
    let distractor = world.card().symbols.len() as u32 - 1;
    let mut rng = seed.stream("walk", 0);
    let mut before: Vec<Vec<f32>> = Vec::new();
    for episode in 0.. {
        world.begin(layout.draw(seed.number("episode", episode)));
        let mut path: Vec<Vec<f32>> = vec![Vec::new()];
        world.symbols(&mut path[0]);
        before.push(path[0].clone());
        for _ in 0..EPISODE {
            let choice = rng.random_range(0..choices);
            if choice == kind.left_out && before.len() < PAST {
                continue;
            }
            let end = world.act(choice).end;
            let mut s = Vec::new();
            world.symbols(&mut s);
            path.push(s.clone());
            if s[kind.feature] == kind.value {
                let path = path.split_off(path.len().saturating_sub(PATH));
                return Event { before, path, truth: vec![kind.feature as u32], distractor };
            }
            before.push(s);
            if end.is_some() {
                break;
            }
        }
    }
    unreachable!("a random walk does everything at last")
}

/// All kinds of events, by all methods.
pub(super) fn lines(seeds: u64) -> Vec<Line> {
    let grid = |seed, layout| (Layout::Fixed(layout), Seed(seed).number("walks", layout));
    let door_key = |kind: Kind| {
        over_seeds(seeds, |seed| {
            let event = |layout| {
                let world = FactoredDoorKey::new(6).expect("there is a door-key of 6 by 6");
                let (layout, seed) = grid(seed, layout);
                event(Distracted::new(world, 4), kind, layout, Seed(seed))
            };
            (0..LAYOUTS).map(event).collect::<Vec<_>>()
        })
    };
    let taxi = over_seeds(seeds, |seed| {
        let event = |nth| {
            let world = Distracted::new(Taxi::new(Rules::SPARSE_TO_DESTINATION), 4);
            event(world, ABOARD, Layout::Random, Seed(grid(seed, nth).1))
        };
        (0..LAYOUTS).map(event).collect::<Vec<_>>()
    });
    let all = [(KEY, door_key(KEY)), (DOOR, door_key(DOOR)), (ABOARD, taxi)];
    let line = |(kind, events): (Kind, Vec<Vec<Event>>)| {
        score(kind.name, &events.into_iter().flatten().collect::<Vec<_>>())
    };
    all.into_iter().flat_map(line).collect()
}
