//! What can be chosen about the game.

use super::player::PIXEL;
use crate::world::See;
use inroads_sim::raster::Format;

/// Which way the belts drift. The real game's are not known to us.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Belts {
    /// To the ladder's foot: who stands still is safe.
    #[default]
    Inward,
    /// Away from the ladder's foot: who stands still falls.
    Outward,
    /// Both to the left.
    Left,
    /// Both to the right.
    Right,
    /// Not at all.
    Still,
}

impl Belts {
    /// Drift of the left and the right belt, parts of a pixel a frame: half a pixel; positive is to the right.
    pub(super) fn drift(self) -> [i32; 2] {
        let half = PIXEL / 2;
        match self {
            Self::Inward => [half, -half],
            Self::Outward => [-half, half],
            Self::Left => [-half; 2],
            Self::Right => [half; 2],
            Self::Still => [0; 2],
        }
    }
}

/// What can be chosen about the game.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rules {
    /// Frames for which a choice is kept up, 1 to 16: no longer than from the key to any death, so that no last step of an
    /// episode that fails has the key's reward.
    pub repeat: u32,
    /// Lives, 1 to 9, the first included. The real game has 5 or 6, as one counts.
    pub lives: u8,
    /// Which way the belts drift.
    pub belts: Belts,
    /// Whether rewards are clipped to −1 … 1 (author).
    pub clip: bool,
    /// Whether a picture has, in each pixel, the brighter of the last two frames (usual with Atari games).
    pub pool: bool,
    /// How it is seen, unless somebody wants it otherwise.
    pub see: See,
}

impl Default for Rules {
    fn default() -> Self {
        Self { repeat: 4, lives: 5, belts: Belts::default(), clip: false, pool: false, see: See::Symbols }
    }
}

/// Rules that make no game.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RulesError {
    /// A decision takes no frame, or so many that a key and a death fit into it.
    #[error("repeat is {0}; a choice is kept up for 1 to 16 frames (the author has 4)")]
    Repeat(u32),
    /// No life, or more than the picture has room for.
    #[error("lives are {0}; there are 1 to 9 (the real game has 5 or 6)")]
    Lives(u8),
}

impl Rules {
    /// The author's settings (chapter 5): 84 × 84 grey, brighter of the last two frames, rewards clipped.
    pub const THESIS: Self = Self {
        repeat: 4,
        lives: 5,
        belts: Belts::Inward,
        clip: true,
        pool: true,
        see: See::Pixels(Format::ATARI),
    };

    pub(super) fn check(&self) -> Result<(), RulesError> {
        match (self.repeat, self.lives) {
            (repeat, _) if !(1..=16).contains(&repeat) => Err(RulesError::Repeat(repeat)),
            (_, lives) if !(1..=9).contains(&lives) => Err(RulesError::Lives(lives)),
            _ => Ok(()),
        }
    }

    /// What so many points pay.
    pub(super) fn pay(&self, points: f32) -> f32 {
        if self.clip { points.clamp(-1.0, 1.0) } else { points }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_that_make_no_game_are_refused_by_name() {
        let error = |rules: Rules| rules.check().unwrap_err().to_string();
        assert!(error(Rules { repeat: 0, ..Rules::default() }).contains("1 to 16"));
        assert!(error(Rules { lives: 10, ..Rules::default() }).contains("lives are 10"));
        assert!(Rules::THESIS.check().is_ok());
    }
}
