//! What can be wrong with models, states and steps.

/// Why models do not make a world. The message names the place and the mend.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// A link cannot be as it is.
    #[error("model {model:?}, link {link:?}: {what}")]
    Link {
        /// The model's name.
        model: String,
        /// The link's name.
        link: String,
        /// What is wrong, and what would be right.
        what: &'static str,
    },
    /// A model as a whole cannot be as it is.
    #[error("model {model:?}: {what}")]
    Model {
        /// The model's name.
        model: String,
        /// What is wrong, and what would be right.
        what: &'static str,
    },
    /// An actuator drives no joint.
    #[error("model {model:?}, actuator {actuator}: {what}")]
    Actuator {
        /// The model's name.
        model: String,
        /// The actuator's index.
        actuator: usize,
        /// What is wrong, and what would be right.
        what: &'static str,
    },
    /// The numbers of [`Physics`](super::Physics) or [`Surroundings`](super::Surroundings).
    #[error("physics: {0}")]
    Physics(&'static str),
}

/// Why a state cannot be taken up. The world is as it was before.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StateError {
    /// There are too few or too many numbers.
    #[error("the state has {positions} positions and {velocities} velocities; these bodies have {q} and {v}")]
    Length {
        /// Positions given.
        positions: usize,
        /// Velocities given.
        velocities: usize,
        /// Positions that the models have.
        q: usize,
        /// Velocities that the models have.
        v: usize,
    },
    /// A number is infinite or none at all.
    #[error("{which} {index} of the state is {value}; all numbers must be finite")]
    NotFinite {
        /// "position" or "velocity".
        which: &'static str,
        /// Its index.
        index: usize,
        /// What it is.
        value: f32,
    },
    /// A quaternion of length zero is no orientation.
    #[error("the quaternion at position {index} of the state has length {length}; it must be near 1")]
    Quaternion {
        /// Index of its first component.
        index: usize,
        /// Its length.
        length: f32,
    },
    /// A body would stand in a wall.
    #[error(
        "link {link:?} of model {model:?} is {depth} m deep in a wall at ({x}, {y}); at most {} is allowed",
        super::state::WALL_TOLERANCE
    )]
    InWall {
        /// The model's name.
        model: String,
        /// The link's name.
        link: String,
        /// How deep it is in, metres; infinite when its middle is in a wall or outside the map.
        depth: f32,
        /// Where the link is.
        x: f32,
        /// Where the link is.
        y: f32,
    },
}

/// Why a step was not made, or gave no state.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PhysicsFault {
    /// Too few or too many controls or forces; nothing has moved.
    #[error("{given} {what} were given; these bodies take {expected}")]
    Length {
        /// "controls" or "forces".
        what: &'static str,
        /// Numbers given.
        given: usize,
        /// Numbers that there should have been.
        expected: usize,
    },
    /// A control, force or time is infinite or none at all; nothing has moved.
    #[error("{what} {index} is {value}; it must be a finite number")]
    NotFinite {
        /// "control", "force" or "seconds".
        what: &'static str,
        /// Its index.
        index: usize,
        /// What it is.
        value: f32,
    },
    /// The simulation broke down: Rapier put a body into quarantine, or a number is not finite any more. Only
    /// [`restore`](super::Articulated::restore) and [`load`](super::Articulated::load) mend it.
    #[error(
        "the physics of model {model:?} diverged ({why}); restore a state, and please report what led here"
    )]
    Diverged {
        /// The model's name.
        model: String,
        /// How it was noticed.
        why: &'static str,
    },
}
