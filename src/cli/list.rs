//! `inroads list`.

use inroads_envs::registry;

use crate::assembly::AGENTS;

#[allow(clippy::print_stdout)] // what the command is for
pub(super) fn list() {
    println!("agents");
    for entry in AGENTS {
        println!("  {:<14} {}", entry.name, entry.about);
    }
    println!("\nenvironments");
    for entry in registry::ENTRIES {
        println!("  {:<20} {}", entry.name, entry.about);
    }
    println!("\ntrain one in the other: inroads train AGENT ENVIRONMENT");
}
