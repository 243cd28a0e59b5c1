//! Writing over pictures, for people: the public-domain 8 × 8 letters of `font8x8`.

use font8x8::legacy::BASIC_LEGACY;

use super::{Frame, colour::luma};

/// Pixels along a letter's side, at scale 1.
const SIDE: u32 = 8;

/// Writes from pixel `at`, the upper left corner, in letters of `8 × scale` pixels a side; `\n` begins a new line below.
/// What is not printable ASCII becomes `?`; what lies outside the picture is cut off. On grey pictures the colour is
/// its luma.
pub fn write(frame: &mut Frame, at: [i32; 2], text: &str, colour: [u8; 3], scale: u32) {
    let mut pen = at.map(i64::from);
    let step = i64::from(SIDE * scale);
    for letter in text.chars() {
        if letter == '\n' {
            pen = [i64::from(at[0]), pen[1] + step];
        } else {
            draw(frame, pen, glyph(letter), colour, scale);
            pen[0] += step;
        }
    }
}

/// Width and height of a text in pixels.
pub fn size(text: &str, scale: u32) -> [u32; 2] {
    let longest = text.split('\n').map(|line| line.chars().count()).max().unwrap_or(0);
    [longest, text.split('\n').count()].map(|letters| letters as u32 * SIDE * scale)
}

/// A letter's rows from the top; the lowest bit is the leftmost pixel.
pub fn glyph(letter: char) -> [u8; 8] {
    let code = if (' '..='~').contains(&letter) { letter as usize } else { '?' as usize };
    BASIC_LEGACY[code]
}

fn draw(frame: &mut Frame, at: [i64; 2], glyph: [u8; 8], colour: [u8; 3], scale: u32) {
    let size = frame.size().map(i64::from);
    let grey = [luma(colour)];
    let colour: &[u8] = if frame.channels() == 3 { &colour } else { &grey };
    let side = i64::from(SIDE * scale);
    // What of the letter lies within the picture.
    let [columns, rows] =
        [0, 1].map(|axis| (-at[axis]).clamp(0, side)..(size[axis] - at[axis]).clamp(0, side));
    for y in rows {
        let bits = glyph[(y / i64::from(scale)) as usize];
        let row = frame.row_mut((at[1] + y) as u32);
        for x in columns.clone().filter(|x| bits >> (x / i64::from(scale)) & 1 == 1) {
            let start = (at[0] + x) as usize * colour.len();
            row[start..start + colour.len()].copy_from_slice(colour);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(frame: &Frame) -> Vec<String> {
        let row =
            |y| (0..frame.size()[0]).map(|x| if frame.pixel([x, y])[0] > 0 { '#' } else { '.' }).collect();
        (0..frame.size()[1]).map(row).collect()
    }

    #[test]
    fn letters_are_where_they_belong() {
        let mut frame = Frame::new([16, 8], 3);
        write(&mut frame, [0, 0], "L", [9, 8, 7], 1);
        let letter =
            ["####....", ".##.....", ".##.....", ".##.....", ".##...#.", ".##..##.", "#######.", "........"];
        let drawn = picture(&frame);
        assert_eq!(drawn, letter.map(|row| format!("{row}........")));
        assert_eq!(frame.pixel([0, 0]), [9, 8, 7]);
        // Moved by a letter, it is the same elsewhere.
        let mut moved = Frame::new([16, 8], 3);
        write(&mut moved, [0, 0], " L", [9, 8, 7], 1);
        let shifted: Vec<_> = drawn.iter().map(|row| format!("........{}", &row[..8])).collect();
        assert_eq!(picture(&moved), shifted);
    }

    #[test]
    fn lines_scales_grey_and_edges() {
        let [mut small, mut large] = [Frame::new([24, 16], 1), Frame::new([72, 48], 1)];
        write(&mut small, [0, 0], "aß\n?~x", [255, 0, 0], 1);
        write(&mut large, [0, 0], "a?\n?~x", [255, 0, 0], 3);
        assert_eq!(size("a?\n?~x", 3), [72, 48]);
        for y in 0..48 {
            for x in 0..72 {
                assert_eq!(large.pixel([x, y]), small.pixel([x / 3, y / 3]), "{x} {y}");
            }
        }
        assert!(small.bytes().contains(&luma([255, 0, 0])));
        let mut cut = Frame::new([24, 16], 1);
        write(&mut cut, [-5, -3], "aß\n?~x", [255, 0, 0], 1);
        for y in 0..13 {
            for x in 0..19 {
                assert_eq!(cut.pixel([x, y]), small.pixel([x + 5, y + 3]), "{x} {y}");
            }
        }
        for at in [[i32::MIN; 2], [i32::MAX; 2], [-112, 0], [0, 16]] {
            let mut frame = Frame::new([24, 16], 1);
            write(&mut frame, at, "nothing", [255; 3], 2);
            assert!(frame.bytes().iter().all(|&byte| byte == 0), "{at:?}");
        }
    }
}
