//! Acting by plans, which random pushes interrupt now and then.

use inroads_envs::Rng;
use rand::RngExt;
use serde::{Deserialize, Serialize};

use super::{Planner, Problem, Refining, Shooting};
use crate::Memory;

/// Which planner looks for actions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PlannerKind {
    /// The cross-entropy method with warm start.
    #[default]
    Refining,
    /// Random shooting, as in the papers.
    Shooting,
}

impl PlannerKind {
    /// The planner that is meant.
    pub(super) fn of<'a>(self, refining: &'a Refining, shooting: &'a Shooting) -> &'a dyn Planner {
        match self {
            Self::Refining => refining,
            Self::Shooting => shooting,
        }
    }
}

/// How plans are interrupted.
#[derive(Clone, Copy)]
pub(super) struct Steering<'a> {
    pub(super) planner: &'a dyn Planner,
    /// How probably a random action comes instead of a planned one.
    pub(super) random: f32,
    /// It is kept up for 1 to so many steps.
    pub(super) hold: u32,
}

impl Steering<'_> {
    /// The next action. The memory is: how many steps the last random action is still to be kept up, that action, and what
    /// the planner remembers.
    pub(super) fn act(&self, problem: &Problem<'_>, memory: &mut Memory, rng: &mut Rng) -> Vec<f32> {
        let width = problem.model.actions();
        if memory.is_empty() {
            memory.resize(1 + width, 0.0);
        }
        if memory[0] == 0.0 && rng.random::<f32>() < self.random {
            *memory = vec![rng.random_range(1..=self.hold) as f32];
            memory.extend((0..width).map(|_| rng.random_range(-1.0_f32..=1.0)));
        }
        if memory[0] > 0.0 {
            memory[0] -= 1.0;
            return memory[1..=width].to_vec();
        }
        let mut rest = memory.split_off(1 + width);
        let mut plan = self.planner.plan(problem, &mut rest, rng);
        memory.append(&mut rest);
        plan.truncate(width);
        plan
    }
}
