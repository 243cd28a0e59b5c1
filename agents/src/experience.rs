//! Experience is written once; learners own lessons, not data.
//!
//! A [`Lesson`] says that some steps of some episode teach something, and what: some tens of bytes, whatever
//! an observation weighs. A [`Replay`] is a ring of lessons, from which a learner draws [`Clip`]s that borrow.

use std::collections::VecDeque;
use std::ops::Range;

use inroads_envs::{End, Rng};
use rand::RngExt;
use serde::{Deserialize, Serialize};

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

    /// A new episode begins at `s`.
    pub fn begin(&mut self, s: &O) {
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
        });
    }

    /// The running episode went on by one step.
    ///
    /// # Panics
    /// When no episode was begun.
    pub fn push(&mut self, t: &Transition<O, A>) {
        let episode = self.episodes.back_mut().expect("begin comes before push");
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

    /// Steps that the episode of that number has so far; 0 when it is not here.
    pub fn length(&self, number: u64) -> u32 {
        self.episode(number).map_or(0, |episode| episode.actions.len() as u32)
    }

    /// The numbers of all episodes that are here.
    pub fn numbers(&self) -> Range<u64> {
        self.first..self.first + self.episodes.len() as u64
    }
}

/// What a lesson teaches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Aim {
    /// The task itself, with the task's rewards and the episode's end.
    Task,
    /// A subgoal, attained at the last step or not at all; attaining it ends the lesson for good.
    Subgoal {
        /// Whether the last step attained it.
        attained: bool,
    },
}

/// Some steps of an episode as something to learn from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lesson {
    /// The episode's number.
    pub episode: u64,
    /// Its steps.
    pub steps: Range<u32>,
    /// What they teach.
    pub aim: Aim,
    /// Rewards that replace the ones that follow from the aim, one a step (dense rewards).
    pub rewards: Option<Box<[f32]>>,
}

/// A step (or a few) to learn from, borrowed from the experience.
#[derive(Clone, Copy, Debug)]
pub struct Clip<'a, O, A> {
    /// Observations, one more than actions.
    pub observations: &'a [O],
    /// Actions taken.
    pub actions: &'a [A],
    /// Reward of the clip's first (and, at length one, only) action.
    pub reward: f32,
    /// Whether the value of what follows is zero: the task terminated or the subgoal was attained. A
    /// truncation, and an option's time-out, are not this.
    pub terminal: bool,
}

/// Reward of a step that does not attain the subgoal (`decisions.md`: 0 on success, −1 a step).
pub const STEP_PENALTY: f32 = -1.0;
/// Reward of the step that attains the subgoal.
pub const ATTAINED: f32 = 0.0;

/// A ring of lessons, sampled uniformly over their steps.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Replay {
    lessons: VecDeque<Lesson>,
    /// `ends[i]` is the number of steps ever stored up to and with `lessons[i]`.
    ends: VecDeque<u64>,
    /// Steps ever stored before `lessons[0]`.
    dropped: u64,
    capacity: u64,
}

impl Replay {
    /// Keeps about `capacity` steps.
    pub fn new(capacity: usize) -> Self {
        Self { lessons: VecDeque::new(), ends: VecDeque::new(), dropped: 0, capacity: capacity as u64 }
    }

    /// Adds a lesson; the oldest ones fall out when the ring is full.
    pub fn push(&mut self, lesson: Lesson) {
        if lesson.steps.is_empty() {
            return;
        }
        let end = self.total() + u64::from(lesson.steps.end - lesson.steps.start);
        self.lessons.push_back(lesson);
        self.ends.push_back(end);
        while self.len() as u64 > self.capacity && self.lessons.len() > 1 {
            self.drop_oldest();
        }
    }

    /// Forgets lessons of episodes that the experience has forgotten.
    pub fn forget_before(&mut self, first: u64) {
        while self.lessons.front().is_some_and(|lesson| lesson.episode < first) {
            self.drop_oldest();
        }
    }

    fn drop_oldest(&mut self) {
        self.lessons.pop_front();
        self.dropped = self.ends.pop_front().unwrap_or(self.dropped);
    }

    fn total(&self) -> u64 {
        self.ends.back().copied().unwrap_or(self.dropped)
    }

    /// Number of steps to draw from.
    pub fn len(&self) -> usize {
        (self.total() - self.dropped) as usize
    }

    /// Whether there is nothing to draw.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Draws `n` steps with replacement into `clips`. Nothing is drawn from an empty ring.
    ///
    /// # Panics
    /// When a lesson speaks of an episode that `all` has forgotten: call
    /// [`forget_before`](Self::forget_before) when episodes are.
    pub fn sample<'a, O, A>(
        &self,
        all: &'a Experience<O, A>,
        n: usize,
        rng: &mut Rng,
        clips: &mut Vec<Clip<'a, O, A>>,
    ) {
        clips.clear();
        if self.is_empty() {
            return;
        }
        for _ in 0..n {
            let at = rng.random_range(self.dropped..self.total());
            let index = self.ends.partition_point(|&end| end <= at);
            let lesson = &self.lessons[index];
            let before = if index == 0 { self.dropped } else { self.ends[index - 1] };
            clips.push(clip(lesson, lesson.steps.start as usize + (at - before) as usize, all));
        }
    }
}

/// One step of a lesson, with the reward and the end that its aim gives it.
fn clip<'a, O, A>(lesson: &Lesson, step: usize, all: &'a Experience<O, A>) -> Clip<'a, O, A> {
    let episode = all.episode(lesson.episode).expect("lessons are forgotten with their episodes");
    let last = step + 1 == lesson.steps.end as usize;
    let terminated = step + 1 == episode.actions.len() && episode.end == Some(End::Terminated);
    let (reward, terminal) = match lesson.aim {
        Aim::Task => (episode.rewards[step], terminated),
        Aim::Subgoal { attained } => {
            let attained = attained && last;
            // A task that terminates elsewhere ends the lesson too, and for good: nobody goes on from there.
            (if attained { ATTAINED } else { STEP_PENALTY }, attained || terminated)
        }
    };
    let reward = lesson.rewards.as_ref().map_or(reward, |r| r[step - lesson.steps.start as usize]);
    Clip {
        observations: &episode.observations[step..=step + 1],
        actions: &episode.actions[step..=step],
        reward,
        terminal,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use inroads_envs::Seed;

    /// Three episodes of the given lengths whose observations count up; the second is truncated.
    fn experience(capacity: usize) -> Experience<f32, u8> {
        let mut all = Experience::new(capacity);
        let mut value = 0.0;
        for (steps, end) in [(2, End::Terminated), (3, End::Truncated), (2, End::Terminated)] {
            all.begin(&value);
            for step in 0..steps {
                let (before, after) = (value, value + 1.0);
                let end = (step + 1 == steps).then_some(end);
                all.push(&Transition { before: &before, action: &0, reward: before, after: &after, end });
                value = after;
            }
            value += 1.0;
        }
        all
    }

    fn task(episode: u64, steps: Range<u32>) -> Lesson {
        Lesson { episode, steps, aim: Aim::Task, rewards: None }
    }

    fn all_clips(replay: &Replay, all: &Experience<f32, u8>) -> Vec<(f32, f32, f32, bool)> {
        let mut clips = Vec::new();
        replay.sample(all, 400, &mut Seed(0).stream("test", 0), &mut clips);
        let mut seen: Vec<_> =
            clips.iter().map(|c| (c.observations[0], c.observations[1], c.reward, c.terminal)).collect();
        seen.sort_by(|a, b| a.0.total_cmp(&b.0));
        seen.dedup();
        seen
    }

    #[test]
    fn clips_never_cross_an_episode_and_only_terminations_are_terminal() {
        let all = experience(100);
        let mut replay = Replay::new(100);
        for (episode, steps) in [(0, 0..2), (1, 0..3), (2, 0..2)] {
            replay.push(task(episode, steps));
        }
        let expected = [(0.0, false), (1.0, true), (3.0, false), (4.0, false), (5.0, false), (7.0, false)];
        let seen = all_clips(&replay, &all);
        assert_eq!(seen.len(), 7);
        for ((from, terminal), clip) in expected.iter().zip(&seen) {
            assert_eq!(*clip, (*from, from + 1.0, *from, *terminal));
        }
    }

    #[test]
    fn an_attained_subgoal_ends_its_lesson_and_a_missed_one_bootstraps() {
        let all = experience(100);
        let mut replay = Replay::new(100);
        let lesson =
            |attained, steps| Lesson { episode: 1, steps, aim: Aim::Subgoal { attained }, rewards: None };
        replay.push(lesson(true, 0..2));
        replay.push(lesson(false, 2..3));
        let expected =
            [(3.0, 4.0, STEP_PENALTY, false), (4.0, 5.0, ATTAINED, true), (5.0, 6.0, STEP_PENALTY, false)];
        assert_eq!(all_clips(&replay, &all), expected);
    }

    #[test]
    fn the_ring_forgets_the_oldest_lessons_and_dense_rewards_replace_sparse_ones() {
        let all = experience(100);
        let mut replay = Replay::new(4);
        replay.push(task(0, 0..2));
        replay.push(Lesson { rewards: Some(Box::new([0.5, 0.25, 0.125])), ..task(1, 0..3) });
        assert_eq!(replay.len(), 3);
        let rewards: Vec<_> = all_clips(&replay, &all).iter().map(|c| c.2).collect();
        assert_eq!(rewards, [0.5, 0.25, 0.125]);
    }

    #[test]
    fn whole_episodes_are_forgotten_with_their_lessons() {
        let mut all = experience(4);
        all.begin(&0.0);
        assert_eq!(all.first(), 2, "seven steps are over a capacity of four until two episodes are gone");
        let mut replay = Replay::new(100);
        replay.push(task(1, 0..3));
        replay.push(task(2, 0..2));
        replay.forget_before(all.first());
        assert_eq!(replay.len(), 2);
        assert!(all_clips(&replay, &all).iter().all(|c| c.0 >= 7.0));
    }
}
