//! Columns of numbers brought to mean 0 and deviation 1.

use serde::{Deserialize, Serialize};

/// A column that varies less than this does not vary: the authors' floor (`algorithms.md`, section 7).
const FLOOR: f64 = 1e-5;

/// Means and standard deviations of columns.
///
/// A column that does not vary is 0 when standardised, whatever it is, and its mean when restored: the authors divide by
/// 1e-5 there, so that a hundredth more than ever before would enter a network as a thousand.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Standard {
    means: Vec<f32>,
    /// 0 for a column that does not vary.
    deviations: Vec<f32>,
}

impl Standard {
    /// That of rows of `width` numbers.
    pub(crate) fn of(rows: &[f32], width: usize) -> Self {
        let mut moments = Moments::default();
        moments.add(rows, width);
        moments.standard()
    }

    /// Numbers a row.
    pub(crate) fn width(&self) -> usize {
        self.means.len()
    }

    /// (x − mean) / deviation, in place.
    pub(crate) fn standardise(&self, rows: &mut [f32]) {
        for row in rows.chunks_exact_mut(self.width()) {
            for ((x, mean), deviation) in row.iter_mut().zip(&self.means).zip(&self.deviations) {
                *x = if *deviation > 0.0 { (*x - mean) / deviation } else { 0.0 };
            }
        }
    }

    /// mean + deviation × x, in place.
    pub(crate) fn restore(&self, rows: &mut [f32]) {
        for row in rows.chunks_exact_mut(self.width()) {
            for ((x, mean), deviation) in row.iter_mut().zip(&self.means).zip(&self.deviations) {
                *x = mean + deviation * *x;
            }
        }
    }
}

/// Means and squares of columns, row by row (Welford's recurrence).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Moments {
    rows: u64,
    means: Vec<f64>,
    squares: Vec<f64>,
}

impl Moments {
    /// How many rows there were.
    pub(crate) fn rows(&self) -> u64 {
        self.rows
    }

    /// More rows of `width` numbers.
    pub(crate) fn add(&mut self, rows: &[f32], width: usize) {
        self.means.resize(width, 0.0);
        self.squares.resize(width, 0.0);
        for row in rows.chunks_exact(width.max(1)) {
            self.rows += 1;
            for ((mean, square), x) in self.means.iter_mut().zip(&mut self.squares).zip(row) {
                let away = f64::from(*x) - *mean;
                *mean += away / self.rows as f64;
                *square += away * (f64::from(*x) - *mean);
            }
        }
    }

    /// Their means and deviations.
    pub(crate) fn standard(&self) -> Standard {
        let n = self.rows.max(1) as f64;
        let deviation = |sum: &f64| Some((sum / n).sqrt()).filter(|&deviation| deviation >= FLOOR);
        Standard {
            means: self.means.iter().map(|&mean| mean as f32).collect(),
            deviations: self.squares.iter().map(|sum| deviation(sum).unwrap_or(0.0) as f32).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn restoring_undoes_standardising_and_a_column_that_does_not_vary_stays_finite() {
        let rows = [1.0, 5.0, 100.0, 3.0, 5.0, -300.0, 8.0, 5.0, 200.0];
        let standard = Standard::of(&rows, 3);
        let mut now = rows;
        standard.standardise(&mut now);
        let column = |i: usize| [now[i], now[3 + i], now[6 + i]];
        for i in [0, 2] {
            let [a, b, c] = column(i);
            assert!((a + b + c).abs() < 1e-6 && (a * a + b * b + c * c - 3.0).abs() < 1e-5);
        }
        assert_eq!(column(1), [0.0; 3]);
        standard.restore(&mut now);
        assert!(now.iter().zip(&rows).all(|(a, b)| (a - b).abs() < 1e-4), "{now:?}");

        // What the constant never was before.
        let mut other = [1.0, 6.0, 0.0];
        standard.standardise(&mut other);
        assert_eq!(other[1], 0.0);
        standard.restore(&mut other);
        assert_eq!(other[1], 5.0);
    }
}
