//! A robot on its way through a maze: the decision process itself.

use inroads_sim::rigid::CellMap;

use super::{Maze, MazeError, Picture, Robot, Starts, ground::Ground, picture};
use crate::{
    Dimension, Drawing, End, Environment, Goal, GoalError, Goals, Pay, Refused, Render, Rng, Seed, Snapshot,
    Space, Spec, Step,
};

/// Index of `has_key` in the observations of mazes with a lock (author's order: behind x and y).
pub(super) const HAS_KEY: usize = 2;
/// What a step adds to the time that is observed (the author's ants of 30 dimensions).
const TICK: f32 = 0.001;
/// Steps without an action after which a robot rests: two seconds of the ant.
const REST: u32 = 20;
/// Noisy starts that are tried before one without noise is taken.
const TRIES: u32 = 100;

/// A robot in a maze.
///
/// Observations are the robot's, with `has_key` (0 or 1) behind x and y where there is a lock, and the time
/// at the end where the maze is timed. The goal's dimensions are x and y, and `has_key` where there is a
/// lock: without the key one is at least 1 away from it.
pub struct MazeTask<R> {
    spec: Spec,
    /// What is pursued; the spec has it too where that is a task.
    goal: Goal,
    ground: Ground,
    pay: Pay,
    timed: bool,
    robot: R,
    episode: Episode,
}

/// What of an episode is not the robot's.
#[derive(Clone, Debug, PartialEq)]
struct Episode {
    steps: u32,
    held: bool,
    over: bool,
    fault: Option<String>,
}

impl Episode {
    const BEGUN: Self = Self { steps: 0, held: false, over: false, fault: None };
}

/// The state of a [`MazeTask`], for [`Snapshot`].
#[derive(Clone, Debug, PartialEq)]
pub struct MazeState<S> {
    robot: S,
    episode: Episode,
    goal: Vec<f32>,
}

impl<S> MazeState<S> {
    /// This episode, with the robot of another.
    pub fn with_robot(self, other: Self) -> Self {
        Self { robot: other.robot, ..self }
    }
}

impl<R: Robot> MazeTask<R> {
    /// Builds a maze about the robot that `robot` makes for its map.
    ///
    /// # Errors
    /// [`MazeError`] says what is wrong with the description, or where the robot cannot start.
    pub fn with(
        maze: &Maze<'_>,
        robot: impl FnOnce(&CellMap) -> Result<R, MazeError>,
    ) -> Result<Self, MazeError> {
        let ground = Ground::new(maze)?;
        let robot = robot(&ground.map)?;
        let goal = goal(maze, &ground);
        let spec = spec(maze, &ground, &robot, &goal);
        let (pay, timed) = (maze.pay, maze.timed);
        let mut task = Self { spec, goal, ground, pay, timed, robot, episode: Episode::BEGUN };
        task.set_starts(maze.starts)?;
        Ok(task)
    }

    /// Starts the next episodes elsewhere. The running one is over.
    ///
    /// # Errors
    /// [`MazeError`] says why the robot cannot start there; episodes start where they did.
    pub fn set_starts(&mut self, starts: Starts<'_>) -> Result<(), MazeError> {
        let mut ground = self.ground.clone();
        ground.start_at(starts, self.robot.clearance())?;
        self.episode = Episode { over: true, ..Episode::BEGUN };
        for &at in &ground.places {
            self.robot.begin(at, None).map_err(|why| MazeError::Start { at, why })?;
        }
        self.ground = ground;
        Ok(())
    }

    /// The maze seen from above. The episode goes on afterwards as if nobody had looked.
    pub fn picture(&mut self) -> Picture {
        let now = self.save();
        let resting = self.settled();
        self.load(&now);
        let heading = self.robot.heading().shifted(usize::from(self.ground.key.is_some()));
        let [x, y] = self.target();
        Picture::new(&self.ground, [x, y].map(f64::from), heading, resting)
    }

    /// What is observed when the robot has come to rest after a start without noise.
    fn settled(&mut self) -> Vec<f32> {
        let still = vec![0.0; self.spec.action.len()];
        // A robot that breaks down is shown as it was last seen.
        let _ = self.robot.begin(self.ground.places[0], None);
        let _ = (0..REST).try_for_each(|_| self.robot.act(&still));
        self.episode = Episode::BEGUN;
        let mut seen = Vec::new();
        self.observe(&mut seen);
        seen
    }

    /// What walks in the maze.
    pub fn robot(&self) -> &R {
        &self.robot
    }

    /// Begins an episode with the robot as `place` puts it, instead of one that a seed names.
    pub(super) fn place<E>(&mut self, place: impl FnOnce(&mut R) -> Result<(), E>) -> Result<(), E> {
        place(&mut self.robot)?;
        self.episode = Episode::BEGUN;
        self.pick_up();
        Ok(())
    }

    /// Where the goal is.
    fn target(&self) -> [f32; 2] {
        [self.goal.at[0], self.goal.at[1]]
    }

    /// Moves the goal.
    fn aim(&mut self, at: &[f32]) {
        self.goal.at.copy_from_slice(at);
        if let Some(task) = &mut self.spec.goal {
            task.at.copy_from_slice(at);
        }
    }

    /// x, y, has_key: as many of them are achieved as the goal has dimensions.
    fn here(&self) -> [f32; 3] {
        let [x, y] = self.robot.at();
        [x, y, f32::from(u8::from(self.episode.held))]
    }

    /// What a step that ends here pays.
    fn paid(&self) -> Step {
        self.reward(&self.here()[..self.goal.dims.len()], &self.goal.at)
    }

    /// Takes the key when it is within reach.
    fn pick_up(&mut self) {
        if let Some(key) = self.ground.key {
            let reached = distance(&self.robot.at(), &key.map(|x| x as f32)) <= self.ground.tolerance as f32;
            self.episode.held |= reached;
        }
    }
}

impl<R: Robot> Environment for MazeTask<R> {
    type Observation = Vec<f32>;
    type Action = Vec<f32>;

    fn spec(&self) -> &Spec {
        &self.spec
    }

    fn reset(&mut self, seed: u64) {
        let mut rng = Seed(seed).stream("start", 0);
        let (target, tolerance) = (self.target(), self.ground.tolerance as f32);
        let away = |at: [f64; 2]| distance(&at.map(|x| x as f32), &target) > tolerance;
        let clearance = self.robot.clearance();
        let drawn = (0..TRIES).any(|_| {
            let at = self.ground.start(clearance, away, &mut rng);
            self.robot.begin(at, Some(&mut rng)).is_ok()
        });
        self.episode = Episode::BEGUN;
        if !drawn {
            // The robot has stood there before, when the maze was built.
            self.episode.fault = self.robot.begin(self.ground.places[0], None).err();
            self.episode.over = self.episode.fault.is_some();
        }
        self.pick_up();
    }

    fn step(&mut self, action: &Vec<f32>) -> Result<Step, Refused> {
        if self.episode.over {
            return Err(Refused::Over);
        }
        self.spec.action.admit(action)?;
        self.episode.steps += 1;
        if let Err(fault) = self.robot.act(action) {
            self.episode.fault = Some(fault);
            self.episode.over = true;
            // Nobody knows where the step would have led: it pays what staying would have paid.
            return Ok(Step { end: Some(End::Truncated), ..self.paid() });
        }
        self.pick_up();
        let step = self.paid();
        self.episode.over = step.end.is_some();
        Ok(step)
    }

    fn observe(&mut self, out: &mut Vec<f32>) {
        out.clear();
        self.robot.observe(out);
        if self.ground.key.is_some() {
            out.insert(HAS_KEY, self.here()[HAS_KEY]);
        }
        if self.timed {
            out.push(TICK * self.episode.steps as f32);
        }
    }

    fn fault(&self) -> Option<&str> {
        self.episode.fault.as_deref()
    }
}

impl<R: Robot> Goals for MazeTask<R> {
    fn achieved(&self, observation: &Vec<f32>, out: &mut Vec<f32>) {
        self.goal.achieved(observation, out);
    }

    fn distance(&self, achieved: &[f32], goal: &[f32]) -> f32 {
        distance(achieved, goal)
    }

    fn reward(&self, achieved: &[f32], goal: &[f32]) -> Step {
        self.pay.step(distance(achieved, goal), self.ground.tolerance as f32)
    }

    fn goal(&self) -> &[f32] {
        &self.goal.at
    }

    fn set_goal(&mut self, goal: &[f32]) -> Result<(), GoalError> {
        let (expected, found) = (self.goal.dims.len(), goal.len());
        if expected != found {
            return Err(GoalError::Width { expected, found });
        }
        let wrong = |&(index, value): &(usize, f32)| {
            !value.is_finite() || index == HAS_KEY && value != 0.0 && value != 1.0
        };
        if let Some((index, value)) = goal.iter().copied().enumerate().find(wrong) {
            return Err(GoalError::Value { index, value });
        }
        let at = [goal[0], goal[1]];
        if self.ground.map.is_wall(at.map(f64::from)) {
            return Err(GoalError::Wall { at });
        }
        self.aim(goal);
        Ok(())
    }

    fn sample_goal(&self, rng: &mut Rng) -> Vec<f32> {
        let [x, y] = self.ground.free_point(rng).map(|x| x as f32);
        [x, y, 1.0][..self.goal.dims.len()].to_vec()
    }
}

impl<R: Robot> Snapshot for MazeTask<R> {
    type State = MazeState<R::State>;

    fn save(&self) -> Self::State {
        MazeState { robot: self.robot.save(), episode: self.episode.clone(), goal: self.goal.at.clone() }
    }

    fn load(&mut self, state: &Self::State) {
        self.robot.load(&state.robot);
        self.episode.clone_from(&state.episode);
        self.aim(&state.goal);
    }
}

impl<R: Robot> Render for MazeTask<R> {
    fn drawing(&self) -> Drawing {
        let mut scene = picture::scene(&self.ground, self.target(), self.robot.at(), self.episode.held);
        self.robot.draw(&mut scene.solids);
        Drawing::Bodies(scene)
    }
}

/// Euclidean distance.
fn distance(a: &[f32], b: &[f32]) -> f32 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f32>().sqrt()
}

fn goal(maze: &Maze<'_>, ground: &Ground) -> Goal {
    let [x, y] = ground.goal.map(|x| x as f32);
    let (mut dims, mut at) = (vec![0, 1], vec![x, y]);
    if maze.locked {
        dims.push(HAS_KEY);
        at.push(1.0);
    }
    Goal { dims, at, tolerance: maze.tolerance as f32 }
}

fn spec(maze: &Maze<'_>, ground: &Ground, robot: &impl Robot, goal: &Goal) -> Spec {
    let mut observation = robot.observation(ground.map.bounds());
    if maze.locked {
        observation.insert(HAS_KEY, Dimension::linear("has_key", "", 0.0, 1.0));
    }
    if maze.timed {
        observation.push(Dimension::linear("time", "", 0.0, TICK * maze.limit as f32));
    }
    Spec {
        name: maze.name,
        about: maze.about,
        observation: Space::Box(observation.into()),
        action: Space::Box(robot.action().into()),
        place: goal.dims.clone(),
        goal: (maze.pay != Pay::Nothing).then(|| goal.clone()),
        time_limit: None,
        success_reward: 0.0,
    }
}
