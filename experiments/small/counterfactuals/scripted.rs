//! Made-up states of seven features, visited at random, and then one state with something new in it.
//!
//! | feature | values in the past |
//! |---|---|
//! | 0, 1 | 0 to 9: a place |
//! | 2, 3 | 0 to 3, never both 3; in a tenth of the visits both are 4; in a tenth one of them is 5 |
//! | 4, 5 | 0 to 3 |
//! | 6 | 0 to 3: the distractor |
//!
//! All are drawn uniformly and independently but for what the table says.

use inroads::envs::{Rng, Seed};
use rand::RngExt;

use super::score::{Event, Line, lines as score};
use crate::support::over_seeds;

/// Visits before the event.
const PAST: usize = 2000;
/// States of the exploration that ends with the event.
const PATH: usize = 20;
/// Events a seed.
const EVENTS: u64 = 10;

/// A kind of event: its name, its truth, and what makes it of a familiar state.
type Kind = (&'static str, &'static [u32], fn(&mut Vec<f32>, &mut Rng));

const KINDS: &[Kind] = &[
    ("a new value", &[4], |s, _| s[4] = 9.0),
    ("two values that never met", &[2, 3], |s, _| (s[2], s[3]) = (3.0, 3.0)),
    ("two new values at once", &[4, 5], |s, _| (s[4], s[5]) = (9.0, 9.0)),
    // Their path shows 4 and 4, which neither 5 has met.
    ("two that never met, crossed", &[2, 3], |s, _| (s[2], s[3]) = (5.0, 5.0)),
];

/// A familiar state.
fn familiar(rng: &mut Rng) -> Vec<f32> {
    let mut s: Vec<_> = [10, 10, 4, 4, 4, 4, 4].map(|values| rng.random_range(0..values) as f32).into();
    match rng.random_range(0..10) {
        0 => (s[2], s[3]) = (4.0, 4.0),
        1 => s[2 + rng.random_range(0..2)] = 5.0,
        _ => {
            if s[2] == 3.0 && s[3] == 3.0 {
                s[3] = rng.random_range(0..3) as f32;
            }
        }
    }
    s
}

fn event(kind: &Kind, rng: &mut Rng) -> Event {
    let before: Vec<_> = (0..PAST).map(|_| familiar(rng)).collect();
    let mut path: Vec<_> = (0..PATH).map(|_| familiar(rng)).collect();
    if kind.0.ends_with("crossed") {
        path.iter_mut().for_each(|s| (s[2], s[3]) = (4.0, 4.0));
    }
    kind.2(&mut path[PATH - 1], rng);
    Event { before, path, truth: kind.1.to_vec(), distractor: 6 }
}

/// All kinds of events, by all methods.
pub(super) fn lines(seeds: u64) -> Vec<Line> {
    let of = |kind: &Kind| {
        let events = over_seeds(seeds, |seed| {
            let mut rng = Seed(seed).stream(kind.0, 0);
            (0..EVENTS).map(|_| event(kind, &mut rng)).collect::<Vec<_>>()
        });
        score(kind.0, &events.into_iter().flatten().collect::<Vec<_>>())
    };
    KINDS.iter().flat_map(of).collect()
}
