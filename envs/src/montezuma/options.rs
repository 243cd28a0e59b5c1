//! What the thesis' options aim at on this screen, and the states that they are asked to start from.

/// A place or a deed that an option aims at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Target {
    /// Its name.
    pub name: &'static str,
    /// What is to be attained.
    pub goal: Goal,
}

/// What is to be attained.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Goal {
    /// To be at this place, x and y as in the game's memory, give or take [`TOLERANCE`].
    Place([i32; 2]),
    /// To have had the key.
    Key,
}

/// How far from a place one may be along each axis, pixels (author's code).
pub const TOLERANCE: i32 = 2;

impl Target {
    /// Whether a player at this place, x and y as in the game's memory, who has had the key or not, has attained it.
    pub fn attains(&self, [x, y]: [i32; 2], key: bool) -> bool {
        match self.goal {
            Goal::Place(at) => (x - at[0]).abs() <= TOLERANCE && (y - at[1]).abs() <= TOLERANCE,
            Goal::Key => key,
        }
    }
}

const fn place(name: &'static str, x: i32, y: i32) -> Target {
    Target { name, goal: Goal::Place([x, y]) }
}

/// The targets. The first [`THESIS`] are those of the thesis (section 5.2.1); the others are further ones of the author's
/// code. All places are the code's.
pub const TARGETS: [Target; 7] = [
    place("left door", 24, 235),
    place("right door", 130, 235),
    place("bottom right", 123, 148),
    place("bottom left", 23, 148),
    Target { name: "key", goal: Goal::Key },
    place("foot of the middle ladder", 77, 192),
    place("top of the right ladder", 132, 192),
];

/// How many of [`TARGETS`] the thesis names.
pub const THESIS: usize = 5;

/// The starts: 100 places of the player, x and y as in the game's memory.
///
/// The thesis has "100 states scattered across the first screen" and does not list them. Of these, 82 are places that the
/// author's public code resets the real game to (28 of its exploration code, and of its initiation experiment those that
/// no closed door makes illegal here; two are moved by a pixel, out of the doors); the last 18 are ours, between theirs.
#[rustfmt::skip]
pub const STARTS: [[i32; 2]; 100] = [
    // Upper platforms: left, middle (one in the air above it), right.
    [25, 235], [26, 235], [30, 235], [34, 235], [38, 235], [42, 235], [46, 235], [50, 235],
    [69, 235], [73, 235], [77, 235], [81, 235], [85, 235], [88, 235], [77, 250],
    [104, 235], [108, 235], [112, 235], [116, 235], [120, 235], [124, 235], [128, 235], [129, 235],
    // Middle ladder, and what is at its foot.
    [77, 233], [77, 229], [77, 225], [77, 221], [77, 217], [77, 215], [77, 213], [77, 209], [77, 205], [77, 201],
    [74, 192], [75, 192], [80, 192], [84, 192], [86, 192], [88, 192],
    // Rope.
    [109, 192], [109, 199],
    // Middle platforms: right, left.
    [125, 192], [129, 192], [132, 192], [133, 192], [138, 192], [139, 192],
    [10, 192], [13, 192], [17, 192], [21, 192],
    // Right ladder.
    [133, 185], [133, 181], [133, 177], [133, 173], [133, 169], [133, 165], [133, 162], [133, 161], [133, 157], [133, 151],
    // Floor.
    [133, 148], [123, 148], [114, 148], [99, 148], [75, 148], [62, 148], [50, 148], [38, 148], [29, 148], [25, 148],
    [21, 148], [20, 148],
    // Left ladder.
    [21, 152], [21, 156], [21, 160], [21, 164], [21, 168], [21, 172], [21, 176], [21, 177], [21, 180],
    // Ours.
    [109, 203], [109, 207], [109, 211], [107, 148], [91, 148], [83, 148], [69, 148], [56, 148], [44, 148], [33, 148],
    [77, 197], [21, 184], [21, 188], [133, 189], [142, 192], [25, 192], [29, 192], [66, 192],
];

#[cfg(test)]
mod tests {
    use super::super::player::{Hold, Player};
    use super::super::screen::{DOORS, WALLS, from_ram};
    use super::*;

    #[test]
    fn starts_are_a_hundred_legal_places() {
        for (number, &start) in STARTS.iter().enumerate() {
            assert!(!STARTS[..number].contains(&start), "{start:?} twice");
            let player = Player::at(from_ram(start));
            assert_eq!(player.ram(), start);
            assert!(WALLS.iter().chain(&DOORS).all(|solid| !solid.meets(&player.area())), "{start:?}");
            assert_eq!(player.hold == Hold::Air, start == [77, 250], "{start:?}: {player:?}");
        }
    }

    #[test]
    fn a_place_is_attained_within_two_pixels_along_each_axis() {
        let door = &TARGETS[0];
        for (at, attained) in [([24, 235], true), ([26, 233], true), ([27, 235], false), ([24, 232], false)] {
            assert_eq!(door.attains(at, false), attained, "{at:?}");
        }
        let key = TARGETS.iter().find(|target| target.goal == Goal::Key).unwrap();
        assert!(key.attains([0, 0], true) && !key.attains([16, 192], false));
    }
}
