//! A learner alone as an agent: every flat baseline.

use crate::{
    Actor, Agent, Bag, Checkpoint, Context, Corrupt, Curious, Experience, Learner, Memory, Transition,
};
use serde::{Serialize, de::DeserializeOwned};

/// A learner that acts on its own, on the task's reward, and a bonus for what is new if it is given one.
pub struct Flat<O, A, L> {
    curious: Curious<O, L>,
    experience: Experience<O, A>,
    memory: Memory,
}

impl<O: Clone, A: Clone, L: Learner<O, A, ()>> Flat<O, A, L> {
    /// An agent that remembers about `capacity` steps.
    pub fn new(curious: Curious<O, L>, capacity: usize) -> Self {
        Self { curious, experience: Experience::new(capacity), memory: Memory::new() }
    }
}

impl<O: Clone, A: Clone, L: Learner<O, A, ()>> Actor<O, A> for Flat<O, A, L> {
    fn begin(&mut self, s: &O, _: &mut Context) {
        self.memory.clear();
        self.experience.begin(s);
    }

    fn act(&mut self, s: &O, ctx: &mut Context) -> A {
        let number = self.experience.latest();
        if self.curious.begins_at(self.experience.length(number)) {
            self.experience.note(number, &self.memory);
        }
        self.curious.act(&mut self.memory, s, ctx)
    }

    fn observe(&mut self, t: &Transition<O, A>, ctx: &mut Context) {
        self.experience.push(t);
        self.curious.step(self.experience.latest(), &self.experience, ctx);
    }
}

impl<O, A, L> Agent<O, A> for Flat<O, A, L>
where
    O: Clone + Serialize + DeserializeOwned,
    A: Clone + Serialize + DeserializeOwned,
    L: Learner<O, A, ()>,
{
    fn frozen(&self) -> Box<dyn Actor<O, A> + '_> {
        Box::new(Greedy::<_, ()>::new(self.curious.learner(false), None))
    }

    fn updates(&self) -> Vec<(&'static str, u64)> {
        vec![("policy", self.curious.updates())]
    }
}

impl<O, A, L> Checkpoint for Flat<O, A, L>
where
    O: Clone + Serialize + DeserializeOwned,
    A: Clone + Serialize + DeserializeOwned,
    L: Learner<O, A, ()>,
{
    fn save(&self, bag: &mut Bag) {
        bag.put_part("curious", &self.curious);
        bag.put("experience", &self.experience);
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        bag.get_part("curious", &mut self.curious)?;
        self.experience = bag.get("experience")?;
        Ok(())
    }
}

/// A learner watched without learning.
pub(crate) struct Greedy<'a, L, G> {
    learner: &'a L,
    goal: Option<&'a G>,
    memory: Memory,
}

impl<'a, L, G> Greedy<'a, L, G> {
    /// On the way to a goal; none for the task.
    pub(crate) fn new(learner: &'a L, goal: Option<&'a G>) -> Self {
        Self { learner, goal, memory: Memory::new() }
    }
}

impl<O, A, G, L: Learner<O, A, G>> Actor<O, A> for Greedy<'_, L, G> {
    fn begin(&mut self, _: &O, _: &mut Context) {
        self.memory.clear();
    }

    fn act(&mut self, s: &O, ctx: &mut Context) -> A {
        self.learner.act(&mut self.memory, s, self.goal, ctx)
    }

    fn observe(&mut self, _: &Transition<O, A>, _: &mut Context) {}
}
