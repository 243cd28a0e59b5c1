//! Many linear systems of LSTDQ, solved side by side.
//!
//! In white features (see [`Batch`]), LSTDQ for a policy `π` is `θ = b + γ Σ (1−d) ψ(s,a) φ(s',π(s'))ᵀ θ'`, where `ψ` are
//! white features, `θ'` the same weights for plain ones and `b = Σ ψ r`. A product with that matrix is a pass over the batch
//! and does not need the matrix; it is never built. One pass serves many systems, so that rows come from memory once.

use super::{Batch, batch::LANES, krylov::Gmres};

/// Rows handled before the next system's turn: few enough to stay in the fastest cache, features before and after.
const TILE: usize = 32;

/// What makes the system of an event and a sign differ from others.
#[derive(Clone, Copy, Debug)]
pub(super) struct Case<'a> {
    /// The action taken after each transition.
    pub(super) policy: &'a [u16],
    /// What the value after each transition counts: its count times γ, without those that bring about the event or the end.
    pub(super) discount: &'a [f32],
    /// What is earned, in white features: `Σ ψ r`.
    pub(super) earned: &'a [f64],
    /// Its sign.
    pub(super) sign: f64,
}

/// Solves LSTDQ for each case, from `guesses` on: white weights, [`Batch::stride`] an action. A case is left as it is when its
/// residual is `tolerance` of what is earned, or after `limit` products.
pub(super) fn solve(
    batch: &Batch,
    cases: &[Case<'_>],
    guesses: &[Vec<f64>],
    tolerance: f64,
    limit: usize,
) -> Vec<Vec<f64>> {
    let mut passes: Vec<Pass<'_>> = cases.iter().map(|&case| Pass::new(batch, case)).collect();
    passes.iter_mut().zip(guesses).for_each(|(pass, guess)| pass.aim(plain(batch, guess)));
    run(batch, &mut passes.iter_mut().collect::<Vec<_>>());
    let begin = |(pass, guess): (&Pass<'_>, &Vec<f64>)| {
        let earned = norm(pass.case.earned);
        // What is left to explain: b − (1 − T) θ₀.
        let right = pass.backed_up().zip(guess).map(|(backed_up, guess)| backed_up - guess).collect();
        Gmres::new(right, tolerance * earned)
    };
    let mut systems: Vec<Gmres> = passes.iter().zip(guesses).map(begin).collect();
    loop {
        let open = |system: &Gmres| !system.solved() && system.products() < limit;
        let mut active: Vec<_> = passes.iter_mut().zip(&mut systems).filter(|(_, s)| open(s)).collect();
        if active.is_empty() {
            break;
        }
        active.iter_mut().for_each(|(pass, system)| pass.aim(plain(batch, system.direction())));
        run(batch, &mut active.iter_mut().map(|(pass, _)| &mut **pass).collect::<Vec<_>>());
        for (pass, system) in active {
            let image = system.direction().iter().zip(&pass.image).map(|(x, image)| x - image).collect();
            system.absorb(image);
        }
    }
    let found = systems.iter().zip(guesses);
    found.map(|(system, guess)| system.solution().iter().zip(guess).map(|(x, g)| x + g).collect()).collect()
}

/// One backup: the white weights of least squares for values after each transition that some plain weights, a stride, give.
pub(super) fn back_up(batch: &Batch, cases: &[Case<'_>], weights: Vec<Vec<f32>>) -> Vec<Vec<f64>> {
    let mut passes: Vec<Pass<'_>> = cases.iter().map(|&case| Pass::new(batch, case)).collect();
    passes.iter_mut().zip(weights).for_each(|(pass, weights)| pass.aim(weights));
    run(batch, &mut passes.iter_mut().collect::<Vec<_>>());
    passes.iter().map(|pass| pass.backed_up().collect()).collect()
}

/// White weights as weights of plain features.
pub(super) fn plain(batch: &Batch, white: &[f64]) -> Vec<f32> {
    let mut exact = vec![0.0; batch.stride];
    let mut weights = Vec::with_capacity(white.len());
    for (whitening, block) in batch.whitenings.iter().zip(white.chunks_exact(batch.stride)) {
        whitening.unwhiten(block, &mut exact);
        weights.extend(exact.iter().map(|&x| x as f32));
    }
    weights
}

/// Writes the values of all actions after a transition, by weights of plain features.
pub(super) fn values_after(batch: &Batch, weights: &[f32], place: usize, out: &mut [f32]) {
    let row = &batch.after[place * batch.stride..][..batch.stride];
    let blocks = weights.chunks_exact(batch.stride);
    out.iter_mut().zip(blocks).for_each(|(slot, block)| *slot = dot(row, block));
}

/// A product on its way.
struct Pass<'a> {
    case: Case<'a>,
    weights: Vec<f32>,
    image: Vec<f64>,
}

impl<'a> Pass<'a> {
    fn new(batch: &Batch, case: Case<'a>) -> Self {
        Self { case, weights: Vec::new(), image: vec![0.0; batch.stride * batch.choices()] }
    }

    /// The plain weights that are multiplied next.
    fn aim(&mut self, weights: Vec<f32>) {
        self.weights = weights;
        self.image.fill(0.0);
    }

    /// What is earned, and the image.
    fn backed_up(&self) -> impl Iterator<Item = f64> {
        self.case.earned.iter().zip(&self.image).map(|(earned, image)| self.case.sign * earned + image)
    }

    /// Adds what some rows of one action contribute: `Σ ψ(s,a) · discount · φ(s',π(s'))ᵀ θ`.
    fn add(&mut self, batch: &Batch, action: usize, rows: std::ops::Range<usize>, sum: &mut [f32]) {
        let stride = batch.stride;
        let mut backed = [0.0; TILE];
        let after = batch.after[rows.start * stride..rows.end * stride].chunks_exact(stride);
        let known = self.case.policy[rows.clone()].iter().zip(&self.case.discount[rows.clone()]);
        for ((slot, row), (&next, &discount)) in backed.iter_mut().zip(after).zip(known) {
            let weights = &self.weights[usize::from(next) * stride..][..stride];
            *slot = if discount == 0.0 { 0.0 } else { discount * dot(row, weights) };
        }
        let before = &batch.before[rows.start * stride..rows.end * stride];
        combine(before, &backed[..rows.len()], sum);
        let image = &mut self.image[action * stride..][..stride];
        image.iter_mut().zip(&*sum).for_each(|(wide, &x)| *wide += f64::from(x));
    }
}

/// Computes the images of what was aimed at.
fn run(batch: &Batch, passes: &mut [&mut Pass<'_>]) {
    let mut sum = vec![0.0; batch.stride];
    for (action, ends) in batch.starts.windows(2).enumerate() {
        for start in (ends[0]..ends[1]).step_by(TILE) {
            let rows = start..(start + TILE).min(ends[1]);
            passes.iter_mut().for_each(|pass| pass.add(batch, action, rows.clone(), &mut sum));
        }
    }
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The product of two rows of a multiple of [`LANES`].
fn dot(a: &[f32], b: &[f32]) -> f32 {
    let mut sums = [0.0; LANES];
    for (a, b) in a.chunks_exact(LANES).zip(b.chunks_exact(LANES)) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    sums.iter().sum()
}

/// `sum = Σ weight · row`, four rows at a time so that the sum is read and written less often.
fn combine(rows: &[f32], weights: &[f32], sum: &mut [f32]) {
    sum.fill(0.0);
    let stride = sum.len();
    let mut fours = weights.chunks_exact(4);
    let mut blocks = rows.chunks_exact(4 * stride);
    for (w, block) in fours.by_ref().zip(blocks.by_ref()) {
        let (ab, cd) = block.split_at(2 * stride);
        let ((a, b), (c, d)) = (ab.split_at(stride), cd.split_at(stride));
        for ((((slot, a), b), c), d) in sum.iter_mut().zip(a).zip(b).zip(c).zip(d) {
            *slot += (w[0] * a + w[1] * b) + (w[2] * c + w[3] * d);
        }
    }
    for (&weight, row) in fours.remainder().iter().zip(blocks.remainder().chunks_exact(stride)) {
        sum.iter_mut().zip(row).for_each(|(slot, x)| *slot += weight * x);
    }
}
