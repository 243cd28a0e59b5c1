//! Which river it is.

use super::{
    map::{BANK, COLUMNS},
    message::Text,
};

/// What can be chosen of a river.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Setting {
    /// Columns of the river, 1 to 6: MiniHack's narrow one has 2, the others 3.
    pub wide: usize,
    /// Whether all rows but two are of lava.
    pub lava: bool,
    /// Boulders, 0 to 85: MiniHack has 5.
    pub boulders: u32,
    /// Monsters, 0 to 32: MiniHack has none or 5.
    pub monsters: u32,
    /// How much of a turn's text the hero is told.
    pub text: Text,
}

impl Setting {
    /// MiniHack's River-Narrow.
    pub const NARROW: Self = Self { wide: 2, lava: false, boulders: 5, monsters: 0, text: Text::Whole };
    /// MiniHack's River.
    pub const WIDE: Self = Self { wide: 3, ..Self::NARROW };
    /// MiniHack's River-Lava.
    pub const LAVA: Self = Self { lava: true, ..Self::WIDE };

    /// The same with monsters.
    pub const fn monsters(self, monsters: u32) -> Self {
        Self { monsters, ..self }
    }

    pub(super) fn check(&self) -> Result<(), RiverError> {
        if !(1..=WIDEST).contains(&self.wide) {
            return Err(RiverError::Wide(self.wide));
        }
        if self.boulders > BOULDERS {
            return Err(RiverError::Boulders(self.boulders));
        }
        if self.monsters > MONSTERS {
            return Err(RiverError::Monsters(self.monsters));
        }
        Ok(())
    }
}

/// Columns of the widest river: the last column of the map is the goal's.
const WIDEST: usize = COLUMNS - 1 - BANK;
/// Most boulders: one for each cell of the bank where they may lie.
const BOULDERS: u32 = 85;
/// Most monsters.
const MONSTERS: u32 = 32;

/// A river that there cannot be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RiverError {
    /// Too wide or too narrow.
    #[error("a river of {0} columns does not fit between its banks; choose 1 to {WIDEST}")]
    Wide(usize),
    /// Too many boulders.
    #[error("{0} boulders are more than the bank has room for; choose at most {BOULDERS}")]
    Boulders(u32),
    /// Too many monsters.
    #[error("{0} monsters are too many; choose at most {MONSTERS}")]
    Monsters(u32),
}
