//! Scaled pictures against Pillow and OpenCV (`support/raster_peers.py`), to the bit; parts against wholes.

#[path = "support/chance.rs"]
mod chance;

use chance::Chance;
use inroads_sim::raster::{Colour, Filter, Format, Frame, Scaler, Window};

const COLOURS: [Colour; 3] = [Colour::Rgb, Colour::Luma, Colour::Mean];
const FILTERS: [Filter; 3] = [Filter::Pillow, Filter::Area, Filter::Linear];

/// The noise of `raster_peers.py`.
fn noise([width, height]: [u32; 2]) -> Frame {
    let mut frame = Frame::new([width, height], 3);
    for (index, byte) in (0u64..).zip(frame.bytes_mut()) {
        let mut value = index.wrapping_mul(2_654_435_761).wrapping_add(u64::from(31 * width + height));
        value ^= value >> 13;
        value = value.wrapping_mul(0x9E37_79B1) & 0xFFFF_FFFF_FFFF;
        *byte = (value ^ value >> 17) as u8;
    }
    frame
}

fn run(native: &Frame, format: Format) -> (Scaler, Frame) {
    let (mut scaler, mut out) = (Scaler::new(native.size(), format), Frame::default());
    let mut next = 0;
    let row = |y, pixels: &mut [u8]| {
        assert!(y >= next, "rows come from the top, once each");
        next = y + 1;
        pixels.copy_from_slice(native.row(y));
    };
    scaler.run(row, &mut out);
    (scaler, out)
}

#[test]
fn scales_as_pillow_and_opencv_do() {
    let mut cases = 0;
    for line in include_str!("support/raster_scales.txt").lines() {
        let words: Vec<_> = line.split(' ').collect();
        let number = |word: usize| words[word].parse::<u32>().expect("a number");
        let filter = match words[4] {
            "pillow" => Filter::Pillow,
            "area" => Filter::Area,
            "linear" => Filter::Linear,
            other => panic!("{other}?"),
        };
        let native = noise([number(0), number(1)]);
        for (index, colour) in COLOURS.into_iter().enumerate() {
            let format = Format { colour, scale: Some(([number(2), number(3)], filter)) };
            let (_, out) = run(&native, format);
            let mut crc = flate2::Crc::new();
            crc.update(out.bytes());
            assert_eq!(crc.sum(), number(5 + index), "{line}: {colour:?}");
            cases += 1;
        }
    }
    assert!(cases >= 700);
}

/// Sizes of the picture and, if it is scaled, of the result.
fn shapes(chance: &mut Chance) -> ([u32; 2], Option<[u32; 2]>) {
    let mut pair = |bound| [0; 2].map(|one: u32| one + 1 + chance.below(bound) as u32);
    let (native, scaled) = (pair(90), pair(60));
    (native, (native[0] % 7 != 0).then_some(scaled))
}

fn window(chance: &mut Chance, [width, height]: [u32; 2]) -> Window {
    let mut range = |length: u32| {
        let [a, b] = [0; 2].map(|_: u32| chance.below(u64::from(length) + 1) as u32);
        a.min(b)..a.max(b)
    };
    Window::of(range(width), range(height))
}

/// A window drawn anew after its native pixels have changed; rows are asked for within what it says that it needs.
#[test]
fn parts_are_parts_of_the_whole() {
    let mut chance = Chance(2);
    for round in 0..600 {
        let (size, scaled) = shapes(&mut chance);
        let [colour, filter] = [3; 2].map(|kinds| chance.below(kinds) as usize);
        let format = Format { colour: COLOURS[colour], scale: scaled.map(|size| (size, FILTERS[filter])) };
        let what = format!("round {round}: {size:?} as {format:?}");
        let mut native = noise(size);
        let (scaler, mut out) = run(&native, format);

        let changed = window(&mut chance, size);
        for y in changed.rows() {
            let bytes = 3 * changed.from[0] as usize..3 * changed.to[0] as usize;
            native.row_mut(y)[bytes].iter_mut().for_each(|byte| *byte ^= 0xA5);
        }
        let (_, wanted) = run(&native, format);
        let window = scaler.touches(changed);
        let needed = scaler.needs(window);
        let mut next = 0;
        let row = |y, columns: std::ops::Range<u32>, pixels: &mut [u8]| {
            assert!(y >= next && needed.rows().contains(&y) && columns == needed.columns(), "{what}");
            next = y + 1;
            pixels.copy_from_slice(&native.row(y)[3 * columns.start as usize..3 * columns.end as usize]);
        };
        scaler.part(window, row, &mut out);
        assert!(out == wanted, "{what}: {changed:?} touches {window:?}");
    }
}

/// Pinball's ball on 500 × 500 pixels, worked out by hand: pixel `i` lies at 5.952 (i + ½) and reaches 5.952 to either side.
#[test]
fn windows_are_small() {
    let scaler = Scaler::new([500; 2], Format::THESIS);
    let touched = scaler.touches(Window { from: [240; 2], to: [260; 2] });
    assert_eq!(touched, Window { from: [39; 2], to: [45; 2] });
    assert_eq!(scaler.needs(touched), Window { from: [229; 2], to: [271; 2] });
}

#[test]
#[should_panic(expected = "another format")]
fn a_picture_of_another_format() {
    let scaler = Scaler::new([5; 2], Format::THESIS);
    scaler.part(Window { from: [0; 2], to: [1; 2] }, |_, _, _| {}, &mut Frame::new([84; 2], 1));
}
