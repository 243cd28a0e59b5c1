//! What an agent may know of a domain, as data.

use std::{borrow::Cow, sync::Arc};

use crate::{Refused, Step};

/// Whether a dimension is a line or a circle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A quantity on a line.
    Linear,
    /// An angle in radians, possibly unwrapped: learners see its sine and cosine.
    Angle,
}

/// One component of an observation or action.
#[derive(Clone, Debug, PartialEq)]
pub struct Dimension {
    /// What it is, in one word.
    pub name: Cow<'static, str>,
    /// Its unit, `""` when it has none.
    pub unit: &'static str,
    /// Least value. For observations the *usual* range (used for scaling), unbounded when infinite.
    pub low: f32,
    /// Greatest value, as `low`.
    pub high: f32,
    /// Line or circle.
    pub kind: Kind,
}

impl Dimension {
    /// A dimension on a line.
    pub const fn linear(name: &'static str, unit: &'static str, low: f32, high: f32) -> Self {
        Self { name: Cow::Borrowed(name), unit, low, high, kind: Kind::Linear }
    }

    /// An angle in radians without bounds.
    pub const fn angle(name: &'static str) -> Self {
        let name = Cow::Borrowed(name);
        Self { name, unit: "rad", low: f32::NEG_INFINITY, high: f32::INFINITY, kind: Kind::Angle }
    }
}

/// The shape and range of observations or actions.
#[derive(Clone, Debug, PartialEq)]
pub enum Space {
    /// A vector of numbers. Clones share what there is to say of them: of a large grid it weighs more than all the rest.
    Box(Arc<[Dimension]>),
    /// One of `n` choices, `0..n`.
    Discrete(usize),
    /// A picture.
    Frame {
        /// Pixels a row.
        width: u32,
        /// Rows.
        height: u32,
        /// Bytes a pixel.
        channels: u32,
    },
}

impl Space {
    /// Number of components of a vector or a picture; 1 for a choice.
    pub fn len(&self) -> usize {
        match self {
            Self::Box(dimensions) => dimensions.len(),
            Self::Discrete(_) => 1,
            Self::Frame { width, height, channels } => {
                [*width, *height, *channels].map(|n| n as usize).iter().product()
            }
        }
    }

    /// Whether there is nothing to see or do.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The dimensions of a vector; none for a choice or a picture.
    pub fn dimensions(&self) -> &[Dimension] {
        match self {
            Self::Box(dimensions) => dimensions,
            Self::Discrete(_) | Self::Frame { .. } => &[],
        }
    }

    /// How many choices there are; none where something else is done.
    pub fn choices(&self) -> usize {
        match self {
            Self::Discrete(choices) => *choices,
            Self::Box(_) | Self::Frame { .. } => 0,
        }
    }

    /// Checks a vector action: length, finiteness, range.
    ///
    /// # Errors
    /// [`Refused`] naming the first component at fault.
    pub fn admit(&self, action: &[f32]) -> Result<(), Refused> {
        let dimensions = self.dimensions();
        if action.len() != dimensions.len() {
            return Err(Refused::Shape { expected: dimensions.len(), found: action.len() });
        }
        for (index, (&value, dimension)) in action.iter().zip(dimensions).enumerate() {
            if !value.is_finite() {
                return Err(Refused::NotFinite { index, value });
            }
            if value < dimension.low || value > dimension.high {
                let (low, high) = (dimension.low, dimension.high);
                return Err(Refused::OutOfRange { index, value, low, high });
            }
        }
        Ok(())
    }

    /// Checks a choice.
    ///
    /// # Errors
    /// [`Refused::OutOfRange`] when there are fewer choices.
    pub fn admit_choice(&self, choice: usize) -> Result<(), Refused> {
        match self {
            Self::Discrete(n) if choice < *n => Ok(()),
            Self::Discrete(n) => Err(Refused::OutOfRange {
                index: 0,
                value: choice as f32,
                low: 0.0,
                high: n.saturating_sub(1) as f32,
            }),
            other => Err(Refused::Shape { expected: other.len(), found: 1 }),
        }
    }
}

/// The task's goal as a region: a ball around a point of some of the observation's dimensions.
#[derive(Clone, Debug, PartialEq)]
pub struct Goal {
    /// Indices of the observation's dimensions that the goal speaks of.
    pub dims: Vec<usize>,
    /// The point, one number a dimension.
    pub at: Vec<f32>,
    /// Greatest Euclidean distance that still counts as there.
    pub tolerance: f32,
}

impl Goal {
    /// Euclidean distance from an observation to the goal's point.
    pub fn distance(&self, observation: &[f32]) -> f32 {
        self.dims.iter().zip(&self.at).map(|(&d, &at)| (observation[d] - at).powi(2)).sum::<f32>().sqrt()
    }

    /// Writes into the caller's buffer what an observation has of the goal's dimensions.
    pub fn achieved(&self, observation: &[f32], out: &mut Vec<f32>) {
        out.clear();
        out.extend(self.dims.iter().map(|&d| observation[d]));
    }

    /// Whether the observation lies within the tolerance.
    pub fn reached(&self, observation: &[f32]) -> bool {
        self.distance(observation) <= self.tolerance
    }
}

/// What agents may know of a domain before they act.
#[derive(Clone, Debug, PartialEq)]
pub struct Spec {
    /// The domain's name in the registry.
    pub name: &'static str,
    /// One sentence for `inroads list`.
    pub about: &'static str,
    /// What is seen.
    pub observation: Space,
    /// What is done.
    pub action: Space,
    /// The task's goal, when it is a region of observations; `None` when there is no task or it is not one.
    pub goal: Option<Goal>,
    /// The observation's dimensions that say *where* one is, on which initiation sets are learned by default.
    pub place: Vec<usize>,
    /// Steps after which an episode is truncated; `None` when nothing truncates.
    pub time_limit: Option<u32>,
    /// An episode that terminates with at least this reward on its last step succeeded.
    pub success_reward: f32,
}

impl Spec {
    /// Whether an episode that ended with this step succeeded.
    pub fn succeeded(&self, last: &Step) -> bool {
        last.end == Some(crate::End::Terminated) && last.reward >= self.success_reward
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_large_picture_has_more_components_than_32_bits_count() {
        let frame = Space::Frame { width: 65_280, height: 65_280, channels: 3 };
        assert_eq!(frame.len() as u64, 12_784_435_200);
    }

    #[test]
    fn clones_share_what_there_is_to_say_of_numbers() {
        let space = Space::Box([Dimension::angle("heading")].into());
        assert!(std::ptr::eq(space.clone().dimensions(), space.dimensions()));
    }
}
