//! The files themselves: whether they are pictures, of which size, with which colours, and what odd data do to them.

mod systems;

use std::collections::HashSet;
use std::fs::File;
use std::path::PathBuf;

use super::*;

/// A file of its own, removed at the end.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        Self(std::env::temp_dir().join(format!("inroads-figures-{}-{name}", std::process::id())))
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

/// Size and colours of a PNG.
fn read_png(scratch: &Scratch) -> ([u32; 2], Vec<[u8; 3]>) {
    let mut decoder = png::Decoder::new(std::io::BufReader::new(File::open(&scratch.0).unwrap()));
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    let colours = bytes[..info.buffer_size()].chunks_exact(3).map(|pixel| [pixel[0], pixel[1], pixel[2]]);
    ([info.width, info.height], colours.collect())
}

fn has(pixels: &[[u8; 3]], colour: palette::Colour) -> bool {
    pixels.contains(&colour.rgb)
}

fn u_maze() -> Map {
    let open = [(1, 1), (1, 2), (1, 3), (2, 3), (3, 3), (3, 2), (3, 1)];
    let cells = (0..5).flat_map(|row| (0..5).map(move |column| (row, column)));
    let walls = cells
        .filter(|cell| !open.contains(cell))
        .map(|(row, column)| Rect::around([(column - 1) as f32 * 4.0, (row - 1) as f32 * 4.0], [2.0, 2.0]));
    Map {
        walls: walls.collect(),
        bounds: Rect { min: [-6.0, -6.0], max: [14.0, 14.0] },
        goal: Some(([0.0, 8.0], 0.6)),
        starts: vec![[0.0, 0.0]],
        key: None,
    }
}

fn panel(runs: Vec<Vec<(f64, f64)>>) -> Panel {
    let series = vec![Series { label: "DSC".into(), colour: 1, runs }];
    Panel {
        title: "U-maze".into(),
        x_label: "steps".into(),
        y_label: "return".into(),
        series,
        ..Panel::default()
    }
}

#[test]
fn curves_have_axes_and_the_colours_of_their_series() {
    let scratch = Scratch::new("curves.png");
    let rising = |slope: f64| (0..20).map(|step| (f64::from(step) * 1e3, slope * f64::from(step))).collect();
    let mut left = panel(vec![rising(1.0), rising(1.5), rising(2.0)]);
    left.series.push(Series { label: "DDPG".into(), colour: 2, runs: vec![rising(0.2), rising(0.4)] });
    let right = Panel { summary: Summary::MeanAndInterval, ..left.clone() };
    curves(&scratch.0, &[left, right]).unwrap();
    let (size, pixels) = read_png(&scratch);
    assert_eq!(size[0], 1400);
    assert!((450..550).contains(&size[1]), "{size:?}");
    for colour in [palette::WHITE, palette::INK, palette::colour(1), palette::colour(2)] {
        assert!(has(&pixels, colour), "{colour:?}");
    }
    assert!(!has(&pixels, palette::colour(3)));
    assert!(std::fs::metadata(&scratch.0).unwrap().len() < 150_000);
}

#[test]
fn odd_runs_make_a_picture_all_the_same() {
    let scratch = Scratch::new("odd.png");
    let odd = [
        vec![],
        vec![vec![]],
        vec![vec![(5.0, 1.0)]],
        vec![vec![(5.0, 1.0)], vec![(7.0, 1.0)]],
        vec![vec![(0.0, 3.0), (1.0, 3.0)]; 2],
        vec![vec![(0.0, f64::NAN), (f64::NAN, 1.0), (f64::INFINITY, 2.0)]],
        vec![vec![(0.0, 1.0), (1.0, f64::NAN), (2.0, 5.0)]],
        vec![vec![(0.0, f64::MIN), (1.0, f64::MAX)], vec![(0.0, 0.0), (1.0, 1e-300)]],
        vec![vec![(-1e300, 1.0), (1e300, -1.0)]],
    ];
    for runs in odd {
        for summary in [Summary::MedianAndRange, Summary::MeanAndInterval] {
            let levels = vec![Level { label: "nowhere".into(), y: f64::NAN }, Level::default()];
            let odd = Panel { summary, levels, y_range: Some((1.0, f64::NAN)), ..panel(runs.clone()) };
            curves(&scratch.0, &[odd.clone(), Panel::default(), odd]).unwrap();
            assert!(has(&read_png(&scratch).1, palette::INK), "{runs:?}");
        }
    }
}

#[test]
fn many_panels_stand_in_rows() {
    let scratch = Scratch::new("rows.png");
    let height = |count: usize| {
        curves(&scratch.0, &vec![panel(vec![vec![(0.0, 0.0), (1.0, 1.0)]]); count]).unwrap();
        read_png(&scratch).0[1]
    };
    assert_eq!(height(1), height(3));
    assert!(height(4) > height(3) && height(6) == height(4) && height(7) > height(6));
}

#[test]
fn sets_colour_the_inside_and_leave_the_walls_grey() {
    let scratch = Scratch::new("sets.png");
    let map = u_maze();
    let picture = |colour, left: bool| SetPicture {
        title: format!("skill {colour}"),
        subtitle: "covers half of free space".into(),
        colour,
        region: Raster::of(&map, 60, 60, |point| (point[0] < 4.0) == left),
        positives: vec![[1.0, 0.0], [f32::NAN, 0.0]],
        negatives: vec![[8.0, 4.0], [1e30, -1e30]],
    };
    sets(&scratch.0, &map, &[picture(1, true), picture(2, false)], "").unwrap();
    let ([width, height], pixels) = read_png(&scratch);
    assert_eq!((width, pixels.len()), (864, (width * height) as usize));
    let colours: HashSet<_> = pixels.iter().collect();
    for colour in [palette::WALL, palette::FLOOR, palette::GOAL, palette::INK] {
        assert!(colours.contains(&colour.rgb), "{colour:?}");
    }
    // Left panel: the start's surroundings are inside, so bluish; the right corridor is not.
    let at = |x: u32, y: u32| pixels[(y * width + x) as usize];
    let (left, top, scale) = (18, 18 + 54, 20);
    let inside = at(left + (1 + 6) * scale, top + (14 - 1) * scale);
    let outside = at(left + (8 + 6) * scale, top + (14 - 1) * scale);
    assert!(inside[2] > inside[0] + 60, "{inside:?}");
    assert_eq!(outside, palette::FLOOR.rgb);
}

#[test]
fn a_raster_counts_free_space_from_the_lowest_row() {
    let map = Map { walls: vec![Rect { min: [0.0, 0.0], max: [1.0, 2.0] }], ..Map::default() };
    let map = Map { bounds: Rect { min: [0.0, 0.0], max: [2.0, 2.0] }, ..map };
    let low = Raster::of(&map, 2, 2, |point| point[1] < 1.0);
    assert_eq!(low.inside, [true, true, false, false]);
    assert_eq!(low.share_of_free_space(&map), 0.5);
    let walled = Map { walls: vec![map.bounds], ..map };
    assert!(low.share_of_free_space(&walled).is_nan());
}

#[test]
fn regions_overlap_by_cells_and_have_their_middle_inside() {
    let map = Map { bounds: Rect { min: [0.0, 0.0], max: [3.0, 3.0] }, ..Map::default() };
    let left = Raster::of(&map, 3, 3, |point| point[0] < 2.0);
    let low = Raster::of(&map, 3, 3, |point| point[1] < 1.0);
    assert_eq!(left.overlap(&low), 2.0 / 7.0);
    let empty = Raster::of(&map, 3, 3, |_| false);
    assert_eq!((left.overlap(&empty), empty.overlap(&empty)), (0.0, 1.0));
    // Of an L the mean is (1.1, 1.1), in no cell of it.
    let bent = Raster::of(&map, 3, 3, |[x, y]| x < 1.0 || y < 1.0);
    let [x, y] = bent.middle(&map).unwrap();
    assert!(x < 1.0 || y < 1.0, "{x}, {y}");
    assert_eq!(low.middle(&map), Some([1.5, 0.5]));
    assert_eq!(empty.middle(&map), None);
}

#[test]
fn a_key_is_a_blue_disc_where_there_is_one() {
    let scratch = Scratch::new("key.png");
    for key in [None, Some([8.0, 4.0])] {
        sets(&scratch.0, &Map { key, ..u_maze() }, &[], "").unwrap();
        assert_eq!(has(&read_png(&scratch).1, palette::KEY), key.is_some());
    }
}

#[test]
fn free_space_is_within_the_bounds_and_in_no_wall() {
    let map = u_maze();
    assert!(map.is_free([0.0, 0.0]) && !map.is_free([0.0, 4.0]) && !map.is_free([99.0, 0.0]));
}

#[test]
fn trajectories_have_the_colour_of_the_acting_skill_and_y_upwards() {
    let scratch = Scratch::new("trajectories.png");
    let points = (0..40).map(|step| ([step as f32 * 0.2, 0.0], [0, 3][step / 20]));
    let broken = vec![([0.0, 0.0], 0), ([f32::NAN, 0.0], 0), ([1e30, 1e30], 1), ([0.0, 1.0], 2)];
    let paths =
        [Trajectory { points: points.collect() }, Trajectory { points: broken }, Trajectory::default()];
    trajectories(&scratch.0, &u_maze(), &paths, "of seed 3").unwrap();
    let ([width, height], pixels) = read_png(&scratch);
    assert!(width == 676 && height > width);
    assert!(has(&pixels, palette::colour(0)) && has(&pixels, palette::colour(3)));
    let crowd = |skills: usize| {
        let points = (0..skills).map(|skill| ([skill as f32 * 0.1, 0.0], skill)).collect();
        trajectories(&scratch.0, &u_maze(), &[Trajectory { points }], "").unwrap();
        read_png(&scratch).0[1]
    };
    assert!(crowd(15) > crowd(14) && crowd(15) == crowd(90), "the legend names some and counts the others");
    // The goal is at y = 8, so in the upper half of the map.
    let goal = pixels.iter().position(|pixel| *pixel == palette::GOAL.rgb).unwrap();
    assert!(goal < (width * 330) as usize);
}

#[test]
fn no_skill_and_no_trajectory_leave_the_bare_map() {
    let (one, other) = (Scratch::new("none-1.png"), Scratch::new("none-2.png"));
    sets(&one.0, &u_maze(), &[], "").unwrap();
    trajectories(&other.0, &u_maze(), &[], "").unwrap();
    for scratch in [one, other] {
        let (_, pixels) = read_png(&scratch);
        assert!(has(&pixels, palette::WALL) && has(&pixels, palette::GOAL));
    }
}

#[test]
fn a_movie_has_a_frame_a_pose_and_is_small() {
    let scratch = Scratch::new("movie.gif");
    let poses: Vec<Pose> = (0..100)
        .map(|step| Pose {
            step,
            at: [step as f32 * 0.08, 0.0],
            heading: step as f32 * 0.1,
            skill: step / 40,
        })
        .collect();
    movie(&scratch.0, &u_maze(), &poses).unwrap();
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(File::open(&scratch.0).unwrap()).unwrap();
    assert!(decoder.width() == 480 && decoder.height() > 480);
    let mut seen = HashSet::new();
    let mut count = 0;
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        count += 1;
        seen.extend(
            frame
                .buffer
                .chunks_exact(4)
                .filter(|pixel| pixel[3] > 0)
                .map(|pixel| [pixel[0], pixel[1], pixel[2]]),
        );
    }
    assert_eq!(count, 100);
    assert!((0..3).all(|skill| seen.contains(&palette::colour(skill).rgb)));
    assert!(std::fs::metadata(&scratch.0).unwrap().len() < 300_000);
}

#[test]
fn a_movie_of_one_pose_or_of_poses_that_are_no_numbers_is_a_movie() {
    let scratch = Scratch::new("still.gif");
    movie(&scratch.0, &u_maze(), &[Pose::default()]).unwrap();
    let lost = Pose { at: [f32::NAN; 2], heading: f32::NAN, ..Pose::default() };
    movie(&scratch.0, &u_maze(), &[Pose::default(), lost, lost, Pose { step: 3, ..lost }]).unwrap();
    let decoder = gif::DecodeOptions::new().read_info(File::open(&scratch.0).unwrap()).unwrap();
    assert_eq!(decoder.into_iter().map(Result::unwrap).count(), 4);
}

#[test]
fn the_same_data_give_the_same_bytes() {
    let scratch = Scratch::new("same.gif");
    let poses = [Pose::default(), Pose { step: 1, at: [1.0, 0.0], skill: 2, ..Pose::default() }];
    let draw = || {
        movie(&scratch.0, &u_maze(), &poses).unwrap();
        std::fs::read(&scratch.0).unwrap()
    };
    assert_eq!(draw(), draw());
}

#[test]
fn errors_name_the_file_and_the_reason() {
    let map = u_maze();
    let missing = std::env::temp_dir().join("inroads-no-such-folder").join("figure.png");
    let error = trajectories(&missing, &map, &[], "").unwrap_err();
    assert!(matches!(error, FigureError::Write { .. }));
    assert!(error.to_string().contains("inroads-no-such-folder"), "{error}");

    assert!(curves(&missing, &[]).unwrap_err().to_string().contains("at least one panel"));
    assert!(movie(&missing, &map, &[]).unwrap_err().to_string().contains("at least one frame"));
    for max in [[-6.0, 14.0], [f32::NAN, 14.0], [f32::INFINITY, 14.0]] {
        let flat = Map { bounds: Rect { min: [-6.0, -6.0], max }, ..map.clone() };
        assert!(matches!(sets(&missing, &flat, &[], ""), Err(FigureError::Bounds { .. })));
    }
    let short = Raster { nx: 3, ny: 3, inside: vec![true; 8] };
    let picture = SetPicture { title: "skill 7".into(), region: short, ..SetPicture::default() };
    let error = sets(&missing, &map, &[picture], "").unwrap_err().to_string();
    assert!(error.contains("skill 7") && error.contains("8 values for 3 × 3"), "{error}");
    let crowd = vec![SetPicture::default(); 1000];
    assert!(matches!(sets(&missing, &map, &crowd, ""), Err(FigureError::Size { .. })));
}

#[test]
fn the_fonts_parse_and_have_the_letters_we_use() {
    for weight in [text::Weight::Regular, text::Weight::Bold] {
        let face = text::face(weight).unwrap();
        assert!("aZ09%→−·…×θ".chars().all(|letter| face.glyph_index(letter).is_some()));
        assert!(text::width("wide", 16.0, weight) > text::width("wi", 16.0, weight));
    }
    let (short, size) = text::fit("a title that is far too long", 20.0, text::Weight::Regular, 100.0);
    assert!(short.ends_with('…') && size == 15.0);
    assert!(text::width(&short, size, text::Weight::Regular) <= 101.0);
    assert_eq!(text::wrap("one two three", 16.0, 80.0), ["one two", "three"]);
}

#[test]
fn dots_and_logarithms_take_odd_numbers() {
    let scratch = Scratch::new("dots.png");
    let column =
        |colour, values: &[f64]| Column { label: format!("agent {colour}"), colour, values: values.into() };
    let arena = Dots {
        title: "arena".into(),
        y_label: "steps".into(),
        y_range: None,
        columns: vec![column(1, &[3.0, 5.0, f64::NAN]), column(2, &[]), column(3, &[f64::INFINITY, 4.0])],
    };
    dots(&scratch.0, &[arena, Dots::default()], "not done yet: one").unwrap();
    let (size, pixels) = read_png(&scratch);
    assert!(size[0] == 942 && has(&pixels, palette::colour(1)), "{size:?}");
    assert!(dots(&scratch.0, &[], "").is_err());

    let falling = (0..6).map(|step| (f64::from(step), 10f64.powi(-step))).collect();
    let odd = vec![(0.0, 0.0), (1.0, -1.0), (2.0, f64::NAN), (3.0, 0.5)];
    let log = Panel { log: true, y_range: Some((1e-4, 1.0)), ..panel(vec![falling, odd]) };
    curves_on(
        &scratch.0,
        &[log.clone(), Panel { y_range: None, ..log }],
        &Sheet { columns: 1, remark: "x".into() },
    )
    .unwrap();
    let (size, pixels) = read_png(&scratch);
    assert!(size[0] == 820 && size[1] > 800 && has(&pixels, palette::colour(1)), "{size:?}");
}
