//! What makes one of the three tasks differ from the others.

use inroads_sim::rigid::{Model, ModelError, Pose, Rotation, Vector, hand::objects};

use super::grasps::{Region, Spread};

/// A task: an object, how far its joint is to go, and where hands may take hold of it.
#[derive(Clone, Copy, Debug)]
pub struct Task {
    /// Its name in the registry.
    pub name: &'static str,
    /// One sentence.
    pub about: &'static str,
    /// The object, in its own frame.
    pub object: fn() -> Model,
    /// Where the object's frame is in the world, metres. It is turned by -90 degrees about the vertical.
    pub at: [f32; 3],
    /// How the object's joint moves its handle, in the object's frame.
    pub path: Path,
    /// Greatest position of the joint, radians or metres.
    pub end: f32,
    /// Position of the joint beyond which the task is done.
    pub success: f32,
    /// Middle of what is meant to be gripped, in the object's frame when the joint is at zero, metres.
    pub handle: [f32; 3],
    /// Which way a hand points that is not turned: its approach and the line along which its fingers close, in
    /// the object's frame.
    pub upright: [[f32; 3]; 2],
    /// How wrists are spread about the points: as narrow for door and slide as a sampler on the surface would
    /// have it, wider for the lever, whose bar is as easily held as the door's.
    pub spread: Spread,
    /// The solids that a hand can span.
    pub regions: &'static [Region],
}

/// How a joint moves things, in the object's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Path {
    /// About an axis through a point, right-handed.
    Turn {
        /// Direction of the axis, of length 1.
        axis: [f32; 3],
        /// A point on it, metres.
        through: [f32; 3],
    },
    /// Along a direction of length 1.
    Shift([f32; 3]),
}

/// Why a task cannot be set up.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TaskError {
    /// Its object cannot be built.
    #[error(transparent)]
    Object(#[from] ModelError),
    /// There is nothing to grip.
    #[error(
        "task {0:?} has no region that fingers can close on; give one of positive size, with a closing axis"
    )]
    Bare(&'static str),
    /// The spread of its wrists is not one.
    #[error(
        "the spread of task {0:?} must be of positive finite numbers, the least depth before the greatest"
    )]
    Spread(&'static str),
    /// Too few candidates touch nothing.
    #[error(
        "task {task:?}: open hands fit about {points} points only, 50 are needed; give regions with room"
    )]
    Crowded {
        /// The task.
        task: &'static str,
        /// Points with enough wrists.
        points: usize,
    },
}

impl Task {
    /// Whether candidates can be drawn.
    pub(super) fn check(&self) -> Result<(), TaskError> {
        let positive = |x: f32| x > 0.0 && x.is_finite();
        let faces = self.regions.iter().flat_map(|region| region.closings.iter().map(|c| region.area(*c)));
        if !positive(faces.sum()) {
            return Err(TaskError::Bare(self.name));
        }
        let Spread { swing, twist, depth, aside, margin } = self.spread;
        let spread = [swing, twist, aside, depth[1] - depth[0]].into_iter().all(positive);
        if spread && margin >= 0.0 { Ok(()) } else { Err(TaskError::Spread(self.name)) }
    }

    /// Where the object's frame is in the world.
    pub fn place(&self) -> Pose {
        let turned = Rotation::from_rotation_z(-std::f32::consts::FRAC_PI_2);
        Pose::from_parts(Vector::from_array(self.at), turned)
    }

    /// The object where it stands in the world.
    pub fn model(&self) -> Model {
        let mut model = (self.object)();
        model.links[0].place = self.place();
        model
    }
}

/// The door: 0.3 of 0.4 rad. Poses, ranges and thresholds of all three are the fork's.
pub const DOOR: Task = Task {
    name: "door",
    about: "a gripper that holds a door pulls it open by 0.3 rad; the joint's progress a step",
    object: objects::door,
    at: [-0.12, -0.35, 1.1],
    path: Path::Turn { axis: [0.0, 0.0, 1.0], through: [0.255, 0.0, 0.0] },
    end: 0.4,
    success: 0.3,
    handle: [-0.1, -0.1, -0.025],
    upright: [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    spread: Spread { swing: 1.5, twist: 0.8, depth: [-0.02, 0.01], aside: 0.02, margin: 0.002 },
    regions: &[
        // The handle's bar and its stub.
        Region { centre: [-0.1, -0.1, -0.025], half: [0.075, 0.015, 0.02], closings: &[1, 2] },
        Region { centre: [-0.175, -0.0725, -0.025], half: [0.025, 0.0525, 0.025], closings: &[0, 2] },
    ],
};

/// The lever: 0.5 of 1.75 rad.
pub const LEVER: Task = Task {
    name: "lever",
    about: "a gripper that holds a lever turns it up by 0.5 rad; the joint's progress a step",
    object: objects::lever,
    at: [-0.6, -0.5, 1.1],
    path: Path::Turn { axis: [1.0, 0.0, 0.0], through: [0.0, 0.0, 0.025] },
    end: 1.75,
    success: 0.5,
    handle: [0.0, 0.225, 0.025],
    upright: [[0.0, 0.0, -1.0], [1.0, 0.0, 0.0]],
    spread: Spread { swing: 1.5, twist: 0.8, depth: [-0.04, 0.0], aside: 0.03, margin: 0.002 },
    regions: &[
        // The bar, the arm, the two posts.
        Region { centre: [0.0, 0.225, 0.025], half: [0.015, 0.075, 0.015], closings: &[0, 2] },
        Region { centre: [0.0, 0.1125, 0.025], half: [0.015, 0.0375, 0.015], closings: &[0, 2] },
        Region { centre: [0.04, 0.0, 0.025], half: [0.025, 0.075, 0.025], closings: &[0] },
        Region { centre: [-0.04, 0.0, 0.025], half: [0.025, 0.075, 0.025], closings: &[0] },
    ],
};

/// The slide: 0.2 of 0.4 m.
pub const SLIDE: Task = Task {
    name: "slide",
    about: "a gripper that holds a slide's post pulls it along by 0.2 m; the joint's progress a step",
    object: objects::slide,
    at: [-0.6, -0.5, 0.5],
    path: Path::Shift([0.0, -1.0, 0.0]),
    end: 0.4,
    success: 0.2,
    handle: [0.0, 0.2, 0.0975],
    upright: [[0.0, 0.0, -1.0], [1.0, 0.0, 0.0]],
    spread: Spread { swing: 1.5, twist: 0.8, depth: [-0.02, 0.01], aside: 0.02, margin: 0.002 },
    regions: &[
        // The post, the carriage above the rails, the two rails.
        Region { centre: [0.0, 0.2, 0.09875], half: [0.01, 0.01, 0.02875], closings: &[0, 1] },
        Region { centre: [0.0, 0.2, 0.0625], half: [0.0248, 0.05, 0.0075], closings: &[0] },
        Region { centre: [0.0375, 0.1, 0.0425], half: [0.0125, 0.2, 0.0125], closings: &[0] },
        Region { centre: [-0.0375, 0.1, 0.0425], half: [0.0125, 0.2, 0.0125], closings: &[0] },
    ],
};
