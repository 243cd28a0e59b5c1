//! Units that move and are pushed.

use std::sync::Arc;

use rand::RngExt;

use super::{
    kinds::{Kind, Noun},
    level::Level,
    rules::{Rules, Unit},
    symbols,
};
use crate::world::{Card, Draw, Fact, ProtoGoals, World};
use crate::{Bits, End, Snapshot, Step};

/// What the player's choices are, and where they lead: columns and rows.
pub const WAYS: [(&str, [i8; 2]); 4] =
    [("up", [0, -1]), ("down", [0, 1]), ("left", [-1, 0]), ("right", [1, 0])];

/// Reward of winning. Nothing else pays.
pub(super) const WIN: f32 = 1.0;

/// A level, and how it stands.
#[derive(Clone, Debug)]
pub struct Baba {
    pub(super) level: Arc<Level>,
    /// Kinds of units that may occur, and those that goals speak of.
    pub(super) kinds: Arc<[Kind]>,
    pub(super) goal_kinds: Arc<[Kind]>,
    pub(super) state: State,
    /// Who moves in which order: scratch.
    order: Vec<usize>,
}

/// All that changes in an episode.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct State {
    /// All units, in the level's order.
    pub units: Vec<Unit>,
    /// The rules that hold.
    pub rules: Rules,
}

impl Baba {
    /// A level to be played.
    pub fn new(level: Level) -> Self {
        let (kinds, goal_kinds) = (level.kinds().into(), level.goal_kinds().into());
        let mut rules = Rules::default();
        rules.read(&level.units, level.size);
        let state = State { units: level.units.clone(), rules };
        Self { level: level.into(), kinds, goal_kinds, state, order: Vec::new() }
    }

    /// How it stands.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Columns and rows.
    pub fn size(&self) -> [usize; 2] {
        self.level.size
    }

    /// The cell beside another; none over the edge.
    fn beside(&self, cell: u16, [dx, dy]: [i8; 2]) -> Option<u16> {
        let [columns, rows] = self.level.size;
        let x = (usize::from(cell) % columns).checked_add_signed(dx.into()).filter(|&x| x < columns)?;
        let y = (usize::from(cell) / columns).checked_add_signed(dy.into()).filter(|&y| y < rows)?;
        Some((y * columns + x) as u16)
    }

    /// The last of the cells, from `cell` on, whose units move along when something enters; none when it cannot enter.
    fn enter(&self, mut cell: u16, way: [i8; 2]) -> Option<u16> {
        let State { units, rules } = &self.state;
        loop {
            let here = || units.iter().filter(|unit| unit.cell == cell);
            if here().any(|unit| rules.is_stop(unit.kind)) {
                return None;
            }
            if !here().any(|unit| rules.is_push(unit.kind)) {
                return Some(cell);
            }
            cell = self.beside(cell, way)?;
        }
    }

    /// Moves a unit, and pushes what is in its way; all or nothing.
    fn go(&mut self, unit: usize, way: [i8; 2]) {
        let from = self.state.units[unit].cell;
        let Some(to) = self.beside(from, way) else { return };
        let Some(mut last) = self.enter(to, way) else { return };
        let back = way.map(|step| -step);
        // The farthest is pushed first, so that nothing is pushed twice.
        while last != to {
            let Some(before) = self.beside(last, back) else { return };
            let State { units, rules } = &mut self.state;
            for pushed in units.iter_mut().filter(|unit| unit.cell == before && rules.is_push(unit.kind)) {
                pushed.cell = last;
            }
            last = before;
        }
        self.state.units[unit].cell = to;
    }

    /// Moves all that is YOU, those first that are farthest along the way.
    fn walk(&mut self, way: [i8; 2]) {
        let columns = self.level.size[0];
        let along = |cell: u16| {
            let [x, y] = [usize::from(cell) % columns, usize::from(cell) / columns];
            i32::from(way[0]) * x as i32 + i32::from(way[1]) * y as i32
        };
        let mut order = std::mem::take(&mut self.order);
        order.clear();
        let State { units, rules } = &self.state;
        order.extend((0..units.len()).filter(|&unit| rules.is_you(units[unit].kind)));
        order.sort_unstable_by_key(|&unit| (std::cmp::Reverse(along(units[unit].cell)), unit));
        order.iter().for_each(|&unit| self.go(unit, way));
        self.order = order;
    }

    /// Whether somebody who is YOU is where something is WIN.
    fn won(&self) -> bool {
        let State { units, rules } = &self.state;
        let you = units.iter().filter(|unit| rules.is_you(unit.kind));
        you.into_iter().any(|you| units.iter().any(|unit| unit.cell == you.cell && rules.is_win(unit.kind)))
    }
}

impl Snapshot for Baba {
    type State = State;

    fn save(&self) -> State {
        self.state.clone()
    }

    fn load(&mut self, state: &State) {
        self.state.clone_from(state);
    }
}

impl World for Baba {
    fn card(&self) -> Card {
        symbols::card(self)
    }

    fn begin(&mut self, draw: Draw) {
        self.state.units.clone_from(&self.level.units);
        self.state.rules.read(&self.state.units, self.level.size);
        if let Some(mut rng) = draw.start() {
            // The first that is YOU starts on any cell where nothing stops, is pushed, or wins.
            let State { units, rules } = &self.state;
            let taken = |kind| rules.is_stop(kind) || rules.is_push(kind) || rules.is_win(kind);
            let free = |cell: &u16| !units.iter().any(|unit| unit.cell == *cell && taken(unit.kind));
            let cells: Vec<u16> = (0..self.level.cells() as u16).filter(free).collect();
            let you = units.iter().position(|unit| rules.is_you(unit.kind));
            if let (Some(you), false) = (you, cells.is_empty()) {
                self.state.units[you].cell = cells[rng.random_range(0..cells.len())];
            }
        }
    }

    fn act(&mut self, choice: usize) -> Step {
        self.walk(WAYS[choice].1);
        let State { units, rules } = &mut self.state;
        rules.read(units, self.level.size);
        for unit in units.iter_mut() {
            if let Kind::Thing(noun) = unit.kind {
                unit.kind = Kind::Thing(rules.becomes(noun).unwrap_or(noun));
            }
        }
        if self.won() {
            return Step { reward: WIN, end: Some(End::Terminated) };
        }
        let State { units, rules } = &self.state;
        let lost = !units.iter().any(|unit| rules.is_you(unit.kind));
        Step { reward: 0.0, end: lost.then_some(End::Terminated) }
    }

    fn symbols(&self, out: &mut Vec<f32>) {
        symbols::write(self, out);
    }

    fn facts(&self) -> Vec<Fact> {
        symbols::facts(self)
    }
}

impl ProtoGoals for Baba {
    fn proto_goals(&self) -> Vec<String> {
        let place = |cell: usize| format!("{},{}", cell % self.level.size[0], cell / self.level.size[0]);
        let of = |kind: &Kind| {
            let name = kind.name();
            (0..self.level.cells()).map(move |cell| format!("{name} at {}", place(cell)))
        };
        self.goal_kinds.iter().flat_map(of).collect()
    }

    fn annotate(&self, out: &mut Bits) {
        let cells = self.level.cells();
        out.clear(self.goal_kinds.len() * cells);
        for unit in &self.state.units {
            if unit.kind == Kind::Thing(Noun::Hedge) {
                continue;
            }
            if let Some(kind) = self.goal_kinds.iter().position(|kind| *kind == unit.kind) {
                out.set(kind * cells + usize::from(unit.cell));
            }
        }
    }

    fn cell(&self, bit: usize) -> Option<[usize; 2]> {
        let [cell, width] = [bit % self.level.cells(), self.level.size[0]];
        Some([cell % width, cell / width])
    }
}
