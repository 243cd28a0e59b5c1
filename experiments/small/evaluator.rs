//! The price of judging proto-goals: 10,000 of them, of which at most 300 occur in a batch of 4,096 transitions, with 100
//! features and 5 actions.
//!
//! A walk on a torus of 17 by 17 cells, a proto-goal each, with 67 lamps that flicker so that no two transitions are equal. It
//! depends on the machine, so nothing is written.

use std::time::Instant;

use inroads::{
    agents::{Encoder, Experience, Transition},
    discovery::proto::plausible::{Judgement, Plausibility},
    envs::{Annotated, Bits, Rng, Seed},
};
use rand::RngExt;

use crate::{Options, controllability::single_bits, support::Done};

/// What is seen, as it is.
struct AsIs(usize);

impl Encoder<Vec<f32>> for AsIs {
    fn width(&self) -> usize {
        self.0
    }

    fn write(&self, observation: &Vec<f32>, out: &mut [f32]) {
        out.copy_from_slice(observation);
    }
}

pub(crate) fn run(_: &Options) -> Done {
    const SIDE: usize = 17;
    const LAMPS: usize = 99 - 2 * (SIDE - 1);
    const GOALS: usize = 10_000;
    let mut rng = Seed(0).stream("cost", 0);
    let mut at = [0, 0];
    let mut counts = vec![0; GOALS];
    let see = |at: [usize; 2], counts: &mut [u64], rng: &mut Rng| {
        let mut seen = vec![0.0; 2 * SIDE + LAMPS];
        (seen[at[0]], seen[SIDE + at[1]]) = (1.0, 1.0);
        seen[2 * SIDE..].iter_mut().for_each(|lamp| *lamp = f32::from(u8::from(rng.random_bool(0.5))));
        let mut bits = Bits::new(GOALS);
        bits.set(SIDE * at[0] + at[1]);
        counts[SIDE * at[0] + at[1]] += 1;
        Annotated { seen, bits }
    };
    let mut experience = Experience::new(4_096);
    let mut before = see(at, &mut counts, &mut rng);
    experience.begin(&before);
    for _ in 0..4_096 {
        let action = rng.random_range(0..5);
        if action < 4 {
            at[action % 2] = (at[action % 2] + if action < 2 { 1 } else { SIDE - 1 }) % SIDE;
        }
        let after = see(at, &mut counts, &mut rng);
        experience.push(&Transition {
            before: &before,
            action: &action,
            reward: 0.0,
            after: &after,
            end: None,
        });
        before = after;
    }
    let goals = single_bits(GOALS);
    let began = Instant::now();
    let encoder = AsIs(2 * SIDE + LAMPS);
    let judged = Plausibility::default().judge(&experience, &encoder, 5, &goals, &counts, &mut rng)?;
    let occurring = judged.goals.iter().filter(|j| matches!(j, Judgement::Estimated(_))).count();
    println!(
        "{GOALS} proto-goals, of which {occurring} occur in a batch of 4096, 100 features, 5 actions: {:.2} s by the clock, on one thread",
        began.elapsed().as_secs_f64()
    );
    Ok(())
}
