//! What `algorithms.md` 14 asks of RND, with its numbers.

use inroads_envs::Seed;
use rand::seq::SliceRandom;

use super::*;
use crate::{Bag, Checkpoint, encode::Encoder};

/// A state of 128 by its number.
struct Numbered;

impl Encoder<usize> for Numbered {
    fn width(&self) -> usize {
        128
    }

    fn write(&self, state: &usize, out: &mut [f32]) {
        out.fill(0.0);
        out[*state] = 1.0;
    }
}

fn rnd(config: &RndConfig, seed: u64) -> Rnd<usize> {
    Rnd::new(Arc::new(Numbered), config, Backend::of_tests(), &mut Seed(seed).stream("weights", 0))
}

fn config() -> RndConfig {
    let torso = TorsoConfig { hidden: vec![64], ..TorsoConfig::default() };
    RndConfig { torso, outputs: 32, rate: 1e-3, warm_up: 100, batch: 8, ..RndConfig::default() }
}

/// States that are visited in some order, one update a visit.
fn lived(config: &RndConfig, seed: u64, counts: impl Fn(usize) -> usize) -> Rnd<usize> {
    let mut all: Vec<usize> = (0..64).flat_map(|state| vec![state; counts(state)]).collect();
    all.shuffle(&mut Seed(seed).stream("order", 0));
    let (mut rnd, mut ctx) = (rnd(config, seed), Context::training(Seed(seed), 0));
    (0..all.len() as u32).for_each(|step| rnd.visit((0, step), &all, &mut ctx));
    rnd
}

fn bonuses(rnd: &Rnd<usize>, states: std::ops::Range<usize>) -> Vec<f32> {
    let states: Vec<_> = states.collect();
    rnd.bonuses(&states.iter().collect::<Vec<_>>())
}

/// Ranks from 0, equal values in the middle of theirs.
fn ranks(values: &[f32]) -> Vec<f32> {
    let rank = |x: &f32| {
        let (below, equal) = values
            .iter()
            .fold((0, 0), |(below, equal), y| (below + usize::from(y < x), equal + usize::from(y == x)));
        below as f32 + (equal as f32 - 1.0) / 2.0
    };
    values.iter().map(rank).collect()
}

#[test]
fn what_it_learned_from_is_ten_times_less_new_than_what_it_did_not() {
    let rnd = lived(&RndConfig { batch: 32, ..config() }, 0, |_| 33);
    assert!(rnd.updates() >= 2000, "{}", rnd.updates());
    let mean = |states| {
        let found = bonuses(&rnd, states);
        found.iter().sum::<f32>() / found.len() as f32
    };
    let (seen, unseen) = (mean(0..64), mean(64..128));
    assert!(seen < 0.1 * unseen, "{seen} {unseen}");
}

#[test]
fn it_ranks_states_as_counts_do() {
    let counts = |state: usize| [1, 4, 16, 64, 256][state % 5];
    // Each visit is learned from once: replayed for long enough, all states become known, and ranks are chance.
    let rnd = lived(&RndConfig { batch: 1, ..config() }, 1, counts);
    let (found, truth) = (
        ranks(&bonuses(&rnd, 0..64)),
        ranks(&(0..64).map(|state| (counts(state) as f32).recip()).collect::<Vec<_>>()),
    );
    let mean = 63.0 / 2.0;
    let sum = |x: &[f32], y: &[f32]| x.iter().zip(y).map(|(a, b)| (a - mean) * (b - mean)).sum::<f32>();
    let correlation = sum(&found, &truth) / (sum(&found, &found) * sum(&truth, &truth)).sqrt();
    assert!(correlation > 0.8, "{correlation}");
}

#[test]
fn a_restored_one_goes_on_to_the_same_bits() {
    let config = RndConfig { updates_per_visit: 0.5, warm_up: 10, ..config() };
    let all: Vec<usize> = (0..80).map(|i| i * i % 64).collect();
    let live = |rnd: &mut Rnd<usize>, steps: std::ops::Range<u32>| {
        let mut ctx = Context::training(Seed(3), u64::from(steps.start));
        steps.for_each(|step| rnd.visit((0, step), &all, &mut ctx));
    };
    let saved = |rnd: &Rnd<usize>| {
        let mut bag = Bag::default();
        rnd.save(&mut bag);
        bag
    };
    let mut one = rnd(&config, 1);
    live(&mut one, 0..41);
    let mut restored = rnd(&config, 2);
    restored.load(&saved(&one)).unwrap();
    live(&mut one, 41..80);
    live(&mut restored, 41..80);
    assert_eq!(one.updates(), 36, "one every second visit from the 10th on");
    assert!(saved(&one) == saved(&restored));
    let bits = |rnd: &Rnd<usize>| bonuses(rnd, 0..128).iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&one), bits(&restored));
    assert_eq!(bits(&one), bits(&one.clone()));
}

#[test]
fn visits_are_forgotten_with_their_episodes_and_beyond_the_capacity() {
    /// Episodes before number 5 are forgotten.
    struct Late;
    impl Seen<usize> for Late {
        fn seen(&self, (episode, _): Moment) -> Option<&usize> {
            (episode >= 5).then_some(&7)
        }

        fn oldest(&self) -> u64 {
            5
        }
    }
    let mut rnd = rnd(&RndConfig { capacity: 3, ..config() }, 0);
    let mut ctx = Context::training(Seed(0), 0);
    rnd.visits.extend([(3, 0), (4, 0)]);
    rnd.visit((5, 0), &Late, &mut ctx);
    assert_eq!(rnd.visits, [(5, 0)]);
    (1..5).for_each(|step| rnd.visit((5, step), &Late, &mut ctx));
    assert_eq!(rnd.visits, [(5, 2), (5, 3), (5, 4)]);
    assert!(RndConfig { outputs: 0, ..config() }.check().unwrap_err().contains("outputs"));
    assert_eq!(RndConfig::default().check(), Ok(()));
}
