//! From models to Rapier's bodies, colliders and joints.

use rapier3d::{math::Pose, prelude::*};

use super::{
    ModelError, Physics, Surroundings,
    check::check,
    contacts::Party,
    tree::{Coordinate, Tree},
    world::World,
};
use crate::{
    Shape,
    rigid::{Axis, Joint, Link, Mass, Model, Part, walls},
};

/// Friction of floor and walls: the floor of MuJoCo's ant. The greater of two solids' counts.
const FRICTION: f32 = 1.0;
/// Half the height of walls, metres: nothing that is some steps tall climbs over.
const WALL: f32 = 5.0;
/// The group of floor and walls; model i has the one i + 1 places higher.
const STAGE: u32 = 1;

/// A world with these models in it, and how to read each of them.
pub(super) fn build(
    models: &[Model],
    around: Surroundings<'_>,
    physics: &Physics,
) -> Result<(Vec<Tree>, World), ModelError> {
    if let Some(what) = physics.wrong() {
        return Err(ModelError::Physics(what));
    }
    if models.len() > 31 {
        return Err(ModelError::Physics("at most 31 models fit into one world"));
    }
    let mut world = World::empty(physics);
    stage(&mut world, around);
    let (mut trees, mut q, mut v) = (Vec::new(), 0, 0);
    for (index, model) in models.iter().enumerate() {
        check(model)?;
        let tree = Builder { model, index, q, v }.insert(&mut world)?;
        (q, v) = (tree.q.end, tree.v.end);
        trees.push(tree);
    }
    world.settle();
    for (tree, model) in trees.iter_mut().zip(models) {
        equip(tree, model, &mut world);
    }
    Ok((trees, world))
}

/// Floor and walls.
fn stage(world: &mut World, around: Surroundings<'_>) {
    let groups = groups(STAGE);
    if let Some(height) = around.floor {
        let floor = ColliderBuilder::new(SharedShape::halfspace(Vector::Z))
            .translation(Vector::Z * height)
            .friction(FRICTION)
            .friction_combine_rule(CoefficientCombineRule::Max)
            .collision_groups(groups)
            .user_data(Party::Floor.tag());
        world.rapier.insert_collider(floor, None);
    }
    if let Some(walls) = around.walls.and_then(|map| walls::collider(map, 0.0, WALL)) {
        let walls = walls
            .friction(FRICTION)
            .friction_combine_rule(CoefficientCombineRule::Max)
            .collision_groups(groups)
            .user_data(Party::Walls.tag());
        world.walls = Some(world.rapier.insert_collider(walls, None));
    }
}

/// What is in a group touches everything that is not in it.
fn groups(own: u32) -> InteractionGroups {
    let own = Group::from_bits_truncate(own);
    InteractionGroups::new(own, !own, InteractionTestMode::And)
}

/// One model on its way into the world.
struct Builder<'a> {
    model: &'a Model,
    index: usize,
    /// Positions and velocities of the models before it.
    q: usize,
    v: usize,
}

impl Builder<'_> {
    fn insert(&self, world: &mut World) -> Result<Tree, ModelError> {
        let (mut links, masses) = self.weld();
        let root = &self.model.links[0];
        let free = root.joint == Joint::Free;
        let fixed = root.joint == Joint::Fixed;
        // Rapier turns a free root about its frame's origin but moves its centre of mass: right only when the
        // two are one point. So the body's frame is the link's, moved to the centre of mass.
        let shift = if free { masses[0].local_com } else { Vector::ZERO };
        for (_, place) in links.iter_mut().filter(|(body, _)| *body == 0) {
            place.translation -= shift;
        }
        let bodies: Vec<_> = masses
            .iter()
            .enumerate()
            .map(|(body, mass)| {
                let mass = if body == 0 { mass.transform_by(&Pose::from_translation(-shift)) } else { *mass };
                let builder =
                    if body == 0 && fixed { RigidBodyBuilder::fixed() } else { RigidBodyBuilder::dynamic() };
                // A body at rest would fall asleep and heed no torque; one that may not turn fast would lose
                // angular momentum.
                let builder =
                    builder.can_sleep(false).allow_fast_rotation(true).additional_mass_properties(mass);
                let place = if body == 0 { root.place * links[0].1.inverse() } else { Pose::IDENTITY };
                world.rapier.insert_body(builder.pose(place))
            })
            .collect();
        self.dress(world, &bodies, &links)?;
        let joints = self.join(world, &bodies, &links);
        let multibody = bodies
            .iter()
            .find_map(|body| world.rapier.multibody_joints.rigid_body_link(*body).map(|link| link.multibody));
        let root = if free { (7, 6) } else { (0, 0) };
        let (q, v) = (self.q + root.0 + joints.len(), self.v + root.1 + joints.len());
        let velocity = |link| joints.iter().find(|(of, _)| *of == link).map(|(_, joint)| joint.v);
        let drives = &self.model.actuators;
        let drives = drives.iter().filter_map(|drive| Some((velocity(drive.link)?, drive.gear))).collect();
        let joints = joints.into_iter().map(|(_, joint)| joint).collect();
        Ok(Tree { free, q: self.q..q, v: self.v..v, bodies, links, multibody, joints, drives })
    }

    /// Which links make one body: of each link its body and its frame in the body's, which is that of the
    /// body's first link; of each body its mass.
    fn weld(&self) -> (Vec<(usize, Pose)>, Vec<MassProperties>) {
        let (mut links, mut masses) = (Vec::<(usize, Pose)>::new(), Vec::new());
        for link in &self.model.links {
            let place = match (link.parent, &link.joint) {
                (Some(parent), Joint::Fixed) => (links[parent].0, links[parent].1 * link.place),
                _ => {
                    masses.push(MassProperties::default());
                    (masses.len() - 1, Pose::IDENTITY)
                }
            };
            masses[place.0] += mass(link).transform_by(&place.1);
            links.push(place);
        }
        (links, masses)
    }

    /// Puts the solids on the bodies.
    fn dress(
        &self,
        world: &mut World,
        bodies: &[RigidBodyHandle],
        links: &[(usize, Pose)],
    ) -> Result<(), ModelError> {
        for (index, (link, (body, place))) in self.model.links.iter().zip(links).enumerate() {
            for part in link.solids.iter().filter(|part| part.solid) {
                let (shape, own) = solid(&part.shape).ok_or_else(|| ModelError::Link {
                    model: self.model.name.clone(),
                    link: link.name.clone(),
                    what: "a hull's points lie in a plane; give at least four that do not",
                })?;
                let collider = ColliderBuilder::new(shape)
                    .position(*place * part.pose * own)
                    .density(0.0)
                    .friction(part.friction)
                    .friction_combine_rule(CoefficientCombineRule::Max)
                    .collision_groups(groups(STAGE << (self.index + 1)))
                    .user_data(Party::Link { model: self.index, link: index }.tag());
                world.rapier.insert_collider(collider, Some(bodies[*body]));
            }
        }
        Ok(())
    }

    /// Joins the bodies; of each joint its link in the model, and where its coordinate is. Their multibody is
    /// not complete before the last: [`equip`] fills in what depends on it.
    fn join(
        &self,
        world: &mut World,
        bodies: &[RigidBodyHandle],
        links: &[(usize, Pose)],
    ) -> Vec<(usize, Coordinate)> {
        let mut joints = Vec::new();
        let first = if self.model.links[0].joint == Joint::Free {
            (self.q + 7, self.v + 6)
        } else {
            (self.q, self.v)
        };
        for (index, (link, (body, _))) in self.model.links.iter().zip(links).enumerate() {
            let (axis, mask, slot) = match &link.joint {
                Joint::Hinge(axis) => (axis, JointAxesMask::LOCKED_REVOLUTE_AXES, 3),
                Joint::Slide(axis) => (axis, JointAxesMask::LOCKED_PRISMATIC_AXES, 0),
                Joint::Fixed | Joint::Free => continue,
            };
            let (parent, parent_frame) = match link.parent {
                Some(parent) => (bodies[links[parent].0], links[parent].1),
                // A root that turns or slides does so against something that does not.
                None => (world.rapier.insert_body(RigidBodyBuilder::fixed()), Pose::IDENTITY),
            };
            let frame = Pose::from_parts(axis.anchor, Rotation::from_rotation_arc(Vector::X, axis.axis));
            let mut joint = GenericJointBuilder::new(mask)
                .local_frame1(parent_frame * link.place * frame)
                .local_frame2(frame)
                .contacts_enabled(false);
            if let Some(range) = axis.range {
                joint = joint.limits(if slot == 0 { JointAxis::LinX } else { JointAxis::AngX }, range);
            }
            world.rapier.insert_multibody_joint(parent, bodies[*body], joint.build());
            let (q, v) = (first.0 + joints.len(), first.1 + joints.len());
            let (range, armature, inertia) = (axis.range, axis.armature, 0.0);
            joints.push((
                index,
                Coordinate { link: *body, axis: slot, assembly: 0, q, v, range, armature, inertia },
            ));
        }
        joints
    }
}

/// Gives a complete multibody its damping, rotor inertia and dry friction. Rapier's own default, some damping
/// on every angle, would brake even a free root.
fn equip(tree: &mut Tree, model: &Model, world: &mut World) {
    let Some(index) = tree.multibody else { return };
    let rapier = &mut world.rapier;
    let Some(multibody) = rapier.multibody_joints.get_multibody_mut(index) else { return };
    multibody.set_self_contacts_enabled(false);
    // Only now does Rapier see that a root is fixed and has no coordinates.
    multibody.forward_kinematics(&rapier.bodies, true);
    multibody.damping_mut().fill(0.0);
    multibody.armature_mut().fill(0.0);
    let axes = model.links.iter().filter_map(|link| axis(&link.joint));
    for (joint, axis) in tree.joints.iter_mut().zip(axes) {
        joint.link +=
            usize::from(model.links[0].joint != Joint::Free && model.links[0].joint != Joint::Fixed);
        joint.assembly = multibody.link(joint.link).map_or(0, MultibodyLink::assembly_id);
        multibody.damping_mut()[joint.assembly] = axis.damping;
        multibody.armature_mut()[joint.assembly] = axis.armature;
        multibody.frictions_mut()[joint.assembly] = axis.friction;
    }
    multibody.update_rigid_bodies(&mut rapier.bodies, true);
    let inverse = multibody.dof_inverse_inertia(&rapier.bodies);
    for joint in &mut tree.joints {
        joint.inertia = 1.0 / inverse[joint.assembly];
    }
}

/// The axis of a joint that has one.
pub(super) fn axis(joint: &Joint) -> Option<&Axis> {
    match joint {
        Joint::Hinge(axis) | Joint::Slide(axis) => Some(axis),
        Joint::Fixed | Joint::Free => None,
    }
}

/// The mass of a link in its frame.
pub(super) fn mass(link: &Link) -> MassProperties {
    match &link.mass {
        Some(Mass { mass, place, inertia }) => {
            MassProperties::with_principal_inertia_frame(place.translation, *mass, *inertia, place.rotation)
        }
        None => link.solids.iter().map(part_mass).fold(MassProperties::default(), |sum, part| sum + part),
    }
}

fn part_mass(part: &Part) -> MassProperties {
    solid(&part.shape).map_or_else(MassProperties::default, |(shape, own)| {
        shape.mass_properties(part.density).transform_by(&(part.pose * own))
    })
}

/// A shape for Rapier, and where it lies in ours: Rapier's cylinders stand along y. None when a hull is flat.
pub(in crate::rigid) fn solid(shape: &Shape) -> Option<(SharedShape, Pose)> {
    let shape = match shape {
        Shape::Ball { radius } => SharedShape::ball(*radius),
        Shape::Capsule { from, to, radius } => SharedShape::capsule(*from, *to, *radius),
        Shape::Cuboid { half } => SharedShape::cuboid(half.x, half.y, half.z),
        Shape::Cylinder { half_height, radius } => {
            let upright = Rotation::from_rotation_arc(Vector::Y, Vector::Z);
            return Some((SharedShape::cylinder(*half_height, *radius), Pose::from_rotation(upright)));
        }
        Shape::Hull { points } => SharedShape::convex_hull(points)?,
    };
    Some((shape, Pose::IDENTITY))
}
