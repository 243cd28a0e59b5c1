//! Model-based control: a learned model of the dynamics, and planning with it (Nagabandi 2018; thesis 4.1.3, 6.1).

mod agent;
mod dynamics;
mod plan;
mod planned;
mod predict;
mod refining;
mod shooting;
mod standard;
mod steer;
#[cfg(test)]
mod tests;
mod view;

pub use agent::{Mpc, MpcConfig, Planning};
pub use dynamics::{Dynamics, DynamicsConfig, Fit};
pub use plan::{Candidates, Planner, Problem};
pub use planned::{Planned, PlannedConfig};
pub use predict::{Objective, Predict, Reach, Reward, Values};
pub use refining::Refining;
pub use shooting::Shooting;
pub use steer::PlannerKind;
pub use view::{FreeBody, Plain, View};

/// What is wrong with a planner's horizon or discount, if anything.
fn horizon_and_discount(table: &str, horizon: usize, discount: f32) -> Result<(), String> {
    if horizon == 0 {
        return Err(format!("{table}.horizon is 0; a plan has at least one action"));
    }
    if !(0.0..=1.0).contains(&discount) {
        return Err(format!("{table}.discount is {discount}; it must lie in [0, 1]"));
    }
    Ok(())
}
