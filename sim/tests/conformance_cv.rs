//! Grey and scaled pictures against OpenCV and Pillow (fixtures/cv), to the bit.

#[path = "../../tests/support/fixtures.rs"]
mod fixtures;
#[path = "../../tests/support/recorded.rs"]
mod recorded;

use inroads_sim::raster::{Colour, Filter, Format, Frame, Scaler};
use serde_json::Value;

#[test]
fn conformance_cv_resize() {
    for record in fixtures::records("cv", "resize") {
        let (size, native) = recorded::picture(&fixtures::folder("").join(text(&record["input_png"])));
        let stride = 3 * size[0] as usize;
        let case =
            format!("case {}, {} at {} pixels a tile", record["case"], record["env"], record["tile_size"]);
        let made = |colour, filter: Option<Filter>| {
            let scale = filter.map(|filter| (shape(&record[field(colour, filter)]), filter));
            let mut frame = Frame::default();
            let row = |y, pixels: &mut [u8]| pixels.copy_from_slice(&native[y as usize * stride..][..stride]);
            Scaler::new(size, Format { colour, scale }).run(row, &mut frame);
            frame
        };
        let grey = made(Colour::Luma, None);
        assert_eq!(
            u64::from(crc(grey.bytes())),
            record["grey_crc32"],
            "{case}: checksum of the grey picture"
        );
        let rows = [("grey_first_row", 0), ("grey_mid_row", size[1] / 2)];
        for (field, y) in rows {
            assert_eq!(grey.row(y), bytes(&record[field]), "{case}: {field}");
        }
        for (colour, filter) in [
            (Colour::Luma, Filter::Area),
            (Colour::Luma, Filter::Linear),
            (Colour::Rgb, Filter::Pillow),
            (Colour::Mean, Filter::Pillow),
        ] {
            let field = field(colour, filter);
            let (made, wanted) =
                (made(colour, Some(filter)), recorded::base64(text(&record[field]["u8_b64"])));
            let wrong = made.bytes().iter().zip(&wanted).filter(|(a, b)| a != b).count();
            assert_eq!(
                (made.bytes().len(), wrong),
                (wanted.len(), 0),
                "{case}: length and wrong bytes of {field}"
            );
        }
        let known = [
            "case",
            "env",
            "tile_size",
            "input_png",
            "grey_crc32",
            "grey_first_row",
            "grey_mid_row",
            "area84",
            "linear84",
            "pillow_bilinear84_rgb",
            "pillow_bilinear84_channel_mean",
        ];
        let fields = record.as_object().expect("a record has fields").keys();
        for field in fields {
            assert!(known.contains(&field.as_str()), "{case}: nothing compares {field}");
        }
    }
}

/// Where a record has the picture made in this way.
fn field(colour: Colour, filter: Filter) -> &'static str {
    match (colour, filter) {
        (Colour::Rgb, Filter::Pillow) => "pillow_bilinear84_rgb",
        (Colour::Mean, Filter::Pillow) => "pillow_bilinear84_channel_mean",
        (_, Filter::Linear) => "linear84",
        _ => "area84",
    }
}

/// Width and height: the first two lengths are rows and columns.
fn shape(array: &Value) -> [u32; 2] {
    [1, 0].map(|axis| array["shape"][axis].as_u64().expect("a length") as u32)
}

fn text(value: &Value) -> &str {
    value.as_str().expect("a text")
}

fn bytes(array: &Value) -> Vec<u8> {
    let array = array.as_array().expect("an array");
    array.iter().map(|byte| byte.as_u64().expect("a byte") as u8).collect()
}

fn crc(bytes: &[u8]) -> u32 {
    let mut crc = flate2::Crc::new();
    crc.update(bytes);
    crc.sum()
}
