//! The policy over options (3.1.2): which skill to call where.

mod deep;
mod scan;
mod tabular;

pub use deep::DeepOverSkills;
pub use scan::Scan;
pub use tabular::TabularOverSkills;

use std::ops::Range;

use inroads_agents::{Checkpoint, Context, Experience, draw::argmax};
use inroads_envs::Rng;
use serde::{Deserialize, Serialize};

use crate::SkillId;

/// One decision and what came of it, as a range of the experience: an SMDP transition.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Choice {
    /// The episode's number.
    pub episode: u64,
    /// The steps from the decision to the next one.
    pub steps: Range<u32>,
    /// The skill that was called.
    pub skill: SkillId,
    /// Σ γᵗ r over those steps.
    pub reward: f32,
    /// γ to the number of steps.
    pub discount: f32,
    /// Whether the episode terminated with them. A truncation is not this.
    pub terminal: bool,
}

/// Chooses among admissible skills and learns their values from the task's reward alone.
pub trait PolicyOverSkills<O>: Checkpoint {
    /// One of the `admissible` skills (never empty): explores when `ctx.explore`.
    fn choose(&self, s: &O, admissible: &[SkillId], ctx: &mut Context) -> SkillId;

    /// Remembers a decision.
    fn record<A>(&mut self, choice: Choice, all: &Experience<O, A>);

    /// One update by equation 3.3, where `admissible` gives the skills that may be called at a state.
    fn learn<A>(
        &mut self,
        all: &Experience<O, A>,
        admissible: &dyn Fn(&O) -> Vec<SkillId>,
        ctx: &mut Context,
    );

    /// A new skill joins: its value is everywhere the greatest that any known skill has at one of the states
    /// in which its subgoal was triggered (3.1.2, optimism under uncertainty).
    fn grow(&mut self, triggers: &[O]);

    /// The values of all skills at `s`.
    fn values(&self, s: &O) -> Vec<f32>;

    /// Updates made so far.
    fn updates(&self) -> u64;
}

/// ε-greedy exploration over decisions: linear from `start` to `end`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Epsilon {
    /// Share of random choices at first (authors' code: 1).
    pub start: f32,
    /// Share of random choices at last (authors' code: 0.05).
    pub end: f32,
    /// Decisions from the one to the other (authors' code: 50,000; with its options 100 steps long and 300
    /// episodes that is never reached, so the default here is shorter).
    pub decisions: u64,
}

impl Default for Epsilon {
    fn default() -> Self {
        Self { start: 1.0, end: 0.05, decisions: 10_000 }
    }
}

impl Epsilon {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        for (name, share) in [("start", self.start), ("end", self.end)] {
            if !(0.0..=1.0).contains(&share) {
                return Err(format!("{name} is {share}; a share of random choices lies in [0, 1]"));
            }
        }
        Ok(())
    }

    /// The share of random choices after `decisions` decisions.
    pub fn at(&self, decisions: u64) -> f32 {
        let progress = (decisions as f32 / self.decisions.max(1) as f32).min(1.0);
        self.start + (self.end - self.start) * progress
    }
}

/// The admissible skill of the greatest value; ties go to a random one.
fn greedy(values: &[f32], admissible: &[SkillId], rng: &mut Rng) -> SkillId {
    let admitted: Vec<_> = admissible.iter().map(|k| values[k.index()]).collect();
    admissible[argmax(&admitted, rng)]
}
