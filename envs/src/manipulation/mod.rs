//! Door, Lever and Slide: a gripper that holds an object moves its one joint (thesis section 5.2.2).
//!
//! The thesis' robot experiments ran on a fork of robosuite with a Panda arm. Here a hand that flies freely stands
//! in for the arm: actions, rates, objects, thresholds, rewards and the observation's layout are the fork's, joint
//! limits of an arm there are none. The question is the thesis': which of the 250 grasps that an episode may start
//! from afford success.

mod grasps;
mod observe;
pub mod oracle;
mod task;

use inroads_sim::rigid::{
    Pose, Rectangle, Vector,
    hand::{Command, Reading, Saved, Workbench, gripper},
};
use inroads_sim::view::{Colour, Scene, colour};
use rand::RngExt;

pub use grasps::{GRASPS, POINTS, Region, Spread, WRISTS, grasps};
pub use observe::{HAND, HANDLE_TO_HAND, JOINT, LENGTH};
pub use task::{DOOR, LEVER, Path, SLIDE, Task, TaskError};

use crate::registry::{AnyEnvironment, Entry, Make};
use crate::{
    Dimension, Drawing, End, Environment, Refused, Render, Seed, Snapshot, Space, Spec, Step, Sweep,
    TimeLimit,
};

/// The three tasks of the registry.
pub(crate) const ENTRIES: &[Entry] = &[
    Entry {
        name: DOOR.name,
        about: DOOR.about,
        make: Make::Bodies { make: || any(&DOOR), picture: || None },
    },
    Entry {
        name: LEVER.name,
        about: LEVER.about,
        make: Make::Bodies { make: || any(&LEVER), picture: || None },
    },
    Entry {
        name: SLIDE.name,
        about: SLIDE.about,
        make: Make::Bodies { make: || any(&SLIDE), picture: || None },
    },
];

fn any(task: &'static Task) -> AnyEnvironment {
    AnyEnvironment::Vectors(Box::new(limited(task).expect("the tasks of this crate are well formed")))
}

/// A task as the registry has them, with episodes of at most [`LIMIT`] steps.
///
/// # Errors
/// [`TaskError`] says what is wrong with the task.
pub fn limited(task: &'static Task) -> Result<TimeLimit<Manipulation>, TaskError> {
    Ok(TimeLimit::new(Manipulation::new(task)?, LIMIT))
}

/// Steps after which an episode is truncated (the fork's horizon).
pub const LIMIT: u32 = 250;
/// Control steps in which a reset closes the fingers (the fork's).
const CLOSING: u32 = 10;
/// Stiffness of action 0; 1 doubles it and -1 is none (the fork: 0 to 300).
const STIFFNESS: f32 = 150.0;
/// Shift of action 1, metres: robosuite's 0.05 times the fork's action scale 0.5.
const SHIFT: f32 = 0.025;
/// Turn of action 1, radians: 0.5 times the scale.
const TURN: f32 = 0.25;
/// Greatest reward of a step (the fork's clip).
const MOST: f32 = 0.5;

/// A gripper at an object.
///
/// Actions are 13 numbers in [-1, 1]: six stiffnesses, three shifts, three turns, the grip. Rewards are the joint's
/// progress beyond its best so far in this episode; an episode terminates on success and never otherwise, so
/// [`Spec::succeeded`] is the cumulant of an initiation value function.
pub struct Manipulation {
    task: &'static Task,
    spec: Spec,
    bench: Workbench,
    grasps: Vec<Pose>,
    best: f32,
    over: bool,
    fault: Option<String>,
}

/// A moment of an episode, see [`Snapshot`].
#[derive(Clone)]
pub struct State {
    bench: Saved,
    best: f32,
    over: bool,
    fault: Option<String>,
}

impl Manipulation {
    /// Sets a task up: one of [`DOOR`], [`LEVER`] and [`SLIDE`], or one of your own.
    ///
    /// # Errors
    /// [`TaskError`] says what is wrong with the task.
    pub fn new(task: &'static Task) -> Result<Self, TaskError> {
        let bench = Workbench::new(&task.model())?;
        let grasps = grasps(task)?;
        Ok(Self { task, spec: spec(task), bench, grasps, best: 0.0, over: true, fault: None })
    }

    /// The task.
    pub fn task(&self) -> &'static Task {
        self.task
    }

    /// The poses of the hand that episodes start from, in the world, before the fingers close.
    pub fn grasps(&self) -> &[Pose] {
        &self.grasps
    }

    /// Begins an episode at a grasp.
    fn grip(&mut self, grasp: usize) {
        self.bench.begin(self.grasps[grasp], gripper::OPEN).expect("candidate grasps are finite");
        let hold = Command { stiffness: [STIFFNESS; 6], shift: Vector::ZERO, turn: Vector::ZERO, grip: 1.0 };
        let closed = (0..CLOSING).try_for_each(|_| self.bench.step(&hold));
        self.fault = closed.err().map(|fault| fault.to_string());
        self.best = self.bench.reading().joint;
        self.over = false;
    }

    /// Where everything is.
    pub fn reading(&self) -> Reading {
        self.bench.reading()
    }

    /// The hand, the object and the controller.
    pub fn bench(&self) -> &Workbench {
        &self.bench
    }

    /// What the controller is told by an admissible action.
    fn command(&self, action: &[f32]) -> Command {
        let [shift, turn] = [6, 9].map(|i| Vector::from_slice(&action[i..i + 3]));
        // The goal stays within reach: what bounds an arm's workspace bounds the free hand's.
        let at = self.bench.reading().hand.translation;
        let centre = self.task.place() * Vector::from_array(self.task.handle);
        let reach = Vector::splat(observe::REACH);
        let goal = (at + shift * SHIFT).clamp(centre - reach, centre + reach);
        Command {
            stiffness: std::array::from_fn(|i| STIFFNESS * (action[i] + 1.0)),
            shift: goal - at,
            turn: turn * TURN,
            grip: action[12],
        }
    }
}

impl Environment for Manipulation {
    type Observation = Vec<f32>;
    type Action = Vec<f32>;

    fn spec(&self) -> &Spec {
        &self.spec
    }

    /// The seed draws one of the grasps, all with the same chance.
    fn reset(&mut self, seed: u64) {
        let grasp = Seed(seed).stream("start", 0).random_range(0..self.grasps.len());
        self.grip(grasp);
    }

    fn step(&mut self, action: &Vec<f32>) -> Result<Step, Refused> {
        if self.over {
            return Err(Refused::Over);
        }
        self.spec.action.admit(action)?;
        if self.fault.is_none() {
            let command = self.command(action);
            self.fault = self.bench.step(&command).err().map(|fault| fault.to_string());
        }
        if self.fault.is_some() {
            self.over = true;
            return Ok(Step { reward: 0.0, end: Some(End::Truncated) });
        }
        let joint = self.bench.reading().joint;
        let reward = (joint - self.best).clamp(0.0, MOST);
        self.best = self.best.max(joint);
        self.over = joint > self.task.success;
        Ok(Step { reward, end: self.over.then_some(End::Terminated) })
    }

    fn observe(&mut self, out: &mut Vec<f32>) {
        observe::observe(self.task, &self.bench.reading(), self.bench.moving(), out);
    }

    fn fault(&self) -> Option<&str> {
        self.fault.as_deref()
    }
}

impl Snapshot for Manipulation {
    type State = State;

    fn save(&self) -> State {
        State { bench: self.bench.save(), best: self.best, over: self.over, fault: self.fault.clone() }
    }

    fn load(&mut self, state: &State) {
        self.bench.load(&state.bench);
        (self.best, self.over) = (state.best, state.over);
        self.fault.clone_from(&state.fault);
    }
}

/// The starts are the [`grasps`](Manipulation::grasps): the hand is put there with its fingers wide open, then closes
/// them for half a second. The same grasp always gives the same episode.
impl Sweep for Manipulation {
    fn starts(&self) -> usize {
        self.grasps.len()
    }

    fn begin(&mut self, start: usize) {
        self.grip(start);
    }
}

impl Render for Manipulation {
    fn drawing(&self) -> Drawing {
        const COLOURS: [&[Colour]; 2] = [
            &[colour::ARM, colour::FOOT, colour::FOOT],
            &[colour::JOINT, colour::OBJECT, colour::HANDLE, colour::FURNITURE],
        ];
        let focus = self.task.place() * Vector::from_array(self.task.handle);
        let (x, y) = (f64::from(focus.x), f64::from(focus.y));
        Drawing::Bodies(Scene {
            solids: self.bench.solids(|model, link| COLOURS[model][link]).collect(),
            marks: Vec::new(),
            trail: Vec::new(),
            bounds: Rectangle { low: [x - 0.5, y - 0.5], high: [x + 0.5, y + 0.5] },
            focus,
            distance: 0.9,
        })
    }
}

fn spec(task: &Task) -> Spec {
    const ACTIONS: [&str; 13] = [
        "stiffness_x",
        "stiffness_y",
        "stiffness_z",
        "stiffness_rx",
        "stiffness_ry",
        "stiffness_rz",
        "shift_x",
        "shift_y",
        "shift_z",
        "turn_x",
        "turn_y",
        "turn_z",
        "grip",
    ];
    Spec {
        name: task.name,
        about: task.about,
        observation: observe::space(task),
        action: Space::Box(ACTIONS.map(|name| Dimension::linear(name, "", -1.0, 1.0)).into()),
        goal: None,
        place: (HAND..HAND + 3).collect(),
        time_limit: None,
        // Only success terminates.
        success_reward: 0.0,
    }
}
