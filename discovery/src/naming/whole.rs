//! "Be in this very state" (equation 7.9, for symbols).

use super::Name;
use crate::Features;

/// A goal of all features of a state.
#[derive(Clone, Copy, Debug)]
pub struct Whole {
    /// Greatest Euclidean distance from the state that still attains it.
    pub tolerance: f32,
}

impl Name<Vec<f32>, Features> for Whole {
    fn name(&self, novel: &Vec<f32>, _: &Vec<f32>, _: &dyn Fn(&Vec<f32>) -> f32) -> Option<Features> {
        Some(Features::of(novel, 0..novel.len(), self.tolerance))
    }

    fn exactly(&self, s: &Vec<f32>) -> Option<Features> {
        Some(Features::of(s, 0..s.len(), self.tolerance))
    }
}
