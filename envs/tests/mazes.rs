//! What all mazes keep: starts, goals, keys, snapshots, faults, and what users may change.

use inroads_envs::{
    End, Environment, GoalError, Goals, Pay, Render, Rng, Seed, Snapshot, Step, TimeLimit,
    maze::{
        CORRIDOR, Heading, Maze, MazeError, MazeTask, PointMaze, Robot, Starts, Stride, U_MAZE,
        catalogue::{E_MAZE, FOUR_ROOMS, LOCK_AND_KEY, REACHER},
    },
    registry::{self, AnyEnvironment, MakeError, Options},
};
use inroads_sim::{
    rigid::{CellMap, MapError, PointState, Rectangle},
    view::Solid,
};
use rand::RngExt;

type Vectors = Box<dyn inroads_envs::Domain<Vec<f32>, Vec<f32>>>;

fn vectors(env: AnyEnvironment) -> Vectors {
    match env {
        AnyEnvironment::Vectors(env) => env,
        _ => panic!("mazes are walked with vectors"),
    }
}

fn seen(env: &mut impl Environment<Observation = Vec<f32>>) -> Vec<f32> {
    let mut seen = Vec::new();
    env.observe(&mut seen);
    seen
}

fn action(env: &impl Environment, rng: &mut Rng) -> Vec<f32> {
    (0..env.spec().action.len()).map(|_| rng.random_range(-1.0..=1.0)).collect()
}

fn at(maze: &mut PointMaze, [x, y]: [f64; 2]) {
    maze.restore(PointState { x, y, ..PointState::default() }).unwrap();
}

#[test]
fn both_starts_of_the_e_maze_are_used() {
    let mut maze = PointMaze::new(&E_MAZE).unwrap();
    let starts: Vec<_> = (0..400).map(|seed| (maze.reset(seed), maze.state()).1).collect();
    let lower = starts.iter().filter(|s| (s.y - 16.0).abs() <= 0.1).count();
    let upper = starts.iter().filter(|s| s.y.abs() <= 0.1).count();
    assert!(lower + upper == 400 && (160..240).contains(&lower), "{upper} above, {lower} below");
    assert_eq!(maze.goal(), [0.0, 8.0]);
}

#[test]
fn starts_anywhere_cover_the_free_space_evenly_but_for_the_goal() {
    let mut maze = PointMaze::new(&REACHER).unwrap();
    let starts: Vec<_> = (0..4000).map(|seed| (maze.reset(seed), maze.state()).1).collect();
    // The arena's floor reaches to 10.5 and the robot's ball to 0.5 about it; the noise is 0.1.
    assert!(starts.iter().all(|s| s.x.abs() < 10.1 && s.y.abs() < 10.1));
    assert!(starts.iter().all(|s| s.x.hypot(s.y) > 0.6 - 0.15), "no episode starts at its goal");
    for corner in [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]] {
        let inside = starts.iter().filter(|s| s.x * corner[0] > 5.0 && s.y * corner[1] > 5.0).count();
        assert!((200..300).contains(&inside), "{inside} of 250 expected about {corner:?}");
    }
}

#[test]
fn starts_can_be_listed_and_are_tried_before_they_are_taken() {
    let mut maze = PointMaze::new(&REACHER).unwrap();
    let corners = [[9.0, 9.0], [-9.0, 9.0]];
    maze.set_starts(Starts::At(&corners)).unwrap();
    for seed in 0..50 {
        maze.reset(seed);
        assert!((maze.state().x.abs() - 9.0).abs() <= 0.1 && (maze.state().y - 9.0).abs() <= 0.1);
    }
    assert!(matches!(
        maze.set_starts(Starts::At(&[[0.0, 12.0]])),
        Err(MazeError::Start { at: [0.0, 12.0], .. })
    ));
    assert!(matches!(maze.set_starts(Starts::At(&[])), Err(MazeError::NoRoom(_))));
    maze.reset(3);
    assert!((maze.state().y - 9.0).abs() <= 0.1, "a refusal changes nothing");
}

#[test]
fn the_lock_opens_with_the_key_and_only_with_it() {
    let mut maze = PointMaze::new(&LOCK_AND_KEY).unwrap();
    let still = |maze: &mut PointMaze| maze.step(&vec![0.0, 0.0]).unwrap();
    let (key, lock, opened) = ([8.0, 8.0], [0.0, 8.0], Step { reward: 0.0, end: Some(End::Terminated) });
    let goes_on = Step { reward: -1.0, end: None };
    assert_eq!(maze.spec().observation.len(), 7);
    // At the lock without the key: nothing. At the key: it is held, nothing else. Neither: nothing.
    for (place, has_key) in
        [(lock, 0.0), (key, 1.0), ([8.0, 8.65], 0.0), ([8.0, 8.55], 1.0), ([0.0, 0.0], 0.0)]
    {
        at(&mut maze, place);
        assert_eq!((still(&mut maze), seen(&mut maze)[2]), (goes_on, has_key), "{place:?}");
    }
    // With the key: only within 0.6 m of the lock, and the key is kept on the way.
    at(&mut maze, key);
    let mut carried = maze.save();
    for (place, expected) in [([0.0, 7.35], goes_on), ([0.0, 7.45], opened), (lock, opened), (key, goes_on)] {
        let mut moved = PointMaze::new(&LOCK_AND_KEY).unwrap();
        at(&mut moved, place);
        carried = carried.with_robot(moved.save());
        maze.load(&carried);
        assert_eq!((still(&mut maze), seen(&mut maze)[2]), (expected, 1.0), "{place:?}");
    }
    // A new episode starts without it.
    maze.reset(0);
    assert_eq!(seen(&mut maze)[2], 0.0);
}

#[test]
fn the_key_lies_on_the_floor_until_it_is_held() {
    let mut maze = PointMaze::new(&LOCK_AND_KEY).unwrap();
    maze.reset(0);
    assert_eq!(maze.drawing().bodies().unwrap().marks.len(), 2);
    at(&mut maze, [8.0, 8.0]);
    assert_eq!(maze.drawing().bodies().unwrap().marks.len(), 1);
    let wrong = |cells, locked| PointMaze::new(&Maze { cells, locked, ..U_MAZE }).err();
    assert_eq!(wrong("#r.g#", true), Some(MazeError::Keys { found: 0, expected: 1 }));
    assert_eq!(wrong("#rkg#", false), Some(MazeError::Keys { found: 1, expected: 0 }));
}

/// Random steps: what each pays is what the pure function says of the observation behind it, for goals of all
/// kinds.
fn pays_what_the_function_says<R: Robot>(mut maze: MazeTask<R>, steps: u32) {
    let mut rng = Seed(7).stream("test", 0);
    let mut achieved = Vec::new();
    let (mut seed, mut reached) = (0, 0);
    maze.reset(seed);
    for step in 0..steps {
        if step % 50 == 0 {
            // Every other goal is near the robot, so that some are reached.
            let mut goal = maze.sample_goal(&mut rng);
            if step % 100 == 0 {
                let now = seen(&mut maze);
                maze.achieved(&now, &mut goal);
            }
            maze.set_goal(&goal).unwrap();
            assert_eq!((maze.goal(), &maze.spec().goal.as_ref().unwrap().at[..]), (&goal[..], &goal[..]));
        }
        let paid = maze.step(&action(&maze, &mut rng)).unwrap();
        let now = seen(&mut maze);
        maze.achieved(&now, &mut achieved);
        assert_eq!(maze.reward(&achieved, maze.goal()), paid);
        assert_eq!(maze.spec().goal.as_ref().unwrap().reached(&now), paid.end.is_some());
        if paid.end.is_some() {
            reached += 1;
            seed += 1;
            maze.reset(seed);
        }
    }
    assert!(reached > 2, "{reached} goals were reached");
}

#[test]
fn steps_pay_what_the_pure_function_of_the_observation_says() {
    for pay in [Pay::Sparse, Pay::Dense { price: 0.1 }, Pay::Dense { price: 1.0 }] {
        for maze in [U_MAZE, FOUR_ROOMS, LOCK_AND_KEY] {
            pays_what_the_function_says(PointMaze::new(&Maze { pay, ..maze }).unwrap(), 3000);
        }
        pays_what_the_function_says(
            PointMaze::striding(&Maze { pay, ..E_MAZE }, Stride::Small).unwrap(),
            3000,
        );
    }
}

#[test]
fn goals_are_drawn_from_free_space_and_walls_are_refused() {
    let mut maze = PointMaze::new(&E_MAZE).unwrap();
    let map = CellMap::parse(E_MAZE.cells, E_MAZE.scale).unwrap();
    let mut rng = Seed(1).stream("test", 0);
    let goals: Vec<_> = (0..2200).map(|_| maze.sample_goal(&mut rng)).collect();
    assert!(goals.iter().all(|g| !map.is_wall([f64::from(g[0]), f64::from(g[1])])));
    // Eleven cells, of which three in a row lie below y = 2.
    let above = goals.iter().filter(|g| g[1] < 2.0).count();
    assert!((540..660).contains(&above), "{above} of 600 expected");
    assert_eq!(maze.set_goal(&[0.0, 4.0]), Err(GoalError::Wall { at: [0.0, 4.0] }));
    assert_eq!(maze.set_goal(&[0.0]), Err(GoalError::Width { expected: 2, found: 1 }));
    assert!(matches!(maze.set_goal(&[f32::NAN, 0.0]), Err(GoalError::Value { index: 0, .. })));
    assert_eq!(maze.goal(), [0.0, 8.0], "a refusal changes nothing");
    let mut locked = PointMaze::new(&LOCK_AND_KEY).unwrap();
    assert_eq!(locked.set_goal(&[0.0, 8.0, 0.5]), Err(GoalError::Value { index: 2, value: 0.5 }));
}

#[test]
fn a_time_limit_passes_goals_on() {
    let mut maze = TimeLimit::new(PointMaze::new(&U_MAZE).unwrap(), 10);
    maze.set_goal(&[8.0, 4.0]).unwrap();
    assert_eq!(maze.spec().goal, maze.inner().spec().goal);
    assert_eq!((maze.goal(), maze.spec().time_limit), (&[8.0, 4.0][..], Some(10)));
}

/// Saves in the middle of episodes, disturbs everything, loads, and compares what follows bit for bit.
fn futures_are_the_same<R: Robot>(maze: MazeTask<R>, steps: u32) {
    let mut maze = TimeLimit::new(maze, 3 * steps);
    let mut rng = Seed(3).stream("test", 0);
    for seed in 0..3 {
        maze.reset(seed);
        for _ in 0..steps {
            maze.step(&action(&maze, &mut rng)).unwrap();
        }
        let saved = maze.save();
        let actions: Vec<_> = (0..steps).map(|_| action(&maze, &mut rng)).collect();
        let future = |maze: &mut TimeLimit<MazeTask<R>>| -> Vec<_> {
            let bits = |maze: &mut _| seen(maze).iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            actions.iter().map_while(|a| maze.step(a).ok().map(|step| (step, bits(maze)))).collect()
        };
        let first = future(&mut maze);
        for other in 0..2 {
            maze.reset(100 + other);
            for _ in 0..(7 + 13 * other) {
                maze.step(&action(&maze, &mut rng)).unwrap();
            }
            maze.set_goal(&[0.1, 0.1]).unwrap();
            maze.load(&saved);
            assert_eq!(future(&mut maze), first);
        }
    }
}

#[test]
fn what_follows_a_loaded_state_is_what_followed_it_before() {
    futures_are_the_same(PointMaze::new(&U_MAZE).unwrap(), 300);
}

/// A robot whose simulator gives up at its third step.
struct Frail {
    steps: u32,
}

impl Robot for Frail {
    type State = u32;

    fn observation(&self, _: Rectangle) -> Vec<inroads_envs::Dimension> {
        ["x", "y"].map(|name| inroads_envs::Dimension::linear(name, "m", -1.0, 1.0)).to_vec()
    }

    fn action(&self) -> Vec<inroads_envs::Dimension> {
        vec![inroads_envs::Dimension::linear("push", "", -1.0, 1.0)]
    }

    fn clearance(&self) -> f64 {
        0.1
    }

    fn begin(&mut self, _: [f64; 2], _: Option<&mut Rng>) -> Result<(), String> {
        self.steps = 0;
        Ok(())
    }

    fn act(&mut self, _: &[f32]) -> Result<(), String> {
        self.steps += 1;
        if self.steps == 3 { Err("the body was put into quarantine".to_owned()) } else { Ok(()) }
    }

    fn at(&self) -> [f32; 2] {
        [self.steps as f32, 0.0]
    }

    fn observe(&self, out: &mut Vec<f32>) {
        out.extend(self.at());
    }

    fn heading(&self) -> Heading {
        Heading::Nowhere
    }

    fn save(&self) -> u32 {
        self.steps
    }

    fn load(&mut self, state: &u32) {
        self.steps = *state;
    }

    fn draw(&self, _: &mut Vec<Solid>) {}
}

#[test]
fn a_simulator_that_gives_up_truncates_the_episode_and_says_why() {
    let mut maze = TimeLimit::new(MazeTask::with(&CORRIDOR, |_| Ok(Frail { steps: 0 })).unwrap(), 10);
    for seed in 0..2 {
        maze.reset(seed);
        assert_eq!(maze.fault(), None, "a new episode has no fault");
        for _ in 0..2 {
            assert_eq!(maze.step(&vec![0.0]), Ok(Step { reward: -1.0, end: None }));
        }
        let last = maze.step(&vec![0.0]).unwrap();
        assert_eq!(last, Step { reward: -1.0, end: Some(End::Truncated) });
        assert!(!maze.spec().succeeded(&last));
        assert_eq!(maze.fault(), Some("the body was put into quarantine"));
        assert!(maze.step(&vec![0.0]).is_err());
    }
}

#[test]
fn time_is_counted_in_thousandths_of_an_episode_s_steps() {
    let mut maze = PointMaze::new(&Maze { timed: true, ..U_MAZE }).unwrap();
    for seed in 0..2 {
        maze.reset(seed);
        for step in 0..5 {
            assert_eq!(seen(&mut maze)[6], 0.001 * step as f32);
            maze.step(&vec![0.1, 0.0]).unwrap();
        }
    }
    assert_eq!((seen(&mut maze).len(), maze.spec().observation.len()), (7, 7));
}

#[test]
fn a_user_s_map_scale_goal_and_starts_are_taken() {
    let map = "#######\n#g...r#\n#######";
    let options = Options { map: Some(map), scale: Some(2.0), ..Options::default() };
    let mut env = vectors(registry::make_with("point-maze", &options).unwrap());
    assert_eq!(env.spec().goal.as_ref().unwrap().at, [-8.0, 0.0]);
    env.reset(0);
    assert!((-0.1..=0.1).contains(&seen(&mut env)[0]));
    let picture = registry::picture_with("point-maze", &options).unwrap().unwrap();
    assert_eq!((picture.goal, picture.bounds.low), ([-8.0, 0.0], [-9.0, -1.0]));
    let options = Options { goal: Some([-4.0, 0.0]), starts: Some(Starts::At(&[[-8.0, 0.0]])), ..options };
    let mut env = vectors(registry::make_with("point-maze", &options).unwrap());
    env.reset(0);
    assert!(env.spec().goal.as_ref().unwrap().at == [-4.0, 0.0] && seen(&mut env)[0] < -7.8);
    assert_eq!(env.spec().time_limit, Some(1000));
}

#[test]
fn what_makes_no_maze_is_refused_by_name_and_place() {
    let refused = |name: &str, options: Options<'_>| match registry::make_with(name, &options) {
        Err(error) => (error.to_string(), error),
        Ok(_) => panic!("{name} was built"),
    };
    let map = |map| Options { map: Some(map), ..Options::default() };
    let (text, error) = refused("point-maze", map("###\n#r?\n###"));
    let unknown = MazeError::Map(MapError::Unknown { line: 2, column: 3, found: '?' });
    assert_eq!(error, MakeError::Maze { name: "point-maze", why: unknown });
    assert!(text.starts_with("`point-maze`: map line 2, column 3: '?'"), "{text}");
    assert!(refused("point-maze", map("#r#")).0.contains("mark a cell with g"));
    let narrow = Options { scale: Some(0.9), ..Options::default() };
    assert!(refused("point-maze", narrow).0.contains("too narrow for a robot of 1 m"));
    let walled = Options { goal: Some([0.0, 4.0]), ..Options::default() };
    assert!(refused("point-maze", walled).0.contains("free space"));
    let (text, error) = refused("corridor-5", narrow);
    assert_eq!(error, MakeError::Option { name: "corridor-5", option: "scale" });
    assert_eq!(text, "`corridor-5` takes no option `scale`; the mazes of point and ant do");
    assert!(matches!(refused("point-mze", narrow).1, MakeError::Unknown(_)));
    assert!(registry::make_with("corridor-5", &Options::default()).is_ok());
}

#[test]
fn impossible_mazes_are_refused() {
    let refused = |maze| PointMaze::new(&maze).err();
    let narrow = MazeError::Narrow { scale: 0.5, robot: 1.0 };
    assert_eq!(refused(Maze { scale: 0.5, ..CORRIDOR }), Some(narrow));
    assert_eq!(refused(Maze { goal: Some([0.0, 3.0]), ..CORRIDOR }), Some(MazeError::Goal));
    assert_eq!(refused(Maze { cells: "r.", ..CORRIDOR }), Some(MazeError::Goal));
    assert_eq!(refused(Maze { tolerance: 0.0, ..CORRIDOR }), Some(MazeError::Tolerance(0.0)));
    let error = refused(Maze { cells: "r.g\n##", ..CORRIDOR }).map(|e| e.to_string()).unwrap_or_default();
    assert!(error.contains("line 2, column 3"), "{error}");
}
