//! Trains deep skill chaining from code and prints the skills that it finds.
//!
//! `cargo run --release --example train_dsc` (`-- --quick` stops after three episodes)

use inroads::{prelude::*, session};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let quick = std::env::args().any(|argument| argument == "--quick");
    let episodes = if quick { 3 } else { 300 };
    let config = Config::defaults("dsc", "point-maze")?.with_assignment(&format!("episodes={episodes}"))?;
    let mut session = session::build(&config)?;
    for _ in 0..episodes {
        let episode = &session.train()?[0];
        eprintln!("episode {}: return {}, {} skills", episode.episode, episode.reward, episode.skills);
    }
    for skill in session.skills() {
        eprintln!("{skill:?}");
    }
    if let Some(watched) = session.evaluate(Protocol::Frozen, 0)? {
        eprintln!("frozen: {:?}", watched.summary);
    }
    Ok(())
}
