//! The experiment file.

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

use serde::Deserialize;
use toml::Table;

use super::{Draw, EvidenceError, Metric};

/// Where experiment files lie, from the folder in which the command runs.
const FOLDER: &str = "experiments";
/// Settings that a file says elsewhere, and where.
const ELSEWHERE: [(&str, &str); 5] = [
    ("agent", "it is the arm's `agent`"),
    ("environment", "it is the domain's `environment`"),
    ("seed", "seeds are the experiment's `seeds` and `first_seed`"),
    ("episodes", "all arms have the same budget: set `budget.episodes` of the experiment or of the domain"),
    ("max_steps", "all arms have the same budget: set `budget.max_steps` of the experiment or of the domain"),
];

/// An experiment: one figure of the thesis, or one of ours.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Experiment {
    /// The figure's name, such as `4.3`: how it is asked for, and the name of its folders.
    pub figure: String,
    /// Stands above it.
    pub title: String,
    /// What the thesis claims, with its section.
    pub thesis: String,
    /// What is known of how it came out, for the reader; may be long.
    #[serde(default)]
    pub note: String,
    /// The figure whose runs these are, where another has them already: domains and arms of the same names are the same.
    pub runs: Option<String>,
    /// How many seeds.
    pub seeds: u64,
    /// The first of them.
    #[serde(default)]
    pub first_seed: u64,
    /// How long each run trains.
    pub budget: Budget,
    /// By what runs are compared, and the median one is chosen.
    pub metric: Metric,
    /// The settings of all runs, over the agents' defaults.
    #[serde(default)]
    pub settings: Table,
    /// The environments.
    #[serde(rename = "domain")]
    pub domains: Vec<Domain>,
    /// The agents.
    #[serde(rename = "arm")]
    pub arms: Vec<Arm>,
    /// Settings of some arms in some domains, in order, over all others.
    #[serde(default, rename = "rule")]
    pub rules: Vec<Rule>,
    /// What is drawn.
    #[serde(default, rename = "draw")]
    pub draws: Vec<Draw>,
    /// What is claimed.
    #[serde(default, rename = "claim")]
    pub claims: Vec<Claim>,
}

/// How long a run trains: the same for all arms of a domain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Budget {
    /// Training episodes; without it only steps count.
    pub episodes: Option<u64>,
    /// Training ends after the episode that reaches this many steps of the environment; without it only episodes count.
    pub max_steps: Option<u64>,
    /// Steps of a mean episode, measured; for the price, where no number of steps is given.
    pub steps_an_episode: Option<u64>,
}

/// An environment.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Domain {
    /// Its name here, and that of its folder.
    pub name: String,
    /// What figures call it; its name when left out.
    pub label: Option<String>,
    /// Its name in the registry.
    pub environment: String,
    /// Another budget than the experiment's.
    pub budget: Option<Budget>,
    /// Only so many of the seeds.
    pub seeds: Option<u64>,
    /// Settings of its runs.
    #[serde(default)]
    pub set: Table,
}

/// An agent with its settings.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Arm {
    /// Its name here, and that of its folder.
    pub name: String,
    /// What figures call it; its name when left out.
    pub label: Option<String>,
    /// Its name in the registry; that of the arm that it is like, when left out.
    pub agent: Option<String>,
    /// An arm above, whose settings it takes before its own.
    pub like: Option<String>,
    /// Milliseconds of one core for a step of the environment with all that is learned at it, measured.
    pub ms_per_step: Price,
    /// Only these domains; all when left out.
    #[serde(default)]
    pub domains: Vec<String>,
    /// Only so many of the seeds.
    pub seeds: Option<u64>,
    /// Its settings.
    #[serde(default)]
    pub set: Table,
}

/// Milliseconds a step: everywhere, or by domain.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum Price {
    /// The same in all domains.
    Everywhere(f64),
    /// By the domain's name.
    ByDomain(std::collections::BTreeMap<String, f64>),
}

/// Settings of some arms in some domains.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rule {
    /// The arms; all when left out.
    #[serde(default)]
    pub arms: Vec<String>,
    /// The domains; all when left out.
    #[serde(default)]
    pub domains: Vec<String>,
    /// The settings.
    pub set: Table,
}

/// What is claimed of the arms in a domain. Either of two arms (`better`, `worse`), or of one against a number (`arm`,
/// `at_least`, `on_seeds`).
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Claim {
    /// The claim in words.
    pub claim: String,
    /// The domain.
    pub domain: String,
    /// Another metric than the experiment's.
    pub metric: Option<Metric>,
    /// The arm that is said to be better. Of steps, fewer are better.
    pub better: Option<String>,
    /// The arm that is said to be worse.
    pub worse: Option<String>,
    /// The arm that is said to reach a number.
    pub arm: Option<String>,
    /// The number; of steps, it is `at_most`.
    pub at_least: Option<f64>,
    /// On how many seeds it is said to.
    pub on_seeds: Option<u64>,
}

/// The file of a figure: `experiments/fig-4-3.toml` for `4.3`, or the file itself.
///
/// # Errors
/// [`EvidenceError::NoFigure`] with those that there are.
pub fn find(figure: &str) -> Result<PathBuf, EvidenceError> {
    if figure.ends_with(".toml") {
        return Ok(figure.into());
    }
    let path = Path::new(FOLDER).join(format!("fig-{}.toml", figure.replace('.', "-")));
    if path.is_file() {
        return Ok(path);
    }
    let listed = fs::read_dir(FOLDER).into_iter().flatten().filter_map(|entry| {
        let name = entry.ok()?.file_name().into_string().ok()?;
        Some(name.strip_prefix("fig-")?.strip_suffix(".toml")?.replace('-', "."))
    });
    let others = listed.collect::<BTreeSet<_>>().into_iter().collect::<Vec<_>>().join(", ");
    Err(EvidenceError::NoFigure { name: figure.to_owned(), path, others })
}

impl Experiment {
    /// Reads and checks a file.
    ///
    /// # Errors
    /// [`EvidenceError::File`] names the file, the key and the mend.
    pub fn read(path: &Path) -> Result<Self, EvidenceError> {
        let wrong = |why: String| EvidenceError::File { path: path.to_owned(), why };
        let text = fs::read_to_string(path).map_err(|why| wrong(format!("cannot be read: {why}")))?;
        let experiment: Self =
            toml::from_str(&text).map_err(|why| wrong(why.to_string().trim_end().into()))?;
        experiment.check().map_err(wrong)?;
        Ok(experiment)
    }

    /// The arm of that name.
    pub(super) fn arm(&self, name: &str) -> Option<usize> {
        self.arms.iter().position(|arm| arm.name == name)
    }

    /// The budget in a domain.
    pub(super) fn budget(&self, domain: &Domain) -> Budget {
        domain.budget.unwrap_or(self.budget)
    }

    fn check(&self) -> Result<(), String> {
        plain("figure", &self.figure)?;
        self.runs.iter().try_for_each(|figure| plain("runs", figure))?;
        at_least_one("seeds", self.seeds)?;
        names("domain", self.domains.iter().map(|domain| domain.name.as_str()))?;
        names("arm", self.arms.iter().map(|arm| arm.name.as_str()))?;
        no_other_place("settings", &self.settings)?;
        for domain in &self.domains {
            let key = format!("domain `{}`", domain.name);
            no_other_place(&format!("{key}.set"), &domain.set)?;
            self.budget(domain).check().map_err(|why| format!("{key}: {why}"))?;
        }
        for (index, arm) in self.arms.iter().enumerate() {
            self.check_arm(index).map_err(|why| format!("arm `{}`: {why}", arm.name))?;
        }
        for (index, rule) in self.rules.iter().enumerate() {
            let key = format!("rule {}", index + 1);
            no_other_place(&format!("{key}.set"), &rule.set)?;
            self.known(&rule.arms, &rule.domains).map_err(|why| format!("{key}: {why}"))?;
        }
        let mut files = BTreeSet::new();
        for draw in &self.draws {
            let file = draw.file();
            plain("file", file).map_err(|why| format!("draw: {why}"))?;
            if !files.insert(file) {
                return Err(format!("two draws have the file `{file}`; name one of them otherwise"));
            }
            self.check_draw(draw).map_err(|why| format!("draw `{file}`: {why}"))?;
        }
        for claim in &self.claims {
            self.check_claim(claim).map_err(|why| format!("claim `{}`: {why}", claim.claim))?;
        }
        Ok(())
    }

    fn check_arm(&self, index: usize) -> Result<(), String> {
        let arm = &self.arms[index];
        no_other_place("set", &arm.set)?;
        self.known(&[], &arm.domains)?;
        match (&arm.agent, &arm.like) {
            (None, None) => return Err("set `agent`, or `like` to be like an arm above".into()),
            (_, Some(like)) if self.arm(like).is_none_or(|other| other >= index) => {
                return Err(format!("`like` names `{like}`, which is no arm above it; move that arm up"));
            }
            _ => {}
        }
        let dear = |ms: f64| if ms.is_finite() && ms > 0.0 { Ok(()) } else { Err(PRICE.to_owned()) };
        match &arm.ms_per_step {
            Price::Everywhere(ms) => dear(*ms),
            Price::ByDomain(by) => {
                self.known(&[], &by.keys().cloned().collect::<Vec<_>>())?;
                by.values().try_for_each(|ms| dear(*ms))?;
                let lacking =
                    self.domains.iter().find(|domain| arm.lives_in(domain) && !by.contains_key(&domain.name));
                lacking.map_or(Ok(()), |domain| {
                    Err(format!("`ms_per_step` lacks domain `{}`; measure it", domain.name))
                })
            }
        }
    }

    fn check_draw(&self, draw: &Draw) -> Result<(), String> {
        match draw {
            Draw::Curves { of, .. } if of.is_empty() || of.len() > 3 => {
                Err("`of` has to name one to three quantities".into())
            }
            Draw::Curves { .. } | Draw::Dots { .. } => Ok(()),
            Draw::Sets { arms, feature, values, .. } => {
                self.known(arms, &[])?;
                match feature.is_empty() == values.is_empty() {
                    true => Ok(()),
                    false => Err("set both `feature` and `values`, or neither".into()),
                }
            }
            Draw::Trajectories { arms, episodes, .. } => {
                self.known(arms, &[])?;
                at_least_one("episodes", *episodes)
            }
        }
    }

    fn check_claim(&self, claim: &Claim) -> Result<(), String> {
        let both = |name: &Option<String>| name.iter().cloned().collect::<Vec<_>>();
        let arms = [both(&claim.better), both(&claim.worse), both(&claim.arm)].concat();
        self.known(&arms, std::slice::from_ref(&claim.domain))?;
        let compares = claim.better.is_some() && claim.worse.is_some();
        let reaches = claim.arm.is_some() && claim.at_least.is_some();
        let parts = [&claim.better, &claim.worse, &claim.arm].iter().filter(|part| part.is_some()).count();
        let right = (compares && parts == 2 && claim.at_least.is_none() && claim.on_seeds.is_none())
            || (reaches && parts == 1 && claim.on_seeds.is_some_and(|seeds| seeds > 0));
        if right {
            Ok(())
        } else {
            Err("set `better` and `worse`, or `arm`, `at_least` and `on_seeds` above 0".into())
        }
    }

    /// Whether all arms and domains of these names are there.
    fn known(&self, arms: &[String], domains: &[String]) -> Result<(), String> {
        let all = |names: Vec<&str>| names.join(", ");
        if let Some(arm) = arms.iter().find(|arm| self.arm(arm).is_none()) {
            let there = all(self.arms.iter().map(|arm| arm.name.as_str()).collect());
            return Err(format!("there is no arm `{arm}`; there are {there}"));
        }
        match domains.iter().find(|domain| self.domains.iter().all(|known| known.name != **domain)) {
            Some(domain) => {
                let there = all(self.domains.iter().map(|known| known.name.as_str()).collect());
                Err(format!("there is no domain `{domain}`; there are {there}"))
            }
            None => Ok(()),
        }
    }
}

const PRICE: &str = "`ms_per_step` has to be a measured number above 0";

impl Budget {
    fn check(self) -> Result<(), String> {
        match self {
            Self { episodes: Some(0), .. } | Self { max_steps: Some(0), .. } => {
                Err("a budget of 0 is none; leave the key out, or give a number above 0".into())
            }
            Self { max_steps: Some(_), .. } | Self { episodes: Some(_), steps_an_episode: Some(_), .. } => {
                Ok(())
            }
            _ => {
                Err("`budget` needs `max_steps`, or `episodes` with `steps_an_episode` for the price".into())
            }
        }
    }

    /// Steps that a run takes, as far as is known before.
    pub(super) fn steps(self) -> u64 {
        let episodes = self.episodes.zip(self.steps_an_episode).map(|(episodes, steps)| episodes * steps);
        self.max_steps.into_iter().chain(episodes).min().unwrap_or(0)
    }
}

impl Arm {
    /// What figures call it.
    pub fn label(&self) -> &str {
        self.label.as_deref().unwrap_or(&self.name)
    }

    /// Whether it has runs in a domain.
    pub(super) fn lives_in(&self, domain: &Domain) -> bool {
        self.domains.is_empty() || self.domains.contains(&domain.name)
    }

    /// Milliseconds a step in a domain.
    pub(super) fn ms_per_step(&self, domain: &Domain) -> f64 {
        match &self.ms_per_step {
            Price::Everywhere(ms) => *ms,
            Price::ByDomain(by) => by.get(&domain.name).copied().unwrap_or(f64::NAN),
        }
    }
}

impl Domain {
    /// What figures call it.
    pub fn label(&self) -> &str {
        self.label.as_deref().unwrap_or(&self.name)
    }
}

/// Whether a name can be a folder's everywhere.
fn plain(key: &str, name: &str) -> Result<(), String> {
    let fits = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
    if name.is_empty() || name.starts_with('.') || !name.chars().all(fits) {
        return Err(format!("`{key}` is `{name}`; it names files, so take letters, digits, -, _ and ."));
    }
    Ok(())
}

fn names<'a>(key: &str, all: impl Iterator<Item = &'a str>) -> Result<(), String> {
    let mut seen = BTreeSet::new();
    for name in all {
        plain(&format!("{key}.name"), name)?;
        if !seen.insert(name) {
            return Err(format!("two of `{key}` have the name `{name}`; name one of them otherwise"));
        }
    }
    if seen.is_empty() { Err(format!("there is no `[[{key}]]`; add one")) } else { Ok(()) }
}

fn at_least_one(key: &str, count: u64) -> Result<(), String> {
    if count == 0 { Err(format!("`{key}` must be at least 1")) } else { Ok(()) }
}

/// Whether settings leave alone what the file says elsewhere.
fn no_other_place(key: &str, settings: &Table) -> Result<(), String> {
    let stray = ELSEWHERE.iter().find(|(name, _)| settings.contains_key(*name));
    stray.map_or(Ok(()), |(name, place)| Err(format!("`{key}` sets `{name}`; leave it out: {place}")))
}
