//! Figure 8.6: does the difference between seeking and avoiding tell what an agent controls?
//!
//! Random actions in three worlds whose controllable proto-goals are known ([`Probe`]), the estimates of
//! [`plausible`](inroads::discovery::proto::plausible) from all transitions, and F1 of "controllable" for every τ₂. Reachability
//! (equation 8.1) is left out, as in the figure; with it is a column of the table.

use inroads::{
    agents::{Experience, Transition, encode::OneHot, lspi::Lspi},
    discovery::{
        Wanted,
        proto::plausible::{Judgement, Plausibility},
    },
    envs::{
        Annotated, Bits, Environment, Seed, Spec,
        probes::{DistractorGrid, Probe, TimerGrid},
        registry::{self, AnyAnnotated},
        taxi::{Rules, Taxi},
    },
    figures::{Level, Panel, Series, Summary, curves},
};
use rand::RngExt;
use serde::Serialize;

use crate::{
    Options,
    support::{Done, over_seeds, write},
};

type Seen = Annotated<Vec<f32>>;

/// Thresholds τ₂ in [0, 1], and their distance.
const THRESHOLDS: usize = 101;
const STEP: f64 = 0.01;
/// The F1 that a band of thresholds must have, and how wide the band must be.
const GOOD: f64 = 0.95;
const WIDE: f64 = 0.15;
/// Above the rank of what is seen in all three worlds: 116 to 157.
const FEATURES: usize = 160;
/// Values of the block of what is seen jointly: with 125 for row, column and passenger. Whether picking up does anything
/// depends on all three.
const JOINT: usize = 128;
/// How many transitions, and how many features: with more data it becomes better (thesis), with too few features worthless.
const SETTINGS: [(usize, usize); 4] =
    [(2_048, FEATURES), (4_096, FEATURES), (16_384, FEATURES), (16_384, 24)];
/// The one that counts.
const HEADLINE: usize = 2;

/// A world, and which of its proto-goals are controllable.
struct Domain {
    name: &'static str,
    truth: fn() -> Vec<bool>,
}

const DOMAINS: [Domain; 3] = [
    Domain { name: "taxi", truth: || Taxi::new(Rules::Gymnasium).controllable() },
    Domain { name: "timer-grid", truth: || size(TimerGrid::new(4, 100)).controllable() },
    Domain { name: "distractor-grid", truth: || size(DistractorGrid::new(4, 0.5)).controllable() },
];

fn size<W, E: std::fmt::Debug>(world: Result<W, E>) -> W {
    world.expect("the registry's size")
}

/// Precision, recall and F1 at each threshold.
type Sweep = Vec<[f64; 3]>;

/// A seed of a domain and a setting.
#[derive(Clone)]
struct Outcome {
    observed: usize,
    absent: usize,
    narrow: bool,
    /// F1 of calling everything that was observed controllable.
    all_yes: f64,
    /// By equation 8.2 alone.
    controllable: Sweep,
    /// By equations 8.1 and 8.2.
    plausible: Sweep,
}

/// All seeds of a domain and a setting.
#[derive(Serialize)]
struct Summarised {
    domain: &'static str,
    transitions: usize,
    features: usize,
    seeds: u64,
    all_yes: f64,
    all_no: f64,
    /// The widest band of thresholds with a mean F1 of at least 0.95, and with that F1 on every seed.
    band: Option<[f64; 2]>,
    band_of_worst: Option<[f64; 2]>,
    /// The same with reachability.
    band_plausible: Option<[f64; 2]>,
    /// Mean precision, recall and F1, and the worst seed's F1, at each threshold from 0 in steps of 0.01.
    precision: Vec<f64>,
    recall: Vec<f64>,
    f1: Vec<f64>,
    f1_of_worst: Vec<f64>,
    #[serde(skip)]
    outcomes: Vec<Outcome>,
}

pub(crate) fn run(options: &Options) -> Done {
    let seeds = options.seeds.unwrap_or(10);
    let mut all = Vec::new();
    let mut panels = Vec::new();
    for domain in &DOMAINS {
        let outcomes = over_seeds(seeds, |seed| outcomes(domain, seed));
        let found: Vec<Summarised> =
            (0..SETTINGS.len()).map(|setting| summarise(domain, setting, &outcomes)).collect();
        found.iter().for_each(print);
        panels.push(panel(domain, &found));
        all.extend(found);
    }
    let headline = all.iter().filter(|s| (s.transitions, s.features) == SETTINGS[HEADLINE]);
    let met = headline.fold(true, |met, s| met & wide(s.band) & wide(s.band_of_worst));
    println!(
        "F1 of at least {GOOD} over a band at least {WIDE} wide on all three, mean and worst seed: {met}"
    );
    std::fs::create_dir_all(&options.out)?;
    curves(options.out.join("controllability.png"), &panels)?;
    write(options, "controllability", &all)
}

fn wide(band: Option<[f64; 2]>) -> bool {
    band.is_some_and(|[low, high]| high - low > WIDE - STEP / 2.0)
}

fn print(s: &Summarised) {
    let band = |band: Option<[f64; 2]>| {
        band.map_or("none".to_owned(), |[low, high]| format!("{low:.2}–{high:.2} ({:.2})", high - low))
    };
    let mean = |number: fn(&Outcome) -> usize| {
        s.outcomes.iter().map(|o| number(o) as f64).sum::<f64>() / s.outcomes.len() as f64
    };
    println!(
        "{:<16} {:>6} transitions {:>4} features{} | observed {:>5.1}, not in batch {:.1} | all yes {:.2}, all no {:.2} | \
         F1 ≥ {GOOD}: mean {}, every seed {}, with 8.1 {}",
        s.domain,
        s.transitions,
        s.features,
        if s.outcomes.iter().any(|o| o.narrow) { " (narrow)" } else { "" },
        mean(|o| o.observed),
        mean(|o| o.absent),
        s.all_yes,
        s.all_no,
        band(s.band),
        band(s.band_of_worst),
        band(s.band_plausible),
    );
    for at in [5, 10, 20, 30, 50] {
        println!(
            "    τ₂ = {:.2}: precision {:.3}, recall {:.3}, F1 {:.3}, of the worst seed {:.3}",
            at as f64 * STEP,
            s.precision[at],
            s.recall[at],
            s.f1[at],
            s.f1_of_worst[at],
        );
    }
}

fn panel(domain: &Domain, found: &[Summarised]) -> Panel {
    let series = found.iter().enumerate().map(|(at, s)| {
        let narrow =
            if s.features < FEATURES { format!(", {} features only", s.features) } else { String::new() };
        let points =
            |o: &Outcome| o.controllable.iter().enumerate().map(|(t, x)| (t as f64 * STEP, x[2])).collect();
        let label = format!("{} transitions{narrow}", s.transitions);
        Series { label, colour: at + 1, runs: s.outcomes.iter().map(points).collect() }
    });
    Panel {
        title: domain.name.into(),
        x_label: "threshold τ₂".into(),
        y_label: "F1 of “controllable”".into(),
        y_range: Some((0.0, 1.0)),
        summary: Summary::MedianAndRange,
        series: series.collect(),
        levels: vec![Level { label: "all called controllable".into(), y: found[HEADLINE].all_yes }],
        ..Panel::default()
    }
}

fn summarise(domain: &Domain, setting: usize, seeds: &[Vec<Outcome>]) -> Summarised {
    let outcomes: Vec<Outcome> = seeds.iter().map(|outcomes| outcomes[setting].clone()).collect();
    let count = outcomes.len() as f64;
    let mean = |sweep: fn(&Outcome) -> &Sweep, at: usize, which: usize| {
        outcomes.iter().map(|o| sweep(o)[at][which]).sum::<f64>() / count
    };
    let worst = |at: usize| outcomes.iter().map(|o| o.controllable[at][2]).fold(1.0, f64::min);
    let listed = |number: &dyn Fn(usize) -> f64| {
        (0..THRESHOLDS).map(|at| (number(at) * 1e3).round() / 1e3).collect::<Vec<_>>()
    };
    Summarised {
        domain: domain.name,
        transitions: SETTINGS[setting].0,
        features: SETTINGS[setting].1,
        seeds: outcomes.len() as u64,
        all_yes: outcomes.iter().map(|o| o.all_yes).sum::<f64>() / count,
        all_no: 0.0,
        band: band(|at| mean(|o| &o.controllable, at, 2)),
        band_of_worst: band(worst),
        band_plausible: band(|at| mean(|o| &o.plausible, at, 2)),
        precision: listed(&|at| mean(|o| &o.controllable, at, 0)),
        recall: listed(&|at| mean(|o| &o.controllable, at, 1)),
        f1: listed(&|at| mean(|o| &o.controllable, at, 2)),
        f1_of_worst: listed(&worst),
        outcomes,
    }
}

/// The widest run of thresholds with a good F1: its ends.
fn band(f1: impl Fn(usize) -> f64) -> Option<[f64; 2]> {
    let mut widest: Option<(usize, usize)> = None;
    let mut start = None;
    for at in 0..THRESHOLDS {
        start = if f1(at) >= GOOD { start.or(Some(at)) } else { None };
        if let Some(start) = start.filter(|&start| widest.is_none_or(|(low, high)| at - start > high - low)) {
            widest = Some((start, at));
        }
    }
    widest.map(|(low, high)| [low as f64 * STEP, high as f64 * STEP])
}

/// A seed of a domain, in all settings.
fn outcomes(domain: &Domain, seed: u64) -> Vec<Outcome> {
    let truth = (domain.truth)();
    SETTINGS.map(|(transitions, features)| outcome(domain, &truth, Seed(seed), transitions, features)).into()
}

fn outcome(domain: &Domain, truth: &[bool], seed: Seed, transitions: usize, features: usize) -> Outcome {
    let made = registry::make_annotated(domain.name, &registry::Options::default());
    let Ok(AnyAnnotated::Vectors(mut env)) = made else { panic!("{} is seen as symbols", domain.name) };
    let spec = env.spec().clone();
    let encoder = OneHot::around(&spec, JOINT).expect("symbols are whole numbers");
    let (experience, counts) = wander(&mut env, &spec, seed, transitions, truth.len());
    let plausibility = Plausibility {
        batch: transitions,
        lspi: Lspi { features, ..Lspi::default() },
        ..Plausibility::default()
    };
    let goals = single_bits(truth.len());
    let mut rng = seed.stream("judge", 0);
    let judged = plausibility
        .judge(&experience, &encoder, spec.action.choices(), &goals, &counts, &mut rng)
        .expect("there is experience");
    let observed: Vec<(bool, Judgement)> = truth
        .iter()
        .copied()
        .zip(judged.goals)
        .filter(|(_, judgement)| *judgement != Judgement::Unobserved)
        .collect();
    let sweep = |reachable: f32| {
        let at = |at: usize| {
            let controllable = (at as f64 * STEP) as f32;
            let plausibility = Plausibility { reachable, controllable, ..plausibility.clone() };
            scores(observed.iter().map(|(truth, judgement)| (*truth, plausibility.accepts(judgement))))
        };
        (0..THRESHOLDS).map(at).collect()
    };
    Outcome {
        observed: observed.len(),
        absent: observed.iter().filter(|(_, judgement)| *judgement == Judgement::Absent).count(),
        narrow: judged.narrow,
        all_yes: scores(observed.iter().map(|(truth, _)| (*truth, true)))[2],
        // Every reach is more than −1.
        controllable: sweep(-1.0),
        plausible: sweep(plausibility.reachable),
    }
}

/// Precision, recall and F1 of pairs of truth and answer. With no right yes, 0.
fn scores(pairs: impl Iterator<Item = (bool, bool)>) -> [f64; 3] {
    let (mut right, mut wrong, mut missed) = (0.0, 0.0, 0.0);
    for pair in pairs {
        match pair {
            (true, true) => right += 1.0,
            (false, true) => wrong += 1.0,
            (true, false) => missed += 1.0,
            (false, false) => {}
        }
    }
    let share = |of: f64| if right > 0.0 { right / of } else { 0.0 };
    [share(right + wrong), share(right + missed), share(right + (wrong + missed) / 2.0)]
}

/// Each proto-goal as a goal of its own.
pub(super) fn single_bits(len: usize) -> Vec<Wanted> {
    let single = |bit| {
        let mut bits = Bits::new(len);
        bits.set(bit);
        Wanted(bits)
    };
    (0..len).map(single).collect()
}

/// Random actions; and how often each proto-goal held after one.
fn wander(
    env: &mut impl Environment<Observation = Seen, Action = usize>,
    spec: &Spec,
    seed: Seed,
    transitions: usize,
    goals: usize,
) -> (Experience<Seen, usize>, Vec<u64>) {
    let mut experience = Experience::new(transitions);
    let mut counts = vec![0; goals];
    let (mut before, mut after) = (Seen::default(), Seen::default());
    let (mut taken, mut episode) = (0, 0);
    while taken < transitions {
        let mut rng = seed.stream("wander", episode);
        env.reset(seed.number("episode", episode));
        episode += 1;
        env.observe(&mut before);
        experience.begin(&before);
        while taken < transitions {
            let action = rng.random_range(0..spec.action.choices());
            let step = env.step(&action).expect("there is such a choice");
            env.observe(&mut after);
            after.bits.ones().for_each(|bit| counts[bit] += 1);
            let (before_this, after_this) = (&before, &after);
            experience.push(&Transition {
                before: before_this,
                action: &action,
                reward: step.reward,
                after: after_this,
                end: step.end,
            });
            taken += 1;
            if step.end.is_some() {
                break;
            }
            std::mem::swap(&mut before, &mut after);
        }
    }
    (experience, counts)
}
