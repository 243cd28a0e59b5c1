//! What only some domains can do, each a small trait of its own. Goals have a file to themselves.

use crate::{Environment, TimeLimit};

/// A domain whose state can be kept and brought back, in the middle of an episode too.
///
/// What follows [`load`](Self::load) is bit for bit what followed [`save`](Self::save), given the same
/// actions and whatever happened in between: the state holds all that the future depends on, warm starts,
/// goal and step count included.
pub trait Snapshot {
    /// The state: a value of its own, which outlives the domain. That of a body holds its whole world.
    type State: Clone;

    /// The state at this moment, inside or outside an episode.
    fn save(&self) -> Self::State;

    /// Brings a state back that this domain, or one built in the same way, has saved.
    fn load(&mut self, state: &Self::State);
}

/// A domain that can start in each of a list of states, so that one can sweep over them.
pub trait Sweep {
    /// How many there are.
    fn starts(&self) -> usize;

    /// Begins an episode in one of them, counted from 0.
    ///
    /// # Panics
    /// When there is no such start.
    fn begin(&mut self, start: usize);
}

impl<E: Sweep + Environment> Sweep for TimeLimit<E> {
    fn starts(&self) -> usize {
        self.inner().starts()
    }

    fn begin(&mut self, start: usize) {
        self.change(|inner| inner.begin(start));
        self.set_clock(0, false);
    }
}

/// A time-limited episode: the domain's own state, and how far the limit is.
#[derive(Clone, Debug, PartialEq)]
pub struct Limited<S> {
    inner: S,
    taken: u32,
    over: bool,
}

impl<E: Snapshot + Environment> Snapshot for TimeLimit<E> {
    type State = Limited<E::State>;

    fn save(&self) -> Self::State {
        let (taken, over) = self.clock();
        Limited { inner: self.inner().save(), taken, over }
    }

    fn load(&mut self, state: &Self::State) {
        self.change(|inner| inner.load(&state.inner));
        self.set_clock(state.taken, state.over);
    }
}

impl<E: Snapshot + ?Sized> Snapshot for Box<E> {
    type State = E::State;

    fn save(&self) -> Self::State {
        (**self).save()
    }

    fn load(&mut self, state: &Self::State) {
        (**self).load(state);
    }
}
