//! The width of the Gaussian kernel, given as a number or as one of scikit-learn's two rules.

use std::fmt;

use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

use super::{Unfit, kernel::Samples};

/// γ of exp(−γ‖x − y‖²); written `"scale"`, `"auto"` or a number in a configuration.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Gamma {
    /// 1 / (features · variance over all entries), or 1 when all entries are the same.
    #[default]
    Scale,
    /// 1 / features.
    Auto,
    /// This number.
    Value(f64),
}

impl Gamma {
    /// The number it stands for on these samples.
    pub(super) fn on(self, samples: &Samples) -> Result<f64, Unfit> {
        let features = samples.width() as f64;
        let gamma = match self {
            Self::Scale => match variance(samples.values()) {
                0.0 => 1.0,
                variance => 1.0 / (features * variance),
            },
            Self::Auto => 1.0 / features,
            Self::Value(gamma) => gamma,
        };
        Self::Value(gamma).check()?;
        Ok(gamma)
    }

    pub(super) fn check(self) -> Result<(), Unfit> {
        match self {
            Self::Value(gamma) if !(gamma.is_finite() && gamma > 0.0) => Err(Unfit::Gamma(gamma)),
            _ => Ok(()),
        }
    }
}

/// Population variance. The first value is subtracted throughout, so that equal values give exactly zero
/// whatever the rounding of their mean.
fn variance(values: &[f64]) -> f64 {
    let (n, first) = (values.len() as f64, values[0]);
    let mean = values.iter().map(|v| v - first).sum::<f64>() / n;
    values.iter().map(|v| (v - first - mean).powi(2)).sum::<f64>() / n
}

impl Serialize for Gamma {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Scale => to.serialize_str("scale"),
            Self::Auto => to.serialize_str("auto"),
            Self::Value(gamma) => to.serialize_f64(*gamma),
        }
    }
}

impl<'de> Deserialize<'de> for Gamma {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_any(Reader)
    }
}

/// By hand, because a derived untagged enum cannot say what it would have accepted.
struct Reader;

impl de::Visitor<'_> for Reader {
    type Value = Gamma;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(r#""scale", "auto" or a number above 0"#)
    }

    fn visit_str<E: de::Error>(self, name: &str) -> Result<Gamma, E> {
        match name {
            "scale" => Ok(Gamma::Scale),
            "auto" => Ok(Gamma::Auto),
            _ => Err(E::invalid_value(de::Unexpected::Str(name), &self)),
        }
    }

    fn visit_f64<E: de::Error>(self, gamma: f64) -> Result<Gamma, E> {
        let refused = |_| E::invalid_value(de::Unexpected::Float(gamma), &self);
        Gamma::Value(gamma).check().map_err(refused)?;
        Ok(Gamma::Value(gamma))
    }

    fn visit_i64<E: de::Error>(self, gamma: i64) -> Result<Gamma, E> {
        self.visit_f64(gamma as f64)
    }

    fn visit_u64<E: de::Error>(self, gamma: u64) -> Result<Gamma, E> {
        self.visit_f64(gamma as f64)
    }
}
