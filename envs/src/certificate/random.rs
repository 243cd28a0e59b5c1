//! How random actions fare.

use serde::Serialize;

use super::Options;
use crate::{End, Environment, Seed, check};

/// What came of actions that are drawn uniformly from the action space.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Random {
    /// Episodes played.
    pub episodes: u64,
    /// Further episodes, in which the domain refused an action that its spec admits. They count nowhere else. Not 0 only of
    /// a domain at fault, which [`check`](crate::check::check) says more of.
    pub refused: u64,
    /// Steps in all of them.
    pub steps: u64,
    /// Those that succeeded.
    pub successes: u64,
    /// Their share.
    pub success: f64,
    /// Wilson's 95 % interval of the share.
    pub interval: [f64; 2],
    /// Episodes that terminated, with success or without.
    pub terminated: u64,
    /// Steps of an episode.
    pub length: Spread,
    /// The undiscounted return of an episode.
    pub returns: Spread,
    /// Steps of the shortest episode that succeeded.
    pub shortest_success: Option<u64>,
}

/// Where numbers lie.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// Their mean.
    pub mean: f64,
    /// Their standard deviation, that of a population.
    pub deviation: f64,
    /// The least.
    pub least: f64,
    /// The greatest.
    pub greatest: f64,
}

/// Numbers that are added one by one, after Welford (1962).
#[derive(Default)]
struct Sum {
    count: f64,
    mean: f64,
    squares: f64,
    range: Option<[f64; 2]>,
}

impl Sum {
    fn add(&mut self, x: f64) {
        self.count += 1.0;
        let from = x - self.mean;
        self.mean += from / self.count;
        self.squares += from * (x - self.mean);
        self.range = Some(self.range.map_or([x; 2], |[least, greatest]| [least.min(x), greatest.max(x)]));
    }

    /// All zero when there are none.
    fn spread(&self) -> Spread {
        let [least, greatest] = self.range.unwrap_or_default();
        Spread { mean: self.mean, deviation: (self.squares / self.count.max(1.0)).sqrt(), least, greatest }
    }
}

/// Plays episodes with random actions. Episode `i` has the seed `options.seed + i`.
pub(super) fn play<E>(env: &mut E, options: &Options) -> Random
where
    E: Environment<Action: check::Drawn> + ?Sized,
{
    let (spec, mut length, mut returns) = (env.spec().clone(), Sum::default(), Sum::default());
    let (mut episodes, mut refused, mut all) = (0, 0, 0);
    let (mut successes, mut terminated, mut shortest) = (0, 0, None);
    'episodes: while episodes + refused < options.episodes && all < options.steps {
        let seed = options.seed.wrapping_add(episodes + refused);
        let mut rng = Seed(seed).stream("random policy", 0);
        let (mut steps, mut earned, mut succeeded) = (0_u64, 0.0, false);
        env.reset(seed);
        while steps < options.steps {
            let action = check::Drawn::legal(&spec.action, &mut rng);
            let Ok(step) = env.step(&action) else {
                refused += 1;
                continue 'episodes;
            };
            steps += 1;
            earned += f64::from(step.reward);
            if let Some(end) = step.end {
                terminated += u64::from(end == End::Terminated);
                succeeded = spec.succeeded(&step);
                break;
            }
        }
        if succeeded {
            successes += 1;
            shortest = Some(shortest.map_or(steps, |least: u64| least.min(steps)));
        }
        episodes += 1;
        all += steps;
        length.add(steps as f64);
        returns.add(earned);
    }
    Random {
        episodes,
        refused,
        steps: all,
        successes,
        success: successes as f64 / episodes.max(1) as f64,
        interval: wilson(successes, episodes),
        terminated,
        length: length.spread(),
        returns: returns.spread(),
        shortest_success: shortest,
    }
}

/// Quantile of the normal distribution for 95 %, both sides.
const Z: f64 = 1.959_964;

/// Wilson's interval (1927) of a share: as it does not collapse at 0, "never seen" is not "never".
fn wilson(successes: u64, of: u64) -> [f64; 2] {
    if of == 0 {
        return [0.0, 1.0];
    }
    let (n, share) = (of as f64, successes as f64 / of as f64);
    let scale = 1.0 + Z * Z / n;
    let middle = (share + Z * Z / (2.0 * n)) / scale;
    let half = Z / scale * (share * (1.0 - share) / n + Z * Z / (4.0 * n * n)).sqrt();
    [(middle - half).max(0.0), (middle + half).min(1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Refused, Spec, Step, TimeLimit, corridor::Corridor};

    #[test]
    fn wilsons_intervals_are_those_of_the_books() {
        let near = |[a, b]: [f64; 2], [c, d]: [f64; 2]| (a - c).abs() < 1e-4 && (b - d).abs() < 1e-4;
        // Newcombe (1998), table I, method 3: 81 of 263, 15 of 148, 0 of 20, 1 of 29.
        assert!(near(wilson(81, 263), [0.2553, 0.3662]));
        assert!(near(wilson(15, 148), [0.0624, 0.1605]));
        assert!(near(wilson(0, 20), [0.0, 0.1611]));
        assert!(near(wilson(1, 29), [0.0061, 0.1718]));
        assert_eq!(wilson(0, 0), [0.0, 1.0]);
    }

    #[test]
    fn a_corridor_of_three_cells_is_walked_at_random_as_arithmetic_has_it() {
        // From the first cell: right, right in two steps (1/4); within four steps, any of the 16 rows of choices that
        // has come two to the right by then: RR (4 of 16), LRR (2), RLRR (1), LLRR (1).
        let mut env = TimeLimit::new(Corridor::new(3), 4);
        let found = play(&mut env, &Options { episodes: 20_000, ..Options::default() });
        let [low, high] = found.interval;
        assert!(low < 0.5 && 0.5 < high && high - low < 0.02, "{found:?}");
        assert_eq!((found.episodes, found.shortest_success), (20_000, Some(2)));
        assert_eq!(found.terminated, found.successes);
        assert_eq!((found.length.least, found.length.greatest), (2.0, 4.0));
        assert_eq!((found.returns.least, found.returns.greatest), (-4.0, -1.0));
        // 2 with 1/4, 3 with 1/8, else 4.
        assert!((found.length.mean - 3.375).abs() < 0.03, "{found:?}");
        assert!((found.length.deviation - 0.857).abs() < 0.02, "{found:?}");
    }

    /// Refuses to go right.
    struct Sulking(Corridor);

    impl Environment for Sulking {
        type Observation = Vec<f32>;
        type Action = usize;

        fn spec(&self) -> &Spec {
            self.0.spec()
        }

        fn reset(&mut self, seed: u64) {
            self.0.reset(seed);
        }

        fn step(&mut self, action: &usize) -> Result<Step, Refused> {
            if *action == 1 { Err(Refused::Over) } else { self.0.step(action) }
        }

        fn observe(&mut self, out: &mut Vec<f32>) {
            self.0.observe(out);
        }
    }

    #[test]
    fn a_refusal_is_no_failure() {
        let mut env = TimeLimit::new(Sulking(Corridor::new(3)), 2);
        let found = play(&mut env, &Options { episodes: 400, ..Options::default() });
        // Left twice in a row has one chance in four.
        assert_eq!(found.episodes + found.refused, 400);
        assert!((60..140).contains(&found.episodes), "{found:?}");
        assert_eq!((found.steps, found.length.least), (2 * found.episodes, 2.0));
    }

    #[test]
    fn what_has_no_limit_is_left_in_the_end() {
        let mut env = Corridor::new(10_000);
        let found = play(&mut env, &Options { steps: 1000, ..Options::default() });
        assert_eq!((found.episodes, found.steps, found.successes, found.terminated), (1, 1000, 0, 0));
    }
}
