//! From MJCF's motors to actuators.

use std::collections::BTreeMap;

use super::{MjcfError, vocabulary::Places};
use crate::rigid::Actuator;

/// Reads the motors, in the order of the file.
pub(super) fn read(
    file: &mjcf_rs::Model,
    places: &Places,
    joints: &BTreeMap<String, usize>,
) -> Result<Vec<Actuator>, MjcfError> {
    file.actuators
        .iter()
        .zip(&places.motors)
        .map(|(motor, place)| {
            let link = motor.joint.as_ref().and_then(|joint| joints.get(joint)).ok_or_else(|| {
                let all: Vec<_> = joints.keys().map(String::as_str).collect();
                place.error(
                    "it drives no hinge or slide of this body",
                    format!("name one as its joint; there are: {}", all.join(", ")),
                )
            })?;
            let limited = motor.ctrl_limited.resolve(file.compiler.autolimits, motor.ctrl_range.is_some());
            let most = match motor.ctrl_range.filter(|_| limited) {
                Some([low, high]) if high > 0.0 && (low + high).abs() <= 1e-6 * high => high,
                Some([low, high]) => {
                    return Err(place.error(
                        format!("its controls are from {low} to {high}, and ours reach as far down as up"),
                        "give it a symmetric ctrlrange",
                    ));
                }
                None => {
                    return Err(place.error(
                        "its control has no limit",
                        "give it a ctrlrange: a control of 1 will be its upper end",
                    ));
                }
            };
            Ok(Actuator { link: *link, gear: (motor.gear[0] * most) as f32 })
        })
        .collect()
}
