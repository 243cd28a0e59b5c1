//! Picking one of many by numbers: the greatest, or by chance in proportion.

use inroads_envs::Rng;
use rand::RngExt;

/// The index of the greatest of these values; ties go to a random one.
pub fn argmax(values: &[f32], rng: &mut Rng) -> usize {
    let best = greatest(values);
    let ties = values.iter().filter(|v| **v == best).count();
    // With nothing but NaN there is no best, and the first will do.
    let pick = if ties > 1 { rng.random_range(0..ties) } else { 0 };
    values.iter().enumerate().filter(|(_, v)| **v == best).nth(pick).map_or(0, |(i, _)| i)
}

/// The greatest of these values; −∞ of none.
pub(crate) fn greatest(values: &[f32]) -> f32 {
    values.iter().copied().fold(f32::NEG_INFINITY, f32::max)
}

/// `n` indices drawn with replacement, each with a probability proportional to its weight (equations 7.4 and 8.4);
/// uniform when nothing has any weight, none of nothing.
pub fn proportional(weights: &[f64], n: usize, rng: &mut Rng) -> Vec<usize> {
    let mut sums = Vec::with_capacity(weights.len());
    let total = weights.iter().fold(0.0, |sum, weight| {
        sums.push(sum + weight);
        sum + weight
    });
    if weights.is_empty() {
        return Vec::new();
    }
    if total <= 0.0 {
        return (0..n).map(|_| rng.random_range(0..weights.len())).collect();
    }
    let pick = |_| {
        let at = rng.random::<f64>() * total;
        sums.partition_point(|sum| *sum <= at).min(weights.len() - 1)
    };
    (0..n).map(pick).collect()
}

/// Up to `n` different indices, drawn one after the other by their weights, which are above 0 (Efraimidis and Spirakis
/// 2006), in ascending order.
pub fn different(weights: &[f64], n: usize, rng: &mut Rng) -> Vec<usize> {
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
    fn ties_go_to_everybody() {
        let mut rng = Seed(1).stream("test", 0);
        let picks: Vec<_> = (0..300).map(|_| argmax(&[1.0, 2.0, 2.0, 0.0, 2.0], &mut rng)).collect();
        for index in [1, 2, 4] {
            assert!(picks.iter().filter(|p| **p == index).count() > 60);
        }
        assert!(!picks.contains(&0) && !picks.contains(&3));
        assert_eq!(argmax(&[f32::NAN, f32::NAN], &mut rng), 0);
    }

    #[test]
    fn draws_follow_their_weights() {
        let mut rng = Seed(0).stream("test", 0);
        let drawn = proportional(&[1.0, 0.0, 3.0], 4000, &mut rng);
        let count = |i| drawn.iter().filter(|d| **d == i).count();
        assert_eq!(count(1), 0);
        assert!((count(0) as i64 - 1000).abs() < 120, "four standard deviations are 110");
        assert!(proportional(&[], 5, &mut rng).is_empty());
        let uniform = proportional(&[0.0, 0.0], 100, &mut rng);
        assert!(uniform.contains(&0) && uniform.contains(&1));
    }

    #[test]
    fn different_draws_take_everything_when_there_is_room_and_the_heavier_sooner() {
        let mut rng = Seed(0).stream("test", 0);
        assert_eq!(different(&[1.0, 2.0, 0.1], 5, &mut rng), [0, 1, 2]);
        let first = (0..4000).filter(|_| different(&[1.0, 3.0], 1, &mut rng) == [0]).count();
        assert!((first as i64 - 1000).abs() < 120);
    }
}
