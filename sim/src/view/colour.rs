//! The colours of the domains, and how a colour becomes light and light a colour.
//!
//! Warm bodies before cool surroundings; the trail, the key and the goal are told apart from each other by
//! people with any colour vision (the first two are of Okabe and Ito, "Color Universal Design", 2008).

use rapier3d::math::Vector;

use super::Colour;

/// The trunk of a robot.
pub const TORSO: Colour = [222, 108, 48];
/// The limbs of a robot.
pub const LEG: Colour = [244, 174, 96];
/// The last limbs of a robot: feet, fingers.
pub const FOOT: Colour = [250, 206, 142];
/// Walls of a maze.
pub const WALL: Colour = [134, 148, 168];
/// A goal; the red of the figures under `docs/results`.
pub const GOAL: Colour = [214, 39, 40];
/// What must be fetched on the way to a goal.
pub const KEY: Colour = [230, 159, 0];
/// Where a body has been.
pub const TRAIL: Colour = [0, 114, 178];
/// Steel: the links of an arm.
pub const ARM: Colour = [226, 229, 234];
/// The joints of an arm.
pub const JOINT: Colour = [84, 96, 116];
/// What an arm moves: a door's panel, a lever, a carriage.
pub const OBJECT: Colour = [0, 140, 110];
/// Where it is to be gripped.
pub const HANDLE: Colour = [238, 200, 60];
/// A table, a frame, a base.
pub const FURNITURE: Colour = [170, 148, 124];

/// Amounts of red, green and blue light; 1 is what a white surface gives back in full light.
pub(super) type Light = Vector;

/// The light of a colour. A square is near enough to the standard's curve (IEC 61966-2-1) and exact everywhere.
pub(super) const fn light([red, green, blue]: Colour) -> Light {
    const fn part(byte: u8) -> f32 {
        (byte as f32 / 255.0) * (byte as f32 / 255.0)
    }
    Light::new(part(red), part(green), part(blue))
}

/// The colour of a light, the inverse of [`light`]; too much light is white, what is not a number is black.
pub(super) fn colour(light: Light) -> Colour {
    // The cast saturates, and takes what is not a number to 0.
    light.to_array().map(|part| (part.max(0.0).sqrt() * 255.0 + 0.5) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_survive_the_way_through_light() {
        for byte in 0..=255 {
            assert_eq!(colour(light([byte, 255 - byte, 7])), [byte, 255 - byte, 7]);
        }
        assert_eq!(colour(Light::new(9.0, -1.0, f32::NAN)), [255, 0, 0]);
    }
}
