//! How often choices are random: a share that falls to a floor, and floors that differ from episode to episode.

use serde::{Deserialize, Serialize};

/// Share of random choices: it falls linearly over the learner's updates, to `end`, or, where there is a ladder, to the
/// episode's own rung of it.
///
/// Ape-X and R2D2 give each of many actors a rung. Here one actor has them one after the other: the first step of an episode
/// draws one, all with the same probability, and the memory keeps it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ExplorationConfig {
    /// ε before the first update; 1 (Mnih 2015).
    pub start: f32,
    /// ε after all updates, where there is no ladder; 0.05 (DI-engine's R2D2 on MiniGrid).
    pub end: f32,
    /// Updates over which it falls.
    pub decay_updates: u64,
    /// Rungs of the ladder; 0 for none.
    pub rungs: u32,
}

impl Default for ExplorationConfig {
    fn default() -> Self {
        Self { start: 1.0, end: 0.05, decay_updates: 1000, rungs: 0 }
    }
}

impl ExplorationConfig {
    /// ε on a rung, counted from 0, after so many updates.
    pub fn epsilon(&self, rung: u32, updates: u64) -> f32 {
        let floor = if self.rungs == 0 { self.end } else { ladder(rung, self.rungs) };
        let done = if self.decay_updates == 0 { 1.0 } else { updates as f64 / self.decay_updates as f64 };
        let (start, done) = (self.start.max(floor), done.min(1.0) as f32);
        start * (1.0 - done) + floor * done
    }

    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the mend.
    pub fn check(&self) -> Result<(), String> {
        for (name, value) in [("start", self.start), ("end", self.end)] {
            if !(0.0..=1.0).contains(&value) {
                return Err(format!("{name} is {value}; it must lie in [0, 1]"));
            }
        }
        Ok(())
    }
}

/// ε of rung `i` of `n`: 0.4^(1 + 7i/(n − 1)) (Ape-X, Horgan 2018, section 4.1); of a single one 0.4.
pub fn ladder(i: u32, n: u32) -> f32 {
    0.4_f64.powf(1.0 + 7.0 * f64::from(i) / f64::from(n.max(2) - 1)) as f32
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
        let plain = ExplorationConfig { start: 1.0, end: 0.2, decay_updates: 100, rungs: 0 };
        let at = |updates| plain.epsilon(3, updates);
        assert_eq!((at(0), at(50), at(1000)), (1.0, 0.6, 0.2));
        let rungs = ExplorationConfig { rungs: 4, ..plain };
        assert_eq!((rungs.epsilon(0, 1000), rungs.epsilon(3, 1000)), (ladder(0, 4), ladder(3, 4)));
        assert_eq!(ExplorationConfig { decay_updates: 0, ..plain }.epsilon(0, 0), 0.2);
        assert!(ExplorationConfig { start: 2.0, ..plain }.check().unwrap_err().contains("start"));
    }
}
