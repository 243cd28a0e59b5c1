//! Systems of linear equations of which only products with the matrix are known: GMRES (Saad and Schultz 1986).

/// One system `A x = b` on its way to be solved. The product with `A` is somebody else's work: take a
/// [`direction`](Self::direction), multiply, [`absorb`](Self::absorb); so many systems can share one pass over the data.
///
/// After `n` products, `x` is the vector with the least residual among all that `n` products can make; after as many as
/// there are unknowns it is exact.
#[derive(Clone, Debug)]
pub(super) struct Gmres {
    /// Orthonormal directions, one more than there were products.
    basis: Vec<Vec<f64>>,
    /// The triangular factor of the projected matrix, column by column.
    columns: Vec<Vec<f64>>,
    /// Givens' rotations that made it triangular: cosine and sine.
    rotations: Vec<(f64, f64)>,
    /// The rotated right-hand side; its last element is the residual's norm.
    right: Vec<f64>,
    /// The norm of the residual at which it is solved.
    target: f64,
}

impl Gmres {
    /// Begins at `x = 0`. It is solved when the norm of the residual is at most `target`.
    pub(super) fn new(mut right: Vec<f64>, target: f64) -> Self {
        let norm = dot(&right, &right).sqrt();
        if norm > 0.0 {
            right.iter_mut().for_each(|x| *x /= norm);
        }
        Self { basis: vec![right], columns: Vec::new(), rotations: Vec::new(), right: vec![norm], target }
    }

    /// Whether the residual is small enough.
    pub(super) fn solved(&self) -> bool {
        self.residual() <= self.target
    }

    /// Products so far.
    pub(super) fn products(&self) -> usize {
        self.columns.len()
    }

    fn residual(&self) -> f64 {
        self.right.last().map_or(0.0, |last| last.abs())
    }

    /// What to multiply next.
    pub(super) fn direction(&self) -> &[f64] {
        self.basis.last().map_or(&[], |last| last)
    }

    /// Takes in `A` times the direction.
    pub(super) fn absorb(&mut self, mut image: Vec<f64>) {
        let mut column: Vec<f64> = Vec::with_capacity(self.basis.len() + 1);
        for direction in &self.basis {
            let along = dot(direction, &image);
            image.iter_mut().zip(direction).for_each(|(x, d)| *x -= along * d);
            column.push(along);
        }
        let norm = dot(&image, &image).sqrt();
        for (i, &(cosine, sine)) in self.rotations.iter().enumerate() {
            let (a, b) = (column[i], column[i + 1]);
            (column[i], column[i + 1]) = (cosine * a + sine * b, cosine * b - sine * a);
        }
        let last = column.last_mut().expect("there is a direction");
        let length = (*last * *last + norm * norm).sqrt();
        let (cosine, sine) = if length > 0.0 { (*last / length, norm / length) } else { (1.0, 0.0) };
        *last = length;
        let residual = self.right.pop().unwrap_or(0.0);
        self.right.extend([cosine * residual, -sine * residual]);
        self.rotations.push((cosine, sine));
        self.columns.push(column);
        if norm > 0.0 {
            image.iter_mut().for_each(|x| *x /= norm);
        }
        self.basis.push(image);
    }

    /// The `x` of least residual so far.
    pub(super) fn solution(&self) -> Vec<f64> {
        let mut solution = vec![0.0; self.direction().len()];
        let mut right = self.right.clone();
        for at in (0..self.columns.len()).rev() {
            let column = &self.columns[at];
            // A column of zeros: the matrix is singular along this direction, which then does not help.
            let weight = if column[at] > 0.0 { right[at] / column[at] } else { 0.0 };
            right.iter_mut().zip(&column[..at]).for_each(|(r, c)| *r -= weight * c);
            solution.iter_mut().zip(&self.basis[at]).for_each(|(x, d)| *x += weight * d);
        }
        solution
    }
}

/// Eight sums side by side, which processors add at once.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (tail_a, tail_b) = (a.chunks_exact(8).remainder(), b.chunks_exact(8).remainder());
    for (a, b) in a.chunks_exact(8).zip(b.chunks_exact(8)) {
        for lane in 0..8 {
            sums[lane] += a[lane] * b[lane];
        }
    }
    let tail: f64 = tail_a.iter().zip(tail_b).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + tail
}

#[cfg(test)]
mod tests {
    use super::*;

    fn solve(matrix: &[[f64; 3]; 3], right: [f64; 3]) -> (Vec<f64>, usize) {
        let mut system = Gmres::new(right.to_vec(), 1e-12);
        while !system.solved() {
            let image = matrix.iter().map(|row| dot(row, system.direction())).collect();
            system.absorb(image);
        }
        (system.solution(), system.products())
    }

    #[test]
    fn as_many_products_as_unknowns_solve_a_system() {
        let (x, products) = solve(&[[2.0, 1.0, 0.0], [0.0, 1.0, -3.0], [1.0, 0.0, 4.0]], [4.0, -7.0, 13.0]);
        assert!(products <= 3);
        for (found, expected) in x.iter().zip([1.0, 2.0, 3.0]) {
            assert!((found - expected).abs() < 1e-12, "{x:?}");
        }
    }

    #[test]
    fn one_product_solves_the_identity_and_none_solves_zero() {
        let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert_eq!(solve(&identity, [3.0, 0.0, 4.0]).1, 1);
        assert_eq!(solve(&identity, [0.0; 3]), (vec![0.0; 3], 0));
    }
}
