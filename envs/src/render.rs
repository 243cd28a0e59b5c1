//! What only domains have that people can watch.

use inroads_sim::view::Scene;

use crate::Environment;

/// A domain that can be drawn.
pub trait Render {
    /// The world as it is now. Nothing of it is part of an observation.
    fn scene(&self) -> Scene;
}

/// What every domain of the registry is.
pub trait Domain<O: Clone + Default, A: Clone>:
    Environment<Observation = O, Action = A> + Render + Send
{
}

impl<O, A, D> Domain<O, A> for D
where
    O: Clone + Default,
    A: Clone,
    D: Environment<Observation = O, Action = A> + Render + Send,
{
}
