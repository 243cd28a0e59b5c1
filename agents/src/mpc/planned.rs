//! A learner whose actions are planned: model-based control with a terminal value (equation 4.1; Lowrey 2019).
//!
//! Another learner learns the value V(s | g), as it would alone, and its policy is not asked for actions; plans on a model
//! of the dynamics, which learns from the same clips, end with that value. So whatever holds a goal-conditioned learner (an
//! agent alone on its way to a goal, option policies that are one for all) can be model-based by a change of its parts.

use std::sync::Arc;

use inroads_envs::Rng;
use serde::{Deserialize, Serialize};

use super::{
    Dynamics, DynamicsConfig, PlannerKind, Problem, Reach, Refining, Reward, Shooting, View, steer::Steering,
};
use crate::{Clip, Context, Learned, Learner, Memory, checkpoint, goal::Region, nets::Backend};

/// Settings of planned actions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PlannedConfig {
    /// The model.
    pub dynamics: DynamicsConfig,
    /// Who plans.
    pub planner: PlannerKind,
    /// For `planner = "refining"`.
    pub refining: Refining,
    /// For `planner = "shooting"`.
    pub shooting: Shooting,
    /// What predicted states pay. It should be what the learner of the values is paid, but for a plan that ends without them.
    pub reward: Reward,
    /// Whether what lies beyond the horizon counts by the learner's values (equation 4.1), or nothing does (equation 6.6).
    pub values: bool,
    /// Updates of the model before the first plan; until then actions are random (authors: 50 episodes of random actions,
    /// then 50 passes over them).
    pub ready: u64,
    /// The model makes an update with every so many of the learner's (authors: 5 passes over everything after each episode).
    pub every: u64,
    /// A random action is kept up for 1 to so many steps, drawn anew each time (authors: 1).
    pub hold: u32,
    /// How probably a random action comes instead of a planned one, in training (authors: 0.1, at evaluation too).
    pub epsilon: f32,
}

impl Default for PlannedConfig {
    fn default() -> Self {
        Self {
            dynamics: DynamicsConfig::default(),
            planner: PlannerKind::default(),
            refining: Refining { horizon: 10, candidates: 64, rounds: 2, elites: 8, ..Refining::default() },
            shooting: Shooting::default(),
            reward: Reward::Dense,
            values: true,
            ready: 5000,
            every: 1,
            hold: 10,
            epsilon: 0.1,
        }
    }
}

impl PlannedConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        self.dynamics.check().map_err(|why| format!("dynamics.{why}"))?;
        self.refining.check()?;
        self.shooting.check()?;
        for (name, value) in [("every", self.every), ("hold", u64::from(self.hold))] {
            if value == 0 {
                return Err(format!("{name} is 0; it must be at least 1"));
            }
        }
        if !(0.0..=1.0).contains(&self.epsilon) {
            return Err(format!("epsilon is {}; it must lie in [0, 1]", self.epsilon));
        }
        if self.reward == Reward::Sparse && !self.values {
            return Err("reward is \"sparse\" and values is false: plans would see nothing but a goal within their horizon; set \
                        reward = \"dense\" or values = true"
                .into());
        }
        Ok(())
    }
}

/// A learner of values whose actions are planned.
pub struct Planned<L> {
    learner: L,
    config: PlannedConfig,
    model: Dynamics,
    updates: u64,
}

checkpoint!([L] Planned<L>; plain: updates; parts: learner, model; where L: crate::Checkpoint);

impl<L> Planned<L> {
    /// Plans with the values of `learner`, by actions of so many numbers in [−1, 1].
    ///
    /// # Panics
    /// When the settings are impossible: see [`PlannedConfig::check`].
    pub fn new(
        learner: L,
        view: Arc<dyn View>,
        actions: usize,
        config: &PlannedConfig,
        backend: Backend,
        rng: &mut Rng,
    ) -> Self {
        let model = Dynamics::new(view, actions, &config.dynamics, backend, rng);
        Self { learner, config: config.clone(), model, updates: 0 }
    }

    /// The model.
    pub fn model(&self) -> &Dynamics {
        &self.model
    }

    /// Whether the model has learned enough to plan with.
    fn ready(&self) -> bool {
        self.updates / self.config.every >= self.config.ready
    }
}

impl<L: Learner<Vec<f32>, Vec<f32>, Region>> Learner<Vec<f32>, Vec<f32>, Region> for Planned<L> {
    /// # Panics
    /// When there is no goal: nobody has said where to go.
    fn act(&self, memory: &mut Memory, s: &Vec<f32>, goal: Option<&Region>, ctx: &mut Context) -> Vec<f32> {
        let config = &self.config;
        let region = goal.expect("a plan leads to a goal");
        let random = match (self.ready(), ctx.explore) {
            (false, _) => 1.0,
            (true, explore) => f32::from(explore) * config.epsilon,
        };
        let width = s.len();
        let values = |rows: &[f32]| {
            let states: Vec<_> = rows.chunks_exact(width).map(<[f32]>::to_vec).collect();
            self.learner.values_of(&states, goal)
        };
        let objective = Reach {
            goal: &region.goal(),
            reward: config.reward,
            values: if config.values { Some(&values) } else { None },
        };
        let problem = Problem { model: &self.model, objective: &objective, s };
        let planner = config.planner.of(&config.refining, &config.shooting);
        Steering { planner, random, hold: config.hold }.act(&problem, memory, &mut ctx.acting)
    }

    fn values(&self, memory: &Memory, s: &Vec<f32>, goals: &[Option<&Region>]) -> Vec<f32> {
        self.learner.values(memory, s, goals)
    }

    fn values_of(&self, states: &[Vec<f32>], goal: Option<&Region>) -> Vec<f32> {
        self.learner.values_of(states, goal)
    }

    fn learn(&mut self, clips: &[Clip<'_, Vec<f32>, Vec<f32>, Region>], ctx: &mut Context) -> Learned {
        let learned = self.learner.learn(clips, ctx);
        self.updates += 1;
        if self.updates.is_multiple_of(self.config.every) {
            let steps = clips.iter().flat_map(|clip| {
                let pairs = clip.observations.windows(2).zip(clip.actions);
                pairs.map(|(pair, action)| [pair[0].as_slice(), action, &pair[1]])
            });
            ctx.check("loss of the model", self.model.learn(steps));
        }
        learned
    }

    fn batch(&self) -> usize {
        self.learner.batch()
    }
}

#[cfg(test)]
mod tests;
