//! The machine for evidence, on the smallest experiment: stopped, sharded, changed, it comes to the same figure.

mod support;

use std::{
    collections::{BTreeMap, BTreeSet},
    fs::{self, File},
    path::{Path, PathBuf},
    process::Stdio,
    sync::atomic::{AtomicBool, AtomicUsize, Ordering},
    thread::sleep,
    time::Duration,
};

use inroads::{
    config::Config,
    evidence::{self, EvidenceError, Plan, Shard, State, Told, Wanted, Worker},
    session,
};
use serde_json::Value;
use support::{Folder, fail, inroads, succeed};

fn experiments() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments")
}

fn miniature() -> PathBuf {
    experiments().join("fig-miniature.toml")
}

fn plan(file: &Path, runs: &Path) -> Plan {
    Plan::read(file, &Wanted { seeds: None, scale: 1.0, runs: runs.to_owned() }).unwrap()
}

/// Does a part of a plan until some episodes are over; whether it was done by then.
fn work(plan: &Plan, shard: Option<Shard>, until: usize) -> Result<bool, EvidenceError> {
    let (stop, lived) = (AtomicBool::new(false), AtomicUsize::new(0));
    let worker = Worker { plan, shard, fresh: false, jobs: 1, stop: &stop };
    worker.work(&|told| {
        if let Told::Episode(..) = told
            && lived.fetch_add(1, Ordering::Relaxed) + 1 == until
        {
            stop.store(true, Ordering::Relaxed);
        }
    })
}

/// The figure's JSON without what differs from time to time: seconds.
fn numbers(out: &Path) -> Value {
    let text = fs::read_to_string(out.join("figure.json")).unwrap();
    let mut value: Value = serde_json::from_str(&text).unwrap();
    for (list, keys) in [
        ("runs", ["wall_seconds", "commit"]),
        ("arms", ["core_hours", "ms_per_step"]),
        ("claims", ["core_hours", "commits"]),
    ] {
        for entry in value[list].as_array_mut().unwrap() {
            for key in keys {
                assert!(entry.as_object_mut().unwrap().remove(key).is_some(), "{list} {key}");
            }
        }
    }
    value
}

/// The logs of all runs of the miniature.
fn logs(plan: &Plan) -> Vec<(String, Vec<u8>, Vec<u8>)> {
    let read = |path: &Path, log: &str| fs::read(path.join(log)).unwrap();
    let runs = plan.runs.iter();
    runs.map(|run| (run.name.clone(), read(&run.path, "metrics.jsonl"), read(&run.path, "tests.jsonl")))
        .collect()
}

#[test]
fn the_miniature_stopped_and_in_shards_is_the_miniature() {
    let folder = Folder::new("evidence");
    let whole = plan(&miniature(), &folder.join("whole"));
    assert!(work(&whole, None, usize::MAX).unwrap());
    let record = evidence::draw(&whole, &folder.join("whole-figure"), "reproduce").unwrap();
    assert_eq!((record.runs.len(), record.missing.len()), (6, 0));
    assert_eq!(record.claims.len(), 2);
    assert_eq!(serde_json::to_value(record.claims[1].verdict).unwrap(), "supported");
    assert_eq!(record.claims[1].values["chain"].len(), 3, "every seed is told");
    for run in &whole.runs {
        let checkpoints = fs::read_dir(run.path.join("checkpoints")).unwrap().count();
        assert_eq!(checkpoints, 1, "{}: only the newest is kept", run.name);
    }

    // Stopped in its third run, then gone on with.
    let stopped = plan(&miniature(), &folder.join("stopped"));
    assert!(!work(&stopped, None, 137).unwrap());
    let states: Vec<_> = stopped.runs.iter().map(State::of).collect();
    assert_eq!(states[..4], [State::Finished, State::Finished, State::Begun, State::Absent]);
    let half = evidence::draw(&stopped, &folder.join("half-figure"), "reproduce").unwrap();
    assert_eq!((half.runs.len(), half.missing.len()), (2, 4), "what is missing is named");
    assert!(half.missing.contains(&stopped.runs[2].name));
    assert!(work(&stopped, None, usize::MAX).unwrap());

    // In two shards, which share a folder, both agents in each.
    let sharded = plan(&miniature(), &folder.join("sharded"));
    let parts: Vec<Shard> = ["0/2", "1/2"].map(|text| text.parse().unwrap()).to_vec();
    let names =
        |shard| sharded.part(Some(shard)).into_iter().map(|run| run.name.clone()).collect::<BTreeSet<_>>();
    assert!(names(parts[0]).is_disjoint(&names(parts[1])));
    for shard in parts {
        let arms: BTreeSet<_> = sharded.part(Some(shard)).iter().map(|run| run.arm).collect();
        assert_eq!(arms.len(), 2, "a shard of one agent alone could be all of the price");
        assert!(work(&sharded, Some(shard), usize::MAX).unwrap());
    }

    for (name, other) in [("stopped", &stopped), ("sharded", &sharded)] {
        assert!(logs(other) == logs(&whole), "{name}: logs differ");
        let out = folder.join(&format!("{name}-figure"));
        evidence::draw(other, &out, "reproduce").unwrap();
        assert_eq!(numbers(&out), numbers(&folder.join("whole-figure")), "{name}");
        for picture in ["curves.png", "steps.png"] {
            let bytes = |figure: &str| fs::read(folder.join(figure).join(picture)).unwrap();
            assert!(bytes(&format!("{name}-figure")) == bytes("whole-figure"), "{name}: {picture} differs");
        }
    }

    // What is done is not done again.
    let before = fs::metadata(whole.runs[0].path.join("summary.json")).unwrap().modified().unwrap();
    assert!(work(&whole, None, 1).unwrap());
    assert_eq!(fs::metadata(whole.runs[0].path.join("summary.json")).unwrap().modified().unwrap(), before);
}

/// The command on the miniature, in a folder of its own.
fn reproduce(folder: &Folder, file: &Path, more: &[&str]) -> std::process::Command {
    let mut command = inroads(&["reproduce"]);
    command.arg(file).args(more).current_dir(folder.join(""));
    command
}

#[test]
fn the_command_makes_a_figure_and_the_table_of_claims() {
    let folder = Folder::new("reproduce");
    let priced = succeed(&mut reproduce(&folder, &miniature(), &["--dry-run"]));
    let text = String::from_utf8(priced.stdout).unwrap();
    assert!(text.contains("6 runs") && text.contains("core-hours") && text.contains("0 of 3"), "{text}");
    assert_eq!(fs::read_dir(folder.join("")).unwrap().count(), 0, "a dry run writes nothing");

    // Nothing is done yet, and the figure says so.
    let none = succeed(&mut reproduce(&folder, &miniature(), &["--draw", "--out", "empty"]));
    assert!(String::from_utf8(none.stdout).unwrap().contains("not done yet: corridor/chain/0"));

    succeed(&mut reproduce(&folder, &miniature(), &["--fresh", "--jobs", "2"]));
    let figure = folder.join("docs/results/miniature");
    for picture in ["curves.png", "steps.png"] {
        assert!(fs::read(figure.join(picture)).unwrap().starts_with(b"\x89PNG"), "{picture}");
    }
    let first = fs::read(folder.join("runs/miniature/corridor/chain/0/metrics.jsonl")).unwrap();
    let again = succeed(&mut reproduce(&folder, &miniature(), &["--fresh"]));
    assert!(String::from_utf8(again.stderr).unwrap().contains("corridor/chain/0: begins"));
    assert!(fs::read(folder.join("runs/miniature/corridor/chain/0/metrics.jsonl")).unwrap() == first);

    let table = succeed(inroads(&["claims"]).current_dir(folder.join("")));
    let table = String::from_utf8(table.stdout).unwrap();
    let rows: Vec<_> = table.lines().collect();
    assert_eq!(rows.len(), 4, "{table}");
    assert!(rows[3].contains("| supported | 3 of 3 |") && rows[3].contains("`inroads reproduce"), "{table}");

    // A trial with another budget lies elsewhere and claims nothing.
    let trial = succeed(&mut reproduce(&folder, &miniature(), &["--scale", "0.1", "--seeds", "1"]));
    assert!(!String::from_utf8(trial.stdout).unwrap().contains("supported"));
    let scaled = folder.join("runs/miniature-x0.1");
    let config = fs::read_to_string(scaled.join("corridor/chain/0/config.toml")).unwrap();
    assert!(config.contains("\nepisodes = 6\n"), "{config}");
    assert_eq!(numbers(&scaled.join("figure"))["claims"], Value::Array(Vec::new()));
}

#[test]
fn runs_with_other_settings_are_refused_unless_all_is_fresh() {
    let folder = Folder::new("changed");
    let text = fs::read_to_string(miniature()).unwrap();
    let file = folder.join("fig-changed.toml");
    fs::write(&file, &text).unwrap();
    succeed(&mut reproduce(&folder, &file, &["--seeds", "1"]));
    let run = folder.join("runs/miniature/corridor/flat/0");
    let before = fs::read(run.join("metrics.jsonl")).unwrap();

    fs::write(&file, text.replace("test_every = 5", "test_every = 6")).unwrap();
    let error = fail(&mut reproduce(&folder, &file, &["--seeds", "1"]));
    for words in ["fig-changed.toml", "corridor/flat/0", "test_every is 5, asked for is 6", "--fresh"] {
        assert!(error.contains(words), "{words} is not in: {error}");
    }
    assert!(fs::read(run.join("metrics.jsonl")).unwrap() == before, "nothing was touched");
    succeed(&mut reproduce(&folder, &file, &["--seeds", "1", "--fresh"]));
    assert!(fs::read_to_string(run.join("config.toml")).unwrap().contains("test_every = 6"));
}

#[test]
fn a_run_that_another_process_has_is_left_to_it() {
    let folder = Folder::new("locked");
    let plan = plan(&miniature(), &folder.join("runs"));
    let locks = plan.folder.join(".locks");
    fs::create_dir_all(&locks).unwrap();
    let taken = File::create(locks.join("corridor+chain+0")).unwrap();
    taken.lock().unwrap();
    assert!(work(&plan, None, usize::MAX).unwrap());
    assert_eq!(plan.missing(), ["corridor/chain/0"]);
    drop(taken);
    assert!(work(&plan, None, usize::MAX).unwrap());
    assert_eq!(plan.missing(), [""; 0]);
}

#[test]
fn ctrl_c_saves_and_the_same_command_goes_on() {
    let folder = Folder::new("interrupted");
    let more = ["--scale", "20", "--seeds", "1", "--shard", "0/2"];
    let mut child = reproduce(&folder, &miniature(), &more).stderr(Stdio::piped()).spawn().unwrap();
    let run = folder.join("runs/miniature-x20/corridor/chain/0");
    let lines = || fs::read_to_string(run.join("metrics.jsonl")).unwrap_or_default().lines().count();
    while lines() < 50 {
        assert!(child.try_wait().unwrap().is_none(), "it ended before it could be stopped");
        sleep(Duration::from_millis(1));
    }
    std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    let output = child.wait_with_output().unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success() && text.contains("goes on"), "{text}");
    assert!(!run.join("summary.json").exists() && (50..1200).contains(&lines()));
    let text = String::from_utf8(succeed(&mut reproduce(&folder, &miniature(), &more)).stderr).unwrap();
    assert!(text.contains("goes on after"), "{text}");
    assert!(run.join("summary.json").exists() && lines() == 1200);
}

/// What stands in a file's place and what the error says of it.
const SLIPS: [(&str, &str, &[&str]); 12] = [
    ("seeds = 3", "seeds = 3\nsed = 4", &["unknown field `sed`"]),
    ("seeds = 3", "seeds = 0", &["`seeds` must be at least 1"]),
    (
        "agent = \"q-learning\"",
        "agent = \"q-learner\"",
        &["arm `flat`", "domain `corridor`", "did you mean `q-learning`"],
    ),
    ("environment = \"corridor-20\"", "environment = \"corridor-21\"", &["corridor-20"]),
    ("test_every = 5", "test_evry = 5", &["`test_evry`", "did you mean `test_every`"]),
    ("test_every = 5", "test_every = 5\nepisodes = 9", &["`settings` sets `episodes`", "budget.episodes"]),
    (
        "budget = { episodes = 60, steps_an_episode = 60 }",
        "budget = { episodes = 60 }",
        &["steps_an_episode"],
    ),
    ("ms_per_step = 0.06", "ms_per_step = 0", &["arm `chain`", "measured number above 0"]),
    ("better = \"chain\"", "better = \"chains\"", &["there is no arm `chains`; there are chain, flat"]),
    ("worse = \"flat\"\n", "", &["set `better` and `worse`"]),
    (
        "of = [\"test_steps\", \"options\", \"chain\"]",
        "of = [\"test_step\"]",
        &["unknown variant `test_step`", "`test_steps`"],
    ),
    ("name = \"flat\"", "name = \"chain\"", &["two of `arm` have the name `chain`"]),
];

#[test]
fn slips_in_an_experiment_file_are_named_with_the_mend() {
    let folder = Folder::new("slips");
    let text = fs::read_to_string(miniature()).unwrap();
    let file = folder.join("fig-slip.toml");
    for (right, wrong, said) in SLIPS {
        assert!(text.contains(right), "{right}");
        fs::write(&file, text.replacen(right, wrong, 1)).unwrap();
        let error = fail(&mut reproduce(&folder, &file, &["--dry-run"]));
        assert!(error.contains("fig-slip.toml"), "{error}");
        said.iter().for_each(|words| assert!(error.contains(words), "{words} is not in: {error}"));
    }
    let error = fail(&mut reproduce(&folder, &miniature(), &["--shard", "2/2"]));
    assert!(error.contains("I from 0 to N - 1"), "{error}");
    let error = fail(inroads(&["reproduce", "9.9"]).current_dir(env!("CARGO_MANIFEST_DIR")));
    assert!(error.contains("fig-9-9.toml") && error.contains("miniature"), "{error}");
}

#[test]
fn every_experiment_of_the_repository_can_be_run() {
    let mut count = 0;
    let mut shared: BTreeMap<PathBuf, Config> = BTreeMap::new();
    for entry in fs::read_dir(experiments()).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if !name.starts_with("fig-") {
            continue;
        }
        count += 1;
        let wanted = Wanted { seeds: Some(1), scale: 1.0, runs: "runs".into() };
        let plan = Plan::read(&path, &wanted).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(name, format!("fig-{}.toml", plan.experiment.figure.replace('.', "-")));
        assert!(!plan.experiment.thesis.is_empty() && !plan.experiment.claims.is_empty(), "{name}");
        for run in &plan.runs {
            assert!(run.steps > 0 && run.ms_per_step > 0.0, "{name}: {} has no price", run.name);
            let other = shared.entry(run.path.clone()).or_insert_with(|| run.config.clone());
            assert!(*other == run.config, "{name}: {} is another run in another figure", run.name);
            session::build(&run.config).unwrap_or_else(|error| panic!("{name}: {}: {error}", run.name));
        }
        let arms = plan.experiment.arms.len();
        let used: BTreeSet<_> = plan.runs.iter().map(|run| run.arm).collect();
        assert_eq!(used.len(), arms, "{name}: an arm has no run with the first seed");
    }
    assert!(count > 0);
}
