//! What differs between agents that see vectors and agents that see pictures: how a network reads it, and what of it can be
//! counted.

use std::sync::Arc;

use inroads_agents::{
    Encoder, Key, Novelty,
    encode::OneHot,
    nets::TorsoConfig,
    novelty::{FeatureCounts, FeatureCountsConfig},
};
use inroads_envs::{Dimension, Frame, Kind, Spec};
use serde::{Deserialize, Serialize, de::DeserializeOwned};

use super::{
    Vector,
    shared::{named, scaled},
};
use crate::config::ConfigError;

/// What a network reads through.
pub(super) type Reader<O> = Arc<dyn Encoder<O> + Send + Sync>;

/// A kind of observation that tables can be kept of, experience saved of, and networks made for.
pub(super) trait Observed: Key + Clone + Serialize + DeserializeOwned + Sized + 'static {
    /// How a network with this torso reads it; `vectors` says how vectors become rows.
    fn reader(spec: &Spec, torso: &TorsoConfig, vectors: EncoderKind) -> Result<Reader<Self>, ConfigError>;

    /// Counts of its features.
    fn feature_counts(config: &FeatureCountsConfig) -> Result<Box<dyn Novelty<Self>>, String>;
}

/// How vectors become rows that networks read. Pictures become patches, as the torso wants them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum EncoderKind {
    /// One-hot where everything looks like a whole number, else scaled.
    #[default]
    Auto,
    /// A block a dimension, with a one at its value.
    OneHot,
    /// By the usual range of each dimension.
    Scaled,
}

impl Observed for Vector {
    fn reader(spec: &Spec, _: &TorsoConfig, vectors: EncoderKind) -> Result<Reader<Self>, ConfigError> {
        let one_hot = match vectors {
            EncoderKind::Auto => spec.observation.dimensions().iter().all(counts),
            EncoderKind::OneHot => true,
            EncoderKind::Scaled => false,
        };
        if !one_hot {
            return Ok(scaled(spec));
        }
        Ok(Arc::new(named("encoder", OneHot::new(&spec.observation, &[]).map_err(|why| why.to_string()))?))
    }

    fn feature_counts(config: &FeatureCountsConfig) -> Result<Box<dyn Novelty<Self>>, String> {
        Ok(Box::new(FeatureCounts::new(config)))
    }
}

impl Observed for Frame {
    fn reader(spec: &Spec, torso: &TorsoConfig, _: EncoderKind) -> Result<Reader<Self>, ConfigError> {
        Ok(Arc::new(named("torso", torso.encoder(&spec.observation).map_err(|why| why.to_string()))?))
    }

    fn feature_counts(_: &FeatureCountsConfig) -> Result<Box<dyn Novelty<Self>>, String> {
        Err("pictures have no features to be counted; set novelty.counts = \"states\" or \"cfn\", or see the world as \
             symbols: --see symbols"
            .into())
    }
}

/// Whether a dimension looks like a whole number: it counts something from a whole number up to another, in no unit that
/// things are measured in. A guess, which the setting overrules: a `Spec` does not say it.
fn counts(dimension: &Dimension) -> bool {
    let whole = |x: f32| x.is_finite() && x >= 0.0 && x.fract() == 0.0;
    dimension.kind == Kind::Linear
        && whole(dimension.low)
        && whole(dimension.high)
        && ["", "cells", "steps", "turns"].contains(&dimension.unit)
}

#[cfg(test)]
mod tests {
    use super::*;
    use inroads_envs::registry::{self, AnyEnvironment, Options};

    /// Numbers a row that networks read of a world of symbols.
    fn width(world: &str, kind: EncoderKind) -> usize {
        let options = Options { see: Some("symbols".parse().unwrap()), ..Options::default() };
        let AnyEnvironment::Choices(env) = registry::make_with(world, &options).unwrap() else {
            panic!("{world} is seen otherwise")
        };
        Vector::reader(env.spec(), &TorsoConfig::default(), kind).unwrap().width()
    }

    #[test]
    fn what_counts_is_one_hot_and_what_is_measured_is_scaled() {
        // Rows, columns, passenger's places, destinations.
        assert_eq!(width("taxi", EncoderKind::Auto), 5 + 5 + 5 + 4);
        assert_eq!(width("taxi", EncoderKind::Scaled), 4);
        // The agent and what it holds and stands on, and 25 cells of an object, a colour and a state.
        assert_eq!(
            width("door-key-5x5", EncoderKind::Auto),
            (5 + 5 + 4 + 8 + 6 + 13 + 10 + 6) + 25 * (11 + 6 + 4)
        );
        assert_eq!(width("pinball", EncoderKind::Auto), width("pinball", EncoderKind::Scaled));
        assert_eq!(width("montezuma", EncoderKind::Auto), width("montezuma", EncoderKind::Scaled));
    }

    #[test]
    fn pictures_are_read_as_patches_whole() {
        let options = Options { see: Some("rgb".parse().unwrap()), ..Options::default() };
        let AnyEnvironment::Frames(env) = registry::make_with("empty-5x5", &options).unwrap() else {
            panic!("it is seen otherwise")
        };
        let reader = Frame::reader(env.spec(), &TorsoConfig::default(), EncoderKind::Auto).unwrap();
        assert_eq!(reader.width(), env.spec().observation.len());
        assert!(Frame::feature_counts(&FeatureCountsConfig::default()).err().unwrap().contains("symbols"));
    }
}
