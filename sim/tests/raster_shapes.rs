//! Filled shapes against pygame-ce (`support/raster_peers.py`), pixel for pixel.

use inroads_sim::raster::{Frame, Stencil};

const SIDE: u32 = 120;
const COLOUR: [u8; 3] = [200, 100, 50];

#[test]
fn discs_and_polygons_are_pygames() {
    let (mut discs, mut polygons) = (0, 0);
    for line in include_str!("support/raster_shapes.txt").lines() {
        let (kind, numbers) = line.split_once(' ').expect("a kind and numbers");
        let numbers: Vec<i64> = numbers.split(' ').map(|number| number.parse().expect("a number")).collect();
        let (&wanted, numbers) = numbers.split_last().expect("a checksum");
        let numbers: Vec<i32> = numbers.iter().map(|&number| number as i32).collect();
        let (stencil, at) = if kind == "disc" {
            discs += 1;
            (Stencil::disc(numbers[2] as u32), [numbers[0], numbers[1]])
        } else {
            polygons += 1;
            (Stencil::polygon(numbers.as_chunks().0), [0, 0])
        };
        let mut frame = Frame::new([SIDE; 2], 3);
        stencil.fill(at, COLOUR, &mut frame);
        let mut crc = flate2::Crc::new();
        crc.update(frame.bytes());
        assert_eq!(i64::from(crc.sum()), wanted, "{line}");
        assert_eq!(in_windows(&stencil, at), frame, "{line}: row by row, in windows");
    }
    assert!(discs >= 60 && polygons >= 160);
}

/// The picture put together from windows of odd widths.
fn in_windows(stencil: &Stencil, at: [i32; 2]) -> Frame {
    let mut frame = Frame::new([SIDE; 2], 3);
    for y in 0..SIDE {
        for from in (0..SIDE).step_by(17) {
            let columns = from..(from + 17).min(SIDE);
            let bytes = 3 * columns.start as usize..3 * columns.end as usize;
            stencil.fill_row(at, COLOUR, y, columns, &mut frame.row_mut(y)[bytes]);
        }
    }
    frame
}

#[test]
fn rectangles_bounds_and_nothing() {
    let rectangle = Stencil::rectangle([3, 2]);
    assert_eq!((rectangle.columns(), rectangle.rows()), (0..3, 0..2));
    let mut frame = Frame::new([5, 4], 1);
    frame.shape([5, 4], 3);
    frame.bytes_mut().fill(0);
    rectangle.fill([-1, 3], [1, 2, 3], &mut frame);
    let drawn: Vec<_> = (0..20).map(|pixel| frame.pixel([pixel % 5, pixel / 5])[0]).collect();
    let mut wanted = vec![0; 20];
    (wanted[15], wanted[16]) = (1, 1);
    assert_eq!(drawn, wanted);
    let disc = Stencil::disc(10);
    assert_eq!((disc.columns(), disc.rows()), (-10..10, -10..10));
    for nothing in [Stencil::disc(0), Stencil::polygon(&[]), Stencil::rectangle([0, 3])] {
        assert!(nothing.rows().all(|y| nothing.spans(y).all(|span| span.is_empty())), "{nothing:?}");
    }
}
