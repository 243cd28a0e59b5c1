//! One palette for curves and skills, and the greys around it.
//!
//! The colours are those of Okabe and Ito ("Color Universal Design", 2008), in an order that puts the strongest
//! contrasts first and yellow, which is weak on white, last.

const OKABE_ITO: [(u8, u8, u8); 7] = [
    (0, 114, 178),
    (230, 159, 0),
    (0, 158, 115),
    (204, 121, 167),
    (86, 180, 233),
    (213, 94, 0),
    (240, 228, 66),
];

/// The sheet.
pub(super) const WHITE: Colour = rgb(255, 255, 255);
/// Titles and labels.
pub(super) const INK: Colour = rgb(34, 34, 34);
/// Captions, ticks.
pub(super) const SOFT: Colour = rgb(95, 99, 104);
/// Grid lines.
pub(super) const GRID: Colour = rgb(230, 231, 233);
/// Walls of a maze.
pub(super) const WALL: Colour = rgb(163, 168, 175);
/// Free space of a maze.
pub(super) const FLOOR: Colour = rgb(241, 243, 246);
/// The goal.
pub(super) const GOAL: Colour = rgb(214, 39, 40);
/// Where a key lies: blue, as in figure 3.2.
pub(super) const KEY: Colour = rgb(31, 84, 196);

/// A colour; `alpha` is 1 for opaque, 0 for invisible.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Colour {
    pub(super) rgb: [u8; 3],
    pub(super) alpha: f32,
}

/// An opaque colour.
pub(super) const fn rgb(r: u8, g: u8, b: u8) -> Colour {
    Colour { rgb: [r, g, b], alpha: 1.0 }
}

/// The colour of a number: 0 is black, then seven that colour-blind readers can tell apart, then darker rounds of the
/// same seven.
pub(super) fn colour(index: usize) -> Colour {
    let Some(index) = index.checked_sub(1) else { return rgb(0, 0, 0) };
    let (r, g, b) = OKABE_ITO[index % OKABE_ITO.len()];
    let round = (index / OKABE_ITO.len()).min(3) as i32;
    let dark = 0.62_f32.powi(round);
    let part = |value: u8| (f32::from(value) * dark) as u8;
    rgb(part(r), part(g), part(b))
}

/// The same colour, see-through.
pub(super) fn faint(colour: Colour, alpha: f32) -> Colour {
    Colour { alpha, ..colour }
}

/// The colour of a share between 0 and 1: from pale over the palette's blue to dark, so that it is read in grey too.
pub(super) fn shade(part: f32) -> Colour {
    const STOPS: [[f32; 3]; 3] = [[226.0, 239.0, 248.0], [0.0, 114.0, 178.0], [4.0, 42.0, 84.0]];
    let along = part.clamp(0.0, 1.0) * 2.0;
    let stop = if along < 1.0 { 0 } else { 1 };
    let mix = |axis: usize| {
        let (low, high) = (STOPS[stop][axis], STOPS[stop + 1][axis]);
        (low + (high - low) * (along - stop as f32)).round() as u8
    };
    rgb(mix(0), mix(1), mix(2))
}

/// What a skill's number is called in legends: 0 is the global option, whose skills are primitive actions.
pub fn skill_name(skill: usize) -> String {
    match skill {
        0 => "global option (primitive actions)".to_owned(),
        _ => format!("skill {skill}"),
    }
}
