//! Questions about states, from which goals are made (thesis chapter 8).

use super::Fact;
use crate::{Annotated, Bits, Drawing, Environment, Refused, Render, Snapshot, Spec, Step, Sweep, TimeLimit};

/// A domain that has proto-goals: questions that each state, with what just happened in it, answers with yes or no
/// (thesis section 8.1).
pub trait ProtoGoals {
    /// What each bit asks, in a few words; as many as there are bits.
    fn proto_goals(&self) -> Vec<String>;

    /// Which hold now. Clears what `out` held.
    fn annotate(&self, out: &mut Bits);

    /// The column and row, counted from the upper left, of the cell that a bit asks about; none when it asks about
    /// something else. For pictures only: agents know nothing of what bits ask.
    fn cell(&self, _bit: usize) -> Option<[usize; 2]> {
        None
    }
}

/// What one bit asks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Question {
    /// In a few words.
    pub text: String,
    /// The cell that it is about ([`ProtoGoals::cell`]).
    pub cell: Option<[usize; 2]>,
}

/// An environment that shows the proto-goals beside what it shows otherwise.
#[derive(Clone, Debug)]
pub struct Annotating<E>(pub E);

impl<E: Environment + ProtoGoals> Environment for Annotating<E> {
    type Observation = Annotated<E::Observation>;
    type Action = E::Action;

    fn spec(&self) -> &Spec {
        self.0.spec()
    }

    fn reset(&mut self, seed: u64) {
        self.0.reset(seed);
    }

    fn step(&mut self, action: &E::Action) -> Result<Step, Refused> {
        self.0.step(action)
    }

    fn observe(&mut self, out: &mut Self::Observation) {
        self.0.observe(&mut out.seen);
        self.0.annotate(&mut out.bits);
    }

    fn fault(&self) -> Option<&str> {
        self.0.fault()
    }
}

impl<E: ProtoGoals> ProtoGoals for Annotating<E> {
    fn proto_goals(&self) -> Vec<String> {
        self.0.proto_goals()
    }

    fn annotate(&self, out: &mut Bits) {
        self.0.annotate(out);
    }

    fn cell(&self, bit: usize) -> Option<[usize; 2]> {
        self.0.cell(bit)
    }
}

impl<E: ProtoGoals + Environment> ProtoGoals for TimeLimit<E> {
    fn proto_goals(&self) -> Vec<String> {
        self.inner().proto_goals()
    }

    fn annotate(&self, out: &mut Bits) {
        self.inner().annotate(out);
    }

    fn cell(&self, bit: usize) -> Option<[usize; 2]> {
        self.inner().cell(bit)
    }
}

impl<E: Render> Render for Annotating<E> {
    fn drawing(&self) -> Drawing {
        self.0.drawing()
    }

    fn facts(&self) -> Vec<Fact> {
        self.0.facts()
    }

    fn told(&self) -> Option<String> {
        self.0.told()
    }

    fn choices(&self) -> &'static [&'static str] {
        self.0.choices()
    }
}

impl<E: Snapshot> Snapshot for Annotating<E> {
    type State = E::State;

    fn save(&self) -> Self::State {
        self.0.save()
    }

    fn load(&mut self, state: &Self::State) {
        self.0.load(state);
    }
}

impl<E: Sweep> Sweep for Annotating<E> {
    fn starts(&self) -> usize {
        self.0.starts()
    }

    fn begin(&mut self, start: usize) {
        self.0.begin(start);
    }
}
