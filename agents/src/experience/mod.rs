//! Experience is written once; learners own lessons, not data.
//!
//! A [`Lesson`] says that some steps of some episode teach something, and what: some tens of bytes, whatever
//! an observation weighs. A [`Replay`](crate::Replay) is a ring of lessons, from which a learner draws [`Clip`]s that
//! borrow. So a frame is kept once, as the bytes that it is, and neighbouring transitions share it.

mod lesson;

use std::collections::{BTreeMap, VecDeque};
use std::ops::Range;

use inroads_envs::End;
use serde::{Deserialize, Serialize};

pub use lesson::{Aim, Clip, Lesson, Pay, Rewards, discounted};

use crate::Transition;

/// The steps of one episode: `observations` has one element more than `actions` and `rewards`.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Episode<O, A> {
    /// Every observation, the last one included.
    pub observations: Vec<O>,
    /// The action taken at each observation but the last.
    pub actions: Vec<A>,
    /// The task's reward of each action.
    pub rewards: Vec<f32>,
    /// How it ended; `None` while it goes on.
    pub end: Option<End>,
    /// What whoever acted remembered just before it saw observation number so and so ([`Experience::note`]).
    pub memories: BTreeMap<u32, Vec<f32>>,
}

/// All episodes that are still remembered, oldest first.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Experience<O, A> {
    episodes: VecDeque<Episode<O, A>>,
    /// The number of the oldest episode that is still here.
    first: u64,
    /// Steps in all episodes that are here.
    steps: usize,
    capacity: usize,
}

impl<O: Clone, A: Clone> Experience<O, A> {
    /// Remembers about `capacity` steps; whole episodes are forgotten, oldest first, when the next one begins.
    pub fn new(capacity: usize) -> Self {
        Self { episodes: VecDeque::new(), first: 0, steps: 0, capacity }
    }

    /// A new episode begins at `s`; its number. Others may go on beside it ([`push_to`](Self::push_to)).
    pub fn begin(&mut self, s: &O) -> u64 {
        while self.steps > self.capacity && self.episodes.len() > 1 {
            let forgotten = self.episodes.pop_front().expect("the queue was not empty");
            self.steps -= forgotten.actions.len();
            self.first += 1;
        }
        self.episodes.push_back(Episode {
            observations: vec![s.clone()],
            actions: Vec::new(),
            rewards: Vec::new(),
            end: None,
            memories: BTreeMap::new(),
        });
        self.latest()
    }

    /// The episode begun last went on by one step.
    ///
    /// # Panics
    /// When no episode was begun.
    pub fn push(&mut self, t: &Transition<O, A>) {
        self.push_to(self.latest(), t);
    }

    /// The episode of that number went on by one step.
    ///
    /// # Panics
    /// When it is not here.
    pub fn push_to(&mut self, number: u64, t: &Transition<O, A>) {
        let episode = self.episode_mut(number).expect("begin comes before push");
        episode.observations.push(t.after.clone());
        episode.actions.push(t.action.clone());
        episode.rewards.push(t.reward);
        episode.end = t.end;
        self.steps += 1;
    }
}

impl<O, A> Experience<O, A> {
    /// The number of the oldest episode that is still here.
    pub fn first(&self) -> u64 {
        self.first
    }

    /// The number of the newest episode.
    pub fn latest(&self) -> u64 {
        (self.first + self.episodes.len() as u64).saturating_sub(1)
    }

    /// The episode of that number, when it is still here.
    pub fn episode(&self, number: u64) -> Option<&Episode<O, A>> {
        self.episodes.get(usize::try_from(number.checked_sub(self.first)?).ok()?)
    }

    fn episode_mut(&mut self, number: u64) -> Option<&mut Episode<O, A>> {
        self.episodes.get_mut(usize::try_from(number.checked_sub(self.first)?).ok()?)
    }

    /// Keeps what whoever acts remembers before it sees the newest observation of an episode: sequences that begin there
    /// are learned from that state on (R2D2, Kapturowski 2019, section 3). An empty memory needs no keeping.
    pub fn note(&mut self, number: u64, memory: &[f32]) {
        if memory.is_empty() {
            return;
        }
        if let Some(episode) = self.episode_mut(number) {
            episode.memories.insert(episode.actions.len() as u32, memory.to_vec());
        }
    }

    /// Steps that the episode of that number has so far; 0 when it is not here.
    pub fn length(&self, number: u64) -> u32 {
        self.episode(number).map_or(0, |episode| episode.actions.len() as u32)
    }

    /// The numbers of all episodes that are here.
    pub fn numbers(&self) -> Range<u64> {
        self.first..self.first + self.episodes.len() as u64
    }
}

/// A moment: an episode's number, and that of an observation in it.
pub type Moment = (u64, u32);

/// Observations by moment, whatever was done between them: what novelty needs of an [`Experience`]. A list of
/// observations is one episode.
pub trait Seen<O> {
    /// The observation of that moment, when it is still remembered.
    fn seen(&self, at: Moment) -> Option<&O>;

    /// The number of the oldest episode that is still remembered.
    fn oldest(&self) -> u64;
}

impl<O> Seen<O> for Vec<O> {
    fn seen(&self, (_, step): Moment) -> Option<&O> {
        self.get(step as usize)
    }

    fn oldest(&self) -> u64 {
        0
    }
}

impl<O, A> Seen<O> for Experience<O, A> {
    fn seen(&self, (number, step): Moment) -> Option<&O> {
        self.episode(number)?.observations.get(step as usize)
    }

    fn oldest(&self) -> u64 {
        self.first
    }
}
