//! Sets learned from examples: what an initiation set (thesis 3.1.3, 5.1.2) needs of a classifier, and four of them.

mod neural;
mod odds;

pub use neural::{Neural, NeuralConfig};
pub use odds::{Odds, OddsConfig};

use serde::{Deserialize, Serialize};

use crate::svm::{self, ClassWeights, Gamma, Machine, OneClass, TOLERANCE, TwoClass, Unfit};

/// Says which rows are inside a set learned from examples.
pub trait Classifier: crate::Checkpoint {
    /// Replaces what was learned by a fit to these rows. No negatives: a one-class fit.
    ///
    /// # Errors
    /// [`Unfit`] when nothing can be learned from the rows, or there are no positives; what was learned before stays
    /// then. Rows are counted through the positives and on through the negatives.
    fn fit(&mut self, positives: &[Vec<f32>], negatives: &[Vec<f32>]) -> Result<(), Unfit>;

    /// Positive inside the set, negative outside; its size says how far inside or outside (decision value).
    /// Before the first fit: negative infinity.
    fn score(&self, row: &[f32]) -> f32;

    /// Whether the row is inside the set.
    fn contains(&self, row: &[f32]) -> bool {
        self.score(row) > 0.0
    }
}

/// A classifier of examples that count more or less (thesis 5.1.2), which says how probable membership is.
pub trait Weighing: Classifier {
    /// Replaces what was learned by a fit to rows, whether each is inside, and how much it counts.
    ///
    /// # Errors
    /// [`Unfit`] names what cannot be used; what was learned before stays then.
    fn fit_weighted(&mut self, rows: &[Vec<f32>], labels: &[bool], weights: &[f32]) -> Result<(), Unfit>;

    /// How probable it is that the row is inside; 0 before the first fit, and where nothing is known.
    fn probability(&self, row: &[f32]) -> f32;
}

/// [`Classifier::fit`] of one whose examples may weigh: all weigh the same.
fn fit_equal(
    classifier: &mut impl Weighing,
    positives: &[Vec<f32>],
    negatives: &[Vec<f32>],
) -> Result<(), Unfit> {
    if positives.is_empty() {
        return Err(Unfit::NoSamples);
    }
    let rows = [positives, negatives].concat();
    let labels: Vec<_> = (0..rows.len()).map(|i| i < positives.len()).collect();
    classifier.fit_weighted(&rows, &labels, &vec![1.0; rows.len()])
}

/// What an example outside and one inside count where either class counts 1 in sum (Japkowicz and Stephen 2002).
fn class_weights(labels: &[bool]) -> [f32; 2] {
    [false, true].map(|class| 1.0 / labels.iter().filter(|label| **label == class).count().max(1) as f32)
}

/// What to do with negatives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TwoClassRule {
    /// A two-class machine says which of the training rows, of either label, lie on the positive side; the set is
    /// a one-class machine of those. So the set stays closed: a two-class machine alone claims all the space that
    /// lies away from its negatives. This is what the authors' code does.
    #[default]
    RefitOneClass,
    /// The two-class machine itself.
    Plain,
}

/// Settings of [`Svm`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SvmConfig {
    /// Share of positives that may be left outside by a one-class machine.
    pub nu: f64,
    /// The kernel's width: `"scale"`, `"auto"` or a number. The rules look at the rows of each fit.
    pub gamma: Gamma,
    /// Price of an error of a two-class machine, whose classes are balanced.
    pub c: f64,
    /// What to do with negatives.
    pub two_class: TwoClassRule,
}

impl Default for SvmConfig {
    fn default() -> Self {
        Self { nu: 0.1, gamma: Gamma::Scale, c: 1.0, two_class: TwoClassRule::RefitOneClass }
    }
}

impl SvmConfig {
    /// Whether the settings are possible. Every fit asks too; this is for asking before a run starts.
    ///
    /// # Errors
    /// [`Unfit`] says which is not.
    pub fn check(&self) -> Result<(), Unfit> {
        self.one_class().check()?;
        self.refining().check()
    }

    fn one_class(&self) -> OneClass {
        OneClass { nu: self.nu, gamma: self.gamma, tolerance: TOLERANCE }
    }

    fn refining(&self) -> TwoClass {
        TwoClass { c: self.c, classes: ClassWeights::Balanced, gamma: self.gamma, tolerance: TOLERANCE }
    }
}

/// The thesis's initiation classifier: a one-class support vector machine, refined by a two-class one as soon as
/// there are negatives (3.1.3).
#[derive(Clone, Debug, Default)]
pub struct Svm {
    config: SvmConfig,
    machine: Option<Machine>,
}

impl Svm {
    /// One that has learned nothing yet. Impossible settings are reported by [`SvmConfig::check`], or by the first
    /// fit that uses them.
    #[must_use]
    pub fn new(config: SvmConfig) -> Self {
        Self { config, machine: None }
    }

    /// What was learned last.
    #[must_use]
    pub fn machine(&self) -> Option<&Machine> {
        self.machine.as_ref()
    }

    fn one_class(&self, rows: &[Vec<f32>]) -> Result<Machine, Unfit> {
        let mut machine = self.config.one_class().fit(rows)?;
        // The edge runs through support vectors, and is known up to the tolerance only. Whoever is that near is
        // inside; else rounding would decide, and the set of a single row would not hold that row.
        machine.rho -= TOLERANCE;
        Ok(machine)
    }

    fn two_class(&self, positives: &[Vec<f32>], negatives: &[Vec<f32>]) -> Result<Machine, Unfit> {
        let mut rows = [positives, negatives].concat();
        let labels: Vec<bool> = (0..rows.len()).map(|i| i < positives.len()).collect();
        let machine = self.config.refining().fit(&rows, &labels)?;
        if self.config.two_class == TwoClassRule::Plain {
            return Ok(machine);
        }
        rows.retain(|row| machine.decision(row) > 0.0);
        // Nothing on the positive side: the negatives lie where the positives do and teach nothing yet.
        self.one_class(if rows.is_empty() { positives } else { &rows })
    }
}

impl Classifier for Svm {
    fn fit(&mut self, positives: &[Vec<f32>], negatives: &[Vec<f32>]) -> Result<(), Unfit> {
        self.machine = Some(match (positives, negatives) {
            ([], _) => return Err(Unfit::NoSamples),
            (_, []) => self.one_class(positives)?,
            _ => self.two_class(positives, negatives)?,
        });
        Ok(())
    }

    fn score(&self, row: &[f32]) -> f32 {
        self.machine.as_ref().map_or(f32::NEG_INFINITY, |machine| machine.decision(row) as f32)
    }
}

crate::checkpoint!([] Svm; plain: machine; parts: );

/// Inside is whoever has a positive within a radius, and nearer than any negative. Exact on grids, and easy to
/// foretell in tests.
#[derive(Clone, Debug)]
pub struct Nearest {
    radius: f32,
    positives: Vec<Vec<f32>>,
    negatives: Vec<Vec<f32>>,
}

impl Nearest {
    /// One that has learned nothing yet. With radius 0, inside are the positives themselves.
    #[must_use]
    pub fn new(radius: f32) -> Self {
        Self { radius, positives: Vec::new(), negatives: Vec::new() }
    }
}

/// Euclidean distance to the nearest of the rows; infinite without any.
fn nearest(rows: &[Vec<f32>], to: &[f32]) -> f32 {
    let distance = |row: &Vec<f32>| row.iter().zip(to).map(|(a, b)| (a - b).powi(2)).sum::<f32>().sqrt();
    rows.iter().map(distance).fold(f32::INFINITY, f32::min)
}

impl Classifier for Nearest {
    fn fit(&mut self, positives: &[Vec<f32>], negatives: &[Vec<f32>]) -> Result<(), Unfit> {
        if positives.is_empty() {
            return Err(Unfit::NoSamples);
        }
        svm::check_rows(&[positives, negatives].concat())?;
        (self.positives, self.negatives) = (positives.to_vec(), negatives.to_vec());
        Ok(())
    }

    fn score(&self, row: &[f32]) -> f32 {
        if self.positives.is_empty() {
            return f32::NEG_INFINITY;
        }
        // The next number up lets a row at the radius in, while one as near to a negative stays out.
        self.radius.next_up().min(nearest(&self.negatives, row)) - nearest(&self.positives, row)
    }
}

crate::checkpoint!([] Nearest; plain: positives, negatives; parts: );

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Bag;

    fn grid(side: u8, from: f32) -> Vec<Vec<f32>> {
        (0..side * side).map(|i| vec![from + f32::from(i / side), from + f32::from(i % side)]).collect()
    }

    #[test]
    fn a_set_without_negatives_is_closed_and_holds_most_of_its_examples() {
        let mut svm = Svm::default();
        assert_eq!(svm.score(&[0.0, 0.0]), f32::NEG_INFINITY);
        let rows = grid(6, 0.0);
        svm.fit(&rows, &[]).unwrap();
        assert!(svm.contains(&[1.0, 1.0]) && !svm.contains(&[20.0, 2.5]));
        assert!(rows.iter().filter(|row| svm.contains(row)).count() >= 30);
    }

    #[test]
    fn the_default_rule_refits_on_the_positive_side_and_the_plain_one_does_not() {
        // One positive astray among the negatives, one negative astray among the positives.
        let (mut positives, mut negatives) = (grid(5, 0.0), grid(5, 10.0));
        positives.push(vec![12.1, 12.1]);
        negatives.push(vec![2.1, 2.1]);
        let mut refitted = Svm::default();
        refitted.fit(&positives, &negatives).unwrap();
        let mut plain = Svm::new(SvmConfig { two_class: TwoClassRule::Plain, ..SvmConfig::default() });
        plain.fit(&positives, &negatives).unwrap();
        for svm in [&refitted, &plain] {
            assert!(svm.contains(&[2.0, 2.0]) && !svm.contains(&[12.0, 12.0]));
        }
        let far = [-6.0, -6.0];
        assert!(!refitted.contains(&far), "the refit set is closed");
        assert!(refitted.machine().unwrap().coefficients.iter().all(|beta| *beta > 0.0));
        assert!(plain.machine().unwrap().coefficients.iter().any(|beta| *beta < 0.0));

        // The refit is the one-class fit of exactly the rows on the positive side: the astray negative is among
        // them, the astray positive is not.
        let mut kept = grid(5, 0.0);
        kept.push(vec![2.1, 2.1]);
        let mut expected = Svm::default();
        expected.fit(&kept, &[]).unwrap();
        assert_eq!(refitted.machine(), expected.machine());
    }

    #[test]
    fn when_nothing_lies_on_the_positive_side_the_positives_alone_decide() {
        // Equal rows under both labels: the two-class machine is zero everywhere.
        let rows = vec![vec![1.0, 2.0]; 3];
        let mut svm = Svm::default();
        svm.fit(&rows, &rows).unwrap();
        assert!(svm.contains(&rows[0]) && !svm.contains(&[9.0, 9.0]));
    }

    #[test]
    fn a_single_example_is_inside_its_own_set() {
        let mut svm = Svm::default();
        svm.fit(&[vec![0.3, 0.7]], &[]).unwrap();
        assert!(svm.contains(&[0.3, 0.7]) && !svm.contains(&[1.3, 0.7]));
    }

    #[test]
    fn a_failed_fit_keeps_what_was_learned() {
        let mut svm = Svm::default();
        svm.fit(&grid(3, 0.0), &[]).unwrap();
        let before = svm.score(&[1.0, 1.0]);
        assert_eq!(svm.fit(&[], &grid(2, 0.0)), Err(Unfit::NoSamples));
        let bad = svm.fit(&grid(2, 0.0), &[vec![0.0, f32::NAN]]);
        assert_eq!(bad, Err(Unfit::NotFinite { row: 4, column: 1 }));
        assert_eq!(svm.score(&[1.0, 1.0]), before);
    }

    #[test]
    fn nearest_is_exact_at_its_edges() {
        let mut set = Nearest::new(1.0);
        assert_eq!(set.score(&[0.0, 0.0]), f32::NEG_INFINITY);
        set.fit(&[vec![0.0, 0.0]], &[vec![0.0, 2.0]]).unwrap();
        assert!(set.contains(&[0.0, 0.0]) && set.contains(&[1.0, 0.0]), "within the radius, which counts");
        assert!(!set.contains(&[1.01, 0.0]), "beyond the radius");
        assert!(!set.contains(&[0.0, 1.0]), "as near to the negative");
        let mut exact = Nearest::new(0.0);
        exact.fit(&[vec![3.0]], &[]).unwrap();
        assert!(exact.contains(&[3.0]) && !exact.contains(&[3.1]));
        assert_eq!(exact.fit(&[], &[]), Err(Unfit::NoSamples));
    }

    #[test]
    fn checkpoints_restore_scores() {
        let mut svm = Svm::default();
        svm.fit(&grid(4, 0.0), &grid(2, 8.0)).unwrap();
        let mut near = Nearest::new(1.5);
        near.fit(&grid(2, 0.0), &grid(1, 5.0)).unwrap();
        let (mut svm_again, mut near_again) = (Svm::default(), Nearest::new(1.5));
        let pairs: [(&dyn Classifier, &mut dyn Classifier); 2] =
            [(&svm, &mut svm_again), (&near, &mut near_again)];
        for (saved, restored) in pairs {
            let mut bag = Bag::default();
            saved.save(&mut bag);
            restored.load(&bag).unwrap();
            assert_eq!(restored.score(&[1.2, 0.4]), saved.score(&[1.2, 0.4]));
        }
    }

    #[test]
    fn a_configuration_is_read_strictly() {
        let read = |text: &str| serde_json::from_str::<SvmConfig>(text).map_err(|error| error.to_string());
        assert_eq!(read("{}").unwrap(), SvmConfig::default());
        let config = read(r#"{"gamma": 2, "nu": 0.05, "two_class": "plain"}"#).unwrap();
        assert_eq!((config.gamma, config.two_class), (Gamma::Value(2.0), TwoClassRule::Plain));
        let text = serde_json::to_string(&SvmConfig::default()).unwrap();
        assert_eq!(read(&text).unwrap(), SvmConfig::default());
        assert!(read(r#"{"mu": 1}"#).unwrap_err().contains("mu"));
        assert!(read(r#"{"gamma": "wide"}"#).unwrap_err().contains(r#""scale", "auto" or a number above 0"#));
        assert!(read(r#"{"gamma": -1}"#).is_err());
        assert_eq!(SvmConfig::default().check(), Ok(()));
        assert_eq!(SvmConfig { nu: 2.0, ..SvmConfig::default() }.check(), Err(Unfit::Nu(2.0)));
        assert_eq!(SvmConfig { c: -1.0, ..SvmConfig::default() }.check(), Err(Unfit::Cost(-1.0)));
    }
}
