//! Rivers to be crossed on boulders (thesis section 8.5.3): MiniHack's River levels, by NetHack's rules.
//!
//! What NetHack does by chance happens by chance here, with its odds, and what it says of it is said here, word for
//! word. The monsters' ways are invented: see `docs/environments/river.md`.

mod dice;
mod kinds;
mod map;
mod message;
mod monsters;
mod paint;
mod rules;
mod setting;
mod start;
mod symbols;

use std::sync::Arc;

pub use dice::Dice;
pub use kinds::{Kind, Nature};
pub use map::{BANK, CELLS, COLUMNS, GOAL, Ground, Map, Place, ROWS, WAYS};
pub use message::{Attack, Blow, Liquid, Message, Text, last_line, vocabulary, words};
pub use monsters::Monster;
pub use paint::Tiles;
pub use rules::Turn;
pub use setting::{RiverError, Setting};

use crate::registry::{Entry, Make};
use crate::world::{Card, Draw, Fact, Grain, Layout, ProtoGoals, World};
use crate::{Bits, Rng, Snapshot, Step};
use dice::EveryThrow;

/// The hero's health at first, and at most: a rogue's.
pub const HEALTH: u8 = 12;
/// Turns after which a point of health comes back, at the first experience level.
const HEALING: u8 = 15;
/// Steps after which MiniHack cuts an episode off.
const LIMIT: u32 = 350;

/// A river, and the hero who is to cross it.
#[derive(Clone, Debug)]
pub struct River {
    setting: Setting,
    /// All words of all messages, sorted.
    words: Arc<[String]>,
    state: State,
}

/// All that changes in an episode.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Ground and boulders.
    pub map: Map,
    /// Where the hero is.
    pub hero: Place,
    /// What he can still suffer, at most [`HEALTH`].
    pub health: u8,
    /// Turns since he last moved a boulder, at most 3: then he remarks on the next.
    pub rested: u8,
    /// Turns of the game, from 1, modulo 15: when it becomes 0, a point of health comes back.
    pub clock: u8,
    /// The monsters, the dead ones too.
    pub monsters: Vec<Monster>,
    /// Which of them holds him.
    pub holder: Option<usize>,
    /// Boulders that have become floor.
    pub filled: u32,
    /// Boulders that have sunk in vain.
    pub lost: u32,
    /// What was said in the last turn.
    log: Vec<Message>,
    dice: Rng,
}

impl State {
    /// What was said in the last turn, all of it.
    pub fn log(&self) -> &[Message] {
        &self.log
    }

    /// A turn of the game is over.
    pub fn pass(&mut self) {
        self.rested = (self.rested + 1).min(rules::RESTED);
        self.clock = (self.clock + 1) % HEALING;
        if self.clock == 0 {
            self.health = (self.health + 1).min(HEALTH);
        }
    }
}

/// What the hero's part of a turn can come to.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// How likely it is.
    pub chance: f64,
    /// Whether time passes, or the episode is over.
    pub turn: Turn,
    /// What is then.
    pub state: State,
}

impl River {
    /// A river.
    ///
    /// # Errors
    /// [`RiverError`] names the number that does not fit, and those that do.
    pub fn new(setting: Setting) -> Result<Self, RiverError> {
        setting.check()?;
        let state = State::drawn(&setting, Layout::default().draw(0));
        Ok(Self { setting, words: vocabulary().into(), state })
    }

    /// What was chosen of it.
    pub fn setting(&self) -> &Setting {
        &self.setting
    }

    /// What is.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// What the hero was told of the last turn: all that was said, or as much as [`Setting::text`] has it.
    pub fn heard(&self) -> &[Message] {
        let log = &self.state.log;
        match self.setting.text {
            Text::Whole => log,
            Text::LastLine => &log[last_line(log.iter().map(|message| message.text()))],
        }
    }

    /// Everything that the hero's part of a turn can come to, with what is likely; the monsters stay as they are.
    ///
    /// # Panics
    /// When there is no such choice.
    pub fn outcomes(&self, choice: usize) -> Vec<Outcome> {
        let mut dice = EveryThrow::default();
        let mut outcomes = Vec::new();
        loop {
            let mut state = self.state.clone();
            state.log.clear();
            let turn = state.hero_acts(WAYS[choice].1, &mut dice);
            outcomes.push(Outcome { chance: dice.chance(), turn, state });
            if !dice.advance() {
                return outcomes;
            }
        }
    }
}

impl Snapshot for River {
    type State = State;

    fn save(&self) -> State {
        self.state.clone()
    }

    fn load(&mut self, state: &State) {
        self.state.clone_from(state);
    }
}

impl World for River {
    fn card(&self) -> Card {
        symbols::card(&self.setting)
    }

    fn begin(&mut self, draw: Draw) {
        self.state = State::drawn(&self.setting, draw);
    }

    fn act(&mut self, choice: usize) -> Step {
        let state = &mut self.state;
        state.log.clear();
        // The generator is put back: it is part of the state, and the rules borrow both.
        let mut dice = state.dice.clone();
        let mut turn = state.hero_acts(WAYS[choice].1, &mut dice);
        if turn == Turn::Passed {
            match state.monsters_act(&mut dice) {
                true => state.pass(),
                false => turn = Turn::Dead,
            }
        }
        state.dice = dice;
        turn.step()
    }

    fn symbols(&self, out: &mut Vec<f32>) {
        symbols::write(&self.setting, &self.state, out);
    }

    /// All but when he last moved a boulder, which decides on a remark only, and the clock. Without monsters nothing hurts
    /// the hero and leaves him alive, so that it does not matter either when health comes back; with them it does.
    fn landmark(&self, out: &mut Vec<f32>) -> Grain {
        self.symbols(out);
        out.drain(symbols::CLOCKS);
        if self.setting.monsters == 0 { Grain::Exact } else { Grain::Coarse }
    }

    /// What was heard of the last turn.
    fn told(&self) -> Option<String> {
        let said: Vec<_> = self.heard().iter().map(|message| message.text()).collect();
        (!said.is_empty()).then(|| said.join("  "))
    }

    fn facts(&self) -> Vec<Fact> {
        symbols::facts(&self.state)
    }
}

impl ProtoGoals for River {
    fn proto_goals(&self) -> Vec<String> {
        self.words.to_vec()
    }

    fn annotate(&self, out: &mut Bits) {
        out.clear(self.words.len());
        for word in self.heard().iter().flat_map(|message| words(message.text())) {
            let letters = || word.bytes().map(|letter| letter.to_ascii_lowercase());
            if let Ok(bit) = self.words.binary_search_by(|known| known.bytes().cmp(letters())) {
                out.set(bit);
            }
        }
    }
}

/// A river of the registry.
macro_rules! entry {
    ($name:literal, $about:literal, $setting:expr) => {
        Entry {
            name: $name,
            about: $about,
            make: Make::Annotated(|| Box::new(River::new($setting).expect("the registry's rivers fit"))),
        }
    };
}

/// The worlds of the registry.
pub(crate) const ENTRIES: &[Entry] = &[
    entry!(
        "river-narrow",
        "Push a boulder into a river, cross it, and find the stairs (thesis 8.5.3).",
        Setting::NARROW
    ),
    entry!("river", "The same with a river 3 cells wide: two boulders, and some luck.", Setting::WIDE),
    entry!(
        "river-lava",
        "The wide river with lava, which kills, and swallows most boulders (thesis 8.5.3).",
        Setting::LAVA
    ),
    entry!("river-monster", "The wide river with five monsters on its banks.", Setting::WIDE.monsters(5)),
    entry!("river-monster-lava", "The wide river with lava and five monsters.", Setting::LAVA.monsters(5)),
    entry!("river-narrow-monsters-1", "The narrow river with one monster.", Setting::NARROW.monsters(1)),
    entry!("river-narrow-monsters-2", "The narrow river with two monsters.", Setting::NARROW.monsters(2)),
    entry!("river-narrow-monsters-3", "The narrow river with three monsters.", Setting::NARROW.monsters(3)),
    entry!("river-narrow-monsters-4", "The narrow river with four monsters.", Setting::NARROW.monsters(4)),
    entry!(
        "river-narrow-monsters",
        "The narrow river with five monsters (thesis figure 8.5).",
        Setting::NARROW.monsters(5)
    ),
];
