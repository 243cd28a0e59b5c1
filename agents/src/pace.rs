//! How often a learner learns.

/// How much a learner learns from how much experience.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Pace {
    /// Minibatch updates a step of the environment; below one, an update every few steps.
    pub updates_per_step: f32,
    /// Steps in the replay before the first update.
    pub warm_up: usize,
}

impl Pace {
    /// Updates that are due after step number `step` (counted from 1) of a learner.
    pub fn due(&self, step: u64) -> u64 {
        let upto = |s: u64| (s as f64 * f64::from(self.updates_per_step)) as u64;
        upto(step) - upto(step.saturating_sub(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn updates_fall_due_evenly() {
        let due = |updates_per_step| {
            let pace = Pace { updates_per_step, warm_up: 0 };
            (1..=4).map(|step| pace.due(step)).collect::<Vec<_>>()
        };
        assert_eq!(due(1.0), [1, 1, 1, 1]);
        assert_eq!(due(0.5), [0, 1, 0, 1]);
        assert_eq!(due(1.5), [1, 2, 1, 2]);
        assert_eq!(due(0.0), [0, 0, 0, 0]);
    }
}
