//! How far one gets without options: what the agent can say of the parts of a way that lie outside its graph.

use serde::{Deserialize, Serialize};

/// Walks that are remembered.
const KEPT: usize = 500;
/// Walks that are asked about a distance.
const ASKED: usize = 20;

/// Walks straight to a region: from how far, and whether they arrived.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Walks {
    /// Oldest first.
    walks: Vec<(f32, bool)>,
}

impl Walks {
    /// One more.
    pub(super) fn count(&mut self, distance: f32, arrived: bool) {
        if self.walks.len() == KEPT {
            self.walks.remove(0);
        }
        self.walks.push((distance, arrived));
    }

    /// How probable it is to arrive from such a distance, by those of the walks that came from the most similar ones; by
    /// Laplace's rule, so that nothing is certain, and even where there was none.
    pub(super) fn probability(&self, distance: f32) -> f32 {
        let mut near: Vec<_> =
            self.walks.iter().map(|(from, arrived)| ((from - distance).abs(), *arrived)).collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        near.truncate(ASKED);
        laplace(near.iter().filter(|(_, arrived)| *arrived).count() as u64, near.len() as u64)
    }
}

/// How probable the next success is after so many in so many trials: Laplace's rule of succession.
pub(super) fn laplace(successes: u64, trials: u64) -> f32 {
    (successes + 1) as f32 / (trials + 2) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn walks_from_similar_distances_tell() {
        let mut walks = Walks::default();
        assert_eq!(walks.probability(1.0), 0.5);
        (0..20).for_each(|_| walks.count(1.0, true));
        (0..20).for_each(|_| walks.count(9.0, false));
        assert_eq!((walks.probability(2.0), walks.probability(8.0)), (21.0 / 22.0, 1.0 / 22.0));
    }
}
