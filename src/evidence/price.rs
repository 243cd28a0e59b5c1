//! What an experiment costs: agents × seeds × steps × milliseconds a step.

use super::{Plan, State};
use crate::run::{Folder, Summary};

/// Milliseconds of an hour.
const HOUR: f64 = 3.6e6;

/// The price, a line an arm in a domain, with what is done already, as a table; then the total and what is left. Nothing
/// is written.
pub fn price(plan: &Plan) -> String {
    let head =
        ["domain", "arm", "seeds", "steps a run", "ms a step", "core-hours", "done", "measured ms a step"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    let (mut all, mut left) = (0.0, 0.0);
    for (domain, arm) in plan.pairs() {
        let mut line = Line::default();
        for asked in plan.of(domain, arm) {
            let hours = asked.steps as f64 * asked.ms_per_step / HOUR;
            (line.steps, line.ms) = (asked.steps, asked.ms_per_step);
            line.seeds += 1;
            line.hours += hours;
            match State::of(asked) {
                State::Finished => line.finish(&asked.path),
                State::Begun => line.begun += 1,
                State::Changed(_) => line.changed += 1,
                State::Absent => {}
            }
            left += if State::of(asked) == State::Finished { 0.0 } else { hours };
        }
        all += line.hours;
        let experiment = &plan.experiment;
        rows.push(line.cells(&experiment.domains[domain].name, &experiment.arms[arm].name));
    }
    let runs = plan.runs.len();
    format!("{}\n{runs} runs: {all:.2} core-hours, of which {left:.2} are left", aligned(&rows))
}

#[derive(Default)]
struct Line {
    seeds: usize,
    steps: u64,
    ms: f64,
    hours: f64,
    finished: usize,
    begun: usize,
    changed: usize,
    measured: (f64, u64),
}

impl Line {
    fn finish(&mut self, run: &std::path::Path) {
        self.finished += 1;
        if let Ok(Summary { wall_seconds, env_steps, .. }) =
            Folder::open(run).and_then(|run| run.read_summary())
        {
            self.measured = (self.measured.0 + wall_seconds, self.measured.1 + env_steps);
        }
    }

    fn cells(&self, domain: &str, arm: &str) -> Vec<String> {
        let mut done = format!("{} of {}", self.finished, self.seeds);
        for (count, what) in [(self.begun, "begun"), (self.changed, "with other settings")] {
            if count > 0 {
                done += &format!(", {count} {what}");
            }
        }
        let (seconds, steps) = self.measured;
        let measured =
            if steps > 0 { format!("{:.3}", 1e3 * seconds / steps as f64) } else { "-".to_owned() };
        let numbers = [
            self.seeds.to_string(),
            self.steps.to_string(),
            format!("{}", self.ms),
            format!("{:.3}", self.hours),
        ];
        [vec![domain.to_owned(), arm.to_owned()], numbers.to_vec(), vec![done, measured]].concat()
    }
}

/// Rows in columns as wide as they need.
fn aligned(rows: &[Vec<String>]) -> String {
    let wide = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let line = |row: &Vec<String>| {
        let cells =
            row.iter().enumerate().map(|(column, cell)| format!("{cell:<width$}", width = wide(column)));
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    rows.iter().map(line).collect::<Vec<_>>().join("\n")
}
