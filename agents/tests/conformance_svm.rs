//! Support vector machines against scikit-learn's on the same samples.
//!
//! Every record is a data set with one- and two-class machines fitted to it, at the usual tolerance and at a very
//! small one. At the small one the optimum is compared; at the usual one two solvers may stop at different points
//! near it, so the comparison allows what the tolerance allows.

#[path = "../../tests/support/fixtures.rs"]
mod fixtures;

use inroads_agents::svm::{ClassWeights, Gamma, Machine, OneClass, TwoClass};
use serde::Deserialize;

#[derive(Deserialize)]
struct DataSet {
    name: String,
    #[serde(rename = "X")]
    rows: Vec<Vec<f64>>,
    y: Vec<i64>,
    #[serde(rename = "Q")]
    queries: Vec<Vec<f64>>,
    models: Vec<Reference>,
}

#[derive(Deserialize)]
struct Reference {
    #[serde(rename = "type")]
    kind: String,
    nu: Option<f64>,
    #[serde(rename = "C")]
    c: Option<f64>,
    class_weight: Option<String>,
    gamma: f64,
    tol: f64,
    intercept: f64,
    decision: Vec<f64>,
    n_sv: Option<usize>,
    predict: Option<Vec<i64>>,
    train_predict: Option<Vec<i64>>,
}

impl Reference {
    /// Our machine of the same kind. Its gamma is left to our own rule: the references use "scale".
    fn fit(&self, data: &DataSet) -> Machine {
        let (gamma, tolerance) = (Gamma::Scale, self.tol);
        let machine = match self.kind.as_str() {
            "OneClassSVM" => {
                let nu = self.nu.expect("a one-class machine has a nu");
                OneClass { nu, gamma, tolerance }.fit(&data.rows)
            }
            "SVC" => {
                let c = self.c.expect("a two-class machine has a C");
                let balanced = self.class_weight.as_deref() == Some("balanced");
                let classes = if balanced { ClassWeights::Balanced } else { ClassWeights::Equal };
                let labels: Vec<bool> = data.y.iter().map(|y| *y == 1).collect();
                TwoClass { c, classes, gamma, tolerance }.fit(&data.rows, &labels)
            }
            other => panic!("{}: there is no {other} here", data.name),
        };
        machine.unwrap_or_else(|why| panic!("{}: {why}", data.name))
    }

    /// How far a value may be off: a few tolerances and, at the small tolerance, rounding; in units of the largest
    /// value there is.
    fn allowed(&self) -> f64 {
        let scale =
            self.decision.iter().fold(self.intercept.abs().max(1.0), |most, value| most.max(value.abs()));
        (4.0 * self.tol + 1e-6) * scale
    }
}

/// What disagrees, and how many labels were far enough from the edge to be compared.
#[derive(Default)]
struct Tally {
    wrong: Vec<String>,
    labels: usize,
    compared: usize,
}

impl Tally {
    fn compare(&mut self, data: &DataSet, reference: &Reference) {
        let (machine, allowed) = (reference.fit(data), reference.allowed());
        let Reference { kind, nu, tol, .. } = reference;
        let case = format!("{}, {kind}, nu {nu:?}, tolerance {tol}", data.name);

        if (machine.gamma / reference.gamma - 1.0).abs() > 1e-9 {
            self.wrong.push(format!("{case}: gamma is {} but {} there", machine.gamma, reference.gamma));
        }
        // The intercept is added to the sum over the support vectors; rho is taken from it.
        if (machine.rho + reference.intercept).abs() > allowed {
            self.wrong.push(format!("{case}: rho is {} but {} there", machine.rho, -reference.intercept));
        }
        for (query, expected) in data.queries.iter().zip(&reference.decision) {
            let found = machine.decision(query);
            if (found - expected).abs() > allowed {
                self.wrong.push(format!("{case}: f({query:?}) is {found} but {expected} there"));
            }
        }
        if let Some(expected) = reference.n_sv {
            let found = machine.support.len();
            if found.abs_diff(expected) > 4 + expected / 10 {
                self.wrong.push(format!("{case}: {found} support vectors but {expected} there"));
            }
        }
        for (rows, labels) in [(&data.queries, &reference.predict), (&data.rows, &reference.train_predict)] {
            for (row, label) in rows.iter().zip(labels.iter().flatten()) {
                let found = machine.decision(row);
                self.labels += 1;
                if found.abs() > allowed {
                    self.compared += 1;
                    if (found > 0.0) != (*label == 1) {
                        self.wrong.push(format!("{case}: f({row:?}) is {found} but the label {label} there"));
                    }
                }
            }
        }
    }
}

#[test]
fn conformance_svm_agrees_with_scikit_learn() {
    let records = fixtures::records("svm", "");
    assert!(!records.is_empty(), "there are no records of the family svm");
    let mut tally = Tally::default();
    for record in records {
        let data: DataSet = serde_json::from_value(record).expect("a record of the family svm");
        assert!(!data.models.is_empty(), "{}: no machines to compare with", data.name);
        for reference in &data.models {
            tally.compare(&data, reference);
        }
    }
    let Tally { wrong, labels, compared } = tally;
    let first = &wrong[..wrong.len().min(20)];
    assert!(wrong.is_empty(), "{} disagree, the first of them:\n{}", wrong.len(), first.join("\n"));
    assert!(compared * 10 > labels * 8, "only {compared} of {labels} labels could be compared");
}
