//! Support vector machines with a Gaussian kernel, for the sets of states an option may start in.
//!
//! The thesis (3.1.3) learns an initiation set from the states of successful executions alone with a one-class
//! machine, and refines it with a two-class machine once there are failures. Both are the same quadratic
//! programme under different bounds, so one solver (`smo`) serves both; scales and conventions are libsvm's
//! (Chang and Lin 2011), so that values can be compared with scikit-learn's.

mod gamma;
mod kernel;
mod one_class;
mod smo;
#[cfg(test)]
mod tests;
mod two_class;

pub use gamma::Gamma;
pub use one_class::OneClass;
pub use two_class::{ClassWeights, TwoClass};

use kernel::Samples;
use serde::{Deserialize, Serialize};

/// How far from the optimum the solver may stop unless told otherwise: libsvm's default.
pub const TOLERANCE: f64 = 1e-3;

/// What a fit leaves behind: f(x) = Σᵢ βᵢ exp(−γ‖xᵢ − x‖²) − ρ over the support vectors xᵢ.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// The support vectors: the training rows that matter.
    pub support: Vec<Vec<f64>>,
    /// βᵢ, one a support vector; negative for those of the negative class.
    pub coefficients: Vec<f64>,
    /// The threshold; scikit-learn's `intercept_` is −ρ.
    pub rho: f64,
    /// The kernel's width, as a number.
    pub gamma: f64,
}

impl Machine {
    /// Keeps the rows that have a coefficient.
    fn new(samples: &Samples, gamma: f64, solution: &smo::Solution) -> Self {
        let kept = || samples.iter().zip(&solution.coefficients).filter(|(_, beta)| **beta != 0.0);
        Self {
            support: kept().map(|(row, _)| row.to_vec()).collect(),
            coefficients: kept().map(|(_, beta)| *beta).collect(),
            rho: solution.rho,
            gamma,
        }
    }

    /// f(row): positive inside, negative outside.
    ///
    /// # Panics
    /// When the row is not as wide as the rows of the fit.
    #[must_use]
    pub fn decision<T: Copy + Into<f64>>(&self, row: &[T]) -> f64 {
        let terms = self.support.iter().zip(&self.coefficients).map(|(vector, beta)| {
            assert_eq!(vector.len(), row.len(), "a row must be as wide as the rows of the fit");
            beta * kernel::gaussian(self.gamma, vector, row)
        });
        terms.sum::<f64>() - self.rho
    }
}

/// Why there is no machine for these samples.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Unfit {
    /// Nothing to learn from.
    #[error("there are no samples to learn a set from: gather at least one example from inside the set")]
    NoSamples,
    /// Rows without columns.
    #[error("the samples have no columns: give every row at least one feature")]
    NoFeatures,
    /// Rows of different widths.
    #[error("row {row} has {width} columns instead of {expected}: give all rows the same features")]
    Ragged {
        /// The first row that differs.
        row: usize,
        /// Its width.
        width: usize,
        /// The first row's width, or that of the rows a network reads.
        expected: usize,
    },
    /// Not a number, or infinite.
    #[error("row {row}, column {column} is not finite: drop the row or repair what computes it")]
    NotFinite {
        /// Where.
        row: usize,
        /// Where in the row.
        column: usize,
    },
    /// One label or weight a row is wanted.
    #[error("there are {rows} rows but {given} {what}: give one a row")]
    Unpaired {
        /// Labels or weights.
        what: &'static str,
        /// How many rows.
        rows: usize,
        /// How many of the others.
        given: usize,
    },
    /// A weight that cannot be one.
    #[error("the weight {weight} of {what} must be finite and not negative")]
    Weight {
        /// What is weighed.
        what: String,
        /// Its weight.
        weight: f64,
    },
    /// Two classes are wanted.
    #[error(
        "all samples (of positive weight) are {}: a two-class machine needs both classes, use a one-class one",
        if *.positive { "positive" } else { "negative" }
    )]
    SingleClass {
        /// The class that is there.
        positive: bool,
    },
    /// ν is a share.
    #[error("nu is {0} but must be above 0 and at most 1: it is the share of samples left outside")]
    Nu(f64),
    /// C is a price.
    #[error("C is {0} but must be above 0 and finite")]
    Cost(f64),
    /// γ makes no kernel.
    #[error("gamma is {0} but must be above 0 and finite: name a value, or rescale the features")]
    Gamma(f64),
    /// The solver would not stop.
    #[error("the tolerance is {0} but must be above 0 and finite; 0.001 is usual")]
    Tolerance(f64),
}

/// Whether these rows can be learned from at all.
pub(crate) fn check_rows(rows: &[Vec<f32>]) -> Result<(), Unfit> {
    Samples::read(rows).map(|_| ())
}

fn check_tolerance(tolerance: f64) -> Result<(), Unfit> {
    if tolerance > 0.0 && tolerance.is_finite() { Ok(()) } else { Err(Unfit::Tolerance(tolerance)) }
}

/// Whether there is one of them a row.
pub(crate) fn check_paired(what: &'static str, given: usize, rows: usize) -> Result<(), Unfit> {
    if given == rows { Ok(()) } else { Err(Unfit::Unpaired { what, rows, given }) }
}

fn check_weight(weight: f64, what: impl FnOnce() -> String) -> Result<(), Unfit> {
    if weight >= 0.0 && weight.is_finite() { Ok(()) } else { Err(Unfit::Weight { what: what(), weight }) }
}

/// Whether there is a weight a row, and each is one.
pub(crate) fn check_weights(weights: &[f64], rows: usize) -> Result<(), Unfit> {
    check_paired("weights", weights.len(), rows)?;
    weights.iter().enumerate().try_for_each(|(row, weight)| check_weight(*weight, || format!("row {row}")))
}
