//! The search that makes a room from its solution: boxes stand on their targets, the player pulls them away, and the
//! position that is hardest to come from is where the game begins. Played backwards, the pulls solve it.
//!
//! What is searched, in which order and with which score is gym-sokoban's, to the state; how is ours. A state is one
//! number, changed by exclusive or as cells change, looked up in one table; the way back is undone rather than copied.

use super::{Cell, room::step};

/// How long rooms are searched for a start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Search {
    /// Most pulls and moves from the solved room, plus 2 (the original counts down from here to 0).
    pub depth: u32,
    /// Most positions looked at.
    pub states: u32,
}

impl Default for Search {
    /// gym-sokoban's.
    fn default() -> Self {
        Self { depth: 300, states: 300_000 }
    }
}

/// Where a game begins, and how it is won.
pub(super) struct Found {
    /// The player's cell.
    pub(super) player: usize,
    /// The boxes' cells, in the order of the targets that they came from.
    pub(super) boxes: Vec<usize>,
    /// Pulls × the sum of the boxes' distances from their targets; above 0.
    pub(super) score: u64,
    /// Actions that solve it.
    pub(super) solution: Vec<u8>,
}

/// Searches backwards from the solved room: `cells` holds walls, floor and targets, `player` where the player ends.
/// None when every position has a box or the player on a target, or nothing can be pulled.
pub(super) fn search(cells: &[Cell], columns: usize, player: usize, budget: Search) -> Option<Found> {
    let mut search = Backwards::new(cells, columns, player);
    search.run(budget);
    search.best
}

/// One step of the way from the solved room to the present position.
struct Done {
    /// Where the player was.
    from: usize,
    /// The box that was pulled, and whether it was the first time.
    pulled: Option<(usize, bool)>,
    /// The position that the step led to.
    hash: u64,
    /// The next of eight actions to be tried there: pulls up, down, left, right, then moves.
    next: u8,
    /// What it did, one of the eight.
    action: u8,
    /// Pulls so far.
    pulls: u32,
}

struct Backwards<'a> {
    cells: &'a [Cell],
    columns: usize,
    player: usize,
    /// The box in each cell, counted from 1.
    at: Vec<u8>,
    boxes: Vec<usize>,
    targets: Vec<usize>,
    /// Whether a box has been pulled. The original tells boxes that were from boxes that were not, and so positions.
    touched: Vec<bool>,
    /// Targets with a box.
    covered: u32,
    /// The sum of Manhattan distances from boxes to their targets.
    distance: u32,
    way: Vec<Done>,
    seen: Seen,
    best: Option<Found>,
}

/// Most boxes that the search tells apart.
pub(super) const MOST_BOXES: usize = u8::MAX as usize;

impl<'a> Backwards<'a> {
    fn new(cells: &'a [Cell], columns: usize, player: usize) -> Self {
        let targets: Vec<usize> = (0..cells.len()).filter(|&at| cells[at].is_target()).collect();
        let mut at = vec![0; cells.len()];
        for (number, &target) in (1..).zip(&targets) {
            at[target] = number;
        }
        Self {
            cells,
            columns,
            player,
            at,
            boxes: targets.clone(),
            touched: vec![false; targets.len()],
            covered: targets.len() as u32,
            distance: 0,
            targets,
            way: Vec::new(),
            seen: Seen::new(),
            best: None,
        }
    }

    fn run(&mut self, budget: Search) {
        let hash = self.boxes.iter().fold(key(PLAYER, self.player), |hash, &at| hash ^ key(RESTING, at));
        self.seen.insert(hash);
        self.way.push(Done { from: self.player, pulled: None, hash, next: 0, action: 0, pulls: 0 });
        while let Some(here) = self.way.last_mut() {
            let action = here.next;
            here.next += 1;
            if action == 8 {
                self.undo();
                continue;
            }
            // The original looks at its budget before it looks at the position.
            if self.way.len() as u32 + 2 > budget.depth || self.seen.len >= budget.states {
                continue;
            }
            self.attempt(action);
        }
    }

    /// Goes to the position behind an action, unless it has been seen.
    fn attempt(&mut self, action: u8) {
        let direction = usize::from(action % 4);
        let (from, to) = (self.player, step(self.player, direction, self.columns));
        if self.cells[to] == Cell::Wall || self.at[to] != 0 {
            return;
        }
        let behind = step(from, direction ^ 1, self.columns);
        let number = self.at[behind];
        if action >= 4 && number == 0 {
            return; // The pull with nothing to pull was this move.
        }
        let here = self.way.last().expect("the way begins at the solved room");
        let mut hash = here.hash ^ key(PLAYER, from) ^ key(PLAYER, to);
        let mut pulled = None;
        if action < 4 && number != 0 {
            let moved = usize::from(number) - 1;
            let first = !self.touched[moved];
            hash ^= key(if first { RESTING } else { PULLED }, behind) ^ key(PULLED, from);
            pulled = Some((moved, first));
        }
        if !self.seen.insert(hash) {
            return;
        }
        let pulls = here.pulls + u32::from(pulled.is_some());
        self.way.push(Done { from, pulled, hash, next: 0, action, pulls });
        self.player = to;
        if let Some((moved, _)) = pulled {
            self.touched[moved] = true;
            self.shift(moved, behind, from);
        }
        self.judge(pulls);
    }

    /// Goes back one step.
    fn undo(&mut self) {
        let Some(done) = self.way.pop() else { return };
        if let Some((moved, first)) = done.pulled {
            let direction = usize::from(done.action % 4);
            self.touched[moved] = !first;
            self.shift(moved, done.from, step(done.from, direction ^ 1, self.columns));
        }
        self.player = done.from;
    }

    /// A box goes from one cell to another.
    fn shift(&mut self, moved: usize, from: usize, to: usize) {
        let covers = |at: usize| u32::from(self.cells[at].is_target());
        self.covered = self.covered + covers(to) - covers(from);
        self.distance = self.distance + self.apart(moved, to) - self.apart(moved, from);
        self.at[from] = 0;
        self.at[to] = moved as u8 + 1;
        self.boxes[moved] = to;
    }

    /// How far a cell is from a box's target.
    fn apart(&self, moved: usize, at: usize) -> u32 {
        let place = |at: usize| [at / self.columns, at % self.columns];
        let [a, b] = [place(at), place(self.targets[moved])];
        (a[0].abs_diff(b[0]) + a[1].abs_diff(b[1])) as u32
    }

    /// Keeps the position if it beats the best so far.
    fn judge(&mut self, pulls: u32) {
        let score = u64::from(pulls) * u64::from(self.distance);
        let open = self.covered == 0 && !self.cells[self.player].is_target();
        if !open || score <= self.best.as_ref().map_or(0, |best| best.score) {
            return;
        }
        // A pull up is undone by a push down; pulls and pushes, up and down, left and right are neighbours in number.
        let forwards = |done: &Done| {
            let back = (done.action % 4) ^ 1;
            back + if done.pulled.is_some() { 1 } else { 5 }
        };
        let best = self.best.get_or_insert_with(|| Found {
            player: 0,
            boxes: Vec::new(),
            score: 0,
            solution: Vec::new(),
        });
        (best.player, best.score) = (self.player, score);
        best.boxes.clone_from(&self.boxes);
        best.solution.clear();
        best.solution.extend(self.way[1..].iter().rev().map(forwards));
    }
}

const PLAYER: u64 = 0;
const RESTING: u64 = 1;
const PULLED: u64 = 2;

/// A random number for a thing in a cell (Zobrist 1970): SplitMix64's finaliser (Steele, Lea, Flood 2014) of both.
///
/// Two positions that share a number would be taken for one, once in 10^9 rooms; the room is solvable even so.
fn key(thing: u64, at: usize) -> u64 {
    let x = (at as u64 * 3 + thing + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// A set of numbers, by open addressing; 0 marks an empty place.
struct Seen {
    places: Vec<u64>,
    len: u32,
}

impl Seen {
    fn new() -> Self {
        // Growing fourfold, it ends with half a million places, 4 MiB, for the 300,000 that gym-sokoban allows.
        Self { places: vec![0; 1 << 13], len: 0 }
    }

    /// Takes a number in; says whether it was new.
    fn insert(&mut self, number: u64) -> bool {
        let number = number.max(1);
        if self.len as usize >= self.places.len() / 8 * 5 {
            self.grow();
        }
        let place = self.place(number);
        let new = self.places[place] == 0;
        self.places[place] = number;
        self.len += u32::from(new);
        new
    }

    /// Where the number is, or would be.
    fn place(&self, number: u64) -> usize {
        let mask = self.places.len() - 1;
        let mut place = number as usize & mask;
        while self.places[place] != 0 && self.places[place] != number {
            place = (place + 1) & mask;
        }
        place
    }

    fn grow(&mut self) {
        let old = std::mem::take(&mut self.places);
        self.places = vec![0; old.len() * 4];
        for number in old.into_iter().filter(|&number| number != 0) {
            let place = self.place(number);
            self.places[place] = number;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_corridor_has_one_start() {
        // # . @ _ _ #: the box can be pulled right three times, the last position being the best.
        let row = |cells: &[Cell]| cells.to_vec();
        let wall = [Cell::Wall; 7];
        let floor = Cell::Floor;
        let middle = [Cell::Wall, Cell::Target, floor, floor, floor, floor, Cell::Wall];
        let cells = [row(&wall), row(&middle), row(&wall)].concat();
        let found = search(&cells, 7, 9, Search::default()).expect("something can be pulled");
        assert_eq!((found.player, found.boxes, found.score), (12, vec![11], 9));
        assert_eq!(found.solution, [3, 3, 3]);
    }

    #[test]
    fn what_cannot_be_pulled_has_no_start() {
        let cells = [[Cell::Wall; 4], [Cell::Wall, Cell::Target, Cell::Floor, Cell::Wall], [Cell::Wall; 4]];
        assert!(search(&cells.concat(), 4, 6, Search::default()).is_none());
    }

    /// Solved rooms, what gym-sokoban's own search makes of them, and how many positions it looked at: to the position,
    /// to the box, to the tie; one is left unfinished after 300,000 positions.
    #[test]
    fn reverse_play_ends_where_gym_sokobans_ends() {
        let records = include_str!("../../../tests/fixtures/sokoban/reverse_play.jsonl");
        for record in records.lines() {
            let record: serde_json::Value = serde_json::from_str(record).unwrap();
            let what = format!("room {}", record["seed"]);
            let rows: Vec<String> = serde_json::from_value(record["room"].clone()).unwrap();
            let columns = rows[0].len();
            let codes: Vec<u8> = rows.concat().bytes().map(|digit| digit - b'0').collect();
            let player = codes.iter().position(|&code| code == 5).unwrap();
            let ground = |code: &u8| [Cell::Wall, Cell::Floor, Cell::Target][usize::from(*code % 4)];
            let cells: Vec<Cell> = codes.iter().map(ground).collect();
            let mut search = Backwards::new(&cells, columns, player);
            search.run(Search::default());
            assert_eq!(u64::from(search.seen.len), record["explored"].as_u64().unwrap(), "{what}");
            let score = search.best.as_ref().map_or(0, |best| best.score);
            assert_eq!(score, record["score"].as_u64().unwrap(), "{what}");
            let Some(best) = search.best else { continue };
            let place = |at: usize| [at / columns, at % columns];
            assert_eq!(serde_json::json!(place(best.player)), record["player"], "{what}");
            let pairs =
                search.targets.iter().zip(&best.boxes).map(|(&target, &at)| [place(target), place(at)]);
            assert_eq!(serde_json::json!(pairs.collect::<Vec<_>>()), record["target_to_box"], "{what}");
        }
    }

    #[test]
    fn a_set_holds_what_was_taken_in() {
        let mut seen = Seen::new();
        let numbers: Vec<u64> = (0..40_000).map(|at| key(PLAYER, at)).collect();
        assert!(numbers.iter().all(|&number| seen.insert(number)));
        assert!(!numbers.iter().any(|&number| seen.insert(number)));
        assert_eq!(seen.len, 40_000);
    }
}
