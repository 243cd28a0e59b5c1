//! Who is compared, as tuned on DoorKey-6x6 (`tuning`), each with the returns that suit it. All have the same table: eight
//! clips an update, an update a step, a discount of 0.97, all of their steps in the replay.

use inroads::{
    agents::{
        Curious, Flat, Pace, Practice, Replay, TabularQ, nets::Backend, novelty::Counts,
        tabular::TabularConfig,
    },
    assembly::{
        graphs::{self, ImDsg, ImDsgConfig},
        parts::PlannerKind,
    },
    envs::{Seed, Space, Spec},
};

use super::Boxed;

/// An agent.
pub(crate) struct Entrant {
    pub(crate) name: &'static str,
    pub(crate) build: fn(&Spec) -> Boxed,
}

/// All of them.
pub(crate) const AGENTS: [Entrant; 4] = [
    Entrant { name: "IM-DSG", build: |spec| Box::new(im_dsg(spec, &ours(PlannerKind::AbstractMdp))) },
    Entrant {
        name: "IM-DSG without planning",
        build: |spec| Box::new(im_dsg(spec, &ours(PlannerKind::Direct))),
    },
    Entrant {
        name: "counts",
        build: |spec| flat(spec, &Simple { rate: 0.1, weight: 0.1, ..Simple::default() }),
    },
    Entrant {
        name: "epsilon-greedy",
        build: |spec| flat(spec, &Simple { initial: 0.5, returns: 3, ..Simple::default() }),
    },
];

/// IM-DSG on counts, which need neither backend nor seed.
pub(crate) fn im_dsg(spec: &Spec, config: &ImDsgConfig) -> ImDsg {
    graphs::im_dsg(spec, config, Backend::default(), Seed(0)).expect("counts fit everywhere")
}

/// IM-DSG as tuned.
pub(crate) fn ours(planner: PlannerKind) -> ImDsgConfig {
    let mut config = ImDsgConfig { planner, ..ImDsgConfig::default() };
    (config.novelty.weight, config.explorer.explore_for) = (0.003, 40);
    config
}

/// What is tuned of Q-learning.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Simple {
    pub(crate) rate: f32,
    pub(crate) epsilon: f32,
    pub(crate) initial: f32,
    /// b; 0 for no bonus.
    pub(crate) weight: f32,
    /// Whether the mean of all bonuses is taken from each.
    pub(crate) centred: bool,
    /// Steps of returns.
    pub(crate) returns: u32,
}

impl Default for Simple {
    fn default() -> Self {
        Self { rate: 0.5, epsilon: 0.1, initial: 0.0, weight: 0.0, centred: true, returns: 5 }
    }
}

impl std::fmt::Display for Simple {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { rate, epsilon, initial, weight, centred, .. } = self;
        write!(f, "rate {rate}, epsilon {epsilon}, begins at {initial}, b = {weight}")?;
        f.write_str(if *weight > 0.0 && !centred { ", not centred" } else { "" })
    }
}

/// Steps that are remembered: more than any training has.
const CAPACITY: usize = 200_000;

/// Q-learning, with a bonus for counts if it weighs anything.
pub(crate) fn flat(spec: &Spec, simple: &Simple) -> Boxed {
    let Space::Discrete(choices) = spec.action else { unreachable!("these worlds have choices") };
    let Simple { rate, epsilon, initial, weight, centred, returns } = *simple;
    let config = TabularConfig { rate, epsilon, initial, discount: 0.97, ..TabularConfig::default() };
    let pace = Pace { updates_per_step: 1.0, warm_up: config.batch };
    let table = TabularQ::new(choices, &config);
    let curious = Curious::new(table.clone(), Practice::new(Replay::new(CAPACITY).spanning(returns), pace));
    let curious = if weight > 0.0 {
        curious.with_novelty(Box::new(Counts::default()), weight).centred(centred).sober(table)
    } else {
        curious
    };
    Box::new(Flat::new(curious, CAPACITY))
}
