//! What only domains have that people can watch.

use image::RgbImage;
use inroads_sim::view::Scene;

use crate::{Environment, world::Fact};

/// A domain as people see it. Nothing of it is part of an observation.
#[derive(Clone, Debug)]
pub enum Drawing {
    /// Bodies in a room, to be looked at by a camera.
    Bodies(Scene),
    /// A finished picture, as small as it can be drawn.
    Pixels(RgbImage),
}

impl Drawing {
    /// The bodies, where there are any.
    pub fn bodies(self) -> Option<Scene> {
        match self {
            Self::Bodies(scene) => Some(scene),
            Self::Pixels(_) => None,
        }
    }
}

/// A domain that can be drawn.
pub trait Render {
    /// The world as it is now.
    fn drawing(&self) -> Drawing;

    /// What is true of it now, for metrics and plots; where there is nothing to say that is not observed, nothing.
    fn facts(&self) -> Vec<Fact> {
        Vec::new()
    }

    /// What is told in words, where anything is.
    fn told(&self) -> Option<String> {
        None
    }

    /// What each choice does, in a word or two, where choices have names.
    fn choices(&self) -> &'static [&'static str] {
        &[]
    }
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
