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
pub struct Lesson<G = ()> {
    /// The episode's number.
    pub episode: u64,
    /// Its steps.
    pub steps: Range<u32>,
    /// What they teach.
    pub aim: Aim,
    /// The goal that the learner is to read with them. None for the task, and for a learner that has but one subgoal.
    pub goal: Option<G>,
    /// Rewards that replace the ones that follow from the aim, one a step (dense rewards).
    pub rewards: Option<Box<[f32]>>,
}

impl<G> Lesson<G> {
    /// One step of the task.
    pub fn task(episode: u64, step: u32) -> Self {
        Self { episode, steps: step..step + 1, aim: Aim::Task, goal: None, rewards: None }
    }

    /// The same for a learner that reads no goals.
    pub fn without_goal(self) -> Lesson {
        let Self { episode, steps, aim, rewards, .. } = self;
        Lesson { episode, steps, aim, goal: None, rewards }
    }

    /// The same for a learner that reads this goal.
    pub fn with_goal<H>(self, goal: H) -> Lesson<H> {
        let Self { episode, steps, aim, rewards, .. } = self;
        Lesson { episode, steps, aim, goal: Some(goal), rewards }
    }
}

/// What the steps of a lesson about a subgoal pay.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pay {
    /// A step that does not attain it.
    pub step: f32,
    /// The step that attains it.
    pub attained: f32,
}

impl Pay {
    /// −1 a step, 0 on success (chapter 3; `decisions.md`).
    pub const COST: Self = Self { step: -1.0, attained: 0.0 };
    /// 1 on success, 0 before: a value is the discounted probability of success (chapters 4 to 9).
    pub const ATTAINMENT: Self = Self { step: 0.0, attained: 1.0 };
}

/// Rewards of a clip, one an action.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rewards<'a> {
    /// The task's, or dense ones.
    Given(&'a [f32]),
    /// Those of a subgoal, which the clip's last action attains or none does.
    Subgoal(Pay, bool),
}

/// A step (or a few) to learn from, borrowed from the experience.
#[derive(Clone, Copy, Debug)]
pub struct Clip<'a, O, A, G> {
    /// Observations, one more than actions.
    pub observations: &'a [O],
    /// Actions taken.
    pub actions: &'a [A],
    /// What each of them paid.
    pub rewards: Rewards<'a>,
    /// The goal to be read; none for the task.
    pub goal: Option<&'a G>,
    /// Whether the value of what follows is zero: the task terminated or the subgoal was attained. A
    /// truncation, and an option's time-out, are not this.
    pub terminal: bool,
}

impl<O, A, G> Clip<'_, O, A, G> {
    /// What action number `i` paid.
    pub fn reward(&self, i: usize) -> f32 {
        match self.rewards {
            Rewards::Given(rewards) => rewards[i],
            Rewards::Subgoal(pay, attained) if attained && i + 1 == self.actions.len() => pay.attained,
            Rewards::Subgoal(pay, _) => pay.step,
        }
    }

    /// Σ γᵗ r over the clip, and the discount of the value of its last observation: 0 when it is terminal.
    pub fn discounted(&self, gamma: f32) -> (f32, f32) {
        let (mut sum, mut discount) = (0.0, 1.0);
        for i in 0..self.actions.len() {
            sum += discount * self.reward(i);
            discount *= gamma;
        }
        (sum, if self.terminal { 0.0 } else { discount })
    }

    /// The observation after the last action.
    ///
    /// # Panics
    /// When the clip is empty, which none from a replay is.
    pub fn last(&self) -> &O {
        self.observations.last().expect("a clip has an observation more than actions")
    }
}

/// A ring of lessons, sampled uniformly over their steps.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Replay<G = ()> {
    lessons: VecDeque<Lesson<G>>,
    /// `ends[i]` is the number of steps ever stored up to and with `lessons[i]`.
    ends: VecDeque<u64>,
    /// Steps ever stored before `lessons[0]`.
    dropped: u64,
    /// The least episode of lessons that came behind one of a newer episode (hindsight about the past); none where all
    /// came in order.
    late: Option<u64>,
    capacity: u64,
    /// What subgoals pay.
    pay: Pay,
    /// Steps a clip, fewer at the end of a lesson.
    span: u32,
    /// Whether a lesson that ends without its subgoal ends for good.
    closing: bool,
}

impl<G> Replay<G> {
    /// Keeps about `capacity` steps, and gives clips of one, whose subgoals cost a step each.
    pub fn new(capacity: usize) -> Self {
        let (lessons, ends) = (VecDeque::new(), VecDeque::new());
        let (capacity, pay) = (capacity as u64, Pay::COST);
        Self { lessons, ends, dropped: 0, late: None, capacity, pay, span: 1, closing: false }
    }

    /// The same with other rewards of subgoals.
    pub fn paying(self, pay: Pay) -> Self {
        Self { pay, ..self }
    }

    /// The same with clips of up to `steps` steps, for n-step returns; at least 1.
    pub fn spanning(self, steps: u32) -> Self {
        Self { span: steps.max(1), ..self }
    }

    /// The same where a lesson that ends without its subgoal ends for good: nothing follows. For probabilities of
    /// success within a horizon, where γ is 1 (thesis 5.1.1; `decisions.md`); a learner of policies bootstraps there.
    pub fn closing(self) -> Self {
        Self { closing: true, ..self }
    }

    /// Adds a lesson; the oldest ones fall out when the ring is full.
    pub fn push(&mut self, lesson: Lesson<G>) {
        if lesson.steps.is_empty() {
            return;
        }
        self.append(lesson);
        while self.len() as u64 > self.capacity && self.lessons.len() > 1 {
            self.drop_oldest();
        }
    }

    fn append(&mut self, lesson: Lesson<G>) {
        if self.lessons.back().is_some_and(|newer| lesson.episode < newer.episode) {
            self.late = Some(self.late.map_or(lesson.episode, |late| late.min(lesson.episode)));
        }
        let end = self.total() + u64::from(lesson.steps.end - lesson.steps.start);
        self.lessons.push_back(lesson);
        self.ends.push_back(end);
    }

    /// Forgets lessons of episodes that the experience has forgotten.
    pub fn forget_before(&mut self, first: u64) {
        while self.lessons.front().is_some_and(|lesson| lesson.episode < first) {
            self.drop_oldest();
        }
        // Lessons that came in order are gone with that. Before any other one to be forgotten, behind what is newer, lies
        // one that is late and no newer than it.
        if self.late.is_some_and(|late| late < first) {
            let lessons = std::mem::take(&mut self.lessons);
            self.ends.clear();
            self.late = None;
            lessons.into_iter().filter(|lesson| lesson.episode >= first).for_each(|kept| self.append(kept));
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
        &'a self,
        all: &'a Experience<O, A>,
        n: usize,
        rng: &mut Rng,
        clips: &mut Vec<Clip<'a, O, A, G>>,
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
            clips.push(self.clip(lesson, lesson.steps.start + (at - before) as u32, all));
        }
    }

    /// The clip of a lesson that begins with `step`, with the rewards and the end that its aim gives it.
    fn clip<'a, O, A>(
        &self,
        lesson: &'a Lesson<G>,
        step: u32,
        all: &'a Experience<O, A>,
    ) -> Clip<'a, O, A, G> {
        let episode = all.episode(lesson.episode).expect("lessons are forgotten with their episodes");
        let end = lesson.steps.end.min(step + self.span);
        let last = end == lesson.steps.end;
        let (from, to) = (step as usize, end as usize);
        let terminated = to == episode.actions.len() && episode.end == Some(End::Terminated);
        let attained = last && lesson.aim == Aim::Subgoal { attained: true };
        let rewards = match (&lesson.rewards, lesson.aim) {
            (Some(dense), _) => {
                let start = lesson.steps.start as usize;
                Rewards::Given(&dense[from - start..to - start])
            }
            (None, Aim::Task) => Rewards::Given(&episode.rewards[from..to]),
            (None, Aim::Subgoal { .. }) => Rewards::Subgoal(self.pay, attained),
        };
        Clip {
            observations: &episode.observations[from..=to],
            actions: &episode.actions[from..to],
            rewards,
            goal: lesson.goal.as_ref(),
            // A task that terminates elsewhere ends a lesson about a subgoal too, and for good: nobody goes on
            // from there.
            terminal: attained || terminated || (self.closing && last),
        }
    }
}

#[cfg(test)]
mod tests;
