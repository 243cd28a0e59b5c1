//! What model-based control costs: a plan for the ant, with a model of the default size.

use std::{hint::black_box, sync::Arc};

use inroads::{
    agents::{
        Memory,
        mpc::{Dynamics, DynamicsConfig, FreeBody, Planner, Problem, Reach, Refining, Reward},
        nets::Backend,
    },
    envs::{
        Environment, Goal, Seed,
        maze::{AntMaze, catalogue::ANT_REACHER},
    },
};

use crate::workload::Workload;

/// A plan of the default planner from the ant's start. What the model has learned changes nothing about its cost.
pub(crate) fn control() -> Vec<Workload> {
    let mut ant = AntMaze::new(&ANT_REACHER).expect("a maze of the registry");
    let (mut s, seed) = (Vec::new(), Seed(0));
    ant.reset(0);
    ant.observe(&mut s);
    let view = Arc::new(FreeBody::new(s.len(), 15));
    let mut rng = seed.stream("bench", 2);
    let model = Dynamics::new(view, 8, &DynamicsConfig::default(), Backend::Flex, &mut rng);
    let goal = Goal { dims: vec![0, 1], at: vec![0.0, 0.0], tolerance: 0.6 };
    let (planner, mut memory) = (Refining::default(), Memory::new());
    vec![Workload::repeated("agents/mpc/plan", move || {
        let objective = Reach { goal: &goal, reward: Reward::Dense, values: None };
        let problem = Problem { model: &model, objective: &objective, s: &s };
        black_box(planner.plan(&problem, &mut memory, &mut rng));
    })]
}
