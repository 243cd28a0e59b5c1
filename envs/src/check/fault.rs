//! What can be wrong with an environment.

use std::borrow::Cow;

use crate::{End, Refused};

/// What is wrong with an observation.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Flaw {
    /// It has another shape than the spec says.
    #[error("the observation has {found} where the spec has {expected}")]
    Shape {
        /// What it has.
        found: String,
        /// What it must have.
        expected: String,
    },
    /// A component is NaN or infinite.
    #[error("observation component {index} ({name}) is {value}")]
    NotFinite {
        /// Which component.
        index: usize,
        /// What the spec calls it.
        name: Cow<'static, str>,
        /// Its value.
        value: f32,
    },
}

/// A clause of the contract that an environment breaks.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Fault {
    /// The spec contradicts itself.
    #[error("the spec contradicts itself: {0}")]
    Spec(&'static str),
    /// An observation is not of the space in the spec.
    #[error("seed {seed}, step {step}: the observation {seen} is not of the spec's space: {why}")]
    Observation {
        /// The episode's seed.
        seed: u64,
        /// Steps taken.
        step: u32,
        /// The observation.
        seen: String,
        /// What is wrong with it.
        why: Flaw,
    },
    /// `observe` left something of what the buffer held.
    #[error("seed {seed}, step {step}: observe leaves part of what the buffer held; write all of it")]
    Buffer {
        /// The episode's seed.
        seed: u64,
        /// Steps taken.
        step: u32,
    },
    /// A reward is NaN or infinite.
    #[error("seed {seed}, step {step}: the reward is {reward}; rewards must be finite")]
    Reward {
        /// The episode's seed.
        seed: u64,
        /// Steps taken.
        step: u32,
        /// The reward.
        reward: f32,
    },
    /// The same seed and actions gave something else.
    #[error(
        "seed {seed}, step {step}: the same seed and actions gave another episode; draw only from the seed"
    )]
    Replay {
        /// The episode's seed.
        seed: u64,
        /// First step that differs.
        step: u32,
    },
    /// What is seen depends on how often one looks.
    #[error(
        "seed {seed}, step {step}: who looks seldom sees something else; what is remembered of the last drawing is wrong"
    )]
    Looks {
        /// The episode's seed.
        seed: u64,
        /// First step that differs.
        step: u32,
    },
    /// A legal action was refused.
    #[error("seed {seed}, step {step}: a legal action was refused: {refused}")]
    RefusedLegal {
        /// The episode's seed.
        seed: u64,
        /// Steps taken.
        step: u32,
        /// The refusal.
        refused: Refused,
    },
    /// An illegal action was carried out, or refused for the wrong reason.
    #[error("seed {seed}, step {step}: the illegal action {action} was answered with {answer}")]
    Admitted {
        /// The episode's seed.
        seed: u64,
        /// Steps taken.
        step: u32,
        /// The action.
        action: String,
        /// The answer.
        answer: String,
    },
    /// A refused action left its mark.
    #[error(
        "seed {seed}, step {step}: refused actions have changed the episode; refuse before changing anything"
    )]
    Mark {
        /// The episode's seed.
        seed: u64,
        /// First step that differs.
        step: u32,
    },
    /// `step` outside an episode was not refused as [`Refused::Over`].
    #[error("step {when} was answered with {answer}; it must be refused with Over")]
    NotOver {
        /// Before the first reset or after the end.
        when: &'static str,
        /// The answer.
        answer: String,
    },
    /// Truncation and the spec's time limit disagree.
    #[error(
        "seed {seed}: after {step} steps the episode's end is {end:?}, but the spec's time limit is {limit:?}"
    )]
    Limit {
        /// The episode's seed.
        seed: u64,
        /// Steps taken.
        step: u32,
        /// How it ended.
        end: Option<End>,
        /// The spec's limit.
        limit: Option<u32>,
    },
}
