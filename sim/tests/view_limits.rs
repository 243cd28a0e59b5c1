//! What cannot be drawn is left out, and breaks nothing.

use image::RgbImage;
use inroads_sim::{
    Shape,
    rigid::{Pose, Rectangle, Rotation, Vector},
    view::{Camera, Mark, Scene, Solid, draw},
};

const NAN: f32 = f32::NAN;

fn scene(solids: Vec<Solid>) -> Scene {
    Scene {
        solids,
        marks: Vec::new(),
        trail: Vec::new(),
        bounds: Rectangle { low: [-4.0, -3.0], high: [4.0, 3.0] },
        focus: Vector::new(0.0, 0.0, 0.5),
        distance: 9.0,
    }
}

fn ball(radius: f32, at: [f32; 3]) -> Solid {
    Solid {
        shape: Shape::Ball { radius },
        pose: Pose::from_translation(Vector::from(at)),
        colour: [20, 200, 20],
    }
}

fn picture(scene: &Scene, camera: &Camera) -> RgbImage {
    let mut frame = RgbImage::new(120, 90);
    draw(scene, camera, &mut frame);
    frame
}

fn cameras(scene: &Scene) -> [Camera; 2] {
    [Camera::above(scene.bounds), Camera::watching(scene)]
}

#[test]
fn solids_without_volume_or_number_are_left_out() {
    let v = Vector::new;
    let capsule = |from, to| Shape::Capsule { from, to, radius: 0.1 };
    let hull = |points: &[Vector]| Shape::Hull { points: points.to_vec() };
    let shapes = [
        Shape::Ball { radius: NAN },
        Shape::Ball { radius: -1.0 },
        Shape::Ball { radius: 0.0 },
        capsule(v(NAN, 0.0, 0.0), Vector::ZERO),
        capsule(Vector::ZERO, v(f32::INFINITY, 0.0, 0.0)),
        Shape::Cuboid { half: v(1.0, NAN, 1.0) },
        Shape::Cuboid { half: v(1.0, 0.0, 1.0) },
        Shape::Cylinder { half_height: NAN, radius: 1.0 },
        hull(&[]),
        hull(&[Vector::X; 9]),
        hull(&[Vector::ZERO, Vector::X, Vector::Y, v(1.0, 1.0, 0.0), v(0.5, 0.5, 0.0)]),
        hull(&[Vector::ZERO, Vector::X, v(2.0, 0.0, 0.0), v(3.0, 0.0, 0.0)]),
        hull(&[Vector::ZERO, Vector::X, Vector::Y, Vector::Z, v(NAN, 0.0, 0.0)]),
    ];
    let poses = [
        Pose::from_translation(v(NAN, 0.0, 0.0)),
        Pose::from_parts(Vector::ZERO, Rotation::from_xyzw(NAN, 0.0, 0.0, 1.0)),
        Pose::from_parts(Vector::ZERO, Rotation::from_xyzw(0.0, 0.0, 0.0, 0.0)),
    ];
    let good = ball(0.6, [0.0, 0.0, 0.6]);
    let misshapen = shapes.map(|shape| Solid { shape, ..good.clone() });
    let misplaced = poses.map(|pose| Solid { pose, ..good.clone() });
    let without = scene(vec![good]);
    for solid in misshapen.into_iter().chain(misplaced) {
        let with = Scene { solids: vec![solid.clone(), without.solids[0].clone()], ..without.clone() };
        for camera in cameras(&without) {
            assert!(picture(&with, &camera) == picture(&without, &camera), "{solid:?}");
        }
    }
}

#[test]
fn paint_without_number_is_left_out() {
    let without = scene(vec![ball(0.6, [0.0, 0.0, 0.6])]);
    let mark = |at, radius| Mark { at, radius, colour: [200, 0, 0] };
    let with = Scene {
        marks: vec![mark([NAN, 0.0], 1.0), mark([0.0, 0.0], NAN), mark([0.0, 0.0], -3.0)],
        trail: vec![[NAN, 0.0], [f32::INFINITY, 0.0], [0.0, NAN], [2.0, 2.0]],
        ..without.clone()
    };
    for camera in cameras(&without) {
        assert!(picture(&with, &camera) == picture(&without, &camera));
    }
}

#[test]
fn a_camera_that_sees_nothing_leaves_a_background() {
    let scene = scene(vec![ball(0.6, [0.0, 0.0, 0.6])]);
    let focus = Vector::ZERO;
    let flat = |low, high| Camera::above(Rectangle { low, high });
    for camera in [
        flat([1.0, 1.0], [1.0, 1.0]),
        flat([f64::NAN, f64::NAN], [1.0, 1.0]),
        flat([1.0, 1.0], [-1.0, -1.0]),
        Camera::beside(Vector::new(NAN, 0.0, 0.0), 5.0, 0.0, 0.5, 0.7),
        Camera::beside(focus, 0.0, 0.0, 0.5, 0.7),
        Camera::beside(focus, -1.0, 0.0, 0.5, 0.7),
        Camera::beside(focus, 5.0, NAN, 0.5, 0.7),
        Camera::beside(focus, 5.0, 0.0, NAN, 0.7),
        Camera::beside(focus, 5.0, 0.0, 0.5, 0.0),
        Camera::beside(focus, 5.0, 0.0, 0.5, 7.0),
    ] {
        let frame = picture(&scene, &camera);
        assert!(frame.pixels().all(|pixel| pixel == frame.get_pixel(0, 0)), "{camera:?}");
        assert_eq!(camera.project(focus, [120, 90]), None, "{camera:?}");
    }
}

#[test]
fn great_and_strange_worlds_do_not_break_the_brush() {
    let shaped = |shape| Solid { shape, ..ball(1.0, [0.0; 3]) };
    let mut solids = vec![
        ball(1e30, [1e35, 0.0, 0.0]),
        ball(1e-30, [0.0; 3]),
        ball(1e20, [0.0; 3]),
        shaped(Shape::Cuboid { half: Vector::new(1e30, 1e30, 1e-30) }),
        shaped(Shape::Capsule { from: Vector::ZERO, to: Vector::new(1e30, 0.0, 0.0), radius: 1e-9 }),
        shaped(Shape::Hull { points: vec![Vector::ZERO, Vector::X * 1e30, Vector::Y, Vector::Z * 1e-30] }),
    ];
    solids.extend((0..500).map(|i| ball(0.1, [(i % 25) as f32, (i / 25) as f32, -0.05 * i as f32])));
    let scene = Scene {
        marks: vec![Mark { at: [1e30, 1e30], radius: 1e30, colour: [200, 0, 0] }],
        trail: (0..500).map(|i| [(i as f32).sin() * 1e9, (i as f32).cos()]).collect(),
        ..scene(solids)
    };
    let beside = |distance, elevation, view| Camera::beside(Vector::ZERO, distance, 0.0, elevation, view);
    for camera in cameras(&scene).into_iter().chain([
        beside(1e-20, 0.5, 0.7),
        beside(1e30, 0.5, 0.7),
        beside(3.0, -0.5, 0.7),
        beside(3.0, std::f32::consts::FRAC_PI_2, 3.1),
        Camera::above(Rectangle { low: [-1e30; 2], high: [1e30; 2] }),
        Camera::above(Rectangle { low: [-1e300; 2], high: [1e300; 2] }),
        Camera::above(Rectangle { low: [0.0; 2], high: [1e-30; 2] }),
    ]) {
        picture(&scene, &camera);
    }
}
