//! From a state that stands out to a goal that others can pursue (thesis 7.2.2.7, 9.2.3).

mod counterfactual;
mod whole;

pub use counterfactual::{Counterfactual, CounterfactualConfig, DropRule, Resets};
pub use whole::Whole;

/// Makes a goal of the most novel state of an exploration.
pub trait Name<O, G> {
    /// A goal that `novel` attains; `boring` is the least novel state of the same exploration, and `novelty` says how
    /// novel any state is, also one that was never seen. None when there is nothing to make a goal of.
    fn name(&self, novel: &O, boring: &O, novelty: &dyn Fn(&O) -> f32) -> Option<G>;

    /// The goal of being as `s` is in everything; none where there is no such goal.
    fn exactly(&self, s: &O) -> Option<G> {
        let _ = s;
        None
    }
}

impl<O, G> Name<O, G> for Box<dyn Name<O, G>> {
    fn name(&self, novel: &O, boring: &O, novelty: &dyn Fn(&O) -> f32) -> Option<G> {
        (**self).name(novel, boring, novelty)
    }

    fn exactly(&self, s: &O) -> Option<G> {
        (**self).exactly(s)
    }
}
