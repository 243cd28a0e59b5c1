//! How desirable goals are, and draws by it (thesis 8.3.2).

use inroads_envs::Rng;
use rand::RngExt;

use super::space::Candidate;

/// novel(g) = 1/√N(g) (equation 8.3); 1 for what was never attained.
pub fn novelty(goal: &Candidate) -> f64 {
    1.0 / (goal.attained.max(1) as f64).sqrt()
}

/// u(g) = R(g) + novel(g) (8.3.2), or 0 where rewards are so bad that this is below.
pub fn utility(goal: &Candidate) -> f64 {
    (goal.mean_reward() + novelty(goal)).max(0.0)
}

/// Up to `n` different indices, drawn one after the other by their weights, which are above 0 (Efraimidis and Spirakis
/// 2006), in ascending order.
pub fn draw_different(weights: &[f64], n: usize, rng: &mut Rng) -> Vec<usize> {
    let mut keys: Vec<_> =
        weights.iter().enumerate().map(|(i, weight)| (rng.random::<f64>().ln() / weight, i)).collect();
    keys.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut drawn: Vec<_> = keys.into_iter().take(n).map(|(_, i)| i).collect();
    drawn.sort_unstable();
    drawn
}

#[cfg(test)]
mod tests {
    use super::*;
    use inroads_envs::Seed;

    #[test]
    fn different_draws_take_everything_when_there_is_room_and_the_heavier_sooner() {
        let mut rng = Seed(0).stream("test", 0);
        assert_eq!(draw_different(&[1.0, 2.0, 0.1], 5, &mut rng), [0, 1, 2]);
        let first = (0..4000).filter(|_| draw_different(&[1.0, 3.0], 1, &mut rng) == [0]).count();
        assert!((first as i64 - 1000).abs() < 120);
    }
}
