//! A learner alone as an agent: every flat baseline.

use std::slice;

use serde::{Serialize, de::DeserializeOwned};

use crate::{
    Actor, Agent, Bag, Checkpoint, Context, Corrupt, Crowd, Curious, Experience, Lane, Learner, Memory,
    Transition,
};

/// A learner that acts on its own, on the task's reward, and a bonus for what is new if it is given one.
pub struct Flat<O, A, L> {
    curious: Curious<O, L>,
    experience: Experience<O, A>,
    /// The episodes that go on, by lane: their numbers, and what is remembered in them.
    lanes: Vec<(u64, Memory)>,
}

impl<O: Clone, A: Clone, L: Learner<O, A, ()>> Flat<O, A, L> {
    /// An agent that remembers about `capacity` steps.
    pub fn new(curious: Curious<O, L>, capacity: usize) -> Self {
        Self { curious, experience: Experience::new(capacity), lanes: Vec::new() }
    }
}

impl<O: Clone, A: Clone, L: Learner<O, A, ()>> Crowd<O, A> for Flat<O, A, L> {
    fn begin_lane(&mut self, lane: usize, s: &O, _: &mut Context) {
        self.lanes.truncate(lane);
        self.lanes.push((self.experience.begin(s), Memory::new()));
    }

    fn act_lanes(&mut self, running: &[usize], s: &[O], ctxs: &mut [Context], actions: &mut Vec<A>) {
        for (number, memory) in running.iter().map(|&lane| &self.lanes[lane]) {
            if self.curious.notes_at(self.experience.length(*number)) {
                self.experience.note(*number, memory);
            }
        }
        let all = self.lanes.iter_mut().zip(s).zip(ctxs).enumerate();
        let runs = all.filter(|(lane, _)| running.contains(lane));
        let acting = runs.map(|(_, (((_, memory), s), ctx))| Lane { memory, s, goal: None, ctx });
        actions.extend(self.curious.act_all(&mut acting.collect::<Vec<_>>()));
    }

    fn observe_lane(&mut self, lane: usize, t: &Transition<O, A>, ctx: &mut Context) {
        let (number, _) = self.lanes[lane];
        self.experience.push_to(number, t);
        self.curious.step(number, &self.experience, ctx);
    }
}

/// One episode at a time is a crowd of one.
impl<O: Clone, A: Clone, L: Learner<O, A, ()>> Actor<O, A> for Flat<O, A, L> {
    fn begin(&mut self, s: &O, ctx: &mut Context) {
        self.begin_lane(0, s, ctx);
    }

    fn act(&mut self, s: &O, ctx: &mut Context) -> A {
        let mut actions = Vec::with_capacity(1);
        self.act_lanes(&[0], slice::from_ref(s), slice::from_mut(ctx), &mut actions);
        actions.pop().expect("an action a lane")
    }

    fn observe(&mut self, t: &Transition<O, A>, ctx: &mut Context) {
        self.observe_lane(0, t, ctx);
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

    fn crowd(&mut self) -> Option<&mut dyn Crowd<O, A>> {
        Some(self)
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
