//! From rows of what is seen to features: layers of rectified units, and for pictures an embedding of patches or a
//! convolution before them.
//!
//! A patch embedding is a product of every patch with one matrix; a merge joins two by two places into one and is a product
//! too. So all of it is large matrix products, where a convolution first has to gather its windows: the default is several
//! times as fast as Nature's convolution (`docs/results/learners/speed.md`).

use burn::module::Module;
use burn::nn::Linear;
use burn::tensor::activation::relu;
use burn::tensor::{Device, Tensor};
use inroads_envs::{Rng, Space};
use serde::{Deserialize, Serialize};

use super::convolution::{NATURE, least};
use super::{init, mlp::rectified};
use crate::encode::{PatchError, Patches, Shape};

/// How pictures are looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Vision {
    /// Patches side by side, each embedded alone, and two by two of their places merged again and again.
    #[default]
    Patches,
    /// The convolution of DQN (Mnih 2015): 32 kernels of 8 × 8 with stride 4, 64 of 4 × 4 with stride 2, 64 of 3 × 3; the
    /// paper has `hidden` 512 on top. Pictures have at least 36 by 36 pixels.
    Nature,
}

/// Settings of what makes features of what is seen.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TorsoConfig {
    /// How pictures are looked at; nothing for vectors.
    pub vision: Vision,
    /// Features a patch of a picture, with `vision = "patches"`.
    pub embedding: usize,
    /// Features a place after each merge of two by two places, as long as there is more than one; with
    /// `vision = "patches"`.
    pub merges: Vec<usize>,
    /// Widths of the layers on top, at least one.
    pub hidden: Vec<usize>,
}

impl Default for TorsoConfig {
    fn default() -> Self {
        Self { vision: Vision::Patches, embedding: 32, merges: vec![64, 64], hidden: vec![128] }
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

    /// What writes the pictures of a space as this torso reads them.
    ///
    /// # Errors
    /// [`PatchError`] when they are no pictures, or too small: it names both sizes.
    pub fn encoder(&self, space: &Space) -> Result<Patches, PatchError> {
        if self.vision == Vision::Patches {
            return Patches::new(space, 0);
        }
        let [side, stride, least] = [NATURE[0].side, NATURE[0].stride, least(&NATURE)].map(|n| n as u32);
        match *space {
            Space::Frame { width, height, .. } if width.min(height) < least => {
                Err(PatchError::Small { width, height, least })
            }
            _ => Patches::overlapping(space, side, stride),
        }
    }

    /// How many features there are.
    pub(crate) fn features(&self) -> usize {
        *self.hidden.last().expect("a torso has a hidden layer")
    }
}

/// Rows in, rectified features out.
#[derive(Module, Debug, Default)]
pub(crate) struct Torso {
    /// What makes features of a patch, and then of several places together; empty for vectors.
    places: Vec<Linear>,
    hidden: Vec<Linear>,
    /// Rows and columns of patches, and numbers a patch.
    grid: [usize; 3],
    /// Whether places are joined in [`NATURE`]'s windows, and not two by two.
    nature: bool,
}

impl Torso {
    /// # Panics
    /// When there is no hidden layer, or one of width 0: see [`TorsoConfig::check`]. When a convolution does not fit into the
    /// grid: see [`TorsoConfig::encoder`].
    pub(crate) fn new(shape: Shape, config: &TorsoConfig, device: &Device, rng: &mut Rng) -> Self {
        let (mut layers, nature) = (Vec::new(), config.vision == Vision::Nature);
        let (mut width, grid) = match shape {
            Shape::Row(width) => (width, [0; 3]),
            Shape::Grid { down, across, width } => {
                let (mut places, mut features) = ([down, across], width);
                let mut layer = |joined: usize, next: usize| {
                    layers.push(init::by_inputs(joined * features, next, device, rng));
                    features = next;
                };
                if nature {
                    layer(1, NATURE[0].features);
                    for kernel in &NATURE[1..] {
                        places = places.map(|n| kernel.windows(n));
                        layer(kernel.side * kernel.side, kernel.features);
                    }
                } else {
                    layer(1, config.embedding);
                    for &merged in config.merges.iter() {
                        if places == [1, 1] {
                            break;
                        }
                        places = places.map(|n| n.div_ceil(2));
                        layer(4, merged);
                    }
                }
                (places[0] * places[1] * features, [down, across, width])
            }
        };
        let hidden = init::hidden(&mut width, &config.hidden, device, rng);
        Self { places: layers, hidden, grid, nature }
    }

    /// Features, a row for each row.
    pub(crate) fn forward(&self, rows: Tensor<2>) -> Tensor<2> {
        rectified(&self.hidden, self.embedded(rows))
    }

    /// What the layers on top read.
    fn embedded(&self, rows: Tensor<2>) -> Tensor<2> {
        let Some((first, rest)) = self.places.split_first() else { return rows };
        let n = rows.dims()[0];
        let [down, across, width] = self.grid;
        let mut places = [down, across];
        let mut x = relu(first.forward(rows.reshape([n * down * across, width])));
        for (i, layer) in rest.iter().enumerate() {
            let joined = if self.nature {
                NATURE[i + 1].gathered(x, n, &mut places)
            } else {
                merged(x, n, &mut places)
            };
            x = relu(layer.forward(joined));
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
mod tests;
