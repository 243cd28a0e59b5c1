//! The runs that an experiment asks for.

use std::{
    path::{Path, PathBuf},
    str::FromStr,
};

use toml::{Table, Value};

use super::{Arm, Domain, EvidenceError, Experiment};
use crate::config::{Config, ConfigError};

/// Episodes of a run that only steps end.
const WITHOUT_END: i64 = 1_000_000_000;

/// What is wanted of an experiment.
#[derive(Clone, Debug, PartialEq)]
pub struct Wanted {
    /// Only so many of its seeds.
    pub seeds: Option<u64>,
    /// Budgets are multiplied by it; what is not 1 makes no claim.
    pub scale: f64,
    /// The folder of all runs.
    pub runs: PathBuf,
}

/// An experiment with its runs.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The experiment.
    pub experiment: Experiment,
    /// Its file.
    pub file: PathBuf,
    /// By what budgets are multiplied.
    pub scale: f64,
    /// The folder of its runs.
    pub folder: PathBuf,
    /// Where a trial is drawn, which makes no claim.
    pub figure: PathBuf,
    /// The runs: the first seed of all, then the second, so that what is done first can already be compared.
    pub runs: Vec<Asked>,
}

/// A run that is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Asked {
    /// The how manyeth domain.
    pub domain: usize,
    /// The how manyeth arm.
    pub arm: usize,
    /// Its seed.
    pub seed: u64,
    /// `DOMAIN/ARM/SEED`, as its folder is called.
    pub name: String,
    /// Its folder.
    pub path: PathBuf,
    /// What `inroads train` would be told.
    pub config: Config,
    /// Steps that it takes, as far as is known before.
    pub steps: u64,
    /// Milliseconds a step, as the file has it.
    pub ms_per_step: f64,
}

/// A part of the runs: every so manyeth one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Which part, from 0.
    pub index: usize,
    /// Of how many.
    pub of: usize,
}

impl FromStr for Shard {
    type Err = EvidenceError;

    fn from_str(text: &str) -> Result<Self, EvidenceError> {
        let numbers = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
        match numbers {
            Some((index, of)) if index < of => Ok(Self { index, of }),
            _ => Err(EvidenceError::Shard(text.to_owned())),
        }
    }
}

impl Plan {
    /// The plan of an experiment file.
    ///
    /// # Errors
    /// [`EvidenceError`] names the file, the key and the mend.
    pub fn read(file: &Path, wanted: &Wanted) -> Result<Self, EvidenceError> {
        Self::new(Experiment::read(file)?, file, wanted)
    }

    fn new(experiment: Experiment, file: &Path, wanted: &Wanted) -> Result<Self, EvidenceError> {
        let &Wanted { seeds, scale, ref runs } = wanted;
        if !(scale.is_finite() && scale > 0.0) {
            let why = format!("--scale is {scale}; it multiplies budgets, so give a number above 0");
            return Err(EvidenceError::File { path: file.to_owned(), why });
        }
        // What is computed with another budget never lies among what claims rest on.
        let trial = if scale == 1.0 { String::new() } else { format!("-x{scale}") };
        let figure = experiment.runs.as_ref().unwrap_or(&experiment.figure);
        let mut plan = Self {
            file: file.to_owned(),
            scale,
            folder: runs.join(format!("{figure}{trial}")),
            figure: runs.join(format!("{}{trial}", experiment.figure)).join("figure"),
            runs: Vec::new(),
            experiment,
        };
        for nth in 0..plan.experiment.seeds.min(seeds.unwrap_or(u64::MAX)) {
            let mut of_seed = plan.of_seed(nth)?;
            // Another one first each time: else a shard could get all runs of the dearest arm.
            let first = nth as usize % of_seed.len().max(1);
            of_seed.rotate_left(first);
            plan.runs.extend(of_seed);
        }
        Ok(plan)
    }

    /// The runs of a part.
    pub fn part(&self, shard: Option<Shard>) -> Vec<&Asked> {
        let Shard { index, of } = shard.unwrap_or(Shard { index: 0, of: 1 });
        self.runs.iter().skip(index).step_by(of).collect()
    }

    /// The runs of an arm in a domain, in the order of their seeds.
    pub fn of(&self, domain: usize, arm: usize) -> impl Iterator<Item = &Asked> {
        self.runs.iter().filter(move |asked| (asked.domain, asked.arm) == (domain, arm))
    }

    /// All pairs of a domain and an arm that has runs there, domain by domain.
    pub fn pairs(&self) -> Vec<(usize, usize)> {
        let Experiment { domains, arms, .. } = &self.experiment;
        let all = (0..domains.len()).flat_map(|domain| (0..arms.len()).map(move |arm| (domain, arm)));
        all.filter(|&(domain, arm)| self.of(domain, arm).next().is_some()).collect()
    }

    /// The domain of a run.
    pub fn domain(&self, asked: &Asked) -> &Domain {
        &self.experiment.domains[asked.domain]
    }

    /// The arm of a run.
    pub fn arm(&self, asked: &Asked) -> &Arm {
        &self.experiment.arms[asked.arm]
    }

    /// The runs of the so manyeth seed, over all domains and arms.
    fn of_seed(&self, nth: u64) -> Result<Vec<Asked>, EvidenceError> {
        let Experiment { domains, arms, .. } = &self.experiment;
        let mut runs = Vec::new();
        for (d, domain) in domains.iter().enumerate() {
            for (a, arm) in arms.iter().enumerate() {
                let seeds = domain.seeds.unwrap_or(u64::MAX).min(arm.seeds.unwrap_or(u64::MAX));
                if nth < seeds && arm.lives_in(domain) {
                    runs.push(self.asked((d, a), self.experiment.first_seed + nth)?);
                }
            }
        }
        Ok(runs)
    }

    fn asked(&self, (d, a): (usize, usize), seed: u64) -> Result<Asked, EvidenceError> {
        let (domain, arm) = (&self.experiment.domains[d], &self.experiment.arms[a]);
        let config = self.config((domain, a), seed).map_err(|why| EvidenceError::Settings {
            path: self.file.clone(),
            arm: arm.name.clone(),
            domain: domain.name.clone(),
            why: Box::new(why),
        })?;
        let name = format!("{}/{}/{seed}", domain.name, arm.name);
        Ok(Asked {
            domain: d,
            arm: a,
            seed,
            path: self.folder.join(&name),
            name,
            config,
            steps: self.scaled(self.experiment.budget(domain).steps()),
            ms_per_step: arm.ms_per_step(domain),
        })
    }

    fn config(&self, (domain, arm): (&Domain, usize), seed: u64) -> Result<Config, ConfigError> {
        let arms = self.lineage(arm);
        let agent = arms.iter().rev().find_map(|arm| arm.agent.as_deref()).unwrap_or_default();
        let own = &self.experiment.arms[arm].name;
        let here = |names: &[String], name: &String| names.is_empty() || names.contains(name);
        let rules = self.experiment.rules.iter();
        let rules = rules.filter(|rule| here(&rule.arms, own) && here(&rule.domains, &domain.name));
        let tables = [&self.experiment.settings, &domain.set].into_iter();
        let tables: Vec<&Table> =
            tables.chain(arms.iter().map(|arm| &arm.set)).chain(rules.map(|rule| &rule.set)).collect();
        let said = self.said(domain, seed);
        Config::asked(agent, &domain.environment, |config| {
            config.overlaid(tables.iter().copied().chain([&said]))
        })
    }

    /// What the file says in places of its own.
    fn said(&self, domain: &Domain, seed: u64) -> Table {
        let budget = self.experiment.budget(domain);
        let scaled = |number| self.scaled(number) as i64;
        let numbers = [
            ("seed", seed as i64),
            ("episodes", budget.episodes.map_or(WITHOUT_END, scaled)),
            ("max_steps", budget.max_steps.map_or(0, scaled)),
        ];
        numbers.into_iter().map(|(key, number)| (key.to_owned(), Value::Integer(number))).collect()
    }

    /// An arm and those that it is like, the first one first.
    fn lineage(&self, arm: usize) -> Vec<&Arm> {
        let like = |arm: &&Arm| self.experiment.arm(arm.like.as_deref()?).map(|i| &self.experiment.arms[i]);
        let mut arms: Vec<_> = std::iter::successors(Some(&self.experiment.arms[arm]), like).collect();
        arms.reverse();
        arms
    }

    fn scaled(&self, number: u64) -> u64 {
        ((number as f64 * self.scale).round() as u64).max(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shard_is_a_number_below_another() {
        let read = |text: &str| text.parse::<Shard>().ok();
        assert_eq!(read("0/1"), Some(Shard { index: 0, of: 1 }));
        assert_eq!(read("7/8"), Some(Shard { index: 7, of: 8 }));
        for wrong in ["8/8", "0/0", "1", "-1/2", "a/2", "1/2/3", ""] {
            assert_eq!(read(wrong), None, "{wrong}");
        }
    }
}
