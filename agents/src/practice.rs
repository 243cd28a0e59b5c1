//! Learning from what is remembered, in step with what is lived: a replay and its pace.

use serde::{Deserialize, Serialize};

use crate::{Clip, Context, Experience, Learned, Lesson, Pace, Replay};

/// What one learner learns from, and how often: the loop between a [`Replay`] and whoever learns of its clips.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Practice<G = ()> {
    replay: Replay<G>,
    pace: Pace,
    steps: u64,
    updates: u64,
}

impl<G> Practice<G> {
    /// Practice on what an empty replay will hold.
    pub fn new(replay: Replay<G>, pace: Pace) -> Self {
        Self { replay, pace, steps: 0, updates: 0 }
    }

    /// What there is to draw from.
    pub fn replay(&self) -> &Replay<G> {
        &self.replay
    }

    /// Minibatch updates made so far.
    pub fn updates(&self) -> u64 {
        self.updates
    }

    /// Adds a lesson.
    pub fn push(&mut self, lesson: Lesson<G>) {
        self.replay.push(lesson);
    }

    /// A step of the environment has passed: makes the updates that are due, none before the warm-up is over. `learn`
    /// makes one on some clips.
    pub fn step<O, A>(
        &mut self,
        batch: usize,
        all: &Experience<O, A>,
        ctx: &mut Context,
        learn: impl FnMut(&[Clip<O, A, G>], &mut Context) -> Learned,
    ) {
        self.steps += 1;
        if self.replay.len() >= self.pace.warm_up {
            self.practise(self.pace.due(self.steps), batch, all, ctx, learn);
        }
    }

    /// Makes so many updates, as soon as there are as many steps to draw from as a batch has clips. None after one whose
    /// loss is no finite number, which ends the episode ([`Context::check`]).
    pub fn practise<O, A>(
        &mut self,
        updates: u64,
        batch: usize,
        all: &Experience<O, A>,
        ctx: &mut Context,
        mut learn: impl FnMut(&[Clip<O, A, G>], &mut Context) -> Learned,
    ) {
        self.replay.forget_before(all.first());
        if updates == 0 || self.replay.len() < batch {
            return;
        }
        for _ in 0..updates {
            if ctx.fault.is_some() {
                return;
            }
            let mut clips = Vec::with_capacity(batch);
            let numbers = self.replay.sample(all, batch, &mut ctx.learning, &mut clips);
            let learned = learn(&clips, ctx);
            ctx.check("loss", learned.loss);
            learned.errors.iter().for_each(|error| ctx.check("error of a clip", *error));
            if ctx.fault.is_some() {
                return;
            }
            self.replay.revise(&numbers, &learned.errors);
            self.updates += 1;
        }
    }
}
