//! Why there is no such grid.

/// Why there is no such grid. Each says what would be one.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GridError {
    /// A number is too small or too large.
    #[error("{what}: {found} is not possible; give {least} to {greatest}")]
    Size {
        /// Which number.
        what: &'static str,
        /// What was given.
        found: u32,
        /// Least that is possible.
        least: u32,
        /// Greatest that is possible.
        greatest: u32,
    },
    /// An encoding has the wrong length.
    #[error(
        "the encoding has {found} bytes; a grid of {0} by {1} cells has {2}, three a cell",
        size[0], size[1], 3 * usize::from(size[0]) * usize::from(size[1])
    )]
    Length {
        /// Columns and rows.
        size: [u8; 2],
        /// Bytes that were given.
        found: usize,
    },
    /// A cell's bytes mean nothing.
    #[error(
        "cell ({0}, {1}): no object is encoded as {2}, {3}, {4}; see `Cell::encode` for what there is, \
         and give the agent's pose apart",
        at[0], at[1], bytes[0], bytes[1], bytes[2]
    )]
    Cell {
        /// Column and row.
        at: [u8; 2],
        /// Object, colour and state.
        bytes: [u8; 3],
    },
    /// The agent cannot be where it is put.
    #[error("cell ({0}, {1}): the agent cannot stand there; put it on an empty cell, or move what is there", at[0], at[1])]
    Agent {
        /// Column and row.
        at: [u8; 2],
    },
    /// What is to be carried cannot be.
    #[error("the agent cannot carry {0:?}; it carries keys, balls and boxes")]
    Carried(super::Cell),
    /// There is nothing to succeed with.
    #[error("the task needs {0} on the board, and there is none; add it, or set another task")]
    Task(&'static str),
}
