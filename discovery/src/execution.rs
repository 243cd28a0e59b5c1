//! Option execution, in one place.
//!
//! A skill is called, acts until it reaches its subgoal, the episode ends or its budget is spent, and hands
//! back. A running call is a value, not a call stack: so truncation is caught once, a page can pause between
//! two steps, and nothing of it is ever saved (checkpoints are taken between episodes).

use inroads_agents::{Actor, Agent, Bag, Checkpoint, Context, Corrupt, Experience, Transition};
use inroads_envs::End;
use serde::{Serialize, de::DeserializeOwned};
use std::ops::Range;

use crate::SkillId;

/// A skill is asked to act for at most `budget` steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Call {
    /// Who acts.
    pub skill: SkillId,
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
pub struct Outcome {
    /// The call.
    pub call: Call,
    /// The episode's number.
    pub episode: u64,
    /// The steps it took.
    pub steps: Range<u32>,
    /// Why it handed back.
    pub stop: Stop,
    /// Whether and how the episode ended with it.
    pub end: Option<End>,
}

/// Σ γᵗ r over some steps, and γ to their number: the two coefficients of equation 3.3, whose exponent counts the
/// steps taken (`decisions.md`).
pub fn discounted(rewards: &[f32], gamma: f32) -> (f32, f32) {
    rewards.iter().fold((0.0, 1.0), |(sum, discount), r| (sum + discount * r, discount * gamma))
}

/// What differs between the systems of the thesis: which skill to call, and what to learn from what happened.
///
/// Deciding and acting borrow the method; only finishing and learning change it. What lasts one episode of one
/// actor is in the lane, so an evaluation cannot change a method.
pub trait Discovery<O, A>: Checkpoint {
    /// State of one episode of one actor. Never saved.
    type Lane: Default;

    /// Which skill to call at `s`.
    fn decide(&self, lane: &mut Self::Lane, s: &O, ctx: &mut Context) -> Call;

    /// The called skill's action at `s`.
    fn act(&self, lane: &mut Self::Lane, call: Call, s: &O, ctx: &mut Context) -> A;

    /// Whether this step reached the called skill's subgoal.
    fn reached(&self, call: Call, t: &Transition<O, A>) -> bool;

    /// A call is over; its steps are in the experience already.
    fn finished(&mut self, out: &Outcome, all: &Experience<O, A>, ctx: &mut Context);

    /// One step of the environment has passed while `call` ran.
    fn learn(&mut self, call: Call, all: &Experience<O, A>, ctx: &mut Context);

    /// Learning steps made so far, by name of the network.
    fn updates(&self) -> Vec<(&'static str, u64)>;
}

/// The running call of one actor.
struct Execution<L> {
    lane: L,
    /// The call and the steps that it has taken.
    running: Option<(Call, u32)>,
    /// Whoever chose the last action, for pictures.
    last: SkillId,
}

impl<L> Execution<L> {
    fn new(lane: L) -> Self {
        Self { lane, running: None, last: SkillId::GLOBAL }
    }

    /// The action at `s`, after a decision if no call is running.
    fn act<O, A, D: Discovery<O, A, Lane = L>>(&mut self, method: &D, s: &O, ctx: &mut Context) -> A {
        let (call, _) = *self.running.get_or_insert_with(|| (method.decide(&mut self.lane, s, ctx), 0));
        self.last = call.skill;
        method.act(&mut self.lane, call, s, ctx)
    }

    /// Counts the step: the call, the steps it has taken, and why it ended with this one, if it did.
    ///
    /// The order matters: reaching the subgoal at the last moment counts as reaching it.
    fn advance<O, A, D: Discovery<O, A, Lane = L>>(
        &mut self,
        method: &D,
        t: &Transition<O, A>,
    ) -> (Call, u32, Option<Stop>) {
        let (call, before) = self.running.expect("act comes before observe");
        let steps = before + 1;
        let stop = if method.reached(call, t) {
            Some(Stop::Reached)
        } else if t.end.is_some() {
            Some(Stop::CutShort)
        } else {
            (steps >= call.budget).then_some(Stop::TimedOut)
        };
        self.running = stop.is_none().then_some((call, steps));
        (call, steps, stop)
    }
}

/// A discovery method as an agent.
pub struct Hierarchy<O, A, D: Discovery<O, A>> {
    method: D,
    experience: Experience<O, A>,
    execution: Execution<D::Lane>,
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

    /// The method watched without learning, from a lane of the caller's.
    pub fn watch(&self, lane: D::Lane) -> Box<dyn Actor<O, A> + '_> {
        Box::new(Watched { method: &self.method, execution: Execution::new(lane) })
    }
}

impl<O: Clone, A: Clone, D: Discovery<O, A>> Actor<O, A> for Hierarchy<O, A, D> {
    fn begin(&mut self, s: &O, _: &mut Context) {
        self.experience.begin(s);
        self.execution = Execution::new(D::Lane::default());
    }

    fn act(&mut self, s: &O, ctx: &mut Context) -> A {
        self.execution.act(&self.method, s, ctx)
    }

    fn observe(&mut self, t: &Transition<O, A>, ctx: &mut Context) {
        self.experience.push(t);
        let (call, steps, stop) = self.execution.advance(&self.method, t);
        if let Some(stop) = stop {
            let episode = self.experience.latest();
            let until = self.experience.length(episode);
            let outcome = Outcome { call, episode, steps: until - steps..until, stop, end: t.end };
            self.method.finished(&outcome, &self.experience, ctx);
        }
        self.method.learn(call, &self.experience, ctx);
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
struct Watched<'a, D, L> {
    method: &'a D,
    execution: Execution<L>,
}

impl<O, A, D: Discovery<O, A>> Actor<O, A> for Watched<'_, D, D::Lane> {
    fn begin(&mut self, _: &O, _: &mut Context) {
        self.execution.running = None;
    }

    fn act(&mut self, s: &O, ctx: &mut Context) -> A {
        self.execution.act(self.method, s, ctx)
    }

    fn observe(&mut self, t: &Transition<O, A>, _: &mut Context) {
        self.execution.advance(self.method, t);
    }

    fn source(&self) -> usize {
        self.execution.last.index()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equation_3_3_discounts_by_the_steps_taken() {
        let (reward, discount) = discounted(&[-1.0, -1.0, -1.0], 0.9);
        assert!((reward + discount * -5.0 - -6.355).abs() < 1e-6);
        assert_eq!(discounted(&[], 0.9), (0.0, 1.0));
    }
}
