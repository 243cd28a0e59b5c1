//! The Reacher: a two-link arm touches a target with its fingertip (thesis section 3.2; Gymnasium's Reacher).
//!
//! Arm, observation and starts are Gymnasium's; what a step pays and when an episode ends is a [`Task`] of three.
//! The time limit is [`TimeLimit`]'s business.

use inroads_sim::{
    math,
    rigid::{
        Configuration, PhysicsFault, Rectangle, StateError, Vector,
        reacher::{Arm, FINGERTIP, LENGTH},
    },
    view::{Mark, Scene, colour},
};
use rand::RngExt;

use crate::registry::{AnyEnvironment, Entry, Make};
use crate::{
    Dimension, Drawing, End, Environment, Goal, Refused, Render, Rng, Seed, Snapshot, Space, Spec, Step,
    TimeLimit,
};

/// What a step pays and what ends an episode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Task {
    /// −1 a step; 0 on reaching the target, which ends the episode. The thesis' sparse reward.
    Sparse,
    /// Minus the distance and the squares of the controls after every step; nothing ends the episode. Gymnasium's
    /// Reacher-v5 with its default weights, 1 and 1.
    Dense,
    /// Minus the squares of the controls and 0.01 a step; 10 on reaching the target, which ends the episode. The
    /// wrapper of the thesis author's code.
    Bonus,
}

impl Task {
    /// What a step pays, and whether it ends the episode: a step that was this action and ended with the fingertip
    /// so far from the target, metres in x and y.
    pub fn pay(self, action: &[f32], [x, y]: [f32; 2]) -> Step {
        let distance = math::hypotf(x, y);
        let effort = action.iter().map(|control| control * control).sum::<f32>();
        let touched = distance <= TOLERANCE;
        let (reward, end) = match self {
            Self::Sparse if touched => (0.0, Some(End::Terminated)),
            Self::Bonus if touched => (TOUCH, Some(End::Terminated)),
            Self::Sparse => (-1.0, None),
            Self::Bonus => (-effort - TIME, None),
            Self::Dense => (-distance - effort, None),
        };
        Step { reward, end }
    }
}

const SPARSE: Entry = Entry {
    name: "reacher",
    about: "a two-link arm touches a target with its fingertip; -1 a step",
    // The steps that an episode of the author's code has; Gymnasium's 50 are shorter than one skill's call.
    make: Make::Bodies { make: || limited(Task::Sparse, 1000), picture: || None },
};
const DENSE: Entry = Entry {
    name: "reacher-dense",
    about: "the same arm as in Gymnasium: minus distance and effort at every step, 50 steps",
    make: Make::Bodies { make: || limited(Task::Dense, 50), picture: || None },
};
const BONUS: Entry = Entry {
    name: "reacher-bonus",
    about: "the same arm; 10 for touching the target, a little less than nothing for effort and time",
    make: Make::Bodies { make: || limited(Task::Bonus, 1000), picture: || None },
};

/// The reachers of the registry.
pub(crate) const ENTRIES: &[Entry] = &[SPARSE, DENSE, BONUS];

fn limited(task: Task, steps: u32) -> AnyEnvironment {
    AnyEnvironment::Vectors(Box::new(TimeLimit::new(Reacher::new(task), steps)))
}

/// Greatest start angle of each joint, radians, uniform (Gymnasium's reset).
const ANGLE_NOISE: f32 = 0.1;
/// Greatest start velocity of each joint, radians a second, uniform (Gymnasium's reset).
const VELOCITY_NOISE: f32 = 0.005;
/// Targets are uniform in a disc of this radius, metres (Gymnasium's reset).
const TARGETS: f32 = 0.2;
/// Greatest distance that counts as touching, metres (the author's wrapper).
const TOLERANCE: f32 = 0.02;
/// What touching pays in the author's wrapper, and what a step costs.
const TOUCH: f32 = 10.0;
const TIME: f32 = 0.01;
/// Usual speed of the joints, radians a second: random controls rarely exceed it.
const SPEED: f32 = 20.0;

/// An arm and a target.
///
/// | observation | | unit | range |
/// |---|---|---|---|
/// | 0, 1 | cosines of the two angles | | ±1 |
/// | 2, 3 | their sines | | ±1 |
/// | 4, 5 | target, x and y | m | ±0.2 |
/// | 6, 7 | angular velocities | rad/s | usually ±20 |
/// | 8, 9, 10 | fingertip minus target, x, y and z | m | ±0.41, z is 0 |
///
/// The action is the torque at the first and the second joint, ±1 for ±200 N m. (Reacher-v2 and v4 show these 11
/// numbers, v5 all but the last.)
pub struct Reacher {
    spec: Spec,
    task: Task,
    arm: Arm,
    target: [f32; 2],
    over: bool,
    fault: Option<String>,
}

/// What a Reacher's future depends on.
#[derive(Clone, Debug, PartialEq)]
pub struct ReacherState {
    /// Angles and velocities of the joints, radians and radians a second.
    pub joints: Configuration,
    /// The target, metres from the first joint.
    pub target: [f32; 2],
    over: bool,
    fault: Option<String>,
}

impl Reacher {
    /// An arm with that task.
    pub fn new(task: Task) -> Self {
        Self { spec: spec(task), task, arm: Arm::new(), target: [0.1, -0.1], over: true, fault: None }
    }

    /// Begins an episode in a given state instead of one that a seed names: angles and velocities of the joints
    /// (radians, radians a second), and the target (metres from the first joint).
    ///
    /// # Errors
    /// [`StateError`] when there are not two angles and two velocities, or a number is not finite.
    pub fn restore(&mut self, joints: &Configuration, target: [f32; 2]) -> Result<(), StateError> {
        if let Some(index) = target.iter().position(|x| !x.is_finite()) {
            return Err(StateError::NotFinite { which: "target", index, value: target[index] });
        }
        self.arm.restore(joints)?;
        (self.target, self.over, self.fault) = (target, false, None);
        Ok(())
    }

    /// Angles and velocities of the joints.
    pub fn joints(&self) -> &Configuration {
        self.arm.state()
    }

    /// Fingertip minus target, metres.
    fn gap(&self) -> [f32; 2] {
        let [x, y] = self.arm.fingertip();
        [x - self.target[0], y - self.target[1]]
    }
}

impl Environment for Reacher {
    type Observation = Vec<f32>;
    type Action = Vec<f32>;

    fn spec(&self) -> &Spec {
        &self.spec
    }

    fn reset(&mut self, seed: u64) {
        let mut rng = Seed(seed).stream("start", 0);
        let mut within = |most: f32| (0..2).map(|_| rng.random_range(-most..most)).collect();
        let start = Configuration { q: within(ANGLE_NOISE), v: within(VELOCITY_NOISE) };
        let target = draw_target(&mut rng);
        self.restore(&start, target).expect("a start is two angles and two velocities");
    }

    fn step(&mut self, action: &Vec<f32>) -> Result<Step, Refused> {
        if self.over {
            return Err(Refused::Over);
        }
        self.spec.action.admit(action)?;
        let before = self.arm.state().clone();
        let step = match self.arm.step([action[0], action[1]]) {
            Ok(()) => self.task.pay(action, self.gap()),
            Err(fault) => self.give_up(&fault, &before),
        };
        self.over = step.end.is_some();
        Ok(step)
    }

    fn observe(&mut self, out: &mut Vec<f32>) {
        let (joints, gap) = (self.arm.state(), self.gap());
        out.clear();
        out.extend(joints.q.iter().map(|angle| math::cosf(*angle)));
        out.extend(joints.q.iter().map(|angle| math::sinf(*angle)));
        out.extend(self.target);
        out.extend(&joints.v);
        out.extend(gap);
        out.push(0.0);
    }

    fn fault(&self) -> Option<&str> {
        self.fault.as_deref()
    }
}

impl Reacher {
    /// Ends an episode whose simulation broke down where it was last whole.
    fn give_up(&mut self, fault: &PhysicsFault, last: &Configuration) -> Step {
        self.fault = Some(fault.to_string());
        self.arm.restore(last).expect("it was a state before the step");
        Step { end: Some(End::Truncated), ..self.task.pay(&[], self.gap()) }
    }
}

impl Snapshot for Reacher {
    type State = ReacherState;

    fn save(&self) -> ReacherState {
        let (joints, fault) = (self.arm.state().clone(), self.fault.clone());
        ReacherState { joints, target: self.target, over: self.over, fault }
    }

    fn load(&mut self, state: &ReacherState) {
        self.restore(&state.joints, state.target).expect("only states of reachers are saved");
        (self.over, self.fault) = (state.over, state.fault.clone());
    }
}

impl Render for Reacher {
    fn drawing(&self) -> Drawing {
        let reach = f64::from(LENGTH + FINGERTIP);
        Drawing::Bodies(Scene {
            solids: self.arm.solids(|link| [colour::JOINT, colour::TORSO][link]).collect(),
            marks: vec![Mark { at: self.target, radius: TOLERANCE, colour: colour::GOAL }],
            trail: Vec::new(),
            bounds: Rectangle { low: [-1.1 * reach; 2], high: [1.1 * reach; 2] },
            focus: Vector::ZERO,
            distance: 0.5,
        })
    }
}

/// A point of the disc of targets, by rejection.
fn draw_target(rng: &mut Rng) -> [f32; 2] {
    loop {
        let at: [f32; 2] = std::array::from_fn(|_| rng.random_range(-TARGETS..TARGETS));
        if math::hypotf(at[0], at[1]) < TARGETS {
            return at;
        }
    }
}

fn spec(task: Task) -> Spec {
    let (entry, success_reward) = match task {
        Task::Sparse => (SPARSE, 0.0),
        Task::Dense => (DENSE, 0.0),
        Task::Bonus => (BONUS, TOUCH),
    };
    let within = |name, unit, bound: f32| Dimension::linear(name, unit, -bound, bound);
    let far = TARGETS + LENGTH + FINGERTIP;
    Spec {
        name: entry.name,
        about: entry.about,
        observation: Space::Box(
            [
                within("cos_q0", "", 1.0),
                within("cos_q1", "", 1.0),
                within("sin_q0", "", 1.0),
                within("sin_q1", "", 1.0),
                within("target_x", "m", TARGETS),
                within("target_y", "m", TARGETS),
                within("dq0", "rad/s", SPEED),
                within("dq1", "rad/s", SPEED),
                within("gap_x", "m", far),
                within("gap_y", "m", far),
                within("gap_z", "m", far),
            ]
            .into(),
        ),
        action: Space::Box([within("torque_0", "200 N m", 1.0), within("torque_1", "200 N m", 1.0)].into()),
        // Wherever the target is, to touch it is to bring the gap to nothing.
        goal: (task != Task::Dense).then(|| Goal {
            dims: vec![8, 9],
            at: vec![0.0, 0.0],
            tolerance: TOLERANCE,
        }),
        place: vec![8, 9],
        time_limit: None,
        success_reward,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An arm of which the fingertip is at (0.21, 0).
    fn stretched(task: Task, target: [f32; 2]) -> Reacher {
        let mut reacher = Reacher::new(task);
        reacher.restore(&Configuration { q: vec![0.0; 2], v: vec![0.0; 2] }, target).unwrap();
        reacher
    }

    #[test]
    fn touching_ends_the_sparse_tasks_and_pays_by_the_task() {
        let step = |task, target| stretched(task, target).step(&vec![0.5, 0.0]).unwrap();
        // Half the torque for 0.02 s turns the arm by 0.02 rad: the fingertip moves by 4 mm.
        let (near, far) = ([0.195, 0.0], [0.15, 0.0]);
        assert_eq!(step(Task::Sparse, near), Step { reward: 0.0, end: Some(End::Terminated) });
        assert_eq!(step(Task::Sparse, far), Step { reward: -1.0, end: None });
        assert_eq!(step(Task::Bonus, near), Step { reward: 10.0, end: Some(End::Terminated) });
        assert_eq!(step(Task::Bonus, far), Step { reward: -0.26, end: None });
        let dense = step(Task::Dense, near);
        assert!(dense.end.is_none() && (dense.reward + 0.25 + 0.0155).abs() < 1e-3, "{dense:?}");
    }

    #[test]
    fn the_goal_of_the_spec_is_the_end_of_the_episode() {
        let mut reacher = stretched(Task::Sparse, [0.195, 0.0]);
        let last = reacher.step(&vec![0.0, 0.0]).unwrap();
        let mut seen = Vec::new();
        reacher.observe(&mut seen);
        assert!(reacher.spec().succeeded(&last) && reacher.spec().goal.as_ref().unwrap().reached(&seen));
        assert_eq!(reacher.step(&vec![0.0, 0.0]), Err(Refused::Over));
    }

    #[test]
    fn starts_are_gymnasiums() {
        let mut reacher = Reacher::new(Task::Sparse);
        let starts: Vec<_> = (0..500).map(|seed| (reacher.reset(seed), reacher.save()).1).collect();
        let within = |numbers: &[f32], most: f32| numbers.iter().all(|x| x.abs() <= most);
        assert!(
            starts.iter().all(|s| within(&s.joints.q, ANGLE_NOISE) && within(&s.joints.v, VELOCITY_NOISE))
        );
        let radii: Vec<_> = starts.iter().map(|s| s.target[0].hypot(s.target[1])).collect();
        assert!(radii.iter().all(|radius| *radius < TARGETS));
        // Uniform in a disc: half of it lies within 1/√2 of the radius.
        let inner = radii.iter().filter(|radius| **radius < TARGETS * 0.5_f32.sqrt()).count();
        assert!((200..300).contains(&inner), "{inner} of 500");
    }

    #[test]
    fn what_follows_a_saved_state_is_what_followed_it_before() {
        let mut reacher = Reacher::new(Task::Dense);
        reacher.reset(3);
        let act = |reacher: &mut Reacher, i: usize| {
            let action = vec![if i % 13 < 9 { 1.0 } else { -0.4 }, if i % 17 < 11 { 1.0 } else { -0.7 }];
            reacher.step(&action).unwrap();
            reacher.joints().clone()
        };
        for i in 0..30 {
            act(&mut reacher, i);
        }
        let saved = reacher.save();
        let first: Vec<_> = (30..130).map(|i| act(&mut reacher, i)).collect();
        reacher.reset(4);
        reacher.load(&saved);
        assert_eq!(reacher.save(), saved);
        let again: Vec<_> = (30..130).map(|i| act(&mut reacher, i)).collect();
        assert!(
            first == again && first.iter().any(|joints| joints.q[1].abs() > 3.0),
            "and the limit was met"
        );
    }

    #[test]
    fn what_is_no_state_is_refused() {
        let mut reacher = stretched(Task::Sparse, [0.1, 0.1]);
        let good = reacher.joints().clone();
        assert!(reacher.restore(&good, [f32::NAN, 0.0]).is_err());
        assert!(reacher.restore(&Configuration { q: vec![0.0], ..good.clone() }, [0.0; 2]).is_err());
        assert!(reacher.restore(&Configuration { v: vec![0.0, f32::INFINITY], ..good }, [0.0; 2]).is_err());
        assert!(reacher.step(&vec![0.1, 0.1]).is_ok());
    }
}
