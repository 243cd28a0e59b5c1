//! The skull.

use super::player::PIXEL;
use super::screen::{Area, SKULL, SKULL_RANGE, SKULL_START, SKULL_Y};

/// How fast it rolls, parts of a pixel a frame: 0.75 pixels (invented). There and back takes 160 frames.
pub const ROLL: i32 = 192;

/// Pixels at each edge of player and skull that do not count when they meet: their corners are round (invented).
const ROUND: i32 = 1;

/// A skull that rolls on the floor, to and fro.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Skull {
    /// Left edge, in parts of a pixel.
    pub x: i32,
    /// Whether it rolls to the left.
    pub left: bool,
}

impl Skull {
    /// Where it is when a game begins; that it rolls to the left then is invented.
    pub const START: Self = Self { x: SKULL_START * PIXEL, left: true };

    /// At the turning point that is further from column `x`, about to leave it.
    pub fn far_from(x: i32) -> Self {
        let [low, high] = SKULL_RANGE;
        let left = 2 * x < low + high;
        Self { x: if left { high } else { low } * PIXEL, left }
    }

    /// The next frame.
    pub(super) fn frame(&mut self) {
        let [low, high] = SKULL_RANGE.map(|x| x * PIXEL);
        self.x = (self.x + if self.left { -ROLL } else { ROLL }).clamp(low, high);
        match self.x {
            x if x == low => self.left = false,
            x if x == high => self.left = true,
            _ => {}
        }
    }

    /// The pixels that it covers.
    pub fn area(&self) -> Area {
        Area::new(self.x.div_euclid(PIXEL), SKULL_Y, SKULL[0], SKULL[1])
    }

    /// Whether it touches a player who covers these pixels.
    pub fn touches(&self, player: &Area) -> bool {
        let inner = |a: &Area| Area::new(a.x + ROUND, a.y + ROUND, a.width - 2 * ROUND, a.height - 2 * ROUND);
        inner(&self.area()).meets(&inner(player))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_rolls_between_its_turning_points_for_ever() {
        let [low, high] = SKULL_RANGE;
        let mut skull = Skull::far_from(low);
        assert_eq!((skull.area().x, skull.left), (high, true));
        let first = skull;
        for frame in 0..160 {
            assert!(frame == 0 || skull != first, "back after {frame} frames");
            skull.frame();
            assert!((low..=high).contains(&skull.area().x));
        }
        assert_eq!(skull, first);
    }

    #[test]
    fn corners_do_not_count() {
        let skull = Skull { x: 60 * PIXEL, left: true };
        let touched = |x, y| skull.touches(&Area::new(x, y, 8, 20));
        assert!(touched(55, 160) && !touched(54, 160) && touched(64, 160) && !touched(65, 160));
        assert!(touched(60, 149) && !touched(60, 148));
    }
}
