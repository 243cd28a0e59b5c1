//! The state as numbers.

use super::{BANK, CELLS, COLUMNS, Ground, HEALTH, Kind, Map, ROWS, Setting, State, WAYS};
use crate::world::{Card, Fact, See};
use crate::{Dimension, Kind as Line};

/// Names of the choices.
const ACTIONS: [&str; 8] = {
    let mut names = [""; 8];
    let mut way = 0;
    while way < names.len() {
        names[way] = WAYS[way].0;
        way += 1;
    }
    names
};

/// Where the two numbers are that count turns: since a push, and of the game.
pub(super) const CLOCKS: std::ops::Range<usize> = 3..5;

pub(super) fn card(setting: &Setting) -> Card {
    let dimension =
        |name: String, low, high| Dimension { name: name.into(), unit: "", low, high, kind: Line::Linear };
    let at = |what: &str, cell| {
        let [x, y] = Map::place(cell);
        format!("{what} {x},{y}")
    };
    let mut symbols = vec![
        Dimension::linear("x", "cells", 0.0, COLUMNS as f32 - 1.0),
        Dimension::linear("y", "cells", 0.0, ROWS as f32 - 1.0),
        Dimension::linear("health", "", 0.0, f32::from(HEALTH)),
        Dimension::linear("turns since a push", "turns", 0.0, f32::from(super::rules::RESTED)),
        Dimension::linear("clock", "turns", 0.0, f32::from(super::HEALING) - 1.0),
        Dimension::linear("held by", "", 0.0, setting.monsters as f32),
    ];
    symbols.extend(river(setting).map(|cell| dimension(at("ground", cell), 0.0, 2.0)));
    symbols.extend((0..CELLS).map(|cell| dimension(at("boulders", cell), 0.0, 1.0)));
    for monster in 1..=setting.monsters {
        symbols.extend([
            dimension(format!("monster {monster}"), 0.0, Kind::ALL.len() as f32),
            dimension(format!("monster {monster} x"), 0.0, COLUMNS as f32 - 1.0),
            dimension(format!("monster {monster} y"), 0.0, ROWS as f32 - 1.0),
            dimension(format!("monster {monster} health"), 0.0, super::monsters::MONSTER_HEALTH as f32),
        ]);
    }
    Card {
        name: "river",
        about: "A river to be crossed on boulders.",
        actions: &ACTIONS,
        symbols,
        place: vec![0, 1],
        limit: Some(super::LIMIT),
        success_reward: super::rules::WIN,
        layout: Default::default(),
        see: See::Symbols,
    }
}

/// The cells that are, or were, of the river, row by row.
fn river(setting: &Setting) -> impl Iterator<Item = usize> {
    let wide = setting.wide;
    (0..ROWS).flat_map(move |row| (0..wide).map(move |column| row * COLUMNS + BANK + column))
}

pub(super) fn write(setting: &Setting, state: &State, out: &mut Vec<f32>) {
    out.clear();
    let held = state.holder.map_or(0.0, |monster| monster as f32 + 1.0);
    let [x, y] = state.hero.map(f32::from);
    out.extend([x, y, f32::from(state.health), f32::from(state.rested), f32::from(state.clock), held]);
    out.extend(river(setting).map(|cell| match state.map.ground(cell) {
        Ground::Floor => 0.0,
        Ground::Water => 1.0,
        Ground::Lava => 2.0,
    }));
    out.extend((0..CELLS).map(|cell| f32::from(state.map.boulders(cell))));
    for monster in &state.monsters {
        let [x, y] = monster.place.map(f32::from);
        let all = [1.0 + f32::from(monster.kind as u8), x, y, f32::from(monster.health)];
        out.extend(if monster.health > 0 { all } else { [0.0; 4] });
    }
}

pub(super) fn facts(state: &State) -> Vec<Fact> {
    let [x, y] = state.hero.map(f32::from);
    let alive = state.monsters.iter().filter(|monster| monster.health > 0).count();
    vec![
        Fact::new("x", x),
        Fact::new("y", y),
        Fact::new("health", f32::from(state.health)),
        Fact::new("boulders", state.map.all_boulders() as f32),
        Fact::new("filled", state.filled as f32),
        Fact::new("lost", state.lost as f32),
        Fact::new("monsters", alive as f32),
    ]
}
