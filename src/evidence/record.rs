//! The JSON of a figure, and the table of all claims.

use std::{collections::BTreeMap, fs, path::Path};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{EvidenceError, Judged, Metric, Point, Quantity};
use crate::run::RunError;

/// The name of the JSON in a figure's folder.
pub(super) const FILE: &str = "figure.json";
/// Points of a curve that the JSON has at most.
const POINTS: usize = 200;

/// A figure, as plain data.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Its name.
    pub figure: String,
    /// Its title.
    pub title: String,
    /// What the thesis claims.
    pub thesis: String,
    /// What is known of how it came out.
    pub note: String,
    /// How it is made.
    pub command: String,
    /// By what budgets were multiplied; only 1 makes claims.
    pub scale: f64,
    /// By what runs are compared.
    pub metric: Metric,
    /// The verdicts.
    pub claims: Vec<Judged>,
    /// What each arm cost in each domain.
    pub arms: Vec<ArmCost>,
    /// The runs that are not done, as `DOMAIN/ARM/SEED`.
    pub missing: Vec<String>,
    /// Pictures of single runs.
    pub pictures: Vec<Shown>,
    /// Every run that is done.
    pub runs: Vec<RunRecord>,
}

/// What an arm cost in a domain.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ArmCost {
    /// The domain's name.
    pub domain: String,
    /// The arm's name.
    pub arm: String,
    /// Runs that are done.
    pub runs: usize,
    /// Steps of the environment in them.
    pub steps: u64,
    /// Hours of one core that they took.
    pub core_hours: f64,
    /// Milliseconds a step, measured.
    pub ms_per_step: f64,
}

/// A picture of a single run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shown {
    /// The file.
    pub file: String,
    /// The run, as `DOMAIN/ARM/SEED`.
    pub run: String,
    /// By what rule it was chosen.
    pub rule: String,
    /// Steps of each episode that is drawn, and whether it succeeded; none where sets are drawn.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub episodes: Vec<(u32, bool)>,
}

/// A run that is done.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunRecord {
    /// The domain's name.
    pub domain: String,
    /// The arm's name.
    pub arm: String,
    /// The seed.
    pub seed: u64,
    /// Training episodes.
    pub episodes: u64,
    /// Steps of the environment in them.
    pub steps: u64,
    /// Seconds of training.
    pub wall_seconds: f64,
    /// Which version of the code began it.
    pub commit: String,
    /// The metric; none where the run has none.
    pub value: Option<f64>,
    /// What is drawn of it: episodes, steps, value. Of more than 200 points each is the mean of as many neighbours as it takes.
    pub curves: BTreeMap<Quantity, Vec<(u64, u64, f64)>>,
}

impl Record {
    /// Writes it: a run, a claim a line.
    ///
    /// # Errors
    /// [`RunError::Io`] when the file cannot be written.
    pub(super) fn write(&self, folder: &Path) -> Result<(), RunError> {
        let path = folder.join(FILE);
        let value = serde_json::to_value(self).expect("plain data always encodes");
        fs::write(&path, lines(&value)).map_err(RunError::io("write", &path))
    }

    fn read(path: &Path) -> Result<Self, RunError> {
        let text = fs::read_to_string(path).map_err(RunError::io("read", path))?;
        serde_json::from_str(&text).map_err(|why| RunError::io("read", path)(why.into()))
    }
}

/// A curve as the JSON has it.
pub(super) fn thinned(points: &[Point]) -> Vec<(u64, u64, f64)> {
    let chunks = points.chunks(points.len().div_ceil(POINTS).max(1));
    let point = |chunk: &[Point]| {
        let last = chunk[chunk.len() - 1];
        let mean = chunk.iter().map(|point| point.value).sum::<f64>() / chunk.len() as f64;
        (last.episodes, last.steps, short(mean))
    };
    chunks.map(point).collect()
}

/// A number with five digits that count.
pub(super) fn short(x: f64) -> f64 {
    format!("{x:.4e}").parse().unwrap_or(x)
}

/// All claims of the figures in a folder, as a table in Markdown: those of one figure together, contradictions too.
///
/// # Errors
/// [`EvidenceError::NoClaims`] when there is no figure; [`RunError::Io`] when one cannot be read.
pub fn claims(folder: &Path) -> Result<String, RunError> {
    let listed = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut files: Vec<_> =
        listed.map(|entry| entry.path().join(FILE)).filter(|file| file.is_file()).collect();
    files.sort();
    if files.is_empty() {
        return Err(EvidenceError::NoClaims(folder.to_owned()).into());
    }
    let head = [
        "figure",
        "claim",
        "where",
        "verdict",
        "seeds",
        "interval",
        "steps",
        "core-hours",
        "command",
        "commit",
    ];
    let mut rows = vec![row(&head.map(str::to_owned)), row(&head.map(|_| "---".to_owned()))];
    for file in files {
        let record = Record::read(&file)?;
        rows.extend(record.claims.iter().map(|claim| row(&cells(&record, claim))));
    }
    Ok(rows.join("\n"))
}

fn cells(record: &Record, claim: &Judged) -> [String; 10] {
    let verdict = serde_json::to_value(claim.verdict).ok();
    let interval = claim.estimate.map_or_else(|| "-".to_owned(), |estimate| format!("{estimate:.2}"));
    [
        record.figure.clone(),
        claim.claim.clone(),
        claim.domain.clone(),
        verdict.as_ref().and_then(Value::as_str).unwrap_or_default().to_owned(),
        format!("{} of {}", claim.seeds.0, claim.seeds.1),
        format!("{} = {interval}; {}", claim.estimated, claim.metric),
        claim.steps.to_string(),
        format!("{:.2}", claim.core_hours),
        format!("`{}`", record.command),
        claim.commits.join(", "),
    ]
}

fn row(cells: &[String]) -> String {
    let clean = cells.iter().map(|cell| cell.replace('|', "\\|").replace('\n', " "));
    format!("| {} |", clean.collect::<Vec<_>>().join(" | "))
}

/// JSON whose lists have a line an entry.
fn lines(value: &Value) -> String {
    let Value::Object(parts) = value else { return format!("{value}\n") };
    let part = |(key, part): (&String, &Value)| {
        let key = Value::from(key.as_str());
        match part {
            Value::Array(entries) if !entries.is_empty() => {
                let entries: Vec<_> = entries.iter().map(|entry| format!("    {entry}")).collect();
                format!("  {key}: [\n{}\n  ]", entries.join(",\n"))
            }
            _ => format!("  {key}: {part}"),
        }
    };
    format!("{{\n{}\n}}\n", parts.iter().map(part).collect::<Vec<_>>().join(",\n"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_curves_are_means_of_neighbours() {
        let point = |n: u64| Point { episodes: n + 1, steps: 10 * (n + 1), value: n as f64 };
        let curve: Vec<_> = (0..500).map(point).collect();
        let thin = thinned(&curve);
        assert_eq!((thin.len(), thin[0], thin[166]), (167, (3, 30, 1.0), (500, 5000, 498.5)));
        assert_eq!(thinned(&curve[..200]).len(), 200);
        assert!(thinned(&[]).is_empty());
        assert_eq!((short(123_456.0), short(1.0 / 3.0)), (123_460.0, 0.33333));
    }

    #[test]
    fn lists_have_a_line_an_entry_and_stay_json() {
        let value = serde_json::json!({ "a": [{ "b": 1 }, { "b": 2 }], "c": [], "d": "x" });
        let text = lines(&value);
        assert_eq!(text.lines().count(), 8, "{text}");
        assert_eq!(serde_json::from_str::<Value>(&text).unwrap(), value);
    }
}
