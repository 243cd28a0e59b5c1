//! Throughput of what everything else is made of: `cargo bench --bench throughput`.
//!
//! A line a workload, and all of them in `target/throughput.json`. How a number is come by stands in
//! `measure.rs`: undisturbed speed, and the same relative to a calibration loop timed in the same moments.
#![allow(clippy::print_stdout)] // what the command is for

mod bodies;
mod calibration;
mod compare;
mod control;
mod cost;
mod evaluator;
mod learners;
mod measure;
mod planning;
mod processor;
mod recurrent;
mod refits;
mod training;
mod workload;
mod worlds;

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
    process::ExitCode,
    time::Duration,
};

use clap::Parser;
use serde_json::json;

use crate::{
    calibration::Yardstick,
    compare::{AGAIN, TOLERANCE, Verdict, judge},
    measure::{Effort, Measured, plainly},
    workload::Workload,
};

/// Measures steps a second of environments, simulators and learners.
#[derive(Parser)]
struct Options {
    /// One short round, to see that it works.
    #[arg(long)]
    quick: bool,
    /// Compare with this file: fail when a workload has become slower, relative to a calibration loop.
    #[arg(long, value_name = "FILE", conflicts_with = "quick")]
    against: Option<PathBuf>,
    /// Write this processor's part of this file.
    #[arg(long, value_name = "FILE", conflicts_with = "quick")]
    record: Option<PathBuf>,
    /// Print two numbers: operations of this workload in a second of processor time and of the clock's, as many as are
    /// done in `--seconds`.
    #[arg(long, value_name = "WORKLOAD")]
    only: Option<String>,
    /// Print what a step of the environment costs each agent, by part; or this agent.
    #[arg(long, value_name = "AGENT", num_args = 0..=1, default_missing_value = "")]
    cost: Option<String>,
    /// How long `--only` measures.
    #[arg(long, value_name = "SECONDS", default_value_t = 1.0)]
    seconds: f64,
    /// Draw out this workload to 1.25 times its length, to see that `--against` notices.
    #[arg(long, value_name = "WORKLOAD", hide = true)]
    slow: Option<String>,
    /// What cargo calls every benchmark with.
    #[arg(long, hide = true)]
    bench: bool,
}

/// What was recorded: for every processor the relative speeds of its workloads.
type Baseline = BTreeMap<String, BTreeMap<String, f64>>;

/// A speed of four fifths.
const SLOW: f64 = 1.25;
/// Seconds between attempts at what seems slower.
const PAUSE: f64 = 1.0;

fn main() -> ExitCode {
    match run(&Options::parse()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

/// Whether nothing has become slower.
fn run(options: &Options) -> Result<bool, String> {
    let mut workloads = bodies::bodies();
    workloads.extend(worlds::worlds());
    workloads.extend(learners::ddpg());
    workloads.extend(recurrent::r2d2());
    workloads.extend(learners::td3());
    workloads.extend(control::control());
    workloads.extend(training::training());
    workloads.extend(evaluator::evaluator());
    workloads.extend(planning::planning());
    workloads.extend(refits::refits());
    if let Some(name) = &options.only {
        let names = workloads.iter().map(|w| w.name.clone()).collect::<Vec<_>>().join("\n  ");
        let found = workloads.iter_mut().find(|w| w.name == *name);
        let found = found.ok_or_else(|| format!("there is no workload `{name}`; all of them:\n  {names}"))?;
        let [processor, clock] = plainly(found, options.seconds);
        println!("{processor:.4} {clock:.4}");
        return Ok(true);
    }
    if let Some(agent) = &options.cost {
        cost::table(Some(&**agent).filter(|agent| !agent.is_empty()), |name| {
            let refit = workloads.iter_mut().find(|w| w.name == name);
            1e6 / plainly(refit.expect("it is among the refits"), 1.0)[0]
        });
        return Ok(true);
    }
    let effort = if options.quick {
        Effort { rounds: 1, repetitions: 1 }
    } else {
        Effort { rounds: 9, repetitions: 8 }
    };
    let baseline = options.against.as_deref().map(read).transpose()?;
    let mut yardstick = Yardstick::new();
    let mut all = measure(workloads, &mut yardstick, effort, options.slow.as_deref());
    for measured in &all {
        let micros = measured.micros();
        println!("{:<44} {micros:>12.3} µs {:>14.0} a second", measured.workload.name, 1e6 / micros);
    }
    ratios(&all);
    write_results(&all);
    if let Some(path) = &options.record {
        record(path, &all)?;
    }
    baseline.map_or(Ok(true), |baseline| Ok(against(&baseline, &mut all, &mut yardstick, effort)))
}

/// Every workload in every round, so that each is spread over the whole time.
fn measure(
    workloads: Vec<Workload>,
    yardstick: &mut Yardstick,
    effort: Effort,
    slow: Option<&str>,
) -> Vec<Measured> {
    let mut all: Vec<Measured> = workloads.into_iter().map(|w| Measured::new(w, yardstick)).collect();
    for measured in &mut all {
        measured.handicap = if slow == Some(&measured.workload.name) { SLOW } else { 1.0 };
    }
    for _ in 0..effort.rounds {
        for measured in &mut all {
            let round = measured.round(yardstick, effort.repetitions);
            measured.rounds.push(round);
        }
    }
    all
}

/// What is said of two workloads together.
fn ratios(all: &[Measured]) {
    let of = |name: &str| all.iter().find(|m| m.workload.name == name).map_or(f64::NAN, Measured::micros);
    let alone = of(&format!("{}{}", learners::UPDATE, learners::ALONE));
    let (one, two) = (of(bodies::ONE_THREAD), of(bodies::TWO_THREADS));
    println!("two threads step the ants {:.2} times as fast as one", one / two);
    worlds::in_copies(all);
    let events = of(evaluator::PREPARE) + 300.0 * of(evaluator::EVENT);
    println!("300 proto-goals that occur are judged in {:.2} s", events * 1e-6);
    println!("a DDPG update takes {:.2} times its matrix products alone", of(learners::UPDATE) / alone);
}

/// Everything, in `target/throughput.json`.
fn write_results(all: &[Measured]) {
    let workloads: serde_json::Map<String, serde_json::Value> = all
        .iter()
        .map(|m| {
            let micros = m.micros();
            let found = json!({ "micros": micros, "per_second": 1e6 / micros, "relative": m.relative() });
            (m.workload.name.clone(), found)
        })
        .collect();
    let results = json!({ "processor": processor::name(), "workloads": workloads });
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/target/throughput.json");
    match std::fs::write(path, format!("{results:#}\n")) {
        Ok(()) => println!("wrote {path}"),
        Err(error) => println!("could not write {path}: {error}"),
    }
}

fn read(path: &Path) -> Result<Baseline, String> {
    let text = std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    serde_json::from_str(&text).map_err(|error| {
        format!("{}: {error}; record it again with `-- --record {}`", path.display(), path.display())
    })
}

/// Writes this processor's part of the file and leaves the others'.
fn record(path: &Path, all: &[Measured]) -> Result<(), String> {
    let mut baseline = if path.exists() { read(path)? } else { Baseline::new() };
    // Four digits say more than is known.
    let rounded = |x: f64| format!("{x:.3e}").parse().unwrap_or(x);
    let relative = all.iter().map(|m| (m.workload.name.clone(), rounded(m.relative()))).collect();
    baseline.insert(processor::name(), relative);
    let text = serde_json::to_string_pretty(&baseline).map_err(|error| error.to_string())?;
    std::fs::write(path, text + "\n").map_err(|error| format!("{}: {error}", path.display()))?;
    println!("recorded `{}` in {}", processor::name(), path.display());
    Ok(())
}

/// Compares with what was recorded, and says what has become slower.
fn against(baseline: &Baseline, all: &mut [Measured], yardstick: &mut Yardstick, effort: Effort) -> bool {
    let name = processor::name();
    let Some(expected) = baseline.get(&name) else {
        println!("nothing is recorded for this processor, `{name}`, so nothing is compared; record it with");
        println!("  cargo bench --bench throughput -- --record benches/baseline.json");
        return true;
    };
    for gone in expected.keys().filter(|name| all.iter().all(|m| m.workload.name != **name)) {
        println!("{gone} is recorded, but nobody measures it any more; record again (`-- --record`)");
    }
    let mut slower = 0;
    for measured in all {
        let name = measured.workload.name.clone();
        let Some(&expected) = expected.get(&name) else {
            println!("{name} is new: it is compared once it is recorded (`-- --record`)");
            continue;
        };
        let found = measured.relative();
        let verdict = judge(expected, found, || {
            std::thread::sleep(Duration::from_secs_f64(PAUSE));
            let again = measured.again(yardstick, effort);
            println!("{name}: {:.3} of what is recorded; again: {:.3}", found / expected, again / expected);
            again
        });
        match verdict {
            Verdict::Kept => {}
            Verdict::Faster => println!("{name} has become faster; record it (`-- --record`)"),
            Verdict::Slower(_) if !measured.has_room(yardstick) => {
                println!("{name} is not judged: others are busy on the processors that it needs");
            }
            Verdict::Slower(found) => {
                slower += 1;
                let (percent, attempts) = (100.0 * (1.0 - found / expected), AGAIN + 1);
                println!("{name} HAS BECOME SLOWER by {percent:.0} %: expected {expected:.4} operations");
                println!(
                    "  in the time of a calibration loop, found {found:.4}, the most of {attempts} attempts"
                );
            }
        }
    }
    if slower == 0 {
        println!("nothing is slower than recorded by more than {:.0} %", 100.0 * TOLERANCE);
    }
    slower == 0
}
