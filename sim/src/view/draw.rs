//! From light to pixels.

use image::{Rgb, RgbImage};

use super::{
    Camera, Scene,
    colour::{Light, colour},
    stage::{BEYOND, Stage},
};

/// Neighbours that differ by more, in any of red, green and blue, show a border between them.
const CONTRAST: u8 = 10;
/// Where in a pixel of such a border to look, sixteenths from its middle: no two in one row or column, the
/// standard eight samples of Direct3D 11.
const PLACES: [[f32; 2]; 8] =
    [[1.0, -3.0], [-1.0, 3.0], [5.0, 1.0], [-3.0, -5.0], [-5.0, 5.0], [-7.0, -1.0], [3.0, 7.0], [7.0, -7.0]];

/// Draws a scene on the whole of a frame of any size, over what it showed. Equal scenes give equal bytes.
///
/// Solids that are not made of finite numbers or have no volume are left out; a camera that sees nothing (no
/// distance, no bounds) leaves an empty background. Memory: one byte a pixel, and some for each solid. Time:
/// about 25 ms for an ant in a maze at 480 × 360, on one core of a server (AMD EPYC).
///
/// ```
/// use image::RgbImage;
/// use inroads_sim::{Shape, rigid::{Pose, Rectangle, Vector}, view::{Camera, Scene, Solid, colour, draw}};
///
/// let ball = Solid {
///     shape: Shape::Ball { radius: 0.5 },
///     pose: Pose::from_translation(Vector::new(1.0, 0.0, 0.5)),
///     colour: colour::TORSO,
/// };
/// let scene = Scene {
///     solids: vec![ball],
///     marks: vec![],
///     trail: vec![],
///     bounds: Rectangle { low: [-2.0, -2.0], high: [2.0, 2.0] },
///     focus: Vector::ZERO,
///     distance: 6.0,
/// };
/// let mut frame = RgbImage::new(80, 80);
/// draw(&scene, &Camera::above(scene.bounds), &mut frame);
/// let [red, _, blue] = frame.get_pixel(60, 40).0;
/// assert!(red > 2 * blue);
/// draw(&scene, &Camera::watching(&scene), &mut frame);
/// ```
pub fn draw(scene: &Scene, camera: &Camera, frame: &mut RgbImage) {
    let (width, height) = frame.dimensions();
    let Some(stage) = Stage::new(scene, camera, [width, height]) else {
        frame.pixels_mut().for_each(|pixel| *pixel = Rgb(colour(BEYOND)));
        return;
    };
    for (x, y, pixel) in frame.enumerate_pixels_mut() {
        *pixel = Rgb(colour(stage.look(x as f32 + 0.5, y as f32 + 0.5)));
    }
    let rough = borders(frame);
    for ((x, y, pixel), _) in frame.enumerate_pixels_mut().zip(rough).filter(|(_, rough)| *rough) {
        let (x, y) = (x as f32 + 0.5, y as f32 + 0.5);
        let looks = PLACES.iter().map(|[a, b]| stage.look(x + a / 16.0, y + b / 16.0));
        *pixel = Rgb(colour(looks.sum::<Light>() / PLACES.len() as f32));
    }
}

/// Which pixels, row by row, differ from one of their four neighbours.
fn borders(frame: &RgbImage) -> Vec<bool> {
    let (width, height) = (frame.width() as usize, frame.height() as usize);
    let bytes = frame.as_raw();
    let mut rough = vec![false; width * height];
    let mut compare = |one: usize, other: usize| {
        if (0..3).any(|part| bytes[3 * one + part].abs_diff(bytes[3 * other + part]) > CONTRAST) {
            (rough[one], rough[other]) = (true, true);
        }
    };
    for at in 0..width * height {
        if (at + 1) % width != 0 {
            compare(at, at + 1);
        }
        if at + width < width * height {
            compare(at, at + width);
        }
    }
    rough
}
