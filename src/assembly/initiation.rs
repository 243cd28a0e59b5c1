//! Initiation sets by name: a new family is one file and one line here.

use std::sync::Arc;

use inroads_agents::classify::{
    Nearest, Neural, NeuralConfig, Odds, OddsConfig, Svm, SvmConfig, TwoClassRule,
};
use inroads_agents::encode::{Choices, Scaled};
use inroads_agents::evaluate::{Sigmoid, SigmoidConfig, Table, TableConfig};
use inroads_agents::{Encoder, Evaluator, nets::Backend};
use inroads_discovery::initiation::{IvfConfig, WeightedConfig};
use inroads_discovery::{Binary, Dual, Initiation, Ivf, Weighted};
use inroads_envs::{Seed, Spec};
use serde::{Deserialize, Serialize};

use super::{
    Vector,
    shared::{FeatureSet, choices, features, named, scaled},
};
use crate::config::ConfigError;

/// Sets of the family that the configuration names.
pub(super) type Sets<A> = Box<dyn Initiation<Vector, A>>;

/// What sets are built from.
pub(super) struct Plan<'a> {
    pub(super) spec: &'a Spec,
    pub(super) backend: Backend,
    pub(super) seed: Seed,
}

/// A family: its name, and how it is built for continuous actions and for choices.
struct Family {
    name: &'static str,
    continuous: fn(&Plan<'_>, &InitiationConfig) -> Sets<Vector>,
    discrete: fn(&Plan<'_>, &InitiationConfig) -> Sets<usize>,
}

const FAMILIES: &[Family] = &[
    Family { name: "binary", continuous: binary, discrete: binary },
    Family { name: "dual", continuous: dual, discrete: dual },
    Family { name: "ivf", continuous: ivf_continuous, discrete: ivf_discrete },
    Family { name: "weighted", continuous: weighted_continuous, discrete: weighted_discrete },
];

/// What tells inside from outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum ClassifierKind {
    /// Support vector machines (thesis).
    Svm,
    /// Distance to the nearest examples: exact on grids.
    Nearest,
    /// A network that reads all that is seen; for `weighted` sets too (thesis 5.1.2).
    Neural,
}

/// What says how probable success is (chapter 5).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum EvaluatorKind {
    /// A table, where actions are choices; else a network.
    Table,
    /// A network.
    Network,
}

/// Settings of initiation sets.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct InitiationConfig {
    /// The family: `binary` (3.1.3), `dual` (4.1.1), `ivf` (5.1.1) or `weighted` (5.1.2).
    pub(super) sets: String,
    /// The classifier of the first two; `neural` is one of `binary` and `weighted`.
    pub(super) classifier: ClassifierKind,
    /// What the classifier reads of what is seen, unless it is `neural`, which reads everything.
    pub(super) features: FeatureSet,
    /// Examples of either class that a skill remembers.
    pub(super) examples: usize,
    /// The machine; of dual sets the pessimistic one.
    pub(super) svm: SvmConfig,
    /// ν of an optimistic machine before there are negatives (authors: 0.01).
    pub(super) optimistic_nu: f64,
    /// Greatest distance from a positive example, where the classifier is `nearest`; of dual sets the pessimistic one's.
    pub(super) radius: f32,
    /// The same for an optimistic one.
    pub(super) optimistic_radius: f32,
    /// What says how probable success is, for the last two.
    pub(super) evaluator: EvaluatorKind,
    /// Their thresholds, gestation and optimism.
    pub(super) ivf: IvfConfig,
    /// The table.
    pub(super) table: TableConfig,
    /// The network.
    pub(super) network: SigmoidConfig,
    /// What an example counts.
    pub(super) weighted: WeightedConfig,
    /// The weighted classifier, where it is no network.
    pub(super) odds: OddsConfig,
    /// The classifier, where it is a network.
    pub(super) neural: NeuralConfig,
}

impl Default for InitiationConfig {
    fn default() -> Self {
        Self {
            sets: "binary".into(),
            classifier: ClassifierKind::Svm,
            features: FeatureSet::Place,
            examples: 500,
            svm: SvmConfig::default(),
            optimistic_nu: 0.01,
            radius: 0.5,
            optimistic_radius: 1.0,
            evaluator: EvaluatorKind::Table,
            ivf: IvfConfig::default(),
            table: TableConfig::default(),
            network: SigmoidConfig::default(),
            weighted: WeightedConfig::default(),
            odds: OddsConfig::default(),
            neural: NeuralConfig::default(),
        }
    }
}

impl InitiationConfig {
    pub(super) fn check(&self) -> Result<(), String> {
        self.svm.check().map_err(|e| format!("svm: {e}"))?;
        self.optimistic().check().map_err(|e| format!("optimistic_nu: {e}"))?;
        for (name, radius) in [("radius", self.radius), ("optimistic_radius", self.optimistic_radius)] {
            if !(radius.is_finite() && radius >= 0.0) {
                return Err(format!("{name} is {radius}; it must be 0 or above"));
            }
        }
        for discount in [self.table.discount, self.network.discount] {
            self.ivf.check(discount).map_err(|e| format!("ivf: {e}"))?;
        }
        self.table.check().map_err(|e| format!("table: {e}"))?;
        self.network.check().map_err(|e| format!("network: {e}"))?;
        self.weighted.check().map_err(|e| format!("weighted: {e}"))?;
        self.odds.check().map_err(|e| format!("odds: {e}"))?;
        self.neural.check().map_err(|e| format!("neural: {e}"))?;
        if self.sets == "dual" && self.classifier == ClassifierKind::Neural {
            return Err("classifier is \"neural\" and sets is \"dual\", whose pessimistic half sees one class only; set \
                        classifier = \"svm\" or \"nearest\""
                .into());
        }
        self.family().map(drop)
    }

    fn optimistic(&self) -> SvmConfig {
        SvmConfig { nu: self.optimistic_nu, two_class: TwoClassRule::Plain, ..self.svm.clone() }
    }

    fn family(&self) -> Result<&'static Family, String> {
        FAMILIES.iter().find(|family| family.name == self.sets).ok_or_else(|| {
            let names: Vec<_> = FAMILIES.iter().map(|family| family.name).collect();
            format!("there are no sets `{}`; there are: {}", self.sets, names.join(", "))
        })
    }

    /// The sets for continuous actions.
    pub(super) fn continuous(&self, plan: &Plan<'_>) -> Result<Sets<Vector>, ConfigError> {
        named("initiation", self.family()).map(|family| (family.continuous)(plan, self))
    }

    /// The sets for choices.
    pub(super) fn discrete(&self, plan: &Plan<'_>) -> Result<Sets<usize>, ConfigError> {
        named("initiation", self.family()).map(|family| (family.discrete)(plan, self))
    }
}

fn binary<A: 'static>(plan: &Plan<'_>, config: &InitiationConfig) -> Sets<A> {
    match config.classifier {
        ClassifierKind::Svm => Box::new(Binary::new(
            features(plan.spec, config.features),
            Svm::new(config.svm.clone()),
            config.examples,
        )),
        ClassifierKind::Nearest => Box::new(Binary::new(
            features(plan.spec, config.features),
            Nearest::new(config.radius),
            config.examples,
        )),
        ClassifierKind::Neural => {
            Box::new(Binary::new(scaled(plan.spec), neural(plan, config), config.examples))
        }
    }
}

fn dual<A: 'static>(plan: &Plan<'_>, config: &InitiationConfig) -> Sets<A> {
    match config.classifier {
        // A network is refused for these (`check`).
        ClassifierKind::Svm | ClassifierKind::Neural => {
            let (optimistic, pessimistic) = (Svm::new(config.optimistic()), Svm::new(config.svm.clone()));
            Box::new(Dual::new(
                features(plan.spec, config.features),
                optimistic,
                pessimistic,
                config.examples,
            ))
        }
        ClassifierKind::Nearest => {
            let (optimistic, pessimistic) =
                (Nearest::new(config.optimistic_radius), Nearest::new(config.radius));
            Box::new(Dual::new(
                features(plan.spec, config.features),
                optimistic,
                pessimistic,
                config.examples,
            ))
        }
    }
}

/// A network that says how probable success is.
fn network<A>(
    plan: &Plan<'_>,
    actions: Arc<dyn Encoder<A> + Send + Sync>,
    config: &InitiationConfig,
) -> Sigmoid<Vector, A> {
    let mut rng = plan.seed.stream("initialise", 1);
    Sigmoid::new(scaled(plan.spec), actions, 0, &config.network, plan.backend, &mut rng)
}

fn ivf<A: 'static, E: Evaluator<Vector, A, ()> + Clone + 'static>(
    evaluator: E,
    config: &InitiationConfig,
) -> Ivf<Vector, A, E> {
    Ivf::new(&config.ivf, evaluator, |_| ())
}

fn weighted<A: 'static, E: Evaluator<Vector, A, ()> + Clone + 'static>(
    plan: &Plan<'_>,
    evaluator: E,
    config: &InitiationConfig,
) -> Sets<A> {
    let ivf = ivf(evaluator, config);
    match config.classifier {
        ClassifierKind::Neural => {
            Box::new(Weighted::new(&config.weighted, ivf, scaled(plan.spec), neural(plan, config)))
        }
        ClassifierKind::Svm | ClassifierKind::Nearest => Box::new(Weighted::new(
            &config.weighted,
            ivf,
            features(plan.spec, config.features),
            Odds::new(&config.odds),
        )),
    }
}

/// A network that tells inside from outside.
fn neural(plan: &Plan<'_>, config: &InitiationConfig) -> Neural {
    let mut rng = plan.seed.stream("initialise", 2);
    Neural::new(scaled(plan.spec).width(), &config.neural, plan.backend, &mut rng)
}

fn ivf_continuous(plan: &Plan<'_>, config: &InitiationConfig) -> Sets<Vector> {
    Box::new(ivf(network(plan, Arc::new(Scaled::new(&plan.spec.action)), config), config))
}

fn weighted_continuous(plan: &Plan<'_>, config: &InitiationConfig) -> Sets<Vector> {
    weighted(plan, network(plan, Arc::new(Scaled::new(&plan.spec.action)), config), config)
}

fn ivf_discrete(plan: &Plan<'_>, config: &InitiationConfig) -> Sets<usize> {
    let choices = choices(plan.spec);
    match config.evaluator {
        EvaluatorKind::Table => Box::new(ivf(Table::new(choices, &config.table), config)),
        EvaluatorKind::Network => Box::new(ivf(network(plan, Arc::new(Choices(choices)), config), config)),
    }
}

fn weighted_discrete(plan: &Plan<'_>, config: &InitiationConfig) -> Sets<usize> {
    let choices = choices(plan.spec);
    match config.evaluator {
        EvaluatorKind::Table => weighted(plan, Table::new(choices, &config.table), config),
        EvaluatorKind::Network => weighted(plan, network(plan, Arc::new(Choices(choices)), config), config),
    }
}
