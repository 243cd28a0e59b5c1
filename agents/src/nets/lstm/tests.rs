use super::*;
use crate::nets::Backend;
use burn::tensor::activation;
use inroads_envs::Seed;
use rand::RngExt;

const INPUTS: usize = 3;
const WIDTH: usize = 5;
/// Five sequences of 6, 6, 4, 1 and no steps.
const SIZES: [usize; 6] = [4, 3, 3, 3, 2, 2];
const ROWS: usize = 17;

fn lstm() -> Lstm {
    Lstm::new(INPUTS, WIDTH, &Backend::of_tests().plain(), &mut Seed(3).stream("weights", 0))
}

fn numbers(purpose: &str, n: usize) -> Vec<f32> {
    let mut rng = Seed(7).stream(purpose, 0);
    (0..n).map(|_| rng.random_range(-1.0..1.0)).collect()
}

fn start() -> State {
    State { hidden: numbers("hidden", 5 * WIDTH), cell: numbers("cell", 5 * WIDTH) }
}

fn read(values: &[f32]) -> Tensor<2> {
    rows(values.to_vec(), INPUTS, &Backend::of_tests().plain())
}

/// The same cell of Burn's operations: what is put out, a row a step of a sequence.
pub(in crate::nets) fn in_burn(
    lstm: &Lstm,
    read: Tensor<2>,
    sizes: &[usize],
    start: (Tensor<2>, Tensor<2>),
) -> Tensor<2> {
    let width = lstm.width();
    let (mut hidden, mut cell) = start;
    let (mut first, mut out) = (0, Vec::new());
    for &count in sizes {
        let now = read.clone().slice([first..first + count]);
        let going_on = |t: Tensor<2>| t.slice([0..count]);
        let gates = lstm.layers[0].forward(now) + lstm.layers[1].forward(going_on(hidden));
        let gate = |k: usize| gates.clone().slice([0..count, k * width..(k + 1) * width]);
        let [input, forget, output] = [0, 1, 3].map(|k| activation::sigmoid(gate(k)));
        cell = forget * going_on(cell) + input * activation::tanh(gate(2));
        hidden = output * activation::tanh(cell.clone());
        out.push(hidden.clone());
        first += count;
    }
    Tensor::cat(out, 0)
}

fn assert_near(ours: &[f32], theirs: &[f32], what: &str) {
    assert_eq!(ours.len(), theirs.len(), "{what}");
    let largest = theirs.iter().fold(0.0_f32, |most, x| most.max(x.abs()));
    assert!(largest > 0.0, "{what} is all zeros");
    for (a, b) in ours.iter().zip(theirs) {
        assert!((a - b).abs() <= 2e-6 * largest.max(1.0), "{what}: {a} {b}");
    }
}

#[test]
fn it_puts_out_and_descends_as_burns_own_operations_do() {
    let (lstm, x, slopes) = (lstm(), numbers("read", ROWS * INPUTS), numbers("slopes", ROWS * WIDTH));
    let trace = lstm.forward(read(&x), &SIZES, start());

    let device = Backend::of_tests().plain();
    let tracked = lstm.clone().train();
    let leaf = |values: Vec<f32>, width| rows(values, width, &device).autodiff().require_grad();
    let (by_read, hidden, cell) =
        (leaf(x.clone(), INPUTS), leaf(start().hidden, WIDTH), leaf(start().cell, WIDTH));
    let out = in_burn(&tracked, by_read.clone(), &SIZES, (hidden.clone(), cell.clone()));
    assert_near(&trace.hidden, &floats(out.clone().inner()), "what is put out");

    let grads = (out * rows(slopes.clone(), WIDTH, &device).autodiff()).sum().backward();
    let ours = lstm.backward(trace, read(&x), &SIZES, &slopes);
    let theirs = |layer: usize| floats(tracked.layers[layer].weight.val().grad(&grads).unwrap());
    let bias = tracked.layers[0].bias.as_ref().unwrap().val().grad(&grads).unwrap();
    let of = |leaf: &Tensor<2>| floats(leaf.grad(&grads).unwrap());
    assert_near(&floats(ours.input), &theirs(0), "dWx");
    assert_near(&floats(ours.recurrent), &theirs(1), "dWh");
    assert_near(&floats(ours.bias), &floats(bias), "db");
    assert_near(&floats(ours.read), &of(&by_read), "dX");
    // Of the sequence without steps nobody asks.
    assert_near(&ours.start.hidden, &of(&hidden)[..4 * WIDTH], "dh0");
    assert_near(&ours.start.cell, &of(&cell)[..4 * WIDTH], "dc0");
}

#[test]
fn the_derivatives_are_those_of_finite_differences() {
    let (x, slopes) = (numbers("read", ROWS * INPUTS), numbers("slopes", ROWS * WIDTH));
    let (lstm, device) = (lstm(), Backend::of_tests().plain());
    let value = |lstm: &Lstm, x: &[f32], start: State| {
        let hidden = lstm.forward(read(x), &SIZES, start).hidden;
        hidden.iter().zip(&slopes).map(|(h, slope)| f64::from(h * slope)).sum::<f64>()
    };
    let ours = lstm.backward(lstm.forward(read(&x), &SIZES, start()), read(&x), &SIZES, &slopes);
    const STEP: f32 = 0.01;
    let near = |ours: f32, value: &dyn Fn(f32) -> f64, what: &str| {
        let found = (value(STEP) - value(-STEP)) / f64::from(2.0 * STEP);
        assert!((f64::from(ours) - found).abs() < 2e-3, "{what}: {ours} {found}");
    };
    let nudged = |values: &[f32], i: usize, by: f32| {
        let mut values = values.to_vec();
        values[i] += by;
        values
    };
    let by = [floats(ours.input.clone()), floats(ours.recurrent.clone()), floats(ours.bias.clone())];
    let parts = [(0, INPUTS * 4 * WIDTH), (1, WIDTH * 4 * WIDTH), (2, 4 * WIDTH)];
    let weights: Vec<Vec<f32>> = [
        floats(lstm.layers[0].weight.val()),
        floats(lstm.layers[1].weight.val()),
        floats(lstm.layers[0].bias.as_ref().unwrap().val()),
    ]
    .into();
    let made = |weights: &[Vec<f32>]| {
        let input = init::layer(weights[0].clone(), weights[2].clone(), &device);
        let recurrent = init::layer(weights[1].clone(), vec![0.0; 4 * WIDTH], &device);
        Lstm { layers: vec![input, Linear { bias: None, ..recurrent }] }
    };
    for (part, n) in parts {
        for i in (0..n).step_by(3) {
            let value = |by: f32| {
                let mut weights = weights.clone();
                weights[part] = nudged(&weights[part], i, by);
                value(&made(&weights), &x, start())
            };
            near(by[part][i], &value, ["dWx", "dWh", "db"][part]);
        }
    }
    let by_read = floats(ours.read);
    for i in 0..ROWS * INPUTS {
        near(by_read[i], &|by| value(&lstm, &nudged(&x, i, by), start()), "dX");
    }
    for i in 0..4 * WIDTH {
        let from = |by| State { hidden: nudged(&start().hidden, i, by), ..start() };
        near(ours.start.hidden[i], &|by| value(&lstm, &x, from(by)), "dh0");
        let from = |by| State { cell: nudged(&start().cell, i, by), ..start() };
        near(ours.start.cell[i], &|by| value(&lstm, &x, from(by)), "dc0");
    }
}

#[test]
fn twenty_steps_and_twenty_more_are_forty() {
    let lstm = lstm();
    let x = numbers("read", 2 * 40 * INPUTS);
    let first = State { hidden: numbers("hidden", 2 * WIDTH), cell: numbers("cell", 2 * WIDTH) };
    let all = lstm.forward(read(&x), &[2; 40], first.clone());
    let (early, late) = x.split_at(x.len() / 2);
    let half = lstm.forward(read(early), &[2; 20], first);
    let rest = lstm.forward(read(late), &[2; 20], half.end(&[2; 20]));
    for (a, b) in all.hidden.iter().zip(half.hidden.iter().chain(&rest.hidden)) {
        assert!((a - b).abs() < 1e-6, "{a} {b}");
    }
    assert_eq!(rest.end(&[2; 20]).hidden, rest.hidden[rest.hidden.len() - 2 * WIDTH..]);
}

#[test]
fn each_sequence_ends_where_it_ends() {
    let lstm = lstm();
    let x = numbers("read", ROWS * INPUTS);
    let end = lstm.forward(read(&x), &SIZES, start()).end(&SIZES);
    let row = |values: &[f32], i: usize| values[i * WIDTH..(i + 1) * WIDTH].to_vec();
    // The one without steps is where it was; the one of one step where that step led.
    assert_eq!(row(&end.hidden, 4), row(&start().hidden, 4));
    let one = State { hidden: row(&start().hidden, 3), cell: row(&start().cell, 3) };
    let alone = lstm.forward(read(&x[3 * INPUTS..4 * INPUTS]), &[1], one);
    for (a, b) in row(&end.cell, 3).iter().zip(&alone.cells) {
        assert!((a - b).abs() < 1e-6, "{a} {b}");
    }
}

#[test]
fn a_cell_begins_by_remembering() {
    let bias = floats(lstm().layers[0].bias.as_ref().unwrap().val());
    let bound = init::bound(WIDTH);
    let within = |values: &[f32], centre: f32| values.iter().all(|b| (b - centre).abs() <= bound);
    assert!(
        within(&bias[WIDTH..2 * WIDTH], 1.0)
            && within(&bias[..WIDTH], 0.0)
            && within(&bias[2 * WIDTH..], 0.0)
    );
}
