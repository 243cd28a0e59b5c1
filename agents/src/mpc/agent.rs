//! Model-based control alone as an agent: random episodes, a fit, and then plans towards a goal.

use std::sync::Arc;

use inroads_envs::{Goal, Rng};
use serde::{Deserialize, Serialize};

use super::{
    Dynamics, DynamicsConfig, Fit, Planner, PlannerKind, Problem, Reach, Refining, Reward, Shooting, View,
    steer::Steering,
};
use crate::{Actor, Agent, Context, Experience, Memory, Transition, checkpoint, nets::Backend};

/// Settings of the agent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct MpcConfig {
    /// The model.
    pub dynamics: DynamicsConfig,
    /// Who plans.
    pub planner: PlannerKind,
    /// For `planner = "refining"`.
    pub refining: Refining,
    /// For `planner = "shooting"`.
    pub shooting: Shooting,
    /// What predicted states pay.
    pub reward: Reward,
    /// Episodes of random actions before the first fit (authors: 50).
    pub warm_up: u64,
    /// A random action is kept up for 1 to so many steps, drawn anew each time (paper and authors: 1). Who changes his mind
    /// at every step never sees what becomes of a push that lasts, and a model of his steps believes that each gets him on.
    pub hold: u32,
    /// Passes over the data of the first fit (authors: 50).
    pub first_epochs: usize,
    /// Passes of later fits (authors: 5).
    pub epochs: usize,
    /// Episodes from one fit to the next (authors: 1).
    pub refit: u64,
    /// How probably a random action comes instead of a planned one, at evaluation too (authors: 0.1, and so). Where a model
    /// is wrong in that a body moves that does not, the same plan would come for ever.
    pub epsilon: f32,
    /// Steps remembered (authors: 3e5).
    pub capacity: usize,
}

impl Default for MpcConfig {
    fn default() -> Self {
        Self {
            dynamics: DynamicsConfig::default(),
            planner: PlannerKind::default(),
            refining: Refining::default(),
            shooting: Shooting::default(),
            reward: Reward::default(),
            warm_up: 50,
            hold: 10,
            first_epochs: 50,
            epochs: 5,
            refit: 1,
            epsilon: 0.1,
            capacity: 300_000,
        }
    }
}

impl MpcConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        self.dynamics.check().map_err(|why| format!("dynamics.{why}"))?;
        self.refining.check()?;
        self.shooting.check()?;
        let least = [
            ("warm_up", self.warm_up),
            ("hold", u64::from(self.hold)),
            ("first_epochs", self.first_epochs as u64),
            ("refit", self.refit),
            ("capacity", self.capacity as u64),
        ];
        if let Some((name, _)) = least.into_iter().find(|(_, value)| *value == 0) {
            return Err(format!("{name} is 0; it must be at least 1"));
        }
        if !(0.0..=1.0).contains(&self.epsilon) {
            return Err(format!("epsilon is {}; it must lie in [0, 1]", self.epsilon));
        }
        Ok(())
    }

    /// Who plans by these settings.
    pub fn planner(&self) -> &dyn Planner {
        self.planner.of(&self.refining, &self.shooting)
    }
}

/// An agent that learns what its actions lead to, and plans.
pub struct Mpc {
    config: MpcConfig,
    goal: Goal,
    dynamics: Dynamics,
    experience: Experience<Vec<f32>, Vec<f32>>,
    memory: Memory,
    /// Fits made so far.
    fits: u64,
    /// Episodes that have ended.
    episodes: u64,
    last: Fit,
}

impl Mpc {
    /// An agent on its way to `goal` by actions of so many numbers in [−1, 1].
    ///
    /// # Panics
    /// When the settings are impossible: see [`MpcConfig::check`].
    pub fn new(
        view: Arc<dyn View>,
        actions: usize,
        goal: Goal,
        config: &MpcConfig,
        backend: Backend,
        rng: &mut Rng,
    ) -> Self {
        Self {
            dynamics: Dynamics::new(view, actions, &config.dynamics, backend, rng),
            experience: Experience::new(config.capacity),
            config: config.clone(),
            goal,
            memory: Memory::new(),
            fits: 0,
            episodes: 0,
            last: Fit::default(),
        }
    }

    /// The model.
    pub fn dynamics(&self) -> &Dynamics {
        &self.dynamics
    }

    /// What the last fit came to.
    pub fn last_fit(&self) -> Fit {
        self.last
    }

    /// The agent without learning, on the way to a goal of its own.
    pub fn towards(&self, goal: Goal) -> Planning<'_> {
        Planning { agent: self, goal, memory: Memory::new() }
    }

    fn act_with(&self, goal: &Goal, memory: &mut Memory, s: &[f32], ctx: &mut Context) -> Vec<f32> {
        let config = &self.config;
        let objective = Reach { goal, reward: config.reward, values: None };
        let problem = Problem { model: &self.dynamics, objective: &objective, s };
        let planner = config.planner();
        let random = if self.fits == 0 { 1.0 } else { config.epsilon };
        Steering { planner, random, hold: config.hold }.act(&problem, memory, &mut ctx.acting)
    }
}

impl Actor<Vec<f32>, Vec<f32>> for Mpc {
    fn begin(&mut self, s: &Vec<f32>, _: &mut Context) {
        self.memory.clear();
        self.experience.begin(s);
    }

    fn act(&mut self, s: &Vec<f32>, ctx: &mut Context) -> Vec<f32> {
        let mut memory = std::mem::take(&mut self.memory);
        let action = self.act_with(&self.goal, &mut memory, s, ctx);
        self.memory = memory;
        action
    }

    fn observe(&mut self, t: &Transition<Vec<f32>, Vec<f32>>, ctx: &mut Context) {
        self.experience.push(t);
        if t.end.is_none() {
            return;
        }
        self.episodes += 1;
        let since = self.episodes.checked_sub(self.config.warm_up);
        if since.is_some_and(|since| since.is_multiple_of(self.config.refit)) {
            let epochs = if self.fits == 0 { self.config.first_epochs } else { self.config.epochs };
            self.last = self.dynamics.fit(&self.experience, epochs, &mut ctx.learning);
            ctx.check("loss of the model", self.last.loss);
            // Of held out episodes alone nothing is learned.
            self.fits += u64::from(self.last.steps > 0);
        }
    }
}

impl Agent<Vec<f32>, Vec<f32>> for Mpc {
    fn frozen(&self) -> Box<dyn Actor<Vec<f32>, Vec<f32>> + '_> {
        Box::new(self.towards(self.goal.clone()))
    }

    fn updates(&self) -> Vec<(&'static str, u64)> {
        vec![("model", self.fits)]
    }
}

checkpoint!([] Mpc; plain: experience, fits, episodes, last; parts: dynamics);

/// The agent watched without learning.
pub struct Planning<'a> {
    agent: &'a Mpc,
    goal: Goal,
    memory: Memory,
}

impl Actor<Vec<f32>, Vec<f32>> for Planning<'_> {
    fn begin(&mut self, _: &Vec<f32>, _: &mut Context) {
        self.memory.clear();
    }

    fn act(&mut self, s: &Vec<f32>, ctx: &mut Context) -> Vec<f32> {
        self.agent.act_with(&self.goal, &mut self.memory, s, ctx)
    }

    fn observe(&mut self, _: &Transition<Vec<f32>, Vec<f32>>, _: &mut Context) {}
}
