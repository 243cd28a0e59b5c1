//! The point maze against rllab's stepping rule on MuJoCo (fixtures/point).
//!
//! Up to the first contact motion is kinematics and must agree to 1e-5, step by step and over the whole way.
//! Contacts are Rapier's and not MuJoCo's: behind them only the invariants are compared.

#[path = "../../tests/support/fixtures.rs"]
mod fixtures;

use inroads_envs::{
    End, Environment,
    maze::{Maze, PointMaze, U_MAZE},
};
use inroads_sim::rigid::{CellMap, MAX_SPEED, MAX_SPIN, PointState};
use serde_json::Value;

/// The agreement that is asked for, metres and radians.
const TOLERANCE: f64 = 1e-5;

/// One recorded episode.
struct Record {
    seed: i64,
    noisy: bool,
    cells: String,
    scale: f64,
    goal: [f64; 2],
    tolerance: f64,
    /// Displacement and turn, metres and radians.
    actions: Vec<[f64; 2]>,
    /// One more than actions.
    states: Vec<PointState>,
    blocked: Vec<bool>,
    done: Vec<bool>,
}

impl Record {
    fn all() -> Vec<Self> {
        fixtures::records("point", "").iter().map(Self::read).collect()
    }

    fn read(record: &Value) -> Self {
        let rows = |key: &str| record[key].as_array().unwrap_or_else(|| panic!("no list {key}"));
        let numbers = |row: &Value| -> Vec<f64> {
            row.as_array().into_iter().flatten().map(|x| x.as_f64().expect("a number")).collect()
        };
        let flags =
            |column: usize| rows("blocked_and_done").iter().map(move |row| numbers(row)[column] != 0.0);
        let states = rows("states_x_y_th_vx_vy_om").iter().map(|row| match numbers(row)[..] {
            [x, y, theta, vx, vy, omega] => PointState { x, y, theta, vx, vy, omega },
            _ => panic!("a state has six numbers"),
        });
        let goal = numbers(&record["goal"]);
        Self {
            seed: record["seed"].as_i64().unwrap_or(-1),
            noisy: record["noisy_start"].as_bool().expect("noisy_start"),
            cells: rows("maze").iter().map(|row| cells(row) + "\n").collect(),
            scale: record["scaling"].as_f64().expect("scaling"),
            goal: [goal[0], goal[1]],
            tolerance: record["tolerance"].as_f64().expect("tolerance"),
            actions: rows("actions").iter().map(numbers).map(|action| [action[0], action[1]]).collect(),
            states: states.collect(),
            blocked: flags(0).collect(),
            done: flags(1).collect(),
        }
    }

    fn maze(&self) -> PointMaze {
        let (goal, scale, tolerance) = (Some(self.goal), self.scale, self.tolerance);
        PointMaze::new(&Maze { cells: &self.cells, scale, goal, tolerance, ..U_MAZE }).expect("a legal maze")
    }

    /// The first step in which MuJoCo saw a wall, or the number of steps.
    fn first_contact(&self) -> usize {
        let touched = |step: usize| {
            let s = self.states[step + 1];
            self.blocked[step] || s.vx != 0.0 || s.vy != 0.0 || s.omega != 0.0
        };
        (0..self.actions.len()).find(|&step| touched(step)).unwrap_or(self.actions.len())
    }

    /// The recorded action as the environment takes it: turns in quarters of a radian.
    fn action(&self, step: usize) -> Vec<f32> {
        let [forward, turn] = self.actions[step];
        vec![forward as f32, (4.0 * turn) as f32]
    }
}

/// A row of the map: 0 free, 1 wall, 2 or "r" start, 3 or "g" goal.
fn cells(row: &Value) -> String {
    let cell = |cell: &Value| match (cell.as_i64(), cell.as_str()) {
        (Some(0), _) => '.',
        (Some(1), _) => '#',
        (Some(2), _) | (_, Some("r")) => 'r',
        (Some(3), _) | (_, Some("g")) => 'g',
        _ => panic!("no cell is {cell}"),
    };
    row.as_array().into_iter().flatten().map(cell).collect()
}

fn assert_near(ours: PointState, theirs: PointState, what: &str) {
    let pairs = [
        (ours.x, theirs.x),
        (ours.y, theirs.y),
        (ours.theta, theirs.theta),
        (ours.vx, theirs.vx),
        (ours.vy, theirs.vy),
        (ours.omega, theirs.omega),
    ];
    assert!(pairs.iter().all(|(a, b)| (a - b).abs() <= TOLERANCE), "{what}:\n{ours:?}\n{theirs:?}");
}

/// Takes a step and says whether the maze ended the episode.
fn step(maze: &mut PointMaze, action: &[f32], what: &str) -> bool {
    let step = maze.step(&action.to_vec()).unwrap_or_else(|refused| panic!("{what}: {refused}"));
    assert_eq!(step.reward, if step.end.is_some() { 0.0 } else { -1.0 }, "{what}");
    step.end == Some(End::Terminated)
}

#[test]
fn conformance_point_every_step_before_a_contact() {
    for record in Record::all().iter().filter(|record| !record.noisy) {
        let mut maze = record.maze();
        for i in 0..record.first_contact() {
            let what = format!("seed {}, step {i}", record.seed);
            maze.restore(record.states[i]).unwrap_or_else(|why| panic!("{what}: {why}"));
            assert_eq!(step(&mut maze, &record.action(i), &what), record.done[i], "{what}: done");
            assert_near(maze.state(), record.states[i + 1], &what);
        }
    }
}

#[test]
fn conformance_point_open_loop_until_a_contact() {
    for record in Record::all().iter().filter(|record| !record.noisy) {
        let mut maze = record.maze();
        maze.restore(record.states[0]).expect("a start in free space");
        for i in 0..record.first_contact() {
            let what = format!("seed {}, step {i}", record.seed);
            assert_eq!(step(&mut maze, &record.action(i), &what), record.done[i], "{what}: done");
            assert_near(maze.state(), record.states[i + 1], &what);
        }
    }
}

#[test]
fn conformance_point_stays_in_free_space_at_bounded_speed() {
    for record in Record::all() {
        let map = CellMap::parse(&record.cells, record.scale).expect("a legal map");
        let mut maze = record.maze();
        maze.restore(record.states[0]).expect("a start in free space");
        for i in 0..record.actions.len() {
            let what = format!("seed {}, step {i}", record.seed);
            let done = step(&mut maze, &record.action(i), &what);
            let s = maze.state();
            assert!(!map.is_wall([s.x, s.y]), "{what}: in a wall at {s:?}");
            assert!(s.vx.hypot(s.vy) <= MAX_SPEED * (1.0 + 1e-9), "{what}: too fast, {s:?}");
            assert!(s.omega.abs() <= MAX_SPIN, "{what}: spins too fast, {s:?}");
            if done {
                break;
            }
        }
    }
}
