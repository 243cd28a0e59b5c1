//! Which goals are mastered (thesis 8.4.3).

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

/// What came of pursuing a goal.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pursuits {
    count: u64,
    /// The latest ones, oldest first: whether each attained the goal.
    latest: VecDeque<bool>,
    window: usize,
}

impl Pursuits {
    /// None yet; the `window` latest ones are remembered.
    pub fn new(window: usize) -> Self {
        Self { count: 0, latest: VecDeque::new(), window }
    }

    /// Another one.
    pub fn push(&mut self, attained: bool) {
        self.count += 1;
        if self.latest.len() == self.window {
            self.latest.pop_front();
        }
        self.latest.push_back(attained);
    }

    /// How many there were.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Share of the latest ones that attained the goal; 0 of none.
    pub fn success(&self) -> f32 {
        let attained = self.latest.iter().filter(|attained| **attained).count();
        attained as f32 / self.latest.len().max(1) as f32
    }

    /// Whether the goal is mastered: at least κ of a whole window attained it.
    pub fn mastered(&self, kappa: f32) -> bool {
        self.latest.len() == self.window && self.success() >= kappa
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mastery_asks_for_a_share_of_a_whole_window_and_can_be_lost() {
        let mut pursuits = Pursuits::new(5);
        let mut seen = Vec::new();
        for attained in [true, true, true, false, false, false, true] {
            pursuits.push(attained);
            seen.push((pursuits.success(), pursuits.mastered(0.6)));
        }
        let expected = [
            (1.0, false),
            (1.0, false),
            (1.0, false),
            (0.75, false),
            (0.6, true),
            (0.4, false),
            (0.4, false),
        ];
        assert_eq!(seen, expected);
        assert_eq!(pursuits.count(), 7);
    }
}
