//! What stops an episode: an action that was refused, or a number that is none where one must be.

use inroads_envs::{Refused, check::Flaw};

/// Why an episode cannot go on. Whatever it is, nobody has learned from it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Fault {
    /// The environment refused an action.
    #[error("the environment refused an action: {0}")]
    Refused(#[from] Refused),
    /// What is seen is not of the spec's space.
    #[error(transparent)]
    Observation(#[from] Flaw),
    /// A reward is NaN or infinite.
    #[error("the reward is {0}")]
    Reward(f32),
    /// What an update came from, or came to, is NaN or infinite.
    #[error("the {what} is {value}")]
    Learning {
        /// A loss, say, and whose.
        what: &'static str,
        /// Its value.
        value: f32,
    },
}

/// A fault and when it was found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("step {step} of the episode: {fault}")]
pub struct Halt {
    /// Steps of the episode, that of the fault included.
    pub step: u32,
    /// What it is.
    pub fault: Fault,
}
