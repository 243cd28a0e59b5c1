//! What values are learned towards, and what a sequence's errors make of its priority.

/// The linear part of h (R2D2, Kapturowski 2019, section 2.3; Pohlen 2018).
const EPSILON: f64 = 1e-3;

/// How values stand for returns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Scale {
    /// As they are.
    Plain,
    /// By h: values of any size within reach of one network.
    Rescaled,
}

impl Scale {
    /// h: from a return to the value that stands for it.
    pub(super) fn value(self, x: f64) -> f64 {
        match self {
            Self::Plain => x,
            Self::Rescaled => x.signum() * ((x.abs() + 1.0).sqrt() - 1.0) + EPSILON * x,
        }
    }

    /// h⁻¹: from a value to the return that it stands for.
    pub(super) fn unscaled(self, y: f64) -> f64 {
        match self {
            Self::Plain => y,
            Self::Rescaled => {
                let root = (1.0 + 4.0 * EPSILON * (y.abs() + 1.0 + EPSILON)).sqrt();
                y.signum() * (((root - 1.0) / (2.0 * EPSILON)).powi(2) - 1.0)
            }
        }
    }
}

/// How returns are made.
#[derive(Clone, Copy, Debug)]
pub(super) struct Returns {
    /// Most steps of a return.
    pub(super) steps: usize,
    /// γ.
    pub(super) discount: f64,
    pub(super) scale: Scale,
}

/// The target of every step of a sequence:
///
/// ```text
/// y = h(Σ γᵏ r + γⁿ h⁻¹(Q'(s', argmax Q(s', ·))))
/// ```
///
/// where n is the most steps of a return, or as many as are left. `value` is Q'(s', argmax Q(s', ·)) at an observation of the
/// sequence, counted from 0. A sequence that is cut off, as by its length or a truncation, has a value at its end; a
/// `terminal` one has none.
pub(super) fn targets(
    rewards: &[f32],
    terminal: bool,
    value: impl Fn(usize) -> f32,
    how: Returns,
) -> Vec<f32> {
    let end = rewards.len();
    let target = |from: usize| {
        let to = (from + how.steps).min(end);
        let (mut sum, mut discount) = (0.0, 1.0);
        for reward in &rewards[from..to] {
            sum += discount * f64::from(*reward);
            discount *= how.discount;
        }
        if to < end || !terminal {
            sum += discount * how.scale.unscaled(f64::from(value(to)));
        }
        how.scale.value(sum) as f32
    };
    (0..end).map(target).collect()
}

/// The target's value of the network's best choice, the first of several best: van Hasselt 2016.
pub(super) fn double(online: &[f32], target: &[f32]) -> f32 {
    let best = (1..online.len()).fold(0, |best, i| if online[i] > online[best] { i } else { best });
    target[best]
}

/// η max |δ| + (1 − η) mean |δ|; 0 of nothing (Kapturowski 2019, section 2.3).
pub(super) fn priority(errors: &[f32], greatest_share: f32) -> f32 {
    let greatest = errors.iter().fold(0.0_f32, |most, error| most.max(error.abs()));
    let mean = errors.iter().map(|error| error.abs()).sum::<f32>() / errors.len().max(1) as f32;
    greatest_share * greatest + (1.0 - greatest_share) * mean
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rescaling_is_the_papers_and_can_be_undone() {
        let h = Scale::Rescaled;
        for (x, expected) in [(1.0, 0.415_214), (10.0, 2.326_625), (-1000.0, -31.638_584)] {
            assert!((h.value(x) - expected).abs() < 1e-6, "{x}: {}", h.value(x));
        }
        for i in 0..2000 {
            let x = 1e-3 * 1e7_f64.powf(f64::from(i) / 1999.0);
            for x in [x, -x] {
                assert!((h.unscaled(h.value(x)) / x - 1.0).abs() < 1e-4, "{x}");
            }
        }
        assert!(h.value(0.0) == 0.0 && h.unscaled(0.0).abs() < 1e-12);
        assert_eq!((Scale::Plain.value(7.0), Scale::Plain.unscaled(7.0)), (7.0, 7.0));
    }

    /// Values 10, 20, 30, … at the observations.
    fn y(rewards: &[f32], terminal: bool, steps: usize) -> Vec<f32> {
        let how = Returns { steps, discount: 0.5, scale: Scale::Plain };
        targets(rewards, terminal, |i| 10.0 * (i + 1) as f32, how)
    }

    #[test]
    fn targets_are_those_of_tabular_n_step_learning() {
        // Two steps and the value of the observation behind them; at the end one step.
        assert_eq!(
            y(&[1.0, 2.0, 4.0], false, 2),
            [1.0 + 1.0 + 7.5, 2.0 + 2.0 + 10.0, 4.0 + 20.0],
            "a window's end and a truncation bootstrap"
        );
        assert_eq!(y(&[1.0, 2.0, 4.0], true, 2), [1.0 + 1.0 + 7.5, 2.0 + 2.0, 4.0], "a termination does not");
        // More steps than there are.
        assert_eq!(y(&[1.0, 2.0, 4.0], true, 9), [1.0 + 1.0 + 1.0, 2.0 + 2.0, 4.0]);
        assert_eq!(y(&[1.0, 2.0], false, 9), [1.0 + 1.0 + 7.5, 2.0 + 15.0]);
        assert_eq!(y(&[1.0, 2.0], false, 1), [1.0 + 10.0, 2.0 + 15.0]);
    }

    #[test]
    fn rescaled_targets_are_sums_of_returns() {
        let h = Scale::Rescaled;
        let how = Returns { steps: 1, discount: 0.5, scale: h };
        let found = targets(&[3.0], false, |_| h.value(100.0) as f32, how)[0];
        assert!((f64::from(found) - h.value(53.0)).abs() < 1e-5, "{found}");
    }

    #[test]
    fn the_networks_choice_has_the_targets_value() {
        assert_eq!(double(&[1.0, 3.0, 3.0], &[9.0, 5.0, 7.0]), 5.0);
    }

    #[test]
    fn a_priority_is_mostly_the_greatest_error() {
        assert!((priority(&[1.0, -3.0, 0.0], 0.9) - 2.833_333).abs() < 1e-6);
        assert_eq!(priority(&[], 0.9), 0.0);
    }
}
