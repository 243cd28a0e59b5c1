//! What an execution of a skill is told to reach: its whole set, or one state of it (4.1.2).

use inroads_envs::Rng;

use crate::{Features, Goal};

/// How a state becomes a goal that a policy can read.
pub trait Aim<O> {
    /// What policies read.
    type Goal: Goal<O>;

    /// Whether there are such goals at all.
    const TELLS: bool;

    /// "Be where `s` is"; none where policies are told nothing.
    fn at(&self, s: &O) -> Option<Self::Goal>;
}

/// Every skill has but one subgoal, the whole set, and its policy needs no telling (chapter 3).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sets;

impl<O> Aim<O> for Sets {
    type Goal = ();

    const TELLS: bool = false;

    fn at(&self, _: &O) -> Option<()> {
        None
    }
}

/// Every execution is told one state of the set (4.1.2): "be there, in these features, up to this distance".
#[derive(Clone, Debug, PartialEq)]
pub struct States {
    /// Which features tell where one is.
    pub features: Vec<usize>,
    /// Greatest Euclidean distance that counts as there (authors: 0.6 in their mazes).
    pub tolerance: f32,
}

impl Aim<Vec<f32>> for States {
    type Goal = Features;

    const TELLS: bool = true;

    fn at(&self, s: &Vec<f32>) -> Option<Features> {
        Some(Features::of(s, self.features.iter().copied(), self.tolerance))
    }
}

/// One of these at random; none of none.
pub(super) fn any<'a, T>(of: &'a [T], rng: &mut Rng) -> Option<&'a T> {
    use rand::RngExt;
    (!of.is_empty()).then(|| &of[rng.random_range(0..of.len())])
}
