//! What an execution of a skill is told to reach: its whole set, or one state of it (4.1.2).

use inroads_agents::goal::{Ground, Region};
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

    /// The task's goal, where it is such a goal itself. Then policies learn of it as of any other, and not of the task's
    /// reward.
    fn task(&self) -> Option<Self::Goal> {
        None
    }

    /// How far `s` is from a goal, as the crow flies.
    fn distance(&self, s: &O, goal: &Self::Goal) -> f32;

    /// The discounted probability of attaining a goal that a policy's value of it stands for.
    fn probability(&self, value: f32) -> f32 {
        value
    }
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

    fn distance(&self, _: &O, (): &()) -> f32 {
        0.0
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

    fn distance(&self, s: &Vec<f32>, goal: &Features) -> f32 {
        goal.distance(s)
    }
}

/// The same with places: "be there", by policies that learn what a way costs.
#[derive(Clone, Debug, PartialEq)]
pub struct Places {
    /// Which dimensions tell where one is.
    pub ground: Ground,
    /// Greatest distance that counts as there (authors: 0.6 in their mazes).
    pub tolerance: f32,
    /// The task's goal, where it is a place.
    pub task: Option<Region>,
    /// γ of the policies' values, which are those of −1 a step until the place is reached.
    pub discount: f32,
}

impl Aim<Vec<f32>> for Places {
    type Goal = Region;

    const TELLS: bool = true;

    fn at(&self, s: &Vec<f32>) -> Option<Region> {
        Some(self.ground.ball(self.ground.place(s), self.tolerance))
    }

    fn task(&self) -> Option<Region> {
        self.task.clone()
    }

    fn distance(&self, s: &Vec<f32>, goal: &Region) -> f32 {
        goal.distance(s)
    }

    /// n steps cost V = −(1 − γⁿ⁻¹)/(1 − γ), the last one being free: γⁿ⁻¹ = 1 + (1 − γ) V.
    fn probability(&self, value: f32) -> f32 {
        (1.0 + (1.0 - self.discount) * value).clamp(0.0, 1.0)
    }
}

/// One of these at random; none of none.
pub(super) fn any<'a, T>(of: &'a [T], rng: &mut Rng) -> Option<&'a T> {
    use rand::RngExt;
    (!of.is_empty()).then(|| &of[rng.random_range(0..of.len())])
}
