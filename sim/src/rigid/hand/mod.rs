//! A hand that flies freely, objects with one joint, and the controller that moves the one against the other.
//!
//! The hand stands in for the Panda arm of robosuite: it takes the same commands (stiffness, shift and turn of the
//! hand, grip) at the same rate, but has no arm behind it, so nothing is out of its reach and no arm is in its way.

mod clearance;
pub mod gripper;
mod impedance;
pub mod objects;
mod workbench;

pub use clearance::Clearance;
pub use impedance::Impedance;
pub use workbench::{CONTROL_STEP, Command, Reading, Saved, Workbench};
