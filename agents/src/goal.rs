//! Goals as values: what says whether a state attains it, and what a network can read.

mod region;

use serde::{Serialize, de::DeserializeOwned};

pub use region::{Ground, Region};

use crate::{Encode, Key};

/// Something that a state attains or does not: β of the skill that pursues it.
pub trait Goal<O>: Clone + PartialEq + Encode + Key + Serialize + DeserializeOwned {
    /// Whether `s` attains it.
    fn reached(&self, s: &O) -> bool;

    /// The features of a state that it asks for, and their values; none where it is not about features.
    fn kept(&self) -> Vec<(u32, f32)> {
        Vec::new()
    }
}

/// Skills that have but one subgoal each need no goal to tell it by.
impl<O> Goal<O> for () {
    fn reached(&self, _: &O) -> bool {
        false
    }
}
