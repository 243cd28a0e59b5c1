//! Goals about features of a state and about proto-goals.

use inroads_agents::{
    Encode, Key,
    tabular::{key, thousandths},
};
use inroads_envs::{Annotated, Bits};
use serde::{Deserialize, Serialize};

pub use inroads_agents::Goal;

/// Some features of a state have these values, more or less: a ball around a point of some dimensions (ε_g of thesis
/// 6.1.1), all of a state (equation 7.9, for symbols), or the few of its features that matter (9.2.4).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Features {
    /// Which features, and their values.
    pub kept: Vec<(u32, f32)>,
    /// Greatest Euclidean distance over these features that still attains it (ξ of 9.2.4).
    pub tolerance: f32,
    /// Features that a state has.
    pub of: u32,
}

impl Features {
    /// "Be as `s` is" in these features.
    pub fn of(s: &[f32], features: impl IntoIterator<Item = usize>, tolerance: f32) -> Self {
        let kept = features.into_iter().map(|i| (i as u32, s[i])).collect();
        Self { kept, tolerance, of: s.len() as u32 }
    }

    /// Euclidean distance of `s` from it over its features.
    pub fn distance(&self, s: &[f32]) -> f32 {
        self.kept.iter().map(|(i, at)| (s[*i as usize] - at).powi(2)).sum::<f32>().sqrt()
    }
}

impl Goal<Vec<f32>> for Features {
    /// Whether `distance` is within the tolerance; most states are found to be too far after a few features.
    fn reached(&self, s: &Vec<f32>) -> bool {
        let mut left = self.tolerance.powi(2);
        self.kept.iter().all(|(i, at)| {
            left -= (s[*i as usize] - at).powi(2);
            left >= 0.0
        })
    }

    fn kept(&self) -> Vec<(u32, f32)> {
        self.kept.clone()
    }
}

impl Encode for Features {
    fn width(&self) -> usize {
        2 * self.of as usize
    }

    /// Of each feature whether it is asked for, and its value.
    fn write(&self, out: &mut [f32]) {
        out.fill(0.0);
        for (i, at) in &self.kept {
            let i = 2 * *i as usize;
            out[i] = 1.0;
            out[i + 1] = *at;
        }
    }
}

impl Key for Features {
    fn key(&self) -> u128 {
        key(self.kept.iter().map(|(i, at)| (u64::from(*i) << 48) ^ thousandths(*at)))
    }
}

/// All of these proto-goals hold at once: one bit, or the AND of several (thesis 8.2.2, 8.2.3).
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Wanted(pub Bits);

impl<O> Goal<Annotated<O>> for Wanted {
    fn reached(&self, s: &Annotated<O>) -> bool {
        s.bits.contains(&self.0)
    }
}

impl Encode for Wanted {
    fn width(&self) -> usize {
        self.0.len()
    }

    fn write(&self, out: &mut [f32]) {
        out.fill(0.0);
        self.0.ones().for_each(|bit| out[bit] = 1.0);
    }
}

impl Key for Wanted {
    fn key(&self) -> u128 {
        self.0.key()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn features_ask_for_some_and_pass_over_the_rest() {
        let s = vec![1.0, 5.0, 2.0];
        let goal = Features::of(&s, [0, 2], 0.6);
        assert!(
            goal.reached(&s) && goal.reached(&vec![1.3, -80.0, 2.4]) && !goal.reached(&vec![1.6, 5.0, 2.5])
        );
        let mut row = vec![9.0; goal.width()];
        goal.write(&mut row);
        assert_eq!(row, [1.0, 1.0, 0.0, 0.0, 1.0, 2.0]);
        assert_ne!(goal.key(), Features::of(&s, [0, 1], 0.5).key());
    }

    #[test]
    fn wanted_bits_must_all_hold() {
        let mut bits = Bits::new(3);
        bits.set(0);
        bits.set(2);
        let goal = Wanted(bits.clone());
        let mut s = Annotated { seen: (), bits };
        assert!(goal.reached(&s));
        s.bits.clear(3);
        s.bits.set(0);
        assert!(!goal.reached(&s));
        let mut row = [9.0; 3];
        goal.write(&mut row);
        assert_eq!(row, [1.0, 0.0, 1.0]);
    }
}
