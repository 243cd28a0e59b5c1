use super::*;
use crate::encode::Encoder;
use crate::nets::{Backend, floats, rows};
use inroads_envs::{Frame, Seed};
use rand::RngExt;

fn torso(shape: Shape, config: &TorsoConfig) -> Torso {
    Torso::new(shape, config, &Backend::of_tests().plain(), &mut Seed(1).stream("weights", 0))
}

#[test]
fn four_neighbours_become_one_place() {
    // 3 × 3 places of one number, 1 to 9.
    let device = Backend::of_tests().plain();
    let x = rows((1..=9).map(|i| i as f32).collect(), 1, &device);
    let mut places = [3, 3];
    let joined = merged(x, 1, &mut places);
    assert_eq!(places, [2, 2]);
    let expected = [[1.0, 2.0, 4.0, 5.0], [3.0, 0.0, 6.0, 0.0], [7.0, 8.0, 0.0, 0.0], [9.0, 0.0, 0.0, 0.0]];
    assert_eq!(floats(joined), expected.concat());
}

#[test]
fn rows_do_not_depend_on_their_neighbours_in_the_batch() {
    for shape in [Shape::Row(24), Shape::Grid { down: 3, across: 2, width: 4 }] {
        let torso = torso(shape, &TorsoConfig { hidden: vec![16, 5], ..TorsoConfig::default() });
        let row = |i: usize| (0..24).map(|j| ((i * 24 + j) as f32).sin()).collect::<Vec<_>>();
        let device = Backend::of_tests().plain();
        let all = floats(torso.forward(rows([row(0), row(1), row(2)].concat(), 24, &device)));
        for i in 0..3 {
            let one = floats(torso.forward(rows(row(i), 24, &device)));
            for (a, b) in one.iter().zip(&all[5 * i..]) {
                assert!((a - b).abs() < 1e-5, "{a} {b}");
            }
        }
        assert!(all.iter().any(|x| *x > 0.0));
    }
}

#[test]
fn settings_that_make_no_network_are_named() {
    assert_eq!(TorsoConfig::default().check(), Ok(()));
    let wrong = |config: TorsoConfig| config.check().unwrap_err();
    assert!(wrong(TorsoConfig { hidden: vec![], ..Default::default() }).contains("hidden"));
    assert!(wrong(TorsoConfig { merges: vec![0], ..Default::default() }).contains("merges"));
}

fn nature() -> TorsoConfig {
    TorsoConfig { vision: Vision::Nature, hidden: vec![512], ..TorsoConfig::default() }
}

/// Pictures of random bytes, one seed each.
fn picture(width: u32, height: u32, channels: u32, seed: u64) -> Frame {
    let mut frame = Frame::new([width, height], channels);
    let mut rng = Seed(seed).stream("picture", 0);
    frame.bytes_mut().iter_mut().for_each(|byte| *byte = rng.random());
    frame
}

/// A convolution and max(0, ·) by its definition: the sum over a window's lines, columns and features. `sizes`: rows,
/// columns and features of what comes in; of what goes out as well.
fn direct(
    input: &[f64],
    sizes: [usize; 3],
    side: usize,
    stride: usize,
    layer: &Linear,
) -> (Vec<f64>, [usize; 3]) {
    let [down, across, features] = sizes;
    let weights = floats(layer.weight.val());
    let bias = floats(layer.bias.as_ref().unwrap().val());
    let outputs = bias.len();
    let out = [(down - side) / stride + 1, (across - side) / stride + 1, outputs];
    let mut all = Vec::new();
    for y in 0..out[0] {
        for x in 0..out[1] {
            for k in 0..outputs {
                let mut sum = f64::from(bias[k]);
                for (i, j) in (0..side).flat_map(|i| (0..side).map(move |j| (i, j))) {
                    for c in 0..features {
                        let pixel = input[((stride * y + i) * across + stride * x + j) * features + c];
                        sum += pixel * f64::from(weights[((i * side + j) * features + c) * outputs + k]);
                    }
                }
                all.push(sum.max(0.0));
            }
        }
    }
    (all, out)
}

#[test]
fn natures_convolution_is_what_it_is_by_definition() {
    // 41 and 45 pixels: some are left over in the first and in the second layer.
    let space = Space::Frame { width: 45, height: 41, channels: 2 };
    let encoder = nature().encoder(&space).unwrap();
    let torso = torso(encoder.shape(), &nature());
    let pictures = [1, 2].map(|seed| picture(45, 41, 2, seed));
    let device = Backend::of_tests().plain();
    let written = crate::encode::rows(&encoder, pictures.iter());
    let found = floats(torso.embedded(rows(written, encoder.width(), &device)));
    let mut expected = Vec::new();
    for picture in &pictures {
        let mut x: Vec<_> = picture.bytes().iter().map(|byte| f64::from(*byte) / 255.0).collect();
        let mut sizes = [41, 45, 2];
        for (layer, kernel) in torso.places.iter().zip(NATURE) {
            (x, sizes) = direct(&x, sizes, kernel.side, kernel.stride, layer);
        }
        assert_eq!(sizes, [1, 2, 64]);
        expected.extend(x);
    }
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(&expected) {
        assert!((f64::from(*found) - expected).abs() < 1e-5, "{found} {expected}");
    }
    assert!(expected.iter().filter(|x| **x > 0.01).count() > 20);
}

#[test]
fn pictures_do_not_depend_on_their_neighbours_in_the_batch() {
    for config in [TorsoConfig::default(), nature()] {
        let space = Space::Frame { width: 40, height: 40, channels: 3 };
        let encoder = config.encoder(&space).unwrap();
        let torso = torso(encoder.shape(), &config);
        let pictures = [1, 2, 3].map(|seed| picture(40, 40, 3, seed));
        let device = Backend::of_tests().plain();
        let features = |pictures: &[Frame]| {
            let written = crate::encode::rows(&encoder, pictures.iter());
            floats(torso.forward(rows(written, encoder.width(), &device)))
        };
        let all = features(&pictures);
        assert_eq!(all.len(), 3 * config.features());
        for (picture, all) in pictures.iter().zip(all.chunks_exact(config.features())) {
            for (a, b) in features(std::slice::from_ref(picture)).iter().zip(all) {
                assert!((a - b).abs() < 1e-5, "{a} {b}");
            }
        }
        assert_ne!(all[..config.features()], all[config.features()..2 * config.features()]);
    }
}

#[test]
fn a_picture_that_is_too_small_for_a_convolution_is_named_with_what_it_needs() {
    let space = |width, height| Space::Frame { width, height, channels: 1 };
    let error = nature().encoder(&space(84, 35)).unwrap_err().to_string();
    assert!(error.contains("84 by 35") && error.contains("36 by 36"), "{error}");
    assert!(nature().encoder(&space(36, 36)).is_ok());
    assert_eq!(nature().encoder(&Space::Discrete(3)), Err(PatchError::NoPicture));
    assert_eq!(TorsoConfig::default().encoder(&space(84, 35)), Patches::new(&space(84, 35), 0));
}

#[test]
fn the_vision_is_a_word_of_the_configuration() {
    let read = serde_json::from_str::<TorsoConfig>("{\"vision\": \"nature\", \"hidden\": [512]}");
    assert_eq!(read.unwrap(), nature());
}
