//! Convolutions as matrix products: the windows of each layer as rows (im2col).
//!
//! Pictures lie as rows of features, a row a place (NHWC), so a window is some rows side by side, gathered by their numbers,
//! and its gradient goes back by one addition a row. That trains in less than half the time of Burn's `Conv2d`, which gathers
//! number by number (`docs/results/learners/speed.md`).

use burn::tensor::{Int, Tensor, TensorData};

/// A layer's windows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Kernel {
    /// Places along a side.
    pub(crate) side: usize,
    /// Places from one window to the next.
    pub(crate) stride: usize,
    /// Features that each becomes.
    pub(crate) features: usize,
}

/// The convolution of DQN (Mnih 2015, Methods, "Model architecture"): 32 kernels of 8 × 8 with stride 4, 64 of 4 × 4 with
/// stride 2, 64 of 3 × 3 with stride 1.
pub(crate) const NATURE: [Kernel; 3] = [
    Kernel { side: 8, stride: 4, features: 32 },
    Kernel { side: 4, stride: 2, features: 64 },
    Kernel { side: 3, stride: 1, features: 64 },
];

impl Kernel {
    /// Windows along so many places; what is left over at the end is in none.
    ///
    /// # Panics
    /// When there is not one: see [`least`].
    pub(crate) fn windows(self, places: usize) -> usize {
        assert!(places >= self.side, "windows of {} places do not fit into {places}", self.side);
        (places - self.side) / self.stride + 1
    }

    /// A row a window, of rows of one place each, for `n` pictures of `places` rows and columns; then of as many as there
    /// are windows.
    pub(crate) fn gathered(self, x: Tensor<2>, n: usize, places: &mut [usize; 2]) -> Tensor<2> {
        let [down, across] = *places;
        *places = places.map(|places| self.windows(places));
        let (rows, width) = (n * places[0] * places[1], self.side * self.side * x.dims()[1]);
        let mut numbers = Vec::with_capacity(rows * self.side * self.side);
        for picture in 0..n {
            for (top, left) in (0..places[0]).flat_map(|y| (0..places[1]).map(move |x| (y, x))) {
                for line in 0..self.side {
                    let first = (picture * down + self.stride * top + line) * across + self.stride * left;
                    numbers.extend((first..first + self.side).map(|number| number as i64));
                }
            }
        }
        let shape = [numbers.len()];
        let numbers = Tensor::<1, Int>::from_data(TensorData::new(numbers, shape), &x.device());
        x.select(0, numbers).reshape([rows, width])
    }
}

/// Places that a side must have so that each of these layers has a window.
pub(crate) fn least(layers: &[Kernel]) -> usize {
    layers.iter().rev().fold(1, |places, kernel| (places - 1) * kernel.stride + kernel.side)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nets::{Backend, floats, rows};
    use burn::tensor::Device;
    use inroads_envs::Seed;
    use rand::RngExt;

    const SMALL: [Kernel; 2] =
        [Kernel { side: 3, stride: 2, features: 2 }, Kernel { side: 2, stride: 1, features: 3 }];

    fn numbers(n: usize, index: u64) -> Vec<f32> {
        let mut rng = Seed(4).stream("numbers", index);
        (0..n).map(|_| rng.random_range(-1.0..1.0)).collect()
    }

    #[test]
    fn windows_are_rows_of_their_places_picture_by_picture() {
        // Two pictures of 3 × 4 places of one number; what is left over on the right is in no window.
        let device = Backend::of_tests().plain();
        let x = rows((0..24).map(|i| i as f32).collect(), 1, &device);
        let mut places = [3, 4];
        let gathered = Kernel { side: 2, stride: 1, features: 0 }.gathered(x.clone(), 2, &mut places);
        assert_eq!((places, gathered.dims()), ([2, 3], [12, 4]));
        let gathered = floats(gathered);
        assert_eq!(gathered[..8], [0.0, 1.0, 4.0, 5.0, 1.0, 2.0, 5.0, 6.0]);
        assert_eq!(gathered[44..], [18.0, 19.0, 22.0, 23.0]);
        let mut places = [3, 4];
        let gathered = Kernel { side: 3, stride: 2, features: 0 }.gathered(x, 2, &mut places);
        assert_eq!((places, gathered.dims()), ([1, 1], [2, 9]));
        assert_eq!(floats(gathered)[..4], [0.0, 1.0, 2.0, 4.0]);
    }

    #[test]
    fn the_least_picture_has_one_window_in_the_last_layer() {
        assert_eq!(least(&NATURE), 36);
        let last = |side| NATURE.iter().fold(side, |places, kernel| kernel.windows(places));
        assert_eq!([last(36), last(64), last(84)], [1, 4, 7]);
    }

    /// Two layers over two pictures of 7 × 6 places with two numbers each, and a weighted sum of what comes out: linear in
    /// every single number.
    fn sum(x: &Tensor<2>, first: &Tensor<2>, second: &Tensor<2>, device: &Device) -> Tensor<1> {
        let mut places = [7, 6];
        let hidden = SMALL[0].gathered(x.clone(), 2, &mut places).matmul(first.clone());
        let out = SMALL[1].gathered(hidden, 2, &mut places).matmul(second.clone());
        assert_eq!((places, out.dims()), ([2, 1], [4, 3]));
        let weights = rows(numbers(12, 3), 3, device);
        (out * if x.is_require_grad() { weights.autodiff() } else { weights }).sum()
    }

    #[test]
    fn gradients_are_those_of_finite_differences() {
        let device = Backend::of_tests().plain();
        let values = [numbers(7 * 6 * 2 * 2, 0), numbers(18 * 2, 1), numbers(8 * 3, 2)];
        let widths = [2, 2, 3];
        let tensors = |values: &[Vec<f32>; 3]| [0, 1, 2].map(|i| rows(values[i].clone(), widths[i], &device));
        let tracked = tensors(&values).map(|tensor| tensor.autodiff().require_grad());
        let grads = sum(&tracked[0], &tracked[1], &tracked[2], &device).backward();
        for (i, tensor) in tracked.iter().enumerate() {
            let grad = floats(tensor.grad(&grads).unwrap());
            for (j, grad) in grad.iter().enumerate() {
                let at = |moved: f32| {
                    let mut values = values.clone();
                    values[i][j] += moved;
                    let [x, first, second] = tensors(&values);
                    floats(sum(&x, &first, &second, &device))[0]
                };
                // Linear in each number, so the step need not be small.
                let difference = at(0.5) - at(-0.5);
                assert!((grad - difference).abs() < 1e-4, "number {j} of {i}: {grad} {difference}");
            }
            assert!(grad.iter().any(|g| g.abs() > 0.1));
        }
    }
}
