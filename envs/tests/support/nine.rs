//! Nine cells: the smallest world that has everything a world can have. How to write one, and what tests need.
//!
//! One walks from a cell to the goal, both anywhere, and earns 1 there. On ice, a step may go astray.

use inroads_envs::{
    Bits, Dimension, End, Frame, ProtoGoals, Rng, Snapshot, Step, Sweep,
    world::{Card, Draw, Drawn, Fact, Layout, Painter, See, World},
};
use inroads_sim::raster::{Format, Mosaic};
use rand::{RngExt, SeedableRng};

/// Cells a side.
const SIDE: u8 = 3;
/// Cells.
const CELLS: u8 = SIDE * SIDE;
/// How often a step on ice goes astray.
const SLIP: f64 = 0.25;

/// Rules and state.
#[derive(Clone, Debug)]
pub struct Nine {
    ice: bool,
    state: State,
}

/// All that changes, the generator included: where it stands is part of what will happen.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    at: u8,
    goal: u8,
    chance: Rng,
}

impl Nine {
    /// The world, on ice or not.
    pub fn new(ice: bool) -> Self {
        Self { ice, state: State { at: 0, goal: CELLS - 1, chance: Rng::seed_from_u64(0) } }
    }
}

impl World for Nine {
    fn card(&self) -> Card {
        let index = |name| Dimension::linear(name, "", 0.0, f32::from(SIDE - 1));
        Card {
            name: "nine-cells",
            about: "nine cells, one of them the goal",
            actions: &["left", "right", "up", "down"],
            symbols: vec![index("x"), index("y"), index("goal x"), index("goal y")],
            place: vec![0, 1],
            limit: Some(50),
            success_reward: 1.0,
            layout: Layout::Random,
            see: See::Symbols,
        }
    }

    fn begin(&mut self, draw: Draw) {
        let mut layout = draw.layout();
        let goal = layout.random_range(0..CELLS);
        // Drawn in any case, so that the layout is the same one wherever one starts.
        let at = another(goal, &mut layout);
        let at = draw.start().map_or(at, |mut start| another(goal, &mut start));
        self.state = State { at, goal, chance: draw.play() };
    }

    fn act(&mut self, choice: usize) -> Step {
        let state = &mut self.state;
        let astray = self.ice && state.chance.random_bool(SLIP);
        let choice = if astray { state.chance.random_range(0..4) } else { choice };
        let (x, y) = (state.at % SIDE, state.at / SIDE);
        let (x, y) = match choice {
            0 => (x.saturating_sub(1), y),
            1 => ((x + 1).min(SIDE - 1), y),
            2 => (x, y.saturating_sub(1)),
            _ => (x, (y + 1).min(SIDE - 1)),
        };
        state.at = y * SIDE + x;
        match state.at == state.goal {
            true => Step { reward: 1.0, end: Some(End::Terminated) },
            false => Step { reward: 0.0, end: None },
        }
    }

    fn symbols(&self, out: &mut Vec<f32>) {
        out.clear();
        let cells = [self.state.at, self.state.goal];
        out.extend(cells.into_iter().flat_map(|cell| [cell % SIDE, cell / SIDE]).map(f32::from));
    }

    fn facts(&self) -> Vec<Fact> {
        vec![Fact::new("at the goal", u8::from(self.state.at == self.state.goal))]
    }
}

/// A cell that is not this one.
fn another(than: u8, rng: &mut Rng) -> u8 {
    (than + rng.random_range(1..CELLS)) % CELLS
}

impl Snapshot for Nine {
    type State = State;

    fn save(&self) -> State {
        self.state.clone()
    }

    fn load(&mut self, state: &State) {
        self.state.clone_from(state);
    }
}

/// The first start is the cell in the corner, and the goal the one across.
impl Sweep for Nine {
    fn starts(&self) -> usize {
        usize::from(CELLS) - 1
    }

    fn begin(&mut self, start: usize) {
        assert!(start < self.starts(), "there are {} starts, and none of number {start}", self.starts());
        self.state = State { at: start as u8, goal: CELLS - 1, chance: Rng::seed_from_u64(start as u64) };
    }
}

/// One a cell: whether one is there.
impl ProtoGoals for Nine {
    fn proto_goals(&self) -> Vec<String> {
        (0..CELLS).map(|cell| format!("at ({}, {})", cell % SIDE, cell / SIDE)).collect()
    }

    fn annotate(&self, out: &mut Bits) {
        out.clear(usize::from(CELLS));
        out.set(usize::from(self.state.at));
    }
}

/// Draws tiles of 4 pixels a side: black, the goal green, oneself red.
#[derive(Clone, Debug)]
pub struct Tiles {
    mosaic: Mosaic,
    format: Format,
    looks: Vec<u16>,
}

/// Pixels a cell's side.
const TILE: u32 = 4;

impl Drawn for Nine {
    type Painter = Tiles;

    fn painter(&self, format: Format) -> Tiles {
        let mut mosaic = Mosaic::new([u32::from(SIDE); 2], TILE, format);
        for colour in [[0, 0, 0], [0, 255, 0], [255, 0, 0]] {
            mosaic.add(&colour.repeat((TILE * TILE) as usize));
        }
        Tiles { mosaic, format, looks: vec![0; usize::from(CELLS)] }
    }
}

impl Painter<Nine> for Tiles {
    fn shape(&self) -> ([u32; 2], u32) {
        (self.format.size([u32::from(SIDE) * TILE; 2]), self.format.channels())
    }

    fn paint(&mut self, world: &Nine, out: &mut Frame) {
        self.looks.fill(0);
        self.looks[usize::from(world.state.goal)] = 1;
        self.looks[usize::from(world.state.at)] = 2;
        out.copy(self.mosaic.show(&self.looks));
    }
}
