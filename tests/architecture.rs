//! What the rooms must not know (`ARCHITECTURE.md`): learners and agents see observations, never ground truth, and never a
//! particular domain; Burn stands in one place.

use std::{
    fs,
    path::{Path, PathBuf},
};

/// All source files under a folder, apart from tests.
fn sources(folder: &str) -> Vec<(PathBuf, String)> {
    fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).expect("the folder is there") {
            let path = entry.expect("it can be read").path();
            if path.is_dir() {
                collect(&path, files);
            } else if path.extension().is_some_and(|e| e == "rs") && !path.ends_with("tests.rs") {
                files.push(path);
            }
        }
    }
    let mut files = Vec::new();
    collect(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder), &mut files);
    assert!(files.len() > 5, "{folder} holds {} files", files.len());
    let code = |path: &PathBuf| {
        let text = fs::read_to_string(path).expect("sources are text");
        let before_tests = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
        let lines = before_tests.lines().filter(|line| !line.trim_start().starts_with("//"));
        lines.collect::<Vec<_>>().join("\n")
    };
    files.into_iter().map(|path| (path.clone(), code(&path))).collect()
}

/// The words of some code.
fn words(code: &str) -> Vec<&str> {
    code.split(|c: char| !(c.is_alphanumeric() || c == '_')).collect()
}

/// The words of `forbidden` that stand in the code of a folder, or of its imports alone, with their files.
fn found(folder: &str, forbidden: &[&str], imports_alone: bool) -> Vec<String> {
    let mut found = Vec::new();
    for (path, code) in sources(folder) {
        let read: Vec<_> = match imports_alone {
            true => code
                .split(';')
                .filter(|s| s.contains("inroads_envs::") || s.contains("inroads_sim"))
                .collect(),
            false => vec![&code[..]],
        };
        let words: Vec<_> = read.into_iter().flat_map(words).collect();
        let there = forbidden.iter().filter(|word| words.contains(word));
        found.extend(there.map(|word| format!("{}: {word}", path.display())));
    }
    found
}

/// What only people, metrics and searches may see.
const TRUTH: &[&str] = &["Snapshot", "Render", "Domain", "Drawing", "facts", "certificate", "Sweep"];

/// Domains, as modules of `envs`.
const DOMAINS: &[&str] = &[
    "maze",
    "corridor",
    "recall",
    "rooms",
    "reacher",
    "manipulation",
    "grid",
    "sokoban",
    "taxi",
    "visual_grid",
    "visual_taxi",
    "pinball",
    "river",
    "baba",
    "montezuma",
    "probes",
    "registry",
    "inroads_sim",
];

#[test]
fn learners_and_agents_see_observations_only() {
    assert_eq!(found("agents/src", TRUTH, false), [""; 0]);
    assert_eq!(found("discovery/src", TRUTH, false), [""; 0]);
}

#[test]
fn learners_and_agents_know_no_domain() {
    assert_eq!(found("agents/src", DOMAINS, true), [""; 0]);
    assert_eq!(found("discovery/src", DOMAINS, true), [""; 0]);
    assert!(found("src", DOMAINS, true).len() > 3, "the root does, so the search finds what there is");
}

#[test]
fn burn_stands_in_one_folder() {
    assert_eq!(found("discovery/src", &["burn", "Tensor"], false), [""; 0]);
    let others = found("agents/src", &["burn"], false);
    let outside: Vec<_> = others.iter().filter(|file| !file.contains("agents/src/nets/")).collect();
    assert!(outside.is_empty() && !others.is_empty(), "{outside:?}");
}
