//! A cell that remembers (LSTM, Hochreiter and Schmidhuber 1997, with the forget gate of Gers 2000) and its gradient
//! through time, written by hand.
//!
//! ```text
//! i, f, o = logistic(x Wx + h Wh + b)    g = tanh(x Wx + h Wh + b)
//! c' = f c + i g                         h' = o tanh c'
//! ```
//!
//! The four gates of a step are one matrix product, and their curves one pass over its rows; everything that is read is one
//! product for all steps, and so are the weights' gradients. In Burn's graph the same takes three times as long
//! (`docs/results/learners.md`).
//!
//! Sequences stand side by side, the longest first: rows go step by step, and within a step sequence by sequence, so the
//! sequences that have a step are the first so many, and no row is padding.

use burn::module::Module;
use burn::nn::Linear;
use burn::optim::GradientsParams;
use burn::tensor::{Device, Tensor};
use inroads_envs::Rng;

use super::squash::{logistic, tanh};
use super::{edit, floats, init, rows};

/// Added to the forget gate's biases, so that a cell begins by remembering (Jozefowicz 2015, section 2.2).
const REMEMBER: f32 = 1.0;

/// The weights of a cell.
#[derive(Module, Debug, Default)]
pub(crate) struct Lstm {
    /// Of what is read, with the biases, and of what was put out before, without: columns of input, forget gate, candidate,
    /// output.
    layers: Vec<Linear>,
}

/// What sequences remember, a row each.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct State {
    /// What the cell put out (h).
    pub(crate) hidden: Vec<f32>,
    /// What it keeps (c).
    pub(crate) cell: Vec<f32>,
}

/// What a pass leaves behind: a row a step of a sequence.
#[derive(Debug)]
pub(crate) struct Trace {
    start: State,
    /// The four gates, after their curves.
    gates: Vec<f32>,
    cells: Vec<f32>,
    /// tanh of the cells.
    squashed: Vec<f32>,
    /// What was put out.
    pub(crate) hidden: Vec<f32>,
}

/// Derivatives by everything that went into a pass.
#[derive(Debug)]
pub(crate) struct Slopes {
    input: Tensor<2>,
    recurrent: Tensor<2>,
    bias: Tensor<1>,
    /// By what was read.
    pub(crate) read: Tensor<2>,
    /// By where it began, which for learners is a constant.
    #[cfg(test)]
    pub(crate) start: State,
}

impl Lstm {
    /// Weights and biases from U(±1/√width) (PyTorch's), and the forget gate's biases 1 more.
    pub(crate) fn new(inputs: usize, width: usize, device: &Device, rng: &mut Rng) -> Self {
        let bound = init::bound(width);
        let mut input = init::uniform(inputs, 4 * width, bound, device, rng);
        let remember = |values: &mut [f32]| values[width..2 * width].iter_mut().for_each(|b| *b += REMEMBER);
        input.bias = input.bias.map(|bias| edit(bias, remember));
        let recurrent = Linear { bias: None, ..init::uniform(width, 4 * width, bound, device, rng) };
        Self { layers: vec![input, recurrent] }
    }

    /// Numbers that it puts out.
    fn width(&self) -> usize {
        self.layers[1].weight.dims()[0]
    }

    /// A pass over sequences, of which `sizes` says how many have each step, falling, from what they remember.
    pub(crate) fn forward(&self, read: Tensor<2>, sizes: &[usize], start: State) -> Trace {
        let (width, device) = (self.width(), read.device());
        let recurrent = self.layers[1].weight.val();
        let mut gates = floats(self.layers[0].forward(read));
        let empty = || vec![0.0; gates.len() / 4];
        let (mut cells, mut squashed, mut hidden) = (empty(), empty(), empty());
        let (mut first, mut before) = (0, 0);
        for (step, &count) in sizes.iter().enumerate() {
            let at = first * width..(first + count) * width;
            let (old, new) = cells.split_at_mut(at.start);
            let (put_out, putting) = hidden.split_at_mut(at.start);
            let old = if step == 0 { &start.cell } else { &old[before * width..] };
            let put_out = if step == 0 { &start.hidden } else { &put_out[before * width..] };
            let entering = rows(put_out[..count * width].to_vec(), width, &device);
            let entering = floats(entering.matmul(recurrent.clone()));
            advance(
                &mut gates[4 * at.start..4 * at.end],
                &entering,
                &old[..count * width],
                [&mut new[..count * width], &mut squashed[at], &mut putting[..count * width]],
                width,
            );
            before = first;
            first += count;
        }
        Trace { start, gates, cells, squashed, hidden }
    }

    /// The derivatives of Σ `slopes` · hidden: back through time from the last step of each sequence to its first.
    pub(crate) fn backward(&self, trace: Trace, read: Tensor<2>, sizes: &[usize], slopes: &[f32]) -> Slopes {
        let (width, device) = (self.width(), read.device());
        let [input, recurrent] = [0, 1].map(|layer| self.layers[layer].weight.val());
        let Trace { start, mut gates, cells, squashed, hidden } = trace;
        let mut entered = Vec::with_capacity(hidden.len());
        let most = sizes.first().copied().unwrap_or(0) * width;
        // By what the step before put out and kept, of the sequences that go on.
        let (mut by_hidden, mut by_cell) = (vec![0.0; most], vec![0.0; most]);
        let mut end = hidden.len();
        for (step, &count) in sizes.iter().enumerate().rev() {
            let at = end - count * width..end;
            let before = match step {
                0 => &start.cell[..count * width],
                _ => &cells[at.start - sizes[step - 1] * width..][..count * width],
            };
            by_hidden.iter_mut().zip(&slopes[at.clone()]).for_each(|(all, own)| *all += own);
            let of_gates = &mut gates[4 * at.start..4 * at.end];
            retreat(of_gates, &squashed[at.clone()], before, &by_hidden, &mut by_cell, width);
            let product = rows(of_gates.to_vec(), 4 * width, &device).matmul(recurrent.clone().transpose());
            by_hidden[..count * width].copy_from_slice(&floats(product));
            end = at.start;
        }
        entered.extend_from_slice(&start.hidden[..most]);
        let mut from = 0;
        for pair in sizes.windows(2) {
            entered.extend_from_slice(&hidden[from..from + pair[1] * width]);
            from += pair[0] * width;
        }
        let by_gates = rows(gates, 4 * width, &device);
        Slopes {
            input: read.transpose().matmul(by_gates.clone()),
            recurrent: rows(entered, width, &device).transpose().matmul(by_gates.clone()),
            bias: by_gates.clone().sum_dim(0).reshape([4 * width]),
            read: by_gates.matmul(input.transpose()),
            #[cfg(test)]
            start: State { hidden: by_hidden, cell: by_cell },
        }
    }

    /// Puts the weights' derivatives where an optimiser finds them.
    pub(crate) fn register(&self, slopes: Slopes, into: &mut GradientsParams) {
        let [input, recurrent] = [0, 1].map(|layer| &self.layers[layer]);
        into.register(input.weight.id, slopes.input);
        into.register(recurrent.weight.id, slopes.recurrent);
        if let Some(bias) = &input.bias {
            into.register(bias.id, slopes.bias);
        }
    }
}

impl Trace {
    /// What each sequence remembers at its end; those without a step what they began with.
    pub(crate) fn end(&self, sizes: &[usize]) -> State {
        let mut end = self.start.clone();
        let width = self.hidden.len() / sizes.iter().sum::<usize>().max(1);
        let mut first = 0;
        for (step, &count) in sizes.iter().enumerate() {
            let going_on = sizes.get(step + 1).copied().unwrap_or(0);
            let (from, to) =
                ((first + going_on) * width..(first + count) * width, going_on * width..count * width);
            end.hidden[to.clone()].copy_from_slice(&self.hidden[from.clone()]);
            end.cell[to].copy_from_slice(&self.cells[from]);
            first += count;
        }
        end
    }
}

/// One step of some sequences. `gates` have what is read, and afterwards their values; `new` are cells, tanh of them, and
/// what is put out.
fn advance(gates: &mut [f32], entering: &[f32], old: &[f32], new: [&mut [f32]; 3], width: usize) {
    let [cells, squashed, hidden] = new.map(|all| all.chunks_exact_mut(width));
    let of_rows = gates.chunks_exact_mut(4 * width).zip(entering.chunks_exact(4 * width));
    let rows = of_rows.zip(old.chunks_exact(width)).zip(cells).zip(squashed).zip(hidden);
    for (((((gates, entering), old), cell), squashed), hidden) in rows {
        gates.iter_mut().zip(entering).for_each(|(gate, more)| *gate += more);
        let (first, last) = gates.split_at_mut(2 * width);
        let (candidate, output) = last.split_at_mut(width);
        first.iter_mut().for_each(|gate| *gate = logistic(*gate));
        candidate.iter_mut().for_each(|gate| *gate = tanh(*gate));
        output.iter_mut().for_each(|gate| *gate = logistic(*gate));
        let (input, forget) = first.split_at(width);
        let kept = forget.iter().zip(old).zip(input.iter().zip(&*candidate));
        for (cell, ((forget, old), (input, candidate))) in cell.iter_mut().zip(kept) {
            *cell = forget * old + input * candidate;
        }
        squashed.iter_mut().zip(&*cell).for_each(|(squashed, cell)| *squashed = tanh(*cell));
        let put_out = output.iter().zip(&*squashed);
        hidden.iter_mut().zip(put_out).for_each(|(hidden, (output, squashed))| *hidden = output * squashed);
    }
}

/// One step of some sequences backwards. `gates` have their values, and afterwards the derivatives by what entered their
/// curves; `by_cell` those by the cells of this step, and afterwards of the step before.
fn retreat(
    gates: &mut [f32],
    squashed: &[f32],
    before: &[f32],
    by_hidden: &[f32],
    by_cell: &mut [f32],
    width: usize,
) {
    let states = squashed.chunks_exact(width).zip(before.chunks_exact(width));
    let slopes = by_hidden.chunks_exact(width).zip(by_cell.chunks_exact_mut(width));
    for ((gates, (squashed, before)), (by_hidden, by_cell)) in
        gates.chunks_exact_mut(4 * width).zip(states).zip(slopes)
    {
        let (first, last) = gates.split_at_mut(2 * width);
        let ((input, forget), (candidate, output)) = (first.split_at_mut(width), last.split_at_mut(width));
        // Of one length, as the compiler is to see.
        let (squashed, before, by_hidden) = (&squashed[..width], &before[..width], &by_hidden[..width]);
        let by_cell = &mut by_cell[..width];
        let (input, forget) = (&mut input[..width], &mut forget[..width]);
        let (candidate, output) = (&mut candidate[..width], &mut output[..width]);
        for j in 0..width {
            let (i, f, g, o) = (input[j], forget[j], candidate[j], output[j]);
            let (s, dh) = (squashed[j], by_hidden[j]);
            let dc = by_cell[j] + dh * o * (1.0 - s * s);
            input[j] = dc * g * i * (1.0 - i);
            forget[j] = dc * before[j] * f * (1.0 - f);
            candidate[j] = dc * i * (1.0 - g * g);
            output[j] = dh * s * o * (1.0 - o);
            by_cell[j] = dc * f;
        }
    }
}

#[cfg(test)]
pub(super) mod tests;
