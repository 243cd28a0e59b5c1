//! Sokoban: push every box onto a target (gym-sokoban, Schrader 2018; thesis section 7.3).

mod draw;
mod generate;
mod read;
mod reverse;
mod room;

pub use draw::{Look, SokobanPainter};
pub use read::RoomError;
pub use reverse::Search;
pub use room::{Cell, Moved, Room};

use inroads_sim::raster::Format;
use rand::RngExt;

use crate::registry::{Entry, Make};
use crate::world::{AnyWorld, Card, Draw, Drawn, Fact, Layout, See, World};
use crate::{Dimension, End, Snapshot, Step};
use generate::Generator;

/// The worlds of the registry: gym-sokoban's `v0`, `v1`, `v2`, `small-v0`, `small-v1`, `large-v0`, and the first as the
/// thesis' author has it.
pub(crate) const ENTRIES: &[Entry] = &[
    Entry {
        name: "sokoban",
        about: "push three boxes onto their targets in a room of 10 by 10",
        make: Make::World(|| made([10, 10], 3, 34, 200)),
    },
    Entry {
        name: "sokoban-4-boxes",
        about: "four boxes in a room of 10 by 10, in 120 steps",
        make: Make::World(|| made([10, 10], 4, 34, 120)),
    },
    Entry {
        name: "sokoban-5-boxes",
        about: "five boxes in a room of 10 by 10",
        make: Make::World(|| made([10, 10], 5, 40, 200)),
    },
    Entry {
        name: "sokoban-small",
        about: "two boxes in a room of 7 by 7",
        make: Make::World(|| made([7, 7], 2, 23, 200)),
    },
    Entry {
        name: "sokoban-small-3-boxes",
        about: "three boxes in a room of 7 by 7",
        make: Make::World(|| made([7, 7], 3, 23, 200)),
    },
    Entry {
        name: "sokoban-large",
        about: "three boxes in a room of 13 by 11",
        make: Make::World(|| made([13, 11], 3, 43, 300)),
    },
    Entry {
        name: "sokoban-thesis",
        about: "as the thesis' author has it: one room, seen in colour, steps are free and boxes worth a tenth",
        make: Make::World(|| {
            let see = See::Pixels(Format::THESIS);
            Box::new(Sokoban {
                see,
                layout: Layout::Fixed(42),
                ..world([10, 10], 3, 34, 200, Reward::Author)
            })
        }),
    },
];

/// A world with the peer's rewards.
fn made(size: [usize; 2], boxes: usize, walk: u32, limit: u32) -> Box<dyn AnyWorld> {
    Box::new(world(size, boxes, walk, limit, Reward::Peer))
}

/// A world of the registry, of which it is known that it has rooms.
fn world(size: [usize; 2], boxes: usize, walk: u32, limit: u32, reward: Reward) -> Sokoban {
    let walk = Some(walk);
    let settings = Settings { size, boxes, walk, reward, limit: Some(limit), ..Settings::default() };
    Sokoban::new(settings).expect("the registry's settings have rooms")
}

/// What is paid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Reward {
    /// gym-sokoban's: −0.1 a step, 1 more when a box comes onto a target, 1 less when one leaves it, 10 more when all
    /// are there.
    #[default]
    Peer,
    /// The thesis author's: a tenth of that, without the price of a step. The last push earns 1.1.
    Author,
    /// 1 when all boxes are on targets, else nothing.
    Sparse,
}

impl Reward {
    /// For a step that brought so many boxes more onto targets, and maybe solved the room.
    fn of(self, more: i32, solved: bool) -> f32 {
        let task = more.signum() as f32 + if solved { 10.0 } else { 0.0 };
        match self {
            Self::Peer => (f64::from(task) - 0.1) as f32,
            Self::Author => task / 10.0,
            Self::Sparse => f32::from(u8::from(solved)),
        }
    }

    /// The least that solving earns.
    fn success(self) -> f32 {
        match self {
            Self::Peer => 9.0,
            Self::Author => 0.9,
            Self::Sparse => 1.0,
        }
    }
}

/// Which rooms there are, and what is paid in them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Rows and columns, walls included, 3 to 100 each.
    pub size: [usize; 2],
    /// Boxes, and as many targets.
    pub boxes: usize,
    /// Steps of the walk that hollows the room out, 100,000 at most; `None`: 1.7 × (rows + columns), as gym-sokoban.
    pub walk: Option<u32>,
    /// How long each room is searched for a start.
    pub search: Search,
    /// What is paid.
    pub reward: Reward,
    /// How it is drawn.
    pub look: Look,
    /// Steps after which an episode is cut off.
    pub limit: Option<u32>,
}

impl Default for Settings {
    /// The thesis': 10 × 10, three boxes, 200 steps (gym-sokoban's `Sokoban-v0`), with the peer's rewards.
    fn default() -> Self {
        Self {
            size: [10, 10],
            boxes: 3,
            walk: None,
            search: Search::default(),
            reward: Reward::Peer,
            look: Look::Sprites,
            limit: Some(200),
        }
    }
}

/// Why there is no such world.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SokobanError {
    /// Too small or too large.
    #[error("rooms of {rows} rows and {columns} columns; both must lie between 3 and 100, walls included")]
    Size {
        /// Rows asked for.
        rows: usize,
        /// Columns asked for.
        columns: usize,
    },
    /// No box, or more than fit.
    #[error(
        "{boxes} boxes in rooms of {rows} rows and {columns} columns: {}; their {cells} cells between the walls hold the \
         boxes, the player and a free cell", mend(*cells)
    )]
    Boxes {
        /// Boxes asked for.
        boxes: usize,
        /// Rows asked for.
        rows: usize,
        /// Columns asked for.
        columns: usize,
        /// Cells between the walls.
        cells: usize,
    },
    /// The walk takes too long.
    #[error(
        "walks of {0} steps; ask for at most {most}: 1.7 × (rows + columns) are usual, and long walks hollow everything out",
        most = generate::LONGEST_WALK
    )]
    Walk(u32),
    /// There are such rooms, perhaps, but none was found.
    #[error(
        "none of {tries} walks of {walk} steps made a room of {rows} rows and {columns} columns in which {boxes} boxes \
         can all be pulled off their targets; ask for fewer boxes, a larger room or a longer walk"
    )]
    NoRoom {
        /// Boxes asked for.
        boxes: usize,
        /// Rows asked for.
        rows: usize,
        /// Columns asked for.
        columns: usize,
        /// Steps of each walk.
        walk: u32,
        /// Walks that were tried.
        tries: u32,
    },
    /// One's own room is solved from the start.
    #[error("every box of the room is on a target: there is nothing to do")]
    Solved,
}

/// What to do about a number of boxes, in rooms with so many cells between the walls.
fn mend(cells: usize) -> String {
    match cells.saturating_sub(2).min(reverse::MOST_BOXES) {
        0 => "no box fits, ask for a room of 3 rows and 5 columns at least".to_owned(),
        most => format!("ask for 1 to {most}"),
    }
}

/// Where rooms come from.
#[derive(Clone, Debug)]
enum Rooms {
    /// By chance.
    Made(Box<Generator>),
    /// One's own.
    Own(Room),
}

/// The world. Choices: nothing, push up, down, left, right, move up, down, left, right.
#[derive(Clone, Debug)]
pub struct Sokoban {
    rooms: Rooms,
    settings: Settings,
    room: Room,
    layout: Layout,
    see: See,
}

impl Sokoban {
    /// A world whose rooms are made by chance, each with a solution.
    ///
    /// Whether there are such rooms is found out here, on up to a thousand of them. A room that chance later denies, a
    /// hundred times in a row, is replaced by the one found here.
    ///
    /// # Errors
    /// [`SokobanError`] when the size or the number of boxes is impossible, or no such room was found.
    pub fn new(settings: Settings) -> Result<Self, SokobanError> {
        let generator = Generator::new(&settings)?;
        let room = generator.spare().clone();
        Ok(Self::with(Rooms::Made(Box::new(generator)), settings, room))
    }

    /// A world with one room, whatever the layout (though [`Layout::FixedMap`] has the player begin elsewhere in it). Size,
    /// boxes, walk and search of the settings do not matter.
    ///
    /// Nothing checks that it can be solved.
    ///
    /// # Errors
    /// [`SokobanError::Solved`].
    pub fn of(room: Room, settings: Settings) -> Result<Self, SokobanError> {
        if room.solved() {
            return Err(SokobanError::Solved);
        }
        let settings = Settings { size: room.size(), boxes: room.box_count() as usize, ..settings };
        Ok(Self::with(Rooms::Own(room.clone()), settings, room))
    }

    fn with(rooms: Rooms, settings: Settings, room: Room) -> Self {
        Self { rooms, settings, room, layout: Layout::Random, see: See::Symbols }
    }

    /// The room as it is.
    pub fn room(&self) -> &Room {
        &self.room
    }

    /// The settings, with size and boxes as they are.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Choices that solve the room that was last begun, far from the fewest, from where its layout has the player begin (not
    /// from a start that [`Layout::FixedMap`] drew, nor from a state that was loaded). None for one's own room, and before
    /// the first episode.
    pub fn solution(&self) -> Option<&[u8]> {
        match &self.rooms {
            Rooms::Made(generator) => generator.last().map(|level| level.solution.as_slice()),
            Rooms::Own(_) => None,
        }
    }
}

impl World for Sokoban {
    fn card(&self) -> Card {
        let [rows, columns] = self.settings.size;
        let at = |name, side: usize| Dimension::linear(name, "", 0.0, side as f32 - 1.0);
        let mut symbols = vec![at("player row", rows), at("player column", columns)];
        symbols.extend((0..rows * columns).map(|at| Dimension {
            name: format!("cell {},{}", at / columns, at % columns).into(),
            ..Dimension::linear("", "", 0.0, 6.0)
        }));
        Card {
            name: "sokoban",
            about: "push every box onto a target",
            actions: &[
                "nothing",
                "push up",
                "push down",
                "push left",
                "push right",
                "move up",
                "move down",
                "move left",
                "move right",
            ],
            symbols,
            place: vec![0, 1],
            limit: self.settings.limit,
            success_reward: self.settings.reward.success(),
            layout: self.layout,
            see: self.see,
        }
    }

    fn begin(&mut self, draw: Draw) {
        match &mut self.rooms {
            Rooms::Made(generator) => self.room.copy(&generator.level(draw.layout()).room),
            Rooms::Own(room) => self.room.copy(room),
        }
        if let Some(mut rng) = draw.start() {
            // Anywhere from where the start can be reached and left without a push, so that the room stays solvable.
            let cells = self.room.walkable();
            self.room.go(cells[rng.random_range(0..cells.len())]);
        }
    }

    fn act(&mut self, choice: usize) -> Step {
        let before = self.room.on_target();
        self.room.act(choice);
        let more = self.room.on_target() as i32 - before as i32;
        let solved = self.room.solved();
        Step { reward: self.settings.reward.of(more, solved), end: solved.then_some(End::Terminated) }
    }

    fn symbols(&self, out: &mut Vec<f32>) {
        out.clear();
        out.extend(self.room.player().map(|at| at as f32));
        out.extend(self.room.cells().iter().map(|&cell| f32::from(cell as u8)));
    }

    /// The author's vector: the player, every box row by row, solved.
    fn facts(&self) -> Vec<Fact> {
        let [row, column] = self.room.player();
        let mut facts = vec![Fact::new("player row", row as f32), Fact::new("player column", column as f32)];
        for (number, [row, column]) in (1..).zip(self.room.boxes()) {
            facts.push(Fact::new(format!("box {number} row"), row as f32));
            facts.push(Fact::new(format!("box {number} column"), column as f32));
        }
        facts.push(Fact::new("solved", f32::from(u8::from(self.room.solved()))));
        facts
    }
}

impl Snapshot for Sokoban {
    type State = Room;

    fn save(&self) -> Room {
        self.room.clone()
    }

    fn load(&mut self, state: &Room) {
        self.room.copy(state);
    }
}

impl Drawn for Sokoban {
    type Painter = SokobanPainter;

    fn painter(&self, format: Format) -> SokobanPainter {
        SokobanPainter::new(self.settings.size, self.settings.look, format)
    }
}
