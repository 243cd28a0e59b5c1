//! The taxi as a probe: one drives, fetches and drops off, but where to is settled when the episode begins.

use super::Probe;
use crate::{ProtoGoals, taxi::Taxi};

/// Bits for where the taxi and the passenger are; those for the destination follow.
const PLACES: usize = 25 + 5;

impl Probe for Taxi {
    /// Where the taxi is and where the passenger is; never the destination.
    fn controllable(&self) -> Vec<bool> {
        (0..self.proto_goals().len()).map(|bit| bit < PLACES).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Bits, Seed,
        taxi::Rules,
        world::{Layout, World},
    };
    use rand::RngExt;

    #[test]
    fn what_is_not_controllable_stays_and_all_else_comes_and_goes() {
        let mut taxi = Taxi::new(Rules::SPARSE);
        let truth = taxi.controllable();
        let (mut changed, mut bits) = (vec![false; truth.len()], Bits::default());
        let mut rng = Seed(1).stream("walk", 0);
        for episode in 0..2000 {
            taxi.begin(Layout::Random.draw(episode));
            taxi.annotate(&mut bits);
            for _ in 0..200 {
                let before = bits.clone();
                let over = taxi.act(rng.random_range(0..6)).end.is_some();
                taxi.annotate(&mut bits);
                (0..truth.len()).for_each(|bit| changed[bit] |= before.get(bit) != bits.get(bit));
                if over {
                    break;
                }
            }
        }
        assert_eq!(changed, truth);
    }
}
