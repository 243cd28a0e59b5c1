//! The samples of one fit, and the Gaussian kernel between them.

use std::cell::OnceCell;

use super::Unfit;

/// exp(−γ‖x − y‖²).
pub(super) fn gaussian<T: Copy + Into<f64>>(gamma: f64, x: &[f64], y: &[T]) -> f64 {
    let squared: f64 = x.iter().zip(y).map(|(a, b)| (a - (*b).into()).powi(2)).sum();
    (-gamma * squared).exp()
}

/// Rows found fit to be learned from: at least one, equally wide, finite.
pub(super) struct Samples {
    values: Vec<f64>,
    width: usize,
}

impl Samples {
    pub(super) fn read<T: Copy + Into<f64>>(rows: &[Vec<T>]) -> Result<Self, Unfit> {
        let width = rows.first().ok_or(Unfit::NoSamples)?.len();
        if width == 0 {
            return Err(Unfit::NoFeatures);
        }
        let mut values = Vec::with_capacity(rows.len() * width);
        for (row, entries) in rows.iter().enumerate() {
            if entries.len() != width {
                return Err(Unfit::Ragged { row, width: entries.len(), expected: width });
            }
            for (column, value) in entries.iter().map(|v| (*v).into()).enumerate() {
                if !value.is_finite() {
                    return Err(Unfit::NotFinite { row, column });
                }
                values.push(value);
            }
        }
        Ok(Self { values, width })
    }

    pub(super) fn len(&self) -> usize {
        self.values.len() / self.width
    }

    pub(super) fn width(&self) -> usize {
        self.width
    }

    /// All entries, row after row.
    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &[f64]> {
        self.values.chunks_exact(self.width)
    }

    fn row(&self, i: usize) -> &[f64] {
        &self.values[i * self.width..][..self.width]
    }
}

/// The matrix of kernel values. A row is computed when the solver first asks for it and kept: the solver comes
/// back to few rows often. In single precision, as libsvm has it: that is 4n bytes for each row asked for, 16 MB
/// when all of 2000 are, and an optimum that agrees with libsvm's to 1e-8 instead of 1e-6.
pub(super) struct Gram<'a> {
    samples: &'a Samples,
    gamma: f64,
    rows: Vec<OnceCell<Box<[f32]>>>,
}

impl<'a> Gram<'a> {
    pub(super) fn new(samples: &'a Samples, gamma: f64) -> Self {
        Self { samples, gamma, rows: vec![OnceCell::new(); samples.len()] }
    }

    pub(super) fn row(&self, i: usize) -> &[f32] {
        let x = self.samples.row(i);
        self.rows[i].get_or_init(|| self.samples.iter().map(|y| gaussian(self.gamma, y, x) as f32).collect())
    }
}
