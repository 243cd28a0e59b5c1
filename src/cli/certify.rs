//! `inroads certify`: what a domain must show before a claim is made about it.

use inroads_envs::{
    certificate::{Answer, Certificate, Options},
    registry,
};

use super::{Done, say::say, world};
use crate::config::World;

/// What `inroads certify` takes.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// Environments (see `inroads list`)
    #[arg(required = true)]
    environments: Vec<String>,
    /// The seed of the first layout and of the first episode; the others' follow it
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Layouts that are searched for their shortest solution
    #[arg(long, default_value_t = Options::default().layouts)]
    layouts: u64,
    /// States of a layout after which its search gives up
    #[arg(long, default_value_t = Options::default().states)]
    states: usize,
    /// Episodes of random actions
    #[arg(long, default_value_t = Options::default().episodes)]
    episodes: u64,
    /// Steps of random actions after which no other episode is begun
    #[arg(long, default_value_t = Options::default().steps)]
    steps: u64,
    #[command(flatten)]
    world: world::Arguments,
}

/// A line of JSON an environment on the standard output, and a sentence for people on the other.
pub(super) fn certify(arguments: &Arguments) -> Done {
    let &Arguments { seed, layouts, states, episodes, steps, .. } = arguments;
    let how = Options { seed, layouts, states, episodes, steps };
    let mut own = World::default();
    arguments.world.put(&mut own)?;
    // First all names, so that a slip in the last does not cost the work on those before it.
    for name in &arguments.environments {
        own.with_options(|options| registry::make_with(name, options).map(drop))?;
    }
    for name in &arguments.environments {
        let found = own.with_options(|options| registry::certify(name, options, &how))?;
        say!("{}", serde_json::to_string(&found).expect("a certificate is numbers and words"));
        eprintln!("{}", sentence(&found));
    }
    Ok(())
}

fn sentence(found: &Certificate) -> String {
    let random = &found.random;
    let [low, high] = random.interval.map(|share| 100.0 * share);
    let mut text = format!(
        "{}: random actions succeed in {} of {} episodes, {:.2} % [{low:.2}, {high:.2}]",
        found.name,
        random.successes,
        random.episodes,
        100.0 * random.success,
    );
    if random.refused > 0 {
        text += &format!("; {} more episodes stopped at a legal action that was refused", random.refused);
    }
    if let Some(search) = &found.search {
        let mut lengths: Vec<usize> =
            search.layouts.iter().filter_map(|layout| steps(&layout.answer)).collect();
        lengths.sort_unstable();
        let kind = if search.shortest { "shortest" } else { "found" };
        text += &format!("; solved {} of {} layouts", search.solved, search.layouts.len());
        if let (Some(least), Some(most)) = (lengths.first(), lengths.last()) {
            let middle = lengths[lengths.len() / 2];
            text += &format!(", {kind} solutions of {least} to {most} steps, median {middle}");
        }
        if search.lucky {
            text += ", with chance known beforehand";
        }
    }
    text
}

fn steps(answer: &Answer) -> Option<usize> {
    match answer {
        Answer::Solved { steps, .. } => Some(*steps),
        Answer::Unsolvable | Answer::Undecided => None,
    }
}
