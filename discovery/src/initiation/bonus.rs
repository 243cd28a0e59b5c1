//! Optimism against the pessimistic bias of learning a set while acting from it alone (thesis 5.1.3): a state stays in
//! the set while the policy may still improve there.

use std::collections::BTreeMap;

use inroads_agents::Key;
use serde::{Deserialize, Serialize};

/// B(s), which is added to the probability of success before it is compared with the threshold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, tag = "kind", rename_all = "snake_case")]
pub enum Bonus {
    /// None.
    #[default]
    None,
    /// B₁ = |Vᵗ(s) − Vᵗ⁻ᴷ(s)|: where competence rises or falls. For states that cannot be counted.
    Progress,
    /// B₂ = c/√N(s, o), where N counts the executions from that state; c where there were none.
    Count {
        /// c (authors, with 250 starts: 0.1 to 0.5).
        c: f32,
    },
}

impl Bonus {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        match self {
            Self::Count { c } if !(c.is_finite() && *c >= 0.0) => {
                Err(format!("c is {c}; it must be a number of 0 or above"))
            }
            _ => Ok(()),
        }
    }

    /// B(s), by what the value is and was there, and how often the skill was executed from there.
    pub(super) fn of(&self, now: f32, earlier: f32, executions: u64) -> f32 {
        match self {
            Self::None => 0.0,
            Self::Progress => (now - earlier).abs(),
            Self::Count { c } => c / (executions.max(1) as f32).sqrt(),
        }
    }
}

/// N(s, o) of one skill.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Starts(BTreeMap<u128, u64>);

impl Starts {
    /// The skill was executed from `s`.
    pub(super) fn count(&mut self, s: &impl Key) {
        *self.0.entry(s.key()).or_default() += 1;
    }

    pub(super) fn of(&self, s: &impl Key) -> u64 {
        self.0.get(&s.key()).copied().unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bonuses_are_what_section_5_1_3_says() {
        let mut starts = Starts::default();
        let (often, never) = (vec![1.0_f32], vec![2.0]);
        (0..4).for_each(|_| starts.count(&often));
        let count = Bonus::Count { c: 0.5 };
        assert_eq!([&often, &never].map(|s| count.of(0.2, 0.9, starts.of(s))), [0.25, 0.5]);
        assert!((Bonus::Progress.of(0.2, 0.9, 0) - 0.7).abs() < 1e-6);
        assert_eq!(Bonus::None.of(0.2, 0.9, 0), 0.0);
        assert!(Bonus::Count { c: -1.0 }.check().unwrap_err().starts_with("c is -1"));
    }
}
