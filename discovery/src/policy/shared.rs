//! One goal-conditioned policy for all skills (4.1.2, 7.2.2.5): each reads its own subgoal.

use inroads_agents::{Clip, Context, Experience, Learner, Lesson, Memory, Pace, Replay, checkpoint};
use serde::{Serialize, de::DeserializeOwned};

use super::SkillPolicy;
use crate::{Call, SkillId};

/// One learner for all skills, which tells them apart by their goals.
pub struct Shared<L, G> {
    learner: L,
    replay: Replay<G>,
    pace: Pace,
    steps: u64,
    updates: u64,
}

checkpoint!(
    [L, G] Shared<L, G>;
    plain: replay, steps, updates;
    parts: learner;
    where L: inroads_agents::Checkpoint, G: Serialize + DeserializeOwned
);

impl<L, G> Shared<L, G> {
    /// A family that learns from what `replay` draws, which is empty.
    pub fn new(learner: L, replay: Replay<G>, pace: Pace) -> Self {
        Self { learner, replay, pace, steps: 0, updates: 0 }
    }

    /// What learns.
    pub fn learner(&self) -> &L {
        &self.learner
    }
}

impl<O, A, G, L> SkillPolicy<O, A, G> for Shared<L, G>
where
    L: Learner<O, A, G>,
    G: Serialize + DeserializeOwned,
{
    fn born(&mut self, _: SkillId) {}

    fn act(&self, memory: &mut Memory, call: &Call<G>, s: &O, ctx: &mut Context) -> A {
        self.learner.act(memory, s, call.goal.as_ref(), ctx)
    }

    fn values(&self, memory: &Memory, s: &O, calls: &[(SkillId, Option<&G>)]) -> Vec<f32> {
        let goals: Vec<_> = calls.iter().map(|(_, goal)| *goal).collect();
        self.learner.values(memory, s, &goals)
    }

    fn lesson(&mut self, _: SkillId, lesson: Lesson<G>) {
        self.replay.push(lesson);
    }

    fn practise(&mut self, _: SkillId, updates: u64, all: &Experience<O, A>, ctx: &mut Context) {
        self.replay.forget_before(all.first());
        let batch = self.learner.batch();
        if updates == 0 || self.replay.len() < batch {
            return;
        }
        let mut clips: Vec<Clip<O, A, G>> = Vec::with_capacity(batch);
        for _ in 0..updates {
            self.replay.sample(all, batch, &mut ctx.learning, &mut clips);
            self.learner.learn(&clips, ctx);
            self.updates += 1;
        }
    }

    fn step(&mut self, k: SkillId, all: &Experience<O, A>, ctx: &mut Context) {
        self.steps += 1;
        if self.replay.len() >= self.pace.warm_up {
            self.practise(k, self.pace.due(self.steps), all, ctx);
        }
    }

    fn updates(&self) -> u64 {
        self.updates
    }
}
