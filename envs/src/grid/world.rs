//! The rules of MiniGrid.

use inroads_sim::raster::Format;

use super::{Cell, Door, GridError, GridPainter, Inside, Maker, State, View, cell::number, layout::Map};
use crate::world::{Card, Draw, Drawn, Fact, Layout, See, World};
use crate::{Dimension, End, Snapshot, Step};

/// What each choice does.
const ACTIONS: &[&str] = &["turn left", "turn right", "forward", "pick up", "drop", "toggle", "done"];

/// What success pays; everything else pays 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pay {
    /// `1 - 0.9 t / limit` after `t` steps, as MiniGrid has it.
    #[default]
    Sooner,
    /// 1, as the thesis' author has it (chapters 5, 7 and 9).
    One,
}

/// A world of MiniGrid: rooms, doors, keys, balls, boxes, goals and lava on a board.
#[derive(Clone, Debug)]
pub struct GridWorld {
    map: Map,
    pay: Pay,
    limit: u32,
    tile: u32,
    highlight: bool,
    layout: Layout,
    see: See,
    state: State,
}

impl GridWorld {
    /// A world whose episodes begin as the maker has it, with MiniGrid's reward and limit, seen as symbols.
    ///
    /// # Errors
    /// [`GridError`] says which size is not possible, and which are.
    pub fn new(maker: Maker) -> Result<Self, GridError> {
        let map = Map::new(maker)?;
        Ok(Self {
            pay: Pay::Sooner,
            limit: map.limit(),
            tile: 8,
            highlight: true,
            layout: Layout::Random,
            see: See::Symbols,
            state: State::empty(map.size()),
            map,
        })
    }

    /// The same as the thesis' author has it: success pays 1, one layout for all episodes, 84 × 84 pixels in colour.
    pub fn thesis(self) -> Self {
        Self { pay: Pay::One, layout: Layout::Fixed(42), see: See::Pixels(Format::THESIS), ..self }
    }

    /// The same with another limit to the steps of an episode, at least 1.
    ///
    /// # Errors
    /// [`GridError::Size`] when it is 0.
    pub fn limited(self, steps: u32) -> Result<Self, GridError> {
        between("steps of an episode", steps, 1, u32::MAX).map(|limit| Self { limit, ..self })
    }

    /// The same with another pay.
    pub fn paying(self, pay: Pay) -> Self {
        Self { pay, ..self }
    }

    /// The same with other layouts, unless somebody asks for others still.
    pub fn laid_out(self, layout: Layout) -> Self {
        Self { layout, ..self }
    }

    /// The same seen in another way, unless somebody asks for another still.
    pub fn seen(self, see: See) -> Self {
        Self { see, ..self }
    }

    /// The same drawn otherwise: pixels along a side of a cell, 1 to 256, and whether the cells that the agent sees are
    /// lighter. Without being asked it is 8 and yes.
    ///
    /// # Errors
    /// [`GridError::Size`] when nothing can be drawn in so many pixels.
    pub fn drawn(self, tile: u32, highlight: bool) -> Result<Self, GridError> {
        between("pixels along a side of a cell", tile, 1, 256).map(|tile| Self { tile, highlight, ..self })
    }

    /// The state.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// What the agent is told to do, in MiniGrid's words. No part of an observation: all objects tell the same.
    pub fn mission(&self) -> String {
        self.map.mission(&self.state)
    }

    /// The cells that the agent sees.
    pub fn view(&self) -> View {
        self.state.board.seen_from(self.state.pose)
    }

    /// Steps forward, if one can stand there.
    fn forward(&mut self) -> Option<End> {
        let front = self.state.pose.front();
        let cell = self.state.board.get(front);
        if cell.walkable() {
            self.state.pose.at = front;
        }
        matches!(cell, Cell::Goal(_) | Cell::Lava).then_some(End::Terminated)
    }

    fn pick_up(&mut self) {
        let front = self.state.pose.front();
        let cell = self.state.board.get(front);
        if cell.portable() && self.state.carried == Cell::Empty {
            self.state.carried = cell;
            self.state.board.set(front, Cell::Empty);
        }
    }

    fn drop(&mut self) {
        let front = self.state.pose.front();
        if self.state.board.is_free(front) && self.state.carried != Cell::Empty {
            let carried = std::mem::replace(&mut self.state.carried, Cell::Empty);
            self.state.board.set(front, carried);
        }
    }

    fn toggle(&mut self) {
        let front = self.state.pose.front();
        let after = match self.state.board.get(front) {
            Cell::Door(colour, Door::Open) => Cell::Door(colour, Door::Closed),
            Cell::Door(colour, Door::Closed) => Cell::Door(colour, Door::Open),
            Cell::Door(colour, Door::Locked) if self.state.carried == Cell::Key(colour) => {
                Cell::Door(colour, Door::Open)
            }
            Cell::Box(_, Inside::Nothing) => Cell::Empty,
            Cell::Box(_, Inside::Key(colour)) => Cell::Key(colour),
            Cell::Box(_, Inside::Ball(colour)) => Cell::Ball(colour),
            _ => return,
        };
        self.state.board.set(front, after);
    }

    fn success(&self) -> f32 {
        match self.pay {
            Pay::Sooner => (1.0 - 0.9 * (f64::from(self.state.steps) / f64::from(self.limit))) as f32,
            Pay::One => 1.0,
        }
    }
}

/// A number within bounds.
pub(super) fn between(what: &'static str, found: u32, least: u32, greatest: u32) -> Result<u32, GridError> {
    match (least..=greatest).contains(&found) {
        true => Ok(found),
        false => Err(GridError::Size { what, found, least, greatest }),
    }
}

impl Snapshot for GridWorld {
    type State = State;

    fn save(&self) -> State {
        self.state.clone()
    }

    fn load(&mut self, state: &State) {
        self.state.clone_from(state);
    }
}

/// Numbers of the symbols that stand before the board's.
const BEFORE: usize = 8;

impl World for GridWorld {
    fn card(&self) -> Card {
        let [width, height] = self.state.board.size();
        let number = |name, high| Dimension::linear(name, "", 0.0, high);
        let mut symbols: Vec<_> = [
            ("x", f32::from(width - 1)),
            ("y", f32::from(height - 1)),
            ("direction", 3.0),
            ("carried object", 7.0),
            ("carried colour", 5.0),
            ("carried state", 12.0),
            ("underfoot object", 9.0),
            ("underfoot colour", 5.0),
        ]
        .map(|(name, high)| number(name, high))
        .into();
        // Without their cell's place, as a thousand names of their own would weigh more than the world.
        let cell = [("object", 10.0), ("colour", 5.0), ("state", 3.0)].map(|(name, high)| number(name, high));
        let cells = usize::from(width) * usize::from(height);
        symbols.extend(cell.iter().cycle().take(3 * cells).cloned());
        Card {
            name: self.map.name(),
            about: self.map.about(),
            actions: ACTIONS,
            symbols,
            place: vec![0, 1],
            limit: Some(self.limit),
            // The least that success pays is MiniGrid's 0.1 on the last step.
            success_reward: 0.05,
            layout: self.layout,
            see: self.see,
        }
    }

    fn begin(&mut self, draw: Draw) {
        self.map.lay_out(&mut draw.layout(), &mut self.state);
        if let Some(mut rng) = draw.start() {
            self.map.start_anywhere(&mut rng, &mut self.state);
        }
    }

    fn act(&mut self, choice: usize) -> Step {
        self.state.steps = self.state.steps.saturating_add(1);
        let facing = self.state.pose.facing;
        let mut end = None;
        let mut succeeded = false;
        match choice {
            0 => self.state.pose.facing = facing.left(),
            1 => self.state.pose.facing = facing.right(),
            2 => {
                end = self.forward();
                succeeded = end.is_some() && self.state.board.get(self.state.pose.at) != Cell::Lava;
            }
            3 => {
                self.pick_up();
                succeeded = self.state.taken();
            }
            4 => self.drop(),
            5 => {
                self.toggle();
                succeeded = self.state.opened();
            }
            _ => {}
        }
        match succeeded {
            true => Step { reward: self.success(), end: Some(End::Terminated) },
            false => Step { reward: 0.0, end },
        }
    }

    fn symbols(&self, out: &mut Vec<f32>) {
        let State { board, pose, carried, .. } = &self.state;
        let facing = pose.facing as u8;
        let (carried, under) = (carried.encode(), board.get(pose.at).encode());
        let before = [pose.at[0], pose.at[1], facing, carried[0], carried[1], carried[2], under[0], under[1]];
        let cells = board.triples().as_flattened();
        out.resize(BEFORE + cells.len(), 0.0);
        let (head, tail) = out.split_at_mut(BEFORE);
        head.copy_from_slice(&before.map(f32::from));
        tail.iter_mut().zip(cells).for_each(|(to, from)| *to = f32::from(*from));
        if let Some(index) = board.index(pose.at) {
            let agent = [number::AGENT, 0, facing];
            tail[3 * index..][..3].copy_from_slice(&agent.map(f32::from));
        }
    }

    /// The mission.
    fn told(&self) -> Option<String> {
        Some(self.mission())
    }

    /// The author's vector (x, y, has key, the doors' states by columns, on lava, has ball), and the direction.
    fn facts(&self) -> Vec<Fact> {
        let State { board, pose, carried, .. } = &self.state;
        let truth = f32::from;
        let mut facts = vec![
            Fact::new("x", pose.at[0]),
            Fact::new("y", pose.at[1]),
            Fact::new("has key", truth(matches!(carried, Cell::Key(_)) as u8)),
        ];
        for ([x, y], cell) in board.cells() {
            if let Cell::Door(_, door) = cell {
                facts.push(Fact::new(format!("door {x} {y}"), door as u8));
            }
        }
        facts.extend([
            Fact::new("on lava", truth((board.get(pose.at) == Cell::Lava) as u8)),
            Fact::new("has ball", truth(matches!(carried, Cell::Ball(_)) as u8)),
            Fact::new("direction", pose.facing as u8),
        ]);
        facts
    }
}

impl Drawn for GridWorld {
    type Painter = GridPainter;

    fn painter(&self, format: Format) -> GridPainter {
        GridPainter::new(self.state.board.size(), self.tile, self.highlight, format)
    }

    fn native(&self) -> [u32; 2] {
        self.state.board.size().map(|cells| u32::from(cells) * self.tile)
    }
}
