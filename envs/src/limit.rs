//! The only place of truncation: a wrapper that ends an episode after a number of steps.

use crate::{Drawing, End, Environment, Refused, Render, Spec, Step, world::Fact};

/// Truncates the episodes of `E` after a number of steps.
#[derive(Clone, Debug)]
pub struct TimeLimit<E> {
    inner: E,
    spec: Spec,
    limit: u32,
    taken: u32,
    over: bool,
}

impl<E: Environment> TimeLimit<E> {
    /// Wraps an environment. The limit stands in the wrapper's [`Spec::time_limit`].
    pub fn new(inner: E, limit: u32) -> Self {
        let spec = Spec { time_limit: Some(limit), ..inner.spec().clone() };
        Self { inner, spec, limit, taken: 0, over: true }
    }

    /// What is limited.
    pub fn inner(&self) -> &E {
        &self.inner
    }

    /// Changes what is limited and takes over the goal that its spec then has.
    pub fn change<T>(&mut self, how: impl FnOnce(&mut E) -> T) -> T {
        let answer = how(&mut self.inner);
        self.spec.goal.clone_from(&self.inner.spec().goal);
        answer
    }

    /// Steps taken in this episode, and whether it is over.
    pub(crate) fn clock(&self) -> (u32, bool) {
        (self.taken, self.over)
    }

    pub(crate) fn set_clock(&mut self, taken: u32, over: bool) {
        (self.taken, self.over) = (taken, over);
    }
}

impl<E: Environment> Environment for TimeLimit<E> {
    type Observation = E::Observation;
    type Action = E::Action;

    fn spec(&self) -> &Spec {
        &self.spec
    }

    fn reset(&mut self, seed: u64) {
        self.inner.reset(seed);
        self.taken = 0;
        self.over = false;
    }

    fn step(&mut self, action: &Self::Action) -> Result<Step, Refused> {
        if self.over {
            return Err(Refused::Over);
        }
        let mut step = self.inner.step(action)?;
        self.taken += 1;
        if step.end.is_none() && self.taken >= self.limit {
            step.end = Some(End::Truncated);
        }
        self.over = step.end.is_some();
        Ok(step)
    }

    fn observe(&mut self, out: &mut Self::Observation) {
        self.inner.observe(out);
    }

    fn fault(&self) -> Option<&str> {
        self.inner.fault()
    }
}

impl<E: Render> Render for TimeLimit<E> {
    fn drawing(&self) -> Drawing {
        self.inner.drawing()
    }

    fn facts(&self) -> Vec<Fact> {
        self.inner.facts()
    }

    fn told(&self) -> Option<String> {
        self.inner.told()
    }

    fn choices(&self) -> &'static [&'static str] {
        self.inner.choices()
    }
}
