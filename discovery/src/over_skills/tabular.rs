//! The policy over options as a table, for small worlds whose answers are known.

use std::collections::BTreeMap;

use inroads_agents::{Context, Experience, Key, checkpoint};
use rand::RngExt;

use super::{Choice, Epsilon, PolicyOverSkills, greedy};
use crate::SkillId;

/// SMDP Q-learning on a table.
pub struct TabularOverSkills {
    values: BTreeMap<u128, Vec<f32>>,
    /// The value of each skill at states that were never visited: one a skill.
    defaults: Vec<f32>,
    rate: f32,
    epsilon: Epsilon,
    /// The newest decision, learned from at once.
    newest: Option<Choice>,
    decisions: u64,
    updates: u64,
}

checkpoint!([] TabularOverSkills; plain: values, defaults, newest, decisions, updates; parts: );

impl TabularOverSkills {
    /// A table for the global option only, whose values begin at 0 and move by `rate` towards their targets.
    pub fn new(rate: f32, epsilon: Epsilon) -> Self {
        Self {
            values: BTreeMap::new(),
            defaults: vec![0.0],
            rate,
            epsilon,
            newest: None,
            decisions: 0,
            updates: 0,
        }
    }

    fn row(&self, key: u128) -> Vec<f32> {
        self.values.get(&key).unwrap_or(&self.defaults).clone()
    }
}

impl<O: Key> PolicyOverSkills<O> for TabularOverSkills {
    fn choose(&self, s: &O, admissible: &[SkillId], ctx: &mut Context) -> SkillId {
        if ctx.explore && ctx.acting.random::<f32>() < self.epsilon.at(self.decisions) {
            return admissible[ctx.acting.random_range(0..admissible.len())];
        }
        greedy(&self.row(s.key()), admissible, &mut ctx.acting)
    }

    fn record<A>(&mut self, choice: Choice, _: &Experience<O, A>) {
        self.decisions += 1;
        self.newest = Some(choice);
    }

    fn learn<A>(&mut self, all: &Experience<O, A>, admissible: &dyn Fn(&O) -> Vec<SkillId>, _: &mut Context) {
        let Some(choice) = self.newest.take() else { return };
        let Some(episode) = all.episode(choice.episode) else { return };
        let (before, after) = (
            &episode.observations[choice.steps.start as usize],
            &episode.observations[choice.steps.end as usize],
        );
        let next = self.row(after.key());
        let best = admissible(after).iter().map(|k| next[k.index()]).fold(f32::NEG_INFINITY, f32::max);
        let target = choice.reward + if choice.terminal { 0.0 } else { choice.discount * best };
        let defaults = &self.defaults;
        let row = self.values.entry(before.key()).or_insert_with(|| defaults.clone());
        let value = &mut row[choice.skill.index()];
        *value += self.rate * (target - *value);
        self.updates += 1;
    }

    fn grow(&mut self, triggers: &[O]) {
        let best = triggers.iter().flat_map(|s| self.row(s.key())).fold(f32::NEG_INFINITY, f32::max);
        let best = if best.is_finite() { best } else { 0.0 };
        self.defaults.push(best);
        self.values.values_mut().for_each(|row| row.push(best));
    }

    fn values(&self, s: &O) -> Vec<f32> {
        self.row(s.key())
    }

    fn updates(&self) -> u64 {
        self.updates
    }
}
