//! Policy evaluation: how probable it is that a policy will succeed from a state (thesis 5.1.1).
//!
//! The question is one about the policy *as it is now*, the answer comes from steps that somebody took at any time:
//! fitted Q-evaluation (Le et al. 2019). An action that was taken is worth its cumulant (1 when it attained the
//! subgoal) and what the policy would be worth from there, and the policy is asked anew every time what it would do.
//! A state is worth what its action there is.
//!
//! ```text
//! Q(s, a) ← c + γ Q′(s′, π(s′))        V(s) ← Q(s, π(s))
//! ```
//!
//! With γ = 1 that is the probability of success itself, if lessons that end without success end for good
//! ([`Replay::closing`](crate::Replay::closing)): without that a value that keeps itself alive in a circle never falls.
//!
//! The value function of a *learner* answers another question, what the best policy would earn; it must not be used
//! for this one (5.1.1).

mod sigmoid;
mod table;
#[cfg(test)]
mod tests;

pub use sigmoid::{Sigmoid, SigmoidConfig};
pub use table::{Table, TableConfig};

use crate::{Checkpoint, Clip, Context};

/// What the policy under evaluation does at a state, without exploring.
pub type Policy<'a, O, A> = dyn Fn(&O, &mut Context) -> A + 'a;

/// Evaluates one policy, for one subgoal or, where `G` is read, for many.
pub trait Evaluator<O, A, G>: Checkpoint {
    /// V of each of these states, in [0, 1]: the probability that the policy attains the goal from there.
    fn values(&self, states: &[&O], goal: Option<&G>) -> Vec<f32>;

    /// The same as it was some updates ago: what competence progress is measured from (5.1.3).
    fn earlier(&self, states: &[&O], goal: Option<&G>) -> Vec<f32>;

    /// One update on clips whose rewards are cumulants ([`Pay::ATTAINMENT`](crate::experience::Pay::ATTAINMENT)); the
    /// loss.
    fn learn(&mut self, clips: &[Clip<O, A, G>], policy: &Policy<'_, O, A>, ctx: &mut Context) -> f32;

    /// How many clips `learn` wants.
    fn batch(&self) -> usize;
}

/// What every evaluator's settings must be.
fn check(discount: f32, batch: usize) -> Result<(), String> {
    if !(0.0..=1.0).contains(&discount) {
        return Err(format!("discount is {discount}; it must lie in [0, 1]"));
    }
    if batch == 0 {
        return Err("batch is 0; an update needs at least one clip".into());
    }
    Ok(())
}
