//! The state as numbers.

use super::{
    kinds::Kind,
    world::{Baba, WAYS, WIN},
};
use crate::world::{Card, Fact, Layout, See};
use crate::{Dimension, Kind as Line};

/// Steps after which an episode is cut off: some six times the shortest solution of the U-maze, which has 31. The thesis'
/// limit is unknown.
const LIMIT: u32 = 200;
/// Names of the choices.
const ACTIONS: [&str; 4] = [WAYS[0].0, WAYS[1].0, WAYS[2].0, WAYS[3].0];

pub(super) fn card(baba: &Baba) -> Card {
    let [columns, rows] = baba.size();
    let mut symbols = vec![
        Dimension::linear("x", "cells", 0.0, columns as f32 - 1.0),
        Dimension::linear("y", "cells", 0.0, rows as f32 - 1.0),
    ];
    for kind in baba.kinds.iter() {
        // Row by row; without the cell's place, as a thousand names of their own would weigh more than the level.
        let each = Dimension { name: kind.name().into(), unit: "", low: 0.0, high: 1.0, kind: Line::Linear };
        symbols.extend(std::iter::repeat_n(each, columns * rows));
    }
    Card {
        name: "baba",
        about: "A level of Baba Is You.",
        actions: &ACTIONS,
        symbols,
        place: vec![0, 1],
        limit: Some(LIMIT),
        success_reward: WIN,
        layout: Layout::default(),
        see: See::Symbols,
    }
}

/// Where the first unit is that the player moves; (0, 0) when there is none.
fn you(baba: &Baba) -> [f32; 2] {
    let state = baba.state();
    let you = state.units.iter().find(|unit| state.rules.is_you(unit.kind));
    let cell = you.map_or(0, |unit| usize::from(unit.cell));
    [(cell % baba.size()[0]) as f32, (cell / baba.size()[0]) as f32]
}

/// How many units of each kind are in each cell.
pub(super) fn write(baba: &Baba, out: &mut Vec<f32>) {
    let cells = baba.level.cells();
    out.clear();
    out.extend(you(baba));
    out.resize(2 + baba.kinds.len() * cells, 0.0);
    for unit in &baba.state().units {
        if let Some(kind) = baba.kinds.iter().position(|kind| *kind == unit.kind) {
            out[2 + kind * cells + usize::from(unit.cell)] += 1.0;
        }
    }
}

pub(super) fn facts(baba: &Baba) -> Vec<Fact> {
    let [x, y] = you(baba);
    let rules = &baba.state().rules;
    let winnable = Kind::all().any(|kind| rules.is_win(kind));
    vec![
        Fact::new("x", x),
        Fact::new("y", y),
        Fact::new("rules", rules.count() as f32),
        Fact::new("something is WIN", if winnable { 1.0 } else { 0.0 }),
    ]
}
