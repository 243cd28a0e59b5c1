//! Sequences of several lengths as rows without padding.

/// Sequences side by side, the longest first; rows go step by step, and within a step sequence by sequence.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Packing {
    /// The sequences in that order.
    pub(super) order: Vec<usize>,
    /// How many of them have each step, falling.
    pub(super) sizes: Vec<usize>,
    /// The row of each step of the first sequence.
    firsts: Vec<usize>,
}

impl Packing {
    /// Sequences of these lengths, which may be 0.
    pub(super) fn new(lengths: &[usize]) -> Self {
        let mut order: Vec<usize> = (0..lengths.len()).collect();
        order.sort_by_key(|i| std::cmp::Reverse(lengths[*i]));
        let longest = order.first().map_or(0, |i| lengths[*i]);
        let sizes: Vec<usize> =
            (0..longest).map(|step| lengths.iter().filter(|length| **length > step).count()).collect();
        let mut rows = 0;
        let first = |size: &usize| {
            rows += size;
            rows - size
        };
        let firsts = sizes.iter().map(first).collect();
        Self { order, sizes, firsts }
    }

    /// Which step of which sequence each row is.
    pub(super) fn rows(&self) -> Vec<(usize, usize)> {
        let of_step = |(step, size): (usize, &usize)| self.order[..*size].iter().map(move |i| (*i, step));
        self.sizes.iter().enumerate().flat_map(of_step).collect()
    }

    /// The row of a step of the sequence at a place of the order.
    pub(super) fn row(&self, place: usize, step: usize) -> usize {
        self.firsts[step] + place
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_come_first_and_no_row_is_padding() {
        let packing = Packing::new(&[1, 3, 0, 2, 3]);
        assert_eq!(packing.order, [1, 4, 3, 0, 2]);
        assert_eq!(packing.sizes, [4, 3, 2]);
        let rows = packing.rows();
        assert_eq!(rows, [(1, 0), (4, 0), (3, 0), (0, 0), (1, 1), (4, 1), (3, 1), (1, 2), (4, 2)]);
        for (place, &sequence) in packing.order.iter().enumerate() {
            for step in 0..[1, 3, 0, 2, 3][sequence] {
                assert_eq!(rows[packing.row(place, step)], (sequence, step));
            }
        }
        assert_eq!(Packing::new(&[0, 0]).sizes, [0; 0]);
    }
}
