//! How time passes, and what bodies stand in.

use rapier3d::math::Vector;

use crate::rigid::CellMap;

/// How time passes for articulated bodies.
///
/// Contacts are found once a call; forces, joints and impulses are dealt with once a sub-step. So a call of
/// several sub-steps costs less than as many calls, and needs a [`prediction`](Self::prediction) that covers
/// what bodies travel in it.
///
/// A contact that was found at the start of a call is wrong when a leg has come round a corner by its end. So
/// where a solid may meet a wall in a call, [`Articulated::step`](super::Articulated::step) makes calls of a third
/// of a sub-step instead: with calls of a sub-step, the ant was deeper than 2 cm in a wall after 20
/// of 500,000 random control steps; so, after 4 of 2,000,000, and never deeper than 4.4 cm.
#[derive(Clone, Debug, PartialEq)]
pub struct Physics {
    /// Seconds from one action to the next.
    pub control_step: f32,
    /// Rapier steps in a control step, at least 1.
    pub calls: u32,
    /// Solver sub-steps in a Rapier step, at least 1.
    pub substeps: u32,
    /// Passes of the solver, in each sub-step, that take away again the speed with which it pushes bodies out
    /// of each other; at least 1, or contacts give energy to the bodies.
    pub relaxations: u32,
    /// How far ahead contacts are looked for, metres: what comes faster than this in a call is found too late.
    pub prediction: f32,
    /// m/s².
    pub gravity: Vector,
    /// What becomes of joints at the ends of their ranges.
    pub limits: Limits,
}

/// What becomes of joints at the ends of their ranges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limits {
    /// They stop dead there. One that is set to beyond its range is moved back at once, without any speed.
    Hard,
    /// They meet a critically damped spring that only pushes, as in MuJoCo; the spring is integrated in closed
    /// form, since it is faster than a call. One that arrives comes back with e⁻² of its speed; one that is set
    /// to beyond its range, by r, is thrown back at r / (e T).
    Springy {
        /// The spring's time constant T, seconds: the first number of MuJoCo's `solreflimit`, which it takes
        time_constant: f32,
    },
}

impl Physics {
    /// Gravity of MuJoCo's models, m/s².
    pub const GRAVITY: Vector = Vector::new(0.0, 0.0, -9.81);

    /// Seconds that a Rapier step takes.
    pub(super) fn call(&self) -> f32 {
        self.control_step / self.calls as f32
    }

    /// What is wrong with the numbers, if anything.
    pub(super) fn wrong(&self) -> Option<&'static str> {
        let positive = |x: f32| x > 0.0 && x.is_finite();
        if !positive(self.control_step) {
            Some("control_step must be a positive number of seconds")
        } else if self.calls == 0 || self.substeps == 0 || self.relaxations == 0 {
            Some("calls, substeps and relaxations must be at least 1")
        } else if !positive(self.prediction) {
            Some("prediction must be a positive number of metres")
        } else if !self.gravity.is_finite() {
            Some("gravity must be finite")
        } else if matches!(self.limits, Limits::Springy { time_constant } if !positive(time_constant)) {
            Some("the time constant of springy limits must be a positive number of seconds")
        } else {
            None
        }
    }
}

/// What articulated bodies stand in.
#[derive(Clone, Copy, Debug, Default)]
pub struct Surroundings<'a> {
    /// Height of the floor, metres; `None`: there is none, bodies fall for ever.
    pub floor: Option<f32>,
    /// Walls from below the floor to higher than anything climbs.
    pub walls: Option<&'a CellMap>,
}
