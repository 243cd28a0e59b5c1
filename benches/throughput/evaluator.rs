//! What it costs to judge which proto-goals can be controlled: least-squares policy iteration for many events.

use std::hint::black_box;

use inroads::{
    agents::lspi::{Batch, Lspi, Projection, Rows},
    envs::Seed,
};
use rand::RngExt;

use crate::workload::Workload;

/// Making a batch ready, once for all events.
pub(crate) const PREPARE: &str = "agents/lspi-evaluator/prepare";
/// Values of seeking and avoiding one event.
pub(crate) const EVENT: &str = "agents/lspi-evaluator/event";

/// Transitions of a batch.
const TRANSITIONS: usize = 4096;
/// Features of a transition, the constant among them.
const FEATURES: usize = 100;
/// Events that are solved for side by side; so many are in an operation.
const TOGETHER: usize = 16;
/// A walk on a torus of so many cells along a side, so that distances, and with them the solver's iterations, are real.
const SIDE: usize = 17;
/// Lamps that flicker: no two transitions are equal, and with the walk's 32 there are `FEATURES` directions.
const LAMPS: usize = FEATURES - 1 - 2 * (SIDE - 1);

/// A batch of 4,096 transitions with 100 features and 5 actions, and events of being in a cell.
pub(crate) fn evaluator() -> Vec<Workload> {
    let lspi = Lspi { features: FEATURES, ..Lspi::default() };
    let (rows, events) = walk();
    let batch = prepare(&lspi, &rows);
    let solve = {
        let lspi = lspi.clone();
        move || {
            let mut rng = Seed(0).stream("ties", 0);
            lspi.solve(&batch, &events, &mut rng, |_, values| {
                _ = black_box(values.seek[0] + values.avoid[0])
            });
        }
    };
    vec![
        Workload::repeated(PREPARE, move || _ = black_box(prepare(&lspi, &rows))),
        Workload::repeated(EVENT, solve).at_once(TOGETHER, 1),
    ]
}

fn prepare(lspi: &Lspi, rows: &Rows) -> Batch {
    let projection = Projection::fit(rows, lspi.features, &mut Seed(0).stream("projection", 0));
    lspi.batch(&projection.project(rows), 5).expect("there are transitions")
}

/// The walk, and for some cells the transitions into them.
fn walk() -> (Rows, Vec<Vec<usize>>) {
    let mut rng = Seed(0).stream("walk", 0);
    let mut rows = Rows::new(2 * SIDE + LAMPS);
    let mut events = vec![Vec::new(); TOGETHER];
    let mut at = [0, 0];
    let mut seen = vec![0.0; rows.width()];
    for transition in 0..=TRANSITIONS {
        let action = rng.random_range(0..5);
        let before = seen.clone();
        if transition > 0 && action < 4 {
            at[action % 2] = (at[action % 2] + if action < 2 { 1 } else { SIDE - 1 }) % SIDE;
        }
        seen.fill(0.0);
        (seen[at[0]], seen[SIDE + at[1]]) = (1.0, 1.0);
        seen[2 * SIDE..].iter_mut().for_each(|lamp| *lamp = f32::from(u8::from(rng.random_bool(0.5))));
        if transition > 0 {
            rows.push(&before, action, &seen, false);
            // Each 18th cell of the 289, all over the torus.
            let cell = SIDE * at[0] + at[1];
            if cell.is_multiple_of(SIDE + 1) && cell / (SIDE + 1) < TOGETHER {
                events[cell / (SIDE + 1)].push(transition - 1);
            }
        }
    }
    (rows, events)
}
