//! The ant in mazes: what it sees, how it starts, what it leaves behind.

use inroads_envs::{
    End, Environment, Goals, Pay, Render, Rng, Seed, Snapshot, TimeLimit,
    maze::{
        AntMaze, Maze, MazeError, Starts,
        catalogue::{ALL, ANT_FOUR_ROOMS, ANT_MEDIUM_MAZE, ANT_REACHER, ANT_U_MAZE, Walker},
    },
    registry::{self, AnyEnvironment, MakeError, Options},
};
use inroads_sim::rigid::{CellMap, Joint, Mass, Pose, StateError, Vector, ant};
use rand::RngExt;

fn maze(maze: &Maze<'_>) -> AntMaze {
    AntMaze::new(maze).unwrap()
}

fn seen(env: &mut impl Environment<Observation = Vec<f32>>) -> Vec<f32> {
    let mut seen = Vec::new();
    env.observe(&mut seen);
    seen
}

fn action(rng: &mut Rng) -> Vec<f32> {
    (0..8).map(|_| rng.random_range(-1.0..=1.0)).collect()
}

#[test]
fn the_ant_sees_its_positions_and_velocities_in_mujoco_s_order() {
    let mut env = maze(&ANT_U_MAZE);
    env.reset(0);
    let spec = env.spec();
    let names: Vec<_> = spec.observation.dimensions().iter().map(|d| d.name.as_ref()).collect();
    assert_eq!(names[..9], ["x", "y", "z", "qw", "qx", "qy", "qz", "shin 1", "foot 1"]);
    assert_eq!(names[15..23], ["vx", "vy", "vz", "wx", "wy", "wz", "shin 1 speed", "foot 1 speed"]);
    assert_eq!((names.len(), spec.action.len()), (29, 8));
    let driven: Vec<_> = spec.action.dimensions().iter().map(|d| d.name.as_ref()).collect();
    assert_eq!(driven[..4], ["shin 4", "foot 4", "shin 1", "foot 1"]);
    let expected = [&env.configuration().q[..], &env.configuration().v[..]].concat();
    assert_eq!(seen(&mut env), expected);
}

#[test]
fn starts_are_noisy_within_the_reset_of_gymnasium() {
    let mut env = maze(&ANT_U_MAZE);
    let starts: Vec<_> = (0..300).map(|seed| (env.reset(seed), seen(&mut env)).1).collect();
    let near = |index: usize, mean: f32| starts.iter().all(|s| (s[index] - mean).abs() <= 0.1);
    assert!(near(0, 0.0) && near(1, 0.0) && near(2, 0.75) && (7..15).all(|joint| near(joint, 0.0)));
    let spread = |index: usize| starts.iter().map(|s| s[index] * s[index]).sum::<f32>() / 300.0;
    // A uniform number of ±0.1 has variance 0.0033, velocities have 0.01.
    assert!((0.0025..0.0042).contains(&spread(0)) && (0.0025..0.0042).contains(&spread(9)));
    assert!((15..29).all(|index| (0.007..0.013).contains(&spread(index))));
    let length = |s: &Vec<f32>| s[3..7].iter().map(|x| x * x).sum::<f32>();
    assert!(starts.iter().all(|s| (length(s) - 1.0).abs() < 1e-5));
    assert!(starts[0] != starts[1] && starts[0] == (env.reset(0), seen(&mut env)).1);
}

#[test]
fn ants_start_anywhere_in_the_arena_without_touching_its_walls() {
    let mut env = maze(&ANT_REACHER);
    let starts: Vec<_> = (0..500).map(|seed| (env.reset(seed), seen(&mut env)).1).collect();
    assert!(starts.iter().all(|s| s[0].abs() < 9.7 && s[1].abs() < 9.7));
    assert!(starts.iter().all(|s| s[0].hypot(s[1]) > 0.6 - 0.15));
    for corner in [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]] {
        let inside = starts.iter().filter(|s| s[0] * corner[0] > 0.0 && s[1] * corner[1] > 0.0).count();
        assert!((90..160).contains(&inside), "{inside} of 125 expected about {corner:?}");
    }
    // The corners from which section 4.2.3 evaluates.
    env.set_starts(Starts::At(&[[9.0, 9.0], [9.0, -9.0], [-9.0, 9.0], [-9.0, -9.0]])).unwrap();
    env.reset(0);
    assert!((seen(&mut env)[0].abs() - 9.0).abs() <= 0.1);
}

#[test]
fn an_ant_in_a_wall_is_refused() {
    let mut env = maze(&ANT_U_MAZE);
    env.reset(0);
    let before = seen(&mut env);
    let mut inside = env.configuration().clone();
    // The ant's feet reach 0.9 m along x and y, the wall begins at y = 2.
    inside.q[1] = 1.5;
    assert!(matches!(env.restore(&inside), Err(StateError::InWall { .. })));
    inside.q[1] = 4.0;
    assert!(matches!(env.restore(&inside), Err(StateError::InWall { .. })));
    inside.q.pop();
    assert!(matches!(env.restore(&inside), Err(StateError::Length { .. })));
    assert_eq!(seen(&mut env), before);
    assert!(matches!(
        env.set_starts(Starts::At(&[[0.0, 1.5]])),
        Err(MazeError::Start { at: [0.0, 1.5], .. })
    ));
}

#[test]
fn what_follows_a_loaded_state_does_not_depend_on_what_came_before() {
    let mut env = TimeLimit::new(maze(&ANT_U_MAZE), 1000);
    let mut rng = Seed(3).stream("test", 0);
    for seed in 0..3 {
        env.reset(seed);
        for _ in 0..60 {
            env.step(&action(&mut rng)).unwrap();
        }
        let saved = env.save();
        let actions: Vec<_> = (0..100).map(|_| action(&mut rng)).collect();
        let future = |env: &mut TimeLimit<AntMaze>| -> Vec<Vec<u32>> {
            actions
                .iter()
                .map(|a| (env.step(a).unwrap(), seen(env).iter().map(|x| x.to_bits()).collect()).1)
                .collect()
        };
        let first = future(&mut env);
        let mut other = TimeLimit::new(maze(&ANT_U_MAZE), 1000);
        other.reset(50);
        for _ in 0..23 {
            env.step(&action(&mut rng)).unwrap();
            other.step(&action(&mut rng)).unwrap();
        }
        env.load(&saved);
        other.load(&saved);
        assert_eq!(future(&mut env), first);
        assert_eq!(future(&mut other), first, "in another ant's world");
    }
}

#[test]
fn an_episode_is_the_same_whatever_came_before() {
    let play = |env: &mut AntMaze, seed| -> Vec<Vec<u32>> {
        let mut rng = Seed(seed).stream("test", 1);
        env.reset(seed);
        (0..100)
            .map(|_| {
                (env.step(&action(&mut rng)).unwrap(), seen(env).iter().map(|x| x.to_bits()).collect()).1
            })
            .collect()
    };
    let mut env = maze(&ANT_FOUR_ROOMS);
    let first = play(&mut env, 4);
    for other in 10..13 {
        play(&mut env, other);
        assert_eq!(play(&mut env, 4), first);
    }
    assert_eq!(play(&mut maze(&ANT_FOUR_ROOMS), 4), first);
}

#[test]
fn steps_pay_what_the_pure_function_of_the_observation_says() {
    for pay in [Pay::Sparse, Pay::Dense { price: 1.0 }] {
        let mut env = maze(&Maze { pay, ..ANT_U_MAZE });
        let mut rng = Seed(7).stream("test", 0);
        let (mut achieved, mut reached, mut seed) = (Vec::new(), 0, 0);
        env.reset(seed);
        for step in 0..400 {
            if step % 20 == 0 {
                // Just beyond the tolerance: a push either way decides.
                let goal = [seen(&mut env)[0] + 0.601, seen(&mut env)[1]];
                env.set_goal(&goal).unwrap();
            }
            let paid = env.step(&action(&mut rng)).unwrap();
            let now = seen(&mut env);
            env.achieved(&now, &mut achieved);
            assert_eq!(env.reward(&achieved, env.goal()), paid);
            assert_eq!(achieved, seen(&mut env)[..2]);
            if paid.end.is_some() {
                (reached, seed) = (reached + 1, seed + 1);
                env.reset(seed);
            }
        }
        assert!(reached > 2, "{reached} goals were reached");
    }
}

#[test]
fn timed_ants_see_a_thousandth_a_step() {
    let Ok(AnyEnvironment::Vectors(mut env)) = registry::make("ant-medium-maze-timed") else {
        panic!("it is in the registry")
    };
    let mut rng = Seed(0).stream("test", 0);
    for seed in 0..2 {
        env.reset(seed);
        for step in 0..20 {
            assert_eq!((seen(&mut env).len(), seen(&mut env)[29]), (30, 0.001 * step as f32));
            env.step(&action(&mut rng)).unwrap();
        }
    }
}

/// The ant with half its torque: a body of the user's.
fn body() -> inroads_sim::rigid::Model {
    let mut body = ant::model(15.0);
    body.name = "half an ant".into();
    body
}

#[test]
fn a_user_s_body_stands_where_the_ant_stands() {
    let mut body = body();
    // Without the fourth leg: 13 positions, 12 velocities, 6 actuators.
    body.links.truncate(10);
    body.actuators.retain(|actuator| actuator.link < 10);
    let options = Options { body: Some(&body), ..Options::default() };
    let Ok(AnyEnvironment::Vectors(mut env)) = registry::make_with("ant-u-maze", &options) else {
        panic!("the body can walk")
    };
    env.reset(0);
    env.step(&vec![1.0; 6]).unwrap();
    assert_eq!((seen(&mut env).len(), env.spec().observation.len()), (25, 25));
}

#[test]
fn a_body_that_breaks_down_truncates_its_episode_and_the_next_one_is_sound() {
    let monster = ant::model(1e12);
    let mut env = AntMaze::walked_by(&ANT_U_MAZE, &monster).unwrap();
    env.reset(0);
    let first = seen(&mut env);
    let last = (0..100).map(|_| env.step(&vec![1.0; 8]).unwrap()).find(|step| step.end.is_some()).unwrap();
    assert_eq!((last.end, last.reward), (Some(End::Truncated), -1.0));
    assert!(env.fault().is_some_and(|fault| fault.contains("ant")), "{:?}", env.fault());
    assert!(seen(&mut env).iter().all(|x| x.is_finite()), "what was last seen stays");
    assert!(env.step(&vec![0.0; 8]).is_err());
    env.reset(0);
    assert_eq!((seen(&mut env), env.fault()), (first, None));
    let mut fresh = AntMaze::walked_by(&ANT_U_MAZE, &monster).unwrap();
    fresh.reset(0);
    for _ in 0..30 {
        assert_eq!(env.step(&vec![0.0; 8]), fresh.step(&vec![0.0; 8]));
        assert_eq!(seen(&mut env), seen(&mut fresh));
    }
}

#[test]
fn no_strength_takes_a_body_out_of_the_maze() {
    let map = CellMap::parse(ANT_U_MAZE.cells, ANT_U_MAZE.scale).unwrap();
    for gear in [300.0, 3000.0, 30_000.0, 300_000.0] {
        let mut env = AntMaze::walked_by(&ANT_U_MAZE, &ant::model(gear)).unwrap();
        let mut rng = Seed(1).stream("test", 0);
        let (mut seed, mut faults) = (0, 0);
        env.reset(seed);
        for _ in 0..300 {
            let end = env.step(&action(&mut rng)).unwrap().end;
            let now = seen(&mut env);
            assert!(!map.is_wall([f64::from(now[0]), f64::from(now[1])]), "{gear} N m: at {:?}", &now[..3]);
            if end.is_some() {
                faults += u32::from(env.fault().is_some());
                seed += 1;
                env.reset(seed);
            }
        }
        assert!(gear < 3000.0 || faults > 0, "{gear} N m break nothing");
    }
}

#[test]
fn bodies_and_maps_that_cannot_be_are_refused_by_name() {
    let refused = |name: &str, options: Options<'_>| match registry::make_with(name, &options) {
        Err(error) => (error.to_string(), error),
        Ok(_) => panic!("{name} was built"),
    };
    let fixed = {
        let mut body = body();
        body.links[0].joint = Joint::Fixed;
        body
    };
    let (text, _) = refused("ant-u-maze", Options { body: Some(&fixed), ..Options::default() });
    assert!(
        text.contains("`ant-u-maze`") && text.contains("half an ant") && text.contains("free joint"),
        "{text}"
    );
    let bent = {
        let mut body = body();
        body.links[3].mass = Some(Mass { mass: -1.0, place: Pose::IDENTITY, inertia: Vector::ONE });
        body
    };
    let (text, _) = refused("ant-u-maze", Options { body: Some(&bent), ..Options::default() });
    assert!(text.contains("half an ant") && text.contains("foot 1") && text.contains("mass"), "{text}");
    let body = body();
    let (text, error) = refused("point-maze", Options { body: Some(&body), ..Options::default() });
    assert_eq!(error, MakeError::Option { name: "point-maze", option: "body" });
    assert_eq!(text, "`point-maze` takes no option `body`; the mazes of the ant do");
    let open = Options { map: Some("####\n#rg.\n####"), ..Options::default() };
    assert_eq!(
        refused("ant-u-maze", open).1,
        MakeError::Maze { name: "ant-u-maze", why: MazeError::Open { line: 2, column: 4 } }
    );
    let narrow = Options { scale: Some(1.5), ..Options::default() };
    assert!(matches!(refused("ant-u-maze", narrow).1, MakeError::Maze { why: MazeError::Start { .. }, .. }));
}

#[test]
fn scenes_and_pictures_show_the_ant_and_its_heading() {
    let mut env = maze(&ANT_MEDIUM_MAZE);
    env.reset(0);
    let before = seen(&mut env);
    let picture = env.picture();
    assert_eq!(seen(&mut env), before, "nobody looked");
    let resting = picture.observation_at([4.0, 0.0]);
    assert_eq!((resting.len(), resting[0]), (29, 4.0));
    assert!(picture.heading(&resting).abs() < 0.1 && (0.5..0.7).contains(&resting[2]), "{resting:?}");
    assert!(resting[15..].iter().all(|speed| speed.abs() < 0.1), "it stands still: {resting:?}");
    let mut turned = env.configuration().clone();
    turned.q[3..7].copy_from_slice(&[0.5_f32.cos(), 0.0, 0.0, 0.5_f32.sin()]);
    env.restore(&turned).unwrap();
    assert!((picture.heading(&seen(&mut env)) - 1.0).abs() < 1e-5);
    let scene = env.drawing().bodies().unwrap();
    assert_eq!((scene.marks.len(), scene.marks[0].at), (1, [20.0, 20.0]));
    assert_eq!(scene.solids.len(), picture.walls.len() + 13);
}

#[test]
fn every_ant_of_the_registry_has_the_limit_and_tolerance_of_the_thesis() {
    let ants: Vec<_> = ALL.iter().filter(|listed| listed.walker == Walker::Ant).collect();
    assert_eq!(ants.len(), 14);
    for listed in ants {
        let AnyEnvironment::Vectors(env) = registry::make(listed.maze.name).unwrap() else {
            panic!("ants are driven by vectors")
        };
        let goal = env.spec().goal.clone().unwrap();
        assert_eq!((env.spec().time_limit, goal.tolerance, goal.dims), (Some(1000), 0.6, vec![0, 1]));
    }
}
