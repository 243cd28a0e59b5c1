//! A controller that somebody has written, in the place of a learned policy.
//!
//! What is studied is then the graph alone. Chapter 6 plays the same part with a learned model and a planner over it
//! (equation 6.6).

use inroads_agents::{Bag, Checkpoint, Context, Corrupt, Experience, Lesson, Memory};

use super::SkillPolicy;
use crate::{Call, SkillId};

/// One function for all skills, from what is seen and the goal to the action. It learns nothing.
pub struct Given<F> {
    act: F,
}

impl<F> Given<F> {
    /// The family of that function.
    pub fn new(act: F) -> Self {
        Self { act }
    }
}

impl<O, A, G, F: Fn(&O, &G) -> A> SkillPolicy<O, A, G> for Given<F> {
    fn born(&mut self, _: SkillId) {}

    /// # Panics
    /// When the call has no goal: nobody has said where to go.
    fn act(&self, _: &mut Memory, call: &Call<G>, s: &O, _: &mut Context) -> A {
        (self.act)(s, call.goal.as_ref().expect("a given policy is called for a goal"))
    }

    /// 0: it knows no values.
    fn values(&self, _: &Memory, _: &O, calls: &[(SkillId, Option<&G>)]) -> Vec<f32> {
        vec![0.0; calls.len()]
    }

    fn lesson(&mut self, _: SkillId, _: Lesson<G>) {}

    fn practise(&mut self, _: SkillId, _: u64, _: &Experience<O, A>, _: &mut Context) {}

    fn step(&mut self, _: SkillId, _: &Experience<O, A>, _: &mut Context) {}

    fn updates(&self) -> u64 {
        0
    }
}

impl<F> Checkpoint for Given<F> {
    fn save(&self, _: &mut Bag) {}

    fn load(&mut self, _: &Bag) -> Result<(), Corrupt> {
        Ok(())
    }
}
