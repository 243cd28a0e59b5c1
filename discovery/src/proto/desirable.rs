//! How desirable goals are (thesis 8.3.2).

use super::space::Candidate;

/// novel(g) = 1/√N(g) (equation 8.3); 1 for what was never attained.
pub fn novelty(goal: &Candidate) -> f64 {
    1.0 / (goal.attained.max(1) as f64).sqrt()
}

/// u(g) = R(g) + novel(g) (8.3.2), or 0 where rewards are so bad that this is below.
pub fn utility(goal: &Candidate) -> f64 {
    (goal.mean_reward() + novelty(goal)).max(0.0)
}
