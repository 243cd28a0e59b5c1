//! What is in a learner's memory.

use crate::Memory;

/// What a [`Memory`] holds between two steps of an episode: plain numbers, in the order of these fields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Remembered<'a> {
    /// What the cell put out.
    pub(super) hidden: &'a [f32],
    /// What it keeps.
    pub(super) cell: &'a [f32],
    /// What was chosen.
    pub(super) choice: usize,
    /// Which rung of the exploration's ladder the episode has.
    pub(super) rung: u32,
}

impl<'a> Remembered<'a> {
    /// What a memory of a cell of that width holds: nothing at the beginning of an episode, and nothing where somebody
    /// else left it.
    pub(super) fn read(memory: &'a [f32], width: usize) -> Option<Self> {
        if memory.len() != 2 * width + 2 {
            return None;
        }
        let (hidden, rest) = memory.split_at(width);
        let (cell, rest) = rest.split_at(width);
        Some(Self { hidden, cell, choice: rest[0] as usize, rung: rest[1] as u32 })
    }

    /// Puts it into a memory in place of whatever was there.
    pub(super) fn write(self, memory: &mut Memory) {
        memory.clear();
        memory.extend_from_slice(self.hidden);
        memory.extend_from_slice(self.cell);
        memory.extend([self.choice as f32, self.rung as f32]);
    }
}
