//! Mean and spread of a stream of numbers.

use serde::{Deserialize, Serialize};

/// Mean and standard deviation of all numbers seen so far (Welford's recurrence).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Running {
    count: u64,
    mean: f64,
    squares: f64,
}

impl Running {
    /// Another number.
    pub fn push(&mut self, x: f32) {
        self.count += 1;
        let away = f64::from(x) - self.mean;
        self.mean += away / self.count as f64;
        self.squares += away * (f64::from(x) - self.mean);
    }

    /// How many there were.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Their mean; 0 before the first.
    pub fn mean(&self) -> f32 {
        self.mean as f32
    }

    /// Their standard deviation; 0 before the second.
    pub fn deviation(&self) -> f32 {
        (self.squares / self.count.max(1) as f64).sqrt() as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_deviation_are_those_of_the_numbers() {
        let mut running = Running::default();
        assert_eq!((running.mean(), running.deviation()), (0.0, 0.0));
        [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0].into_iter().for_each(|x| running.push(x));
        assert_eq!((running.count(), running.mean(), running.deviation()), (8, 5.0, 2.0));
    }
}
