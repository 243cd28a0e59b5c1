//! Statistics of a few seeds: intervals that hold at small numbers, and verdicts.

use serde::{Deserialize, Serialize};

/// An estimate with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl std::fmt::Display for Estimate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let digits = f.precision().unwrap_or(2);
        write!(f, "{:.digits$} [{:.digits$}, {:.digits$}]", self.value, self.low, self.high)
    }
}

/// 97.5th percentile of the normal distribution.
const Z: f64 = 1.959_964;

/// 97.5th percentiles of Student's t with 1 to 30 degrees of freedom.
const T: [f64; 30] = [
    12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131,
    2.120, 2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042,
];

/// A share with Wilson's interval. Of no trials nothing is known: 0 to 1.
pub fn wilson(successes: u64, trials: u64) -> Estimate {
    if trials == 0 {
        return Estimate { value: f64::NAN, low: 0.0, high: 1.0 };
    }
    let (n, p) = (trials as f64, successes as f64 / trials as f64);
    let centre = p + Z * Z / (2.0 * n);
    let half = Z * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt();
    let scale = 1.0 + Z * Z / n;
    Estimate { value: p, low: ((centre - half) / scale).max(0.0), high: ((centre + half) / scale).min(1.0) }
}

/// A mean with Student's interval; without bounds where there are fewer than two numbers.
pub fn mean_interval(values: &[f64]) -> Estimate {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    if values.len() < 2 {
        return Estimate { value: mean, low: f64::NEG_INFINITY, high: f64::INFINITY };
    }
    let variance = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0);
    let t = T.get(values.len() - 2).copied().unwrap_or(Z + 2.5 / (n - 1.0));
    let half = t * (variance / n).sqrt();
    Estimate { value: mean, low: mean - half, high: mean + half }
}

/// The median; none of nothing.
pub fn median(values: &[f64]) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    match sorted.len() {
        0 => None,
        n if n % 2 == 1 => Some(sorted[middle]),
        _ => Some(f64::midpoint(sorted[middle - 1], sorted[middle])),
    }
}

/// P(X > Y) over all pairs, ties counting one half, with Newcombe's interval (2006, method 5), which holds at small
/// numbers and at 0 and 1 too.
///
/// # Panics
/// When one of the samples is empty.
pub fn superiority(x: &[f64], y: &[f64]) -> Estimate {
    assert!(!x.is_empty() && !y.is_empty(), "two samples are compared, and one is empty");
    let wins: f64 = x
        .iter()
        .flat_map(|a| {
            y.iter().map(move |b| {
                if a > b {
                    1.0
                } else if a == b {
                    0.5
                } else {
                    0.0
                }
            })
        })
        .sum();
    let pairs = (x.len() * y.len()) as f64;
    let p = wins / pairs;
    let others = f64::midpoint(x.len() as f64, y.len() as f64) - 1.0;
    let variance =
        |q: f64| q * (1.0 - q) * (1.0 + others * (1.0 - q) / (2.0 - q) + others * q / (1.0 + q)) / pairs;
    // The ends are where the estimate is just as far away as it may be there.
    let end = |mut outside: f64, mut inside: f64| {
        for _ in 0..60 {
            let q = f64::midpoint(outside, inside);
            if (q - p).powi(2) > Z * Z * variance(q) { outside = q } else { inside = q }
        }
        inside
    };
    Estimate {
        value: p,
        low: if p > 0.0 { end(0.0, p) } else { 0.0 },
        high: if p < 1.0 { end(1.0, p) } else { 1.0 },
    }
}

/// What a comparison says of the claim that X is above Y (`evidence.md`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// P(X > Y) is at least 0.8, and its interval excludes 0.5.
    Supported,
    /// P(Y > X) is.
    Contradicted,
    /// Neither.
    Undetermined,
}

impl Verdict {
    /// The verdict on P(X > Y).
    pub fn of(superiority: &Estimate) -> Self {
        match superiority {
            Estimate { value, low, .. } if *value >= 0.8 && *low > 0.5 => Self::Supported,
            Estimate { value, high, .. } if *value <= 0.2 && *high < 0.5 => Self::Contradicted,
            _ => Self::Undetermined,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(estimate: Estimate, expected: [f64; 3], tolerance: f64) {
        let found = [estimate.value, estimate.low, estimate.high];
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < tolerance, "{found} {expected}");
        }
    }

    #[test]
    fn shares_have_wilsons_intervals() {
        // algorithms.md 13.
        near(wilson(45, 50), [0.9, 0.786, 0.957], 5e-4);
        near(wilson(5, 5), [1.0, 0.566, 1.0], 5e-4);
        assert_eq!((wilson(0, 0).low, wilson(0, 0).high), (0.0, 1.0));
    }

    #[test]
    fn means_have_students_intervals() {
        near(
            mean_interval(&[1.0, 2.0, 3.0]),
            [2.0, 2.0 - 4.303 / 3f64.sqrt(), 2.0 + 4.303 / 3f64.sqrt()],
            1e-9,
        );
        assert_eq!(mean_interval(&[1.0]).high, f64::INFINITY);
        assert_eq!(
            (median(&[3.0, 1.0, 2.0]), median(&[1.0, 2.0]), median(&[])),
            (Some(2.0), Some(1.5), None)
        );
    }

    #[test]
    fn superiority_is_symmetric_and_its_verdicts_need_seeds() {
        let (x, y) = ([3.0, 4.0, 5.0, 6.0], [1.0, 2.0, 3.0, 2.5]);
        let (a, b) = (superiority(&x, &y), superiority(&y, &x));
        assert!((a.value - 15.5 / 16.0).abs() < 1e-12);
        near(b, [1.0 - a.value, 1.0 - a.high, 1.0 - a.low], 1e-9);
        assert_eq!((Verdict::of(&a), Verdict::of(&b)), (Verdict::Supported, Verdict::Contradicted));
        let few = superiority(&[2.0], &[1.0]);
        assert_eq!((few.value, Verdict::of(&few)), (1.0, Verdict::Undetermined));
        assert_eq!(superiority(&x, &x).value, 0.5);
    }
}
