//! What is kept, held against the truth.

use inroads::{
    agents::{
        Context, Novelty,
        novelty::{Counts, FeatureCounts, FeatureCountsConfig},
    },
    discovery::naming::{Counterfactual, CounterfactualConfig, Name, Resets},
    envs::Seed,
    statistics::{Estimate, wilson},
};
use serde::Serialize;

/// An event in which something was new for the first time.
pub(super) struct Event {
    /// Everything that was visited before, in this order.
    pub(super) before: Vec<Vec<f32>>,
    /// An exploration whose last state is the event.
    pub(super) path: Vec<Vec<f32>>,
    /// The features that were new, by construction, in ascending order.
    pub(super) truth: Vec<u32>,
    /// The feature that changes at random.
    pub(super) distractor: u32,
}

/// How features are selected.
#[derive(Clone, Copy)]
pub(super) enum Method {
    /// By counts of features and pairs.
    Features(Resets),
    /// The same, where every pair is asked about, however seldom its values occur.
    AllPairs,
    /// By counts of whole states: the negative control.
    States,
}

impl Method {
    pub(super) const ALL: [Self; 4] =
        [Self::Features(Resets::Single), Self::Features(Resets::Pairs), Self::AllPairs, Self::States];

    fn name(self) -> &'static str {
        match self {
            Self::Features(Resets::Single) => "single resets",
            Self::Features(Resets::Pairs) => "resets of pairs",
            Self::AllPairs => "single, all pairs counted",
            Self::States => "counts of whole states",
        }
    }

    /// The features kept of an event.
    fn keep(self, event: &Event) -> Vec<u32> {
        let every = FeatureCountsConfig { expected: 0.0, ..FeatureCountsConfig::default() };
        let (mut novelty, resets): (Box<dyn Novelty<Vec<f32>>>, _) = match self {
            Self::Features(resets) => (Box::new(FeatureCounts::new(&FeatureCountsConfig::default())), resets),
            Self::AllPairs => (Box::new(FeatureCounts::new(&every)), Resets::Single),
            Self::States => (Box::new(Counts::default()), Resets::Single),
        };
        let mut ctx = Context::training(Seed(0), 0);
        (0..event.before.len() as u32).for_each(|step| novelty.visit((0, step), &event.before, &mut ctx));
        let by = |a: &&Vec<f32>, b: &&Vec<f32>| novelty.bonus(a).total_cmp(&novelty.bonus(b));
        let (newest, oldest) = (event.path.iter().max_by(by), event.path.iter().min_by(by));
        let config = CounterfactualConfig { resets, ..CounterfactualConfig::default() };
        let name =
            |(newest, oldest)| Counterfactual::new(&config).name(newest, oldest, &|s| novelty.bonus(s));
        let goal = newest.zip(oldest).and_then(name);
        goal.map_or_else(Vec::new, |goal| goal.kept.iter().map(|(i, _)| *i).collect())
    }
}

/// One kind of event by one method.
#[derive(Serialize)]
pub(super) struct Line {
    pub(super) event: &'static str,
    pub(super) method: &'static str,
    pub(super) events: u64,
    /// Features of the truth among those kept, of those kept.
    pub(super) precision: Estimate,
    /// Features of the truth among those kept, of the truth.
    pub(super) recall: Estimate,
    /// Events in which exactly the truth was kept.
    pub(super) exact: Estimate,
    /// Events in which the distractor was not kept.
    pub(super) distractor_dropped: Estimate,
    /// Events of which nothing was kept: they bring up no goal.
    pub(super) nothing: Estimate,
}

/// All methods on events of one kind.
pub(super) fn lines(event: &'static str, events: &[Event]) -> Vec<Line> {
    Method::ALL.map(|method| line(event, method, events)).into()
}

fn line(event: &'static str, method: Method, events: &[Event]) -> Line {
    let (mut hits, mut kept, mut truth, mut exact, mut dropped, mut nothing) = (0, 0, 0, 0, 0, 0);
    for event in events {
        let found = method.keep(event);
        hits += found.iter().filter(|i| event.truth.contains(i)).count() as u64;
        kept += found.len() as u64;
        truth += event.truth.len() as u64;
        exact += u64::from(found == event.truth);
        dropped += u64::from(!found.contains(&event.distractor));
        nothing += u64::from(found.is_empty());
    }
    let n = events.len() as u64;
    Line {
        event,
        method: method.name(),
        events: n,
        precision: wilson(hits, kept),
        recall: wilson(hits, truth),
        exact: wilson(exact, n),
        distractor_dropped: wilson(dropped, n),
        nothing: wilson(nothing, n),
    }
}

pub(super) fn print(lines: &[Line]) {
    println!(
        "{:32} {:26} {:>6}  {:17} {:17} {:17} {:17}",
        "event", "method", "events", "precision", "recall", "distractor dropped", "nothing kept"
    );
    for l in lines {
        println!(
            "{:32} {:26} {:>6}  {:17} {:17} {:17} {:17}",
            l.event,
            l.method,
            l.events,
            format!("{:.2}", l.precision),
            format!("{:.2}", l.recall),
            format!("{:.2}", l.distractor_dropped),
            format!("{:.2}", l.nothing)
        );
    }
}
