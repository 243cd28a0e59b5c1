//! What is learned from again: a ring of lessons, drawn uniformly or by how much there is still to learn.

mod priority;
mod sum_tree;

pub use priority::PriorityConfig;
pub(crate) use sum_tree::SumTree;

use std::collections::VecDeque;

use inroads_envs::{End, Rng};
use rand::RngExt;
use serde::{Deserialize, Serialize};

use self::priority::Priorities;
use crate::{
    Experience,
    experience::{Aim, Clip, Lesson, Pay, Rewards},
};

/// Which steps of a lesson make a clip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Cut {
    /// Steps a clip, fewer at the end of a lesson.
    span: u32,
    /// Clips begin at every so many steps of an episode.
    period: u32,
    /// Steps before, where there are any, that only bring a memory up to date.
    burn_in: u32,
    /// Whether they go on from what whoever acted remembered.
    remembered: bool,
}

impl Cut {
    /// How many clips begin in these steps: one in each period that they touch.
    fn clips(self, steps: &std::ops::Range<u32>) -> u64 {
        u64::from(steps.end.div_ceil(self.period) - steps.start / self.period)
    }

    /// The first step of clip number `i` of these steps.
    fn start(self, steps: &std::ops::Range<u32>, i: u64) -> u32 {
        steps.start.max((steps.start / self.period + i as u32) * self.period)
    }

    /// Where the memory was noted that a clip which begins at this step goes on from.
    fn noted(self, start: u32) -> u32 {
        start.saturating_sub(self.burn_in) / self.period * self.period
    }
}

/// A ring of lessons, sampled over their steps.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Replay<G = ()> {
    lessons: VecDeque<Lesson<G>>,
    /// `ends[i]` is the number of clips ever stored up to and with `lessons[i]`.
    ends: VecDeque<u64>,
    /// Clips ever stored before `lessons[0]`.
    dropped: u64,
    /// The least episode of lessons that came behind one of a newer episode (hindsight about the past); none where all
    /// came in order.
    late: Option<u64>,
    /// Steps.
    capacity: u64,
    /// What subgoals pay.
    pay: Pay,
    cut: Cut,
    /// Whether a lesson that ends without its subgoal ends for good.
    closing: bool,
    priorities: Option<Priorities>,
}

impl<G> Replay<G> {
    /// Keeps about `capacity` steps, and gives clips of one, all with the same probability, whose subgoals cost a step
    /// each.
    pub fn new(capacity: usize) -> Self {
        Self {
            lessons: VecDeque::new(),
            ends: VecDeque::new(),
            dropped: 0,
            late: None,
            capacity: capacity as u64,
            pay: Pay::COST,
            cut: Cut { span: 1, period: 1, burn_in: 0, remembered: false },
            closing: false,
            priorities: None,
        }
    }

    /// The same with other rewards of subgoals.
    pub fn paying(self, pay: Pay) -> Self {
        Self { pay, ..self }
    }

    /// What subgoals pay.
    pub fn pay(&self) -> Pay {
        self.pay
    }

    /// The same with clips of up to `steps` steps, for n-step returns; at least 1.
    pub fn spanning(self, steps: u32) -> Self {
        Self { cut: Cut { span: steps.max(1), ..self.cut }, ..self }
    }

    /// The same with sequences for learners that remember: of up to `steps` steps, one beginning every `period` steps of
    /// an episode, led in by up to `burn_in` steps before (R2D2, Kapturowski 2019, section 2.3).
    ///
    /// Who acts notes what it remembers wherever [`notes_at`](Self::notes_at) says, and a sequence starts from that; one
    /// that begins between two such steps is led in from the one before.
    pub fn sequences(self, steps: u32, period: u32, burn_in: u32) -> Self {
        let cut = Cut { span: steps.max(1), period: period.max(1), burn_in, remembered: true };
        Self { cut, ..self }
    }

    /// Whether clips begin at this step of an episode.
    pub fn begins_at(&self, step: u32) -> bool {
        step.is_multiple_of(self.cut.period)
    }

    /// Whether somebody who acts must note what it remembers before it sees this observation of an episode
    /// ([`Experience::note`]): where a sequence begins.
    pub fn notes_at(&self, step: u32) -> bool {
        self.cut.remembered && self.begins_at(step)
    }

    /// The same where a lesson that ends without its subgoal ends for good: nothing follows. For probabilities of
    /// success within a horizon, where γ is 1 (thesis 5.1.1; `decisions.md`); a learner of policies bootstraps there.
    pub fn closing(self) -> Self {
        Self { closing: true, ..self }
    }

    /// The same drawn by priority: by how wrong the learner was about each clip when it last saw it.
    pub fn prioritised(self, config: PriorityConfig) -> Self {
        Self { priorities: Some(Priorities::new(config)), ..self }
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
        let (first, end) = (self.total(), self.total() + self.cut.clips(&lesson.steps));
        self.lessons.push_back(lesson);
        self.ends.push_back(end);
        if let Some(priorities) = &mut self.priorities {
            priorities.enter(self.dropped, first..end);
        }
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
            let mut clips = self.dropped;
            let ends = std::mem::take(&mut self.ends);
            self.late = None;
            let total = ends.back().copied().unwrap_or(self.dropped);
            let old = self.priorities.as_ref().map(|priorities| priorities.of(self.dropped..total));
            let mut kept = Vec::new();
            for (lesson, end) in lessons.into_iter().zip(ends) {
                let numbers = std::mem::replace(&mut clips, end)..end;
                if lesson.episode >= first {
                    if let Some(old) = &old {
                        kept.extend(numbers.map(|number| old[(number - self.dropped) as usize]));
                    }
                    self.append(lesson);
                }
            }
            let all = self.dropped..total;
            if let Some(priorities) = &mut self.priorities {
                priorities.replace(all, &kept);
            }
        }
    }

    fn drop_oldest(&mut self) {
        self.lessons.pop_front();
        let gone = self.dropped..self.ends.pop_front().unwrap_or(self.dropped);
        self.dropped = gone.end;
        if let Some(priorities) = &mut self.priorities {
            priorities.leave(gone);
        }
    }

    fn total(&self) -> u64 {
        self.ends.back().copied().unwrap_or(self.dropped)
    }

    /// Number of steps to draw from; of sequences, as many as their beginnings are apart.
    pub fn len(&self) -> usize {
        ((self.total() - self.dropped) * u64::from(self.cut.period)) as usize
    }

    /// Whether there is nothing to draw.
    pub fn is_empty(&self) -> bool {
        self.total() == self.dropped
    }

    /// Draws `n` clips with replacement into `clips`; their numbers. Nothing is drawn from an empty ring.
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
    ) -> Vec<u64> {
        clips.clear();
        if self.is_empty() {
            return Vec::new();
        }
        let live = self.dropped..self.total();
        let (numbers, weights) = match &self.priorities {
            None => ((0..n).map(|_| rng.random_range(live.clone())).collect(), Vec::new()),
            Some(priorities) => priorities.draw(live, n, rng),
        };
        for (i, &number) in numbers.iter().enumerate() {
            let index = self.ends.partition_point(|&end| end <= number);
            let lesson = &self.lessons[index];
            let before = if index == 0 { self.dropped } else { self.ends[index - 1] };
            let clip = self.clip(lesson, self.cut.start(&lesson.steps, number - before), all);
            clips.push(Clip { weight: weights.get(i).copied().unwrap_or(1.0), ..clip });
        }
        numbers
    }

    /// Says how wrong the learner was about clips that were drawn, which is their priority from now on. It matters only
    /// where there are priorities, and whoever has left since is passed over.
    pub fn revise(&mut self, numbers: &[u64], errors: &[f32]) {
        let live = self.dropped..self.total();
        if let Some(priorities) = &mut self.priorities {
            priorities.revise(live, numbers, errors);
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
        // A step of the task goes on into those that came after it, whoever told of them.
        let over = match (lesson.aim, &lesson.rewards) {
            (Aim::Task, None) => episode.actions.len() as u32,
            _ => lesson.steps.end,
        };
        let end = over.min(step.saturating_add(self.cut.span));
        let noted = self.cut.noted(step);
        let (begin, from, to) = (noted as usize, step as usize, end as usize);
        let terminated = to == episode.actions.len() && episode.end == Some(End::Terminated);
        let attained = end == lesson.steps.end && lesson.aim == Aim::Subgoal { attained: true };
        let rewards = match (&lesson.rewards, lesson.aim) {
            (Some(dense), _) => {
                let start = lesson.steps.start as usize;
                Rewards::Given(&dense[from - start..to - start])
            }
            (None, Aim::Task) => Rewards::Given(&episode.rewards[from..to]),
            (None, Aim::Subgoal { .. }) => Rewards::Subgoal(self.pay, attained),
        };
        Clip {
            observations: &episode.observations[begin..=to],
            actions: &episode.actions[begin..to],
            rewards,
            goal: lesson.goal.as_ref(),
            // A task that terminates elsewhere ends a lesson about a subgoal too, and for good: nobody goes on
            // from there.
            terminal: attained || terminated || (self.closing && end == lesson.steps.end),
            at: (lesson.episode, noted),
            previous: begin.checked_sub(1).map(|before| &episode.actions[before]),
            memory: episode.memories.get(&noted).map_or(&[], Vec::as_slice),
            lead: from - begin,
            weight: 1.0,
        }
    }
}

#[cfg(test)]
mod tests;
