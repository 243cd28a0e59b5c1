//! The ends of joints' ranges.
//!
//! Rapier's own limit is hard: it takes all speed, and puts a joint that is beyond it back at once. MuJoCo's is
//! soft: the joint is pushed, never pulled, by a spring of time constant T that is critically damped,
//! x'' = −x / T² − 2 x' / T for x < 0 beyond the range. It lets go when that would pull, at x'' = 0. In closed
//! form, with x₀ and v₀ at the start and c = v₀ + x₀ / T, that is after T (1 + v₀ / c), at speed −c e^−(1 + v₀/c):
//!
//! - from rest at x₀ = −r: r / (e T) after T. Zero angles of the ant's ankles are 0.52 rad beyond their range,
//!   which throws them out at 4.8 rad/s.
//! - from x₀ = 0 at v₀ = −u: e⁻² u after 2 T.
//!
//! T is 20 to 40 ms, less than Rapier's call, so only the outcome is simulated: joints that are set to beyond
//! their range get the impulse at once ([`throw`]), joints that have arrived get the speed when their call is
//! over ([`Coordinate::rebound`]).
//!
//! The third case is a joint that leans on its stop. Rapier's limit sees it only when it is beyond, so a joint
//! pressed by a constant force f steps over by f/I h² in one sub-step h and is put back in the next, for ever
//! (I: inertia; 0.033 rad for the ant's 30 N m and 33 ms). There the force is that of a spring instead, as
//! strong where the joint is, and slack at the stop: the joint comes to rest there, and is held against loads
//! ([`Coordinate::leaning`]).

use rapier3d::prelude::*;

use super::{
    Configuration,
    tree::{CARRIER, Coordinate, Tree},
    world::World,
};
use crate::math;

/// e⁻², the speed of a joint after its meeting with a springy limit over that before.
const RETURNED: f32 = 0.135_335_28;
/// A joint is at the end of its range when it is nearer than this, radians or metres.
const NEAR: f32 = 0.01;
/// Joints that arrive slower than this just stop, rad/s or m/s.
const SLOW: f32 = 0.2;
/// A joint that has arrived in a call has at most this share of its speed left. One with more is still on its
/// way: Rapier has not noticed it yet.
const STOPPED: f32 = 0.3;
/// Greatest stiffness of the spring of a joint that leans on its stop, in units of I / h²: stiff enough to halve
/// the distance in a sub-step, soft enough not to ring.
const STIFFEST: f32 = 3.0;

/// The speed at which a springy limit of time constant `t` throws back a joint that is at `x` < 0, beyond its
/// range, with speed `v` (inwards is positive), less the speed that it has. Never negative.
fn throw(x: f32, v: f32, t: f32) -> f32 {
    let c = v + x / t;
    if x >= 0.0 || c >= 0.0 || v / c <= -1.0 {
        return 0.0;
    }
    (-c * math::expf(-(1.0 + v / c)) - v).max(0.0)
}

/// A joint as one end of its range sees it.
#[derive(Clone, Copy)]
struct Approach {
    /// How far it has to go, negative when it is beyond.
    way: f32,
    /// How fast it comes.
    speed: f32,
    /// Acceleration towards the end by the joint's own force.
    push: f32,
}

impl Coordinate {
    /// Whether the joint is beyond its range.
    pub(super) fn beyond(&self, state: &Configuration) -> bool {
        self.range.is_some_and(|[low, high]| !(low..=high).contains(&state.q[self.q]))
    }

    /// The impulse that a springy limit gives to the joint if it is set to beyond its range, N m s or N s.
    pub(super) fn impulse(&self, state: &Configuration, time_constant: f32) -> f32 {
        let Some([low, high]) = self.range else { return 0.0 };
        let (q, v) = (state.q[self.q], state.v[self.v]);
        self.inertia * (throw(q - low, v, time_constant) - throw(high - q, -v, time_constant))
    }

    /// Stiffness and rest of the spring that stands for `force` when the joint leans on its stop: when it would
    /// be beyond it after one sub-step from rest, and is not on its way back for longer than this call.
    pub(super) fn leaning(
        &self,
        state: &Configuration,
        force: f32,
        seconds: f32,
        substep: f32,
    ) -> Option<(f32, f32)> {
        let [low, high] = self.range?;
        let end = if force > 0.0 { high } else { low };
        let Approach { way, speed, push } = self.approach(state, force, force > 0.0)?;
        if way > push * substep * substep || -speed > push * seconds / 2.0 {
            return None;
        }
        let stiffest = STIFFEST * self.inertia / (substep * substep);
        Some(((force.abs() / way.max(f32::EPSILON)).clamp(CARRIER, stiffest), end))
    }

    /// How the joint stands to the upper or the lower end of its range.
    fn approach(&self, state: &Configuration, force: f32, upper: bool) -> Option<Approach> {
        let [low, high] = self.range?;
        let (q, v, push) = (state.q[self.q], state.v[self.v], force / self.inertia);
        Some(match upper {
            true => Approach { way: high - q, speed: v, push },
            false => Approach { way: q - low, speed: -v, push: -push },
        })
    }

    /// The range that Rapier is told of, or none when the joint cannot reach an end in this call: that saves
    /// solving for a limit that does nothing. A joint that was set to beyond its range and is on its way back is
    /// not put back.
    fn gate(&self, state: &Configuration, force: f32, seconds: f32, returning: bool) -> Option<[f32; 2]> {
        let [mut low, mut high] = self.range?;
        let (q, v) = (state.q[self.q], state.v[self.v]);
        if returning {
            (low, high) = (low.min(q), high.max(q));
        }
        // Twice what the force alone does, for what comes from other joints and the floor.
        let reach = v.abs() * seconds + force.abs() / self.inertia * seconds * seconds + NEAR;
        (q - reach < low || q + reach > high).then_some([low, high])
    }

    /// The speed of the joint after a call in which it has arrived at a springy limit, if it has.
    fn rebound(&self, call: &Call<'_>, after: &Configuration) -> Option<f32> {
        let force = call.forces[self.v];
        [false, true].into_iter().find_map(|upper| {
            let from = self.approach(call.before, force, upper)?;
            let now = self.approach(after, force, upper)?;
            let back = returned(from, now, call)?;
            Some(if upper { -back } else { back })
        })
    }
}

/// The speed away from a springy limit that a joint has at the end of a call, if it has arrived there.
fn returned(from: Approach, now: Approach, call: &Call<'_>) -> Option<f32> {
    let Approach { way, speed, push } = Approach { way: from.way.max(0.0), ..from };
    let square = speed * speed + 2.0 * push * way;
    if now.way > NEAR || square <= 0.0 || (from.way <= 0.0 && speed <= 0.0) {
        return None;
    }
    let arriving = square.sqrt();
    if arriving < SLOW || now.speed.abs() > STOPPED * arriving {
        return None;
    }
    // What is left of the call after the way there and the spring's time pushes it towards the stop again.
    let way_there = way / ((speed + arriving) / 2.0).max(1e-3);
    let left = (call.seconds - way_there - 2.0 * call.time_constant).max(0.0);
    let back = RETURNED * arriving;
    Some((back - push * left).clamp(0.0, back))
}

/// A call of Rapier, as its springy limits see it.
pub(super) struct Call<'a> {
    /// The configuration before it.
    pub(super) before: &'a Configuration,
    /// Generalised forces in it.
    pub(super) forces: &'a [f32],
    /// How long it takes, seconds.
    pub(super) seconds: f32,
    /// Sub-steps in it.
    pub(super) substeps: u32,
    /// The limits' time constant, seconds.
    pub(super) time_constant: f32,
    /// Which joints, in the order of the velocities, were set to beyond their range and are not back yet.
    pub(super) returning: &'a [bool],
}

impl Tree {
    /// Tells Rapier of the limits that can matter in the coming call, and lets joints lean on their stops.
    /// Forces must have been set.
    pub(super) fn meet_limits(&self, world: &mut World, call: &Call<'_>) {
        let substep = call.seconds / call.substeps as f32;
        let Some(multibody) = self.multibody_mut(world) else { return };
        for joint in self.joints.iter().filter(|joint| joint.range.is_some()) {
            let Some(link) = multibody.link_mut(joint.link) else { continue };
            let (force, returning) = (call.forces[joint.v], call.returning[joint.v]);
            let data = &mut link.joint.data;
            let axis = if joint.axis == 0 { JointAxis::LinX } else { JointAxis::AngX };
            match joint.gate(call.before, force, call.seconds, returning) {
                Some(range) => drop(data.set_limits(axis, range)),
                None => data.limit_axes.remove(axis.into()),
            }
            let leaning = joint.leaning(call.before, force, call.seconds, substep);
            if let (Some((stiffness, rest)), false) = (leaning, returning) {
                link.joint.set_spring(joint.axis, stiffness, rest);
            }
        }
    }

    /// Sends back the joints that have arrived at an end of their range.
    pub(super) fn rebound(&self, world: &mut World, call: &Call<'_>, after: &mut Configuration) {
        let Some(multibody) = self.multibody_mut(world) else { return };
        for joint in &self.joints {
            if let Some(speed) = joint.rebound(call, after) {
                multibody.generalized_velocity_mut()[joint.assembly] = speed;
                after.v[joint.v] = speed;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::throw;

    /// The spring, integrated in steps of a microsecond.
    fn integrated(mut x: f64, mut v: f64, t: f64) -> f64 {
        loop {
            let acceleration = -x / (t * t) - 2.0 * v / t;
            if acceleration <= 0.0 || x >= 0.0 {
                return v;
            }
            v += acceleration * 1e-6;
            x += v * 1e-6;
        }
    }

    #[test]
    fn the_closed_form_is_what_integration_gives() {
        for (x, v) in [(-0.6, 0.0), (-0.3, -1.0), (-0.2, 2.0), (-0.5, 1.0), (-0.001, -3.0)] {
            for t in [0.02, 0.04] {
                let (ours, theirs) = (v + throw(x, v, t), integrated(x.into(), v.into(), t.into()) as f32);
                assert!((ours - theirs).abs() < 1e-3 * theirs, "{ours} instead of {theirs} from {x}, {v}");
            }
        }
        assert_eq!(throw(-0.1, 20.0, 0.04), 0.0, "nothing pushes what leaves faster by itself");
        assert_eq!(throw(0.1, -1.0, 0.04), 0.0, "nothing pushes within the range");
    }
}
