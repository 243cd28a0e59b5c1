//! One copy, and what it writes into its rows of the batch.

use super::{Admissible, AutoReset, Row};
use crate::{End, Environment, Refused, Seed, Step};

/// A copy's rows of the batch.
pub(super) struct Rows<'a, N> {
    pub(super) observation: &'a mut [N],
    pub(super) last: &'a mut [N],
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
}

/// The rows that a copy of this domain has.
type RowsOf<'a, E> = Rows<'a, <<E as Environment>::Observation as Row>::Number>;

impl<E: Environment<Observation: Row, Action: Admissible>> Slot<E> {
    pub(super) fn new(env: E, seed: Seed) -> Self {
        Self { env, seed, episode: 0, over: true, called: false, refusal: None }
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

    /// Begins the next episode. `seen` is scratch memory, as in [`step`](Self::step): all copies of a part share it, so
    /// that it stays in the processor's cache.
    pub(super) fn begin(&mut self, rows: RowsOf<'_, E>, seen: &mut E::Observation) {
        self.reset();
        self.env.observe(seen);
        rows.observation.copy_from_slice(seen.numbers());
        (*rows.reward, *rows.end, *rows.began, *rows.fault) = (0.0, None, true, None);
    }

    /// Carries out an admitted action.
    pub(super) fn step(
        &mut self,
        action: &E::Action,
        auto: AutoReset,
        rows: RowsOf<'_, E>,
        seen: &mut E::Observation,
    ) {
        if self.over {
            return self.begin(rows, seen);
        }
        let Step { reward, end } = match self.env.step(action) {
            Ok(step) => step,
            Err(refused) => {
                self.refusal = Some(refused);
                return;
            }
        };
        self.env.observe(seen);
        (*rows.reward, *rows.end, *rows.began, *rows.fault) = (reward, end, false, None);
        self.over = end.is_some();
        if self.over {
            rows.last.copy_from_slice(seen.numbers());
            *rows.fault = self.env.fault().map(str::to_owned);
            if auto == AutoReset::SameStep {
                self.reset();
                self.env.observe(seen);
                *rows.began = true;
            }
        }
        rows.observation.copy_from_slice(seen.numbers());
    }

    fn reset(&mut self) {
        self.env.reset(self.seed.number("episode", self.episode));
        self.episode += 1;
        self.over = false;
    }
}
