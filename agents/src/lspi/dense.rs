//! The little dense algebra that least squares needs: factors of Gram matrices, in double precision.

/// Inverse of the lower Cholesky factor `L` of a symmetric positive definite matrix `G = L Lᵀ`.
///
/// Rows multiplied by it are *white*: their Gram matrix is the identity.
#[derive(Clone, Debug)]
pub(super) struct Whitening {
    size: usize,
    /// `L⁻¹`, row by row; above the diagonal zero.
    inverse: Vec<f64>,
}

impl Whitening {
    /// Factorises `gram`, `size` rows of as many numbers; none when it is not positive definite.
    pub(super) fn new(mut gram: Vec<f64>, size: usize) -> Option<Self> {
        for row in 0..size {
            let (above, rest) = gram.split_at_mut(row * size);
            let this = &mut rest[..size];
            for column in 0..row {
                let other = &above[column * size..][..=column];
                let known: f64 = this[..column].iter().zip(other).map(|(a, b)| a * b).sum();
                this[column] = (this[column] - known) / other[column];
            }
            let known: f64 = this[..row].iter().map(|x| x * x).sum();
            let pivot = this[row] - known;
            if pivot.is_nan() || pivot <= 0.0 {
                return None;
            }
            this[row] = pivot.sqrt();
        }
        Some(Self { size, inverse: invert(&gram, size) })
    }

    /// `L⁻¹ x`: features to white features.
    pub(super) fn whiten(&self, x: &[f64], out: &mut [f64]) {
        for (row, slot) in out.iter_mut().enumerate().take(self.size) {
            let weights = &self.inverse[row * self.size..][..=row];
            *slot = weights.iter().zip(x).map(|(w, x)| w * x).sum();
        }
    }

    /// `L⁻ᵀ x`: weights of white features to weights of features.
    pub(super) fn unwhiten(&self, x: &[f64], out: &mut [f64]) {
        out[..self.size].fill(0.0);
        for (row, &x) in x.iter().enumerate().take(self.size) {
            let weights = &self.inverse[row * self.size..][..=row];
            out.iter_mut().zip(weights).for_each(|(slot, w)| *slot += w * x);
        }
    }
}

/// The inverse of a lower triangular matrix, row by row.
fn invert(lower: &[f64], size: usize) -> Vec<f64> {
    let mut inverse = vec![0.0; size * size];
    for row in 0..size {
        let (above, rest) = inverse.split_at_mut(row * size);
        let this = &mut rest[..size];
        let weights = &lower[row * size..][..size];
        for (other, &weight) in weights[..row].iter().enumerate() {
            let done = &above[other * size..][..=other];
            this.iter_mut().zip(done).for_each(|(slot, x)| *slot -= weight * x);
        }
        this[..row].iter_mut().for_each(|x| *x /= weights[row]);
        this[row] = 1.0 / weights[row];
    }
    inverse
}

/// Adds `weight · x xᵀ` to the lower half of a matrix.
pub(super) fn add_square(gram: &mut [f64], x: &[f64], weight: f64) {
    for (row, &a) in x.iter().enumerate() {
        let (a, lower) = (weight * a, &mut gram[row * x.len()..][..=row]);
        lower.iter_mut().zip(x).for_each(|(slot, b)| *slot += a * b);
    }
}

/// Adds `weight · x yᵀ` to a matrix.
pub(super) fn add_product(matrix: &mut [f64], x: &[f64], y: &[f64], weight: f64) {
    for (row, &a) in matrix.chunks_exact_mut(y.len()).zip(x) {
        let a = weight * a;
        row.iter_mut().zip(y).for_each(|(slot, b)| *slot += a * b);
    }
}

/// Replaces the right-hand side by the solution of a square system: Gauss' method with row pivots, which uses up the
/// matrix. An unknown that the system does not determine is 0.
pub(super) fn solve(matrix: &mut [f64], right: &mut [f64]) {
    let size = right.len();
    for step in 0..size {
        let size_of = |row: usize| matrix[row * size + step].abs();
        let pivot = (step..size).rev().max_by(|&a, &b| size_of(a).total_cmp(&size_of(b))).unwrap_or(step);
        if pivot != step {
            let (above, below) = matrix.split_at_mut(pivot * size);
            above[step * size..][..size].swap_with_slice(&mut below[..size]);
            right.swap(step, pivot);
        }
        let (above, below) = matrix.split_at_mut((step + 1) * size);
        let head = &above[step * size + step..];
        if head[0] == 0.0 {
            continue;
        }
        for (row, at) in below.chunks_exact_mut(size).zip(step + 1..) {
            let factor = row[step] / head[0];
            row[step..].iter_mut().zip(head).for_each(|(slot, x)| *slot -= factor * x);
            right[at] -= factor * right[step];
        }
    }
    for row in (0..size).rev() {
        let known = &matrix[row * size..][..size];
        let sum: f64 = known[row + 1..].iter().zip(&right[row + 1..]).map(|(a, x)| a * x).sum();
        right[row] = if known[row] == 0.0 { 0.0 } else { (right[row] - sum) / known[row] };
    }
}

/// Rows of a Gram matrix, of which the lower half is given, that are independent of each other and span all: Cholesky's
/// method with pivots, until no remaining diagonal element exceeds `tolerance` times what it was.
pub(super) fn independent(mut gram: Vec<f64>, size: usize, tolerance: f64) -> Vec<usize> {
    let at = |row: usize, column: usize| row.max(column) * size + row.min(column);
    let whole: Vec<f64> = (0..size).map(|i| gram[at(i, i)]).collect();
    let mut left: Vec<usize> = (0..size).filter(|&i| whole[i] > 0.0).collect();
    let mut found = Vec::new();
    while let Some(place) = (0..left.len()).max_by(|&a, &b| {
        let share = |i: usize| gram[at(left[i], left[i])] / whole[left[i]];
        // The first of equals.
        share(a).total_cmp(&share(b)).then(b.cmp(&a))
    }) {
        let pivot = left.remove(place);
        let value = gram[at(pivot, pivot)];
        if value <= tolerance * whole[pivot] {
            break;
        }
        found.push(pivot);
        let column: Vec<f64> = left.iter().map(|&i| gram[at(i, pivot)] / value.sqrt()).collect();
        for (row, &i) in left.iter().enumerate() {
            for (&j, other) in left.iter().zip(&column).take(row + 1) {
                gram[at(i, j)] -= column[row] * other;
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_rows_have_the_identity_as_gram_matrix() {
        // G = [[4, 2], [2, 5]] has L = [[2, 0], [1, 2]].
        let whitening = Whitening::new(vec![4.0, 0.0, 2.0, 5.0], 2).unwrap();
        let mut white = [0.0; 2];
        whitening.whiten(&[2.0, 3.0], &mut white);
        assert_eq!(white, [1.0, 1.0]);
        let mut weights = [0.0; 2];
        whitening.unwhiten(&[1.0, 1.0], &mut weights);
        // Lᵀ w = (1, 1): w₁ = 1/2, w₀ = (1 − 1/2) / 2.
        assert_eq!(weights, [0.25, 0.5]);
        assert!(Whitening::new(vec![1.0, 0.0, 1.0, 1.0], 2).is_none());
    }

    #[test]
    fn a_system_is_solved_whatever_the_order_of_its_rows() {
        // 2y = 4; x + z = 4; 3x − y = 1.
        let mut right = [4.0, 4.0, 1.0];
        solve(&mut [0.0, 2.0, 0.0, 1.0, 0.0, 1.0, 3.0, -1.0, 0.0], &mut right);
        assert_eq!(right, [1.0, 2.0, 3.0]);
        // Nothing is said of the second unknown.
        let mut right = [6.0, 0.0];
        solve(&mut [2.0, 0.0, 0.0, 0.0], &mut right);
        assert_eq!(right, [3.0, 0.0]);
    }

    #[test]
    fn independent_rows_are_as_many_as_the_rank() {
        let mut gram = vec![0.0; 9];
        add_square(&mut gram, &[1.0, 2.0, 3.0], 1.0);
        assert_eq!(independent(gram.clone(), 3, 1e-9), [0]);
        add_square(&mut gram, &[1.0, -1.0, 0.0], 1.0);
        assert_eq!(independent(gram.clone(), 3, 1e-9).len(), 2);
        add_square(&mut gram, &[0.0, 0.0, 0.1], 1.0);
        assert_eq!(independent(gram, 3, 1e-9).len(), 3);
        assert!(independent(vec![0.0; 4], 2, 1e-9).is_empty());
    }
}
