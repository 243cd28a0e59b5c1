//! Random streams as functions of (run seed, purpose, index).
//!
//! Nothing in Inroads draws from a generator that outlives an episode, so none is ever saved, and a new draw
//! in one place cannot shift the numbers of another.

use rand::SeedableRng;

/// The generator of every stream: portable, and the same on every machine.
pub type Rng = rand_chacha::ChaCha8Rng;

/// The one seed of a run, from which all named streams come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Seed(pub u64);

impl Seed {
    /// A number that depends on the seed, the purpose and the index, and on nothing else.
    pub fn number(self, purpose: &str, index: u64) -> u64 {
        // FNV-1a over the name, then SplitMix64's finaliser (Steele, Lea, Flood 2014) to spread the three.
        let name = purpose.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
        });
        mix(mix(self.0 ^ name.rotate_left(32)).wrapping_add(mix(index ^ name)))
    }

    /// The stream for a purpose and an index (an episode's number, say).
    pub fn stream(self, purpose: &str, index: u64) -> Rng {
        Rng::seed_from_u64(self.number(purpose, index))
    }
}

fn mix(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::RngExt;

    #[test]
    fn a_stream_is_a_function_of_seed_purpose_and_index() {
        let draw = |seed, purpose, index| Seed(seed).stream(purpose, index).random::<u64>();
        assert_eq!(draw(1, "explore", 2), draw(1, "explore", 2));
        let others = [draw(2, "explore", 2), draw(1, "replay", 2), draw(1, "explore", 3)];
        assert!(others.iter().all(|&other| other != draw(1, "explore", 2)));
    }
}
