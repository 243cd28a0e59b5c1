//! Rooms of cells on a map: the four rooms of Sutton, Precup and Singh (1999), and nine cells, for answers that are known.

use inroads_sim::raster::{Format, Mosaic};
use rand::RngExt;

use crate::registry::{Entry, Make};
use crate::world::{Card, Draw, Drawn, Fact, Layout, Painter, See, World};
use crate::{Dimension, End, Frame, Rng, Seed, Snapshot, Step};

/// Four rooms and four hallways, 104 free cells (Sutton, Precup and Singh 1999, figure 2), from corner to corner.
pub const FOUR_ROOMS: &str = "
#############
#S    #     #
#     #     #
#           #
#     #     #
#     #     #
## ####     #
#     ### ###
#     #     #
#     #     #
#           #
#     #    G#
#############";

/// Three by three cells, from corner to corner.
pub const NINE_CELLS: &str = "
#####
#S  #
#   #
#  G#
#####";

/// How often a move goes astray in the noisy rooms, in one of the other three directions (Sutton, Precup and Singh 1999).
pub const SLIP: f64 = 1.0 / 3.0;

/// The worlds of the registry.
pub(crate) const ENTRIES: &[Entry] = &[
    Entry {
        name: "rooms",
        about: "four rooms of cells, from corner to corner; 1 for arriving, else nothing",
        make: Make::World(|| Box::new(Rooms::own(FOUR_ROOMS, 0.0, 200))),
    },
    Entry {
        name: "rooms-noisy",
        about: "the four rooms where every third move goes astray",
        make: Make::World(|| Box::new(Rooms::own(FOUR_ROOMS, SLIP, 300))),
    },
    Entry {
        name: "nine-cells",
        about: "three by three cells, from corner to corner; 1 for arriving, else nothing",
        make: Make::World(|| Box::new(Rooms::own(NINE_CELLS, 0.0, 20))),
    },
];

/// A map that makes no world.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RoomsError {
    /// There is no row with a cell, or there are too many.
    #[error("a map of rooms has 1 to 255 rows and columns, not {columns} by {rows}")]
    Size {
        /// Columns of the first row.
        columns: usize,
        /// Rows.
        rows: usize,
    },
    /// A row has another length than the first.
    #[error("row {row} of the map has {found} cells where the first has {expected}")]
    Ragged {
        /// Which row, counted from 1.
        row: usize,
        /// Its cells.
        found: usize,
        /// Those of the first.
        expected: usize,
    },
    /// A sign that means nothing.
    #[error("row {row}, column {column} of the map is `{sign}`; write `#` for a wall, a blank, `S` or `G`")]
    Sign {
        /// Which row, counted from 1.
        row: usize,
        /// Which column, counted from 1.
        column: usize,
        /// What stands there.
        sign: char,
    },
    /// Not one start or not one goal.
    #[error("the map has {found} cells `{sign}`; it needs one")]
    Count {
        /// `S` or `G`.
        sign: char,
        /// How many there are.
        found: usize,
    },
    /// Chance that is none.
    #[error("a share of {0} moves cannot go astray; it lies in [0, 1]")]
    Slip(f64),
}

/// What changes.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomsState {
    /// Where one is: column and row, from the top left.
    pub at: [u8; 2],
    /// Where one wants to go.
    pub goal: [u8; 2],
    /// What makes moves go astray.
    chance: Rng,
}

/// Rooms of cells. Choices: left, right, up, down; walls stop one. Arriving pays 1 and ends the episode.
///
/// With a fixed layout start and goal are the map's; with a fixed map the start is anywhere; else both are.
#[derive(Clone, Debug)]
pub struct Rooms {
    columns: u8,
    free: Vec<bool>,
    start: [u8; 2],
    goal: [u8; 2],
    slip: f64,
    limit: u32,
    state: RoomsState,
}

impl Rooms {
    /// The world of a map: `#` walls, blanks, one `S` for the start and one `G` for the goal. Blank first and last lines
    /// do not count. A share `slip` of all moves goes in one of the other three directions; an episode is cut off after
    /// `limit` steps.
    ///
    /// # Errors
    /// [`RoomsError`] says where the map is wrong.
    pub fn new(map: &str, slip: f64, limit: u32) -> Result<Self, RoomsError> {
        let rows: Vec<Vec<char>> = map.trim_matches('\n').lines().map(|row| row.chars().collect()).collect();
        let columns = rows.first().map_or(0, Vec::len);
        if !(1..=255).contains(&columns) || !(1..=255).contains(&rows.len()) {
            return Err(RoomsError::Size { columns, rows: rows.len() });
        }
        let (mut free, mut starts, mut goals) = (Vec::new(), Vec::new(), Vec::new());
        for (y, row) in rows.iter().enumerate() {
            if row.len() != columns {
                return Err(RoomsError::Ragged { row: y + 1, found: row.len(), expected: columns });
            }
            for (x, &sign) in row.iter().enumerate() {
                match sign {
                    '#' | ' ' => {}
                    'S' => starts.push([x as u8, y as u8]),
                    'G' => goals.push([x as u8, y as u8]),
                    _ => return Err(RoomsError::Sign { row: y + 1, column: x + 1, sign }),
                }
                free.push(sign != '#');
            }
        }
        let one = |sign, found: &[[u8; 2]]| match found {
            [cell] => Ok(*cell),
            _ => Err(RoomsError::Count { sign, found: found.len() }),
        };
        let (start, goal) = (one('S', &starts)?, one('G', &goals)?);
        if !(0.0..=1.0).contains(&slip) {
            return Err(RoomsError::Slip(slip));
        }
        let state = RoomsState { at: start, goal, chance: Seed(0).stream("play", 0) };
        Ok(Self { columns: columns as u8, free, start, goal, slip, limit, state })
    }

    fn own(map: &str, slip: f64, limit: u32) -> Self {
        Self::new(map, slip, limit).expect("the maps of this file are whole")
    }

    /// Columns and rows, walls included.
    pub fn size(&self) -> [u8; 2] {
        [self.columns, (self.free.len() / usize::from(self.columns)) as u8]
    }

    /// Whether one can be in a cell; outside of the map one cannot.
    pub fn free(&self, [x, y]: [u8; 2]) -> bool {
        x < self.columns && self.free.get(self.index([x, y])).copied().unwrap_or(false)
    }

    /// All cells that one can be in, row by row.
    pub fn cells(&self) -> impl Iterator<Item = [u8; 2]> {
        let [columns, rows] = self.size();
        (0..rows).flat_map(move |y| (0..columns).map(move |x| [x, y])).filter(|cell| self.free(*cell))
    }

    /// Where one is.
    pub fn state(&self) -> &RoomsState {
        &self.state
    }

    fn index(&self, [x, y]: [u8; 2]) -> usize {
        usize::from(y) * usize::from(self.columns) + usize::from(x)
    }

    /// A free cell that is not this one.
    fn another(&self, than: [u8; 2], rng: &mut Rng) -> [u8; 2] {
        let others: Vec<_> = self.cells().filter(|cell| *cell != than).collect();
        if others.is_empty() { than } else { others[rng.random_range(0..others.len())] }
    }
}

impl World for Rooms {
    fn card(&self) -> Card {
        let [columns, rows] = self.size().map(|n| f32::from(n - 1));
        let index = |name, high| Dimension::linear(name, "", 0.0, high);
        Card {
            name: "rooms",
            about: "rooms of cells",
            actions: &["left", "right", "up", "down"],
            symbols: vec![
                index("column", columns),
                index("row", rows),
                index("goal column", columns),
                index("goal row", rows),
            ],
            place: vec![0, 1],
            limit: Some(self.limit),
            success_reward: 1.0,
            layout: Layout::Fixed(0),
            see: See::Symbols,
        }
    }

    fn begin(&mut self, draw: Draw) {
        let (mut at, mut goal) = (self.start, self.goal);
        if !draw.fixed() {
            let mut rng = draw.layout();
            goal = self.another(at, &mut rng);
            at = self.another(goal, &mut rng);
        }
        if let Some(mut rng) = draw.start() {
            at = self.another(goal, &mut rng);
        }
        self.state = RoomsState { at, goal, chance: draw.play() };
    }

    fn act(&mut self, choice: usize) -> Step {
        let astray = self.slip > 0.0 && self.state.chance.random_bool(self.slip);
        let choice = if astray { (choice + self.state.chance.random_range(1..4)) % 4 } else { choice };
        let [x, y] = self.state.at;
        let to = match choice {
            0 => [x.wrapping_sub(1), y],
            1 => [x.wrapping_add(1), y],
            2 => [x, y.wrapping_sub(1)],
            _ => [x, y.wrapping_add(1)],
        };
        if self.free(to) {
            self.state.at = to;
        }
        match self.state.at == self.state.goal {
            true => Step { reward: 1.0, end: Some(End::Terminated) },
            false => Step { reward: 0.0, end: None },
        }
    }

    fn symbols(&self, out: &mut Vec<f32>) {
        out.clear();
        out.extend([self.state.at, self.state.goal].into_iter().flatten().map(f32::from));
    }

    fn facts(&self) -> Vec<Fact> {
        vec![Fact::new("at the goal", u8::from(self.state.at == self.state.goal))]
    }
}

impl Snapshot for Rooms {
    type State = RoomsState;

    fn save(&self) -> RoomsState {
        self.state.clone()
    }

    fn load(&mut self, state: &RoomsState) {
        self.state.clone_from(state);
    }
}

/// Pixels a cell's side.
const TILE: u32 = 8;

/// Floor, wall, goal and oneself.
const COLOURS: [[u8; 3]; 4] = [[236, 236, 236], [64, 64, 64], [77, 175, 74], [214, 96, 77]];

/// Draws rooms: a tile a cell.
#[derive(Clone, Debug)]
pub struct RoomsPainter {
    mosaic: Mosaic,
    shape: ([u32; 2], u32),
    looks: Vec<u16>,
}

impl Drawn for Rooms {
    type Painter = RoomsPainter;

    fn painter(&self, format: Format) -> RoomsPainter {
        let mut mosaic = Mosaic::new(self.size().map(u32::from), TILE, format);
        for colour in COLOURS {
            mosaic.add(&colour.repeat((TILE * TILE) as usize));
        }
        let size = format.size(self.size().map(|cells| u32::from(cells) * TILE));
        RoomsPainter { mosaic, shape: (size, format.channels()), looks: Vec::new() }
    }
}

impl Painter<Rooms> for RoomsPainter {
    fn shape(&self) -> ([u32; 2], u32) {
        self.shape
    }

    fn paint(&mut self, world: &Rooms, out: &mut Frame) {
        self.looks.clear();
        self.looks.extend(world.free.iter().map(|free| u16::from(!free)));
        self.looks[world.index(world.state.goal)] = 2;
        self.looks[world.index(world.state.at)] = 3;
        out.copy(self.mosaic.show(&self.looks));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Environment, world::Symbolic};

    fn seen(env: &mut impl Environment<Observation = Vec<f32>>) -> Vec<f32> {
        let mut seen = Vec::new();
        env.observe(&mut seen);
        seen
    }

    #[test]
    fn four_rooms_have_104_cells_and_walls_stop_one() {
        let rooms = Rooms::own(FOUR_ROOMS, 0.0, 200);
        assert_eq!((rooms.size(), rooms.cells().count()), ([13, 13], 104));
        let mut env = Symbolic::new(rooms, Layout::Fixed(0));
        env.reset(3);
        assert_eq!(seen(&mut env), [1.0, 1.0, 11.0, 11.0]);
        let mut walk = |choices: &[usize]| {
            let steps: Vec<_> = choices.iter().map(|choice| env.step(choice).unwrap()).collect();
            (seen(&mut env), *steps.last().unwrap())
        };
        assert_eq!(
            walk(&[0, 2, 1, 1, 1, 1, 1, 1]).0[..2],
            [5.0, 1.0],
            "left, up and the dividing wall stop one"
        );
        assert_eq!(walk(&[3, 3, 1, 1]).0[..2], [7.0, 3.0], "through the hallway");
        let (at, last) = walk(&[1, 1, 3, 3, 3, 3, 3, 3, 3, 3, 1, 1]);
        assert_eq!((&at[..2], last), (&[11.0, 11.0][..], Step { reward: 1.0, end: Some(End::Terminated) }));
    }

    #[test]
    fn a_third_of_the_noisy_moves_goes_astray_evenly() {
        let mut rooms = Rooms::own("#####\n#S  #\n#   #\n#  G#\n#####", SLIP, 20);
        let mut ends = [0_u32; 4];
        for seed in 0..3000 {
            rooms.begin(Layout::Fixed(0).draw(seed));
            rooms.state.at = [2, 2];
            rooms.act(1);
            let [x, y] = rooms.state.at;
            ends[match [x, y] {
                [1, 2] => 0,
                [3, 2] => 1,
                [2, 1] => 2,
                _ => 3,
            }] += 1;
        }
        // 2000 ± 77 (three standard deviations) and 333 ± 52.
        assert!(ends[1].abs_diff(2000) < 78, "{ends:?}");
        assert!([0, 2, 3].iter().all(|i| ends[*i].abs_diff(333) < 52), "{ends:?}");
    }

    #[test]
    fn layouts_say_what_is_drawn() {
        let starts = |layout: Layout| -> Vec<RoomsState> {
            let mut rooms = Rooms::own(NINE_CELLS, 0.0, 20);
            (0..40)
                .map(|seed| {
                    rooms.begin(layout.draw(seed));
                    rooms.state.clone()
                })
                .collect()
        };
        assert!(starts(Layout::Fixed(1)).iter().all(|s| (s.at, s.goal) == ([1, 1], [3, 3])));
        let anywhere = starts(Layout::FixedMap(1));
        assert!(anywhere.iter().all(|s| s.goal == [3, 3] && s.at != s.goal));
        assert!(anywhere.iter().any(|s| s.at != [1, 1]));
        assert!(starts(Layout::Random).iter().any(|s| s.goal != [3, 3]));
    }

    #[test]
    fn a_wrong_map_is_named_by_row_and_column() {
        let error = |map: &str| Rooms::new(map, 0.0, 10).unwrap_err().to_string();
        assert!(error("###\n#S\n").contains("row 2"));
        assert!(error("S?G").contains("row 1, column 2"));
        assert!(error("S  ").contains("0 cells `G`"));
        assert!(error("").contains("0 by 0") || error("").contains("1 to 255"));
        assert!(Rooms::new("SG", 1.5, 10).is_err());
    }
}
