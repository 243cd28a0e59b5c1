//! The two-class machine (C-SVC, Cortes and Vapnik 1995): where samples of one kind end and another's begin.
//!
//! The thesis refines an initiation set with it once executions have failed (3.1.3). Weights serve the few
//! failures against many successes, and later the weighted classifier of equation 5.1.

use super::{
    Gamma, Machine, TOLERANCE, Unfit,
    kernel::{Gram, Samples},
    smo::{self, Bounds},
};

/// How much the errors of either class count.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum ClassWeights {
    /// All samples the same.
    #[default]
    Equal,
    /// n / (2 · samples of the class): both classes the same in sum.
    Balanced,
    /// These.
    Given {
        /// Of a negative sample.
        negative: f64,
        /// Of a positive sample.
        positive: f64,
    },
}

/// Settings of a two-class machine. Minimises ½βᵀKβ − yᵀβ with Σβ = 0 and |βᵢ| up to C · class weight · sample
/// weight, β having the sign of its class.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoClass {
    /// C: the price of an error against a simple boundary.
    pub c: f64,
    /// How much either class counts.
    pub classes: ClassWeights,
    /// The kernel's width.
    pub gamma: Gamma,
    /// How exact the solution is.
    pub tolerance: f64,
}

impl Default for TwoClass {
    fn default() -> Self {
        Self { c: 1.0, classes: ClassWeights::Equal, gamma: Gamma::Scale, tolerance: TOLERANCE }
    }
}

impl TwoClass {
    /// Whether the settings are possible, before there are samples.
    ///
    /// # Errors
    /// [`Unfit`] says which is not.
    pub fn check(&self) -> Result<(), Unfit> {
        if !(self.c > 0.0 && self.c.is_finite()) {
            return Err(Unfit::Cost(self.c));
        }
        self.classes.check()?;
        super::check_tolerance(self.tolerance)?;
        self.gamma.check()
    }

    /// The machine that is positive where labels are true.
    ///
    /// # Errors
    /// [`Unfit`] says which sample or setting cannot be used.
    pub fn fit<T: Copy + Into<f64>>(&self, rows: &[Vec<T>], labels: &[bool]) -> Result<Machine, Unfit> {
        self.fit_weighted(rows, labels, &vec![1.0; rows.len()])
    }

    /// The same, each sample's errors counted by its weight. Balanced class weights count samples, not weights.
    ///
    /// # Errors
    /// As [`TwoClass::fit`].
    pub fn fit_weighted<T: Copy + Into<f64>>(
        &self,
        rows: &[Vec<T>],
        labels: &[bool],
        weights: &[f64],
    ) -> Result<Machine, Unfit> {
        self.check()?;
        let samples = Samples::read(rows)?;
        super::check_paired("labels", labels.len(), samples.len())?;
        super::check_weights(weights, samples.len())?;
        let [negative, positive] = self.classes.of(labels);

        let bounds = labels.iter().zip(weights).map(|(&label, weight)| match label {
            true => Bounds { low: 0.0, high: self.c * positive * weight },
            false => Bounds { low: -self.c * negative * weight, high: 0.0 },
        });
        let bounds: Vec<Bounds> = bounds.collect();
        let positives = bounds.iter().any(|b| b.high > 0.0);
        if !positives || bounds.iter().all(|b| b.low == 0.0) {
            return Err(Unfit::SingleClass { positive: positives });
        }

        let target: Vec<f64> = labels.iter().map(|&label| if label { 1.0 } else { -1.0 }).collect();
        let gamma = self.gamma.on(&samples)?;
        let gram = Gram::new(&samples, gamma);
        let solution = smo::solve(&gram, &target, &bounds, vec![0.0; samples.len()], self.tolerance);
        Ok(Machine::new(&samples, gamma, &solution))
    }
}

impl ClassWeights {
    fn check(self) -> Result<(), Unfit> {
        let Self::Given { negative, positive } = self else { return Ok(()) };
        super::check_weight(negative, || "the negative class".to_owned())?;
        super::check_weight(positive, || "the positive class".to_owned())
    }

    /// The weights of the negative and of the positive class.
    fn of(self, labels: &[bool]) -> [f64; 2] {
        let n = labels.len();
        let positives = labels.iter().filter(|label| **label).count();
        match self {
            Self::Equal => [1.0, 1.0],
            // A class without samples is refused later; here it only must not divide by zero.
            Self::Balanced => [n - positives, positives].map(|of| n as f64 / (2 * of.max(1)) as f64),
            Self::Given { negative, positive } => [negative, positive],
        }
    }
}
