//! The point robot in mazes: rllab's, and D4RL's, whose steps are a fifth as long.

use inroads_sim::{
    rigid::{CellMap, MAX_SPEED, MAX_SPIN, MAX_TURN, PointError, PointRobot, PointState, Rectangle},
    view::{Solid, colour},
};
use rand::RngExt;
use rand_distr::StandardNormal;

use super::{Heading, Maze, MazeError, MazeTask, Robot};
use crate::{Dimension, Rng};

/// Greatest start noise of x, y (metres) and heading (radians), uniform (rllab's reset).
const POSE_NOISE: f64 = 0.1;
/// Standard deviation of the start's velocities, metres a second and radians a second (rllab's reset).
const VELOCITY_NOISE: f64 = 0.1;

/// How far a point robot goes at most in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stride {
    /// 1 m (rllab; thesis chapter 3).
    Rllab,
    /// 0.2 m (D4RL): paths long enough for a chain of skills to matter.
    Small,
}

impl Stride {
    /// Metres of a forward action of 1.
    pub fn metres(self) -> f64 {
        match self {
            Self::Rllab => 1.0,
            Self::Small => 0.2,
        }
    }

    /// The unit of a forward action.
    pub(super) fn unit(self) -> &'static str {
        match self {
            Self::Rllab => "m",
            Self::Small => "m/5",
        }
    }
}

/// rllab's point robot. It observes x, y, θ (not wrapped), vx, vy, ω; its actions are two numbers in [-1, 1]:
/// how far to go (of its [`Stride`]) and how far to turn before (quarters of a radian).
pub struct Point {
    robot: PointRobot,
    stride: Stride,
}

impl Point {
    /// A robot at rest at the map's first start.
    ///
    /// # Errors
    /// [`MazeError::Narrow`] when it does not fit into a cell.
    pub fn new(map: CellMap, stride: Stride) -> Result<Self, MazeError> {
        let (scale, robot) = (map.scale(), 2.0 * f64::from(PointRobot::RADIUS));
        match scale < robot {
            true => Err(MazeError::Narrow { scale, robot }),
            false => Ok(Self { robot: PointRobot::new(map), stride }),
        }
    }

    /// Where it is and how it moves.
    pub fn state(&self) -> PointState {
        self.robot.state()
    }

    /// Puts it into a state.
    ///
    /// # Errors
    /// [`PointError::Misplaced`] when the state is in a wall or not finite.
    pub fn restore(&mut self, state: PointState) -> Result<(), PointError> {
        self.robot.restore(state)
    }
}

impl Robot for Point {
    type State = PointState;

    fn observation(&self, bounds: Rectangle) -> Vec<Dimension> {
        let place = |name, axis: usize| {
            Dimension::linear(name, "m", bounds.low[axis] as f32, bounds.high[axis] as f32)
        };
        let within = |name, unit, bound: f64| Dimension::linear(name, unit, -bound as f32, bound as f32);
        vec![
            place("x", 0),
            place("y", 1),
            Dimension::angle("theta"),
            within("vx", "m/s", MAX_SPEED),
            within("vy", "m/s", MAX_SPEED),
            within("omega", "rad/s", MAX_SPIN),
        ]
    }

    fn action(&self) -> Vec<Dimension> {
        vec![
            Dimension::linear("forward", self.stride.unit(), -1.0, 1.0),
            Dimension::linear("turn", "rad/4", -1.0, 1.0),
        ]
    }

    /// The ball's radius: what sticks out of it is pushed back when it meets a wall.
    fn clearance(&self) -> f64 {
        f64::from(PointRobot::RADIUS)
    }

    fn begin(&mut self, [x, y]: [f64; 2], rng: Option<&mut Rng>) -> Result<(), String> {
        let state = match rng {
            None => PointState { x, y, ..PointState::default() },
            Some(rng) => {
                let [x, y, theta] = [x, y, 0.0].map(|mean| mean + rng.random_range(-POSE_NOISE..POSE_NOISE));
                let [vx, vy, omega] =
                    std::array::from_fn(|_| VELOCITY_NOISE * rng.sample::<f64, _>(StandardNormal));
                PointState { x, y, theta, vx, vy, omega }
            }
        };
        self.restore(state).map_err(|why| why.to_string())
    }

    fn act(&mut self, action: &[f32]) -> Result<(), String> {
        let (forward, turn) = (f64::from(action[0]) * self.stride.metres(), f64::from(action[1]) * MAX_TURN);
        self.robot.step(forward, turn).map(|_| ()).map_err(|fault| fault.to_string())
    }

    fn at(&self) -> [f32; 2] {
        let PointState { x, y, .. } = self.state();
        [x as f32, y as f32]
    }

    fn observe(&self, out: &mut Vec<f32>) {
        let PointState { x, y, theta, vx, vy, omega } = self.state();
        out.extend([x, y, theta, vx, vy, omega].map(|x| x as f32));
    }

    fn heading(&self) -> Heading {
        Heading::Angle(2)
    }

    fn save(&self) -> PointState {
        self.state()
    }

    fn load(&mut self, state: &PointState) {
        // A saved state of this map is in free space; one of another map is left alone.
        let _ = self.robot.restore(*state);
    }

    fn draw(&self, out: &mut Vec<Solid>) {
        out.extend(self.robot.solids([colour::TORSO, colour::LEG]));
    }
}

/// A point robot in a maze.
pub type PointMaze = MazeTask<Point>;

impl PointMaze {
    /// Builds a maze for rllab's point robot.
    ///
    /// # Errors
    /// [`MazeError`] says what is wrong with the description.
    pub fn new(maze: &Maze<'_>) -> Result<Self, MazeError> {
        Self::striding(maze, Stride::Rllab)
    }

    /// Builds a maze for a point robot of that stride.
    ///
    /// # Errors
    /// [`MazeError`] says what is wrong with the description.
    pub fn striding(maze: &Maze<'_>, stride: Stride) -> Result<Self, MazeError> {
        Self::with(maze, |map| Point::new(map.clone(), stride))
    }

    /// The robot's state in the episode, which [`restore`](Self::restore) takes back bit for bit.
    pub fn state(&self) -> PointState {
        self.robot().state()
    }

    /// Begins an episode in a given state instead of one that a seed names.
    ///
    /// # Errors
    /// [`PointError::Misplaced`] when the state is in a wall or not finite.
    pub fn restore(&mut self, state: PointState) -> Result<(), PointError> {
        self.place(|robot| robot.restore(state))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        End, Environment, Refused, Step,
        maze::{CORRIDOR, U_MAZE, catalogue::LOCK_AND_KEY},
    };

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
    fn small_steps_are_a_fifth_as_long_and_turns_as_wide() {
        let mut maze = PointMaze::striding(&CORRIDOR, Stride::Small).unwrap();
        maze.restore(PointState::default()).unwrap();
        for _ in 0..36 {
            assert_eq!(maze.step(&vec![1.0, 0.0]), Ok(Step { reward: -1.0, end: None }));
        }
        assert!((maze.state().x - 7.2).abs() < 1e-12);
        maze.step(&vec![0.0, -0.5]).unwrap();
        assert_eq!(maze.state().theta, -0.125);
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
    fn the_picture_is_that_of_the_spec() {
        let mut maze = PointMaze::new(&U_MAZE).unwrap();
        let picture = maze.picture();
        assert_eq!((picture.goal, picture.starts.as_slice()), ([0.0, 8.0], &[[0.0, 0.0]][..]));
        assert_eq!(picture.bounds, Rectangle { low: [-2.0, -2.0], high: [10.0, 10.0] });
        assert_eq!(picture.observation_at([3.0, 1.5]), [3.0, 1.5, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(picture.holding_at([3.0, 1.5]), None, "there is no key");
        let locked = PointMaze::new(&LOCK_AND_KEY).unwrap().picture();
        assert_eq!(locked.observation_at([3.0, 1.5])[..4], [3.0, 1.5, 0.0, 0.0]);
        assert_eq!(locked.holding_at([3.0, 1.5]).unwrap()[..4], [3.0, 1.5, 1.0, 0.0]);
    }
}
