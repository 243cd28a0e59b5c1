//! How long pictures take; looked at, not judged: `cargo test --release -p inroads-sim --test raster_speed -- --ignored
//! --nocapture`. Each time also as a multiple of copying the frame, which every reader of it pays, too.

#[path = "support/chance.rs"]
mod chance;

use std::{hint::black_box, io::Write, time::Instant};

use chance::Chance;
use inroads_sim::raster::{Colour, Filter, Format, Frame, Mosaic, Scaler, Stencil, Window};

/// What somebody sees who walks about a walled grid, turning three times out of four, with the 7 × 7 cells ahead lit.
fn walk(cells: i32, steps: usize) -> Vec<Vec<u16>> {
    let wall = |x: i32, y: i32| {
        let crossing = cells > 12 && y == cells / 2 - 1 && x % 5 != 2;
        [x, y].iter().any(|&at| at == 0 || at == cells - 1)
            || (x == cells / 2 - 1 && y != cells / 3)
            || crossing
    };
    let (mut chance, mut heading) = (Chance(3), 0);
    let [mut x, mut y] = [cells / 2; 2];
    let step = |_| {
        match chance.below(4) {
            0 | 1 => heading = (heading + 1) % 4,
            2 => heading = (heading + 3) % 4,
            _ => {
                let [dx, dy] = [[1, 0], [0, 1], [-1, 0], [0, -1]][heading];
                if !wall(x + dx, y + dy) {
                    (x, y) = (x + dx, y + dy);
                }
            }
        }
        let look = |cell: i32| {
            let [dx, dy] = [cell % cells - x, cell / cells - y];
            let (ahead, aside) = [(dx, dy), (dy, dx), (-dx, dy), (-dy, dx)][heading];
            let lit = (0..7).contains(&ahead) && (-3..=3).contains(&aside);
            let thing = match (cell % cells, cell / cells) {
                place if place == (x, y) => 4 + heading as u16,
                (x, y) if wall(x, y) => 1,
                (x, _) if x == cells / 2 - 1 => 2,
                (x, y) if x == 1 && y == cells - 2 => 3,
                _ => 0,
            };
            2 * thing + u16::from(lit)
        };
        (0..cells * cells).map(look).collect()
    };
    (0..steps).map(step).collect()
}

/// Nanoseconds a call: the least of many rounds, since others use the processor too.
fn nanoseconds(calls: usize, mut call: impl FnMut(usize)) -> f64 {
    let round = |_| {
        let start = Instant::now();
        (0..calls).for_each(&mut call);
        start.elapsed().as_secs_f64() * 1e9 / calls as f64
    };
    (0..20).map(round).fold(f64::INFINITY, f64::min)
}

fn report(what: &str, time: f64, frame: &Frame) {
    let mut copy = Frame::default();
    copy.copy(frame);
    let copying = nanoseconds(2000, |_| {
        copy.copy(black_box(frame));
        black_box(&mut copy);
    });
    let line = format!("{what}: {time:.0} ns, {:.1} times copying it ({copying:.0} ns)\n", time / copying);
    std::io::stderr().write_all(line.as_bytes()).expect("somebody reads it");
}

#[test]
#[ignore = "measures"]
fn mosaics() {
    let mut chance = Chance(1);
    for (cells, side, size) in [
        (8, 8, Some(84)),
        (7, 8, Some(84)),
        (10, 8, Some(84)),
        (16, 8, Some(84)),
        (19, 8, Some(84)),
        (8, 8, None),
    ] {
        let looks = walk(cells as i32, 2000);
        let pairs = looks.windows(2).flat_map(|pair| pair[0].iter().zip(&pair[1]));
        let changes = pairs.filter(|(a, b)| a != b).count() as f64 / looks.len() as f64;
        for colour in [Colour::Rgb, Colour::Luma, Colour::Mean] {
            for filter in [Filter::Pillow, Filter::Area] {
                let format = Format { colour, scale: size.map(|size| ([size; 2], filter)) };
                let mut mosaic = Mosaic::new([cells; 2], side, format);
                for _ in 0..16 {
                    let tile: Vec<u8> = (0..3 * side * side).map(|_| chance.below(256) as u8).collect();
                    mosaic.add(&tile);
                }
                let time = nanoseconds(looks.len(), |call| {
                    black_box(mosaic.show(&looks[call]));
                });
                let what = format!("{cells} × {cells} cells, {changes:.1} changed, {format:?}");
                report(&what, time, mosaic.show(&looks[0]));
                let still = nanoseconds(2000, |_| {
                    black_box(mosaic.show(black_box(&looks[0])));
                });
                report("    unchanged", still, mosaic.show(&looks[0]));
            }
        }
    }
}

#[test]
#[ignore = "measures"]
fn whole_pictures_and_a_ball() {
    let ground = Frame::new([500; 2], 3);
    let ball = Stencil::disc(10);
    for format in [Format::THESIS, Format::THESIS_GREY, Format::ATARI] {
        let (mut scaler, mut out) = (Scaler::new([500; 2], format), Frame::default());
        let whole =
            nanoseconds(1, |_| scaler.run(|y, pixels| pixels.copy_from_slice(ground.row(y)), &mut out));
        report(&format!("500 × 500 pixels, {format:?}"), whole, &out);
        let part = nanoseconds(500, |call| {
            let at = [100 + call as u32 % 300, 240];
            let touched = scaler.touches(Window { from: at.map(|x| x - 10), to: at.map(|x| x + 10) });
            let row = |y, columns: std::ops::Range<u32>, pixels: &mut [u8]| {
                pixels.copy_from_slice(&ground.row(y)[3 * columns.start as usize..3 * columns.end as usize]);
                ball.fill_row(at.map(|x| x as i32), [0, 0, 255], y, columns, pixels);
            };
            scaler.part(touched, row, &mut out);
        });
        report("    a ball's surroundings", part, &out);
    }
}
