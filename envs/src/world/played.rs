//! A world in the course of an episode, however it is seen.

use super::{Layout, World};
use crate::{Refused, Space, Step, Sweep};

/// A world, its layouts, and whether an episode is on.
#[derive(Clone, Debug)]
pub(super) struct Played<W> {
    pub(super) world: W,
    layout: Layout,
    over: bool,
}

impl<W: World> Played<W> {
    pub(super) fn new(world: W, layout: Layout) -> Self {
        Self { world, layout, over: true }
    }

    pub(super) fn reset(&mut self, seed: u64) {
        self.world.begin(self.layout.draw(seed));
        self.over = false;
    }

    pub(super) fn step(&mut self, choice: usize, choices: &Space) -> Result<Step, Refused> {
        if self.over {
            return Err(Refused::Over);
        }
        choices.admit_choice(choice)?;
        let step = self.world.act(choice);
        self.over = step.end.is_some();
        Ok(step)
    }

    pub(super) fn save(&self) -> (W::State, bool) {
        (self.world.save(), self.over)
    }

    pub(super) fn load(&mut self, (state, over): &(W::State, bool)) {
        self.world.load(state);
        self.over = *over;
    }
}

impl<W: World + Sweep> Sweep for Played<W> {
    fn starts(&self) -> usize {
        self.world.starts()
    }

    fn begin(&mut self, start: usize) {
        Sweep::begin(&mut self.world, start);
        self.over = false;
    }
}
