//! Figure 5.4 in small: sets learned while policies are, by a binary classifier, a weighted one and value functions.
//!
//! Price: eight ways to learn a set × 10 seeds × 2 worlds × 4,000 queries at about 0.3 ms, and 24 settings × 3 seeds of
//! tuning.

mod looks;
mod practice;
mod truth;
mod ways;

use inroads::figures::{Heat, Panel, Series, Summary, curves, heat};
use inroads::statistics::{Estimate, Verdict, mean_interval, superiority};
use serde::Serialize;

use crate::Options;
use crate::support::{Done, over_seeds, write};
use looks::{Look, Picture, QUERIES, practised};
use practice::{GOALS, rooms};
use truth::Cells;
use ways::{Sets, Tuned, Way, tuned_over};

/// Seeds of the tuning, which no result has.
const TUNING: std::ops::Range<u64> = 1000..1003;
/// Worlds: whether moves go astray.
const WORLDS: [(&str, f64); 2] = [("rooms", 0.0), ("rooms-noisy", inroads::envs::rooms::SLIP)];

/// What is compared: its name, and how a run is summed up, over its second half where the claim is about learning's
/// later part.
type Measure = (&'static str, fn(&[Look]) -> f64);
const MEASURES: [Measure; 5] = [
    ("accuracy", |run| late(run, |look| look.accuracy)),
    ("balanced accuracy", |run| late(run, |look| look.balanced)),
    ("predicted size", |run| late(run, |look| look.predicted)),
    ("true size", |run| late(run, |look| look.actual)),
    ("executions", |run| run.last().map_or(0.0, |look| look.executions as f64)),
];

/// The mean over the second half of a run.
fn late(run: &[Look], of: impl Fn(&Look) -> f64) -> f64 {
    let half = &run[run.len() / 2..];
    half.iter().map(of).sum::<f64>() / half.len() as f64
}

#[derive(Serialize)]
struct Report {
    queries: u64,
    seeds: u64,
    /// Mean balanced accuracy over all looks of the tuning's seeds, by setting.
    tuning: Vec<(&'static str, Sets, f64)>,
    worlds: Vec<WorldReport>,
}

#[derive(Serialize)]
struct WorldReport {
    world: &'static str,
    results: Vec<Row>,
    claims: Vec<Claim>,
}

#[derive(Serialize)]
struct Row {
    way: &'static str,
    measure: &'static str,
    mean: Estimate,
    /// One number a seed.
    seeds: Vec<f64>,
}

#[derive(Serialize)]
struct Claim {
    claim: String,
    superiority: Estimate,
    verdict: Verdict,
}

pub(crate) fn run(options: &Options) -> Done {
    let seeds = options.seeds.unwrap_or(10);
    let mut tuning = Vec::new();
    let ways: Vec<Way> = tuned_over().into_iter().flat_map(|tuned| tune(&tuned, &mut tuning)).collect();
    let mut report = Report { queries: QUERIES, seeds, tuning, worlds: Vec::new() };
    for (world, slip) in WORLDS {
        println!("\n{world}: {QUERIES} queries, {seeds} seeds; means over the second half");
        let runs: Vec<(Vec<Vec<Look>>, Vec<Picture>)> = ways
            .iter()
            .map(|way| over_seeds(seeds, |seed| practised(way, seed, slip)).into_iter().unzip())
            .collect();
        let compared: Vec<_> = ways.iter().map(|way| way.name).zip(runs.iter().map(|run| &run.0)).collect();
        let results = rows(&compared);
        let claims = claims(&compared);
        draw(options, world, &compared)?;
        draw_sets(options, world, &ways, &runs)?;
        report.worlds.push(WorldReport { world, results, claims });
    }
    write(options, "initiation", &report)
}

/// The ways with the setting that has the greatest balanced accuracy over all looks, in the world without noise.
fn tune(Tuned { over, ways }: &Tuned, tuning: &mut Vec<(&'static str, Sets, f64)>) -> Vec<Way> {
    let (name, bonus) = *ways.last().expect("a setting is somebody's");
    let score = |sets: &Sets| {
        let way = Way { name, sets: sets.clone(), bonus };
        let runs = over_seeds(TUNING.end - TUNING.start, |seed| practised(&way, TUNING.start + seed, 0.0).0);
        let looks: Vec<f64> = runs.iter().flatten().map(|look| look.balanced).collect();
        looks.iter().sum::<f64>() / looks.len() as f64
    };
    let mut best = (0, f64::NEG_INFINITY);
    for (index, sets) in over.iter().enumerate().filter(|_| over.len() > 1) {
        let score = score(sets);
        println!("{name}: balanced accuracy {score:.3} with {sets:?}");
        tuning.push((name, sets.clone(), score));
        best = if score > best.1 { (index, score) } else { best };
    }
    ways.iter().map(|&(name, bonus)| Way { name, sets: over[best.0].clone(), bonus }).collect()
}

fn rows(compared: &[(&'static str, &Vec<Vec<Look>>)]) -> Vec<Row> {
    let mut rows = Vec::new();
    print!("{:26}", "");
    MEASURES.iter().for_each(|(name, _)| print!("{name:>24}"));
    for (way, runs) in compared {
        print!("\n{way:26}");
        for (measure, of) in MEASURES {
            let seeds: Vec<f64> = runs.iter().map(|run| of(run)).collect();
            let mean = mean_interval(&seeds);
            let digits = if mean.value > 10.0 { 0 } else { 3 };
            print!("{:>24}", format!("{mean:.digits$}"));
            rows.push(Row { way, measure, mean, seeds });
        }
    }
    println!();
    rows
}

fn claims(compared: &[(&'static str, &Vec<Vec<Look>>)]) -> Vec<Claim> {
    let of = |name: &str, measure: fn(&[Look]) -> f64| -> Vec<f64> {
        let (_, runs) = compared.iter().find(|(way, _)| *way == name).expect("the way is compared");
        runs.iter().map(|run| measure(run)).collect()
    };
    let mut claims = Vec::new();
    let mut claim = |claim: String, x: &[f64], y: &[f64]| {
        let superiority = superiority(x, y);
        let verdict = Verdict::of(&superiority);
        println!("{claim:64} {superiority} {verdict:?}");
        claims.push(Claim { claim, superiority, verdict });
    };
    for ours in ["weighted + progress", "IVF (table) + progress", "IVF (network) + progress"] {
        for (measure, value) in &MEASURES[..4] {
            claim(format!("{measure}: {ours} above binary"), &of(ours, *value), &of("binary", *value));
        }
    }
    let early = |run: &[Look]| run.iter().map(|look| look.accuracy).fold(0.0, f64::max);
    let end = |run: &[Look]| run.last().map_or(0.0, |look| look.accuracy);
    claim("accuracy of binary: best above last".into(), &of("binary", early), &of("binary", end));
    claims
}

fn draw(options: &Options, world: &str, compared: &[(&'static str, &Vec<Vec<Look>>)]) -> Done {
    let shown = [
        ("binary", 6),
        ("weighted + progress", 3),
        ("IVF (table) + progress", 1),
        ("IVF (network) + progress", 2),
        ("anywhere", 0),
    ];
    let panel = |title: &str, of: fn(&Look) -> f64| Panel {
        title: format!("{title} ({world})"),
        x_label: "queries for an execution".into(),
        y_label: title.into(),
        y_range: Some((0.0, 1.0)),
        summary: Summary::MeanAndInterval,
        series: shown
            .iter()
            .filter_map(|(name, colour)| {
                let (_, runs) = compared.iter().find(|(way, _)| way == name)?;
                let points =
                    |run: &Vec<Look>| run.iter().map(|look| (look.queries as f64, of(look))).collect();
                let runs = runs.iter().map(points).collect();
                Some(Series { label: (*name).into(), colour: *colour, runs })
            })
            .collect(),
        ..Panel::default()
    };
    let panels = [
        panel("accuracy", |look| look.accuracy),
        panel("balanced accuracy", |look| look.balanced),
        panel("predicted size", |look| look.predicted),
        panel("true size", |look| look.actual),
    ];
    Ok(curves(options.out.join(format!("initiation-{world}.png")), &panels)?)
}

/// The set of the first option at the end over what is true, of each way's median seed by balanced accuracy.
fn draw_sets(options: &Options, world: &str, ways: &[Way], runs: &[(Vec<Vec<Look>>, Vec<Picture>)]) -> Done {
    let cells = Cells::new(0.0);
    let grid = |way: &Way, (looks, pictures): &(Vec<Vec<Look>>, Vec<Picture>)| {
        let score = |seed: &usize| late(&looks[*seed], |look| look.balanced);
        let mut order: Vec<usize> = (0..looks.len()).collect();
        order.sort_by(|a, b| score(a).total_cmp(&score(b)));
        let seed = order[(order.len() - 1) / 2];
        let size = rooms(GOALS[0], 0.0).size();
        let columns = usize::from(size[0]);
        let place = |[x, y]: [u8; 2]| usize::from(y) * columns + usize::from(x);
        let mut picture = Heat {
            title: way.name.to_owned(),
            note: format!("seed {seed}"),
            columns,
            cells: vec![None; columns * usize::from(size[1])],
            inside: vec![false; columns * usize::from(size[1])],
            goal: Some(place(GOALS[0])),
        };
        for (index, cell) in cells.at.iter().enumerate() {
            picture.cells[place(*cell)] = Some(pictures[seed].truth[index]);
            picture.inside[place(*cell)] = pictures[seed].inside[index] && *cell != GOALS[0];
        }
        picture
    };
    let grids: Vec<_> = ways.iter().zip(runs).map(|(way, run)| grid(way, run)).collect();
    let caption = format!(
        "{world}: the option that goes to the middle of the first room, at the end. Colour: true probability of \
         success of its policy. Outline: its initiation set, as learned. Each way's median seed by balanced accuracy."
    );
    Ok(heat(options.out.join(format!("initiation-{world}-sets.png")), &grids, 4, &caption)?)
}
