//! `inroads list`.

use inroads_envs::registry;

use crate::assembly::agents;

#[allow(clippy::print_stdout)] // what the command is for
pub(super) fn list() {
    println!("agents");
    table(&agents().map(|entry| (entry.name, entry.about)).collect::<Vec<_>>());
    println!("\nenvironments");
    table(&registry::entries().map(|entry| (entry.name, entry.about)).collect::<Vec<_>>());
    println!("\ntrain one in the other: inroads train AGENT ENVIRONMENT");
}

#[allow(clippy::print_stdout)] // what the command is for
fn table(entries: &[(&str, &str)]) {
    let widest = entries.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    for (name, about) in entries {
        println!("  {name:<widest$}  {about}");
    }
}
