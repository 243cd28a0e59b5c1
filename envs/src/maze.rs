//! Point mazes: rllab's point robot walks to a goal (thesis section 3.2, Point-Maze).
//!
//! The start is the origin plus noise, a step costs 1, the step that comes within the tolerance of the goal
//! costs nothing and ends the episode. Maps, scale, goal and noise are those of the thesis author's code
//! (rllab's `PointMazeEnv`); the time limit is [`TimeLimit`](crate::TimeLimit)'s business.

use inroads_sim::rigid::{
    CellMap, MAX_SPEED, MAX_SPIN, MAX_TURN, MapError, PointError, PointRobot, PointState,
};
use rand::RngExt;
use rand_distr::StandardNormal;

pub use inroads_sim::rigid::Rectangle;

use crate::{Dimension, End, Environment, Goal, Refused, Seed, Space, Spec, Step};

/// Greatest start noise of x, y (metres) and heading (radians), uniform (rllab's reset).
const POSE_NOISE: f64 = 0.1;
/// Standard deviation of the start's velocities, metres a second and radians a second (rllab's reset).
const VELOCITY_NOISE: f64 = 0.1;
/// Least side of a cell, metres: the robot's diameter.
const LEAST_SCALE: f64 = 1.0;

/// What makes one maze differ from another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Maze<'a> {
    /// Its name in the registry.
    pub name: &'static str,
    /// One sentence.
    pub about: &'static str,
    /// The map, as [`CellMap::parse`] reads it. Where there are several starts, the seed chooses.
    pub cells: &'a str,
    /// Side of a cell, metres, at least 1.
    pub scale: f64,
    /// The goal, metres from the first start; `None` for the map's first goal cell.
    pub goal: Option<[f64; 2]>,
    /// Greatest distance from the goal that counts as there, metres.
    pub tolerance: f64,
}

/// The thesis' Point-Maze: round three sides of a U, with the goal at (0, 8).
pub const U_MAZE: Maze<'static> = Maze {
    name: "point-maze",
    about: "a point robot walks round a U to a goal behind the wall; -1 a step",
    cells: "#####\n#r..#\n###.#\n#g..#\n#####",
    scale: 4.0,
    goal: None,
    tolerance: 0.6,
};

/// A short straight corridor, of ours, where learners can be tested in seconds.
pub const CORRIDOR: Maze<'static> = Maze {
    name: "point-corridor",
    about: "a point robot walks down a straight corridor of 8 m; -1 a step",
    cells: "#####\n#r.g#\n#####",
    scale: 4.0,
    goal: None,
    tolerance: 0.6,
};

/// Why there is no such maze.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MazeError {
    /// The map cannot be read.
    #[error(transparent)]
    Map(#[from] MapError),
    /// The robot does not fit into a cell.
    #[error("cells of {0} m are too narrow for a robot of 1 m; give a scale of at least 1")]
    Narrow(f64),
    /// There is no goal, or it is in a wall.
    #[error("the goal must lie in free space: mark a cell with g, or give a point that is not in a wall")]
    Goal,
    /// The tolerance is not a positive finite number.
    #[error("a goal cannot have tolerance {0}; give a positive finite number of metres")]
    Tolerance(f64),
}

/// A point robot in a maze.
///
/// Observations are x, y, θ (not wrapped), vx, vy, ω; actions are two numbers in [-1, 1], how far to go
/// (metres) and how far to turn before (quarters of a radian).
pub struct PointMaze {
    spec: Spec,
    picture: Picture,
    robot: PointRobot,
    over: bool,
}

impl PointMaze {
    /// Builds a maze.
    ///
    /// # Errors
    /// [`MazeError`] says what is wrong with the description.
    pub fn new(maze: &Maze<'_>) -> Result<Self, MazeError> {
        let map = CellMap::parse(maze.cells, maze.scale)?;
        if maze.scale < LEAST_SCALE {
            return Err(MazeError::Narrow(maze.scale));
        }
        if !(maze.tolerance.is_finite() && maze.tolerance > 0.0) {
            return Err(MazeError::Tolerance(maze.tolerance));
        }
        let goal = maze.goal.or(map.goals().first().copied()).filter(|&at| !map.is_wall(at));
        let picture = Picture {
            walls: map.walls(),
            bounds: map.bounds(),
            starts: map.starts().to_vec(),
            goal: goal.ok_or(MazeError::Goal)?,
            tolerance: maze.tolerance,
        };
        let spec = spec(maze, &picture);
        Ok(Self { spec, picture, robot: PointRobot::new(map), over: true })
    }

    /// The state of the episode, which [`restore`](Self::restore) takes back bit for bit.
    pub fn state(&self) -> PointState {
        self.robot.state()
    }

    /// Begins an episode in a given state instead of one that a seed names.
    ///
    /// # Errors
    /// [`PointError::Misplaced`] when the state is in a wall or not finite.
    pub fn restore(&mut self, state: PointState) -> Result<(), PointError> {
        self.robot.restore(state)?;
        self.over = false;
        Ok(())
    }

    /// The maze seen from above.
    pub fn picture(&self) -> &Picture {
        &self.picture
    }
}

/// A maze seen from above, for figures. Agents never see one.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// The walls, which do not overlap. Metres, as all here.
    pub walls: Vec<Rectangle>,
    /// The least rectangle that holds all free space.
    pub bounds: Rectangle,
    /// Where episodes start, but for noise.
    pub starts: Vec<[f64; 2]>,
    /// The goal.
    pub goal: [f64; 2],
    /// Greatest distance from the goal that counts as there.
    pub tolerance: f64,
}

impl Picture {
    /// What an agent would see that stands at a point, at rest and facing along x.
    pub fn observation_at(&self, at: [f64; 2]) -> Vec<f32> {
        observation(&PointState { x: at[0], y: at[1], ..PointState::default() }).to_vec()
    }
}

impl Environment for PointMaze {
    type Observation = Vec<f32>;
    type Action = Vec<f32>;

    fn spec(&self) -> &Spec {
        &self.spec
    }

    fn reset(&mut self, seed: u64) {
        let mut rng = Seed(seed).stream("start", 0);
        let starts = self.robot.map().starts();
        let [x, y] = starts[rng.random_range(0..starts.len())];
        let [x, y, theta] = [x, y, 0.0].map(|mean| mean + rng.random_range(-POSE_NOISE..POSE_NOISE));
        let [vx, vy, omega] = std::array::from_fn(|_| VELOCITY_NOISE * rng.sample::<f64, _>(StandardNormal));
        self.restore(PointState { x, y, theta, vx, vy, omega })
            .expect("a start cell is wider than the start noise");
    }

    /// # Panics
    /// When the physics diverged, which no legal action should bring about: numbers that are not finite must
    /// not reach a learner unnoticed.
    fn step(&mut self, action: &Vec<f32>) -> Result<Step, Refused> {
        if self.over {
            return Err(Refused::Over);
        }
        self.spec.action.admit(action)?;
        let (forward, turn) = (f64::from(action[0]), f64::from(action[1]) * MAX_TURN);
        if let Err(fault) = self.robot.step(forward, turn) {
            panic!("{fault}");
        }
        let seen = observation(&self.robot.state());
        self.over = self.spec.goal.as_ref().is_some_and(|goal| goal.reached(&seen));
        Ok(match self.over {
            true => Step { reward: 0.0, end: Some(End::Terminated) },
            false => Step { reward: -1.0, end: None },
        })
    }

    fn observe(&self, out: &mut Vec<f32>) {
        out.clear();
        out.extend_from_slice(&observation(&self.robot.state()));
    }
}

fn observation(state: &PointState) -> [f32; 6] {
    [state.x, state.y, state.theta, state.vx, state.vy, state.omega].map(|x| x as f32)
}

fn spec(maze: &Maze<'_>, picture: &Picture) -> Spec {
    let bounds = picture.bounds;
    let place =
        |name, axis: usize| Dimension::linear(name, "m", bounds.low[axis] as f32, bounds.high[axis] as f32);
    let within = |name, unit, bound: f64| Dimension::linear(name, unit, -bound as f32, bound as f32);
    Spec {
        name: maze.name,
        about: maze.about,
        observation: Space::Box(vec![
            place("x", 0),
            place("y", 1),
            Dimension::angle("theta"),
            within("vx", "m/s", MAX_SPEED),
            within("vy", "m/s", MAX_SPEED),
            within("omega", "rad/s", MAX_SPIN),
        ]),
        action: Space::Box(vec![within("forward", "m", 1.0), within("turn", "rad/4", 1.0)]),
        goal: Some(Goal {
            dims: vec![0, 1],
            at: picture.goal.map(|x| x as f32).to_vec(),
            tolerance: picture.tolerance as f32,
        }),
        place: vec![0, 1],
        time_limit: None,
        success_reward: 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corridor() -> PointMaze {
        PointMaze::new(&CORRIDOR).unwrap()
    }

    #[test]
    fn walking_straight_ahead_reaches_the_end_of_the_corridor() {
        let mut maze = corridor();
        maze.restore(PointState::default()).unwrap();
        for _ in 0..7 {
            assert_eq!(maze.step(&vec![1.0, 0.0]), Ok(Step { reward: -1.0, end: None }));
        }
        let last = maze.step(&vec![1.0, 0.0]).unwrap();
        assert!(last == Step { reward: 0.0, end: Some(End::Terminated) } && maze.spec().succeeded(&last));
        assert_eq!(maze.step(&vec![1.0, 0.0]), Err(Refused::Over));
    }

    #[test]
    fn the_second_component_turns_by_quarters_of_a_radian() {
        let mut maze = corridor();
        maze.restore(PointState::default()).unwrap();
        maze.step(&vec![0.0, -0.5]).unwrap();
        assert_eq!(maze.state().theta, -0.125);
    }

    #[test]
    fn starts_are_noisy_within_the_reset_of_rllab() {
        let mut maze = corridor();
        let starts: Vec<_> = (0..500).map(|seed| (maze.reset(seed), maze.state()).1).collect();
        assert!(starts.iter().all(|s| [s.x, s.y, s.theta].iter().all(|x| x.abs() <= POSE_NOISE)));
        let variance = starts.iter().map(|s| s.vx * s.vx).sum::<f64>() / 500.0;
        assert!((0.008..0.012).contains(&variance), "{variance}");
    }

    #[test]
    fn several_starts_are_all_used() {
        let cells = "#######\n#r.g.r#\n#######";
        let mut maze = PointMaze::new(&Maze { cells, ..CORRIDOR }).unwrap();
        let far = (0..100).filter(|&seed| (maze.reset(seed), maze.state().x > 8.0).1).count();
        assert!((30..70).contains(&far), "{far} of 100");
    }

    #[test]
    fn an_impossible_maze_is_refused() {
        let refused = |maze| PointMaze::new(&maze).err();
        assert_eq!(refused(Maze { scale: 0.5, ..CORRIDOR }), Some(MazeError::Narrow(0.5)));
        assert_eq!(refused(Maze { goal: Some([0.0, 3.0]), ..CORRIDOR }), Some(MazeError::Goal));
        assert_eq!(refused(Maze { cells: "r.", ..CORRIDOR }), Some(MazeError::Goal));
        assert_eq!(refused(Maze { tolerance: 0.0, ..CORRIDOR }), Some(MazeError::Tolerance(0.0)));
        let error = refused(Maze { cells: "r.g\n##", ..CORRIDOR }).map(|e| e.to_string()).unwrap_or_default();
        assert!(error.contains("line 2, column 3"), "{error}");
    }

    #[test]
    fn the_picture_is_that_of_the_spec() {
        let maze = PointMaze::new(&U_MAZE).unwrap();
        let picture = maze.picture();
        assert_eq!((picture.goal, picture.starts.as_slice()), ([0.0, 8.0], &[[0.0, 0.0]][..]));
        assert_eq!(picture.bounds, Rectangle { low: [-2.0, -2.0], high: [10.0, 10.0] });
        assert_eq!(picture.observation_at([3.0, 1.5]), [3.0, 1.5, 0.0, 0.0, 0.0, 0.0]);
    }
}
