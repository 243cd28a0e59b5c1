//! Tasks whose goal can be chosen: what has been achieved, how far that is from a goal, and what it pays.

use crate::{End, Environment, Rng, Step, TimeLimit};

/// What a step pays. Reaching the goal pays 0 and ends the episode, where there is a task.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pay {
    /// −1 for every step that does not reach the goal (the thesis' default).
    Sparse,
    /// Minus the distance to the goal after the step, times a price.
    Dense {
        /// Reward lost a metre: 1 in thesis section 6.2, 0.1 in the author's code of chapter 3.
        price: f32,
    },
    /// 0, wherever it leads: there is no task, and nothing but the time limit ends an episode (the unsupervised phase of
    /// thesis section 6.2).
    Nothing,
}

impl Pay {
    /// What a step that ends this far from the goal pays, and whether it ends the episode.
    pub fn step(self, distance: f32, tolerance: f32) -> Step {
        match self {
            Self::Nothing => Step { reward: 0.0, end: None },
            _ if distance <= tolerance => Step { reward: 0.0, end: Some(End::Terminated) },
            Self::Sparse => Step { reward: -1.0, end: None },
            Self::Dense { price } => Step { reward: -price * distance, end: None },
        }
    }
}

/// Why a goal cannot be pursued.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GoalError {
    /// The goal has the wrong number of components.
    #[error(
        "the goal has {found} components where {expected} are needed: one for each dimension of the \
         spec's goal"
    )]
    Width {
        /// Components that goals have.
        expected: usize,
        /// Components that were given.
        found: usize,
    },
    /// A component is not of the values that it can have.
    #[error("the goal's component {index} cannot be {value}: places are finite numbers, indicators 0 or 1")]
    Value {
        /// Which component.
        index: usize,
        /// Its value.
        value: f32,
    },
    /// The place is in a wall.
    #[error("the goal ({}, {}) is in a wall; choose a point of free space", at[0], at[1])]
    Wall {
        /// The place, metres.
        at: [f32; 2],
    },
}

/// A domain with goals that can be chosen.
///
/// A goal is a slice with one number for each of `spec().goal.dims`. [`reward`](Self::reward) is a pure
/// function: it is what a step pays that ends where `achieved` says while `goal` is pursued, so that past
/// steps can be paid for other goals (hindsight). What a goal asks for *beyond* a state, such as a key picked
/// up earlier, is an indicator among its dimensions.
///
/// ```
/// use inroads_envs::{Environment, Goals, maze::{PointMaze, U_MAZE}};
/// let mut maze = PointMaze::new(&U_MAZE)?;
/// maze.reset(0);
/// assert_eq!(maze.step(&vec![1.0, 0.0])?.reward, -1.0);
/// // In hindsight, what would that step have paid on the way to where it led?
/// let (mut seen, mut achieved) = (Vec::new(), Vec::new());
/// maze.observe(&mut seen);
/// maze.achieved(&seen, &mut achieved);
/// assert_eq!(maze.reward(&achieved, &achieved).reward, 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Goals: Environment {
    /// Writes into the caller's buffer what an observation has achieved.
    fn achieved(&self, observation: &Self::Observation, out: &mut Vec<f32>);

    /// How far what is achieved is from a goal, metres.
    fn distance(&self, achieved: &[f32], goal: &[f32]) -> f32;

    /// What a step pays that ends at `achieved`, and whether it ends the episode.
    fn reward(&self, achieved: &[f32], goal: &[f32]) -> Step;

    /// The goal that is pursued.
    fn goal(&self) -> &[f32];

    /// Pursues another goal from now on, in this episode and the next.
    ///
    /// # Errors
    /// [`GoalError`] says what is wrong with it; the old goal stays.
    fn set_goal(&mut self, goal: &[f32]) -> Result<(), GoalError>;

    /// A goal, uniformly from free space.
    fn sample_goal(&self, rng: &mut Rng) -> Vec<f32>;
}

impl<E: Goals> Goals for TimeLimit<E> {
    fn achieved(&self, observation: &Self::Observation, out: &mut Vec<f32>) {
        self.inner().achieved(observation, out);
    }

    fn distance(&self, achieved: &[f32], goal: &[f32]) -> f32 {
        self.inner().distance(achieved, goal)
    }

    fn reward(&self, achieved: &[f32], goal: &[f32]) -> Step {
        self.inner().reward(achieved, goal)
    }

    fn goal(&self) -> &[f32] {
        self.inner().goal()
    }

    fn set_goal(&mut self, goal: &[f32]) -> Result<(), GoalError> {
        self.change(|inner| inner.set_goal(goal))
    }

    fn sample_goal(&self, rng: &mut Rng) -> Vec<f32> {
        self.inner().sample_goal(rng)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_goal_pays_nothing_and_the_way_by_steps_or_metres() {
        let there = Step { reward: 0.0, end: Some(End::Terminated) };
        for pay in [Pay::Sparse, Pay::Dense { price: 0.1 }] {
            assert_eq!((pay.step(0.6, 0.6), pay.step(0.0, 0.6)), (there, there));
        }
        assert_eq!(Pay::Nothing.step(0.0, 0.6), Step { reward: 0.0, end: None });
        assert_eq!(Pay::Sparse.step(0.61, 0.6), Step { reward: -1.0, end: None });
        assert_eq!(Pay::Dense { price: 0.1 }.step(3.0, 0.6), Step { reward: -0.3, end: None });
    }
}
