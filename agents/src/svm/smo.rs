//! Sequential minimal optimisation (Platt 1998): the quadratic programme behind every machine here.
//!
//! Minimise ½βᵀKβ − tᵀβ with lᵢ ≤ βᵢ ≤ uᵢ, keeping Σβ where it starts. The coefficients carry the sign of
//! their class (β = yα in the usual notation), so labels, and with them the constraint yᵀα, disappear into
//! bounds: a positive sample has [0, C], a negative one [−C, 0].
//!
//! Each step moves weight from one sample to another. With the gradient g = Kβ − t, weight should go from high g
//! to low g; at the optimum a threshold ρ separates them: no sample that may still rise has g < ρ, none that may
//! still fall has g > ρ, and g − ρ + t is the machine's value on its own samples. The pair is chosen by
//! second-order information (Fan, Chen and Lin 2005): the receiver by lowest g, the giver by the largest decrease
//! of the objective.

use super::kernel::Gram;

/// Steps at most, a sample and in all, so that even a hopeless tolerance ends. Ordinary fits need a few steps a
/// sample.
const STEPS_PER_SAMPLE: usize = 1_000;
const STEPS_AT_LEAST: usize = 100_000;

/// Where one coefficient may lie.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub(super) low: f64,
    pub(super) high: f64,
}

/// The coefficients and the threshold.
#[derive(Debug)]
pub(super) struct Solution {
    pub(super) coefficients: Vec<f64>,
    pub(super) rho: f64,
}

/// A solution on its way.
struct State<'a> {
    gram: &'a Gram<'a>,
    bounds: &'a [Bounds],
    beta: Vec<f64>,
    gradient: Vec<f64>,
}

/// Solves from a feasible start, until no pair of gradients disagrees by `tolerance` or the steps are used up.
pub(super) fn solve(
    gram: &Gram<'_>,
    target: &[f64],
    bounds: &[Bounds],
    start: Vec<f64>,
    tolerance: f64,
) -> Solution {
    let mut gradient: Vec<f64> = target.iter().map(|t| -t).collect();
    for (i, beta) in start.iter().enumerate().filter(|(_, beta)| **beta != 0.0) {
        gradient.iter_mut().zip(gram.row(i)).for_each(|(g, k)| *g += beta * f64::from(*k));
    }
    let mut state = State { gram, bounds, beta: start, gradient };
    for _ in 0..STEPS_AT_LEAST.max(STEPS_PER_SAMPLE * bounds.len()) {
        let Some((to, from)) = state.pair(tolerance) else { break };
        state.shift(to, from);
    }
    Solution { rho: state.threshold(), coefficients: state.beta }
}

/// K(x, x) − 2K(x, y) + K(y, y): the objective's second derivative when weight moves between two samples. Between
/// two in the same place it is zero, and something small stands for it.
fn curvature(between: f32) -> f64 {
    (2.0 - 2.0 * f64::from(between)).max(1e-12)
}

impl State<'_> {
    fn may_rise(&self, i: usize) -> bool {
        self.beta[i] < self.bounds[i].high
    }

    fn may_fall(&self, i: usize) -> bool {
        self.beta[i] > self.bounds[i].low
    }

    /// Who receives and who gives; none when all gradients agree. Ties go to the first, so a fit is a function of
    /// its samples.
    fn pair(&self, tolerance: f64) -> Option<(usize, usize)> {
        let g = &self.gradient;
        let to = (0..g.len())
            .filter(|&i| self.may_rise(i))
            .reduce(|best, i| if g[i] < g[best] { i } else { best })?;
        let row = self.gram.row(to);
        let (mut widest, mut from, mut best) = (0.0, None, 0.0);
        for i in (0..g.len()).filter(|&i| self.may_fall(i)) {
            let gap = g[i] - g[to];
            widest = f64::max(widest, gap);
            // What the objective would fall by, twice, if the bounds let it.
            let gain = gap * gap / curvature(row[i]);
            if gap > 0.0 && gain > best {
                (from, best) = (Some(i), gain);
            }
        }
        if widest < tolerance { None } else { from.map(|from| (to, from)) }
    }

    /// Moves as much weight as is best for the pair, or as the bounds allow.
    fn shift(&mut self, to: usize, from: usize) {
        let (receiver, giver) = (self.gram.row(to), self.gram.row(from));
        let best = (self.gradient[from] - self.gradient[to]) / curvature(receiver[from]);
        let (room, stock) = (self.bounds[to].high - self.beta[to], self.beta[from] - self.bounds[from].low);
        let amount = best.min(room).min(stock);
        // A bound is reached exactly, not up to rounding: who may rise or fall is decided by equality.
        self.beta[to] = if amount == room { self.bounds[to].high } else { self.beta[to] + amount };
        self.beta[from] = if amount == stock { self.bounds[from].low } else { self.beta[from] - amount };
        for ((g, plus), minus) in self.gradient.iter_mut().zip(receiver).zip(giver) {
            *g += amount * (f64::from(*plus) - f64::from(*minus));
        }
    }

    /// ρ: the gradient of the samples between their bounds, which all agree; without any, the middle of what the
    /// others allow, or its one end when all weight is used up or none is.
    fn threshold(&self) -> f64 {
        let all = 0..self.beta.len();
        let at = |i: usize| self.gradient[i];
        let free: Vec<f64> = all.clone().filter(|&i| self.may_rise(i) && self.may_fall(i)).map(at).collect();
        if !free.is_empty() {
            return free.iter().sum::<f64>() / free.len() as f64;
        }
        let above = all.clone().filter(|&i| self.may_rise(i)).map(at).reduce(f64::min);
        let below = all.filter(|&i| self.may_fall(i)).map(at).reduce(f64::max);
        match (above, below) {
            (Some(above), Some(below)) => f64::midpoint(above, below),
            (one, other) => one.or(other).unwrap_or(0.0),
        }
    }
}
