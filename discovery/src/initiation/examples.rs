//! Rows that sets are learned from.

use std::sync::Arc;

use inroads_agents::Encoder;
use serde::{Deserialize, Serialize};

/// Reads places of observations as rows.
pub(super) type Places<O> = Arc<dyn Encoder<O> + Send + Sync>;

/// One observation's row.
pub(super) fn row<O>(places: &Places<O>, s: &O) -> Vec<f32> {
    let mut row = vec![0.0; places.width()];
    places.write(s, &mut row);
    row
}

/// The newest examples of either class.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct Examples {
    pub(super) positives: Vec<Vec<f32>>,
    pub(super) negatives: Vec<Vec<f32>>,
}

impl Examples {
    /// Adds examples of one class, of which at most `capacity` are kept: the oldest are forgotten first.
    pub(super) fn add(&mut self, rows: impl Iterator<Item = Vec<f32>>, positive: bool, capacity: usize) {
        let class = if positive { &mut self.positives } else { &mut self.negatives };
        class.extend(rows);
        class.drain(..class.len().saturating_sub(capacity));
    }

    /// How many there are of either class.
    pub(super) fn counts(&self) -> (usize, usize) {
        (self.positives.len(), self.negatives.len())
    }
}
