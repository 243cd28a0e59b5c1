//! Policy evaluation on a table, for small worlds whose answers are known.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{Evaluator, Policy, check};
use crate::{Clip, Context, Key, checkpoint};

/// Settings of [`Table`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TableConfig {
    /// Step size of an update. Large where little is random: the policy changes, and its value must follow.
    pub rate: f32,
    /// γ; 1 is a probability of success (thesis), below 1 it falls with the steps that are still to go (authors' code:
    /// 0.99).
    pub discount: f32,
    /// Value of what was never tried.
    pub initial: f32,
    /// Clips an update.
    pub batch: usize,
    /// Updates after which "earlier" moves on to now (K of 5.1.3).
    pub period: u64,
}

impl Default for TableConfig {
    fn default() -> Self {
        Self { rate: 0.2, discount: 1.0, initial: 0.0, batch: 32, period: 200 }
    }
}

impl TableConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        for (name, value) in [("rate", self.rate), ("initial", self.initial)] {
            if !(0.0..=1.0).contains(&value) {
                return Err(format!("{name} is {value}; it must lie in [0, 1]"));
            }
        }
        if self.period == 0 {
            return Err("period is 0; progress is measured from at least 1 update ago".into());
        }
        check(self.discount, self.batch)
    }
}

/// TD(0) on a table.
#[derive(Clone, Debug)]
pub struct Table {
    config: TableConfig,
    blank: Row,
    /// By goal (none: the one that there is) and state.
    rows: BTreeMap<(Option<u128>, u128), Row>,
    updates: u64,
}

checkpoint!([] Table; plain: rows, updates; parts: );

/// What is known of one state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Row {
    /// Q(s, ·).
    actions: Vec<f32>,
    /// V(s): a mean over what the policy did there when it was last asked, for it may break ties at random.
    now: f32,
    /// V(s) some updates ago.
    then: f32,
}

impl Row {
    fn towards(&mut self, action: usize, target: f32, rate: f32) -> f32 {
        let error = target - self.actions[action];
        self.actions[action] += rate * error;
        error
    }

    /// The policy does this here, as it is now.
    fn chosen(&mut self, action: usize, rate: f32) {
        self.now += rate * (self.actions[action] - self.now);
    }
}

impl Table {
    /// An empty table for `actions` choices.
    pub fn new(actions: usize, config: &TableConfig) -> Self {
        let initial = config.initial;
        let blank = Row { actions: vec![initial; actions], now: initial, then: initial };
        Self { config: config.clone(), blank, rows: BTreeMap::new(), updates: 0 }
    }

    fn row(&self, s: &impl Key, goal: Option<&impl Key>) -> &Row {
        self.rows.get(&(goal.map(Key::key), s.key())).unwrap_or(&self.blank)
    }

    fn row_mut(&mut self, s: &impl Key, goal: Option<&impl Key>) -> &mut Row {
        let blank = &self.blank;
        self.rows.entry((goal.map(Key::key), s.key())).or_insert_with(|| blank.clone())
    }
}

impl<O: Key, G: Key> Evaluator<O, usize, G> for Table {
    fn values(&self, states: &[&O], goal: Option<&G>) -> Vec<f32> {
        states.iter().map(|s| self.row(*s, goal).now).collect()
    }

    fn earlier(&self, states: &[&O], goal: Option<&G>) -> Vec<f32> {
        states.iter().map(|s| self.row(*s, goal).then).collect()
    }

    fn learn(
        &mut self,
        clips: &[Clip<O, usize, G>],
        policy: &Policy<'_, O, usize>,
        ctx: &mut Context,
    ) -> f32 {
        let mut loss = 0.0;
        for clip in clips {
            let rate = self.config.rate * clip.weight;
            let (cumulant, discount) = clip.discounted(self.config.discount);
            let follows = match discount > 0.0 {
                true => discount * self.row(clip.last(), clip.goal).actions[policy(clip.last(), ctx)],
                false => 0.0,
            };
            let (s, action) = (clip.first(), clip.actions[clip.lead]);
            let chosen = policy(s, ctx);
            let row = self.row_mut(s, clip.goal);
            loss += row.towards(action, (cumulant + follows).clamp(0.0, 1.0), rate).powi(2);
            row.chosen(chosen, rate);
        }
        self.updates += 1;
        if self.updates.is_multiple_of(self.config.period) {
            self.rows.values_mut().for_each(|row| row.then = row.now);
        }
        loss / clips.len().max(1) as f32
    }

    fn batch(&self) -> usize {
        self.config.batch
    }
}
