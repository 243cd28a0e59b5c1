//! Verdicts on claims.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{Claim, Metric, Plan, record::RunRecord};
use crate::{
    run::RunError,
    statistics::{Estimate, Verdict, mean_interval, superiority, wilson},
};

/// A claim with its verdict.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Judged {
    /// The claim in words.
    pub claim: String,
    /// The environment, as the figure calls it.
    pub domain: String,
    /// By what arms are compared.
    pub metric: String,
    /// What is estimated: `P(better > worse)` over pairs of seeds, or the share of seeds that reach a number.
    pub estimated: String,
    /// The estimate with its interval: Newcombe's, or Wilson's of a share; none where an arm has no run.
    pub estimate: Option<Estimate>,
    /// The verdict.
    pub verdict: Verdict,
    /// Seeds that counted and seeds that were asked for: of the arm with the fewest.
    pub seeds: (usize, usize),
    /// The numbers by arm, each with its seed.
    pub values: BTreeMap<String, Vec<(u64, f64)>>,
    /// Their mean with Student's interval by arm, of two seeds and more.
    pub means: BTreeMap<String, Estimate>,
    /// Steps of the environment that it rests on.
    pub steps: u64,
    /// Hours of one core that they took.
    pub core_hours: f64,
    /// Which versions of the code began the runs.
    pub commits: Vec<String>,
}

/// The runs of an arm that a claim rests on.
struct Side<'a> {
    name: &'a str,
    label: &'a str,
    asked: usize,
    done: Vec<&'a RunRecord>,
    values: Vec<(u64, f64)>,
}

impl<'a> Side<'a> {
    fn new(
        plan: &'a Plan,
        runs: &'a [RunRecord],
        (domain, arm): (usize, &str),
        metric: Metric,
    ) -> Result<Self, RunError> {
        let experiment = &plan.experiment;
        let index = experiment.arm(arm).unwrap_or_default();
        let (domain_name, arm) = (&experiment.domains[domain].name, &experiment.arms[index]);
        let own = |run: &&RunRecord| run.domain == *domain_name && run.arm == arm.name;
        let done: Vec<_> = runs.iter().filter(own).collect();
        let mut values = Vec::new();
        for (seed, folder) in plan.finished(domain, index)? {
            values.extend(metric.of(&folder)?.map(|value| (seed, value)));
        }
        Ok(Self { name: &arm.name, label: arm.label(), asked: plan.of(domain, index).count(), done, values })
    }

    fn numbers(&self) -> Vec<f64> {
        self.values.iter().map(|(_, value)| *value).collect()
    }
}

impl Claim {
    /// The verdict on it from the runs that are done.
    pub(super) fn judged(&self, plan: &Plan, runs: &[RunRecord]) -> Result<Judged, RunError> {
        let metric = self.metric.unwrap_or(plan.experiment.metric);
        let domains = &plan.experiment.domains;
        let domain = domains.iter().position(|domain| domain.name == self.domain).unwrap_or_default();
        let arms = [&self.better, &self.worse, &self.arm].into_iter().flatten();
        let sides =
            arms.map(|arm| Side::new(plan, runs, (domain, arm), metric)).collect::<Result<Vec<_>, _>>()?;
        let (estimated, estimate, verdict) = match &sides[..] {
            [better, worse] => compared(better, worse, metric),
            [only] => self.reached(only, metric),
            _ => (String::new(), None, Verdict::Undetermined),
        };
        let rests_on = || sides.iter().flat_map(|side| side.done.iter());
        let mut commits: Vec<_> = rests_on().map(|run| run.commit.clone()).collect();
        commits.sort();
        commits.dedup();
        let seeds = sides.iter().map(|side| (side.values.len(), side.asked)).min().unwrap_or((0, 0));
        let means = sides.iter().filter(|side| side.values.len() > 1);
        Ok(Judged {
            claim: self.claim.clone(),
            domain: domains[domain].label().to_owned(),
            metric: metric.words(),
            estimated,
            estimate,
            verdict,
            seeds,
            means: means.map(|side| (side.name.to_owned(), mean_interval(&side.numbers()))).collect(),
            steps: rests_on().map(|run| run.steps).sum(),
            core_hours: rests_on().fold(0.0, |sum, run| sum + run.wall_seconds) / 3600.0,
            values: sides.iter().map(|side| (side.name.to_owned(), side.values.clone())).collect(),
            commits,
        })
    }

    /// Whether as many seeds reach the number as are said to: contradicted once those that are not done yet could not make
    /// up for it.
    fn reached(&self, side: &Side<'_>, metric: Metric) -> (String, Option<Estimate>, Verdict) {
        let (level, needed) = (self.at_least.unwrap_or(f64::NAN), self.on_seeds.unwrap_or(1) as usize);
        let there = |value: f64| if metric.of.is_cost() { value <= level } else { value >= level };
        let reached = side.values.iter().filter(|(_, value)| there(*value)).count();
        let verdict = match side.asked - side.done.len() {
            _ if reached >= needed => Verdict::Supported,
            left if reached + left < needed => Verdict::Contradicted,
            _ => Verdict::Undetermined,
        };
        let sign = if metric.of.is_cost() { '≤' } else { '≥' };
        let estimated = format!("share of seeds of {} with {sign} {level}, wanted on {needed}", side.label);
        let done = side.done.len() as u64;
        (estimated, (done > 0).then(|| wilson(reached as u64, done)), verdict)
    }
}

/// P(X > Y) over the seeds that there are.
fn compared(better: &Side<'_>, worse: &Side<'_>, metric: Metric) -> (String, Option<Estimate>, Verdict) {
    let sign = if metric.of.is_cost() { '<' } else { '>' };
    let estimated = format!("P({} {sign} {})", better.label, worse.label);
    let (mut x, mut y) = (better.numbers(), worse.numbers());
    if x.is_empty() || y.is_empty() {
        return (estimated, None, Verdict::Undetermined);
    }
    if metric.of.is_cost() {
        std::mem::swap(&mut x, &mut y);
    }
    let estimate = superiority(&x, &y);
    (estimated, Some(estimate), Verdict::of(&estimate))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::Quantity;

    const SUCCESS: Metric = Metric { of: Quantity::TestSuccess, last: Some(5) };
    const STEPS: Metric = Metric { of: Quantity::TestSteps, last: None };

    fn run(seed: u64) -> RunRecord {
        RunRecord {
            domain: "maze".into(),
            arm: "one".into(),
            seed,
            episodes: 10,
            steps: 100,
            wall_seconds: 1.0,
            commit: "unknown".into(),
            value: None,
            curves: BTreeMap::new(),
        }
    }

    fn side<'a>(runs: &'a [RunRecord], asked: usize, values: &[f64]) -> Side<'a> {
        let values = values.iter().zip(0..).map(|(value, seed)| (seed, *value)).collect();
        Side { name: "one", label: "One", asked, done: runs.iter().collect(), values }
    }

    fn reaches(at_least: f64, on_seeds: u64) -> Claim {
        Claim {
            claim: "it does".into(),
            domain: "maze".into(),
            metric: None,
            better: None,
            worse: None,
            arm: Some("one".into()),
            at_least: Some(at_least),
            on_seeds: Some(on_seeds),
        }
    }

    #[test]
    fn a_number_on_some_seeds_is_contradicted_only_when_the_rest_cannot_make_up_for_it() {
        let runs: Vec<RunRecord> = (0..3).map(run).collect();
        let verdict = |done: usize, values: &[f64], metric| {
            reaches(0.9, 2).reached(&side(&runs[..done], 3, values), metric).2
        };
        assert_eq!(verdict(2, &[1.0, 0.9], SUCCESS), Verdict::Supported);
        assert_eq!(verdict(2, &[1.0, 0.0], SUCCESS), Verdict::Undetermined);
        assert_eq!(verdict(2, &[0.8, 0.0], SUCCESS), Verdict::Contradicted);
        assert_eq!(verdict(3, &[1.0, 0.8, 0.0], SUCCESS), Verdict::Contradicted);
        // A run that is done and has no number does not reach it.
        assert_eq!(verdict(3, &[1.0], SUCCESS), Verdict::Contradicted);
        // Of steps it is at most so many.
        assert_eq!(verdict(2, &[0.5, 0.9], STEPS), Verdict::Supported);
        let (words, estimate, _) = reaches(0.9, 2).reached(&side(&runs, 3, &[1.0, 1.0, 0.0]), SUCCESS);
        assert_eq!(words, "share of seeds of One with ≥ 0.9, wanted on 2");
        assert_eq!(estimate, Some(wilson(2, 3)));
    }

    #[test]
    fn of_steps_fewer_are_better_and_nothing_comes_of_no_run() {
        let (few, many) = (side(&[], 4, &[1.0, 2.0, 3.0, 4.0]), side(&[], 4, &[5.0, 6.0, 7.0, 8.0]));
        assert_eq!(compared(&few, &many, STEPS).2, Verdict::Supported);
        assert_eq!(compared(&few, &many, SUCCESS).2, Verdict::Contradicted);
        assert_eq!(compared(&few, &side(&[], 4, &[]), STEPS).1, None);
        assert_eq!(compared(&few, &many, STEPS).0, "P(One < One)");
    }
}
