//! tanh and the logistic function, without branches, so that a compiler computes several numbers at a time.
//!
//! The library's functions take one number a call: in Burn's LSTM they are two fifths of the time. They also differ from
//! platform to platform, which sums and products do not.

/// Beyond this tanh is 1 to the last bit of a single-precision number.
const END: f32 = 7.905_311;
/// The odd polynomial above the line, from x¹³ down to x: Eigen's approximation of 13th over 6th degree
/// (`generic_fast_tanh_float`, which XLA has too).
const ABOVE: [f32; 7] = [
    -2.760_768_5e-16,
    2.000_188e-13,
    -8.604_672e-11,
    5.122_297e-8,
    1.485_722_4e-5,
    6.372_619_3e-4,
    4.893_524_5e-3,
];
/// The even one below it, from x⁶ down to 1.
const BELOW: [f32; 4] = [1.198_258_4e-6, 1.185_347e-4, 2.268_434_6e-3, 4.893_525e-3];

/// tanh x, to 4e-7 of its own size; NaN of NaN.
#[inline(always)]
pub(super) fn tanh(x: f32) -> f32 {
    let x = x.clamp(-END, END);
    let square = x * x;
    let above = ABOVE[1..].iter().fold(ABOVE[0], |sum, factor| sum * square + factor);
    let below = BELOW[1..].iter().fold(BELOW[0], |sum, factor| sum * square + factor);
    x * above / below
}

/// 1 / (1 + e⁻ˣ), to 3e-7; NaN of NaN.
#[inline(always)]
pub(super) fn logistic(x: f32) -> f32 {
    0.5 + 0.5 * tanh(0.5 * x)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of all sizes up to 100, of both signs.
    fn numbers() -> impl Iterator<Item = f32> {
        let sizes = (0..200_000).map(|i| 1e-6 * 1e8_f32.powf(i as f32 / 199_999.0));
        sizes.flat_map(|x| [x, -x]).chain([0.0])
    }

    #[test]
    fn both_are_what_the_library_computes_in_double_precision() {
        let (mut worst, mut worst_logistic) = (0.0_f64, 0.0_f64);
        for x in numbers() {
            let exact = f64::from(x).tanh();
            worst = worst.max((f64::from(tanh(x)) - exact).abs() / exact.abs().max(1e-30));
            let exact = 1.0 / (1.0 + (-f64::from(x)).exp());
            worst_logistic = worst_logistic.max((f64::from(logistic(x)) - exact).abs());
        }
        assert!(worst < 4e-7, "{worst}");
        assert!(worst_logistic < 3e-7, "{worst_logistic}");
    }

    #[test]
    fn nothing_leaves_its_range_and_nan_stays() {
        assert!(numbers().all(|x| tanh(x).abs() <= 1.0 && (0.0..=1.0).contains(&logistic(x))));
        assert_eq!((tanh(0.0), logistic(0.0)), (0.0, 0.5));
        assert!(tanh(f32::NAN).is_nan() && logistic(f32::NAN).is_nan());
        assert_eq!(tanh(f32::INFINITY), -tanh(f32::NEG_INFINITY));
    }
}
