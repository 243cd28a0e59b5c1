//! Rooms by chance: a walk hollows out the walls, targets and player are strewn, and the game is played backwards
//! (gym-sokoban's generator).

use rand::RngExt;

use super::{
    Cell, Room, Settings, SokobanError,
    reverse::{self, Found, MOST_BOXES, Search},
    room::SIDES,
};
use crate::{Rng, Seed};

/// A room, and actions that solve it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Level {
    pub(super) room: Room,
    pub(super) solution: Vec<u8>,
}

/// Makes rooms of one size with one number of boxes.
#[derive(Clone, Debug)]
pub(super) struct Generator {
    size: [usize; 2],
    boxes: usize,
    walk: u32,
    search: Search,
    /// What there is when luck is out.
    spare: Level,
    /// The last room, and the chance that it came from: a fixed layout is made once.
    last: Option<(Rng, Level)>,
}

/// Probability that the walk draws a new direction (gym-sokoban).
const TURN: f64 = 0.35;

/// What the walk hollows out about itself, rows from the top (gym-sokoban): bars, two angles, a block.
const STAMPS: [[[u8; 3]; 3]; 5] = [
    [[0, 0, 0], [1, 1, 1], [0, 0, 0]],
    [[0, 1, 0], [0, 1, 0], [0, 1, 0]],
    [[0, 0, 0], [1, 1, 0], [0, 1, 0]],
    [[0, 0, 0], [1, 1, 0], [1, 1, 0]],
    [[0, 0, 0], [0, 1, 1], [0, 1, 0]],
];

/// Walks tried for one room. The original tries for ever; in the settings of the registry 14 to 57 of 100 fail, a hundred
/// in a row once in 10^24 rooms.
const TRIES: u32 = 100;

/// Walks tried, with a short search, to find out whether there are such rooms at all.
const TRIALS: u32 = 1000;

/// Steps of the longest walk: a thousand such walks, the most that are tried when a world is built, take some seconds.
pub(super) const LONGEST_WALK: u32 = 100_000;

/// The short search.
const GLANCE: Search = Search { depth: 300, states: 2_000 };

impl Generator {
    /// Finds out whether there are such rooms.
    pub(super) fn new(settings: &Settings) -> Result<Self, SokobanError> {
        let (size @ [rows, columns], boxes) = (settings.size, settings.boxes);
        if !SIDES.contains(&rows) || !SIDES.contains(&columns) {
            return Err(SokobanError::Size { rows, columns });
        }
        let cells = (rows - 2) * (columns - 2);
        if boxes == 0 || boxes + 2 > cells || boxes > MOST_BOXES {
            return Err(SokobanError::Boxes { boxes, rows, columns, cells });
        }
        let walk = settings.walk.unwrap_or((rows + columns) as u32 * 17 / 10);
        if walk > LONGEST_WALK {
            return Err(SokobanError::Walk(walk));
        }
        let mut rng = Seed(0).stream("spare room", 0);
        let spare = (0..TRIALS).find_map(|_| level(size, boxes, walk, GLANCE, &mut rng));
        let spare = spare.ok_or(SokobanError::NoRoom { boxes, rows, columns, walk, tries: TRIALS })?;
        Ok(Self { size, boxes, walk, search: settings.search, spare, last: None })
    }

    /// The room that there is when luck is out.
    pub(super) fn spare(&self) -> &Room {
        &self.spare.room
    }

    /// The room of this chance.
    pub(super) fn level(&mut self, mut chance: Rng) -> &Level {
        let known = self.last.take().filter(|(last, _)| *last == chance);
        let (_, level) = self.last.insert(known.unwrap_or_else(|| {
            let key = chance.clone();
            let tried =
                (0..TRIES).find_map(|_| level(self.size, self.boxes, self.walk, self.search, &mut chance));
            (key, tried.unwrap_or_else(|| self.spare.clone()))
        }));
        level
    }

    /// The room of the last chance.
    pub(super) fn last(&self) -> Option<&Level> {
        self.last.as_ref().map(|(_, level)| level)
    }
}

/// One try.
fn level(size: [usize; 2], boxes: usize, walk: u32, search: Search, rng: &mut Rng) -> Option<Level> {
    let mut cells = hollow(size, walk, rng);
    let mut floor: Vec<usize> = (0..cells.len()).filter(|&at| cells[at] == Cell::Floor).collect();
    if floor.len() <= boxes + 1 {
        return None;
    }
    let mut take = || floor.remove(rng.random_range(0..floor.len()));
    let player = take();
    for _ in 0..boxes {
        cells[take()] = Cell::Target;
    }
    let Found { player, boxes, mut solution, .. } = reverse::search(&cells, size[1], player, search)?;
    cells[player] = Cell::Player;
    for at in boxes {
        cells[at] = cells[at].with_box();
    }
    let room = Room::new(size, cells).ok()?;
    // Backwards it began with the player walking about, and boxes may come home to each other's targets before that.
    let mut played = room.clone();
    let last = solution.iter().position(|&action| {
        played.act(action.into());
        played.solved()
    });
    solution.truncate(last? + 1);
    Some(Level { room, solution })
}

/// Walls with floor in them.
fn hollow([rows, columns]: [usize; 2], walk: u32, rng: &mut Rng) -> Vec<Cell> {
    let mut cells = vec![Cell::Wall; rows * columns];
    let mut direction = rng.random_range(0..4);
    let mut at = [rng.random_range(1..rows), rng.random_range(1..columns)];
    for _ in 0..walk {
        if rng.random_bool(TURN) {
            direction = rng.random_range(0..4);
        }
        let [down, right] = [[1, 0], [0, 1], [-1, 0], [0, -1]][direction];
        let clamped = |at: usize, by: isize, side: usize| at.saturating_add_signed(by).clamp(1, side - 2);
        at = [clamped(at[0], down, rows), clamped(at[1], right, columns)];
        for (row, line) in STAMPS[rng.random_range(0..STAMPS.len())].iter().enumerate() {
            for (column, &hollowed) in line.iter().enumerate() {
                let [row, column] = [at[0] + row - 1, at[1] + column - 1];
                let edge = row == 0 || column == 0 || row + 1 == rows || column + 1 == columns;
                if hollowed == 1 && !edge {
                    cells[row * columns + column] = Cell::Floor;
                }
            }
        }
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solutions_solve() {
        for (size, boxes) in [([10, 10], 3), ([7, 7], 2), ([7, 9], 1), ([3, 12], 1)] {
            let settings = Settings { size, boxes, ..Settings::default() };
            let mut generator = Generator::new(&settings).expect("there are such rooms");
            for seed in 0..8 {
                let Level { mut room, solution } = generator.level(Seed(seed).stream("layout", 0)).clone();
                assert_eq!((room.on_target(), room.box_count()), (0, boxes as u32));
                for &action in &solution {
                    let moved = room.act(action.into());
                    assert_eq!((moved.player, moved.pushed), (true, action < 5), "seed {seed}");
                }
                assert!(room.solved(), "{size:?}, {boxes} boxes, seed {seed}");
            }
        }
    }

    #[test]
    fn when_luck_is_out_there_is_the_spare_room() {
        let settings = Settings { search: Search { depth: 0, states: 0 }, ..Settings::default() };
        let mut generator = Generator::new(&settings).unwrap();
        let spare = generator.spare.clone();
        assert_eq!(*generator.level(Seed(1).stream("layout", 0)), spare);
    }

    /// How seldom luck is out.
    #[test]
    fn walks_of_the_registry_seldom_fail() {
        let known = [
            ([10, 10], 3, 34),
            ([10, 10], 4, 34),
            ([10, 10], 5, 40),
            ([7, 7], 2, 23),
            ([7, 7], 3, 23),
            ([13, 11], 3, 43),
        ];
        let failed = known.map(|(size, boxes, walk)| {
            let mut rng = Seed(0).stream("walks", 0);
            (0..1000).filter(|_| level(size, boxes, walk, GLANCE, &mut rng).is_none()).count()
        });
        assert!(failed.iter().all(|&failed| failed < 600), "{failed:?} of 1000");
    }

    /// Free cells of 6,000 walks of gym-sokoban's, mean and deviation, and how many of 2,808 solved rooms gave no game,
    /// against ours: within four standard errors.
    #[test]
    fn rooms_are_as_the_originals_on_average() {
        let mut rng = Seed(1).stream("walks", 0);
        let n = 6000;
        let theirs = [([10, 10], 34, 25.38, 7.93), ([7, 7], 23, 13.61, 4.11), ([13, 11], 43, 34.58, 10.34)];
        for (size, walk, mean, deviation) in theirs {
            let mut free =
                || hollow(size, walk, &mut rng).iter().filter(|&&cell| cell == Cell::Floor).count() as f64;
            let free: Vec<f64> = (0..n).map(|_| free()).collect();
            let ours = free.iter().sum::<f64>() / f64::from(n);
            let error = deviation * (2.0 / f64::from(n)).sqrt();
            assert!((ours - mean).abs() < 4.0 * error, "{size:?}: {ours} here, {mean} there");
            let spread = (free.iter().map(|x| (x - ours).powi(2)).sum::<f64>() / f64::from(n)).sqrt();
            assert!((spread / deviation - 1.0).abs() < 0.05, "{size:?}: {spread} here, {deviation} there");
        }
        let failed = (0..n).filter(|_| level([7, 7], 2, 23, GLANCE, &mut rng).is_none()).count();
        let (share, theirs) = (failed as f64 / f64::from(n), 0.3127);
        let error = (theirs * (1.0 - theirs) * (1.0 / 2808.0 + 1.0 / f64::from(n))).sqrt();
        assert!((share - theirs).abs() < 4.0 * error, "{share} of ours give no game, {theirs} there");
    }
}
