//! Goal regions: balls around places (ε_g of thesis 6.1.1).

use inroads_envs::Spec;
use serde::{Deserialize, Serialize};

use super::Goal;
use crate::{
    Encode, Key,
    tabular::{key, thousandths},
};

/// Which dimensions of an observation say where one is, and what values they can have.
#[derive(Clone, Debug, PartialEq)]
pub struct Ground {
    dims: Vec<u32>,
    bounds: Vec<[f32; 2]>,
}

impl Ground {
    /// The places of a domain; none where one of their dimensions has no bounds, so that none can be drawn.
    pub fn of(spec: &Spec) -> Option<Self> {
        Self::over(spec, &spec.place)
    }

    /// The same for the dimensions of these indices.
    pub fn over(spec: &Spec, dims: &[usize]) -> Option<Self> {
        let dimensions = spec.observation.dimensions();
        let bounds: Vec<_> = dims.iter().map(|&i| [dimensions[i].low, dimensions[i].high]).collect();
        let known = !bounds.is_empty() && bounds.iter().flatten().all(|bound| bound.is_finite());
        known.then(|| Self { dims: dims.iter().map(|&i| i as u32).collect(), bounds })
    }

    /// Least and greatest value of each dimension.
    pub fn bounds(&self) -> &[[f32; 2]] {
        &self.bounds
    }

    /// Where an observation is.
    pub fn place(&self, s: &[f32]) -> Vec<f32> {
        self.dims.iter().map(|&i| s[i as usize]).collect()
    }

    /// The same observation somewhere else.
    pub fn moved(&self, s: &[f32], place: &[f32]) -> Vec<f32> {
        let mut moved = s.to_vec();
        self.dims.iter().zip(place).for_each(|(&i, x)| moved[i as usize] = *x);
        moved
    }

    /// The ball about a place.
    pub fn ball(&self, at: Vec<f32>, tolerance: f32) -> Region {
        Region { dims: self.dims.clone(), bounds: self.bounds.clone(), at, tolerance }
    }
}

/// A ball around a place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Region {
    dims: Vec<u32>,
    bounds: Vec<[f32; 2]>,
    at: Vec<f32>,
    tolerance: f32,
}

impl Region {
    /// Its middle.
    pub fn at(&self) -> &[f32] {
        &self.at
    }

    /// The dimensions of an observation that it speaks of, and its middle's values of them.
    pub fn kept(&self) -> impl Iterator<Item = (u32, f32)> {
        self.dims.iter().copied().zip(self.at.iter().copied())
    }

    /// The same as a task's goal is given.
    pub fn goal(&self) -> inroads_envs::Goal {
        let dims = self.dims.iter().map(|&i| i as usize).collect();
        inroads_envs::Goal { dims, at: self.at.clone(), tolerance: self.tolerance }
    }

    /// Its radius.
    pub fn tolerance(&self) -> f32 {
        self.tolerance
    }

    /// Euclidean distance of an observation from its middle.
    pub fn distance(&self, s: &[f32]) -> f32 {
        self.kept().map(|(i, at)| (s[i as usize] - at).powi(2)).sum::<f32>().sqrt()
    }
}

impl Goal<Vec<f32>> for Region {
    fn reached(&self, s: &Vec<f32>) -> bool {
        self.distance(s) <= self.tolerance
    }
}

impl Encode for Region {
    fn width(&self) -> usize {
        self.at.len()
    }

    /// Its middle, scaled by the bounds to [−1, 1] as observations are. All regions of an agent have one radius.
    fn write(&self, out: &mut [f32]) {
        for ((slot, at), [low, high]) in out.iter_mut().zip(&self.at).zip(&self.bounds) {
            *slot = if high > low { (at - f32::midpoint(*low, *high)) * 2.0 / (high - low) } else { 0.0 };
        }
    }
}

impl Key for Region {
    /// The middle to the nearest thousandth.
    fn key(&self) -> u128 {
        key(self.at.iter().map(|x| thousandths(*x)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_asks_for_the_place_only_and_is_read_in_the_units_of_the_bounds() {
        let ground = Ground { dims: vec![0, 2], bounds: vec![[-2.0, 10.0], [0.0, 4.0]] };
        let ball = ground.ball(vec![1.0, 3.0], 0.6);
        assert!(ball.reached(&vec![1.3, -80.0, 3.4]) && !ball.reached(&vec![1.6, 0.0, 3.5]));
        assert_eq!(ground.place(&[5.0, 6.0, 7.0]), [5.0, 7.0]);
        let mut row = [9.0; 2];
        ball.write(&mut row);
        assert_eq!(row, [-0.5, 0.5]);
        assert_ne!(ball.key(), ground.ball(vec![1.0, 3.002], 0.6).key());
    }
}
