//! Shares of random choices that differ from episode to episode.

use crate::dqn::Epsilon;

/// ε of rung `i`, counted from 0, of `n`: 0.4^(1 + 7i/(n − 1)) (Ape-X, Horgan 2018, section 4.1); of a single one 0.4.
///
/// Ape-X and R2D2 give each of many actors a rung for good. Here an actor has them one after the other: the first step of an
/// episode draws one, all with the same probability, and the memory keeps it.
pub fn ladder(i: u32, n: u32) -> f32 {
    0.4_f64.powf(1.0 + 7.0 * f64::from(i) / f64::from(n.max(2) - 1)) as f32
}

/// ε after so many updates in an episode on a rung: it falls to that of the rung, where there is a ladder.
pub(super) fn epsilon(plain: Epsilon, rungs: u32, rung: u32, updates: u64) -> f32 {
    if rungs == 0 {
        return plain.at(updates);
    }
    let end = ladder(rung, rungs);
    Epsilon { start: plain.start.max(end), end, ..plain }.at(updates)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ladder_is_the_papers() {
        let rungs = |n| (0..n).map(|i| ladder(i, n)).collect::<Vec<_>>();
        for (found, expected) in rungs(4).iter().zip([0.4, 0.0472, 0.0056, 0.00066]) {
            assert!((found - expected).abs() < 5e-5, "{found} {expected}");
        }
        let eight = [0.4, 0.16, 0.064, 0.0256, 0.0102, 0.0041, 0.0016, 0.00066];
        for (found, expected) in rungs(8).iter().zip(eight) {
            assert!((found - expected).abs() < 5e-5, "{found} {expected}");
        }
        assert_eq!(rungs(1), [0.4]);
    }

    #[test]
    fn the_share_falls_to_the_end_or_to_the_rung() {
        let plain = Epsilon { start: 1.0, end: 0.2, updates: 100 };
        let near = |found: f32, expected: f32| assert!((found - expected).abs() < 1e-6, "{found} {expected}");
        near(epsilon(plain, 0, 3, 1000), 0.2);
        near(epsilon(plain, 4, 0, 1000), 0.4);
        near(epsilon(plain, 4, 3, 1000), ladder(3, 4));
        near(epsilon(plain, 4, 3, 0), 1.0);
        // It never rises.
        near(epsilon(Epsilon { start: 0.1, ..plain }, 4, 0, 0), 0.4);
    }
}
