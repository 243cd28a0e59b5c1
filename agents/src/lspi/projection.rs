//! Features for least squares: random projections of observations (thesis section 8.3.1.1).

use inroads_envs::Rng;
use rand_distr::{Distribution, StandardNormal};

use super::{
    Rows,
    dense::{self, Whitening},
};

/// A direction in which the features vary by less than this share of their variance is none: what is left of it is rounding.
const NOTHING: f64 = 1e-10;

/// A Gaussian random projection of standardised observations, with a constant, made white: over the rows that it was drawn
/// for, features have mean square 1 and are uncorrelated.
///
/// The projection makes the cost independent of the observation's size. White features make a ridge mean the same for every
/// function of the observation: without them it grows with how the projection happens to lie, and a ridge of 1e-3 gave
/// Taxi's destination, which nobody controls, a gap of 0.1 to 0.3.
///
/// Values of `|φ|` features are as good as values of the observations themselves as long as the features keep apart what
/// the observations keep apart: `|φ|` must be at least the rank of the observations with a constant. With fewer, different
/// observations share features, goals leak into states where they cannot be had, and what nobody controls seems
/// controllable (a timer's gap of .8 with 16 to 32 features for 39). [`narrow`](Self::narrow) tells.
#[derive(Clone, Debug)]
pub struct Projection {
    /// The dimensions that are not constant, and for each of them a weight a feature.
    kept: Vec<usize>,
    weights: Vec<f64>,
    /// What the features of a row of zeros are.
    offset: Vec<f64>,
    narrow: bool,
}

impl Projection {
    /// Draws a projection to at most `features` numbers, the first of them the constant 1, for observations like those of
    /// `rows`: to fewer if their rank is smaller, since more would depend on these.
    ///
    /// Dimensions are standardised by mean and deviation over all rows, before and after; constant ones do not count.
    pub fn fit(rows: &Rows, features: usize, rng: &mut Rng) -> Self {
        // One more than asked for tells whether more would be independent.
        let drawn = Self::draw(rows, features + 1, rng);
        let size = drawn.offset.len();
        let mut gram = vec![0.0; size * size];
        let mut row = vec![0.0; size];
        for at in 0..rows.len() {
            for side in [rows.before(at), rows.after(at)] {
                drawn.write(side, &mut row);
                dense::add_square(&mut gram, &row, 0.5 / rows.len() as f64);
            }
        }
        let mut chosen = dense::independent(gram.clone(), size, NOTHING);
        let narrow = chosen.len() > features;
        chosen.truncate(features);
        chosen.sort_unstable();
        drawn.whitened(&gram, &chosen, narrow)
    }

    /// How many features there are: the rank of the observations with a constant, or as many as were asked for.
    pub fn features(&self) -> usize {
        self.offset.len()
    }

    /// Whether the rank of the observations with a constant is greater than the number of features: values will leak.
    pub fn narrow(&self) -> bool {
        self.narrow
    }

    /// The features of every observation.
    pub fn project(&self, rows: &Rows) -> Rows {
        let mut exact = vec![0.0; self.features()];
        rows.map(self.features(), |row, out| {
            self.write(row, &mut exact);
            out.iter_mut().zip(&exact).for_each(|(slot, &x)| *slot = x as f32);
        })
    }

    /// The constant and `features − 1` Gaussian directions.
    fn draw(rows: &Rows, features: usize, rng: &mut Rng) -> Self {
        let scales = scales(rows);
        let kept: Vec<usize> = (0..rows.width()).filter(|&at| scales[at].1 > 0.0).collect();
        let mut weights = Vec::with_capacity(kept.len() * features);
        let mut offset = vec![0.0; features];
        offset[0] = 1.0;
        for &at in &kept {
            let (mean, deviation) = scales[at];
            weights.push(0.0);
            for slot in &mut offset[1..] {
                let gauss: f64 = StandardNormal.sample(rng);
                *slot -= gauss * mean / deviation;
                weights.push(gauss / deviation);
            }
        }
        Self { kept, weights, offset, narrow: false }
    }

    /// The chosen features, made white by what is known of their Gram matrix.
    fn whitened(self, gram: &[f64], chosen: &[usize], narrow: bool) -> Self {
        let (size, drawn) = (chosen.len(), self.offset.len());
        let part =
            chosen.iter().flat_map(|&i| chosen.iter().map(move |&j| gram[i.max(j) * drawn + i.min(j)]));
        let whitening = Whitening::new(part.collect(), size).expect("the chosen features are independent");
        let mut white = vec![0.0; size];
        let mut whiten = |plain: &[f64]| {
            let picked: Vec<f64> = chosen.iter().map(|&i| plain[i]).collect();
            whitening.whiten(&picked, &mut white);
            white.clone()
        };
        let weights = self.weights.chunks_exact(drawn).flat_map(&mut whiten).collect();
        let offset = whiten(&self.offset);
        Self { kept: self.kept, weights, offset, narrow }
    }

    fn write(&self, row: &[f32], out: &mut [f64]) {
        out.copy_from_slice(&self.offset);
        for (&at, weights) in self.kept.iter().zip(self.weights.chunks_exact(self.features())) {
            // Rows that are one-hot, and pictures with much black, are mostly zeros.
            if row[at] != 0.0 {
                let x = f64::from(row[at]);
                out.iter_mut().zip(weights).for_each(|(slot, weight)| *slot += weight * x);
            }
        }
    }
}

/// Mean and standard deviation of each dimension over all rows; a deviation of 0 where nothing varies.
fn scales(rows: &Rows) -> Vec<(f64, f64)> {
    let count = (2 * rows.len()).max(1) as f64;
    let all = || (0..rows.len()).flat_map(|at| [rows.before(at), rows.after(at)]);
    let mut sums = vec![(0.0, 0.0); rows.width()];
    for row in all() {
        sums.iter_mut().zip(row).for_each(|(sum, &x)| sum.0 += f64::from(x));
    }
    sums.iter_mut().for_each(|sum| sum.0 /= count);
    for row in all() {
        sums.iter_mut()
            .zip(row)
            .for_each(|(sum, &x)| sum.1 += (f64::from(x) - sum.0) * (f64::from(x) - sum.0));
    }
    sums.iter_mut().for_each(|sum| sum.1 = (sum.1 / count).sqrt());
    sums
}
