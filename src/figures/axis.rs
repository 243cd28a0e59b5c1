//! Round numbers along an axis.

/// A stretch of numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Span {
    pub(super) low: f64,
    pub(super) high: f64,
}

impl Span {
    /// The smallest span with all finite values in it.
    pub(super) fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        values.into_iter().filter(|value| value.is_finite()).fold(None, |span: Option<Self>, value| {
            let (low, high) = span.map_or((value, value), |span| (span.low.min(value), span.high.max(value)));
            Some(Self { low, high })
        })
    }

    /// The same span if it has a length, else one around its only value.
    pub(super) fn opened(self) -> Self {
        if self.high - self.low > 1e-9 * self.low.abs().max(self.high.abs()) {
            return self;
        }
        let half = if self.low == 0.0 { 1.0 } else { self.low.abs() * 0.1 };
        Self { low: self.low - half, high: self.high + half }
    }

    /// The span, longer by a share of its length at both ends.
    pub(super) fn padded(self, share: f64) -> Self {
        let by = (self.high - self.low) * share;
        Self { low: self.low - by, high: self.high + by }
    }

    /// Where a value lies, 0 at the low and 1 at the high end.
    pub(super) fn part(self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }

    /// The powers of ten in a span of their exponents, each exponent with the power's label; halves of what is too short for
    /// two of them.
    pub(super) fn powers(self) -> Vec<(f64, String)> {
        let exponents = |parts: &[f64]| -> Vec<(f64, String)> {
            let (first, last) = (self.low.floor() as i32, self.high.ceil() as i32);
            let all = (first..=last).flat_map(|power| parts.iter().map(move |part| (power, *part)));
            let inside = all.filter(|(power, part)| {
                let exponent = f64::from(*power) + part.log10();
                (self.low - 1e-9..=self.high + 1e-9).contains(&exponent)
            });
            inside.map(|(power, part)| (f64::from(power) + part.log10(), power_label(power, part))).collect()
        };
        let whole = exponents(&[1.0]);
        match whole.len() {
            0 | 1 => exponents(&[1.0, 2.0, 5.0]),
            // More than an axis has room for: every so manyeth.
            many => whole.into_iter().step_by(many.div_ceil(8)).collect(),
        }
    }

    /// About `wanted` round numbers in the span, each with its label.
    pub(super) fn ticks(self, wanted: f64) -> Vec<(f64, String)> {
        let step = round_step((self.high - self.low) / wanted.max(1.0));
        let (first, last) = ((self.low / step - 1e-6).ceil(), (self.high / step + 1e-6).floor());
        let sane = step.is_normal() && first.is_finite() && last.is_finite() && last - first < 1000.0;
        if !sane {
            return Vec::new();
        }
        (0..=(last - first).max(-1.0) as i64)
            .map(|index| {
                let value = (first + index as f64) * step;
                (value, label(value, step))
            })
            .collect()
    }
}

/// A digit times a power of ten, as it stands beside a tick.
fn power_label(power: i32, digit: f64) -> String {
    match power {
        -3..=-1 => format!("{:.*}", power.unsigned_abs() as usize, digit * 10f64.powi(power)),
        0..=3 => format!("{:.0}", digit * 10f64.powi(power)),
        _ => format!("{digit}e{power}").replace('-', "−"),
    }
}

/// The round number (1, 2, 2.5 or 5 times a power of ten) at or just above a step.
fn round_step(step: f64) -> f64 {
    let power = 10f64.powf(step.abs().max(f64::MIN_POSITIVE).log10().floor());
    let lead = step / power;
    let round = [1.0, 2.0, 2.5, 5.0].into_iter().find(|round| lead <= round * 1.0001).unwrap_or(10.0);
    round * power
}

/// A number as it stands beside a tick: "50k" and "1.5M" for large ones, as many decimals as the step needs.
fn label(value: f64, step: f64) -> String {
    let (unit, suffix) = match value.abs() {
        size if size > 0.999e9 => (1e9, "G"),
        size if size > 0.999e6 => (1e6, "M"),
        size if size > 0.999e4 || (size > 0.999e3 && step >= 1e3) => (1e3, "k"),
        _ => (1.0, ""),
    };
    if value.abs() < step * 1e-6 {
        return "0".to_owned();
    }
    let step = step / unit;
    let decimals = (0..9).find(|&places| {
        let scaled = step * 10f64.powi(places);
        (scaled - scaled.round()).abs() < 1e-6 * scaled.max(1.0) && scaled.round() >= 1.0
    });
    let places = decimals.unwrap_or(9) as usize;
    let number = format!("{:.*}", places, value.abs() / unit);
    let number = if unit > 1.0 && number.contains('.') {
        number.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        number
    };
    format!("{}{number}{suffix}", if value < 0.0 { "−" } else { "" })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(low: f64, high: f64, wanted: f64) -> Vec<String> {
        Span { low, high }.ticks(wanted).into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn labels_are_round_and_short() {
        assert_eq!(labels(0.0, 250e3, 5.0), ["0", "50k", "100k", "150k", "200k", "250k"]);
        assert_eq!(labels(0.0, 2e6, 4.0), ["0", "500k", "1M", "1.5M", "2M"]);
        assert_eq!(labels(0.0, 5000.0, 5.0), ["0", "1k", "2k", "3k", "4k", "5k"]);
        assert_eq!(labels(0.0, 1.0, 5.0), ["0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(0.0, 1.0, 4.0), ["0", "0.25", "0.50", "0.75", "1.00"]);
        assert_eq!(labels(-1000.0, 0.0, 4.0), ["−1000", "−750", "−500", "−250", "0"]);
        assert_eq!(labels(-3.0, 3.0, 3.0), ["−2", "0", "2"]);
    }

    #[test]
    fn powers_of_ten_have_their_labels() {
        let labels = |low, high| -> Vec<String> {
            Span { low, high }.powers().into_iter().map(|(_, label)| label).collect()
        };
        assert_eq!(labels(-4.2, 0.1), ["1e−4", "0.001", "0.01", "0.1", "1"]);
        assert_eq!(labels(-0.8, 0.0), ["0.2", "0.5", "1"]);
        assert_eq!(Span { low: -1.0, high: 0.5 }.powers()[0], (-1.0, "0.1".to_owned()));
        assert!(labels(-300.0, 300.0).len() <= 8);
    }

    #[test]
    fn a_span_without_length_is_opened_and_nothing_breaks() {
        assert_eq!(Span::of([f64::NAN, f64::INFINITY]), None);
        assert_eq!(Span::of([3.0, f64::NAN]), Some(Span { low: 3.0, high: 3.0 }));
        for value in [0.0, -5.0, 1e300, 1e-300] {
            let span = Span { low: value, high: value }.opened();
            assert!(span.high > span.low, "{value}");
            assert!(span.ticks(5.0).len() < 20);
        }
        assert!(Span { low: f64::MIN, high: f64::MAX }.ticks(5.0).is_empty());
    }
}
