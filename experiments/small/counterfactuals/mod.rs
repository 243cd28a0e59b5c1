//! Chapter 9: are the features that counterfactuals keep the ones that were new, and what is that good for?
//!
//! - `scripted`, `walks`: events whose cause is known by construction, in made-up states and in real domains;
//! - `score`: what is kept, held against the truth;
//! - `learning`: the whole agent, with goals of few features and of all of them.

mod learning;
mod score;
mod scripted;
mod walks;

use serde::Serialize;

use crate::{
    Options,
    support::{Done, write},
};

/// What is written.
#[derive(Serialize)]
struct Results {
    seeds: u64,
    events: Vec<score::Line>,
    learning: Vec<learning::Line>,
    comparisons: Vec<learning::Comparison>,
}

pub(crate) fn run(options: &Options) -> Done {
    let seeds = options.seeds.unwrap_or(10);
    let mut events = scripted::lines(seeds);
    events.extend(walks::lines(seeds));
    score::print(&events);
    let (learning, comparisons) = learning::lines(seeds, &options.out)?;
    write(options, "counterfactuals", &Results { seeds, events, learning, comparisons })
}
