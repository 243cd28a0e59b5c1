//! Values from libsvm through scikit-learn, and what holds for every machine.

use super::*;

const ROWS: [[f64; 2]; 10] = [
    [0.0, 0.0],
    [1.0, 0.0],
    [0.0, 1.0],
    [1.0, 1.0],
    [2.0, 1.0],
    [1.0, 2.0],
    [2.0, 2.0],
    [0.5, 0.5],
    [3.0, 3.0],
    [-1.0, 0.0],
];
const LABELS: [bool; 10] = [false, false, false, true, true, true, true, false, true, false];
const QUERIES: [[f64; 2]; 4] = [[0.5, 0.4], [3.0, 3.0], [5.0, 5.0], [1.5, 1.5]];

fn rows() -> Vec<Vec<f64>> {
    ROWS.iter().map(|row| row.to_vec()).collect()
}

fn one_class(nu: f64) -> OneClass {
    OneClass { nu, gamma: Gamma::Value(0.5), tolerance: 1e-9 }
}

fn two_class() -> TwoClass {
    TwoClass { gamma: Gamma::Value(0.5), tolerance: 1e-9, ..TwoClass::default() }
}

#[track_caller]
fn assert_near(found: f64, expected: f64) {
    assert!((found - expected).abs() < 2e-6, "{found} is not {expected}");
}

#[track_caller]
fn assert_values(machine: &Machine, rho: f64, values: [f64; 4]) {
    assert_near(machine.rho, rho);
    for (query, value) in QUERIES.iter().zip(values) {
        assert_near(machine.decision(query), value);
    }
}

/// Numbers in [0, 1), the same each time.
fn numbers(mut seed: u64) -> impl FnMut() -> f64 {
    move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn cloud(seed: u64, n: usize, width: usize) -> Vec<Vec<f64>> {
    let mut number = numbers(seed);
    // A sum of uniforms has a middle and sides, as states do.
    (0..n).map(|_| (0..width).map(|_| number() + number() + number()).collect()).collect()
}

#[test]
fn one_class_machines_agree_with_libsvm() {
    let fit = |nu| one_class(nu).fit(&rows()).unwrap();
    assert_values(&fit(0.1), 0.280_337, [0.036_305, 0.0, -0.275_652, 0.041_933]);
    assert_values(&fit(0.3), 0.841_010, [0.108_914, 0.0, -0.826_956, 0.125_798]);
    let half = fit(0.5);
    assert_values(&half, 1.553_098, [0.199_995, -0.367_617, -1.534_757, 0.242_065]);
    // The fourth row's coefficient is zero: it is no support vector.
    let expected = [0.032_406, 0.857_915, 0.440_248, 0.685_719, 0.821_054, 0.162_658, 0.0, 1.0, 1.0];
    let found =
        |row: [f64; 2]| half.support.iter().position(|v| v == &row).map_or(0.0, |i| half.coefficients[i]);
    for (row, beta) in ROWS.iter().enumerate().filter(|(i, _)| *i != 3).map(|(_, row)| *row).zip(expected) {
        assert_near(found(row), beta);
    }
    assert_near(found(ROWS[3]), 0.0);
}

#[test]
fn two_class_machines_agree_with_libsvm() {
    let fit = |settings: TwoClass| settings.fit(&rows(), &LABELS).unwrap();
    assert_values(&fit(two_class()), -0.101_292, [-1.077_645, 1.0, 0.115_531, 1.199_432]);
    let scaled = fit(TwoClass { gamma: Gamma::Scale, ..two_class() });
    assert_values(&scaled, -0.108_667, [-1.076_876, 1.0, 0.126_672, 1.186_812]);
    let classes = ClassWeights::Given { negative: 1.0, positive: 5.0 };
    let heavy = fit(TwoClass { c: 10.0, classes, ..two_class() });
    assert_values(&heavy, -0.084_962, [-1.166_735, 1.0, 0.100_401, 1.952_164]);
    let mut weights = [1.0; 10];
    weights[8..].fill(0.1);
    let weighted = two_class().fit_weighted(&rows(), &LABELS, &weights).unwrap();
    assert_values(&weighted, 0.039_283, [-1.079_802, 0.207_537, -0.037_445, 1.207_810]);
}

#[test]
fn gamma_follows_the_variance_of_all_entries() {
    let samples = Samples::read(&rows()).unwrap();
    assert_near(Gamma::Scale.on(&samples).unwrap(), 0.465_116);
    assert_eq!(Gamma::Auto.on(&samples), Ok(0.5));
    let constant = Samples::read(&vec![vec![0.1, 0.1]; 7]).unwrap();
    assert_eq!(Gamma::Scale.on(&constant), Ok(1.0));
    let huge = Samples::read(&[vec![1e200], vec![-1e200]]).unwrap();
    assert_eq!(Gamma::Scale.on(&huge), Err(Unfit::Gamma(0.0)));
}

#[test]
fn nu_lies_between_the_share_outside_and_the_share_of_support_vectors() {
    for seed in 0..20 {
        let n = 30 + 7 * seed as usize;
        let rows = cloud(seed, n, 1 + seed as usize % 4);
        for nu in [0.03, 0.1, 0.4, 0.8, 1.0] {
            let machine = OneClass { nu, tolerance: 1e-6, ..OneClass::default() }.fit(&rows).unwrap();
            let outside = rows.iter().filter(|row| machine.decision(row) < -1e-5).count() as f64;
            assert!(outside <= nu * n as f64 + 1e-9, "{outside} of {n} outside at {nu}");
            assert!(machine.support.len() as f64 >= nu * n as f64 - 1e-9);
            let total: f64 = machine.coefficients.iter().sum();
            assert!((total - nu * n as f64).abs() < 1e-9);
        }
    }
}

/// Whatever pair the solver chose, the solution must satisfy the optimality conditions on every sample.
#[test]
fn two_class_solutions_are_optimal_and_balanced() {
    for seed in 0..10 {
        let rows = cloud(seed, 80, 2);
        let mut number = numbers(seed + 100);
        let labels: Vec<bool> = rows.iter().map(|row| row[0] + 0.6 * number() > 1.8).collect();
        let machine =
            TwoClass { c: 3.0, tolerance: 1e-8, ..TwoClass::default() }.fit(&rows, &labels).unwrap();
        assert!(machine.coefficients.iter().sum::<f64>().abs() < 1e-9);
        for (row, label) in rows.iter().zip(labels) {
            let sign = if label { 1.0 } else { -1.0 };
            let alpha =
                machine.support.iter().position(|v| v == row).map_or(0.0, |i| machine.coefficients[i] * sign);
            // The solver's kernel is single precision, the machine's double.
            let margin = sign * machine.decision(row);
            assert!((0.0..=3.0).contains(&alpha));
            assert!(alpha == 0.0 || margin < 1.0 + 1e-5, "a sample clear of the margin has no weight");
            assert!(alpha == 3.0 || margin > 1.0 - 1e-5, "a sample inside the margin has all its weight");
        }
    }
}

#[test]
fn a_duplicate_is_a_weight_of_two_and_a_weight_of_zero_is_absence() {
    let twice = |mut rows: Vec<Vec<f64>>| {
        rows.push(ROWS[3].to_vec());
        rows
    };
    let mut double = [1.0; 10];
    double[3] = 2.0;
    let mut absent = [1.0; 11];
    absent[10] = 0.0;
    let mut labels = LABELS.to_vec();
    labels.push(true);
    for query in QUERIES {
        let duplicated = one_class(0.5).fit(&twice(rows())).unwrap();
        let weighted = one_class(0.5).fit_weighted(&rows(), &double).unwrap();
        assert_near(duplicated.decision(&query), weighted.decision(&query));
        let duplicated = two_class().fit(&twice(rows()), &labels).unwrap();
        let weighted = two_class().fit_weighted(&rows(), &LABELS, &double).unwrap();
        assert_near(duplicated.decision(&query), weighted.decision(&query));

        let plain = two_class().fit(&rows(), &LABELS).unwrap();
        let without = two_class().fit_weighted(&twice(rows()), &labels, &absent).unwrap();
        assert_near(plain.decision(&query), without.decision(&query));
        let plain = one_class(0.5).fit(&rows()).unwrap();
        let without = one_class(0.5).fit_weighted(&twice(rows()), &absent).unwrap();
        assert_near(plain.decision(&query), without.decision(&query));
    }
}

#[test]
fn balanced_classes_weigh_the_same_in_sum() {
    let mut labels = LABELS;
    labels[3..6].fill(false);
    let balanced = TwoClass { classes: ClassWeights::Balanced, ..two_class() }.fit(&rows(), &labels).unwrap();
    let classes = ClassWeights::Given { negative: 10.0 / 16.0, positive: 10.0 / 4.0 };
    assert_eq!(balanced, TwoClass { classes, ..two_class() }.fit(&rows(), &labels).unwrap());
}

#[test]
fn degenerate_samples_still_have_a_machine() {
    let line: Vec<Vec<f64>> = (0..40).map(|i| vec![f64::from(i), 2.0 * f64::from(i), 0.0]).collect();
    let sets = [vec![vec![0.1, 7.3]], vec![vec![0.1, 7.3]; 25], vec![vec![4.0, 4.0]; 3], line];
    for rows in &sets {
        for nu in [0.01, 0.5, 1.0] {
            let machine = OneClass { nu, ..OneClass::default() }.fit(rows).unwrap();
            let far = vec![1e6; rows[0].len()];
            assert!(
                machine.rho.is_finite() && machine.decision(&far) < machine.decision(&rows[rows.len() / 2])
            );
        }
    }
    // The same row under both labels: no direction, no blow-up.
    let machine = two_class().fit(&vec![vec![1.0, 1.0]; 4], &[true, true, false, false]).unwrap();
    assert_near(machine.decision(&[1.0, 1.0]), 0.0);
}

#[test]
fn a_thousand_samples_converge() {
    let rows = cloud(7, 1000, 2);
    let (nu, tolerance) = (0.1, 1e-6);
    let machine = OneClass { nu, tolerance, ..OneClass::default() }.fit(&rows).unwrap();
    // At the optimum all coefficients strictly between their bounds sit on the edge.
    for (row, beta) in machine.support.iter().zip(&machine.coefficients) {
        if *beta < 1.0 {
            assert!(machine.decision(row).abs() <= 1e-5);
        }
    }
    assert_eq!(machine, OneClass { nu, tolerance, ..OneClass::default() }.fit(&rows).unwrap());
}

#[test]
fn a_hopeless_tolerance_ends() {
    let rows = cloud(3, 60, 2);
    let exact = OneClass { tolerance: 1e-10, ..OneClass::default() }.fit(&rows).unwrap();
    let hopeless = OneClass { tolerance: f64::MIN_POSITIVE, ..OneClass::default() }.fit(&rows).unwrap();
    assert_near(exact.rho, hopeless.rho);
}

#[test]
fn what_cannot_be_learned_from_is_named() {
    let one = OneClass::default();
    assert_eq!(one.fit::<f64>(&[]), Err(Unfit::NoSamples));
    assert_eq!(one.fit::<f64>(&[vec![], vec![]]), Err(Unfit::NoFeatures));
    let ragged = Unfit::Ragged { row: 1, width: 1, expected: 2 };
    assert_eq!(one.fit(&[vec![1.0, 2.0], vec![1.0]]), Err(ragged));
    assert_eq!(one.fit(&[vec![1.0, f32::NAN]]), Err(Unfit::NotFinite { row: 0, column: 1 }));
    assert_eq!(one.fit_weighted(&rows(), &[0.0; 10]), Err(Unfit::NoSamples));
    for nu in [0.0, -0.1, 1.1] {
        assert_eq!(OneClass { nu, ..one }.fit(&rows()), Err(Unfit::Nu(nu)));
    }
    assert_eq!(OneClass { tolerance: 0.0, ..one }.fit(&rows()), Err(Unfit::Tolerance(0.0)));
    assert_eq!(OneClass { gamma: Gamma::Value(-1.0), ..one }.fit(&rows()), Err(Unfit::Gamma(-1.0)));

    let two = two_class();
    assert_eq!(TwoClass { c: 0.0, ..two }.fit(&rows(), &LABELS), Err(Unfit::Cost(0.0)));
    for positive in [true, false] {
        for classes in [ClassWeights::Equal, ClassWeights::Balanced] {
            let machine = TwoClass { classes, ..two }.fit(&rows(), &[positive; 10]);
            assert_eq!(machine, Err(Unfit::SingleClass { positive }));
        }
    }
    let silent = LABELS.map(f64::from);
    assert_eq!(two.fit_weighted(&rows(), &LABELS, &silent), Err(Unfit::SingleClass { positive: true }));
    let unpaired = Unfit::Unpaired { what: "labels", rows: 10, given: 9 };
    assert_eq!(two.fit(&rows(), &LABELS[..9]), Err(unpaired));
    let mut weights = [1.0; 10];
    weights[4] = -1.0;
    let wrong = two.fit_weighted(&rows(), &LABELS, &weights).unwrap_err();
    assert_eq!(wrong.to_string(), "the weight -1 of row 4 must be finite and not negative");
}
