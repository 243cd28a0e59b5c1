//! `inroads list`.

use inroads_envs::registry;

use super::say::say;
use crate::assembly::agents;

pub(super) fn list() {
    say!("agents");
    table(&agents().map(|entry| (entry.name, entry.about)).collect::<Vec<_>>());
    say!("\nenvironments");
    table(&registry::entries().map(|entry| (entry.name, entry.about)).collect::<Vec<_>>());
    say!("\ntrain one in the other: inroads train AGENT ENVIRONMENT");
}

fn table(entries: &[(&str, &str)]) {
    let widest = entries.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    for (name, about) in entries {
        say!("  {name:<widest$}  {about}");
    }
}
