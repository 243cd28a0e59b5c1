//! Taxis that are seen (visgrid, Allen et al. 2021; thesis sections 7.3 and 9.3).

mod draw;
mod proto_goals;
mod starts;
mod town;

pub(crate) use draw::Rider;
pub use draw::{Ink, Sizes, TaxiPainter};
pub use starts::Starts;
pub use town::{Depot, Town};

use inroads_sim::raster::Format;

use crate::registry::{Entry, Make};
use crate::world::{AnnotatedWorld, Card, Draw, Drawn, Fact, Layout, See, World};
use crate::{Dimension, End, Snapshot, Step};

/// What there is to choose about the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Where the taxi drives.
    pub town: Town,
    /// How many passengers there are: one at least, fewer than depots.
    pub passengers: usize,
    /// Whether passengers can be dropped off at depots only. visgrid's default, and the thesis': anywhere.
    pub depot_dropoff_only: bool,
    /// How episodes start.
    pub starts: Starts,
    /// How large things are drawn.
    pub sizes: Sizes,
    /// What becomes of the colours.
    pub ink: Ink,
    /// Steps after which an episode is cut off.
    pub limit: Option<u32>,
}

impl Settings {
    /// The town of 5 × 5 cells, with one passenger, cut off after 50 steps (thesis section 7.3.1).
    pub const FIVE: Self = Self {
        town: Town::FIVE,
        passengers: 1,
        depot_dropoff_only: false,
        starts: Starts::Classic,
        sizes: Sizes::MEDIUM,
        ink: Ink::Coloured,
        limit: Some(50),
    };

    /// The town of 10 × 10 cells. The thesis names no limit: 200, four times that of a quarter of the cells.
    pub const TEN: Self = Self { town: Town::TEN, sizes: Sizes::WIDE, limit: Some(200), ..Self::FIVE };
}

/// There is no such world.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{passengers} passengers where there are {depots} depots; ask for 1 to {}", depots - 1)]
pub struct PassengersError {
    passengers: usize,
    depots: usize,
}

/// The worlds of the registry.
pub(crate) const ENTRIES: &[Entry] = &[
    Entry {
        name: "visual-taxi-5x5",
        about: "pick a passenger up and drop them off at the depot of their colour, in a town of 5 by 5",
        make: Make::Annotated(|| world(Settings::FIVE)),
    },
    Entry {
        name: "visual-taxi-5x5-thesis",
        about: "visual-taxi-5x5 seen as the thesis' author has it: 84 by 84 pixels, inverted, each channel all or nothing",
        make: Make::Annotated(|| thesis(Settings { sizes: Sizes::LARGE, ..Settings::FIVE })),
    },
    Entry {
        name: "visual-taxi-10x10",
        about: "visual-taxi-5x5 in a town of 10 by 10 with eight depots",
        make: Make::Annotated(|| world(Settings::TEN)),
    },
    Entry {
        name: "visual-taxi-10x10-thesis",
        about: "visual-taxi-10x10 seen as the thesis' author has it",
        make: Make::Annotated(|| thesis(Settings::TEN)),
    },
    Entry {
        name: "visual-taxi-10x10-7-depots",
        about: "visual-taxi-10x10 with the thesis' seven depots",
        make: Make::Annotated(|| world(SEVEN)),
    },
    Entry {
        name: "visual-taxi-10x10-7-depots-thesis",
        about: "visual-taxi-10x10-7-depots seen as the thesis' author has it",
        make: Make::Annotated(|| thesis(SEVEN)),
    },
];

/// The thesis' seven depots (figure 9.4).
const SEVEN: Settings = Settings { town: Town::TEN_WITH_SEVEN, ..Settings::TEN };

fn world(settings: Settings) -> Box<dyn AnnotatedWorld> {
    Box::new(VisualTaxi::new(settings).expect("one passenger is never too many"))
}

/// The author's frames, as large as they are drawn.
fn thesis(settings: Settings) -> Box<dyn AnnotatedWorld> {
    let world = VisualTaxi::new(Settings { ink: Ink::Inverted, ..settings });
    let world = world.expect("one passenger is never too many");
    Box::new(VisualTaxi { see: See::Pixels(Format::NATIVE), ..world })
}

/// A passenger.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Passenger {
    /// Row and column: the taxi's while aboard.
    pub cell: [u8; 2],
    /// Whether they are in the taxi. One is at most.
    pub aboard: bool,
    /// Which of the town's depots they want to go to.
    pub goal: u8,
}

/// The state of the world.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct State {
    /// The taxi's row and column.
    pub taxi: [u8; 2],
    /// The passengers.
    pub passengers: Vec<Passenger>,
}

impl State {
    /// Whoever is aboard.
    fn aboard(&self) -> Option<usize> {
        self.passengers.iter().position(|passenger| passenger.aboard)
    }

    /// Whether somebody other than this one is in a cell.
    fn taken(&self, cell: [u8; 2], but: usize) -> bool {
        self.passengers.iter().enumerate().any(|(nth, passenger)| nth != but && passenger.cell == cell)
    }
}

/// The world. Choices: left, right, up, down, interact (pick up if nobody is aboard, else drop off).
#[derive(Clone, Debug)]
pub struct VisualTaxi {
    settings: Settings,
    state: State,
    see: See,
}

/// The choice that picks up and drops off.
const INTERACT: usize = 4;

impl VisualTaxi {
    /// A world.
    ///
    /// # Errors
    /// [`PassengersError`] when there is no passenger, or not a depot more than passengers.
    pub fn new(settings: Settings) -> Result<Self, PassengersError> {
        let (passengers, depots) = (settings.passengers, settings.town.depots().len());
        if !(1..depots).contains(&passengers) {
            return Err(PassengersError { passengers, depots });
        }
        let mut world = Self {
            settings,
            state: State { taxi: [0, 0], passengers: Vec::with_capacity(passengers) },
            see: See::Symbols,
        };
        world.begin(Layout::Fixed(0).draw(0));
        Ok(world)
    }

    /// The state.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The settings.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Which choices do something: visgrid's action mask.
    pub fn legal(&self) -> [bool; 5] {
        std::array::from_fn(|choice| self.possible(choice))
    }

    fn possible(&self, choice: usize) -> bool {
        let State { taxi, passengers } = &self.state;
        let aboard = self.state.aboard();
        if choice != INTERACT {
            let beside = self.settings.town.beside(*taxi, choice);
            return beside.is_some_and(|cell| aboard.is_none_or(|rider| !self.state.taken(cell, rider)));
        }
        match aboard {
            None => passengers.iter().any(|passenger| passenger.cell == *taxi),
            Some(_) if !self.settings.depot_dropoff_only => true,
            Some(_) => self.settings.town.depots().iter().any(|depot| depot.cell == *taxi),
        }
    }

    fn solved(&self) -> bool {
        let arrived =
            |passenger: &Passenger| !passenger.aboard && passenger.cell == self.goal(passenger).cell;
        self.state.passengers.iter().all(arrived)
    }

    fn goal(&self, passenger: &Passenger) -> &'static Depot {
        &self.settings.town.depots()[usize::from(passenger.goal)]
    }

    /// What a passenger is called.
    fn who(&self, nth: usize) -> String {
        if self.settings.passengers == 1 { "passenger".into() } else { format!("passenger {}", nth + 1) }
    }

    /// The passengers as they are drawn.
    fn riders(&self) -> impl Iterator<Item = Rider> {
        self.state.passengers.iter().map(|passenger| {
            let Depot { cell: goal, colour, .. } = *self.goal(passenger);
            Rider { cell: passenger.cell, aboard: passenger.aboard, goal, colour }
        })
    }
}

impl World for VisualTaxi {
    fn card(&self) -> Card {
        let size = f32::from(self.settings.town.size());
        let depots = self.settings.town.depots().len() as f32;
        let at = |name: String, high| Dimension { name: name.into(), ..Dimension::linear("", "", 0.0, high) };
        let mut symbols = vec![at("taxi row".into(), size - 1.0), at("taxi column".into(), size - 1.0)];
        for nth in 0..self.settings.passengers {
            let who = self.who(nth);
            symbols.extend([
                at(format!("{who} row"), size - 1.0),
                at(format!("{who} column"), size - 1.0),
                at(format!("{who} in taxi"), 1.0),
                at(format!("{who} goal"), depots - 1.0),
            ]);
        }
        Card {
            name: "visual-taxi",
            about: "pick passengers up and drop them off at the depots of their colours",
            actions: &["left", "right", "up", "down", "interact"],
            symbols,
            place: vec![0, 1],
            limit: self.settings.limit,
            success_reward: 1.0,
            layout: Layout::Random,
            see: self.see,
        }
    }

    fn begin(&mut self, draw: Draw) {
        self.start(draw);
    }

    fn act(&mut self, choice: usize) -> Step {
        if self.possible(choice) {
            let aboard = self.state.aboard();
            if choice == INTERACT {
                let taxi = self.state.taxi;
                let here = aboard.or_else(|| self.state.passengers.iter().position(|p| p.cell == taxi));
                if let Some(rider) = here {
                    self.state.passengers[rider].aboard = aboard.is_none();
                }
            } else if let Some(cell) = self.settings.town.beside(self.state.taxi, choice) {
                self.state.taxi = cell;
                if let Some(rider) = aboard {
                    self.state.passengers[rider].cell = cell;
                }
            }
        }
        let solved = self.solved();
        Step { reward: f32::from(u8::from(solved)), end: solved.then_some(End::Terminated) }
    }

    fn symbols(&self, out: &mut Vec<f32>) {
        out.clear();
        out.extend(self.state.taxi.map(f32::from));
        for Passenger { cell: [row, column], aboard, goal } in &self.state.passengers {
            out.extend([*row, *column, u8::from(*aboard), *goal].map(f32::from));
        }
    }

    /// The author's vector, each of its one-hot parts as the number that is hot (cells are counted row by row), and whether
    /// each passenger is in the taxi.
    fn facts(&self) -> Vec<Fact> {
        let size = f32::from(self.settings.town.size());
        let number = |[row, column]: [u8; 2]| f32::from(row) * size + f32::from(column);
        let mut facts = vec![Fact::new("taxi cell", number(self.state.taxi))];
        for (nth, passenger) in self.state.passengers.iter().enumerate() {
            let who = self.who(nth);
            facts.push(Fact::new(format!("{who} cell"), number(passenger.cell)));
            facts.push(Fact::new(format!("{who} goal cell"), number(self.goal(passenger).cell)));
            facts.push(Fact::new(format!("{who} in taxi"), f32::from(u8::from(passenger.aboard))));
        }
        facts
    }
}

impl Snapshot for VisualTaxi {
    type State = State;

    fn save(&self) -> State {
        self.state.clone()
    }

    fn load(&mut self, state: &State) {
        self.state.taxi = state.taxi;
        self.state.passengers.clone_from(&state.passengers);
    }
}

impl Drawn for VisualTaxi {
    type Painter = TaxiPainter;

    fn painter(&self, format: Format) -> TaxiPainter {
        TaxiPainter::new(self.settings.town, self.settings.sizes, self.settings.ink, format)
    }
}
