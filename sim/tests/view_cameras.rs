//! Where cameras see the points of a world.

use inroads_sim::{
    rigid::{Rectangle, Vector},
    view::Camera,
};

#[test]
fn a_picture_from_above_has_x_to_the_right_and_y_up() {
    let camera = Camera::above(Rectangle { low: [-4.0, -3.0], high: [4.0, 3.0] });
    let place = |x: f32, y: f32| camera.project(Vector::new(x, y, 7.0), [120, 90]).unwrap();
    assert_eq!(place(0.0, 0.0), [60.0, 45.0]);
    assert_eq!(place(1.0, 0.0), [75.0, 45.0]);
    assert_eq!(place(0.0, 1.0), [60.0, 30.0]);
}

#[test]
fn bounds_fill_a_picture_of_any_shape_as_far_as_both_allow() {
    let mut state = 1_u32;
    let mut random = |most: f64| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1 << 24) * most
    };
    for _ in 0..500 {
        let low = [random(20.0) - 10.0, random(20.0) - 10.0];
        let bounds = Rectangle { low, high: [low[0] + 0.1 + random(9.0), low[1] + 0.1 + random(9.0)] };
        let size = [1 + random(600.0) as u32, 1 + random(600.0) as u32];
        let corner = |[x, y]: [f64; 2]| {
            Camera::above(bounds).project(Vector::new(x as f32, y as f32, 0.0), size).unwrap()
        };
        let ([left, bottom], [right, top]) = (corner(bounds.low), corner(bounds.high));
        let [width, height] = size.map(|x| x as f32);
        let near = |a: f32, b: f32| (a - b).abs() < 1e-2;
        assert!(near(left + right, width) && near(top + bottom, height), "in the middle");
        assert!(left > -1e-2 && top > -1e-2, "all of it");
        assert!(near(left, 0.0) || near(top, 0.0), "as large as possible");
        let shape = (bounds.high[0] - bounds.low[0]) / (bounds.high[1] - bounds.low[1]);
        assert!(near((right - left) / shape as f32, bottom - top), "squares stay squares");
    }
}

#[test]
fn a_camera_beside_looks_at_its_focus_from_where_it_is_put() {
    let focus = Vector::new(3.0, -2.0, 1.0);
    let place =
        |camera: Camera, x: f32, y: f32, z: f32| camera.project(focus + Vector::new(x, y, z), [200, 100]);
    let near = |found: Option<[f32; 2]>, [x, y]: [f32; 2]| {
        found.is_some_and(|at| (at[0] - x).abs() < 1e-2 && (at[1] - y).abs() < 1e-2)
    };
    // From the south and level: x to the right, z up. Half the height of the picture is 5 tan 0.4 metres.
    let south = Camera::beside(focus, 5.0, -std::f32::consts::FRAC_PI_2, 0.0, 0.8);
    let edge = 5.0 * 0.4_f32.tan();
    assert!(near(place(south, 0.0, 0.0, 0.0), [100.0, 50.0]));
    assert!(near(place(south, edge, 0.0, edge), [150.0, 0.0]));
    assert!(near(place(south, edge, 5.0, edge), [125.0, 25.0]), "half as large at twice the distance");
    assert_eq!(place(south, 0.0, -6.0, 0.0), None, "behind the camera");
    // From the east, y to the right; straight from above, as a map.
    let east = Camera::beside(focus, 5.0, 0.0, 0.0, 0.8);
    assert!(near(place(east, 0.0, edge, 0.0), [150.0, 50.0]));
    let half_pi = std::f32::consts::FRAC_PI_2;
    assert!(near(place(Camera::beside(focus, 5.0, -half_pi, half_pi, 0.8), edge, edge, 0.0), [150.0, 0.0]));
}
