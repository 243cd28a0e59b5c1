//! Reads the records of other systems that conformance tests compare with.
//!
//! Include it with `#[path = "../../tests/support/fixtures.rs"] mod fixtures;`. The records lie in the folder
//! that `INROADS_FIXTURES` names, by default `tests/fixtures` of the repository, one folder a family.

#![allow(dead_code, reason = "no test reads both records and documents")]

use std::{
    fs,
    io::Read,
    path::{Path, PathBuf},
};

use serde_json::Value;

/// All records of a family, from every `*.jsonl` and `*.jsonl.gz` whose name starts with `prefix`, in the
/// order of the names.
///
/// # Panics
/// When there is none, or a file cannot be read: a conformance test that compares nothing has not passed.
pub(crate) fn records(family: &str, prefix: &str) -> Vec<Value> {
    let folder = folder(family);
    let listing = fs::read_dir(&folder)
        .unwrap_or_else(|why| panic!("no fixtures in {}: {why}; set INROADS_FIXTURES", folder.display()));
    let mut files: Vec<_> = listing
        .map(|entry| entry.expect("the folder of fixtures can be listed").path())
        .filter(|path| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            name.starts_with(prefix) && (name.ends_with(".jsonl") || name.ends_with(".jsonl.gz"))
        })
        .collect();
    files.sort();
    let records: Vec<_> = files.iter().flat_map(read).collect();
    assert!(
        !records.is_empty(),
        "{} holds no records in {prefix}*.jsonl or {prefix}*.jsonl.gz; set INROADS_FIXTURES to the folder above it",
        folder.display()
    );
    records
}

/// A family's document `name`, which is one JSON value.
///
/// # Panics
/// When it is not there or cannot be read.
pub(crate) fn document(family: &str, name: &str) -> Value {
    let path = folder(family).join(name);
    let text = fs::read(&path)
        .unwrap_or_else(|why| panic!("no fixture {}: {why}; set INROADS_FIXTURES", path.display()));
    serde_json::from_slice(&text).unwrap_or_else(|why| panic!("{}: {why}", path.display()))
}

/// Where a family's records lie.
pub(crate) fn folder(family: &str) -> PathBuf {
    let named = std::env::var_os("INROADS_FIXTURES").unwrap_or_else(|| "tests/fixtures".into());
    // Tests run in the folder of their crate; a relative name is meant from the repository's.
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/..")).join(named).join(family)
}

/// Whether records from elsewhere are compared with. They may lack what only the repository's own are known to have; in
/// those nothing may be missing.
pub(crate) fn from_elsewhere() -> bool {
    std::env::var_os("INROADS_FIXTURES").is_some()
}

fn read(path: &PathBuf) -> Vec<Value> {
    let bytes = fs::read(path).unwrap_or_else(|why| panic!("{}: {why}", path.display()));
    let mut text = String::new();
    match path.extension().is_some_and(|extension| extension == "gz") {
        true => flate2::read::MultiGzDecoder::new(bytes.as_slice()).read_to_string(&mut text),
        false => bytes.as_slice().read_to_string(&mut text),
    }
    .unwrap_or_else(|why| panic!("{}: {why}", path.display()));
    let parse = |(number, line): (usize, &str)| {
        serde_json::from_str(line)
            .unwrap_or_else(|why| panic!("{}, line {}: {why}", path.display(), number + 1))
    };
    text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()).map(parse).collect()
}
