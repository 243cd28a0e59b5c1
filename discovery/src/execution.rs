//! Option execution, in one place.
//!
//! A skill is called, acts until it reaches its subgoal, the episode ends or its budget is spent, and hands
//! back. A running call is a value, not a call stack: so truncation is caught once, a page can pause between
//! two steps, and nothing of it is ever saved (checkpoints are taken between episodes).

use inroads_agents::{Actor, Agent, Bag, Checkpoint, Context, Corrupt, Experience, Memory, Transition};
use inroads_envs::End;
use serde::{Serialize, de::DeserializeOwned};
use std::ops::Range;

use crate::SkillId;

/// A skill is asked to act for at most `budget` steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Call<G> {
    /// Who acts.
    pub skill: SkillId,
    /// What for, where one policy serves many goals.
    pub goal: Option<G>,
    /// Steps after which it must hand back; at least 1.
    pub budget: u32,
}

/// Why a skill handed back. Not to be confused with [`End`]: an episode may end while a skill runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// Its subgoal is reached (also when that was the episode's last step).
    Reached,
    /// Its budget is spent.
    TimedOut,
    /// The episode ended first.
    CutShort,
}

/// What a call came to: a range of the experience, so no trajectory is collected on the side.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome<G> {
    /// The call.
    pub call: Call<G>,
    /// The episode's number.
    pub episode: u64,
    /// The steps it took.
    pub steps: Range<u32>,
    /// Why it handed back.
    pub stop: Stop,
    /// Whether and how the episode ended with it.
    pub end: Option<End>,
}

/// What differs between the systems of the thesis: which skill to call, and what to learn from what happened.
///
/// Deciding and acting borrow the method; only finishing and learning change it. What lasts one episode of one
/// actor is in the lane, so an evaluation cannot change a method.
pub trait Discovery<O, A>: Checkpoint {
    /// What its skills can be called for; `()` where each has but one subgoal.
    type Goal: Clone;

    /// State of one episode of one actor. Never saved.
    type Lane: Default;

    /// Which skill to call at `s`, given all that is remembered.
    fn decide(
        &self,
        lane: &mut Self::Lane,
        s: &O,
        all: &Experience<O, A>,
        ctx: &mut Context,
    ) -> Call<Self::Goal>;

    /// The called skill's action at `s`.
    fn act(&self, lane: &mut Self::Lane, call: &Call<Self::Goal>, s: &O, ctx: &mut Context) -> A;

    /// Whether this step reached the called skill's subgoal.
    fn reached(&self, call: &Call<Self::Goal>, t: &Transition<O, A>) -> bool;

    /// One step of the environment has passed, and is the newest of the experience. Comes before [`finished`]: what a
    /// method counts, it has counted when it is to judge what a call came to.
    ///
    /// [`finished`]: Self::finished
    fn seen(&mut self, all: &Experience<O, A>, ctx: &mut Context) {
        let _ = (all, ctx);
    }

    /// A call is over; its steps are in the experience already. `lane` is the actor's as it was when it ended.
    fn finished(
        &mut self,
        lane: &mut Self::Lane,
        out: &Outcome<Self::Goal>,
        all: &Experience<O, A>,
        ctx: &mut Context,
    );

    /// One step of the environment has passed while `call` ran; comes last.
    fn learn(&mut self, call: &Call<Self::Goal>, all: &Experience<O, A>, ctx: &mut Context);

    /// Learning steps made so far, by name of the network.
    fn updates(&self) -> Vec<(&'static str, u64)>;
}

/// Who acts, and what it remembers from step to step.
#[derive(Clone, Debug, Default)]
pub struct Driver {
    memory: Memory,
    owner: Option<SkillId>,
}

impl Driver {
    /// `skill` acts from now on: whoever acted before takes its memory with it.
    pub fn hand_to(&mut self, skill: SkillId) {
        if self.owner != Some(skill) {
            self.memory.clear();
            self.owner = Some(skill);
        }
    }

    /// Who acted last; nobody before the first.
    pub fn owner(&self) -> Option<SkillId> {
        self.owner
    }

    /// The memory of who acts.
    pub fn memory(&mut self) -> &mut Memory {
        &mut self.memory
    }
}

/// The running call of one actor.
pub(crate) struct Execution<L, G> {
    pub(crate) lane: L,
    /// The call and the steps that it has taken.
    pub(crate) running: Option<(Call<G>, u32)>,
    /// Whoever chose the last action, for pictures.
    pub(crate) last: SkillId,
}

impl<L, G: Clone> Execution<L, G> {
    pub(crate) fn new(lane: L) -> Self {
        Self { lane, running: None, last: SkillId::GLOBAL }
    }

    /// The action at `s`, after a decision if no call is running.
    pub(crate) fn act<O, A, D>(&mut self, method: &D, s: &O, all: &Experience<O, A>, ctx: &mut Context) -> A
    where
        D: Discovery<O, A, Lane = L, Goal = G>,
    {
        let (call, _) = &*self.running.get_or_insert_with(|| (method.decide(&mut self.lane, s, all, ctx), 0));
        self.last = call.skill;
        method.act(&mut self.lane, call, s, ctx)
    }

    /// Counts the step: the call, the steps it has taken, and why it ended with this one, if it did.
    ///
    /// The order matters: reaching the subgoal at the last moment counts as reaching it.
    pub(crate) fn advance<O, A, D>(
        &mut self,
        method: &D,
        t: &Transition<O, A>,
    ) -> (Call<G>, u32, Option<Stop>)
    where
        D: Discovery<O, A, Lane = L, Goal = G>,
    {
        let (call, before) = self.running.take().expect("act comes before observe");
        let steps = before + 1;
        let stop = if method.reached(&call, t) {
            Some(Stop::Reached)
        } else if t.end.is_some() {
            Some(Stop::CutShort)
        } else {
            (steps >= call.budget).then_some(Stop::TimedOut)
        };
        self.running = stop.is_none().then(|| (call.clone(), steps));
        (call, steps, stop)
    }
}

/// A discovery method as an agent.
pub struct Hierarchy<O, A, D: Discovery<O, A>> {
    method: D,
    experience: Experience<O, A>,
    execution: Execution<D::Lane, D::Goal>,
}

impl<O: Clone, A: Clone, D: Discovery<O, A>> Hierarchy<O, A, D> {
    /// An agent that remembers about `capacity` steps.
    pub fn new(method: D, capacity: usize) -> Self {
        let execution = Execution::new(D::Lane::default());
        Self { method, experience: Experience::new(capacity), execution }
    }

    /// The method.
    pub fn method(&self) -> &D {
        &self.method
    }

    /// All that is remembered.
    pub fn experience(&self) -> &Experience<O, A> {
        &self.experience
    }

    /// The method watched without learning, from a lane of the caller's.
    pub fn watch(&self, lane: D::Lane) -> Box<dyn Actor<O, A> + '_> {
        let (method, all) = (&self.method, &self.experience);
        Box::new(Watched { method, all, execution: Execution::new(lane) })
    }
}

impl<O: Clone, A: Clone, D: Discovery<O, A>> Actor<O, A> for Hierarchy<O, A, D> {
    fn begin(&mut self, s: &O, _: &mut Context) {
        self.experience.begin(s);
        self.execution = Execution::new(D::Lane::default());
    }

    fn act(&mut self, s: &O, ctx: &mut Context) -> A {
        self.execution.act(&self.method, s, &self.experience, ctx)
    }

    fn observe(&mut self, t: &Transition<O, A>, ctx: &mut Context) {
        self.experience.push(t);
        self.method.seen(&self.experience, ctx);
        let (call, steps, stop) = self.execution.advance(&self.method, t);
        if let Some(stop) = stop {
            let episode = self.experience.latest();
            let until = self.experience.length(episode);
            let outcome =
                Outcome { call: call.clone(), episode, steps: until - steps..until, stop, end: t.end };
            self.method.finished(&mut self.execution.lane, &outcome, &self.experience, ctx);
        }
        self.method.learn(&call, &self.experience, ctx);
    }

    fn source(&self) -> usize {
        self.execution.last.index()
    }
}

impl<O, A, D> Agent<O, A> for Hierarchy<O, A, D>
where
    O: Clone + Serialize + DeserializeOwned,
    A: Clone + Serialize + DeserializeOwned,
    D: Discovery<O, A>,
{
    fn frozen(&self) -> Box<dyn Actor<O, A> + '_> {
        self.watch(D::Lane::default())
    }

    fn updates(&self) -> Vec<(&'static str, u64)> {
        self.method.updates()
    }
}

impl<O, A, D> Checkpoint for Hierarchy<O, A, D>
where
    O: Clone + Serialize + DeserializeOwned,
    A: Clone + Serialize + DeserializeOwned,
    D: Discovery<O, A>,
{
    fn save(&self, bag: &mut Bag) {
        bag.put_part("method", &self.method);
        bag.put("experience", &self.experience);
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        bag.get_part("method", &mut self.method)?;
        self.experience = bag.get("experience")?;
        Ok(())
    }
}

/// A method that acts and does not learn.
struct Watched<'a, O, A, D, L, G> {
    method: &'a D,
    all: &'a Experience<O, A>,
    execution: Execution<L, G>,
}

impl<O, A, D: Discovery<O, A>> Actor<O, A> for Watched<'_, O, A, D, D::Lane, D::Goal> {
    fn begin(&mut self, _: &O, _: &mut Context) {
        self.execution.running = None;
    }

    fn act(&mut self, s: &O, ctx: &mut Context) -> A {
        self.execution.act(self.method, s, self.all, ctx)
    }

    fn observe(&mut self, t: &Transition<O, A>, _: &mut Context) {
        self.execution.advance(self.method, t);
    }

    fn source(&self) -> usize {
        self.execution.last.index()
    }
}
