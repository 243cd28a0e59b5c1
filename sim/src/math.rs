//! Functions whose last bits differ between platforms, named once.
//!
//! The standard library takes them from the platform: glibc's, Apple's, and a third in wasm32 round some results
//! differently. With the feature `enhanced-determinism` they are `libm`'s, which is compiled in and the same
//! everywhere; Rapier's feature of that name does the same for its own. Addition, multiplication, division and
//! square roots are exact by IEEE 754 and need no such care.

macro_rules! named {
    ($($name:ident($($argument:ident),+): $float:ident, $method:ident, $libm:ident, $about:literal;)+) => {$(
        #[doc = $about]
        #[inline]
        pub fn $name($($argument: $float),+) -> $float {
            #[cfg(feature = "enhanced-determinism")]
            return libm::$libm($($argument),+);
            #[cfg(not(feature = "enhanced-determinism"))]
            return $float::$method($($argument),+);
        }
    )+};
}

named! {
    sin(x): f64, sin, sin, "The sine of an angle in radians.";
    cos(x): f64, cos, cos, "The cosine of an angle in radians.";
    atan2(y, x): f64, atan2, atan2, "The angle from the x axis to the point (x, y), radians in [−π, π].";
    hypot(x, y): f64, hypot, hypot, "The length of (x, y).";
    sinf(x): f32, sin, sinf, "The sine of an angle in radians, in single precision.";
    cosf(x): f32, cos, cosf, "The cosine of an angle in radians, in single precision.";
    atan2f(y, x): f32, atan2, atan2f, "The angle from the x axis to (x, y), in single precision.";
    hypotf(x, y): f32, hypot, hypotf, "The length of (x, y), in single precision.";
    expf(x): f32, exp, expf, "e to the power of x, in single precision.";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_mean_what_they_say() {
        let near = |a: f64, b: f64| (a - b).abs() < 1e-6;
        assert!(near(sin(0.5), 0.479_425_538) && near(cos(0.5), 0.877_582_561));
        assert!(near(atan2(1.0, -1.0), 0.75 * std::f64::consts::PI) && near(hypot(3.0, -4.0), 5.0));
        assert!(near(sinf(0.5).into(), sin(0.5)) && near(cosf(0.5).into(), cos(0.5)));
        assert!(near(atan2f(1.0, -1.0).into(), atan2(1.0, -1.0)) && near(hypotf(3.0, 4.0).into(), 5.0));
        assert!(near(expf(1.0).into(), std::f64::consts::E));
    }
}
