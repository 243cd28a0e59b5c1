//! What a mosaic shows never depends on what it showed before, and is the whole picture scaled.

#[path = "support/chance.rs"]
mod chance;

use chance::Chance;
use inroads_sim::raster::{Colour, Filter, Format, Frame, Mosaic, Scaler};

/// Cells, side of tiles, size of the result.
const SHAPES: [([u32; 2], u32, Option<[u32; 2]>); 17] = [
    ([8, 8], 8, Some([84, 84])),
    ([7, 7], 8, Some([84, 84])),
    ([10, 10], 8, Some([84, 84])),
    ([19, 19], 8, Some([84, 84])),
    ([13, 13], 8, Some([84, 84])),
    ([10, 10], 16, Some([84, 84])),
    ([8, 8], 32, Some([84, 84])),
    ([5, 5], 16, Some([84, 84])),
    ([3, 5], 7, Some([40, 23])),
    ([6, 2], 5, Some([11, 64])),
    ([9, 4], 3, Some([5, 3])),
    ([1, 1], 8, Some([84, 84])),
    ([70, 3], 4, Some([84, 84])),
    ([4, 4], 21, Some([84, 84])),
    ([4, 4], 42, Some([84, 84])),
    ([8, 8], 8, None),
    ([5, 3], 11, None),
];

fn formats(size: Option<[u32; 2]>) -> Vec<Format> {
    let colours = [Colour::Rgb, Colour::Luma, Colour::Mean];
    let filters = [Filter::Pillow, Filter::Area, Filter::Linear];
    let scales = filters.map(|filter| size.map(|size| (size, filter)));
    let each = |colour| scales.iter().map(move |&scale| Format { colour, scale });
    colours.into_iter().flat_map(each).collect()
}

/// The whole native picture through a scaler.
fn anew(cells: [u32; 2], side: u32, format: Format, tiles: &[Vec<u8>], looks: &[u16]) -> Frame {
    let mut out = Frame::default();
    let row = |y: u32, pixels: &mut [u8]| {
        for (x, pixel) in pixels.chunks_exact_mut(3).enumerate() {
            let look = looks[(y / side * cells[0]) as usize + x / side as usize];
            let at = 3 * ((y % side * side) as usize + x % side as usize);
            pixel.copy_from_slice(&tiles[usize::from(look)][at..at + 3]);
        }
    };
    Scaler::new(cells.map(|cells| cells * side), format).run(row, &mut out);
    out
}

#[test]
fn painting_on_is_painting_anew() {
    let mut chance = Chance(1);
    for (cells, side, size) in SHAPES {
        for format in formats(size) {
            let mut mosaic = Mosaic::new(cells, side, format);
            let mut tiles: Vec<Vec<u8>> = Vec::new();
            let mut looks = vec![0; (cells[0] * cells[1]) as usize];
            for round in 0..40 {
                while tiles.len() < 2 + round / 2 {
                    let tile: Vec<u8> = (0..3 * side * side).map(|_| chance.below(256) as u8).collect();
                    assert_eq!(usize::from(mosaic.add(&tile)), tiles.len());
                    tiles.push(tile);
                }
                for _ in 0..chance.below(2 * looks.len() as u64) * u64::from(round % 5 != 0) {
                    let cell = chance.below(looks.len() as u64) as usize;
                    looks[cell] = chance.below(tiles.len() as u64) as u16;
                }
                let wanted = anew(cells, side, format, &tiles, &looks);
                let what = || format!("{cells:?} cells of {side} as {format:?}, round {round}");
                assert!(*mosaic.show(&looks) == wanted, "{}: painted on", what());
                assert!(*mosaic.clone().show(&looks) == wanted, "{}: a copy", what());
            }
            let mut fresh = Mosaic::new(cells, side, format);
            for tile in &tiles {
                fresh.add(tile);
            }
            assert!(fresh.show(&looks) == mosaic.show(&looks), "{cells:?} {side} {format:?}: painted anew");
        }
    }
}

/// Keys of remembered pieces have room for 4,096 looks; beyond, nothing is remembered, and nothing is wrong.
#[test]
fn many_tiles() {
    let mut mosaic =
        Mosaic::new([4, 4], 2, Format { colour: Colour::Luma, scale: Some(([9, 9], Filter::Pillow)) });
    let mut tiles = Vec::new();
    for number in 0..4100u32 {
        let tile: Vec<u8> = (0..12).map(|byte| ((number * 7) >> (byte % 5)) as u8).collect();
        mosaic.add(&tile);
        tiles.push(tile);
        if number % 4 == 3 {
            let looks: Vec<u16> = (0..16).map(|cell| (number / (cell + 1)) as u16).collect();
            let format = Format { colour: Colour::Luma, scale: Some(([9, 9], Filter::Pillow)) };
            assert!(*mosaic.show(&looks) == anew([4, 4], 2, format, &tiles, &looks), "{number}");
        }
    }
}

#[test]
#[should_panic(expected = "no number 2")]
fn a_look_that_is_not_there() {
    let mut mosaic = Mosaic::new([2, 1], 1, Format::NATIVE);
    mosaic.add(&[0; 3]);
    mosaic.add(&[1; 3]);
    mosaic.show(&[1, 2]);
}

#[test]
#[should_panic(expected = "a mosaic has cells, not 4 by 0")]
fn a_mosaic_without_cells_is_none() {
    Mosaic::new([4, 0], 8, Format::ATARI);
}

#[test]
#[should_panic(expected = "a tile of a mosaic has pixels")]
fn a_tile_without_pixels_is_none() {
    Mosaic::new([4, 4], 0, Format::ATARI);
}

#[test]
#[should_panic(expected = "a picture of 0 by 7 pixels cannot be scaled")]
fn nothing_cannot_be_scaled() {
    Scaler::new([0, 7], Format::NATIVE);
}
