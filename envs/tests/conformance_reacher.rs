//! The reacher against Gymnasium's Reacher-v5 on MuJoCo (fixtures/reacher).
//!
//! MuJoCo integrates with RK4 at 10 ms; Rapier with semi-implicit Euler at 1.25 ms. Under the recorded actions
//! the joints must stay within 2 % of their travel of the recorded ones, open loop, to the end of each episode.

#[path = "../../tests/support/fixtures.rs"]
mod fixtures;

use inroads_envs::{
    Environment,
    reacher::{Reacher, Task},
};
use inroads_sim::rigid::Configuration;
use serde_json::Value;

/// The agreement that is asked for, as a share of a joint's travel in the episode.
const TOLERANCE: f32 = 0.02;
/// What single precision leaves of numbers of this size.
const PRECISION: f32 = 2e-6;
/// How late the recorded fingertip is, metres. Gymnasium reads MuJoCo's body positions, which a step leaves where its
/// last RK4 stage was, not where the joints then are: 0.4 µm off in quiet steps, 2 mm where the elbow meets its limit.
const LATE: f32 = 0.01;

/// One recorded episode.
struct Record {
    seed: i64,
    target: [f32; 2],
    actions: Vec<Vec<f32>>,
    /// Angles and velocities of the joints; one more than actions, as are observations.
    joints: Vec<Configuration>,
    /// The ten numbers of Reacher-v5.
    observations: Vec<Vec<f32>>,
    rewards: Vec<f32>,
}

impl Record {
    fn all() -> Vec<Self> {
        fixtures::records("reacher", "").iter().map(Self::read).collect()
    }

    fn read(record: &Value) -> Self {
        let numbers = |row: &Value| -> Vec<f32> {
            row.as_array().into_iter().flatten().map(|x| x.as_f64().expect("a number") as f32).collect()
        };
        let rows = |first: Option<&str>, rest: &str| -> Vec<Vec<f32>> {
            let rest = record[rest].as_array().unwrap_or_else(|| panic!("no list {rest}"));
            first.map(|first| &record[first]).into_iter().chain(rest).map(numbers).collect()
        };
        let (q, v) = (rows(Some("qpos0"), "qpos"), rows(Some("qvel0"), "qvel"));
        let joints =
            q.iter().zip(&v).map(|(q, v)| Configuration { q: q[..2].to_vec(), v: v[..2].to_vec() }).collect();
        Self {
            seed: record["seed"].as_i64().unwrap_or(-1),
            target: [q[0][2], q[0][3]],
            actions: rows(None, "actions"),
            joints,
            observations: rows(Some("obs0"), "obs"),
            rewards: numbers(&record["reward"]),
        }
    }

    /// A reacher in the recorded state after so many steps.
    fn after(&self, steps: usize) -> Reacher {
        let mut reacher = Reacher::new(Task::Dense);
        reacher.restore(&self.joints[steps], self.target).expect("a recorded state");
        reacher
    }
}

fn observation(reacher: &mut Reacher) -> Vec<f32> {
    let mut seen = Vec::new();
    reacher.observe(&mut seen);
    seen
}

#[test]
fn conformance_reacher_joints_stay_within_2_percent_of_their_travel_open_loop() {
    for record in Record::all() {
        let mut reacher = record.after(0);
        let mut worst = [0.0_f32; 2];
        for (action, theirs) in record.actions.iter().zip(&record.joints[1..]) {
            reacher.step(action).unwrap();
            for (joint, worst) in worst.iter_mut().enumerate() {
                *worst = worst.max((reacher.joints().q[joint] - theirs.q[joint]).abs());
            }
        }
        for (joint, worst) in worst.into_iter().enumerate() {
            let angles = record.joints.iter().map(|joints| joints.q[joint]);
            let travel = angles.clone().fold(f32::MIN, f32::max) - angles.fold(f32::MAX, f32::min);
            let share = worst / travel;
            assert!(
                share <= TOLERANCE,
                "seed {}, joint {joint}: off by {share} of its travel, {travel} rad",
                record.seed
            );
        }
    }
}

#[test]
fn conformance_reacher_observations_of_the_recorded_states_are_the_recorded_ones() {
    for record in Record::all() {
        for (i, theirs) in record.observations.iter().enumerate() {
            let ours = observation(&mut record.after(i));
            assert_eq!((ours.len(), ours[10]), (11, 0.0));
            for (index, (ours, theirs)) in ours.iter().zip(theirs).enumerate() {
                let tolerance = if index < 8 { PRECISION * theirs.abs().max(1.0) } else { LATE };
                let near = (ours - theirs).abs() <= tolerance;
                assert!(near, "seed {}, step {i}, number {index}: {ours} {theirs}", record.seed);
            }
            // The fingertip at these angles, from the lengths of Gymnasium's file.
            let [a, b] = [record.joints[i].q[0], record.joints[i].q[0] + record.joints[i].q[1]];
            let tip = [0.1 * a.cos() + 0.11 * b.cos(), 0.1 * a.sin() + 0.11 * b.sin()];
            for axis in 0..2 {
                let gap = tip[axis] - record.target[axis];
                assert!((ours[8 + axis] - gap).abs() <= PRECISION, "seed {}, step {i}", record.seed);
            }
        }
    }
}

#[test]
fn conformance_reacher_rewards_of_the_recorded_steps_are_the_recorded_ones() {
    for record in Record::all() {
        let mut reacher = record.after(0);
        for (i, (action, theirs)) in record.actions.iter().zip(&record.rewards).enumerate() {
            let gap = [record.observations[i + 1][8], record.observations[i + 1][9]];
            let ours = Task::Dense.pay(action, gap).reward;
            assert!((ours - theirs).abs() <= PRECISION, "seed {}, step {i}: {ours} {theirs}", record.seed);
            // What the environment pays is that, at its own state.
            let paid = reacher.step(action).unwrap();
            let seen = observation(&mut reacher);
            assert_eq!(paid, Task::Dense.pay(action, [seen[8], seen[9]]));
        }
    }
}
