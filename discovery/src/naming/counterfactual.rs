//! "Be as this state is in what was new about it": the features that explain a novelty (thesis 9.2.3, 9.2.4).

use serde::{Deserialize, Serialize};

use super::Name;
use crate::Features;

/// What a drop of novelty is measured by (`decisions.md`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DropRule {
    /// Δₙ, the difference between the most novel and the most boring state.
    #[default]
    Relative,
    /// Nothing: the bonus itself (authors' code).
    Absolute,
}

/// Which features are reset to their values in the boring state at a time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Resets {
    /// One (9.2.3.1).
    #[default]
    Single,
    /// One, and then each two of those that did not matter one by one. Two features may be new in such a way that the
    /// novelty stays as long as either is left as it is: both are new by themselves, or each of them has never met the
    /// boring value of the other. No single reset shows that.
    Pairs,
}

/// Settings of [`Counterfactual`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CounterfactualConfig {
    /// What a drop is measured by.
    pub drop: DropRule,
    /// A feature is kept if resetting it lowers the novelty by at least so much: a share of Δₙ (ours: 0.3), or an
    /// amount (authors' code: 0.1). Above 0.
    pub threshold: f32,
    /// Which features are reset at a time.
    pub resets: Resets,
    /// ξ: greatest Euclidean distance over the kept features that still attains the goal. Features that are whole
    /// numbers need no more than less than 1.
    pub tolerance: f32,
}

impl Default for CounterfactualConfig {
    fn default() -> Self {
        Self { drop: DropRule::Relative, threshold: 0.3, resets: Resets::Single, tolerance: 0.5 }
    }
}

impl CounterfactualConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        if !(self.threshold > 0.0 && self.threshold <= 1.0) {
            let why = "a drop is a share of the difference, or of a bonus of at most 1: above 0 and up to 1";
            return Err(format!("threshold is {}; {why}", self.threshold));
        }
        if !(self.tolerance.is_finite() && self.tolerance >= 0.0) {
            return Err(format!("tolerance is {}; a distance is 0 or above", self.tolerance));
        }
        Ok(())
    }
}

/// Keeps the features without which the novel state would not be novel.
///
/// Each feature in which the two states differ is reset in turn, and kept if that lowers the novelty enough (9.2.3.2).
/// When none does, there is no goal: falling back to the whole state would make chapter 7 of chapter 9 and say nothing.
#[derive(Clone, Debug, Default)]
pub struct Counterfactual {
    config: CounterfactualConfig,
}

impl Counterfactual {
    /// Names goals by counterfactuals.
    pub fn new(config: &CounterfactualConfig) -> Self {
        Self { config: config.clone() }
    }
}

impl Name<Vec<f32>, Features> for Counterfactual {
    fn name(
        &self,
        novel: &Vec<f32>,
        boring: &Vec<f32>,
        novelty: &dyn Fn(&Vec<f32>) -> f32,
    ) -> Option<Features> {
        let most = novelty(novel);
        let enough = match self.config.drop {
            DropRule::Relative => self.config.threshold * (most - novelty(boring)),
            DropRule::Absolute => self.config.threshold,
        };
        let matters = |reset: &[usize]| {
            let mut counterfactual = novel.clone();
            reset.iter().for_each(|i| counterfactual[*i] = boring[*i]);
            let drop = most - novelty(&counterfactual);
            drop > 0.0 && drop >= enough
        };
        let differing = (0..novel.len()).filter(|i| novel[*i] != boring[*i]);
        let (mut kept, rest): (Vec<_>, Vec<_>) = differing.partition(|i| matters(&[*i]));
        if self.config.resets == Resets::Pairs {
            for (n, i) in rest.iter().enumerate() {
                kept.extend(rest[..n].iter().filter(|j| matters(&[*i, **j])).flat_map(|j| [*i, *j]));
            }
            kept.sort_unstable();
            kept.dedup();
        }
        (!kept.is_empty()).then(|| Features::of(novel, kept, self.config.tolerance))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use inroads_agents::{
        Context, Novelty,
        novelty::{Counts, FeatureCounts, FeatureCountsConfig},
    };
    use inroads_envs::Seed;

    /// The features that are kept, where a state was visited as often as `visits` says.
    fn kept(resets: Resets, mut novelty: impl Novelty<Vec<f32>>, states: &[[f32; 3]; 2]) -> Option<Vec<u32>> {
        // Features 0 and 1 take on values 0 and 1 freely; 2 is noise.
        let bits = |step: u32| [step & 1, step >> 1 & 1, step >> 2 & 3].map(|bit| bit as f32).to_vec();
        let mut seen: Vec<_> = (0..400).map(bits).collect();
        // And now and then both are 2, or one of them is 3, where the other was 0.
        for (a, b) in [(2.0, 2.0), (3.0, 0.0), (0.0, 3.0)] {
            seen.extend((0..20).map(|step| vec![a, b, (step % 4) as f32]));
        }
        let mut ctx = Context::training(Seed(0), 0);
        (0..seen.len() as u32).for_each(|step| novelty.visit((0, step), &seen, &mut ctx));
        let config = CounterfactualConfig { resets, ..Default::default() };
        let [novel, boring] = states.map(|s| s.to_vec());
        let goal = Counterfactual::new(&config).name(&novel, &boring, &|s| novelty.bonus(s));
        goal.map(|goal| goal.kept.iter().map(|(i, _)| *i).collect())
    }

    fn generalising() -> FeatureCounts {
        FeatureCounts::new(&FeatureCountsConfig { expected: 0.5, ..Default::default() })
    }

    #[test]
    fn what_is_new_is_kept_and_the_rest_eliminated() {
        let found = kept(Resets::Single, generalising(), &[[1.0, 9.0, 3.0], [0.0, 0.0, 0.0]]);
        assert_eq!(found, Some(vec![1]));
        // 3 and 1 are familiar and have never met; each was met by the boring value of the other.
        let found = kept(Resets::Single, generalising(), &[[3.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        assert_eq!(found, Some(vec![0, 1]));
    }

    #[test]
    fn features_that_are_new_only_together_need_resets_of_two() {
        // Both are new by themselves: without the one, the other is new still.
        let both = [[9.0, 9.0, 2.0], [0.0, 0.0, 0.0]];
        assert_eq!(kept(Resets::Single, generalising(), &both), None);
        assert_eq!(kept(Resets::Pairs, generalising(), &both), Some(vec![0, 1]));
        // 3 and 3 have never met. Neither has either of them met a 2, which was always with a 2.
        let crossed = [[3.0, 3.0, 1.0], [2.0, 2.0, 0.0]];
        assert_eq!(kept(Resets::Single, generalising(), &crossed), None);
        assert_eq!(kept(Resets::Pairs, generalising(), &crossed), Some(vec![0, 1]));
    }

    #[test]
    fn counts_of_whole_states_explain_nothing() {
        let states = [[1.0, 9.0, 3.0], [0.0, 0.0, 0.0]];
        assert_eq!(kept(Resets::Single, Counts::default(), &[[1.0, 9.0, 3.0], [2.0, 2.0, 0.0]]), None);
        // Only where the counterfactual happens to be a state that was seen does a reset show anything.
        assert_eq!(kept(Resets::Single, Counts::default(), &states), Some(vec![1]));
    }
}
