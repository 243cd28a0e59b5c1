use super::*;
use crate::nets::lstm::tests::in_burn;
use inroads_envs::Seed;
use rand::RngExt;

const MEMORY: usize = 6;
const CHOICES: usize = 3;
/// Three sequences of 4, 2 and 2 steps.
const SIZES: [usize; 4] = [3, 3, 1, 1];
const STEPS: usize = 8;

fn net() -> RecurrentNet {
    let torso = TorsoConfig { embedding: 5, merges: vec![4], hidden: vec![7, 6], ..Default::default() };
    let seen = Shape::Grid { down: 2, across: 3, width: 4 };
    let shape = RecurrentShape { seen, torso: &torso, memory: MEMORY, goal: 2, hidden: 9, choices: CHOICES };
    let mut net = RecurrentNet::new(shape, Backend::of_tests(), &mut Seed(1).stream("weights", 0));
    // Heads begin near zero; here every part is to have a gradient to speak of.
    net.online = net.online.map(&mut Larger);
    net
}

struct Larger;

impl burn::module::ModuleMapper for Larger {
    fn map_float<const D: usize>(&mut self, param: Param<Tensor<D>>) -> Param<Tensor<D>> {
        crate::nets::edit(param, |values| {
            if values.iter().all(|x| x.abs() < 0.01) {
                values.iter_mut().for_each(|x| *x *= 200.0);
            }
        })
    }
}

fn numbers(purpose: &str, n: usize) -> Vec<f32> {
    let mut rng = Seed(7).stream(purpose, 0);
    (0..n).map(|_| rng.random_range(-1.0..1.0)).collect()
}

fn seen(step: usize, row: &mut [f32]) {
    row.copy_from_slice(&numbers("seen", STEPS * 24)[step * 24..(step + 1) * 24]);
}

fn start() -> State {
    State { hidden: numbers("hidden", 3 * MEMORY), cell: numbers("cell", 3 * MEMORY) }
}

const PREVIOUS: [Option<usize>; STEPS] = [None, Some(1), Some(0), Some(2), None, Some(1), Some(1), Some(0)];

#[test]
fn the_parts_gradients_are_those_of_one_graph() {
    let net = net();
    let steps = Steps { sizes: &SIZES, write: &seen, previous: &PREVIOUS };
    let (goals, slopes) = (numbers("goals", 2 * STEPS), numbers("slopes", STEPS * CHOICES));
    let pass = net.forth(&steps, [start(), start()], goals.clone());
    let online = pass.online.clone();
    let ours = net.gradients(pass, &SIZES, slopes.clone());

    let tracked = net.online.clone().train();
    let device = &net.device;
    let mut all = vec![0.0; STEPS * 24];
    all.chunks_exact_mut(24).enumerate().for_each(|(step, row)| seen(step, row));
    let features = tracked.torso.forward(rows(all, 24, device).autodiff());
    let mut before = vec![0.0; STEPS * CHOICES];
    for (row, choice) in PREVIOUS.iter().enumerate().filter_map(|(row, choice)| Some((row, (*choice)?))) {
        before[row * CHOICES + choice] = 1.0;
    }
    let read = Tensor::cat(vec![features, rows(before, CHOICES, device).autodiff()], 1);
    let from = |values: Vec<f32>| rows(values, MEMORY, device).autodiff();
    let put_out = in_burn(&tracked.lstm, read, &SIZES, (from(start().hidden), from(start().cell)));
    let values = tracked.head.forward(put_out, Some(rows(goals, 2, device).autodiff()));
    for (a, b) in online.iter().zip(floats(values.clone().inner())) {
        assert!((a - b).abs() < 1e-5, "{a} {b}");
    }
    let loss = (values * rows(slopes, CHOICES, device).autodiff()).sum();
    let theirs = GradientsParams::from_grads(loss.backward(), &tracked);
    let mut compared = Compared { ours, theirs, parameters: 0 };
    net.online.visit(&mut compared);
    // Two layers of patches and two on top, the cell, the head: 8 + 3 + 7.
    assert_eq!(compared.parameters, 18);
}

struct Compared {
    ours: GradientsParams,
    theirs: GradientsParams,
    parameters: usize,
}

impl ModuleVisitor for Compared {
    fn visit_float<const D: usize>(&mut self, param: &Param<Tensor<D>>) {
        let [ours, theirs] = [&self.ours, &self.theirs].map(|all| floats(all.get::<D>(param.id).unwrap()));
        let largest = theirs.iter().fold(0.0_f32, |most, x| most.max(x.abs()));
        assert!(largest > 1e-4, "a parameter of shape {:?} has no gradient", param.dims());
        for (a, b) in ours.iter().zip(&theirs) {
            assert!((a - b).abs() < 1e-5 * largest.max(1.0), "shape {:?}: {a} {b}", param.dims());
        }
        self.parameters += 1;
    }
}

#[test]
fn network_and_target_are_led_in_each_by_itself() {
    let mut net = net();
    let (sizes, previous) = ([2, 1], [None, Some(1), Some(0)]);
    let steps = Steps { sizes: &sizes, write: &seen, previous: &previous };
    let [online, target] = net.led(&steps, start());
    assert_ne!(online.cell[..2 * MEMORY], start().cell[..2 * MEMORY]);
    assert_eq!(online.cell[2 * MEMORY..], start().cell[2 * MEMORY..], "the third has no step");
    // Heads have no part in it, and the other layers are still the same.
    assert_eq!(online, target);
    net.target = net.target.map(&mut Doubled);
    let [still, moved] = net.led(&steps, start());
    assert_eq!(still, online);
    assert_ne!(moved, online);
    // Step by step it is the same.
    let mut all = vec![0.0; 3 * 24];
    all.chunks_exact_mut(24).enumerate().for_each(|(step, row)| seen(step, row));
    let first = State { hidden: start().hidden[..MEMORY].to_vec(), cell: start().cell[..MEMORY].to_vec() };
    let first = net.step(all[..24].to_vec(), &[None], first);
    let second = net.step(all[48..].to_vec(), &[Some(0)], first);
    for (a, b) in second.cell.iter().zip(&online.cell) {
        assert!((a - b).abs() < 1e-6, "{a} {b}");
    }
}

struct Doubled;

impl burn::module::ModuleMapper for Doubled {
    fn map_float<const D: usize>(&mut self, param: Param<Tensor<D>>) -> Param<Tensor<D>> {
        param.map(|values| values * 2.0)
    }
}
