//! Taxi, as a table of 500 states (Dietterich 2000; Gymnasium; thesis section 8.5.1).

use inroads_sim::raster::{Format, Frame};
use rand::RngExt;

use crate::registry::{Entry, Make};
use crate::visual_taxi::{Depot, Ink, Rider, Sizes, TaxiPainter, Town};
use crate::world::{Card, Distracted, Draw, Drawn, Fact, Layout, Painter, See, World};
use crate::{Bits, Dimension, End, ProtoGoals, Snapshot, Step};

/// What is paid, and what ends an episode.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rules {
    /// Gymnasium's: −1 a step; −10 for picking up or dropping off where there is nobody or no depot; 20 for dropping off
    /// at the destination, which is the end. A passenger dropped off at another depot waits there.
    #[default]
    Gymnasium,
    /// The thesis' SparseTaxi: 1 for dropping off at the destination, else nothing.
    Sparse {
        /// Whether a drop-off at a wrong depot ends the episode too, as the thesis' words have it.
        wrong_depot_ends: bool,
    },
}

impl Rules {
    /// SparseTaxi as the thesis words it.
    pub const SPARSE: Self = Self::Sparse { wrong_depot_ends: true };
    /// SparseTaxi by the other reading: only the destination ends an episode.
    pub const SPARSE_TO_DESTINATION: Self = Self::Sparse { wrong_depot_ends: false };
}

/// The worlds of the registry.
pub(crate) const ENTRIES: &[Entry] = &[
    Entry {
        name: "taxi",
        about: "pick a passenger up and drop them off at their destination, in a town of 5 by 5",
        make: Make::Annotated(|| Box::new(Taxi::new(Rules::Gymnasium))),
    },
    Entry {
        name: "sparse-taxi",
        about: "taxi paid only for arriving: the episode ends at the first drop-off at a depot",
        make: Make::Annotated(|| Box::new(Taxi::new(Rules::SPARSE))),
    },
    Entry {
        name: "sparse-taxi-to-destination",
        about: "sparse-taxi by the other reading: a drop-off at a wrong depot does not end the episode",
        make: Make::Annotated(|| Box::new(Taxi::new(Rules::SPARSE_TO_DESTINATION))),
    },
    Entry {
        name: "sparse-taxi-distracted",
        about: "sparse-taxi-to-destination and a number that changes at random in every step",
        make: Make::World(|| Box::new(Distracted::new(Taxi::new(Rules::SPARSE_TO_DESTINATION), 4))),
    },
];

/// Steps after which an episode is cut off (Gymnasium).
const LIMIT: u32 = 200;

/// The town's depots in Gymnasium's order, as indices of [`Town::depots`]: red, green, yellow, blue.
const ORDER: [usize; 4] = [2, 1, 3, 0];

/// The passenger's place while aboard.
const ABOARD: u8 = 4;

/// Gymnasium's choices as directions of [`Town::beside`]: south, north, east, west.
const DIRECTIONS: [usize; 4] = [3, 2, 1, 0];

/// The choice that picks up.
const PICK_UP: usize = 4;

/// A state of Taxi.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TaxiState {
    /// The taxi's row, 0 to 4 from the top.
    pub row: u8,
    /// The taxi's column, 0 to 4.
    pub column: u8,
    /// Where the passenger is: 0 red, 1 green, 2 yellow, 3 blue, 4 in the taxi.
    pub passenger: u8,
    /// Where they want to go: 0 to 3.
    pub destination: u8,
}

impl TaxiState {
    /// How many there are.
    pub const COUNT: usize = 500;

    /// Its number, as Gymnasium counts.
    pub fn encode(self) -> usize {
        let Self { row, column, passenger, destination } = self;
        ((usize::from(row) * 5 + usize::from(column)) * 5 + usize::from(passenger)) * 4
            + usize::from(destination)
    }

    /// The state with this number; none above 499.
    pub fn decode(number: usize) -> Option<Self> {
        (number < Self::COUNT).then_some(Self {
            row: (number / 100) as u8,
            column: (number / 20 % 5) as u8,
            passenger: (number / 4 % 5) as u8,
            destination: (number % 4) as u8,
        })
    }

    /// Those in which an episode may start: somebody waits at a depot that is not their destination.
    pub fn starts() -> impl Iterator<Item = Self> {
        let starts = |state: &Self| state.passenger != ABOARD && state.passenger != state.destination;
        (0..Self::COUNT).filter_map(Self::decode).filter(starts)
    }

    fn cell(self) -> [u8; 2] {
        [self.row, self.column]
    }

    /// The depot at the taxi, as Gymnasium numbers them.
    fn depot_here(self) -> Option<u8> {
        (0..4).find(|&nth| depot(nth).cell == self.cell())
    }
}

/// A depot by Gymnasium's number.
fn depot(number: u8) -> Depot {
    Town::FIVE.depots()[ORDER[usize::from(number)]]
}

/// The world. Choices: south, north, east, west, pick up, drop off.
#[derive(Clone, Debug)]
pub struct Taxi {
    rules: Rules,
    state: TaxiState,
}

impl Taxi {
    /// A world.
    pub fn new(rules: Rules) -> Self {
        Self { rules, state: TaxiState { row: 0, column: 0, passenger: 1, destination: 0 } }
    }

    /// The state.
    pub fn state(&self) -> TaxiState {
        self.state
    }

    /// Which choices change the state: Gymnasium's action mask.
    pub fn legal(&self) -> [bool; 6] {
        std::array::from_fn(|choice| self.after(choice) != self.state)
    }

    /// The state after a choice.
    fn after(&self, choice: usize) -> TaxiState {
        let now = self.state;
        let here = now.depot_here();
        match (choice, here) {
            (0..PICK_UP, _) => match Town::FIVE.beside(now.cell(), DIRECTIONS[choice]) {
                Some([row, column]) => TaxiState { row, column, ..now },
                None => now,
            },
            (PICK_UP, Some(depot)) if now.passenger == depot => TaxiState { passenger: ABOARD, ..now },
            (PICK_UP, _) => now,
            (_, Some(depot)) if now.passenger == ABOARD => TaxiState { passenger: depot, ..now },
            _ => now,
        }
    }
}

impl World for Taxi {
    fn card(&self) -> Card {
        Card {
            name: "taxi",
            about: "pick a passenger up and drop them off at their destination",
            actions: &["south", "north", "east", "west", "pick up", "drop off"],
            symbols: vec![
                Dimension::linear("row", "", 0.0, 4.0),
                Dimension::linear("column", "", 0.0, 4.0),
                Dimension::linear("passenger", "", 0.0, 4.0),
                Dimension::linear("destination", "", 0.0, 3.0),
            ],
            place: vec![0, 1],
            limit: Some(LIMIT),
            success_reward: if self.rules == Rules::Gymnasium { 20.0 } else { 1.0 },
            layout: Layout::Random,
            see: See::Symbols,
        }
    }

    fn begin(&mut self, draw: Draw) {
        let starts = TaxiState::starts().count();
        let chosen = TaxiState::starts().nth(draw.layout().random_range(0..starts));
        self.state = chosen.unwrap_or(self.state);
        if let Some(mut rng) = draw.start() {
            [self.state.row, self.state.column] = [rng.random_range(0..5), rng.random_range(0..5)];
        }
    }

    fn act(&mut self, choice: usize) -> Step {
        let after = self.after(choice);
        let before = std::mem::replace(&mut self.state, after);
        let dropped = before.passenger == ABOARD && self.state.passenger != ABOARD;
        let arrived = dropped && self.state.passenger == self.state.destination;
        let in_vain = choice >= PICK_UP && self.state == before;
        let (reward, over) = match self.rules {
            Rules::Gymnasium if arrived => (20.0, true),
            Rules::Gymnasium => (if in_vain { -10.0 } else { -1.0 }, false),
            Rules::Sparse { wrong_depot_ends } => {
                (f32::from(u8::from(arrived)), arrived || dropped && wrong_depot_ends)
            }
        };
        Step { reward, end: over.then_some(End::Terminated) }
    }

    fn symbols(&self, out: &mut Vec<f32>) {
        let TaxiState { row, column, passenger, destination } = self.state;
        out.clear();
        out.extend([row, column, passenger, destination].map(f32::from));
    }

    /// The author's vector, each of its one-hot parts as the number that is hot (cells are counted row by row), and whether
    /// the passenger is in the taxi and the state's number.
    fn facts(&self) -> Vec<Fact> {
        let number = |[row, column]: [u8; 2]| f32::from(row) * 5.0 + f32::from(column);
        let [rider] = self.riders();
        vec![
            Fact::new("taxi cell", number(self.state.cell())),
            Fact::new("passenger cell", number(rider.cell)),
            Fact::new("passenger in taxi", f32::from(u8::from(rider.aboard))),
            Fact::new("destination cell", number(rider.goal)),
            Fact::new("state", self.state.encode() as f32),
        ]
    }
}

impl Snapshot for Taxi {
    type State = TaxiState;

    fn save(&self) -> TaxiState {
        self.state
    }

    fn load(&mut self, state: &TaxiState) {
        self.state = *state;
    }
}

/// What each of [`ORDER`]'s depots is called.
const NAMES: [&str; 4] = ["red", "green", "yellow", "blue"];

/// The thesis' 34: where the taxi is (25), where the passenger is (5), where they want to go (4).
impl ProtoGoals for Taxi {
    fn proto_goals(&self) -> Vec<String> {
        let cells = (0..25).map(|cell| format!("taxi at {},{}", cell / 5, cell % 5));
        let depots = NAMES.iter().map(|name| format!("passenger at {name}"));
        let aboard = std::iter::once("passenger in taxi".to_owned());
        let destinations = NAMES.iter().map(|name| format!("destination {name}"));
        cells.chain(depots).chain(aboard).chain(destinations).collect()
    }

    fn annotate(&self, out: &mut Bits) {
        let TaxiState { row, column, passenger, destination } = self.state;
        out.clear(34);
        out.set(usize::from(row * 5 + column));
        out.set(25 + usize::from(passenger));
        out.set(30 + usize::from(destination));
    }

    fn cell(&self, bit: usize) -> Option<[usize; 2]> {
        (bit < 25).then_some([bit % 5, bit / 5])
    }
}

impl Taxi {
    /// The passenger as they are drawn: in the destination's colour.
    fn riders(&self) -> [Rider; 1] {
        let Depot { cell: goal, colour, .. } = depot(self.state.destination);
        let aboard = self.state.passenger == ABOARD;
        let cell = if aboard { self.state.cell() } else { depot(self.state.passenger).cell };
        [Rider { cell, aboard, goal, colour }]
    }
}

/// Drawn like the visual taxi: the passenger in the colour of the destination, which is outlined.
impl Drawn for Taxi {
    type Painter = TaxiPainter;

    fn painter(&self, format: Format) -> TaxiPainter {
        TaxiPainter::new(Town::FIVE, Sizes::MEDIUM, Ink::Coloured, format)
    }
}

impl Painter<Taxi> for TaxiPainter {
    fn shape(&self) -> ([u32; 2], u32) {
        Painter::<crate::visual_taxi::VisualTaxi>::shape(self)
    }

    fn paint(&mut self, world: &Taxi, out: &mut Frame) {
        self.draw(world.state.cell(), world.riders().into_iter(), out);
    }
}
