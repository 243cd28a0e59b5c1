//! What has become of a run.

use std::path::Path;

use toml::{Table, Value};

use super::{Asked, Plan};
use crate::{
    config::Config,
    run::{Folder, RunError},
};

/// What has become of a run that is asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum State {
    /// Nothing is there, or nothing that could be gone on with.
    Absent,
    /// It can be gone on with.
    Begun,
    /// It is done.
    Finished,
    /// Something is there with other settings: which.
    Changed(String),
}

impl State {
    /// Looks at a run's folder.
    pub fn of(asked: &Asked) -> Self {
        let Ok(folder) = Folder::open(&asked.path) else { return Self::Absent };
        let has_checkpoint = std::fs::read_dir(folder.checkpoints()).is_ok_and(|files| {
            files.flatten().any(|file| file.path().extension().is_some_and(|e| e == "ckpt"))
        });
        if !has_checkpoint {
            // Killed before its first one was whole.
            return Self::Absent;
        }
        match difference(&folder.config(), &asked.config) {
            Some(what) => Self::Changed(what),
            None if folder.summary().is_file() => Self::Finished,
            None => Self::Begun,
        }
    }
}

impl Plan {
    /// The folders of the runs of an arm in a domain that are done as the file asks for them, with their seeds.
    ///
    /// # Errors
    /// [`RunError`] when a folder vanished meanwhile.
    pub fn finished(&self, domain: usize, arm: usize) -> Result<Vec<(u64, Folder)>, RunError> {
        let done = self.of(domain, arm).filter(|asked| State::of(asked) == State::Finished);
        done.map(|asked| Ok((asked.seed, Folder::open(&asked.path)?))).collect()
    }

    /// The names of the runs that are not done.
    pub fn missing(&self) -> Vec<String> {
        let missing = self.runs.iter().filter(|asked| State::of(asked) != State::Finished);
        missing.map(|asked| asked.name.clone()).collect()
    }
}

/// In what the settings of a run differ from those that are asked for.
fn difference(file: &Path, asked: &Config) -> Option<String> {
    let there = match Config::read(file) {
        Ok(there) if there == *asked => return None,
        Ok(there) => there,
        Err(why) => return Some(why.to_string()),
    };
    let tables = |config: &Config| config.to_toml().parse::<Table>().unwrap_or_default();
    let (there, asked) = (tables(&there), tables(asked));
    let mut found = Vec::new();
    compare(&there, &asked, "", &mut found);
    Some(found.join("; "))
}

fn compare(there: &Table, asked: &Table, prefix: &str, found: &mut Vec<String>) {
    let added = asked.keys().filter(|key| !there.contains_key(*key));
    for key in there.keys().chain(added) {
        let name = format!("{prefix}{key}");
        match (there.get(key), asked.get(key)) {
            (Some(Value::Table(there)), Some(Value::Table(asked))) => {
                compare(there, asked, &format!("{name}."), found);
            }
            (there, asked) if there == asked => {}
            (there, asked) => {
                let shown = |value: Option<&Value>| value.map_or_else(|| "none".to_owned(), Value::to_string);
                found.push(format!("{name} is {}, asked for is {}", shown(there), shown(asked)));
            }
        }
    }
}
