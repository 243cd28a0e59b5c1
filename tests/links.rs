//! Every relative link of the documents leads somewhere.

use std::{
    fs,
    path::{Path, PathBuf},
};

/// All Markdown files below a folder.
fn documents(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("the folder can be read") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            documents(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "md") {
            found.push(path);
        }
    }
}

/// The targets of `[words](target)` outside fenced code, without what names a place in a file.
fn links(text: &str) -> Vec<&str> {
    let mut fenced = false;
    let prose = text.lines().filter(|line| {
        fenced ^= line.trim_start().starts_with("```");
        !fenced
    });
    let targets =
        prose.flat_map(|line| line.split("](").skip(1).filter_map(|rest| rest.split([')', ' ']).next()));
    targets
        .filter(|target| !target.contains("://") && !target.starts_with("mailto:"))
        .filter_map(|target| target.split('#').next())
        .filter(|target| !target.is_empty())
        .collect()
}

#[test]
fn links_are_found_where_prose_has_them() {
    let text = "[a](x.md#here) and [b](https://c.d)\n```\n[c](no)\n```\n![d](img/e.png \"f\") [g](#here)";
    assert_eq!(links(text), ["x.md", "img/e.png"]);
}

#[test]
fn every_relative_link_leads_to_a_file() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = vec![root.join("README.md"), root.join("ARCHITECTURE.md")];
    documents(&root.join("docs"), &mut files);
    let (mut checked, mut broken) = (0, Vec::new());
    for file in &files {
        let text = fs::read_to_string(file).expect("the document can be read");
        let folder = file.parent().expect("a file is in a folder");
        for target in links(&text) {
            checked += 1;
            if !folder.join(target).exists() {
                broken.push(format!("{}: {target}", file.strip_prefix(root).unwrap_or(file).display()));
            }
        }
    }
    assert!(checked > 0, "no link was found in {} documents", files.len());
    assert!(broken.is_empty(), "broken links:\n{}", broken.join("\n"));
}
