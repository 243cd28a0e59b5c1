//! Parts that several agents have, each chosen by one line of their settings: what is new, what a goal is made of, and who
//! plans.

use inroads_agents::{
    Novelty,
    nets::Backend,
    novelty::{Cfn, CfnConfig, Counts, FeatureCountsConfig, Rnd, RndConfig},
};
use inroads_discovery::{
    Features,
    graph::{AbstractMdp, AbstractMdpConfig, Cost, Dijkstra, Direct, Planner},
    naming::{Counterfactual, CounterfactualConfig, Name, Whole},
};
use inroads_envs::{Seed, Spec};
use serde::{Deserialize, Serialize};

use super::{
    Vector,
    kinds::{EncoderKind, Observed},
    shared::named,
};
use crate::config::ConfigError;

/// What novelty counts, or what stands in for a count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NoveltyKind {
    /// Whole states.
    #[default]
    States,
    /// Values of features, and pairs of them: then states that were never seen are told apart too.
    Features,
    /// A network that foretells coins: 1/√N of what looks alike.
    Cfn,
    /// A network that foretells random numbers; its error is no count.
    Rnd,
}

/// What is new, and what it counts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct NoveltyConfig {
    /// What is counted.
    pub counts: NoveltyKind,
    /// How features are counted, where they are.
    pub features: FeatureCountsConfig,
    /// How coins are foretold, where they are.
    pub cfn: CfnConfig,
    /// How random numbers are foretold, where they are.
    pub rnd: RndConfig,
    /// b: what a bonus, divided by its standard deviation, counts beside the task's reward (thesis: 0.01).
    pub weight: f32,
    /// k of equation 7.8: standard deviations above the mean that make a state worth a vertex (thesis: 1).
    pub threshold: f32,
    /// Whether the mean of all bonuses is taken from each (authors: yes, on grids).
    pub centred: bool,
}

impl Default for NoveltyConfig {
    fn default() -> Self {
        Self {
            counts: NoveltyKind::States,
            features: FeatureCountsConfig::default(),
            cfn: CfnConfig::default(),
            rnd: RndConfig::default(),
            weight: 0.01,
            threshold: 1.0,
            centred: true,
        }
    }
}

/// Features whose pairs are still counted in reasonable time: 64 make two thousand pairs a step and a look.
const MOST_FEATURES: usize = 64;

impl NoveltyConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the mend.
    pub fn check(&self) -> Result<(), String> {
        for (name, value) in [("weight", self.weight), ("threshold", self.threshold)] {
            if !(value.is_finite() && value >= 0.0) {
                return Err(format!("{name} is {value}; it must be 0 or above"));
            }
        }
        self.features.check().map_err(|why| format!("features: {why}"))?;
        self.cfn.check().map_err(|why| format!("cfn: {why}"))?;
        self.rnd.check().map_err(|why| format!("rnd: {why}"))
    }

    /// Who says how novel a state is; networks read it scaled, or as patches.
    ///
    /// # Errors
    /// When what is to be counted cannot be, in this domain: a sentence that names those where it can.
    pub(super) fn build<O: Observed>(
        &self,
        spec: &Spec,
        backend: Backend,
        seed: Seed,
    ) -> Result<Box<dyn Novelty<O>>, ConfigError> {
        let rng = &mut seed.stream("novelty", 0);
        let reader = |torso| O::reader(spec, torso, EncoderKind::Scaled);
        Ok(match self.counts {
            NoveltyKind::States => Box::new(Counts::default()),
            NoveltyKind::Features => {
                named("novelty", self.countable(spec))?;
                named("novelty", O::feature_counts(&self.features))?
            }
            NoveltyKind::Cfn => Box::new(Cfn::new(reader(&self.cfn.torso)?, &self.cfn, backend, rng)),
            NoveltyKind::Rnd => Box::new(Rnd::new(reader(&self.rnd.torso)?, &self.rnd, backend, rng)),
        })
    }

    /// Whether there are few enough features to count their pairs.
    fn countable(&self, spec: &Spec) -> Result<(), String> {
        let (name, features) = (spec.name, spec.observation.dimensions().len());
        if features <= MOST_FEATURES {
            return Ok(());
        }
        Err(format!(
            "{name} shows {features} features, and pairs of more than {MOST_FEATURES} are too many to count; take a \
             world whose name has `-factored`, or set novelty.counts = \"states\""
        ))
    }
}

/// What a goal is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NamingKind {
    /// All features of a state (chapter 7).
    #[default]
    Whole,
    /// Those without which it would not be novel (chapter 9).
    Counterfactual,
}

impl NamingKind {
    /// Who makes goals of states. Whole states are told apart by the same tolerance.
    pub(super) fn build(self, config: &CounterfactualConfig) -> Box<dyn Name<Vector, Features>> {
        match self {
            Self::Whole => Box::new(Whole { tolerance: config.tolerance }),
            Self::Counterfactual => Box::new(Counterfactual::new(config)),
        }
    }
}

/// Who plans.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PlannerKind {
    /// Value iteration on the abstract process (7.2.2.4).
    #[default]
    AbstractMdp,
    /// The path of the fewest steps (chapter 6).
    Dijkstra,
    /// The path that most probably succeeds.
    DijkstraSurest,
    /// Nobody: the chosen vertex's own skill is called wherever one is (9.2.1, and the ablation of 7.3.3.1).
    Direct,
}

impl PlannerKind {
    /// The planner of who explores, or without optimism that of who does not.
    pub(super) fn build(self, process: &AbstractMdpConfig, optimistic: bool) -> Box<dyn Planner> {
        let optimism = if optimistic { process.optimism } else { 0.0 };
        match self {
            Self::AbstractMdp => {
                Box::new(AbstractMdp::new(&AbstractMdpConfig { optimism, ..process.clone() }))
            }
            Self::Dijkstra => Box::new(Dijkstra { cost: Cost::Steps }),
            Self::DijkstraSurest => Box::new(Dijkstra { cost: Cost::Surprise }),
            Self::Direct => Box::new(Direct),
        }
    }
}
