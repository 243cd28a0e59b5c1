//! Novelty by counting states one by one.

use std::collections::BTreeMap;

use super::Novelty;
use crate::{
    Context, Key, checkpoint,
    experience::{Moment, Seen},
};

/// Counts of whole states. It does not generalise: of a state that was never seen it knows nothing, however alike it is
/// to one that was.
#[derive(Clone, Debug, Default)]
pub struct Counts {
    visits: BTreeMap<u128, u64>,
}

checkpoint!([] Counts; plain: visits; parts: );

impl Counts {
    /// How often `s` was visited.
    pub fn of(&self, s: &impl Key) -> u64 {
        self.visits.get(&s.key()).copied().unwrap_or(0)
    }

    /// `s` was visited.
    pub fn count(&mut self, s: &impl Key) {
        *self.visits.entry(s.key()).or_default() += 1;
    }
}

impl<O: Key> Novelty<O> for Counts {
    fn bonus(&self, s: &O) -> f32 {
        1.0 / (self.of(s).max(1) as f32).sqrt()
    }

    fn visit(&mut self, at: Moment, all: &dyn Seen<O>, _: &mut Context) {
        if let Some(s) = all.seen(at) {
            self.count(s);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_state_seen_four_times_is_half_as_new() {
        let mut counts = Counts::default();
        let (often, never) = (vec![1.0_f32, 2.0], vec![1.0, 3.0]);
        (0..4).for_each(|_| counts.count(&often));
        assert_eq!((counts.bonus(&often), counts.bonus(&never)), (0.5, 1.0));
        assert_eq!((counts.of(&often), counts.of(&never)), (4, 0));
    }
}
