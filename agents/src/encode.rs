//! From observations to rows of numbers that networks read.

mod inputs;
mod one_hot;
mod patches;

pub(crate) use inputs::Inputs;
pub use one_hot::{Choices, OneHot, OneHotError};
pub use patches::{PatchError, Patches};

use inroads_envs::{Kind, Space};

/// Writes observations as rows: the one bridge from a domain's kind to tensors.
pub trait Encoder<O> {
    /// Numbers a row.
    fn width(&self) -> usize;

    /// Writes one row; `out` has [`width`](Self::width) elements.
    fn write(&self, observation: &O, out: &mut [f32]);

    /// What the numbers of a row are to each other.
    fn shape(&self) -> Shape {
        Shape::Row(self.width())
    }
}

/// What the numbers of a row are to each other: which network can make something of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Nothing: so many numbers.
    Row(usize),
    /// Places that lie in rows and columns, each of so many numbers, row by row.
    Grid {
        /// Rows.
        down: usize,
        /// Places in a row.
        across: usize,
        /// Numbers a place.
        width: usize,
    },
}

impl Shape {
    /// Numbers a row.
    pub fn width(self) -> usize {
        match self {
            Self::Row(width) => width,
            Self::Grid { down, across, width } => down * across * width,
        }
    }
}

/// Rows of many observations, one after the other.
pub(crate) fn rows<'a, O: 'a>(
    encoder: &(impl Encoder<O> + ?Sized),
    seen: impl ExactSizeIterator<Item = &'a O>,
) -> Vec<f32> {
    let width = encoder.width();
    let mut rows = vec![0.0; width * seen.len()];
    rows.chunks_exact_mut(width.max(1)).zip(seen).for_each(|(row, s)| encoder.write(s, row));
    rows
}

/// Rows of goals that are `width` wide, zeros where there is none.
pub(crate) fn goal_rows<'a, G: Encode + 'a>(
    width: usize,
    goals: impl ExactSizeIterator<Item = Option<&'a G>>,
) -> Vec<f32> {
    let mut rows = vec![0.0; width * goals.len()];
    for (row, goal) in rows.chunks_exact_mut(width.max(1)).zip(goals) {
        if let Some(goal) = goal {
            goal.write(row);
        }
    }
    rows
}

/// A goal as numbers that a network reads beside an observation. "No goal", the task itself, is read as zeros
/// (thesis section 8.4), so whoever reads goals must know their width beforehand.
pub trait Encode {
    /// Numbers it writes; the same for all goals of an agent.
    fn width(&self) -> usize;

    /// Writes them; `out` has [`width`](Self::width) elements.
    fn write(&self, out: &mut [f32]);
}

/// Where nothing but the task is ever learned.
impl Encode for () {
    fn width(&self) -> usize {
        0
    }

    fn write(&self, _: &mut [f32]) {}
}

/// Vectors scaled to about [−1, 1] by the usual range of each dimension; an angle becomes its sine and cosine,
/// so that a heading of 2π is the heading 0.
///
/// The authors feed raw states. This is what `Spec` makes free, and every agent of the project gets the same.
#[derive(Clone, Debug)]
pub struct Scaled {
    /// Of each component that is read its index, and how.
    columns: Vec<(usize, Column)>,
    width: usize,
}

#[derive(Clone, Debug)]
enum Column {
    /// `(x − centre) × scale`.
    Linear {
        centre: f32,
        scale: f32,
    },
    Angle,
}

impl Scaled {
    /// The encoder for a space of vectors. A dimension without finite bounds is passed on as it is.
    pub fn new(space: &Space) -> Self {
        Self::of(space, 0..space.dimensions().len())
    }

    /// The encoder for some components of a space of vectors.
    ///
    /// # Panics
    /// When the space has no such component.
    pub fn of(space: &Space, dims: impl IntoIterator<Item = usize>) -> Self {
        let column = |dim: usize| {
            let d = &space.dimensions()[dim];
            let column = match d.kind {
                Kind::Angle => Column::Angle,
                Kind::Linear if d.low.is_finite() && d.high > d.low && d.high.is_finite() => {
                    Column::Linear { centre: f32::midpoint(d.low, d.high), scale: 2.0 / (d.high - d.low) }
                }
                Kind::Linear => Column::Linear { centre: 0.0, scale: 1.0 },
            };
            (dim, column)
        };
        let columns: Vec<_> = dims.into_iter().map(column).collect();
        let width = columns.iter().map(|(_, c)| if matches!(c, Column::Angle) { 2 } else { 1 }).sum();
        Self { columns, width }
    }
}

impl Encoder<Vec<f32>> for Scaled {
    fn width(&self) -> usize {
        self.width
    }

    fn write(&self, observation: &Vec<f32>, out: &mut [f32]) {
        let mut out = out.iter_mut();
        let mut put = |value| {
            if let Some(slot) = out.next() {
                *slot = value;
            }
        };
        for (dim, column) in &self.columns {
            let x = observation[*dim];
            match column {
                Column::Linear { centre, scale } => put((x - centre) * scale),
                Column::Angle => {
                    put(x.sin());
                    put(x.cos());
                }
            }
        }
    }
}

/// Some components of a vector, as they are: what a set of places is learned on.
#[derive(Clone, Debug)]
pub struct Select {
    dims: Vec<usize>,
}

impl Select {
    /// The encoder for the components of these indices.
    pub fn new(dims: &[usize]) -> Self {
        Self { dims: dims.to_vec() }
    }
}

impl Encoder<Vec<f32>> for Select {
    fn width(&self) -> usize {
        self.dims.len()
    }

    fn write(&self, observation: &Vec<f32>, out: &mut [f32]) {
        for (slot, &dim) in out.iter_mut().zip(&self.dims) {
            *slot = observation[dim];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use inroads_envs::Dimension;

    #[test]
    fn ranges_become_unit_ranges_and_angles_become_points_on_a_circle() {
        let space = Space::Box(
            [
                Dimension::linear("x", "m", -2.0, 10.0),
                Dimension::angle("heading"),
                Dimension::linear("v", "m/s", f32::NEG_INFINITY, f32::INFINITY),
            ]
            .into(),
        );
        let encoder = Scaled::new(&space);
        let mut row = vec![0.0; encoder.width()];
        encoder.write(&vec![10.0, std::f32::consts::FRAC_PI_2, 7.0], &mut row);
        assert_eq!(row.len(), 4);
        assert_eq!((row[0], row[1], row[3]), (1.0, 1.0, 7.0));
        assert!(row[2].abs() < 1e-6);
        let some = Scaled::of(&space, [2, 0]);
        let mut row = vec![0.0; some.width()];
        some.write(&vec![4.0, 0.0, 7.0], &mut row);
        assert_eq!(row, [7.0, 0.0]);
    }
}
