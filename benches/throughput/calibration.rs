//! The yardstick: work of the kind that a rigid-body step does, of the same amount on every machine and for ever.
//!
//! Processors differ in how fast they are today: frequency, a neighbour in the cache, another tenant on the same
//! core. Speeds *relative to this loop*, timed in the same moments, hardly do. So it mixes what a step of the
//! ant mixes: small dense f32 matrices (assembled, factored, solved), a projected Gauss-Seidel sweep with its
//! branches, short-lived allocations, and a walk through a tree in memory. Changing anything here
//! makes every recorded baseline worthless.

use std::hint::black_box;

/// Degrees of freedom, as many as the ant has.
const DOFS: usize = 14;
/// Links, as many as the ant has.
const LINKS: usize = 9;
/// Rows of a link's Jacobian.
const ROWS: usize = 6;
/// Contacts of a step.
const CONTACTS: usize = 12;
/// Bodies that are visited one after the other: 256 KiB of them, so that the second cache works too.
const BODIES: usize = 85;
/// Boxes of the tree that is walked through.
const BOXES: usize = 1024;

/// Calibration on one thread or several.
pub(crate) struct Yardstick(Vec<Calibration>);

impl Yardstick {
    /// Nothing is running yet.
    pub(crate) fn new() -> Self {
        Self(Vec::new())
    }

    /// So many loops on each of so many threads, the caller's among them.
    pub(crate) fn loops(&mut self, loops: u32, threads: usize) {
        if self.0.len() < threads {
            self.0.resize_with(threads, Calibration::new);
        }
        let run = |calibration: &mut Calibration| (0..loops).for_each(|_| calibration.once());
        match &mut self.0[..threads] {
            [own] => run(own),
            [own, others @ ..] => std::thread::scope(|scope| {
                for other in others {
                    scope.spawn(move || run(other));
                }
                run(own);
            }),
            [] => {}
        }
    }
}

/// The loop's data.
struct Calibration {
    /// Jacobians, `[BODIES, LINKS, DOFS, ROWS]`.
    jacobians: Vec<f32>,
    /// A box and the two that it encloses.
    boxes: Vec<([f32; 2], [usize; 2])>,
    random: u64,
    velocity: [f32; DOFS],
}

impl Calibration {
    /// The data at the start.
    fn new() -> Self {
        let mut made = Self {
            jacobians: Vec::new(),
            boxes: Vec::new(),
            random: 0x9E37_79B9_7F4A_7C15,
            velocity: [0.0; DOFS],
        };
        made.jacobians = (0..BODIES * LINKS * DOFS * ROWS).map(|_| made.uniform()).collect();
        made.boxes = (0..BOXES)
            .map(|at| {
                let centre = made.uniform();
                let half = 2.0 / (at + 1) as f32;
                ([centre - half, centre + half], [2 * at + 1, 2 * at + 2])
            })
            .collect();
        made
    }

    /// One loop: a step of a body that does not exist, a few tens of microseconds.
    fn once(&mut self) {
        let body = (self.next() % BODIES as u64) as usize;
        let size = LINKS * DOFS * ROWS;
        let jacobians = &self.jacobians[body * size..(body + 1) * size];
        for _ in 0..2 {
            let mut mass = assemble(black_box(jacobians));
            factor(&mut mass);
            let mut force = self.velocity;
            solve(&mass, &mut force);
            self.velocity = sweep(jacobians, &mass, force);
        }
        let found = self.walk() as f32;
        for value in &mut self.velocity {
            // Bounded, whatever came before.
            *value = (0.5 * *value + 1e-3 * found).clamp(-1.0, 1.0);
        }
        black_box(&self.velocity);
    }

    /// Boxes that a random interval touches, depth first, as a broad phase looks for them.
    fn walk(&mut self) -> usize {
        let centre = self.uniform();
        let (low, high) = (centre - 0.05, centre + 0.05);
        let (mut stack, mut found) = (vec![0], 0);
        while let Some(at) = stack.pop() {
            let Some((range, children)) = self.boxes.get(at) else { continue };
            if range[0] <= high && low <= range[1] {
                found += 1;
                stack.extend(children);
            }
        }
        found
    }

    /// Uniform in [-1, 1).
    fn uniform(&mut self) -> f32 {
        (self.next() >> 40) as f32 / (1u64 << 23) as f32 - 1.0
    }

    /// Marsaglia's xorshift.
    fn next(&mut self) -> u64 {
        self.random ^= self.random << 13;
        self.random ^= self.random >> 7;
        self.random ^= self.random << 17;
        self.random
    }
}

/// The sum over links of `Jᵀ J`, and enough on the diagonal to be well conditioned; `[DOFS, DOFS]`.
fn assemble(jacobians: &[f32]) -> Vec<f32> {
    let mut mass = vec![0.0; DOFS * DOFS];
    for jacobian in jacobians.chunks_exact(DOFS * ROWS) {
        for (row, a) in jacobian.chunks_exact(ROWS).enumerate() {
            for (column, b) in jacobian.chunks_exact(ROWS).enumerate() {
                mass[row * DOFS + column] += a.iter().zip(b).map(|(x, y)| x * y).sum::<f32>();
            }
        }
    }
    for at in 0..DOFS {
        mass[at * DOFS + at] += 10.0;
    }
    mass
}

/// `L U` in place, row by row.
fn factor(mass: &mut [f32]) {
    for k in 0..DOFS {
        let (above, below) = mass.split_at_mut((k + 1) * DOFS);
        let pivot = &above[k * DOFS..];
        for row in below.chunks_exact_mut(DOFS) {
            row[k] /= pivot[k];
            let factor = row[k];
            for (x, u) in row[k + 1..].iter_mut().zip(&pivot[k + 1..]) {
                *x -= factor * u;
            }
        }
    }
}

/// Replaces `b` by the solution.
fn solve(lu: &[f32], b: &mut [f32; DOFS]) {
    for (k, row) in lu.chunks_exact(DOFS).enumerate() {
        b[k] -= row[..k].iter().zip(&b[..k]).map(|(l, x)| l * x).sum::<f32>();
    }
    for (k, row) in lu.chunks_exact(DOFS).enumerate().rev() {
        let known: f32 = row[k + 1..].iter().zip(&b[k + 1..]).map(|(u, x)| u * x).sum();
        b[k] = (b[k] - known) / row[k];
    }
}

/// Contacts push where they are approached, one after the other.
fn sweep(jacobians: &[f32], lu: &[f32], mut velocity: [f32; DOFS]) -> [f32; DOFS] {
    for contact in 0..CONTACTS {
        let mut row: [f32; DOFS] =
            std::array::from_fn(|dof| jacobians[(contact % LINKS * DOFS + dof) * ROWS + contact % ROWS]);
        let approach: f32 = row.iter().zip(&velocity).map(|(j, v)| j * v).sum::<f32>() - 0.01;
        if approach < 0.0 {
            let direction = row;
            solve(lu, &mut row);
            let weight: f32 = direction.iter().zip(&row).map(|(j, x)| j * x).sum();
            for (v, x) in velocity.iter_mut().zip(&row) {
                *v -= approach / weight.max(1e-6) * x;
            }
        }
    }
    velocity
}
