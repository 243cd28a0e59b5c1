//! What worlds of cells and sprites cost: a step and the picture of what it led to.
//!
//! Whoever sees the picture reads all of it (a checksum), or it would not be one. Episodes begin anew when they are over,
//! each with a layout of its own, and that counts too: so it is for an agent.

use std::hint::black_box;

use inroads::{
    envs::{
        Domain, Frame, Rng, Seed, Space,
        registry::{self, AnyEnvironment, Options},
        world::See,
    },
    sim::raster::Format,
};
use rand::RngExt;

use crate::{measure::Measured, workload::Workload};

/// Choices that are drawn beforehand: drawing is not what is measured.
const CHOICES: usize = 4096;
/// Steps of a cycle: several episodes of the shorter kind.
const CYCLE: usize = 1024;
/// Episodes begun in a cycle, where beginning is what is measured.
const BEGINNINGS: usize = 64;
/// Simulator steps in a decision of pinball (Konidaris and Barto 2009).
const SUB_STEPS: usize = 20;

/// How the pictures of most are seen: as the thesis' author does in chapter 5, 84 × 84.
const GREY: (&str, Format) = ("84x84 grey", Format::THESIS_GREY);
/// As Atari agents see them, from which the thesis has its size.
const LUMA: (&str, Format) = ("84x84 luma", Format::ATARI);
/// As the author does in chapters 7 and 9.
const COLOUR: (&str, Format) = ("84x84 colour", Format::THESIS);

/// Which choices are made.
#[derive(Clone, Copy)]
enum Play {
    /// Any.
    Any,
    /// In the grids that one turns in, every other choice is a turn (0 or 1): one after which a whole cone of cells is
    /// lit anew, and others go dark.
    Turning,
}

/// What is looked at, by its name in the registry.
const PICTURES: [(&str, Play, (&str, Format)); 18] = [
    ("door-key-8x8", Play::Turning, GREY),
    ("door-key-8x8", Play::Turning, LUMA),
    ("door-key-8x8", Play::Turning, COLOUR),
    ("key-corridor-s3r3", Play::Turning, GREY),
    ("key-corridor-s3r3", Play::Turning, LUMA),
    ("key-corridor-s4r3", Play::Turning, GREY),
    ("key-corridor-s4r3", Play::Turning, LUMA),
    ("four-rooms", Play::Turning, GREY),
    ("sokoban", Play::Any, GREY),
    ("taxi", Play::Any, GREY),
    ("visual-taxi-5x5", Play::Any, GREY),
    ("visual-taxi-10x10", Play::Any, GREY),
    ("pinball", Play::Any, GREY),
    ("river", Play::Any, GREY),
    ("baba-u-maze", Play::Any, GREY),
    ("montezuma", Play::Any, LUMA),
    ("timer-grid", Play::Any, GREY),
    ("distractor-grid", Play::Any, GREY),
];

/// What is seen as symbols: worlds, and by how much a step counts.
const SYMBOLS: [(&str, Play, usize); 2] =
    [("door-key-8x8", Play::Turning, 1), ("pinball", Play::Any, SUB_STEPS)];

/// What takes long to begin.
const BEGUN: [&str; 3] = ["door-key-8x8", "key-corridor-s4r3", "sokoban"];

/// All workloads of worlds.
pub(crate) fn worlds() -> Vec<Workload> {
    let mut all = vec![copied(GREY), copied(COLOUR)];
    all.extend(PICTURES.into_iter().map(|(name, play, way)| pictures(name, play, way)));
    all.extend(SYMBOLS.into_iter().map(|(name, play, times)| symbols(name, play, times)));
    all.extend(BEGUN.into_iter().map(beginnings));
    all
}

/// Prints how many times the copy of its frame each world takes.
pub(crate) fn in_copies(all: &[Measured]) {
    for (way, _) in [GREY, COLOUR, LUMA] {
        // Both greys are as large.
        let copy = copy_name(if way == COLOUR.0 { way } else { GREY.0 });
        let Some(copy) = all.iter().find(|m| m.workload.name == copy) else { continue };
        for measured in all {
            let Some(name) = measured.workload.name.strip_suffix(&format!(", {way}")) else { continue };
            if name.starts_with("worlds/") {
                let times = measured.micros() / copy.micros();
                println!(
                    "{name}: a step with its picture takes {times:.1} times copying and reading it, {way}"
                );
            }
        }
    }
}

fn copy_name(way: &str) -> String {
    format!("raster/copy and read, {way}")
}

/// What no way of drawing can go below: a frame is copied and read.
fn copied((way, format): (&str, Format)) -> Workload {
    let mut frame = Frame::new(format.size([84, 84]), format.channels());
    frame.bytes_mut().iter_mut().zip(0..).for_each(|(byte, at): (_, usize)| *byte = at as u8);
    let mut copy = Frame::default();
    Workload::repeated(&copy_name(way), move || {
        copy.copy(black_box(&frame));
        black_box(checksum(black_box(&copy)));
    })
}

/// A world as pictures: step, observe, read; and reset when an episode is over.
fn pictures(name: &str, play: Play, (way, format): (&str, Format)) -> Workload {
    let AnyEnvironment::Frames(env) = made(name, See::Pixels(format)) else {
        unreachable!("`{name}` is seen as it was asked for")
    };
    let read = |frame: &Frame| black_box(checksum(frame));
    stepped(&format!("worlds/{name}, {way}"), env, play, Frame::default(), read)
}

/// A world as symbols, each of whose steps counts as so many.
fn symbols(name: &str, play: Play, times: usize) -> Workload {
    let AnyEnvironment::Choices(env) = made(name, See::Symbols) else {
        unreachable!("`{name}` is seen as it was asked for")
    };
    let what = if times == 1 { "symbols" } else { "sub-steps" };
    // Of bits: floats are added one after the other, which would take longer than to make them.
    let sum = |sum: u32, symbol: &f32| sum.wrapping_add(symbol.to_bits());
    let read = move |symbols: &Vec<f32>| black_box(symbols.iter().fold(0, sum));
    stepped(&format!("worlds/{name}, {what}"), env, play, Vec::new(), read).at_once(times, 1)
}

fn stepped<O: Clone + Default + 'static, T>(
    name: &str,
    env: Box<dyn Domain<O, usize>>,
    play: Play,
    seen: O,
    read: impl Fn(&O) -> T + 'static,
) -> Workload {
    let choices = choices(&env.spec().action, play);
    Workload::steps(
        name,
        CYCLE,
        (env, seen),
        |(env, _)| env.reset(0),
        move |(env, seen), at| {
            let step = env.step(&choices[at % CHOICES]).expect("the choice is legal");
            if step.end.is_some() {
                env.reset(1 + at as u64);
            }
            env.observe(seen);
            read(seen);
        },
    )
}

/// Beginning episodes, each with a layout of its own.
fn beginnings(name: &str) -> Workload {
    let AnyEnvironment::Choices(env) = made(name, See::Symbols) else {
        unreachable!("`{name}` is seen as it was asked for")
    };
    let begin = |env: &mut Box<dyn Domain<Vec<f32>, usize>>, at: usize| env.reset(black_box(at as u64));
    Workload::steps(&format!("worlds/{name}, reset"), BEGINNINGS, env, |_| {}, begin)
}

/// A world of the registry.
fn made(name: &str, see: See) -> AnyEnvironment {
    registry::make_with(name, &Options { see: Some(see), ..Options::default() })
        .expect("it is in the registry")
}

/// All of a picture, read.
fn checksum(frame: &Frame) -> u64 {
    let (words, rest) = frame.bytes().as_chunks::<8>();
    let words = words.iter().fold(0_u64, |sum, word| sum.wrapping_add(u64::from_le_bytes(*word)));
    rest.iter().fold(words, |sum, &byte| sum.wrapping_add(u64::from(byte)))
}

/// Random choices.
fn choices(space: &Space, play: Play) -> Vec<usize> {
    let Space::Discrete(count) = *space else { unreachable!("worlds have choices") };
    let mut rng = Seed(0).stream("bench", 0);
    let choose = |rng: &mut Rng| match play {
        Play::Turning if rng.random_bool(0.5) => rng.random_range(0..2),
        Play::Any | Play::Turning => rng.random_range(0..count),
    };
    (0..CHOICES).map(|_| choose(&mut rng)).collect()
}
