//! One copy, and what it writes into its rows of the batch.

use super::{Admissible, AutoReset};
use crate::{End, Environment, Refused, Seed, Step};

/// A copy's rows of the batch.
pub(super) struct Rows<'a> {
    pub(super) observation: &'a mut [f32],
    pub(super) last: &'a mut [f32],
    pub(super) reward: &'a mut f32,
    pub(super) end: &'a mut Option<End>,
    pub(super) began: &'a mut bool,
    pub(super) fault: &'a mut Option<String>,
}

/// A copy of the domain.
pub(super) struct Slot<E> {
    env: E,
    seed: Seed,
    /// The number of the next episode.
    episode: u64,
    over: bool,
    called: bool,
    refusal: Option<Refused>,
    /// What the environment writes its observation into.
    seen: Vec<f32>,
}

impl<E: Environment<Observation = Vec<f32>, Action: Admissible>> Slot<E> {
    pub(super) fn new(env: E, seed: Seed) -> Self {
        Self { env, seed, episode: 0, over: true, called: false, refusal: None, seen: Vec::new() }
    }

    pub(super) fn env(&self) -> &E {
        &self.env
    }

    /// Whether it would carry out the action, or needs none.
    pub(super) fn admit(&self, action: &E::Action, auto: AutoReset) -> Result<(), Refused> {
        match (self.over, auto) {
            (true, AutoReset::NextStep) => Ok(()),
            (true, _) => Err(Refused::Over),
            (false, _) => action.admit(&self.env.spec().action),
        }
    }

    /// Asks for a new episode.
    pub(super) fn call(&mut self) {
        self.called = true;
    }

    /// Whether a new episode was asked for, once.
    pub(super) fn called(&mut self) -> bool {
        std::mem::take(&mut self.called)
    }

    /// What the environment refused in the last step, once.
    pub(super) fn refusal(&mut self) -> Option<Refused> {
        self.refusal.take()
    }

    /// Begins the next episode.
    pub(super) fn begin(&mut self, rows: Rows<'_>) {
        self.reset();
        rows.observation.copy_from_slice(&self.seen);
        (*rows.reward, *rows.end, *rows.began, *rows.fault) = (0.0, None, true, None);
    }

    /// Carries out an admitted action.
    pub(super) fn step(&mut self, action: &E::Action, auto: AutoReset, rows: Rows<'_>) {
        if self.over {
            return self.begin(rows);
        }
        let Step { reward, end } = match self.env.step(action) {
            Ok(step) => step,
            Err(refused) => {
                self.refusal = Some(refused);
                return;
            }
        };
        self.env.observe(&mut self.seen);
        (*rows.reward, *rows.end, *rows.began, *rows.fault) = (reward, end, false, None);
        self.over = end.is_some();
        if self.over {
            rows.last.copy_from_slice(&self.seen);
            *rows.fault = self.env.fault().map(str::to_owned);
            if auto == AutoReset::SameStep {
                self.reset();
                *rows.began = true;
            }
        }
        rows.observation.copy_from_slice(&self.seen);
    }

    fn reset(&mut self) {
        self.env.reset(self.seed.number("episode", self.episode));
        self.episode += 1;
        self.over = false;
        self.env.observe(&mut self.seen);
    }
}
