//! Expansion towards random places (6.1.3): what makes a graph grow into the largest region that it does not cover yet
//! (Lindemann and LaValle 2004).

use inroads_envs::Rng;
use rand::RngExt;

/// Draws places evenly from a box, walls included: the bounds of where one can be are all that is told of the domain.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sampled {
    bounds: Vec<[f32; 2]>,
    /// Draws before a search for an acceptable place is given up.
    draws: u32,
}

impl Sampled {
    /// A sampler of places with these bounds, one pair a dimension.
    pub(super) fn new(bounds: Vec<[f32; 2]>, draws: u32) -> Self {
        Self { bounds, draws }
    }

    /// s_rand: any place.
    pub(super) fn place(&self, rng: &mut Rng) -> Vec<f32> {
        self.bounds
            .iter()
            .map(|&[low, high]| if high > low { rng.random_range(low..high) } else { low })
            .collect()
    }

    /// The first place drawn that `accepted` is said of.
    pub(super) fn acceptable(&self, accepted: impl Fn(&[f32]) -> bool, rng: &mut Rng) -> Option<Vec<f32>> {
        (0..self.draws).map(|_| self.place(rng)).find(|place| accepted(place))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use inroads_envs::Seed;

    #[test]
    fn places_lie_in_the_box_and_are_refused_until_one_is_accepted() {
        let sampler = Sampled::new(vec![[-2.0, 10.0], [3.0, 3.0]], 50);
        let mut rng = Seed(1).stream("test", 0);
        let drawn: Vec<_> = (0..600).map(|_| sampler.place(&mut rng)).collect();
        assert!(drawn.iter().all(|p| (-2.0..10.0).contains(&p[0]) && p[1] == 3.0));
        let left = drawn.iter().filter(|p| p[0] < 1.0).count();
        assert!((110..190).contains(&left), "a quarter of 600: {left}");
        assert!(sampler.acceptable(|p| p[0] > 9.0, &mut rng).is_some_and(|p| p[0] > 9.0));
        assert_eq!(sampler.acceptable(|_| false, &mut rng), None);
    }
}
