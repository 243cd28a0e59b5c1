//! What is drawn of many runs, and the JSON beside it.

use std::{collections::BTreeMap, fs, path::Path};

use super::{
    ArmCost, Axis, Draw, Metric, Plan, Point, Quantity, Record, RunRecord, picture, record, work::begun_by,
};
use crate::{
    figures::{self, Column, Dots, Panel, Series, Sheet, Summary},
    run::{Folder, RunError},
};

/// Missing runs that a picture names one by one.
const NAMED: usize = 6;
/// Panels in a row, where each has a domain of its own.
const ACROSS: usize = 3;

/// A run that is done, with what is drawn of it.
struct Done {
    domain: usize,
    arm: usize,
    seed: u64,
    folder: Folder,
    curves: BTreeMap<Quantity, Vec<Point>>,
}

/// Draws the figure of a plan from the runs that are done into a folder, and writes its JSON, with `command` as how it is made.
///
/// # Errors
/// [`RunError`] names the file that cannot be read or written.
pub fn draw(plan: &Plan, out: &Path, command: &str) -> Result<Record, RunError> {
    fs::create_dir_all(out).map_err(RunError::io("make", out))?;
    let done = gather(plan)?;
    let runs = records(plan, &done)?;
    let mut record = Record {
        figure: plan.experiment.figure.clone(),
        title: plan.experiment.title.clone(),
        thesis: plan.experiment.thesis.clone(),
        note: plan.experiment.note.clone(),
        command: command.to_owned(),
        scale: plan.scale,
        metric: plan.experiment.metric,
        claims: Vec::new(),
        arms: costs(plan, &runs),
        missing: plan.missing(),
        pictures: Vec::new(),
        runs,
    };
    if plan.scale == 1.0 {
        let claims = plan.experiment.claims.iter().map(|claim| claim.judged(plan, &record.runs));
        record.claims = claims.collect::<Result<_, _>>()?;
    }
    let remark = remark(&record.missing);
    for draw in &plan.experiment.draws {
        let path = out.join(draw.file()).with_extension("png");
        match draw {
            Draw::Curves { of, over, smoothing, .. } => {
                let panels = curves(plan, &done, (of, *over, *smoothing));
                let columns = if of.len() > 1 { of.len() } else { panels.len().min(ACROSS) };
                figures::curves_on(&path, &panels, &Sheet { columns, remark: remark.clone() })?;
            }
            Draw::Dots { metric, .. } => {
                let dots = dots(plan, &done, metric.unwrap_or(plan.experiment.metric))?;
                figures::dots(&path, &dots, &remark)?;
            }
            Draw::Sets { .. } | Draw::Trajectories { .. } => {
                record.pictures.extend(picture::draw(plan, draw, out)?);
            }
        }
    }
    record.write(out)?;
    Ok(record)
}

/// All runs that are done.
fn gather(plan: &Plan) -> Result<Vec<Done>, RunError> {
    let drawn: Vec<Quantity> = plan
        .experiment
        .draws
        .iter()
        .flat_map(|draw| if let Draw::Curves { of, .. } = draw { of.clone() } else { Vec::new() })
        .collect();
    let mut done = Vec::new();
    for (domain, arm) in plan.pairs() {
        for (seed, folder) in plan.finished(domain, arm)? {
            let curves = drawn.iter().map(|quantity| Ok((*quantity, quantity.along(&folder)?)));
            let curves = curves.collect::<Result<_, RunError>>()?;
            done.push(Done { domain, arm, seed, folder, curves });
        }
    }
    Ok(done)
}

fn records(plan: &Plan, done: &[Done]) -> Result<Vec<RunRecord>, RunError> {
    let record = |run: &Done| {
        let summary = run.folder.read_summary()?;
        Ok(RunRecord {
            domain: plan.experiment.domains[run.domain].name.clone(),
            arm: plan.experiment.arms[run.arm].name.clone(),
            seed: run.seed,
            episodes: summary.episodes,
            steps: summary.env_steps,
            wall_seconds: record::short(summary.wall_seconds),
            commit: begun_by(run.folder.path()),
            value: plan.experiment.metric.of(&run.folder)?.map(record::short),
            curves: run
                .curves
                .iter()
                .map(|(quantity, points)| (*quantity, record::thinned(points)))
                .collect(),
        })
    };
    done.iter().map(record).collect()
}

fn costs(plan: &Plan, runs: &[RunRecord]) -> Vec<ArmCost> {
    let cost = |(domain, arm): (usize, usize)| {
        let (domain, arm) = (&plan.experiment.domains[domain].name, &plan.experiment.arms[arm].name);
        let own = || runs.iter().filter(|run| run.domain == *domain && run.arm == *arm);
        let (steps, seconds) =
            (own().map(|run| run.steps).sum(), own().fold(0.0, |sum, run| sum + run.wall_seconds));
        ArmCost {
            domain: domain.clone(),
            arm: arm.clone(),
            runs: own().count(),
            steps,
            core_hours: record::short(seconds / 3600.0),
            ms_per_step: if steps > 0 { record::short(1e3 * seconds / steps as f64) } else { 0.0 },
        }
    };
    plan.pairs().into_iter().map(cost).collect()
}

/// What a picture says of runs that are not done.
fn remark(missing: &[String]) -> String {
    let named = missing.iter().take(NAMED).cloned().collect::<Vec<_>>().join(", ");
    match missing.len().saturating_sub(NAMED) {
        _ if missing.is_empty() => String::new(),
        0 => format!("not done yet: {named}"),
        more => format!("not done yet: {named} and {more} more"),
    }
}

fn curves(plan: &Plan, done: &[Done], (of, over, smoothing): (&[Quantity], Axis, usize)) -> Vec<Panel> {
    let x = |point: &Point| match over {
        Axis::Steps => point.steps as f64,
        Axis::Episodes => point.episodes as f64,
    };
    let mut panels = Vec::new();
    for (d, domain) in plan.experiment.domains.iter().enumerate() {
        let own = || done.iter().filter(|run| run.domain == d);
        let far = |run: &Done| of.iter().filter_map(|q| run.curves[q].last()).map(&x).fold(0.0, f64::max);
        let end = own().map(far).fold(0.0, f64::max);
        for quantity in of {
            let line = |run: &Done| run.curves[quantity].iter().map(|p| (x(p), p.value)).collect();
            let series = plan.pairs().into_iter().filter(|(domain, _)| *domain == d).map(|(_, a)| Series {
                label: plan.experiment.arms[a].label().to_owned(),
                colour: a + 1,
                runs: own().filter(|run| run.arm == a).map(line).collect(),
            });
            let log = *quantity == Quantity::Chain;
            panels.push(Panel {
                title: domain.label().to_owned(),
                x_label: match over {
                    Axis::Steps => "environment steps".to_owned(),
                    Axis::Episodes => "training episodes".to_owned(),
                },
                y_label: quantity.label().to_owned(),
                x_range: (end > 0.0).then_some((0.0, end)),
                y_range: quantity
                    .is_share()
                    .then_some((if log { decade(own(), *quantity) } else { 0.0 }, 1.0)),
                log,
                // On an axis of logarithms a mean would be that of its largest seeds.
                summary: if quantity.is_share() && !log {
                    Summary::MeanAndInterval
                } else {
                    Summary::MedianAndRange
                },
                smoothing,
                series: series.collect(),
                ..Panel::default()
            });
        }
    }
    panels
}

/// The power of ten below all values above 0, for an axis of logarithms; at most a hundredth.
fn decade<'a>(runs: impl Iterator<Item = &'a Done>, quantity: Quantity) -> f64 {
    let values = runs.flat_map(|run| &run.curves[&quantity]).map(|point| point.value);
    let least = values.filter(|value| *value > 0.0).fold(0.01, f64::min);
    10f64.powf(least.log10().floor())
}

fn dots(plan: &Plan, done: &[Done], metric: Metric) -> Result<Vec<Dots>, RunError> {
    let mut panels = Vec::new();
    for (d, domain) in plan.experiment.domains.iter().enumerate() {
        let mut columns = Vec::new();
        for (_, a) in plan.pairs().into_iter().filter(|(domain, _)| *domain == d) {
            let mut values = Vec::new();
            for run in done.iter().filter(|run| (run.domain, run.arm) == (d, a)) {
                values.extend(metric.of(&run.folder)?);
            }
            columns.push(Column { label: plan.experiment.arms[a].label().to_owned(), colour: a + 1, values });
        }
        panels.push(Dots {
            title: domain.label().to_owned(),
            y_label: metric.words(),
            y_range: metric.of.is_share().then_some((0.0, 1.0)),
            columns,
        });
    }
    Ok(panels)
}
