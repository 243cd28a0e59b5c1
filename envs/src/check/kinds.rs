//! Observations and actions of the kinds that there are.

use std::fmt::Debug;

use rand::RngExt;

use super::Flaw;
use crate::{Annotated, Bits, Dimension, Frame, Rng, Space};

/// The shape of a space in words.
fn shape(space: &Space) -> String {
    match space {
        Space::Frame { width, height, channels } => format!("{width} by {height} pixels of {channels} bytes"),
        other => components(other.len()),
    }
}

fn components(n: usize) -> String {
    format!("{n} component{}", if n == 1 { "" } else { "s" })
}

/// Observations that can be checked.
pub trait Observed: Clone + Default + PartialEq + Debug {
    /// What is wrong with an observation of this space.
    fn flaw(&self, space: &Space) -> Option<Flaw>;
    /// Buffers that hold something already.
    fn used() -> Vec<Self>;
    /// The observation in a line, for people.
    fn told(&self) -> String {
        format!("{self:?}")
    }
}

impl Observed for Vec<f32> {
    fn flaw(&self, space: &Space) -> Option<Flaw> {
        if self.len() != space.len() {
            return Some(Flaw::Shape { found: components(self.len()), expected: shape(space) });
        }
        let index = self.iter().position(|x| !x.is_finite())?;
        let name = space.dimensions().get(index).map(|dimension| dimension.name.clone()).unwrap_or_default();
        Some(Flaw::NotFinite { index, name, value: self[index] })
    }

    fn used() -> Vec<Self> {
        vec![vec![f32::NAN; 1000], vec![7.0]]
    }
}

impl Observed for Frame {
    fn flaw(&self, space: &Space) -> Option<Flaw> {
        let [width, height] = self.size();
        let own = Space::Frame { width, height, channels: self.channels() };
        (own != *space).then(|| Flaw::Shape { found: shape(&own), expected: shape(space) })
    }

    fn used() -> Vec<Self> {
        let full = |size, channels| {
            let mut frame = Self::new(size, channels);
            frame.bytes_mut().fill(0xa5);
            frame
        };
        vec![full([300, 300], 3), full([2, 1], 1)]
    }

    fn told(&self) -> String {
        let [width, height] = self.size();
        format!("picture of {width} by {height} pixels with {} channels", self.channels())
    }
}

impl<O: Observed> Observed for Annotated<O> {
    fn flaw(&self, space: &Space) -> Option<Flaw> {
        self.seen.flaw(space)
    }

    fn used() -> Vec<Self> {
        let mut bits = Bits::new(200);
        (0..200).for_each(|bit| bits.set(bit));
        O::used().into_iter().map(|seen| Self { seen, bits: bits.clone() }).collect()
    }

    fn told(&self) -> String {
        format!("{} with {} proto-goals", self.seen.told(), self.bits.len())
    }
}

/// Actions that can be drawn.
pub trait Drawn: Clone + Debug {
    /// A legal action, uniformly over the space (over [-1, 1] where a dimension has no bounds).
    fn legal(space: &Space, rng: &mut Rng) -> Self;
    /// One action for each way of being illegal.
    fn illegal(space: &Space) -> Vec<Self>;
}

impl Drawn for Vec<f32> {
    fn legal(space: &Space, rng: &mut Rng) -> Self {
        let bounded = |d: &Dimension| {
            let low = if d.low.is_finite() { d.low } else { d.high.min(-1.0) };
            (low, if d.high.is_finite() { d.high } else { low.max(1.0) })
        };
        space.dimensions().iter().map(bounded).map(|(low, high)| rng.random_range(low..=high)).collect()
    }

    fn illegal(space: &Space) -> Vec<Self> {
        let legal: Self = space.dimensions().iter().map(|d| 0.0_f32.clamp(d.low, d.high)).collect();
        let mut actions = vec![vec![], [legal.as_slice(), &[0.0]].concat()];
        for (index, dimension) in space.dimensions().iter().enumerate() {
            let mut with = |value: f32| {
                let mut action = legal.clone();
                action[index] = value;
                actions.push(action);
            };
            [f32::NAN, f32::INFINITY, f32::NEG_INFINITY].into_iter().for_each(&mut with);
            if dimension.low.is_finite() {
                with(dimension.low.next_down());
            }
            if dimension.high.is_finite() {
                with(dimension.high.next_up());
            }
        }
        actions
    }
}

impl Drawn for usize {
    fn legal(space: &Space, rng: &mut Rng) -> Self {
        match space {
            Space::Discrete(n) => rng.random_range(0..*n),
            Space::Box(_) | Space::Frame { .. } => 0,
        }
    }

    fn illegal(space: &Space) -> Vec<Self> {
        match space {
            Space::Discrete(n) => vec![*n, Self::MAX],
            Space::Box(_) | Space::Frame { .. } => vec![],
        }
    }
}
