//! A learner alone as an agent: every flat baseline.

use crate::{
    Actor, Agent, Bag, Checkpoint, Clip, Context, Corrupt, Experience, Learner, Lesson, Memory, Pace, Replay,
    Transition, experience::Aim,
};
use serde::{Serialize, de::DeserializeOwned};

/// A learner that acts on its own, on the task's reward.
pub struct Flat<O, A, L> {
    learner: L,
    experience: Experience<O, A>,
    replay: Replay,
    pace: Pace,
    steps: u64,
    updates: u64,
    memory: Memory,
}

impl<O: Clone, A: Clone, L: Learner<O, A>> Flat<O, A, L> {
    /// An agent that remembers about `capacity` steps.
    pub fn new(learner: L, capacity: usize, pace: Pace) -> Self {
        Self {
            learner,
            experience: Experience::new(capacity),
            replay: Replay::new(capacity),
            pace,
            steps: 0,
            updates: 0,
            memory: Memory::new(),
        }
    }
}

impl<O: Clone, A: Clone, L: Learner<O, A>> Actor<O, A> for Flat<O, A, L> {
    fn begin(&mut self, s: &O, _: &mut Context) {
        self.memory.clear();
        self.experience.begin(s);
        self.replay.forget_before(self.experience.first());
    }

    fn act(&mut self, s: &O, ctx: &mut Context) -> A {
        self.learner.act(&mut self.memory, s, ctx)
    }

    fn observe(&mut self, t: &Transition<O, A>, ctx: &mut Context) {
        self.experience.push(t);
        let episode = self.experience.latest();
        let steps = self.experience.length(episode);
        self.replay.push(Lesson { episode, steps: steps - 1..steps, aim: Aim::Task, rewards: None });
        self.steps += 1;
        if self.replay.len() < self.pace.warm_up.max(self.learner.batch()) {
            return;
        }
        let mut clips: Vec<Clip<O, A>> = Vec::with_capacity(self.learner.batch());
        for _ in 0..self.pace.due(self.steps) {
            self.replay.sample(&self.experience, self.learner.batch(), &mut ctx.learning, &mut clips);
            self.learner.learn(&clips, ctx);
            self.updates += 1;
        }
    }
}

impl<O, A, L> Agent<O, A> for Flat<O, A, L>
where
    O: Clone + Serialize + DeserializeOwned,
    A: Clone + Serialize + DeserializeOwned,
    L: Learner<O, A>,
{
    fn frozen(&self) -> Box<dyn Actor<O, A> + '_> {
        Box::new(Greedy { learner: &self.learner, memory: Memory::new() })
    }

    fn updates(&self) -> Vec<(&'static str, u64)> {
        vec![("policy", self.updates)]
    }
}

impl<O, A, L> Checkpoint for Flat<O, A, L>
where
    O: Clone + Serialize + DeserializeOwned,
    A: Clone + Serialize + DeserializeOwned,
    L: Learner<O, A>,
{
    fn save(&self, bag: &mut Bag) {
        bag.put_part("learner", &self.learner);
        bag.put("experience", &self.experience);
        bag.put("replay", &self.replay);
        bag.put("counts", &(self.steps, self.updates));
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        bag.get_part("learner", &mut self.learner)?;
        self.experience = bag.get("experience")?;
        self.replay = bag.get("replay")?;
        (self.steps, self.updates) = bag.get("counts")?;
        Ok(())
    }
}

/// A learner watched without learning.
struct Greedy<'a, L> {
    learner: &'a L,
    memory: Memory,
}

impl<O, A, L: Learner<O, A>> Actor<O, A> for Greedy<'_, L> {
    fn begin(&mut self, _: &O, _: &mut Context) {
        self.memory.clear();
    }

    fn act(&mut self, s: &O, ctx: &mut Context) -> A {
        self.learner.act(&mut self.memory, s, ctx)
    }

    fn observe(&mut self, _: &Transition<O, A>, _: &mut Context) {}
}
