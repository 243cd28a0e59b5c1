//! A world seen as a picture.

use super::{Drawn, Fact, Layout, Painter, ProtoGoals, played::Played, symbolic};
use crate::{Bits, Drawing, Environment, Frame, Refused, Render, Snapshot, Space, Spec, Step, Sweep};
use inroads_sim::raster::{Format, FormatError};

/// A world whose observation is a frame.
#[derive(Clone, Debug)]
pub struct Pictured<W: Drawn> {
    played: Played<W>,
    painter: W::Painter,
    spec: Spec,
}

impl<W: Drawn> Pictured<W> {
    /// The world as an environment without a limit.
    ///
    /// # Errors
    /// [`FormatError`] when no picture has that size, which that of a large world may have that nothing scales.
    pub fn new(world: W, layout: Layout, format: Format) -> Result<Self, FormatError> {
        match format.scale {
            Some(_) => format.check()?,
            None => format.check_of(world.native())?,
        }
        let painter = world.painter(format);
        let ([width, height], channels) = painter.shape();
        let spec = symbolic::spec(&world.card(), Space::Frame { width, height, channels });
        Ok(Self { played: Played::new(world, layout), painter, spec })
    }

    /// The same under another name, as the registry has it.
    pub(super) fn named(mut self, name: &'static str, about: &'static str) -> Self {
        (self.spec.name, self.spec.about) = (name, about);
        self
    }

    /// The world.
    pub fn world(&self) -> &W {
        &self.played.world
    }
}

impl<W: Drawn> Environment for Pictured<W> {
    type Observation = Frame;
    type Action = usize;

    fn spec(&self) -> &Spec {
        &self.spec
    }

    fn reset(&mut self, seed: u64) {
        self.played.reset(seed);
    }

    fn step(&mut self, choice: &usize) -> Result<Step, Refused> {
        self.played.step(*choice, &self.spec.action)
    }

    fn observe(&mut self, out: &mut Frame) {
        self.painter.paint(&self.played.world, out);
    }
}

impl<W: Drawn> Snapshot for Pictured<W> {
    type State = (W::State, bool);

    fn save(&self) -> Self::State {
        self.played.save()
    }

    fn load(&mut self, state: &Self::State) {
        self.played.load(state);
    }
}

impl<W: Drawn> Render for Pictured<W> {
    /// What the agent sees.
    fn drawing(&self) -> Drawing {
        symbolic::drawing(&self.played.world, self.painter.clone())
    }

    fn facts(&self) -> Vec<Fact> {
        self.played.world.facts()
    }

    fn told(&self) -> Option<String> {
        self.played.world.told()
    }

    fn choices(&self) -> &'static [&'static str] {
        self.played.world.card().actions
    }
}

impl<W: Drawn + Sweep> Sweep for Pictured<W> {
    fn starts(&self) -> usize {
        self.played.starts()
    }

    fn begin(&mut self, start: usize) {
        self.played.begin(start);
    }
}

impl<W: Drawn + ProtoGoals> ProtoGoals for Pictured<W> {
    fn proto_goals(&self) -> Vec<String> {
        self.played.world.proto_goals()
    }

    fn annotate(&self, out: &mut Bits) {
        self.played.world.annotate(out);
    }

    fn cell(&self, bit: usize) -> Option<[usize; 2]> {
        self.played.world.cell(bit)
    }
}
