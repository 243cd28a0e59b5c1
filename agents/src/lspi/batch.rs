//! A batch made ready: what least squares has to do with it once, whatever is rewarded.

use super::{LspiError, Rows, dense, random::RandomPolicy};

/// Numbers that a processor handles at once, and of which rows are multiples.
pub(super) const LANES: usize = 8;

/// Transitions with their features, sorted by action; equal ones are one with a count.
///
/// LSTDQ's features of state and action are the state's features in the action's block, zero elsewhere. So the Gram matrix
/// `Σ φ(s,a) φ(s,a)ᵀ + λI` has one block an action, and multiplying each block's rows by the inverse of its Cholesky factor
/// makes it the identity: that is done here, in double precision, for all events and both signs.
#[derive(Clone, Debug)]
pub struct Batch {
    pub(super) features: usize,
    /// `features` and zeros up to a multiple of [`LANES`].
    pub(super) stride: usize,
    /// White features before each transition.
    pub(super) before: Vec<f32>,
    /// Plain features after it.
    pub(super) after: Vec<f32>,
    /// How many of the caller's rows each is.
    pub(super) counts: Vec<f32>,
    /// 1 where the episode went on, 0 where it terminated.
    pub(super) goes_on: Vec<f32>,
    /// Where the rows of each action begin, and where the last ends.
    pub(super) starts: Vec<usize>,
    /// Where the caller's rows are here.
    pub(super) places: Vec<usize>,
    pub(super) whitenings: Vec<dense::Whitening>,
    pub(super) random: RandomPolicy,
}

impl Batch {
    /// Makes features of transitions ready for that many actions. The ridge `λ` is `ridge` times the mean of the Gram
    /// matrix' diagonal.
    ///
    /// # Errors
    /// [`LspiError`] when there is nothing to learn from, or the features are not numbers.
    pub fn new(rows: &Rows, choices: usize, ridge: f64) -> Result<Self, LspiError> {
        if rows.is_empty() || rows.width() == 0 {
            return Err(LspiError::Nothing);
        }
        if let Some(action) = (0..rows.len()).map(|at| rows.action(at)).find(|&action| action >= choices) {
            return Err(LspiError::Action { action, choices });
        }
        let features = rows.width();
        let (distinct, places) = rows.distinct();
        let starts =
            (0..=choices).map(|action| distinct.partition_point(|&at| rows.action(at) < action)).collect();
        let mut counts = vec![0.0; distinct.len()];
        places.iter().for_each(|&place| counts[place] += 1.0);
        let mut batch = Self {
            features,
            stride: features.next_multiple_of(LANES),
            before: Vec::new(),
            after: Vec::new(),
            counts,
            goes_on: distinct.iter().map(|&at| f32::from(u8::from(!rows.terminal(at)))).collect(),
            starts,
            places,
            whitenings: Vec::with_capacity(choices),
            random: RandomPolicy::default(),
        };
        batch.after = batch.padded(distinct.iter().map(|&at| rows.after(at)));
        batch.whiten(rows, &distinct, ridge)?;
        batch.random = RandomPolicy::new(&batch);
        Ok(batch)
    }

    /// How many transitions there are.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// How many of them differ.
    pub fn distinct(&self) -> usize {
        self.counts.len()
    }

    /// Whether there are none, which cannot be.
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// How many actions there are.
    pub fn choices(&self) -> usize {
        self.whitenings.len()
    }

    /// The action of a distinct transition.
    pub(super) fn action(&self, place: usize) -> usize {
        self.starts.partition_point(|&start| start <= place) - 1
    }

    fn padded<'a>(&self, rows: impl Iterator<Item = &'a [f32]>) -> Vec<f32> {
        let zeros = self.stride - self.features;
        rows.flat_map(|row| row.iter().copied().chain(std::iter::repeat_n(0.0, zeros))).collect()
    }

    fn whiten(&mut self, rows: &Rows, distinct: &[usize], ridge: f64) -> Result<(), LspiError> {
        let size = self.features;
        let exact = |at: usize, out: &mut [f64]| {
            out.iter_mut().zip(rows.before(at)).for_each(|(wide, &x)| *wide = f64::from(x));
        };
        let choices = self.starts.len() - 1;
        let mut grams = vec![vec![0.0; size * size]; choices];
        let (mut row, mut white) = (vec![0.0; size], vec![0.0; size]);
        for (&at, &count) in distinct.iter().zip(&self.counts) {
            exact(at, &mut row);
            dense::add_square(&mut grams[rows.action(at)], &row, f64::from(count));
        }
        let diagonal: f64 = grams.iter().flat_map(|gram| gram.iter().step_by(size + 1)).sum();
        let ridge = ridge * diagonal / (size * choices) as f64;
        for mut gram in grams {
            gram.iter_mut().step_by(size + 1).for_each(|x| *x += ridge);
            self.whitenings.push(dense::Whitening::new(gram, size).ok_or(LspiError::Singular)?);
        }
        self.before.reserve(distinct.len() * self.stride);
        for &at in distinct {
            exact(at, &mut row);
            self.whitenings[rows.action(at)].whiten(&row, &mut white);
            self.before.extend(white.iter().map(|&x| x as f32));
            self.before.resize(self.before.len() + self.stride - size, 0.0);
        }
        Ok(())
    }
}
