//! The tuning budget: the same number of configurations for everybody, on DoorKey-6x6, on seeds of their own. Each is tried
//! with returns of one, three and five steps of whatever learns the task's reward.

use inroads::{assembly::graphs::ImDsgConfig, envs::Spec, statistics::median};
use serde::Serialize;

use super::{
    Boxed,
    agents::{Simple, flat, im_dsg},
    train,
    worlds::WORLDS,
};
use crate::{
    Options,
    support::{Done, over_seeds, write},
};

/// Seeds a configuration; the first of them, away from those of the comparison.
const SEEDS: u64 = 4;
const FIRST: u64 = 1_000;

/// Steps of returns that are tried.
const RETURNS: [u32; 3] = [1, 3, 5];

/// What a configuration changes of the defaults.
type Change = fn(&mut ImDsgConfig);

#[derive(Serialize)]
struct Row {
    agent: &'static str,
    configuration: String,
    returns: u32,
    median_steps: f64,
    solved: usize,
}

pub(crate) fn run(options: &Options) -> Done {
    let mut rows = Vec::new();
    let mut one = |agent: &'static str,
                   configuration: String,
                   returns: u32,
                   build: &(dyn Fn(&Spec) -> Boxed + Sync)| {
        let runs = over_seeds(options.seeds.unwrap_or(SEEDS), |seed| {
            let mut env = WORLDS[0].make(FIRST + seed);
            let mut agent = build(env.spec());
            train(&mut env, &mut agent, FIRST + seed, WORLDS[0].budget)
        });
        let steps: Vec<_> = runs.iter().map(|run| run.solved as f64).collect();
        let solved = runs.iter().filter(|run| run.ever).count();
        let median_steps = median(&steps).unwrap_or(f64::NAN);
        println!("{agent:16} {median_steps:8.0} steps, {solved} solved: {returns}, {configuration}");
        rows.push(Row { agent, configuration, returns, median_steps, solved });
    };
    let simple = Simple::default();
    let greedy = [
        simple,
        Simple { epsilon: 0.3, ..simple },
        Simple { epsilon: 0.05, ..simple },
        Simple { rate: 0.1, initial: 0.2, ..simple },
        Simple { initial: 0.2, ..simple },
        Simple { initial: 0.5, ..simple },
        Simple { initial: 0.8, ..simple },
    ];
    let mut tables = |agent, configurations: &[Simple]| {
        for simple in configurations {
            let what = simple.to_string();
            for returns in RETURNS {
                one(agent, what.clone(), returns, &|spec| flat(spec, &Simple { returns, ..*simple }));
            }
        }
    };
    tables("epsilon-greedy", &greedy);
    let bonus = Simple { rate: 0.1, weight: 0.01, ..simple };
    let counts = [
        bonus,
        Simple { weight: 0.003, ..bonus },
        Simple { weight: 0.001, ..bonus },
        Simple { weight: 0.1, ..bonus },
        Simple { rate: 0.5, ..bonus },
        Simple { initial: 0.2, ..bonus },
        Simple { centred: false, ..bonus },
    ];
    tables("counts", &counts);
    let changes: [(&str, Change); 7] = [
        ("b = 0.01, H = 20", |_| {}),
        ("b = 0.003", |c| c.novelty.weight = 0.003),
        ("b = 0.001", |c| c.novelty.weight = 0.001),
        ("b = 0.003, H = 10, tau = 0.95", |c| {
            (c.novelty.weight, c.explorer.horizon, c.explorer.edge_value) = (0.003, 10, 0.95);
        }),
        ("b = 0.003, exploring for 40 steps", |c| (c.novelty.weight, c.explorer.explore_for) = (0.003, 40)),
        ("b = 0.003, k = 2", |c| (c.novelty.weight, c.novelty.threshold) = (0.003, 2.0)),
        ("b = 0.003, V_novelty begins at 0.2", |c| {
            (c.novelty.weight, c.frontier.table.initial) = (0.003, 0.2);
        }),
    ];
    for (what, change) in changes {
        for returns in RETURNS {
            let mut config = ImDsgConfig::default();
            change(&mut config);
            config.frontier.returns = returns;
            one("IM-DSG", what.into(), returns, &|spec| Box::new(im_dsg(spec, &config)));
        }
    }
    write(options, "im-dsg-tuning", &rows)
}
