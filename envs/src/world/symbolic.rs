//! A world seen as symbols.

use super::{Card, Drawn, Fact, Layout, Painter, ProtoGoals, World, played::Played};
use crate::{Bits, Drawing, Environment, Frame, Refused, Render, Snapshot, Space, Spec, Step, Sweep};
use inroads_sim::raster::{Filter, Format};

/// A world whose observation is [`World::symbols`].
#[derive(Clone, Debug)]
pub struct Symbolic<W> {
    played: Played<W>,
    spec: Spec,
}

impl<W: World> Symbolic<W> {
    /// The world as an environment without a limit.
    pub fn new(world: W, layout: Layout) -> Self {
        let card = world.card();
        let observation = Space::Box(card.symbols.as_slice().into());
        let spec = Spec { place: card.place.clone(), ..spec(&card, observation) };
        Self { played: Played::new(world, layout), spec }
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

/// What agents may know of a world that is seen in some way.
pub(super) fn spec(card: &Card, observation: Space) -> Spec {
    Spec {
        name: card.name,
        about: card.about,
        observation,
        action: Space::Discrete(card.actions.len()),
        goal: None,
        place: Vec::new(),
        time_limit: None,
        success_reward: card.success_reward,
    }
}

impl<W: World> Environment for Symbolic<W> {
    type Observation = Vec<f32>;
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

    fn observe(&mut self, out: &mut Vec<f32>) {
        self.played.world.symbols(out);
    }
}

impl<W: World> Snapshot for Symbolic<W> {
    type State = (W::State, bool);

    fn save(&self) -> Self::State {
        self.played.save()
    }

    fn load(&mut self, state: &Self::State) {
        self.played.load(state);
    }
}

impl<W: Drawn> Render for Symbolic<W> {
    fn drawing(&self) -> Drawing {
        let world = &self.played.world;
        drawing(world, world.painter(whole(world.native())))
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

/// The format in which people see a picture of that size: as it is, or scaled down to what is a picture still.
fn whole(native: [u32; 2]) -> Format {
    const GREATEST: u32 = 1024;
    let longer = u64::from(native[0].max(native[1]).max(1));
    match Format::NATIVE.check_of(native) {
        Ok(()) => Format::NATIVE,
        Err(_) => {
            let scaled = |side: u32| (u64::from(side) * u64::from(GREATEST) / longer).max(1) as u32;
            Format { scale: Some((native.map(scaled), Filter::Area)), ..Format::NATIVE }
        }
    }
}

/// A world as somebody draws it.
pub(super) fn drawing<W: Drawn>(world: &W, mut painter: W::Painter) -> Drawing {
    let mut frame = Frame::default();
    painter.paint(world, &mut frame);
    Drawing::Pixels(frame.to_rgb())
}

impl<W: World + Sweep> Sweep for Symbolic<W> {
    fn starts(&self) -> usize {
        self.played.starts()
    }

    fn begin(&mut self, start: usize) {
        self.played.begin(start);
    }
}

impl<W: World + ProtoGoals> ProtoGoals for Symbolic<W> {
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
