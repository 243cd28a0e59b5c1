//! What several copies answer, row by row.

use super::slot::Rows;
use crate::End;

/// The answers of all copies to a step: row `i` is copy `i`'s. `N` is what an observation consists of: `f32`, or bytes
/// of pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct Batch<N = f32> {
    width: usize,
    observations: Vec<N>,
    rewards: Vec<f32>,
    ends: Vec<Option<End>>,
    began: Vec<bool>,
    /// Last observations of episodes that ended in this step; what else stands there is old.
    lasts: Vec<N>,
    faults: Vec<Option<String>>,
}

impl<N: Copy + Default> Batch<N> {
    pub(super) fn new(count: usize, width: usize) -> Self {
        Self {
            width,
            observations: vec![N::default(); count * width],
            rewards: vec![0.0; count],
            ends: vec![None; count],
            began: vec![false; count],
            lasts: vec![N::default(); count * width],
            faults: vec![None; count],
        }
    }

    /// Numbers that one copy observes: of a picture `height × width × channels`.
    pub fn width(&self) -> usize {
        self.width
    }

    /// All observations, row-major: `count × width`.
    pub fn observations(&self) -> &[N] {
        &self.observations
    }

    /// What copy `copy` observes now.
    ///
    /// # Panics
    /// When there is no such copy, as all here.
    pub fn observation(&self, copy: usize) -> &[N] {
        &self.observations[copy * self.width..][..self.width]
    }

    /// The reward of each copy's step; 0 where the step only began an episode.
    pub fn rewards(&self) -> &[f32] {
        &self.rewards
    }

    /// How each copy's episode ended, in this step.
    pub fn ends(&self) -> &[Option<End>] {
        &self.ends
    }

    /// Which observations are the first of an episode. There is a transition into row `i` only where
    /// `began[i]` is false or [`last`](Self::last) holds what it led to.
    pub fn began(&self) -> &[bool] {
        &self.began
    }

    /// The last observation of the copy's episode, if it ended in this step.
    pub fn last(&self, copy: usize) -> Option<&[N]> {
        self.ends[copy].map(|_| &self.lasts[copy * self.width..][..self.width])
    }

    /// Why the simulator of a copy gave up in this step, if it did.
    pub fn fault(&self, copy: usize) -> Option<&str> {
        self.faults[copy].as_deref()
    }

    /// The batch in parts of so many copies.
    pub(super) fn parts(&mut self, copies: usize) -> impl Iterator<Item = Part<'_, N>> {
        let width = self.width;
        let numbers = self.observations.chunks_mut(copies * width).zip(self.lasts.chunks_mut(copies * width));
        let answers = self.rewards.chunks_mut(copies).zip(self.ends.chunks_mut(copies));
        let notes = self.began.chunks_mut(copies).zip(self.faults.chunks_mut(copies));
        numbers.zip(answers).zip(notes).map(
            move |(((observations, lasts), (rewards, ends)), (began, faults))| Part {
                width,
                observations,
                lasts,
                rewards,
                ends,
                began,
                faults,
            },
        )
    }
}

/// The rows of some copies.
pub(super) struct Part<'a, N> {
    width: usize,
    observations: &'a mut [N],
    lasts: &'a mut [N],
    rewards: &'a mut [f32],
    ends: &'a mut [Option<End>],
    began: &'a mut [bool],
    faults: &'a mut [Option<String>],
}

impl<'a, N> Part<'a, N> {
    /// One copy after the other.
    pub(super) fn rows(self) -> impl Iterator<Item = Rows<'a, N>> {
        let numbers = self.observations.chunks_mut(self.width).zip(self.lasts.chunks_mut(self.width));
        let answers = self.rewards.iter_mut().zip(self.ends);
        let notes = self.began.iter_mut().zip(self.faults);
        numbers.zip(answers).zip(notes).map(|(((observation, last), (reward, end)), (began, fault))| Rows {
            observation,
            last,
            reward,
            end,
            began,
            fault,
        })
    }
}
