//! Observations of which many make a batch.

use crate::Frame;

/// An observation that is a row of numbers, as many for all copies of a domain, so that those of several copies lie
/// one after the other in memory.
pub trait Row: Clone + Default + Send {
    /// What it consists of.
    type Number: Copy + Default + PartialEq + std::fmt::Debug + Send + Sync;

    /// The row.
    fn numbers(&self) -> &[Self::Number];
}

impl Row for Vec<f32> {
    type Number = f32;

    fn numbers(&self) -> &[f32] {
        self
    }
}

/// `height × width × channels` bytes.
impl Row for Frame {
    type Number = u8;

    fn numbers(&self) -> &[u8] {
        self.bytes()
    }
}
