//! Least-squares policy iteration held against answers that are known.

use inroads_envs::{Rng, Seed};
use rand::RngExt;

use super::{
    Batch, Lspi, LspiError, Projection, Rows, Task,
    bellman::{self, Case},
    greedy,
};

const LEFT: usize = 0;
const RIGHT: usize = 1;

/// A chain of states 0 to 3 and the goal, 4, one-hot: each action of each state once, the goal to the right of 3.
fn chain() -> Rows {
    let hot = |state: usize| std::array::from_fn::<f32, 5, _>(|at| f32::from(u8::from(at == state)));
    let mut rows = Rows::new(5);
    for state in 0..4 {
        rows.push(&hot(state), LEFT, &hot(state.saturating_sub(1)), false);
        rows.push(&hot(state), RIGHT, &hot(state + 1), false);
    }
    rows
}

/// The only row of the chain that reaches the goal.
const INTO_GOAL: usize = 7;

fn settings(ridge: f64) -> Lspi {
    Lspi { gamma: 0.9, ridge, tolerance: 1e-9, ..Lspi::default() }
}

/// LSTDQ for a policy: the white solution, and the values of left and right in states 0 to 3.
fn evaluate(lspi: &Lspi, batch: &Batch, task: &Task, policy: &[u16]) -> (Vec<f64>, [[f32; 4]; 2]) {
    let case: Case<'_> = task.case(policy, 1.0);
    let guess = vec![0.0; batch.stride * batch.choices()];
    let white = bellman::solve(batch, &[case], &[guess], lspi.tolerance, lspi.products).remove(0);
    let values = table(batch, &white);
    (white, values)
}

/// The values of left and right in states 0 to 3.
fn table(batch: &Batch, white: &[f64]) -> [[f32; 4]; 2] {
    let weights = bellman::plain(batch, white);
    [LEFT, RIGHT].map(|action| std::array::from_fn(|state| weights[action * batch.stride + state]))
}

fn near(found: [f32; 4], expected: [f32; 4]) {
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-5, "{found} is not {expected}");
    }
}

#[test]
fn a_chain_has_the_values_of_its_policies() {
    // The Gram matrix is the identity but for the goal, which no row comes from: the ridge has to be, but may be tiny.
    let lspi = settings(1e-9);
    let batch = lspi.batch(&chain(), 2).unwrap();
    let task = lspi.task(&batch, &[INTO_GOAL]);
    let (_, [left, right]) = evaluate(&lspi, &batch, &task, &[RIGHT as u16; 8]);
    near(right, [0.729, 0.81, 0.9, 1.0]);
    near(left, [0.6561, 0.6561, 0.729, 0.81]);
    let (_, [left, right]) = evaluate(&lspi, &batch, &task, &[LEFT as u16; 8]);
    near(right, [0.0, 0.0, 0.0, 1.0]);
    near(left, [0.0; 4]);
}

#[test]
fn a_ridge_shrinks_values_as_it_must() {
    // 0.1 on the diagonal: the mean of the Gram matrix' diagonal is 4/5, ones in 4 of 5 states.
    let lspi = settings(0.125);
    let batch = lspi.batch(&chain(), 2).unwrap();
    let task = lspi.task(&batch, &[INTO_GOAL]);
    let (_, [_, right]) = evaluate(&lspi, &batch, &task, &[RIGHT as u16; 8]);
    assert!((right[3] - 0.909_091).abs() < 1e-5 && (right[0] - 0.497_917).abs() < 1e-5, "{right:?}");
}

#[test]
fn a_second_solve_carries_values_one_state_further() {
    let lspi = settings(1e-9);
    let batch = lspi.batch(&chain(), 2).unwrap();
    let task = lspi.task(&batch, &[INTO_GOAL]);
    let left = [LEFT as u16; 8];
    let (white, _) = evaluate(&lspi, &batch, &task, &left);
    let [better, worse] = greedy(&batch, &bellman::plain(&batch, &white), &left);
    let (_, [_, right]) = evaluate(&lspi, &batch, &task, &better);
    near(right, [0.0, 0.0, 0.9, 1.0]);
    // Who avoids the goal has nothing better than to stay with left, where nothing happens.
    assert_eq!(worse, left);
    // So the whole policy takes as many solves as there are states.
    let mut policy = left.to_vec();
    let values = [[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.9, 1.0], [0.0, 0.81, 0.9, 1.0], [0.729, 0.81, 0.9, 1.0]];
    for expected in values {
        let (white, [_, right]) = evaluate(&lspi, &batch, &task, &policy);
        near(right, expected);
        [policy, _] = greedy(&batch, &bellman::plain(&batch, &white), &policy);
    }
}

#[test]
fn a_policy_at_random_is_the_mean_over_its_actions() {
    let lspi = settings(1e-9);
    let batch = lspi.batch(&chain(), 2).unwrap();
    let task = lspi.task(&batch, &[INTO_GOAL]);
    let [left, right] = table(&batch, &lspi.first(&batch, &[task])[0]);
    // V(s) = (Q(s, left) + Q(s, right)) / 2 solves V(s) = 0.45 (V(s−1) + V(s+1)) with "V(4)" = 1/0.9.
    let value: Vec<f32> = (0..4).map(|state| f32::midpoint(left[state], right[state])).collect();
    for state in 0..4 {
        let after = if state == 3 { 1.0 / 0.9 } else { value[state + 1] };
        let expected = 0.45 * (value[state.saturating_sub(1)] + after);
        assert!((value[state] - expected).abs() < 1e-5, "{value:?}");
    }
    assert!(value[0] > 0.05 && value[3] > 0.5);
}

#[test]
fn seek_and_avoid_are_shown_for_what_occurs_only_and_have_their_signs() {
    let lspi = settings(1e-6);
    let batch = lspi.batch(&chain(), 2).unwrap();
    let mut shown = Vec::new();
    let events = [vec![], vec![INTO_GOAL], vec![]];
    lspi.solve(&batch, &events, &mut Seed(0).stream("ties", 0), |event, values| {
        shown.push((event, values.seek.to_vec(), values.avoid.to_vec()));
    });
    let [(event, seek, avoid)] = &shown[..] else { panic!("{shown:?}") };
    assert_eq!(*event, 1);
    assert_eq!((seek[INTO_GOAL], avoid[INTO_GOAL]), (1.0, -1.0));
    for row in 0..INTO_GOAL {
        // After each row, in the state it leads to: left of it, or right of it.
        let state = if row % 2 == LEFT { (row / 2).saturating_sub(1) } else { row / 2 + 1 };
        assert!((seek[row] - 0.9_f32.powi(3 - state as i32)).abs() < 1e-4, "{seek:?}");
        assert!((-1e-4..=0.0).contains(&avoid[row]), "{avoid:?}");
    }
}

#[test]
fn equal_transitions_are_counted_not_repeated() {
    let (once, mut twice) = (chain(), chain());
    for at in 0..once.len() {
        twice.push(once.before(at), once.action(at), once.after(at), once.terminal(at));
    }
    let lspi = settings(1e-3);
    let values = |rows: &Rows, event: Vec<usize>| {
        let batch = lspi.batch(rows, 2).unwrap();
        assert_eq!(batch.distinct(), 8);
        let mut seek = Vec::new();
        let mut show = |_, values: super::Values<'_>| seek = values.seek[..8].to_vec();
        lspi.solve(&batch, &[event], &mut Seed(0).stream("ties", 0), &mut show);
        seek
    };
    let (a, b) = (values(&once, vec![INTO_GOAL]), values(&twice, vec![INTO_GOAL, INTO_GOAL + 8]));
    a.iter().zip(&b).for_each(|(a, b)| assert!((a - b).abs() < 1e-6, "{a} {b}"));
    // Of two equal transitions one brings it about: a half, and with the other half of the value of the goal, 0.
    let half = values(&twice, vec![INTO_GOAL]);
    assert!((half[5] - 0.5).abs() < 2e-3, "{half:?}");
}

#[test]
fn nothing_comes_after_the_end() {
    let mut rows = Rows::new(1);
    rows.push(&[1.0], 0, &[1.0], true);
    rows.push(&[1.0], 1, &[1.0], false);
    let lspi = settings(1e-9);
    let batch = lspi.batch(&rows, 2).unwrap();
    let mut seek = Vec::new();
    lspi.solve(&batch, &[vec![1]], &mut Seed(0).stream("ties", 0), |_, values| seek = values.seek.to_vec());
    assert_eq!(seek, [0.0, 1.0]);
}

/// A walk on 4 by 4 cells, a timer to 20 that begins again, and a coin that is thrown in every step; one-hot. The first 16
/// events are being in a cell, the next 21 the timer's readings; then the coin, and what never occurs.
fn walk(steps: usize, rng: &mut Rng) -> (Rows, Vec<Vec<usize>>) {
    const WIDTH: usize = 16 + 21 + 2;
    let mut rows = Rows::new(WIDTH);
    let mut events = vec![Vec::new(); 16 + 21 + 1 + 1];
    let (mut x, mut y, mut timer, mut coin) = (0, 0, 0, 0);
    let write = |x: usize, y: usize, timer: usize, coin: usize| {
        let mut row = [0.0; WIDTH];
        [4 * y + x, 16 + timer, 37 + coin].into_iter().for_each(|hot| row[hot] = 1.0);
        row
    };
    for at in 0..steps {
        let (before, action) = (write(x, y, timer, coin), rng.random_range(0..4));
        match action {
            0 => x = (x + 1).min(3),
            1 => x = x.saturating_sub(1),
            2 => y = (y + 1).min(3),
            _ => y = y.saturating_sub(1),
        }
        (timer, coin) = ((timer + 1) % 21, rng.random_range(0..2));
        rows.push(&before, action, &write(x, y, timer, coin), false);
        events[4 * y + x].push(at);
        events[16 + timer].push(at);
        if coin == 1 {
            events[37].push(at);
        }
    }
    (rows, events)
}

/// Mean of seek minus mean of avoiding's cost, for every event; none for what the batch does not have.
fn gaps(features: usize, ridge: f64) -> (Vec<Option<f32>>, bool) {
    let mut rng = Seed(3).stream("walk", 0);
    let (rows, events) = walk(4000, &mut rng);
    let lspi = Lspi { features, ridge, ..Lspi::default() };
    let projection = Projection::fit(&rows, features, &mut rng);
    let batch = lspi.batch(&projection.project(&rows), 4).unwrap();
    let mut gaps = vec![None; events.len()];
    lspi.solve(&batch, &events, &mut rng, |event, values| {
        let sum: f32 = values.seek.iter().zip(values.avoid).map(|(seek, avoid)| seek + avoid).sum();
        gaps[event] = Some(sum / rows.len() as f32);
    });
    (gaps, projection.narrow())
}

#[test]
fn places_are_controllable_a_timer_and_a_coin_are_not() {
    let (gaps, narrow) = gaps(100, 1e-3);
    assert!(!narrow);
    let between = |range: std::ops::Range<usize>, low: f32, high: f32| {
        for gap in &gaps[range] {
            assert!(gap.is_some_and(|gap| (low..high).contains(&gap)), "{gap:?} not in {low}..{high}");
        }
    };
    between(0..16, 0.7, 1.0);
    between(16..37, -0.05, 0.05);
    between(37..38, -0.05, 0.05);
    assert_eq!(gaps[38], None, "what never occurs is not solved for");
}

#[test]
fn too_few_features_are_told() {
    // 1 + 15 + 20 + 1 directions that the observations have.
    let mut rng = Seed(3).stream("walk", 0);
    let (rows, _) = walk(4000, &mut rng);
    for (asked, features, narrow) in [(16, 16, true), (36, 36, true), (37, 37, false), (100, 37, false)] {
        let projection = Projection::fit(&rows, asked, &mut rng);
        assert_eq!((projection.features(), projection.narrow()), (features, narrow));
    }
}

#[test]
fn features_are_white_and_the_first_is_constant() {
    let mut rng = Seed(4).stream("walk", 0);
    let (rows, _) = walk(1000, &mut rng);
    let features = Projection::fit(&rows, 100, &mut rng).project(&rows);
    let all: Vec<&[f32]> = (0..rows.len()).flat_map(|at| [features.before(at), features.after(at)]).collect();
    assert!(all.iter().all(|row| (row[0] - 1.0).abs() < 1e-6));
    for i in 0..features.width() {
        for j in 0..features.width() {
            let mean = all.iter().map(|row| f64::from(row[i] * row[j])).sum::<f64>() / all.len() as f64;
            assert!((mean - f64::from(u8::from(i == j))).abs() < 1e-4, "{i} {j} {mean}");
        }
    }
}

#[test]
fn the_same_stream_gives_the_same_values() {
    assert_eq!(gaps(30, 1e-3), gaps(30, 1e-3));
}

#[test]
fn what_cannot_be_learned_from_is_an_error() {
    let lspi = Lspi::default();
    assert_eq!(lspi.batch(&Rows::new(3), 2).unwrap_err(), LspiError::Nothing);
    assert_eq!(lspi.batch(&chain(), 1).unwrap_err(), LspiError::Action { action: 1, choices: 1 });
    let mut rows = Rows::new(1);
    rows.push(&[f32::NAN], 0, &[0.0], false);
    assert_eq!(lspi.batch(&rows, 1).unwrap_err(), LspiError::Singular);
    assert_eq!(lspi.check(), Ok(()));
    let wrong = [
        Lspi { features: 1, ..lspi.clone() },
        Lspi { gamma: 1.0, ..lspi.clone() },
        Lspi { ridge: 0.0, ..lspi.clone() },
        Lspi { tolerance: 0.0, ..lspi.clone() },
        Lspi { products: 0, ..lspi },
    ];
    for (settings, name) in wrong.iter().zip(["features", "gamma", "ridge", "tolerance", "products"]) {
        assert!(settings.check().unwrap_err().starts_with(name));
    }
}
