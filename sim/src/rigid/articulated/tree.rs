//! A model as Rapier has it: which body, link and coordinate is which.

use std::ops::Range;

use rapier3d::{math::Pose, parry::query, prelude::*};

use super::{Configuration, contacts::Party, world::World};
use crate::rigid::CellMap;

/// Stiffness of the spring that carries a joint's force, N m/rad or N/m. See [`Tree::push`].
pub(super) const CARRIER: f32 = 1e-3;

/// What gets beyond this, in metres, radians, m/s or rad/s, is not simulated any more but has been lost.
const BOUND: f32 = 1e6;

/// How near to a wall a solid at rest may start to move and meet it, metres.
const ALERT: f32 = 0.1;

/// A model in a world.
pub(super) struct Tree {
    /// Whether its root is free.
    pub(super) free: bool,
    /// Its positions in a [`Configuration`].
    pub(super) q: Range<usize>,
    /// Its velocities in a [`Configuration`].
    pub(super) v: Range<usize>,
    /// Rapier's bodies, the root's first: links that do not move against each other are one body.
    pub(super) bodies: Vec<RigidBodyHandle>,
    /// Of each link, its body's index in `bodies` and its frame in the body's.
    pub(super) links: Vec<(usize, Pose)>,
    /// Absent when there are no joints.
    pub(super) multibody: Option<MultibodyIndex>,
    /// Its hinges and slides.
    pub(super) joints: Vec<Coordinate>,
    /// Index of the velocity that an actuator drives, and its gear.
    pub(super) drives: Vec<(usize, f32)>,
}

/// A hinge or slide.
pub(super) struct Coordinate {
    /// Index of its link in the multibody.
    pub(super) link: usize,
    /// Index of its axis in Rapier's joint: 0 for slides, 3 for hinges, which both run along x.
    pub(super) axis: usize,
    /// Index of its velocity in the multibody.
    pub(super) assembly: usize,
    /// Index of its position in a [`Configuration`].
    pub(super) q: usize,
    /// Index of its velocity in a [`Configuration`].
    pub(super) v: usize,
    /// Least and greatest position.
    pub(super) range: Option<[f32; 2]>,
    /// Rotor inertia, kg m² or kg.
    pub(super) armature: f32,
    /// What a force on this joint alone has to move when all joints are at zero: rotor and links, kg m² or kg.
    pub(super) inertia: f32,
}

impl Tree {
    /// Applies generalised forces, in the order of a configuration's velocities, until the next call of this.
    ///
    /// Rapier knows no forces on joints. It knows springs, −K (q − rest), which it adds to the generalised
    /// forces in every sub-step; a spring so soft and with its rest so far away is a constant force. The error,
    /// K q, is a thousandth of a N m.
    pub(super) fn push(&self, world: &mut World, forces: &[f32]) {
        if self.free {
            self.push_root(world, &forces[self.v.start..self.v.start + 6]);
        }
        let Some(multibody) = self.multibody_mut(world) else { return };
        for joint in &self.joints {
            let Some(link) = multibody.link_mut(joint.link) else { continue };
            link.joint.set_spring(joint.axis, CARRIER, forces[joint.v] / CARRIER);
        }
    }

    /// The model's multibody, to be changed without Rapier's taking it for one that was moved.
    pub(super) fn multibody_mut<'a>(&self, world: &'a mut World) -> Option<&'a mut Multibody> {
        world.rapier.multibody_joints.get_multibody_mut_internal(self.multibody?)
    }

    /// A free root is pushed as a body. Its frame lies at its centre of mass (see `build`).
    fn push_root(&self, world: &mut World, wrench: &[f32]) {
        let idle = wrench.iter().all(|x| *x == 0.0);
        let body = &world.rapier.bodies[self.bodies[0]];
        if idle && body.user_force() == Vector::ZERO && body.user_torque() == Vector::ZERO {
            // Not even touched: Rapier takes every body that is for one that was moved.
            return;
        }
        let turn = *body.rotation();
        let force = Vector::from_slice(&wrench[..3]);
        let arm = turn * self.links[0].1.translation;
        let torque = turn * Vector::from_slice(&wrench[3..6]) + arm.cross(force);
        let body = &mut world.rapier.bodies[self.bodies[0]];
        body.reset_forces(true);
        body.reset_torques(true);
        body.add_force(force, true);
        body.add_torque(torque, true);
    }

    /// Puts the model into a state. The world must be as its template has it: all joints at zero.
    pub(super) fn write(&self, world: &mut World, state: &Configuration) {
        let rapier = &mut world.rapier;
        let (mut linear, mut angular) = (Vector::ZERO, Vector::ZERO);
        if self.free {
            let (q, v) = (&state.q[self.q.start..], &state.v[self.v.start..]);
            let turn = Rotation::from_xyzw(q[4], q[5], q[6], q[3]);
            let origin = Pose::from_parts(Vector::from_slice(&q[..3]), turn);
            let body = origin * self.links[0].1.inverse();
            angular = turn * Vector::from_slice(&v[3..6]);
            linear = Vector::from_slice(&v[..3]) + angular.cross(body.translation - origin.translation);
            let root = &mut rapier.bodies[self.bodies[0]];
            root.set_position(body, true);
            root.set_linvel(linear, true);
            root.set_angvel(angular, true);
        }
        let Some(index) = self.multibody else { return };
        let Some(multibody) = rapier.multibody_joints.get_multibody_mut_internal(index) else { return };
        for joint in &self.joints {
            let Some(link) = multibody.link_mut(joint.link) else { continue };
            link.joint.apply_displacement(&[state.q[joint.q] - link.joint.coords()[joint.axis]]);
        }
        let mut velocity = multibody.generalized_velocity_mut();
        for joint in &self.joints {
            velocity[joint.assembly] = state.v[joint.v];
        }
        if self.free {
            for (axis, (linear, angular)) in linear.to_array().into_iter().zip(angular.to_array()).enumerate()
            {
                velocity[axis] = linear;
                velocity[axis + 3] = angular;
            }
        }
        multibody.forward_kinematics(&rapier.bodies, true);
        multibody.update_rigid_bodies(&mut rapier.bodies, true);
        self.carry(rapier);
    }

    /// Puts the solids where their bodies are. Rapier would do so only at the end of its next step, and look for
    /// contacts where they were before.
    fn carry(&self, rapier: &mut PhysicsWorld) {
        for body in self.bodies.iter().map(|body| &rapier.bodies[*body]) {
            for handle in body.colliders() {
                let Some(collider) = rapier.colliders.get_mut(*handle) else { continue };
                let place = collider.position_wrt_parent().copied().unwrap_or_default();
                collider.set_position(*body.position() * place);
            }
        }
    }

    /// Reads the model's state, and says whether all of it is finite and within [`BOUND`].
    pub(super) fn read(&self, world: &World, state: &mut Configuration) -> bool {
        let (q, v) = (&mut state.q, &mut state.v);
        if self.free {
            let body = &world.rapier.bodies[self.bodies[0]];
            let origin = *body.position() * self.links[0].1;
            let (at, turn) = (origin.translation, origin.rotation);
            let (mut linear, mut angular) = (body.linvel(), body.angvel());
            if let Some(index) = self.multibody {
                let velocity = world.multibody(index).generalized_velocity();
                linear = Vector::new(velocity[0], velocity[1], velocity[2]);
                angular = Vector::new(velocity[3], velocity[4], velocity[5]);
            }
            linear += angular.cross(at - body.translation());
            let own = turn.inverse() * angular;
            q[self.q.start..self.q.start + 7]
                .copy_from_slice(&[at.x, at.y, at.z, turn.w, turn.x, turn.y, turn.z]);
            v[self.v.start..self.v.start + 6]
                .copy_from_slice(&[linear.x, linear.y, linear.z, own.x, own.y, own.z]);
        }
        if let Some(index) = self.multibody {
            let multibody = world.multibody(index);
            let velocity = multibody.generalized_velocity();
            for joint in &self.joints {
                q[joint.q] =
                    multibody.link(joint.link).map_or(f32::NAN, |link| link.joint.coords()[joint.axis]);
                v[joint.v] = velocity[joint.assembly];
            }
        }
        q[self.q.clone()].iter().chain(&v[self.v.clone()]).all(|x| x.abs() < BOUND)
    }

    /// Where a link's frame is in the world.
    pub(super) fn link_pose(&self, world: &World, link: usize) -> Pose {
        let (body, place) = self.links[link];
        *world.rapier.bodies[self.bodies[body]].position() * place
    }

    /// The kinetic energy and that in the field of gravity, joules; the latter is zero at the world's origin.
    pub(super) fn energy(&self, world: &World, gravity: Vector) -> f32 {
        let bodies = self.bodies.iter().map(|handle| {
            let body = &world.rapier.bodies[*handle];
            if !body.is_dynamic() {
                return 0.0;
            }
            let (linear, angular) = self.velocity(world, *handle);
            let inertia = body.mass_properties().effective_angular_inertia();
            let kinetic = body.mass() * linear.length_squared() + angular.dot(inertia * angular);
            kinetic / 2.0 - body.mass() * gravity.dot(body.center_of_mass())
        });
        let rotors = self.joints.iter().map(|joint| {
            let speed = self
                .multibody
                .map_or(0.0, |index| world.multibody(index).generalized_velocity()[joint.assembly]);
            joint.armature * speed * speed / 2.0
        });
        bodies.sum::<f32>() + rotors.sum::<f32>()
    }

    /// Momentum, and angular momentum about the world's origin. Rotors have none of either: an armature stands
    /// for something that turns with the joint, wherever it is.
    #[cfg(test)]
    pub(super) fn momenta(&self, world: &World) -> (Vector, Vector) {
        self.bodies.iter().fold((Vector::ZERO, Vector::ZERO), |(p, l), handle| {
            let body = &world.rapier.bodies[*handle];
            let (linear, angular) = self.velocity(world, *handle);
            let (own, inertia) = (linear * body.mass(), body.mass_properties().effective_angular_inertia());
            (p + own, l + body.center_of_mass().cross(own) + inertia * angular)
        })
    }

    /// Velocity of a body's centre of mass, and its angular velocity, both in the world's frame. Rapier's bodies
    /// have them too, but as they were in the last sub-step.
    fn velocity(&self, world: &World, body: RigidBodyHandle) -> (Vector, Vector) {
        let link = self.multibody.and(world.rapier.multibody_joints.rigid_body_link(body));
        match (self.multibody, link) {
            (Some(index), Some(link)) => {
                let multibody = world.multibody(index);
                let twist = multibody.body_jacobian(link.id) * multibody.generalized_velocity();
                (Vector::new(twist[0], twist[1], twist[2]), Vector::new(twist[3], twist[4], twist[5]))
            }
            _ => (world.rapier.bodies[body].linvel(), world.rapier.bodies[body].angvel()),
        }
    }

    /// Whether any solid may come to a wall in the next `seconds`: false is all but certain, true is not. None
    /// looks farther than `most`, nor less far than [`ALERT`].
    pub(super) fn near_walls(&self, world: &World, map: &CellMap, seconds: f32, most: f32) -> bool {
        self.solids(world).any(|(body, at, collider)| {
            let (middle, half) = extent(&at, collider);
            let size = half[0].max(half[1]) as f32;
            let speed = body.linvel().length() + body.angvel().length() * size;
            let reach = f64::from((speed * seconds + ALERT).min(most.max(ALERT)));
            map.may_meet_wall(middle, half.map(|half| half + reach))
        })
    }

    /// The solids that move, and where they are.
    fn solids<'a>(&self, world: &'a World) -> impl Iterator<Item = (&'a RigidBody, Pose, &'a Collider)> {
        let bodies =
            self.bodies.iter().map(|body| &world.rapier.bodies[*body]).filter(|body| body.is_dynamic());
        bodies.flat_map(move |body| {
            body.colliders().iter().map(move |handle| {
                let collider = &world.rapier.colliders[*handle];
                let place = collider.position_wrt_parent().copied().unwrap_or_default();
                (body, *body.position() * place, collider)
            })
        })
    }

    /// The solid that is deepest in a wall: how deep, metres (infinite when its middle is in a wall or outside the
    /// map), its link, and where it is. None when no solid touches a wall.
    pub(super) fn deepest(&self, world: &World, map: &CellMap) -> Option<(f32, usize, Vector)> {
        let walls = &world.rapier.colliders[world.walls?];
        let solids = self.solids(world);
        let depths = solids.filter_map(|(_, at, collider)| {
            let (middle, half) = extent(&at, collider);
            if !map.may_meet_wall(middle, half) {
                return None;
            }
            let depth = if map.is_wall(middle) {
                f32::INFINITY
            } else {
                -query::contact(&at, collider.shape(), walls.position(), walls.shape(), 0.0).ok()??.dist
            };
            let Party::Link { link, .. } = Party::of(collider.user_data) else { return None };
            Some((depth, link, at.translation))
        });
        depths.max_by(|a, b| a.0.total_cmp(&b.0))
    }
}

/// The middle of a solid on the floor, and how far it reaches from there along x and along y.
fn extent(at: &Pose, collider: &Collider) -> ([f64; 2], [f64; 2]) {
    let bounds = collider.shape().compute_aabb(at);
    let (middle, half) = (bounds.center(), bounds.half_extents());
    ([middle.x, middle.y].map(f64::from), [half.x, half.y].map(f64::from))
}
