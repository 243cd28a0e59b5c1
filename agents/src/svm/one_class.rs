//! The one-class machine (Schölkopf et al. 2001): a set that holds most of the samples and little else.
//!
//! The thesis's first initiation classifier (3.1.3): only successes are known, nothing says where the set ends.

use super::{
    Gamma, Machine, TOLERANCE, Unfit,
    kernel::{Gram, Samples},
    smo::{self, Bounds},
};

/// Settings of a one-class machine. Minimises ½βᵀKβ with 0 ≤ βᵢ ≤ wᵢ and Σβ = νΣw, which is libsvm's scale
/// (w = 1): values grow with the number of samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OneClass {
    /// ν: at most this share of the samples is left outside, at least this share are support vectors.
    pub nu: f64,
    /// The kernel's width.
    pub gamma: Gamma,
    /// How exact the solution is.
    pub tolerance: f64,
}

impl Default for OneClass {
    fn default() -> Self {
        Self { nu: 0.1, gamma: Gamma::Scale, tolerance: TOLERANCE }
    }
}

impl OneClass {
    /// Whether the settings are possible, before there are samples.
    ///
    /// # Errors
    /// [`Unfit`] says which is not.
    pub fn check(&self) -> Result<(), Unfit> {
        if !(self.nu > 0.0 && self.nu <= 1.0) {
            return Err(Unfit::Nu(self.nu));
        }
        super::check_tolerance(self.tolerance)?;
        self.gamma.check()
    }

    /// The machine of these samples.
    ///
    /// # Errors
    /// [`Unfit`] says which sample or setting cannot be used.
    pub fn fit<T: Copy + Into<f64>>(&self, rows: &[Vec<T>]) -> Result<Machine, Unfit> {
        self.fit_weighted(rows, &vec![1.0; rows.len()])
    }

    /// The same, each sample counted as often as its weight says.
    ///
    /// # Errors
    /// As [`OneClass::fit`].
    pub fn fit_weighted<T: Copy + Into<f64>>(
        &self,
        rows: &[Vec<T>],
        weights: &[f64],
    ) -> Result<Machine, Unfit> {
        self.check()?;
        let samples = Samples::read(rows)?;
        super::check_weights(weights, samples.len())?;
        let total: f64 = weights.iter().sum();
        if total == 0.0 {
            return Err(Unfit::NoSamples);
        }

        // Any start with the right sum will do; libsvm's is to fill up the first samples.
        let mut left = self.nu * total;
        let fill = |weight: &f64| {
            let share = weight.min(left);
            left -= share;
            share
        };
        let start = weights.iter().map(fill).collect();
        let bounds: Vec<Bounds> = weights.iter().map(|&high| Bounds { low: 0.0, high }).collect();
        let gamma = self.gamma.on(&samples)?;
        let gram = Gram::new(&samples, gamma);
        let solution = smo::solve(&gram, &vec![0.0; samples.len()], &bounds, start, self.tolerance);
        Ok(Machine::new(&samples, gamma, &solution))
    }
}
