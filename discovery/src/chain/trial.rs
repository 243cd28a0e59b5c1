//! One call of a skill, watched without learning: what its initiation set foretells.

use inroads_agents::{Actor, Context, Experience, Transition};

use super::{Aim, Chaining, Lane};
use crate::{
    Initiation, PolicyOverSkills, SkillId, SkillPolicy, Stop,
    execution::Execution,
    record::{Came, Trial},
};

/// A call of one skill, made where the episode begins.
pub(super) struct OneCall<'a, O, A, I, P, Q, S: Aim<O>> {
    method: &'a Chaining<O, A, I, P, Q, S>,
    all: &'a Experience<O, A>,
    skill: SkillId,
    execution: Execution<Lane<S::Goal>, S::Goal>,
    came: Option<Came>,
}

impl<'a, O, A, I, P, Q, S> OneCall<'a, O, A, I, P, Q, S>
where
    O: AsRef<[f32]> + Clone,
    I: Initiation<O, A>,
    P: SkillPolicy<O, A, S::Goal>,
    Q: PolicyOverSkills<O>,
    S: Aim<O>,
{
    /// A call of a learned skill.
    pub(super) fn new(
        method: &'a Chaining<O, A, I, P, Q, S>,
        all: &'a Experience<O, A>,
        skill: SkillId,
    ) -> Self {
        Self { method, all, skill, execution: Execution::new(Lane::default()), came: None }
    }
}

impl<O, A, I, P, Q, S> Actor<O, A> for OneCall<'_, O, A, I, P, Q, S>
where
    O: AsRef<[f32]> + Clone,
    I: Initiation<O, A>,
    P: SkillPolicy<O, A, S::Goal>,
    Q: PolicyOverSkills<O>,
    S: Aim<O>,
{
    fn begin(&mut self, s: &O, ctx: &mut Context) {
        let Self { method, all, skill, .. } = *self;
        self.execution = Execution::new(Lane::default());
        // A skill is not admissible where it ends (equation 3.1).
        let there = method.repertoire.inside(method.repertoire.skill(skill).subgoal, s);
        self.came = there.then_some(Came { stop: Stop::Reached, steps: 0, success: true });
        if !there {
            let call = method.call(skill, &mut self.execution.lane, s, all, ctx);
            self.execution.running = Some((call, 0));
        }
    }

    fn act(&mut self, s: &O, ctx: &mut Context) -> A {
        self.execution.act(self.method, s, self.all, ctx)
    }

    fn observe(&mut self, t: &Transition<O, A>, _: &mut Context) {
        let (call, steps, stop) = self.execution.advance(self.method, t);
        if let (None, Some(stop)) = (self.came, stop) {
            let repertoire = &self.method.repertoire;
            let subgoal = repertoire.skill(call.skill).subgoal;
            let success = stop == Stop::Reached || repertoire.attained(subgoal, t.after, t.reward, t.end);
            self.came = Some(Came { stop, steps, success });
        }
    }

    fn source(&self) -> usize {
        self.execution.last.index()
    }
}

impl<O, A, I, P, Q, S> Trial<O, A> for OneCall<'_, O, A, I, P, Q, S>
where
    O: AsRef<[f32]> + Clone,
    I: Initiation<O, A>,
    P: SkillPolicy<O, A, S::Goal>,
    Q: PolicyOverSkills<O>,
    S: Aim<O>,
{
    fn came(&self) -> Option<Came> {
        self.came
    }
}
