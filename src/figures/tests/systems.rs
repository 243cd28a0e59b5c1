//! The pictures of graphs, goals, features and predictions.

use image::{Rgb, RgbImage};
use inroads_discovery::record::GoalState;

use super::{Scratch, has, read_png, u_maze};
use crate::figures::*;

/// The colour of a pixel.
fn at((size, pixels): &([u32; 2], Vec<[u8; 3]>), x: u32, y: u32) -> [u8; 3] {
    pixels[(y * size[0] + x) as usize]
}

/// Two vertices on a map, or in two cells of a row, with an edge between them.
fn pair(to: [f32; 2]) -> Graph {
    let vertex = |at, role, value| Vertex { label: "7".into(), at: Some(at), value, role };
    Graph {
        vertices: vec![vertex([0.0, 0.0], Role::Start, 1.0), vertex(to, Role::Goal, 9.0)],
        edges: vec![Edge { from: 0, to: 1, probability: 1.0, hoped: false, planned: true }],
        ..Graph::default()
    }
}

#[test]
fn vertices_stand_where_they_are_on_the_map_and_their_plan_leads_there() {
    let scratch = Scratch::new("graph-map.png");
    graph(&scratch.0, Ground::Map(&u_maze()), &pair([8.0, 0.0])).unwrap();
    let picture = read_png(&scratch);
    assert_eq!(picture.0[0], 796);
    // 38 pixels a metre, the map's lower left corner (-6, -6) at (18, 778).
    let place = |x: f32, y: f32| ((18.0 + (x + 6.0) * 38.0) as u32, (778.0 - (y + 6.0) * 38.0) as u32);
    let (x, y) = place(8.0, 0.0);
    assert_eq!(at(&picture, x - 10, y), palette::shade(1.0).rgb, "the vertex of the greatest value is dark");
    let (x, y) = place(4.0, 0.0);
    assert_eq!(at(&picture, x, y), palette::colour(6).rgb, "the plan leads along the straight line");
    assert!(has(&picture.1, palette::GOAL) && has(&picture.1, palette::WALL));
    assert!(!has(&picture.1, palette::colour(2)), "nothing grows");
}

#[test]
fn cells_lie_over_the_faded_picture_of_their_world() {
    let scratch = Scratch::new("graph-picture.png");
    let mut world = RgbImage::from_pixel(2, 2, Rgb([0, 0, 0]));
    world.put_pixel(1, 0, Rgb([0, 200, 0]));
    graph(&scratch.0, Ground::Picture { picture: &world, cells: [2, 2] }, &pair([1.0, 1.0])).unwrap();
    let picture = read_png(&scratch);
    // Cells of 110 pixels from (18, 18); the ground is black faded to 32 %, that is grey 173.
    assert_eq!(at(&picture, 18 + 55, 18 + 165), [173; 3]);
    assert_eq!(at(&picture, 18 + 165, 18 + 20), [173, 237, 173]);
    assert_eq!(at(&picture, 18 + 155, 18 + 165), palette::shade(1.0).rgb, "rows are counted downwards");
}

#[test]
fn graphs_of_any_kind_make_a_picture() {
    let scratch = Scratch::new("graph-odd.png");
    let mut odd = pair([f32::NAN, 0.0]);
    odd.vertices.push(Vertex { at: Some([1e30, -1e30]), value: f64::NAN, ..Vertex::default() });
    odd.vertices.push(Vertex { label: "a long label".into(), value: -1.0, ..Vertex::default() });
    for (from, to, probability) in [(0, 0, 1.0), (0, 99, 1.0), (1, 0, f64::NAN), (2, 3, 7.0)] {
        odd.edges.push(Edge { from, to, probability, hoped: true, planned: false });
    }
    let (map, empty) = (u_maze(), RgbImage::new(0, 0));
    let grounds = [
        Ground::Map(&map),
        Ground::Picture { picture: &empty, cells: [0, 3] },
        Ground::Lattice,
        Ground::Layers,
    ];
    for ground in grounds {
        for drawn in [&odd, &Graph::default()] {
            graph(&scratch.0, ground, drawn).unwrap();
            assert!(read_png(&scratch).0[0] >= 356);
        }
    }
    let flat = Map { bounds: Rect::default(), ..map };
    assert!(matches!(graph(&scratch.0, Ground::Map(&flat), &odd), Err(FigureError::Bounds { .. })));
}

#[test]
fn a_goal_space_has_a_panel_a_time_and_a_square_a_goal() {
    let scratch = Scratch::new("goal-space.png");
    let cell = |nth: usize| GoalSquare {
        group: "taxi at".into(),
        label: String::new(),
        cell: Some([nth % 2, nth / 2]),
    };
    let word = GoalSquare { group: "destination".into(), label: "R".into(), cell: None };
    let squares: Vec<_> = (0..4).map(cell).chain([word]).collect();
    let panel = |states: &[GoalState]| GoalPanel { title: "episode 5".into(), states: states.to_vec() };
    use GoalState::{Mastered, Plausible, Pruned, Unseen};
    let late = panel(&[Unseen, Plausible, Mastered, Mastered, Pruned]);
    goal_space(&scratch.0, &squares, &[panel(&[]), late]).unwrap();
    let picture = read_png(&scratch);
    assert_eq!(picture.0[0], 576);
    // Two panels of 216 pixels with 30 between them, in the middle; in each a grid of two cells of 34 pixels.
    let grid = |panel: u32, column: u32, row: u32| {
        let (x, y) = (57 + panel * 246 + 74 + column * 34 + 17, 18 + 32 + 24 + row * 34 + 17);
        at(&picture, x, y)
    };
    assert_eq!([grid(1, 1, 0), grid(1, 0, 1)], [palette::colour(2).rgb, palette::colour(1).rgb]);
    assert_eq!([grid(0, 1, 0), grid(0, 0, 1)], [grid(1, 0, 0); 2], "what is missing is unseen");
    let error = goal_space(&scratch.0, &squares, &[]).unwrap_err();
    assert!(error.to_string().contains("at least one goal and one panel"), "{error}");
}

#[test]
fn kept_features_are_filled_and_a_kept_distractor_is_red() {
    let scratch = Scratch::new("kept.png");
    let feature = |name: &str, distractor| Feature { name: name.into(), distractor };
    let features =
        [feature("x", false), feature("a name too long for its column", false), feature("noise", true)];
    let row = |values: [Option<&str>; 3]| Kept {
        label: "subgoal".into(),
        note: "reached 3 of 4".into(),
        values: values.map(|value| value.map(str::to_owned)).to_vec(),
    };
    let (good, bad) = (row([Some("3"), None, None]), row([None, None, Some("17")]));
    kept_features(&scratch.0, &features, &[good.clone(), Kept::default()]).unwrap();
    let (_, pixels) = read_png(&scratch);
    assert!(has(&pixels, palette::colour(1)), "the value is filled");
    let reds = |pixels: &[[u8; 3]]| pixels.iter().filter(|pixel| **pixel == palette::GOAL.rgb).count();
    let name = reds(&pixels);
    kept_features(&scratch.0, &features, &[good, bad]).unwrap();
    let (_, pixels) = read_png(&scratch);
    assert!(reds(&pixels) > name + 500, "a kept distractor is a red square, beside its red name");
    kept_features(&scratch.0, &features, &[]).unwrap();
    assert!(kept_features(&scratch.0, &[], &[]).unwrap_err().to_string().contains("at least one feature"));
}

#[test]
fn bins_and_briers_score_are_exact() {
    let pairs =
        vec![(0.0, 0.0), (0.05, 1.0), (0.5, 1.0), (0.75, 0.0), (1.0, 1.0), (f64::NAN, 1.0), (1.5, 0.0)];
    let series = Calibration { label: "edges".into(), colour: 3, pairs };
    let bin = |predicted, measured, count| Bin { predicted, measured, count };
    assert_eq!(series.bins(4), [bin(0.025, 0.5, 2), bin(0.5, 1.0, 1), bin(2.75 / 3.0, 1.0 / 3.0, 3)]);
    // 0, 0.9025, 0.25, 0.5625, 0 and 1.
    assert!((series.brier() - 2.715 / 6.0).abs() < 1e-12);
    assert!(Calibration::default().brier().is_nan() && Calibration::default().bins(0).is_empty());

    let scratch = Scratch::new("reliability.png");
    reliability(&scratch.0, "edges", &[series, Calibration::default()]).unwrap();
    assert!(has(&read_png(&scratch).1, palette::colour(3)));
    reliability(&scratch.0, "nothing", &[]).unwrap();
}
