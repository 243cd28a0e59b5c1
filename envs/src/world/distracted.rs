//! A world beside which something changes that nobody can do anything about.

use inroads_sim::raster::{Format, Frame};
use rand::{RngExt, SeedableRng};

use super::{Card, Draw, Drawn, Fact, Grain, Painter, World};
use crate::{Dimension, Rng, Snapshot, Step};

/// A world with one number more among its symbols, the last: drawn anew at the beginning and in every step, uniformly,
/// whatever is done. It is no part of the state, of the picture, or of what searches tell states apart by.
#[derive(Clone, Debug)]
pub struct Distracted<W> {
    world: W,
    values: u8,
    now: u8,
    chance: Rng,
}

impl<W: World> Distracted<W> {
    /// A world beside which a number takes on 0 to `values` − 1; with 1 there is nothing to be distracted by.
    pub fn new(world: W, values: u8) -> Self {
        Self { world, values: values.max(1), now: 0, chance: Rng::seed_from_u64(0) }
    }

    /// The world.
    pub fn world(&self) -> &W {
        &self.world
    }

    fn flicker(&mut self) {
        self.now = self.chance.random_range(0..self.values);
    }
}

/// All that changes in an episode of a [`Distracted`] world.
#[derive(Clone, Debug, PartialEq)]
pub struct Beside<S> {
    world: S,
    now: u8,
    chance: Rng,
}

impl<W: World> Snapshot for Distracted<W> {
    type State = Beside<W::State>;

    fn save(&self) -> Self::State {
        Beside { world: self.world.save(), now: self.now, chance: self.chance.clone() }
    }

    fn load(&mut self, state: &Self::State) {
        self.world.load(&state.world);
        self.now = state.now;
        self.chance.clone_from(&state.chance);
    }
}

impl<W: World> World for Distracted<W> {
    fn card(&self) -> Card {
        let mut card = self.world.card();
        card.symbols.push(Dimension::linear("distractor", "", 0.0, f32::from(self.values - 1)));
        card
    }

    fn begin(&mut self, draw: Draw) {
        self.world.begin(draw);
        self.chance = draw.distraction();
        self.flicker();
    }

    fn act(&mut self, choice: usize) -> Step {
        let step = self.world.act(choice);
        self.flicker();
        step
    }

    fn symbols(&self, out: &mut Vec<f32>) {
        self.world.symbols(out);
        out.push(f32::from(self.now));
    }

    fn landmark(&self, out: &mut Vec<f32>) -> Grain {
        self.world.landmark(out)
    }

    fn facts(&self) -> Vec<Fact> {
        self.world.facts()
    }

    fn told(&self) -> Option<String> {
        self.world.told()
    }
}

/// Draws the world, and not what is beside it.
#[derive(Clone, Debug)]
pub struct Undistracted<P>(P);

impl<W: Drawn> Drawn for Distracted<W> {
    type Painter = Undistracted<W::Painter>;

    fn painter(&self, format: Format) -> Self::Painter {
        Undistracted(self.world.painter(format))
    }

    fn native(&self) -> [u32; 2] {
        self.world.native()
    }
}

impl<W: World, P: Painter<W>> Painter<Distracted<W>> for Undistracted<P> {
    fn shape(&self) -> ([u32; 2], u32) {
        self.0.shape()
    }

    fn paint(&mut self, world: &Distracted<W>, out: &mut Frame) {
        self.0.paint(&world.world, out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::{Layout, nine::Nine};

    #[test]
    fn the_last_number_changes_at_random_and_nothing_else_does() {
        let (mut alone, mut beside) = (Nine::new(true), Distracted::new(Nine::new(true), 4));
        let (mut a, mut b) = (Vec::new(), Vec::new());
        let (mut times, mut streak) = ([0; 4], 0);
        for episode in 0..40 {
            alone.begin(Layout::Random.draw(episode));
            beside.begin(Layout::Random.draw(episode));
            let mut last = 9.0;
            for choice in 0..25 {
                alone.symbols(&mut a);
                beside.symbols(&mut b);
                assert_eq!(a, b[..a.len()], "the distractor takes nothing from the world's own chance");
                times[b[a.len()] as usize] += 1;
                streak += usize::from(b[a.len()] == last);
                last = b[a.len()];
                if alone.act(choice % 4).end != beside.act(choice % 4).end {
                    panic!("the same choices do the same");
                }
            }
        }
        assert!(times.iter().all(|n| (190..310).contains(n)), "uniformly: {times:?}");
        assert!((180..310).contains(&streak), "by itself: {streak} of 960 are like the one before");
        let (mut one, mut other) = (Vec::new(), Vec::new());
        alone.landmark(&mut one);
        beside.landmark(&mut other);
        assert_eq!(one, other);
    }
}
