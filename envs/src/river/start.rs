//! How an episode begins.

use super::{
    BANK, CELLS, HEALTH, Kind, Map, Monster, Place, ROWS, Setting, State, dice::Dice,
    monsters::MONSTER_HEALTH,
};
use crate::{Rng, world::Draw};

/// Columns and rows where boulders lie at first. The last column is the river's first: what lies there lies in the water,
/// unseen, and is in the way all the same.
const STREWN: [std::ops::RangeInclusive<i8>; 2] = [1..=18, 1..=5];

impl State {
    /// As MiniHack has it: boulders anywhere where they are strewn, two on a cell too; the hero anywhere on the bank,
    /// on a boulder too. Monsters on what is free then of both banks.
    pub(super) fn drawn(setting: &Setting, draw: Draw) -> Self {
        let mut rng = draw.layout();
        let mut map = Map::new(setting.wide, setting.lava);
        for _ in 0..setting.boulders {
            let place = [between(&mut rng, &STREWN[0]), between(&mut rng, &STREWN[1])];
            map.add_boulder(Map::cell(place).expect("boulders are strewn on the map"));
        }
        let bank = [0..=BANK as i8 - 1, 0..=ROWS as i8 - 1];
        let hero = [between(&mut rng, &bank[0]), between(&mut rng, &bank[1])];
        let mut state = Self {
            map,
            hero,
            health: HEALTH,
            // The game counts its turns from 1, and a boulder as moved in turn 0.
            rested: 1,
            clock: 1,
            monsters: Vec::with_capacity(setting.monsters as usize),
            holder: None,
            filled: 0,
            lost: 0,
            log: Vec::with_capacity(MESSAGES),
            dice: draw.play(),
        };
        for _ in 0..setting.monsters {
            let free = |state: &Self, cell: usize| {
                let place = Map::place(cell);
                state.map.free(cell) && place != state.hero && state.monster_at(place).is_none()
            };
            // There is always room: 126 cells and more, 85 boulders and 32 monsters at most.
            let place = any(&mut rng, |cell| free(&state, cell)).expect("room for all monsters");
            let kind = any_kind(&mut rng);
            let health = 1 + rng.below(MONSTER_HEALTH) as u8;
            state.monsters.push(Monster { kind, place, health });
        }
        if let Some(mut rng) = draw.start() {
            let here = |cell: usize| {
                let place = Map::place(cell);
                usize::from(place[0].unsigned_abs()) < BANK
                    && state.map.free(cell)
                    && state.monster_at(place).is_none()
            };
            state.hero = any(&mut rng, here).unwrap_or(state.hero);
        }
        state
    }
}

/// Room for what is said in a turn of the worst kind, mostly.
const MESSAGES: usize = 32;

fn between(rng: &mut Rng, range: &std::ops::RangeInclusive<i8>) -> i8 {
    range.start() + rng.below((range.end() - range.start() + 1).unsigned_abs().into()) as i8
}

/// One of the cells for which that holds, all equally likely.
fn any(rng: &mut Rng, holds: impl Fn(usize) -> bool) -> Option<Place> {
    let count = (0..CELLS).filter(|&cell| holds(cell)).count() as u32;
    let nth = (count > 0).then(|| rng.below(count) as usize)?;
    (0..CELLS).filter(|&cell| holds(cell)).nth(nth).map(Map::place)
}

/// A kind of monster, each as likely as it is met in the peer.
fn any_kind(rng: &mut Rng) -> Kind {
    let all = Kind::ALL.iter().map(|kind| kind.nature().weight).sum();
    let mut left = rng.below(all);
    for kind in Kind::ALL {
        let weight = kind.nature().weight;
        if left < weight {
            return kind;
        }
        left -= weight;
    }
    Kind::Newt
}
