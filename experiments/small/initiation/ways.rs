//! The ways to learn sets that are compared, and the settings that each was tuned over: six a way.

use std::sync::Arc;

use inroads::agents::classify::{Odds, OddsConfig};
use inroads::agents::encode::{Choices, Scaled, Select};
use inroads::agents::evaluate::{Sigmoid, SigmoidConfig, Table, TableConfig};
use inroads::agents::nets::Backend;
use inroads::discovery::initiation::{Bonus, IvfConfig, WeightedConfig, Weights};
use inroads::discovery::{Ivf, Weighted};
use inroads::envs::world::{Layout, Symbolic};
use inroads::envs::{Environment, Seed};
use serde::Serialize;

use super::practice::{Family, GOALS, State, rooms};

/// How sets are learned.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Way {
    pub(super) name: &'static str,
    pub(super) sets: Sets,
    pub(super) bonus: Bonus,
}

/// Who draws the set.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Sets {
    /// Nobody: an option may start anywhere.
    Anywhere,
    /// A classifier of outcomes; `whole_failures`: all states of a failed execution are negatives, not its first alone.
    Classifier { weighted: WeightedConfig, odds: OddsConfig, whole_failures: bool },
    /// A value function on a table, with updates a step.
    Values { rate: f32, updates: f32 },
    /// One on a network.
    Network { config: SigmoidConfig, updates: f32 },
}

/// Ways that share a setting, which is tuned for the last of them.
pub(super) struct Tuned {
    pub(super) over: Vec<Sets>,
    pub(super) ways: Vec<(&'static str, Bonus)>,
}

/// All ways, before tuning.
pub(super) fn tuned_over() -> Vec<Tuned> {
    let tuned =
        |over: &[Sets], ways: &[(&'static str, Bonus)]| Tuned { over: over.to_vec(), ways: ways.to_vec() };
    vec![
        tuned(
            &classifiers(Weights::Equal),
            &[("binary + counts", Bonus::Count { c: 0.5 }), ("binary", Bonus::None)],
        ),
        tuned(
            &classifiers(Weights::Value),
            &[("weighted", Bonus::None), ("weighted + progress", Bonus::Progress)],
        ),
        tuned(&values(), &[("IVF (table)", Bonus::None), ("IVF (table) + progress", Bonus::Progress)]),
        tuned(&networks(), &[("IVF (network) + progress", Bonus::Progress)]),
        tuned(&[Sets::Anywhere], &[("anywhere", Bonus::None)]),
    ]
}

fn classifiers(weights: Weights) -> [Sets; 6] {
    let set = |radius, balance, examples, whole_failures| Sets::Classifier {
        weighted: WeightedConfig { weights, examples },
        odds: OddsConfig { radius, balance },
        whole_failures,
    };
    [
        set(1.0, true, 500, true),
        set(1.0, true, 500, false),
        set(1.0, false, 500, false),
        set(0.5, true, 500, true),
        set(1.0, true, 100, true),
        set(1.5, true, 2000, false),
    ]
}

fn values() -> [Sets; 6] {
    [(0.3, 1.0), (0.6, 1.0), (1.0, 1.0), (0.3, 2.0), (0.6, 2.0), (1.0, 2.0)]
        .map(|(rate, updates)| Sets::Values { rate, updates })
}

fn networks() -> [Sets; 6] {
    [
        (1e-3, 0.02, 1.0),
        (3e-3, 0.02, 1.0),
        (3e-3, 0.1, 1.0),
        (1e-3, 0.1, 2.0),
        (3e-3, 0.1, 2.0),
        (3e-3, 0.3, 1.0),
    ]
    .map(|(rate, tau, updates)| {
        let config = SigmoidConfig { hidden: vec![32, 32], rate, tau, ..SigmoidConfig::default() };
        Sets::Network { config, updates }
    })
}

impl Way {
    /// The family, and whether all states of a failed execution are negatives.
    pub(super) fn build(&self, seed: u64) -> (Family, bool) {
        let config = IvfConfig { bonus: self.bonus, ..IvfConfig::default() };
        let table = |config: &IvfConfig, rate| {
            let table = Table::new(4, &TableConfig { rate, ..TableConfig::default() });
            Ivf::<State, usize, Table>::new(config, table, |_| ())
        };
        match &self.sets {
            Sets::Anywhere => {
                let config = IvfConfig { gestation: u32::MAX, updates_per_step: 0.0, ..config };
                (Box::new(table(&config, 0.0)), true)
            }
            Sets::Values { rate, updates } => {
                let config = IvfConfig { updates_per_step: *updates, ..config };
                (Box::new(table(&config, *rate)), true)
            }
            Sets::Classifier { weighted, odds, whole_failures } => {
                let place = Arc::new(Select::new(&[0, 1]));
                let weighted = Weighted::new(weighted, table(&config, 0.3), place, Odds::new(odds));
                (Box::new(weighted), *whole_failures)
            }
            Sets::Network { config: net, updates } => {
                let world = Symbolic::new(rooms(GOALS[0], 0.0), Layout::FixedMap(0));
                let states = Arc::new(Scaled::new(&world.spec().observation));
                let mut rng = Seed(seed).stream("initialise", 0);
                let net = Sigmoid::new(states, Arc::new(Choices(4)), 0, net, Backend::Flex, &mut rng);
                let config = IvfConfig { updates_per_step: *updates, ..config };
                (Box::new(Ivf::<State, usize, _>::new(&config, net, |_| ())), true)
            }
        }
    }
}
