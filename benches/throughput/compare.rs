//! When a workload counts as slower than it was.

/// How much slower than recorded a workload may be: relative speeds below `1 - TOLERANCE` times the recorded
/// one are regressions.
pub(crate) const TOLERANCE: f64 = 0.15;
/// How often a workload that seems slower is measured again before that is believed.
pub(crate) const AGAIN: usize = 5;

/// What comparing a workload came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Verdict {
    /// As fast as recorded, about.
    Kept,
    /// Faster than the tolerance explains: worth recording, so that it is not lost again unseen.
    Faster,
    /// Slower, in each of several attempts; the fastest of them found this.
    Slower(f64),
}

/// Compares relative speeds. Noise makes things slower for a while, a change of the code for good: only what is
/// slower in each of [`AGAIN`] more attempts is called so.
pub(crate) fn judge(expected: f64, found: f64, mut again: impl FnMut() -> f64) -> Verdict {
    let least = (1.0 - TOLERANCE) * expected;
    let mut best = found;
    for _ in 0..AGAIN {
        if best >= least {
            break;
        }
        best = best.max(again());
    }
    let faster = |found: f64| found * (1.0 - TOLERANCE) > expected;
    if best < least {
        Verdict::Slower(best)
    } else if faster(best) && faster(again()) {
        // Once may have been the calibration's bad luck.
        Verdict::Faster
    } else {
        Verdict::Kept
    }
}

/// The middle one; of an even number, the lower of the two. NaN when there is none.
pub(crate) fn median(mut of: Vec<f64>) -> f64 {
    of.sort_by(f64::total_cmp);
    of.get(of.len().saturating_sub(1) / 2).copied().unwrap_or(f64::NAN)
}
