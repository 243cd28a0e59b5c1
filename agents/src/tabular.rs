//! Tabular Q-learning, for small worlds whose answers are known.

use std::collections::BTreeMap;

use rand::RngExt;
use serde::{Deserialize, Serialize};

use crate::{Clip, Context, Learner, Memory, checkpoint};

/// Observations that can name a row of a table.
pub trait Key {
    /// Equal observations have equal keys.
    fn key(&self) -> Vec<i64>;
}

impl Key for Vec<f32> {
    /// Components to the nearest thousandth.
    fn key(&self) -> Vec<i64> {
        self.iter().map(|x| (f64::from(*x) * 1e3).round() as i64).collect()
    }
}

/// Settings of tabular Q-learning.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TabularConfig {
    /// Step size of an update.
    pub rate: f32,
    /// γ.
    pub discount: f32,
    /// Share of random actions while exploring.
    pub epsilon: f32,
    /// Value of what was never tried.
    pub initial: f32,
    /// Clips an update.
    pub batch: usize,
}

impl Default for TabularConfig {
    fn default() -> Self {
        Self { rate: 0.5, discount: 0.99, epsilon: 0.1, initial: 0.0, batch: 8 }
    }
}

/// Q-learning on a table; ties are broken at random (first-index argmax can keep it from ever learning).
#[derive(Clone, Debug)]
pub struct TabularQ {
    config: TabularConfig,
    actions: usize,
    values: BTreeMap<Vec<i64>, Vec<f32>>,
}

checkpoint!([] TabularQ; plain: values; parts: );

impl TabularQ {
    /// An empty table for `actions` choices.
    pub fn new(actions: usize, config: &TabularConfig) -> Self {
        Self { config: config.clone(), actions, values: BTreeMap::new() }
    }

    /// The value of every action at a state.
    pub fn values(&self, s: &impl Key) -> Vec<f32> {
        self.values.get(&s.key()).cloned().unwrap_or_else(|| vec![self.config.initial; self.actions])
    }
}

impl<O: Key> Learner<O, usize> for TabularQ {
    fn act(&self, _: &mut Memory, s: &O, ctx: &mut Context) -> usize {
        if ctx.explore && ctx.acting.random::<f32>() < self.config.epsilon {
            return ctx.acting.random_range(0..self.actions);
        }
        let values = self.values(s);
        let best = values.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        let ties: Vec<_> = (0..self.actions).filter(|&a| values[a] == best).collect();
        ties[ctx.acting.random_range(0..ties.len())]
    }

    fn learn(&mut self, clips: &[Clip<O, usize>], _: &mut Context) -> f32 {
        let mut error = 0.0;
        for clip in clips {
            let next = self.values(&clip.observations[1]).into_iter().fold(f32::NEG_INFINITY, f32::max);
            let target = clip.reward + if clip.terminal { 0.0 } else { self.config.discount * next };
            let (actions, initial) = (self.actions, self.config.initial);
            let row = self.values.entry(clip.observations[0].key()).or_insert_with(|| vec![initial; actions]);
            let value = &mut row[clip.actions[0]];
            error += (target - *value).powi(2);
            *value += self.config.rate * (target - *value);
        }
        error / clips.len().max(1) as f32
    }

    fn batch(&self) -> usize {
        self.config.batch
    }
}
