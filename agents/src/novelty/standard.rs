//! Rows of numbers, each number by how it usually is: running mean and spread.

use crate::{Bag, Checkpoint, Corrupt, Running};

/// The numbers of rows less their running means, over the roots of their running variances plus a floor.
#[derive(Clone, Debug)]
pub(super) struct Standard {
    columns: Vec<Running>,
    /// Added to each variance.
    floor: f32,
    /// Results lie within ± this.
    clip: f32,
    /// Mean, and what is multiplied by, of each column: as `columns` has them.
    means: Vec<f32>,
    scales: Vec<f32>,
}

impl Standard {
    /// For rows of `width` numbers, of which none was seen yet.
    pub(super) fn new(width: usize, floor: f32, clip: f32) -> Self {
        let columns = vec![Running::default(); width];
        let mut standard = Self { columns, floor, clip, means: Vec::new(), scales: Vec::new() };
        standard.refresh();
        standard
    }

    /// These rows were seen.
    pub(super) fn watch(&mut self, rows: &[f32]) {
        for row in rows.chunks_exact(self.columns.len().max(1)) {
            self.columns.iter_mut().zip(row).for_each(|(column, x)| column.push(*x));
        }
        self.refresh();
    }

    fn refresh(&mut self) {
        self.means = self.columns.iter().map(Running::mean).collect();
        let scale = |column: &Running| (column.deviation().powi(2) + self.floor).sqrt().recip();
        self.scales = self.columns.iter().map(scale).collect();
    }

    /// Brings rows to their usual size.
    pub(super) fn apply(&self, rows: &mut [f32]) {
        for row in rows.chunks_exact_mut(self.columns.len().max(1)) {
            for ((x, mean), scale) in row.iter_mut().zip(&self.means).zip(&self.scales) {
                *x = ((*x - mean) * scale).clamp(-self.clip, self.clip);
            }
        }
    }
}

impl Checkpoint for Standard {
    fn save(&self, bag: &mut Bag) {
        bag.put("columns", &self.columns);
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        let columns: Vec<Running> = bag.get("columns")?;
        if columns.len() != self.columns.len() {
            let why = format!("it has {} numbers a row and not {}", columns.len(), self.columns.len());
            return Err(Corrupt::Unreadable { part: "columns".into(), why });
        }
        self.columns = columns;
        self.refresh();
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_become_deviations_from_the_mean_and_stay_within_bounds() {
        let mut standard = Standard::new(2, 1e-8, 5.0);
        standard.watch(&[1.0, 7.0, 3.0, 7.0]);
        let mut rows = [4.0, 7.0, 100.0, 7.5];
        standard.apply(&mut rows);
        assert!((rows[0] - 2.0).abs() < 1e-6);
        // What never varied is as strange as can be where it does.
        assert_eq!(rows[1..], [0.0, 5.0, 5.0]);
        let mut floored = Standard::new(1, 1.0, 5.0);
        floored.watch(&[2.0]);
        let mut row = [2.5];
        floored.apply(&mut row);
        assert_eq!(row, [0.5]);
    }
}
