//! Pictures, pixel by pixel.

use image::{Rgb, RgbImage};
use inroads_sim::{
    Shape,
    rigid::{Pose, Rectangle, Rotation, Vector},
    view::{Camera, Mark, Scene, Solid, colour, draw},
};

const RED: [u8; 3] = [230, 20, 20];
const GREEN: [u8; 3] = [20, 200, 20];
const SIZE: [u32; 2] = [120, 90];

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

fn solid(shape: Shape, at: [f32; 3], colour: [u8; 3]) -> Solid {
    Solid { shape, pose: Pose::from_translation(Vector::from(at)), colour }
}

fn ball(radius: f32, at: [f32; 3], colour: [u8; 3]) -> Solid {
    solid(Shape::Ball { radius }, at, colour)
}

fn cuboid(half: [f32; 3], at: [f32; 3], colour: [u8; 3]) -> Solid {
    solid(Shape::Cuboid { half: Vector::from(half) }, at, colour)
}

fn picture(scene: &Scene, camera: &Camera) -> RgbImage {
    let mut frame = RgbImage::new(SIZE[0], SIZE[1]);
    draw(scene, camera, &mut frame);
    frame
}

fn cameras(scene: &Scene) -> [Camera; 2] {
    [Camera::above(scene.bounds), Camera::watching(scene)]
}

/// From the south, as one reads a map.
fn from_south(focus: [f32; 3], elevation: f32) -> Camera {
    Camera::beside(Vector::from(focus), 9.0, -std::f32::consts::FRAC_PI_2, elevation, 0.8)
}

/// The colour where a point of the world appears.
fn seen(frame: &RgbImage, camera: &Camera, point: [f32; 3]) -> Rgb<u8> {
    let [x, y] = camera.project(Vector::from(point), [frame.width(), frame.height()]).unwrap();
    *frame.get_pixel(x as u32, y as u32)
}

fn reddish(&Rgb([red, green, blue]): &Rgb<u8>) -> bool {
    i32::from(red) > i32::from(green.max(blue)) + 60
}

fn greenish(&Rgb([red, green, blue]): &Rgb<u8>) -> bool {
    i32::from(green) > i32::from(red.max(blue)) + 60
}

fn brightness(pixel: &Rgb<u8>) -> u32 {
    pixel.0.into_iter().map(u32::from).sum()
}

#[test]
fn a_ball_is_where_the_projection_says() {
    let at = [1.5, -0.8, 0.6];
    let scene = scene(vec![ball(0.6, at, RED)]);
    for camera in cameras(&scene) {
        let frame = picture(&scene, &camera);
        let red: Vec<_> = frame.enumerate_pixels().filter(|(_, _, pixel)| reddish(pixel)).collect();
        let mean = |part: fn(u32, u32) -> u32| {
            red.iter().map(|&(x, y, _)| part(x, y) as f32 + 0.5).sum::<f32>() / red.len() as f32
        };
        let [x, y] = camera.project(Vector::from(at), SIZE).unwrap();
        assert!((mean(|x, _| x) - x).abs() < 1.0 && (mean(|_, y| y) - y).abs() < 1.0, "{camera:?}");
        assert!(reddish(&seen(&frame, &camera, at)));
    }
}

#[test]
fn the_nearer_hides_the_farther_in_any_order() {
    let (low, high) = (ball(0.5, [0.0, 0.0, 0.5], RED), ball(0.5, [0.0, 0.0, 2.0], GREEN));
    for solids in [vec![low.clone(), high.clone()], vec![high, low]] {
        let scene = scene(solids);
        let above = picture(&scene, &Camera::above(scene.bounds));
        assert!(!above.pixels().any(reddish) && above.pixels().any(greenish));
        let beside = picture(&scene, &Camera::watching(&scene));
        assert!(beside.pixels().any(reddish) && beside.pixels().any(greenish));
    }
    let row = scene(vec![ball(0.5, [0.0, 2.0, 0.5], RED), ball(0.5, [0.0, -2.0, 0.5], GREEN)]);
    let level = picture(&row, &from_south([0.0, 0.0, 0.5], 0.0));
    assert!(!level.pixels().any(reddish) && level.pixels().any(greenish));
}

#[test]
fn shadows_fall_away_from_the_sun() {
    let scene = scene(vec![ball(0.5, [0.0, 0.0, 1.5], RED)]);
    let empty = Scene { solids: vec![], ..scene.clone() };
    for camera in cameras(&scene) {
        let (with, without) = (picture(&scene, &camera), picture(&empty, &camera));
        let darker: Vec<_> = with
            .enumerate_pixels()
            .zip(without.pixels())
            .filter(|((_, _, pixel), floor)| !reddish(pixel) && brightness(pixel) + 120 < brightness(floor))
            .map(|((x, y, _), _)| [x as f32, y as f32])
            .collect();
        assert!(darker.len() > 50, "a shadow, not a speck: {}", darker.len());
        let foot = camera.project(Vector::ZERO, SIZE).unwrap();
        let mean = [0, 1].map(|axis| darker.iter().map(|at| at[axis]).sum::<f32>() / darker.len() as f32);
        assert!(mean[0] > foot[0] + 3.0, "the sun stands to the left: {mean:?} {foot:?}");
        let down = mean[1] - foot[1];
        let above = matches!(camera, Camera::Above { .. });
        assert!(if above { down > 3.0 } else { down < -3.0 }, "at the top, or behind the viewer: {down}");
    }
}

#[test]
fn solids_shade_solids() {
    let lid = cuboid([0.5, 0.5, 0.1], [0.0, 0.0, 2.0], RED);
    let scene = scene(vec![lid, cuboid([3.0, 3.0, 0.1], [0.0, 0.0, 0.3], GREEN)]);
    let camera = Camera::above(scene.bounds);
    let frame = picture(&scene, &camera);
    let [shadow, light] = [[0.9, -0.9, 0.4], [-0.9, 0.9, 0.4]].map(|at| seen(&frame, &camera, at));
    assert!(greenish(&light) && light.0[1] > shadow.0[1] + 60, "{light:?} {shadow:?}");
}

#[test]
fn a_wall_hides_what_is_behind_it_but_not_what_is_looked_at() {
    let wall = |above_floor: f32| cuboid([3.0, 0.2, 0.75], [0.0, -1.0, 0.75 + above_floor], colour::WALL);
    let behind = |wall| scene(vec![wall, ball(0.3, [0.0, 0.0, 0.3], RED)]);
    let elsewhere = picture(&behind(wall(0.0)), &from_south([3.5, 1.0, 0.3], 0.3));
    assert!(!elsewhere.pixels().any(reddish));
    let at_it = picture(&behind(wall(0.0)), &from_south([0.0, 0.0, 0.3], 0.3));
    assert!(at_it.pixels().filter(|pixel| reddish(pixel)).count() > 20);
    let hanging = picture(&behind(wall(0.1)), &from_south([0.0, 0.0, 0.3], 0.3));
    assert!(!hanging.pixels().any(reddish), "only walls have windows");
    let inside = picture(&behind(wall(0.0)), &from_south([0.0, -1.0, 0.7], 0.3));
    assert!(!inside.pixels().any(reddish), "a wall that is looked at is whole");
    let in_front = picture(&behind(wall(0.0)), &from_south([0.0, -2.0, 0.3], 0.3));
    assert!(!in_front.pixels().any(reddish), "nor does one open behind the focus");
}

#[test]
fn every_shape_has_its_outline() {
    let turned = |shape| Solid {
        shape,
        pose: Pose::from_parts(Vector::new(0.0, 0.0, 1.0), Rotation::from_rotation_z(0.5)),
        colour: RED,
    };
    let sign = |bit: usize| [-1.0, 1.0][bit & 1];
    let corners = (0..8).map(|i| Vector::new(1.5 * sign(i), 0.7 * sign(i >> 1), 0.2 * sign(i >> 2)));
    let hull = Shape::Hull { points: corners.collect() };
    let cuboid = Shape::Cuboid { half: Vector::new(1.5, 0.7, 0.2) };
    let (pi, along) = (std::f32::consts::PI, Vector::new(1.5, 0.0, 0.0));
    for (shape, area) in [
        (Shape::Ball { radius: 0.8 }, pi * 0.64),
        (Shape::Capsule { from: -along, to: along, radius: 0.5 }, pi * 0.25 + 3.0),
        (Shape::Capsule { from: Vector::ZERO, to: Vector::Z, radius: 0.5 }, pi * 0.25),
        (Shape::Capsule { from: along, to: along, radius: 0.5 }, pi * 0.25),
        (Shape::Cylinder { half_height: 0.4, radius: 0.9 }, pi * 0.81),
        (cuboid.clone(), 4.2),
        (hull.clone(), 4.2),
    ] {
        let scene = scene(vec![turned(shape.clone())]);
        // 60 pixels a metre.
        let mut frame = RgbImage::new(480, 360);
        draw(&scene, &Camera::above(scene.bounds), &mut frame);
        let found = frame.pixels().filter(|pixel| reddish(pixel)).count() as f32 / (60.0 * 60.0);
        assert!((found / area - 1.0).abs() < 0.02, "{shape:?}: {found} m² instead of {area}");
    }
    let [of_cuboid, of_hull] = [cuboid, hull].map(|shape| {
        let scene = scene(vec![turned(shape)]);
        picture(&scene, &Camera::watching(&scene))
    });
    let differ = |(a, b): &(&Rgb<u8>, &Rgb<u8>)| brightness(a).abs_diff(brightness(b)) > 30;
    let differences = of_cuboid.pixels().zip(of_hull.pixels()).filter(differ).count();
    assert!(differences < 10, "a box is the hull of its corners, but for {differences} pixels");
}

#[test]
fn borders_are_smooth() {
    let scene = scene(vec![ball(1.0, [0.0, 0.0, 1.0], [0, 0, 0])]);
    let frame = picture(&scene, &Camera::above(scene.bounds));
    let between = frame.pixels().filter(|pixel| (100..160).contains(&pixel.0[0])).count();
    assert!(between > 10, "{between}");
}

#[test]
fn marks_and_the_trail_lie_on_the_floor() {
    let mark = |at, colour| Mark { at, radius: 0.6, colour };
    let scene = Scene {
        marks: vec![mark([-2.0, 1.0], GREEN), mark([-1.5, 1.0], RED), mark([2.0, 0.0], RED)],
        trail: (0..50).map(|i| [-3.0 + 0.1 * i as f32, -2.0]).collect(),
        ..scene(vec![cuboid([0.7, 0.7, 0.2], [2.0, 0.0, 0.2], [90, 90, 90])])
    };
    for camera in cameras(&scene) {
        let frame = picture(&scene, &camera);
        let at = |x: f32, y: f32| seen(&frame, &camera, [x, y, 0.0]);
        assert!(greenish(&at(-2.4, 1.0)) && reddish(&at(-1.75, 1.0)), "later over earlier");
        assert!(!reddish(&at(2.0, 0.0)), "under the box");
        let blue = |x, y| i32::from(at(x, y).0[2]) - i32::from(at(x, y).0[0]);
        assert!(blue(1.8, -2.0) > blue(-2.9, -2.0) + 20 && blue(-2.9, -2.0) > 20, "fading");
        assert!(blue(0.0, -2.4) < 20, "no wider than a line");
    }
}

#[test]
fn frames_of_any_size_are_filled_and_equal_scenes_give_equal_bytes() {
    let solids = vec![ball(0.6, [0.0, 0.0, 0.6], RED), cuboid([1.0, 0.2, 0.4], [0.0, 1.0, 0.4], GREEN)];
    let scene = scene(solids);
    for camera in cameras(&scene) {
        for (width, height) in [(0, 0), (0, 5), (5, 0), (1, 1), (7, 3), (300, 1), (1, 300), (64, 64)] {
            let mut clean = RgbImage::new(width, height);
            let mut used = RgbImage::from_pixel(width, height, Rgb([1, 2, 3]));
            draw(&scene, &camera, &mut clean);
            draw(&scene, &camera, &mut used);
            assert!(clean == used && clean.dimensions() == (width, height));
            assert!(!clean.pixels().any(|pixel| pixel.0 == [0, 0, 0]), "{width} × {height}");
        }
    }
}
