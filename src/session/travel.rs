//! Plans acted out: to one place, and from there to another.

use inroads_agents::{Actor, Context, Summary, Transition};
use inroads_discovery::Skilled;

use super::{
    pair::Seen,
    spot::{Located, PlanError},
};

/// An episode that was to lead from one place to another.
#[derive(Clone, Debug, PartialEq)]
pub struct Travelled {
    /// After how many steps it was at the first place; none when it never was.
    pub departed: Option<u32>,
    /// After how many steps it was at the second one, after the first; none when it never was.
    pub arrived: Option<u32>,
    /// What the episode came to.
    pub summary: Summary,
}

/// The actor that pursues two places, one after the other. Once at the second it goes on as it likes, since an episode
/// ends when the environment says so.
pub(super) struct Journey<'a, O, A> {
    agent: &'a dyn Skilled<O, A>,
    stages: Vec<Stage<'a, O, A>>,
    /// The stage that it is on; after the last, their number.
    on: usize,
    steps: u32,
}

struct Stage<'a, O, A> {
    place: Located<O>,
    actor: Box<dyn Actor<O, A> + 'a>,
    reached: Option<u32>,
}

impl<'a, O: Seen, A> Journey<'a, O, A> {
    /// From one place to the other.
    ///
    /// # Errors
    /// [`PlanError::NoGraph`] when the agent pursues no places.
    pub(super) fn new(agent: &'a dyn Skilled<O, A>, places: [Located<O>; 2]) -> Result<Self, PlanError> {
        let stage = |place: Located<O>| {
            let actor = agent.pursue(&place.place()).ok_or(PlanError::NoGraph)?;
            Ok(Stage { place, actor, reached: None })
        };
        let stages = places.into_iter().map(stage).collect::<Result<_, PlanError>>()?;
        Ok(Self { agent, stages, on: 0, steps: 0 })
    }

    /// After how many steps each place was reached.
    pub(super) fn reached(&self) -> [Option<u32>; 2] {
        [0, 1].map(|stage: usize| self.stages[stage].reached)
    }

    /// Notes the places that `s` is at; whether the next stage begins here.
    fn arrive(&mut self, s: &O) -> bool {
        let before = self.on;
        while self.stages.get(self.on).is_some_and(|stage| stage.place.holds(self.agent, s)) {
            self.stages[self.on].reached = Some(self.steps);
            self.on += 1;
        }
        before != self.on && self.on < self.stages.len()
    }

    fn acting(&mut self) -> &mut (dyn Actor<O, A> + 'a) {
        let last = self.stages.len() - 1;
        &mut *self.stages[self.on.min(last)].actor
    }
}

impl<O: Seen, A> Actor<O, A> for Journey<'_, O, A> {
    fn begin(&mut self, s: &O, ctx: &mut Context) {
        self.arrive(s);
        self.acting().begin(s, ctx);
    }

    fn act(&mut self, s: &O, ctx: &mut Context) -> A {
        self.acting().act(s, ctx)
    }

    fn observe(&mut self, t: &Transition<O, A>, ctx: &mut Context) {
        self.steps += 1;
        self.acting().observe(t, ctx);
        if self.arrive(t.after) && t.end.is_none() {
            self.acting().begin(t.after, ctx);
        }
    }

    fn source(&self) -> usize {
        self.stages[self.on.min(self.stages.len() - 1)].actor.source()
    }
}
