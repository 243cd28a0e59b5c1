//! Least-squares policy iteration for many events at once (thesis section 8.3.1.1; Lagoudakis and Parr 2003).
//!
//! An *event* is something that some transitions of a batch bring about, and others do not. For each of them there are two
//! rewards, *seek* (1 where it occurs) and *avoid* (−1); it ends what is rewarded. Two solves of LSTDQ give rough values of
//! seeking and avoiding it: the first for actions at random, the second for the actions that are greedy by the first. Where
//! the values differ, it depends on the agent whether the event occurs.
//!
//! "At random" means the expectation over all actions. The author's code draws one action a row instead; then the first values
//! are those of one arbitrary policy, and with few rows the second solve follows its accidents: the median gap of the places of
//! Taxi's passenger (4,096 transitions, three seeds) is 0.05 then, and 0.2 with the expectation.
//!
//! With features `φ(s)` in the block of `a`, LSTDQ solves `(A + λI) θ = b` with
//! `A = Σ φ(s,a) (φ(s,a) − γ(1−d) φ(s',π(s')))ᵀ` and `b = Σ φ(s,a) r`, over the batch's transitions; `d` is 1 where the
//! event occurs and where the episode terminated.
//!
//! What is shared: Gram matrices and their factors by all systems ([`Batch`]); the first solve's matrix, but for an event's own
//! transitions, by all events, and its solution by both signs, since it changes sign with the reward (`random.rs`: exact, in
//! double precision). What is approximate: a system of the second solve is solved until its residual is [`Lspi::tolerance`]
//! of its right-hand side (GMRES, `bellman.rs`), with products in single precision and sums in double.

mod batch;
mod bellman;
mod dense;
mod krylov;
mod projection;
mod random;
mod rows;
#[cfg(test)]
mod tests;

pub use batch::Batch;
pub use projection::Projection;
pub use rows::Rows;

use bellman::Case;
use inroads_envs::Rng;
use rand::RngExt;
use serde::{Deserialize, Serialize};

/// Events that are solved for side by side.
const TOGETHER: usize = 16;

/// Values that differ by no more are equal: rows are in single precision, and values are at most about 1.
const SAME: f32 = 1e-6;

/// Settings of least-squares policy iteration.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Lspi {
    /// Features of an observation, the constant among them (100: the author's code; see [`Projection::narrow`]).
    pub features: usize,
    /// Discount a step, in [0, 1) (0.95: the author's code).
    pub gamma: f64,
    /// The ridge as a share of the mean of the Gram matrix' diagonal (1e-3; by white features it matters little: in our
    /// probes 1e-6 gives gaps that differ in the third digit).
    pub ridge: f64,
    /// The residual at which a system of the second solve is solved, as a share of its right-hand side (1e-2: gaps of Taxi,
    /// timer and distractors differ by up to 0.03 from those with 1e-4).
    pub tolerance: f64,
    /// Products after which such a system is left as it is.
    pub products: usize,
}

impl Default for Lspi {
    fn default() -> Self {
        Self { features: 100, gamma: 0.95, ridge: 1e-3, tolerance: 1e-2, products: 200 }
    }
}

/// Why nothing can be learned from a batch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LspiError {
    /// No transition, or no number in its rows.
    #[error("there is nothing to learn from: the batch has no transitions, or its rows no numbers")]
    Nothing,
    /// An action that there is not.
    #[error("a transition has action {action}, but there are only {choices}, numbered from 0")]
    Action {
        /// The action.
        action: usize,
        /// How many there are.
        choices: usize,
    },
    /// No inverse.
    #[error(
        "the features have no Gram matrix that can be inverted; give a ridge above 0, and features that are numbers"
    )]
    Singular,
}

/// Values of one event after every transition of the batch, in the batch's order.
#[derive(Clone, Copy, Debug)]
pub struct Values<'a> {
    /// Whether it occurs.
    pub occurs: &'a [bool],
    /// Of seeking it, in [0, 1]; 1 where it occurs.
    pub seek: &'a [f32],
    /// Of avoiding it, in [−1, 0]; −1 where it occurs.
    pub avoid: &'a [f32],
}

impl Lspi {
    /// Whether the settings make sense.
    ///
    /// # Errors
    /// What is wrong, and how to mend it.
    pub fn check(&self) -> Result<(), String> {
        if self.features < 2 {
            return Err(format!(
                "features = {} leaves nothing but a constant; give 2 or more",
                self.features
            ));
        }
        if !(0.0..1.0).contains(&self.gamma) {
            return Err(format!("gamma = {} is no discount; give a number from 0 to below 1", self.gamma));
        }
        if !(self.ridge > 0.0 && self.ridge.is_finite()) {
            return Err(format!("ridge = {} cannot be added; give a number above 0 (1e-3)", self.ridge));
        }
        if !(self.tolerance > 0.0 && self.tolerance < 1.0) {
            return Err(format!("tolerance = {} is no share; give a number between 0 and 1", self.tolerance));
        }
        if self.products == 0 {
            return Err("products = 0 solves nothing; give 1 or more (200)".into());
        }
        Ok(())
    }

    /// Makes features of observations ready, with [`ridge`](Self::ridge).
    ///
    /// # Errors
    /// As [`Batch::new`].
    pub fn batch(&self, features: &Rows, choices: usize) -> Result<Batch, LspiError> {
        Batch::new(features, choices, self.ridge)
    }

    /// Estimates the values of events, each given by the transitions (row numbers) that bring it about, and shows them to
    /// `each` with the event's number, in order. Events that no transition brings about are passed over: the batch says
    /// nothing about them.
    ///
    /// `rng` decides between actions of equal value.
    ///
    /// # Panics
    /// When an event names a transition that there is not.
    pub fn solve(
        &self,
        batch: &Batch,
        events: &[Vec<usize>],
        rng: &mut Rng,
        mut each: impl FnMut(usize, Values<'_>),
    ) {
        let choices = batch.choices() as u16;
        let ties: Vec<u16> = (0..batch.distinct()).map(|_| rng.random_range(0..choices)).collect();
        let occurring: Vec<usize> = (0..events.len()).filter(|&event| !events[event].is_empty()).collect();
        for group in occurring.chunks(TOGETHER) {
            let tasks: Vec<Task> = group.iter().map(|&event| self.task(batch, &events[event])).collect();
            let weights = self.iterate(batch, &ties, &tasks);
            for ((&event, task), [seek, avoid]) in group.iter().zip(&tasks).zip(&weights) {
                let seek = task.values(batch, seek, 1.0);
                let avoid = task.values(batch, avoid, -1.0);
                each(event, Values { occurs: &task.occurs, seek: &seek, avoid: &avoid });
            }
        }
    }

    /// What an event asks of least squares.
    fn task(&self, batch: &Batch, event: &[usize]) -> Task {
        let stride = batch.stride;
        let mut task = Task {
            discount: Vec::with_capacity(batch.distinct()),
            occurs: vec![false; batch.len()],
            places: Vec::new(),
            earned: vec![0.0; stride * batch.choices()],
        };
        let mut others = batch.counts.clone();
        for &row in event {
            let place = batch.places[row];
            let action = batch.action(place);
            let white = &batch.before[place * stride..][..stride];
            let block = &mut task.earned[action * stride..][..stride];
            block.iter_mut().zip(white).for_each(|(sum, &x)| *sum += f64::from(x));
            others[place] -= 1.0;
            task.occurs[row] = true;
        }
        let with = batch.counts.iter().zip(&others).map(|(all, others)| all - others).enumerate();
        task.places.extend(with.filter(|(_, count)| *count > 0.0));
        let rest = others.iter().zip(&batch.goes_on);
        task.discount.extend(rest.map(|(others, on)| self.gamma as f32 * others * on));
        task
    }

    /// The first solve: white weights of seeking by actions at random.
    fn first(&self, batch: &Batch, tasks: &[Task]) -> Vec<Vec<f64>> {
        let mean = |task: &Task| batch.random.weights(batch, self.gamma, &task.places);
        // Whatever is done next has that value: the mean's weights stand in the first action's place.
        let any = vec![0; batch.distinct()];
        let cases: Vec<Case<'_>> = tasks.iter().map(|task| task.case(&any, 1.0)).collect();
        bellman::back_up(batch, &cases, tasks.iter().map(mean).collect())
    }

    /// Two solves: weights of seeking and of avoiding.
    fn iterate(&self, batch: &Batch, ties: &[u16], tasks: &[Task]) -> Vec<[Vec<f32>; 2]> {
        let first = self.first(batch, tasks);
        let signs = [1.0, -1.0];
        let mut policies = Vec::with_capacity(2 * tasks.len());
        let mut guesses = Vec::with_capacity(2 * tasks.len());
        for white in &first {
            let weights = bellman::plain(batch, white);
            policies.extend(greedy(batch, &weights, ties));
            guesses.extend(signs.map(|sign| white.iter().map(|x| sign * x).collect::<Vec<_>>()));
        }
        let cases: Vec<Case<'_>> = policies
            .iter()
            .enumerate()
            .map(|(at, policy)| tasks[at / 2].case(policy, signs[at % 2]))
            .collect();
        let solved = bellman::solve(batch, &cases, &guesses, self.tolerance, self.products);
        solved
            .chunks_exact(2)
            .map(|pair| [&pair[0], &pair[1]].map(|white| bellman::plain(batch, white)))
            .collect()
    }
}

/// An event in a batch.
#[derive(Debug)]
struct Task {
    /// At which of the caller's transitions it occurs.
    occurs: Vec<bool>,
    /// The distinct transitions that bring it about, and how many of each one's likes do.
    places: Vec<(usize, f32)>,
    /// What the value after a distinct transition counts: γ for each of its likes that bring about neither the event nor the
    /// episode's end.
    discount: Vec<f32>,
    /// `Σ ψ r`, in white features.
    earned: Vec<f64>,
}

impl Task {
    fn case<'a>(&'a self, policy: &'a [u16], sign: f64) -> Case<'a> {
        Case { policy, discount: &self.discount, earned: &self.earned, sign }
    }

    /// The value of the best action after each transition, in the caller's order.
    fn values(&self, batch: &Batch, weights: &[f32], sign: f32) -> Vec<f32> {
        let mut all = vec![0.0; batch.choices()];
        let (low, high) = (sign.min(0.0), sign.max(0.0));
        let best = |(place, &on): (usize, &f32)| {
            bellman::values_after(batch, weights, place, &mut all);
            // After the end nothing comes.
            on * all.iter().copied().fold(f32::NEG_INFINITY, f32::max).clamp(low, high)
        };
        let distinct: Vec<f32> = batch.goes_on.iter().enumerate().map(best).collect();
        let known = batch.places.iter().zip(&self.occurs);
        known.map(|(&place, &occurs)| if occurs { sign } else { distinct[place] }).collect()
    }
}

/// The actions that are greedy by weights, and those that are by the weights' negative. Where none is better than the one in
/// `ties`, that one stays: values are equal wherever an event is out of sight, and then no action must be preferred.
fn greedy(batch: &Batch, weights: &[f32], ties: &[u16]) -> [Vec<u16>; 2] {
    let mut policies = [ties.to_vec(), ties.to_vec()];
    let mut all = vec![0.0; batch.choices()];
    for (place, &tied) in ties.iter().enumerate() {
        bellman::values_after(batch, weights, place, &mut all);
        let kept = all[usize::from(tied)];
        let (mut greatest, mut least) = (kept + SAME, kept - SAME);
        for (action, &value) in (0..).zip(&all) {
            if value > greatest {
                (greatest, policies[0][place]) = (value, action);
            }
            if value < least {
                (least, policies[1][place]) = (value, action);
            }
        }
    }
    policies
}
