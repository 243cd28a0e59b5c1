//! One goal-conditioned policy for all skills (4.1.2, 7.2.2.5): each reads its own subgoal.

use inroads_agents::{Context, Experience, Learner, Lesson, Memory, Practice, checkpoint};
use serde::{Serialize, de::DeserializeOwned};

use super::SkillPolicy;
use crate::{Call, SkillId};

/// One learner for all skills, which tells them apart by their goals.
pub struct Shared<L, G> {
    learner: L,
    practice: Practice<G>,
}

checkpoint!(
    [L, G] Shared<L, G>;
    plain: practice;
    parts: learner;
    where L: inroads_agents::Checkpoint, G: Serialize + DeserializeOwned
);

impl<L, G> Shared<L, G> {
    /// A family that learns by this practice.
    pub fn new(learner: L, practice: Practice<G>) -> Self {
        Self { learner, practice }
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
        self.practice.push(lesson);
    }

    fn practise(&mut self, _: SkillId, updates: u64, all: &Experience<O, A>, ctx: &mut Context) {
        let Self { learner, practice } = self;
        practice.practise(updates, learner.batch(), all, ctx, |clips, ctx| learner.learn(clips, ctx));
    }

    fn step(&mut self, _: SkillId, all: &Experience<O, A>, ctx: &mut Context) {
        let Self { learner, practice } = self;
        practice.step(learner.batch(), all, ctx, |clips, ctx| learner.learn(clips, ctx));
    }

    fn updates(&self) -> u64 {
        self.practice.updates()
    }
}
