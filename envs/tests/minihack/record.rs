//! What is recorded of a step.

use inroads_envs::river::{Map, Place, Setting};
use serde_json::Value;

/// The map's first column and row on the screen.
pub(crate) const CORNER: Place = [26, 7];
pub(crate) const KEYS: [&str; 8] = ["k", "l", "j", "h", "u", "n", "b", "y"];
pub(crate) const LIMIT: usize = 350;

/// One recorded step.
pub(crate) struct Recorded {
    pub(crate) choice: usize,
    pub(crate) line: String,
    pub(crate) hero: Place,
    pub(crate) reward: f32,
    pub(crate) terminated: bool,
    pub(crate) truncated: bool,
    pub(crate) health: i64,
    /// None: the screen was cleared.
    pub(crate) cells: Option<Vec<(usize, char)>>,
}

pub(crate) fn number(value: &Value) -> i64 {
    value.as_i64().unwrap_or_else(|| panic!("{value} is no whole number"))
}

pub(crate) fn text(value: &Value) -> &str {
    value.as_str().unwrap_or_else(|| panic!("{value} is no text"))
}

pub(crate) fn list(value: &Value) -> &[Value] {
    value.as_array().unwrap_or_else(|| panic!("{value} is no list"))
}

/// A position on the screen as one on the map.
pub(crate) fn place(x: &Value, y: &Value) -> Place {
    [(number(x) as i8) - CORNER[0], (number(y) as i8) - CORNER[1]]
}

pub(crate) fn on_map(place: Place) -> usize {
    Map::cell(place).unwrap_or_else(|| panic!("{place:?} is not on the map"))
}

impl Recorded {
    pub(crate) fn read(step: &Value) -> Self {
        let fields = list(step);
        assert_eq!(fields.len(), 8, "a step has eight fields: {step}");
        let cell = |cell: &Value| {
            let shown = text(&cell[2]).chars().next().expect("a character");
            (on_map(place(&cell[0], &cell[1])), shown)
        };
        Self {
            choice: KEYS.iter().position(|&key| key == text(&fields[0])).expect("a key"),
            line: text(&fields[1]).to_owned(),
            hero: place(&fields[2][0], &fields[2][1]),
            reward: fields[3].as_f64().expect("a reward") as f32,
            terminated: number(&fields[4]) == 1,
            truncated: number(&fields[5]) == 1,
            health: number(&fields[6]),
            cells: fields[7].as_array().map(|cells| cells.iter().map(cell).collect()),
        }
    }
}

pub(crate) fn setting(name: &str) -> Setting {
    match name {
        "MiniHack-River-Narrow-v0" => Setting::NARROW,
        "MiniHack-River-v0" => Setting::WIDE,
        "MiniHack-River-Lava-v0" => Setting::LAVA,
        "MiniHack-River-Monster-v0" => Setting::WIDE.monsters(5),
        "MiniHack-River-MonsterLava-v0" => Setting::LAVA.monsters(5),
        other => panic!("no river of ours is {other}"),
    }
}
