//! Pictures that other systems drew, as files and as text.
//!
//! Include it with `#[path = "../../tests/support/recorded.rs"] mod recorded;`.

#![allow(dead_code, reason = "no test reads both files and text")]

use std::path::Path;

/// Width, height and RGB bytes of a picture.
pub(crate) fn picture(path: &Path) -> ([u32; 2], Vec<u8>) {
    let open = std::fs::File::open(path).unwrap_or_else(|why| panic!("{}: {why}", path.display()));
    let mut decoder = png::Decoder::new(std::io::BufReader::new(open));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().unwrap_or_else(|why| panic!("{}: {why}", path.display()));
    let mut bytes = vec![0; reader.output_buffer_size().expect("a small picture")];
    let info = reader.next_frame(&mut bytes).unwrap_or_else(|why| panic!("{}: {why}", path.display()));
    assert_eq!(info.color_type, png::ColorType::Rgb, "{}", path.display());
    ([info.width, info.height], bytes)
}

/// Base64 as RFC 4648 has it.
pub(crate) fn base64(text: &str) -> Vec<u8> {
    let sextet = |byte: u8| match byte {
        b'A'..=b'Z' => u32::from(byte - b'A'),
        b'a'..=b'z' => u32::from(byte - b'a') + 26,
        b'0'..=b'9' => u32::from(byte - b'0') + 52,
        b'+' => 62,
        b'/' => 63,
        _ => panic!("{byte} is not base64"),
    };
    let symbols: Vec<u32> = text.trim_end_matches('=').bytes().map(sextet).collect();
    let group = |group: &[u32]| {
        let bits = group.iter().fold(0, |bits, sextet| bits << 6 | sextet) << (6 * (4 - group.len()));
        bits.to_be_bytes()[1..group.len()].to_vec()
    };
    symbols.chunks(4).flat_map(group).collect()
}
