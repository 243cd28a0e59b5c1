//! From rows of what is seen to features: layers of rectified units, and for pictures an embedding of patches before them.
//!
//! A patch embedding is a product of every patch with one matrix; a merge joins two by two places into one and is a product
//! too. So all of it is large matrix products, where a convolution would first have to gather its windows: at 84 × 84
//! and a batch of 32 it trains in an eighth of the time of Nature's convolution (`docs/results/learners.md`).

use burn::module::Module;
use burn::nn::Linear;
use burn::tensor::activation::relu;
use burn::tensor::{Device, Tensor};
use inroads_envs::Rng;
use serde::{Deserialize, Serialize};

use super::{init, mlp::rectified};
use crate::encode::Shape;

/// Settings of what makes features of what is seen.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TorsoConfig {
    /// Features a patch of a picture; nothing for vectors.
    pub embedding: usize,
    /// Features a place after each merge of two by two places, as long as there is more than one.
    pub merges: Vec<usize>,
    /// Widths of the layers on top, at least one.
    pub hidden: Vec<usize>,
}

impl Default for TorsoConfig {
    fn default() -> Self {
        Self { embedding: 32, merges: vec![64, 64], hidden: vec![128] }
    }
}

impl TorsoConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        if self.embedding == 0 || self.merges.contains(&0) {
            let merges = &self.merges;
            return Err(format!("embedding is {} and merges are {merges:?}; none may be 0", self.embedding));
        }
        if self.hidden.is_empty() || self.hidden.contains(&0) {
            return Err(format!("hidden is {:?}; name at least one layer, and none of width 0", self.hidden));
        }
        Ok(())
    }

    /// How many features there are.
    pub(crate) fn features(&self) -> usize {
        *self.hidden.last().expect("a torso has a hidden layer")
    }
}

/// Rows in, rectified features out.
#[derive(Module, Debug, Default)]
pub(crate) struct Torso {
    /// Empty for vectors.
    patches: Vec<Linear>,
    hidden: Vec<Linear>,
    /// Rows and columns of patches, and numbers a patch.
    grid: [usize; 3],
}

impl Torso {
    /// # Panics
    /// When there is no hidden layer, or one of width 0: see [`TorsoConfig::check`].
    pub(crate) fn new(shape: Shape, config: &TorsoConfig, device: &Device, rng: &mut Rng) -> Self {
        let mut patches = Vec::new();
        let (mut width, grid) = match shape {
            Shape::Row(width) => (width, [0; 3]),
            Shape::Grid { down, across, width } => {
                let (mut places, mut features) = ([down, across], config.embedding);
                patches.push(init::by_inputs(width, features, device, rng));
                for &merged in config.merges.iter() {
                    if places == [1, 1] {
                        break;
                    }
                    places = places.map(|n| n.div_ceil(2));
                    patches.push(init::by_inputs(4 * features, merged, device, rng));
                    features = merged;
                }
                (places[0] * places[1] * features, [down, across, width])
            }
        };
        let hidden = init::hidden(&mut width, &config.hidden, device, rng);
        Self { patches, hidden, grid }
    }

    /// Features, a row for each row.
    pub(crate) fn forward(&self, rows: Tensor<2>) -> Tensor<2> {
        rectified(&self.hidden, self.embedded(rows))
    }

    /// What the layers on top read.
    fn embedded(&self, rows: Tensor<2>) -> Tensor<2> {
        let Some((first, merges)) = self.patches.split_first() else { return rows };
        let n = rows.dims()[0];
        let [down, across, width] = self.grid;
        let mut places = [down, across];
        let mut x = relu(first.forward(rows.reshape([n * down * across, width])));
        for layer in merges {
            x = relu(layer.forward(merged(x, n, &mut places)));
        }
        let features = x.dims()[1];
        x.reshape([n, places[0] * places[1] * features])
    }
}

/// Rows of two by two places each, of rows of one place each; zeros beyond the border where a side is odd.
fn merged(x: Tensor<2>, n: usize, places: &mut [usize; 2]) -> Tensor<2> {
    let ([down, across], c) = (*places, x.dims()[1]);
    let half = places.map(|side| side.div_ceil(2));
    *places = half;
    let x = x.reshape([n, down, across, c]);
    let x = if down % 2 == 1 { beyond(x, 1) } else { x };
    let x = if across % 2 == 1 { beyond(x, 2) } else { x };
    let [down, across] = half;
    x.reshape([n * down, 2, across, 2 * c]).swap_dims(1, 2).reshape([n * down * across, 4 * c])
}

/// The same with zeros at the end of a dimension.
fn beyond(x: Tensor<4>, dim: usize) -> Tensor<4> {
    let mut shape = x.dims();
    shape[dim] = 1;
    let zeros = Tensor::zeros(shape, &x.device());
    Tensor::cat(vec![x, zeros], dim)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nets::{Backend, floats, rows};
    use inroads_envs::Seed;

    fn torso(shape: Shape, config: &TorsoConfig) -> Torso {
        Torso::new(shape, config, &Backend::of_tests().plain(), &mut Seed(1).stream("weights", 0))
    }

    #[test]
    fn four_neighbours_become_one_place() {
        // 3 × 3 places of one number, 1 to 9.
        let device = Backend::of_tests().plain();
        let x = rows((1..=9).map(|i| i as f32).collect(), 1, &device);
        let mut places = [3, 3];
        let joined = merged(x, 1, &mut places);
        assert_eq!(places, [2, 2]);
        let expected =
            [[1.0, 2.0, 4.0, 5.0], [3.0, 0.0, 6.0, 0.0], [7.0, 8.0, 0.0, 0.0], [9.0, 0.0, 0.0, 0.0]];
        assert_eq!(floats(joined), expected.concat());
    }

    #[test]
    fn rows_do_not_depend_on_their_neighbours_in_the_batch() {
        for shape in [Shape::Row(24), Shape::Grid { down: 3, across: 2, width: 4 }] {
            let torso = torso(shape, &TorsoConfig { hidden: vec![16, 5], ..TorsoConfig::default() });
            let row = |i: usize| (0..24).map(|j| ((i * 24 + j) as f32).sin()).collect::<Vec<_>>();
            let device = Backend::of_tests().plain();
            let all = floats(torso.forward(rows([row(0), row(1), row(2)].concat(), 24, &device)));
            for i in 0..3 {
                let one = floats(torso.forward(rows(row(i), 24, &device)));
                for (a, b) in one.iter().zip(&all[5 * i..]) {
                    assert!((a - b).abs() < 1e-5, "{a} {b}");
                }
            }
            assert!(all.iter().any(|x| *x > 0.0));
        }
    }

    #[test]
    fn settings_that_make_no_network_are_named() {
        assert_eq!(TorsoConfig::default().check(), Ok(()));
        let wrong = |config: TorsoConfig| config.check().unwrap_err();
        assert!(wrong(TorsoConfig { hidden: vec![], ..Default::default() }).contains("hidden"));
        assert!(wrong(TorsoConfig { merges: vec![0], ..Default::default() }).contains("merges"));
    }
}
