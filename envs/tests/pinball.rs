//! Pinball as a world: boards that users write, episodes, pictures.

use std::collections::BTreeSet;

use inroads_envs::{
    End, Environment, Frame, Seed, Snapshot,
    pinball::{Ball, Configuration, Pay, Pinball, PinballError, Rules},
    registry::{self, AnyEnvironment, Options},
    world::{Drawn, Layout, Painter, Pictured, See, Symbolic, World},
};
use inroads_sim::raster::{Colour, Filter, Format, Scaler, Stencil};
use rand::RngExt;

const BOARDS: [&str; 5] = ["hard_single", "simple_single", "medium", "box", "empty"];

fn pinball(name: &str, rules: Rules) -> Pinball {
    Pinball::new(Configuration::named(name).unwrap(), rules).unwrap()
}

/// How far a point is from the nearest edge.
fn clearance(configuration: &Configuration, [x, y]: [f64; 2]) -> f64 {
    let edges = configuration
        .polygons()
        .iter()
        .flat_map(|corners| corners.iter().zip(corners.iter().cycle().skip(1)));
    let distance = |([ax, ay], [bx, by]): (&[f64; 2], &[f64; 2])| {
        let [ex, ey] = [bx - ax, by - ay];
        let share = (((x - ax) * ex + (y - ay) * ey) / (ex * ex + ey * ey)).clamp(0.0, 1.0);
        (x - ax - share * ex).hypot(y - ay - share * ey)
    };
    edges.map(distance).fold(f64::INFINITY, f64::min)
}

/// A ball moves a seventh of its radius at most between two looks at the walls: √2 × 2 / 20.
#[test]
fn who_starts_clear_of_walls_stays_clear_but_for_one_motion() {
    for name in BOARDS {
        let mut world = pinball(name, Rules::default());
        let radius = world.configuration().ball();
        let mut rng = Seed(1).stream("test", 0);
        let mut least = f64::INFINITY;
        for episode in 0..60 {
            world.begin(Layout::Random.draw(episode));
            if clearance(world.configuration(), world.ball().centre()) < radius {
                continue;
            }
            let mut choice = 4;
            for _ in 0..400 {
                // Some push this way and that, others long in one direction.
                if episode % 2 == 0 || rng.random_bool(0.15) {
                    choice = rng.random_range(0..5);
                }
                let step = world.act(choice);
                let at = world.ball().centre();
                assert!(world.free(at), "{name}: inside at {at:?}");
                least = least.min(clearance(world.configuration(), at) / radius);
                if step.end.is_some() {
                    break;
                }
            }
        }
        assert!((0.8585..1.05).contains(&least), "{name}: {least} radii from a wall");
    }
}

#[test]
fn the_layout_says_where_the_ball_starts() {
    let mut world = pinball("hard_single", Rules::THESIS);
    let mut starts = |layout: Layout| -> Vec<[f64; 2]> {
        let each = (0..20).map(|episode| {
            world.begin(layout.draw(episode));
            assert!(world.free(world.ball().centre()) && world.ball().speed() == 0.0);
            world.ball().centre()
        });
        each.collect()
    };
    assert!(starts(Layout::Fixed(42)).iter().all(|&start| start == [0.055, 0.95]));
    for layout in [Layout::Random, Layout::FixedMap(42)] {
        let some = starts(layout);
        assert_eq!(some, starts(layout));
        assert!((1..20).all(|i| some[i] != some[i - 1]));
        assert!(some.iter().flatten().all(|at| (0.02..0.98).contains(at)));
    }
}

#[test]
fn what_is_drawn_is_uniform_over_free_space() {
    // On the board with nothing but its sides: quarters of the square, half a percent of error in 10,000 draws.
    let world = pinball("empty", Rules::default());
    let goals = world.test_goals(Seed(7), 10_000);
    for (right, below) in [(false, false), (true, false), (false, true), (true, true)] {
        let quarter = goals.iter().filter(|[x, y]| (*x > 0.5) == right && (*y > 0.5) == below).count();
        assert!((2300..2700).contains(&quarter), "{quarter}");
    }
    // A third of the hardest board is covered.
    let hard = pinball("hard_single", Rules::default());
    assert!(hard.test_goals(Seed(7), 1000).iter().all(|&goal| hard.free(goal)));
    assert_ne!(hard.test_goals(Seed(7), 5), hard.test_goals(Seed(8), 5));
}

#[test]
fn a_step_pays_by_the_action_or_by_the_target() {
    let near = Ball { xdot: -0.5, ..Ball::at([0.947, 0.2]) };
    let paid = |pay| {
        let mut world = pinball("empty", Rules { pay, noise: 0.0 });
        let mut rewards: Vec<_> = (0..5).map(|choice| world.act(choice).reward).collect();
        world.restore(near).unwrap();
        let last = world.act(2);
        assert_eq!(last.end, Some(End::Terminated));
        rewards.push(last.reward);
        assert_eq!(last.reward, world.card().success_reward);
        rewards
    };
    assert_eq!(paid(Pay::Effort), [-5.0, -5.0, -5.0, -5.0, -1.0, 10_000.0]);
    assert_eq!(paid(Pay::Target), [0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
}

#[test]
fn noise_replaces_actions_as_often_as_it_says() {
    let idle = |noise: f64| {
        let mut world = pinball("empty", Rules { noise, ..Rules::default() });
        world.begin(Layout::Fixed(0).draw(3));
        let middle = Ball::at([0.5, 0.5]);
        let steps = (0..10_000).filter(|_| {
            world.restore(middle).unwrap();
            world.act(4).reward == -1.0
        });
        steps.count() as f64 / 10_000.0
    };
    // One in five replacements is the action itself. Four standard deviations.
    assert_eq!(idle(0.0), 1.0);
    assert!((idle(0.1) - 0.92).abs() < 0.011 && (idle(1.0) - 0.2).abs() < 0.016);
    for noise in [-0.1, 1.1, f64::NAN] {
        let rules = Rules { noise, ..Rules::default() };
        let error = Pinball::new(Configuration::named("box").unwrap(), rules).unwrap_err();
        assert!(matches!(error, PinballError::Noise(_)) && error.to_string().contains("between 0 and 1"));
    }
    let mut world = pinball("box", Rules::default());
    assert!(matches!(world.restore(Ball::at([f64::NAN, 0.0])), Err(PinballError::Ball(_))));
}

#[test]
fn a_state_comes_back_to_the_bit_in_the_middle_of_an_episode() {
    let noisy = pinball("medium", Rules { noise: 0.3, ..Rules::default() });
    let mut env = Symbolic::new(noisy, Layout::Random);
    let mut rng = Seed(2).stream("test", 0);
    for episode in 0..10 {
        env.reset(episode);
        let play = |env: &mut Symbolic<Pinball>, choices: &[usize]| {
            let steps = choices.iter().map_while(|choice| env.step(choice).ok());
            let steps: Vec<_> = steps.collect();
            (steps, env.world().ball())
        };
        let choices: Vec<usize> = (0..150).map(|_| rng.random_range(0..5)).collect();
        play(&mut env, &choices[..50]);
        let kept = env.save();
        let went = play(&mut env, &choices[50..]);
        env.reset(99);
        play(&mut env, &choices[..7]);
        env.load(&kept);
        assert_eq!(play(&mut env, &choices[50..]), went);
    }
}

/// Every filter, every colour, sizes that divide 500 and that do not.
const FORMATS: [Format; 7] = [
    Format::NATIVE,
    Format::THESIS,
    Format::THESIS_GREY,
    Format::ATARI,
    Format { colour: Colour::Luma, scale: None },
    Format { colour: Colour::Rgb, scale: Some(([50, 100], Filter::Area)) },
    Format { colour: Colour::Mean, scale: Some(([84, 64], Filter::Linear)) },
];

/// The whole picture, drawn anew.
fn drawn(configuration: &Configuration, ball: [f64; 2], format: Format) -> Frame {
    let pixels = |length: f64| (500.0 * length) as i32;
    let mut native = Frame::new([500, 500], 3);
    native.bytes_mut().as_chunks_mut().0.fill([232; 3]);
    for corners in configuration.polygons() {
        let corners: Vec<_> = corners.iter().map(|corner| corner.map(pixels)).collect();
        Stencil::polygon(&corners).fill([0, 0], [64; 3], &mut native);
    }
    let (at, radius) = configuration.target();
    Stencil::disc(pixels(radius) as u32).fill(at.map(pixels), [255, 0, 0], &mut native);
    Stencil::disc(pixels(configuration.ball()) as u32).fill(ball.map(pixels), [0, 0, 255], &mut native);
    let mut frame = Frame::default();
    Scaler::new([500, 500], format).run(|y, pixels| pixels.copy_from_slice(native.row(y)), &mut frame);
    frame
}

#[test]
fn painting_around_the_ball_is_drawing_everything() {
    let mut rng = Seed(3).stream("test", 0);
    for name in BOARDS {
        let mut world = pinball(name, Rules::default());
        for format in FORMATS {
            let mut painter = world.painter(format);
            let mut frame = Frame::new([3, 3], 1);
            // Anywhere: over the border, off the board, on the target.
            for _ in 0..12 {
                let at = [rng.random_range(-0.05..1.05), rng.random_range(-0.05..1.05)];
                world.restore(Ball::at(at)).unwrap();
                painter.paint(&world, &mut frame);
                assert_eq!((frame.size(), frame.channels()), painter.shape());
                assert!(frame == drawn(world.configuration(), at, format), "{name} {format:?} {at:?}");
            }
        }
    }
}

/// Where the surroundings of the ball would be, numbers overflow: that panics in builds that check for it.
#[test]
fn a_ball_far_off_the_board_is_not_seen() {
    let mut world = pinball("hard_single", Rules::default());
    let mut frame = Frame::default();
    for format in [Format::NATIVE, Format::THESIS] {
        let mut painter = world.painter(format);
        let mut seen = |world: &mut Pinball, x, y| {
            world.restore(Ball::at([x, y])).expect("a place");
            painter.paint(world, &mut frame);
            frame.bytes().to_vec()
        };
        let without = seen(&mut world, 2.0, 2.0);
        assert_ne!(seen(&mut world, 0.5, 0.5), without);
        for far in [-1e7, 1e7, -1e300, f64::MAX] {
            for [x, y] in [[far, 0.5], [0.5, far], [far, far], [far, -far]] {
                assert!(seen(&mut world, x, y) == without, "{x}, {y}");
            }
        }
    }
}

#[test]
fn copies_share_what_is_large() {
    assert!(size_of::<Pictured<Pinball>>() + size_of::<Frame>() < 2048);
    let [one, other] = [pinball("medium", Rules::default()), pinball("medium", Rules::THESIS)];
    assert!(std::sync::Arc::ptr_eq(one.configuration(), other.configuration()));
    // Formats do not get into each other's way, whichever came first.
    let mut world = pinball("box", Rules::default());
    world.begin(Layout::Fixed(0).draw(0));
    for format in [Format::THESIS, Format::ATARI, Format::THESIS] {
        let mut frame = Frame::default();
        world.painter(format).paint(&world, &mut frame);
        assert!(frame == drawn(world.configuration(), world.ball().centre(), format));
    }
}

#[test]
fn the_thesis_sees_frames_from_one_start() {
    let Ok(AnyEnvironment::Frames(mut env)) = registry::make("pinball-thesis") else { panic!("no frames") };
    let spec = env.spec();
    assert_eq!((spec.time_limit, spec.success_reward, spec.action.len()), (Some(1000), 1.0, 1));
    let mut frames = BTreeSet::new();
    for seed in 0..3 {
        env.reset(seed);
        let mut frame = Frame::default();
        env.observe(&mut frame);
        assert_eq!((frame.size(), frame.channels()), ([84, 84], 3));
        frames.insert(frame.bytes().to_vec());
    }
    assert_eq!(frames.len(), 1);
    let options = Options { see: Some(See::Symbols), layout: Some(Layout::Random), ..Options::default() };
    assert!(matches!(registry::make_with("pinball-thesis", &options), Ok(AnyEnvironment::Choices(_))));
}

#[test]
fn facts_are_hundredths() {
    let mut world = pinball("empty", Rules::default());
    world.restore(Ball::at([0.196, 0.9049])).unwrap();
    assert_eq!(world.facts().iter().map(|fact| fact.value).collect::<Vec<_>>(), [20.0, 90.0]);
}
