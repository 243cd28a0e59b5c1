//! Sequences of actions, and what a model says they are worth.
//!
//! All candidates go through the model together, one step of the horizon after the other, so that a plan is a few large
//! products of matrices.

use inroads_envs::Rng;

use super::{Objective, Predict};
use crate::Memory;

/// What is planned for: a model, what is to be gained, and where one is.
#[derive(Clone, Copy)]
pub struct Problem<'a> {
    /// What foresees.
    pub model: &'a dyn Predict,
    /// What is to be gained.
    pub objective: &'a dyn Objective,
    /// The present state.
    pub s: &'a [f32],
}

/// Looks for the actions that gain most.
pub trait Planner {
    /// Actions for the whole horizon, one after the other. What one plan can pass on to that of the next step stands in
    /// `memory`, which is empty when an episode begins.
    fn plan(&self, problem: &Problem<'_>, memory: &mut Memory, rng: &mut Rng) -> Vec<f32>;

    /// States that it has predicted for a plan.
    fn predictions(&self) -> usize;
}

/// Sequences of actions: all first actions, then all second ones.
#[derive(Clone, Debug)]
pub struct Candidates {
    count: usize,
    /// Numbers an action.
    width: usize,
    actions: Vec<f32>,
}

impl Candidates {
    /// So many sequences of `horizon` actions of `width` numbers, all zero.
    pub fn new(count: usize, horizon: usize, width: usize) -> Self {
        Self { count, width, actions: vec![0.0; count * horizon * width] }
    }

    /// One sequence, whose actions stand one after the other.
    pub fn one(sequence: &[f32], width: usize) -> Self {
        Self { count: 1, width, actions: sequence.to_vec() }
    }

    /// How many sequences.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The actions of all at one time after the other.
    pub fn times(&self) -> impl Iterator<Item = &[f32]> {
        self.actions.chunks_exact((self.count * self.width).max(1))
    }

    /// Every number, in this order: time, sequence, part of the action.
    pub fn numbers(&mut self) -> &mut [f32] {
        &mut self.actions
    }

    /// The actions of sequence number `i`, one after the other.
    pub fn sequence(&self, i: usize) -> Vec<f32> {
        let at = i * self.width;
        self.times().flat_map(|now| &now[at..at + self.width]).copied().collect()
    }

    /// Σ γ^{t−1} R(ŝ_t, g) over the horizon for each sequence, the first *predicted* state having weight 1, and
    /// γ^H V(ŝ_H | g) where there are values (equations 4.1 and 6.6). What is not a number counts as −∞.
    pub fn returns(&self, problem: &Problem<'_>, discount: f32) -> Vec<f32> {
        let mut states = problem.s.repeat(self.count);
        let (mut sums, mut paid, mut weight) = (vec![0.0; self.count], vec![0.0; self.count], 1.0);
        for actions in self.times() {
            states = problem.model.next(&states, actions);
            problem.objective.rewards(&states, &mut paid);
            sums.iter_mut().zip(&paid).for_each(|(sum, paid)| *sum += weight * paid);
            weight *= discount;
        }
        if let Some(values) = problem.objective.values(&states) {
            sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight * value);
        }
        sums.iter_mut().filter(|sum| sum.is_nan()).for_each(|sum| *sum = f32::NEG_INFINITY);
        sums
    }
}
