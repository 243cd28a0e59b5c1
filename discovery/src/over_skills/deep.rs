//! The policy over options as a double DQN with one output a skill.

use std::collections::VecDeque;
use std::sync::Arc;

use inroads_agents::{
    Context, Encoder, Experience, checkpoint,
    dqn::{GrowingDqn, Sample},
};
use rand::RngExt;

use super::{Choice, Epsilon, PolicyOverSkills, greedy};
use crate::SkillId;

/// A double DQN whose outputs grow with the skills.
pub struct DeepOverSkills<O> {
    encoder: Arc<dyn Encoder<O> + Send + Sync>,
    network: GrowingDqn,
    epsilon: Epsilon,
    choices: VecDeque<Choice>,
    capacity: usize,
    decisions: u64,
}

checkpoint!([O] DeepOverSkills<O>; plain: choices, decisions; parts: network);

impl<O> DeepOverSkills<O> {
    /// A policy over as many skills as `network` has outputs, remembering `capacity` decisions.
    pub fn new(
        encoder: Arc<dyn Encoder<O> + Send + Sync>,
        network: GrowingDqn,
        epsilon: Epsilon,
        capacity: usize,
    ) -> Self {
        Self { encoder, network, epsilon, choices: VecDeque::new(), capacity, decisions: 0 }
    }

    fn rows<'a>(&self, states: impl Iterator<Item = &'a O>) -> Vec<f32>
    where
        O: 'a,
    {
        let width = self.encoder.width();
        let mut rows = Vec::new();
        for s in states {
            let start = rows.len();
            rows.resize(start + width, 0.0);
            self.encoder.write(s, &mut rows[start..]);
        }
        rows
    }
}

impl<O> PolicyOverSkills<O> for DeepOverSkills<O> {
    fn choose(&self, s: &O, admissible: &[SkillId], ctx: &mut Context) -> SkillId {
        if ctx.explore && ctx.acting.random::<f32>() < self.epsilon.at(self.decisions) {
            return admissible[ctx.acting.random_range(0..admissible.len())];
        }
        greedy(&self.values(s), admissible, &mut ctx.acting)
    }

    fn record<A>(&mut self, choice: Choice, all: &Experience<O, A>) {
        self.decisions += 1;
        self.choices.push_back(choice);
        while self.choices.len() > self.capacity
            || self.choices.front().is_some_and(|c| c.episode < all.first())
        {
            self.choices.pop_front();
        }
    }

    fn learn<A>(
        &mut self,
        all: &Experience<O, A>,
        admissible: &dyn Fn(&O) -> Vec<SkillId>,
        ctx: &mut Context,
    ) {
        let batch = self.network.batch();
        if self.choices.len() < batch {
            return;
        }
        let drawn: Vec<_> = (0..batch)
            .map(|_| &self.choices[ctx.learning.random_range(0..self.choices.len())])
            .filter_map(|c| all.episode(c.episode).map(|e| (c, &e.observations)))
            .collect();
        let before = self.rows(drawn.iter().map(|(c, o)| &o[c.steps.start as usize]));
        let after = self.rows(drawn.iter().map(|(c, o)| &o[c.steps.end as usize]));
        let width = self.encoder.width();
        let outputs = self.network.outputs();
        let samples: Vec<_> = drawn
            .iter()
            .zip(before.chunks(width).zip(after.chunks(width)))
            .map(|((c, o), (before, after))| {
                let mut allowed = vec![false; outputs];
                for k in admissible(&o[c.steps.end as usize]) {
                    allowed[k.index()] = true;
                }
                Sample {
                    before,
                    choice: c.skill.index(),
                    reward: c.reward,
                    discount: c.discount,
                    after,
                    admissible: allowed,
                    terminal: c.terminal,
                }
            })
            .collect();
        let loss = self.network.learn(&samples);
        ctx.check("loss of the policy over options", loss);
    }

    fn grow(&mut self, triggers: &[O]) {
        let values = self.network.values(&self.rows(triggers.iter()));
        let best = values.into_iter().fold(f32::NEG_INFINITY, f32::max);
        self.network.grow(if best.is_finite() { best } else { 0.0 });
    }

    fn values(&self, s: &O) -> Vec<f32> {
        self.network.values(&self.rows(std::iter::once(s)))
    }

    fn updates(&self) -> u64 {
        self.network.updates()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use inroads_agents::{dqn::GrowingConfig, encode::Select, nets::Backend};
    use inroads_envs::Seed;

    #[test]
    fn a_new_skill_is_worth_the_best_that_its_triggers_have_seen_and_changes_no_other_value() {
        let mut rng = Seed(1).stream("test", 0);
        let network = GrowingDqn::new(2, 2, &GrowingConfig::default(), Backend::Flex, &mut rng);
        let encoder = Arc::new(Select::new(&[0, 1]));
        let mut policy = DeepOverSkills::new(encoder, network, Epsilon::default(), 10);
        let states: Vec<Vec<f32>> = (0..50).map(|i| vec![(i as f32).sin(), (i as f32).cos()]).collect();
        let triggers = &states[3..8];
        let values = |policy: &DeepOverSkills<Vec<f32>>| -> Vec<Vec<f32>> {
            states.iter().map(|s| policy.values(s)).collect()
        };

        let before = values(&policy);
        let best = before[3..8].iter().flatten().copied().fold(f32::NEG_INFINITY, f32::max);
        policy.grow(triggers);
        for (old, new) in before.iter().zip(values(&policy)) {
            assert_eq!(new[..2], old[..], "an old value has changed");
            assert_eq!(new[2], best);
        }
    }
}
