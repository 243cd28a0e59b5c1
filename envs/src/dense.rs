//! Dense task rewards: a wrapper that pays by the distance to the goal.

use crate::{End, Environment, Refused, Spec, Step};

/// What a metre from the goal costs a step (authors' code: 0.1).
const PRICE: f32 = 0.1;

/// Pays minus a tenth of the distance to the goal at every step, and 0 on reaching it. An environment whose spec
/// names no goal keeps its own rewards.
#[derive(Clone, Debug)]
pub struct DenseReward<E> {
    inner: E,
    spec: Spec,
    observation: Vec<f32>,
}

impl<E: Environment<Observation = Vec<f32>>> DenseReward<E> {
    /// Wraps an environment and gives it a name of its own.
    pub fn named(name: &'static str, about: &'static str, inner: E) -> Self {
        let spec = Spec { name, about, ..inner.spec().clone() };
        Self { inner, spec, observation: Vec::new() }
    }
}

impl<E: Environment<Observation = Vec<f32>>> Environment for DenseReward<E> {
    type Observation = Vec<f32>;
    type Action = E::Action;

    fn spec(&self) -> &Spec {
        &self.spec
    }

    fn reset(&mut self, seed: u64) {
        self.inner.reset(seed);
    }

    fn step(&mut self, action: &Self::Action) -> Result<Step, Refused> {
        let mut step = self.inner.step(action)?;
        if let (Some(goal), false) = (&self.spec.goal, step.end == Some(End::Terminated)) {
            self.inner.observe(&mut self.observation);
            step.reward = -PRICE * goal.distance(&self.observation);
        }
        Ok(step)
    }

    fn observe(&self, out: &mut Vec<f32>) {
        self.inner.observe(out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::corridor::Corridor;

    #[test]
    fn a_step_costs_a_tenth_of_the_distance_that_is_left_and_the_last_one_nothing() {
        let mut env = DenseReward::named("dense", "", Corridor::new(5));
        env.reset(0);
        let rewards: Vec<_> = (0..4).map(|_| env.step(&1).unwrap()).collect();
        let paid: Vec<_> = rewards.iter().map(|step| step.reward).collect();
        assert_eq!(paid, [-0.3, -0.2, -0.1, 0.0]);
        assert!(env.spec().succeeded(&rewards[3]) && !env.spec().succeeded(&rewards[2]));
    }
}
