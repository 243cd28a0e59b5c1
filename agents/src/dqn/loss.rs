//! What an error costs.

use serde::{Deserialize, Serialize};

/// The loss of an error.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Loss {
    /// ½e² up to |e| = 1 and |e| − ½ beyond (authors' code; Mnih 2015 clips the error alike).
    #[default]
    Huber,
    /// ½e².
    Squared,
}

impl Loss {
    /// Of this error.
    pub(super) fn value(self, error: f32) -> f32 {
        match self {
            Self::Huber if error.abs() > 1.0 => error.abs() - 0.5,
            Self::Huber | Self::Squared => 0.5 * error * error,
        }
    }

    /// Its derivative by the error.
    pub(super) fn slope(self, error: f32) -> f32 {
        match self {
            Self::Huber => error.clamp(-1.0, 1.0),
            Self::Squared => error,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn huber_is_quadratic_near_zero_and_linear_beyond() {
        assert_eq!((Loss::Huber.value(0.5), Loss::Huber.value(-3.0)), (0.125, 2.5));
        assert_eq!((Loss::Huber.slope(0.5), Loss::Huber.slope(-3.0)), (0.5, -1.0));
        assert_eq!((Loss::Squared.value(-3.0), Loss::Squared.slope(-3.0)), (4.5, -3.0));
    }
}
