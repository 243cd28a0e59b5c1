//! Draws a small world of your own from above and from the side:
//!
//! ```text
//! cargo run --release -p inroads-sim --example picture -- DIRECTORY
//! ```

use std::{error::Error, fs::File, path::Path};

use image::RgbImage;
use inroads_sim::{
    Shape,
    rigid::{Pose, Rectangle, Rotation, Vector},
    view::{Camera, Mark, Scene, Solid, colour, draw},
};

fn main() -> Result<(), Box<dyn Error>> {
    let directory = std::env::args().nth(1).unwrap_or_else(|| ".".into());
    let scene = world();
    for (name, camera) in
        [("above.png", Camera::above(scene.bounds)), ("beside.png", Camera::watching(&scene))]
    {
        let mut frame = RgbImage::new(480, 360);
        draw(&scene, &camera, &mut frame);
        save(&frame, &Path::new(&directory).join(name))?;
    }
    Ok(())
}

/// A low wall, a hurdle before it, and a ball that has rolled in a curve.
fn world() -> Scene {
    let at = |x, y, z| Pose::from_translation(Vector::new(x, y, z));
    let wall = Shape::Cuboid { half: Vector::new(2.0, 0.2, 0.3) };
    let hurdle = Shape::Capsule { from: Vector::Y * -0.8, to: Vector::Y * 0.8, radius: 0.08 };
    let turn = Rotation::from_rotation_z(0.4);
    let path = |i: i32| [-2.0 + 0.05 * i as f32, -1.0 + (0.04 * i as f32).sin()];
    let [x, y] = path(60);
    Scene {
        solids: vec![
            Solid { shape: wall, pose: at(0.0, 1.2, 0.3), colour: colour::WALL },
            Solid { shape: hurdle, pose: at(-0.6, -0.6, 0.5) * turn, colour: colour::LEG },
            Solid { shape: Shape::Ball { radius: 0.25 }, pose: at(x, y, 0.25), colour: colour::TORSO },
        ],
        marks: vec![Mark { at: [1.8, -1.0], radius: 0.35, colour: colour::GOAL }],
        trail: (0..=60).map(path).collect(),
        bounds: Rectangle { low: [-2.8, -2.1], high: [2.8, 2.1] },
        focus: Vector::new(0.0, 0.0, 0.2),
        distance: 6.5,
    }
}

fn save(frame: &RgbImage, path: &Path) -> Result<(), Box<dyn Error>> {
    let mut encoder = png::Encoder::new(File::create(path)?, frame.width(), frame.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header()?.write_image_data(frame.as_raw())?;
    Ok(())
}
