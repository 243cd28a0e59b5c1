//! The ant of Gymnasium on a Rapier multibody: prints its state after some seconds, or its speed.
use rapier3d::prelude::*;
use std::time::{Duration, Instant};

struct Ant {
    world: PhysicsWorld,
    root: RigidBodyHandle,
    joints: Vec<MultibodyJointHandle>,
    random: u64,
}

impl Ant {
    fn new(substeps: usize) -> Self {
        let mut world = PhysicsWorld::default();
        world.gravity = Vector::new(0.0, 0.0, -9.81);
        let p = &mut world.integration_parameters;
        p.dt = 0.1;
        p.num_solver_iterations = substeps;
        p.normalized_prediction_distance = 0.2;
        let robot = InteractionGroups::new(Group::GROUP_2, Group::GROUP_1, InteractionTestMode::And);
        let ground = InteractionGroups::new(Group::GROUP_1, Group::GROUP_2, InteractionTestMode::And);
        world.insert_collider(
            ColliderBuilder::halfspace(rapier3d::na::Unit::new_unchecked(Vector::Z))
                .translation(Vector::new(0.0, 0.0, 0.0075))
                .friction(1.0)
                .collision_groups(ground),
            None,
        );
        let solid = |c: ColliderBuilder| c.density(5.0).friction(1.0).collision_groups(robot);
        let root = world.insert_body(
            RigidBodyBuilder::dynamic().translation(Vector::new(0.0, 0.0, 0.75)).can_sleep(false),
        );
        world.insert_collider(solid(ColliderBuilder::ball(0.25)), Some(root));
        let mut joints = Vec::new();
        let s = std::f32::consts::FRAC_1_SQRT_2;
        for (x, y, axis, sign) in [
            (1.0, 1.0, Vector::new(-s, s, 0.0), 1.0),
            (-1.0, 1.0, Vector::new(s, s, 0.0), -1.0),
            (-1.0, -1.0, Vector::new(-s, s, 0.0), -1.0),
            (1.0, -1.0, Vector::new(s, s, 0.0), 1.0),
        ] {
            let out = Vector::new(0.2 * x, 0.2 * y, 0.0);
            let capsule =
                |end: Vector| solid(ColliderBuilder::capsule_from_endpoints(Vector::ZERO, end, 0.08));
            world.insert_collider(capsule(out), Some(root));
            let at = Vector::new(0.0, 0.0, 0.75) + out;
            let thigh = world.insert_body(RigidBodyBuilder::dynamic().translation(at).can_sleep(false));
            world.insert_collider(capsule(out), Some(thigh));
            let foot = world.insert_body(RigidBodyBuilder::dynamic().translation(at + out).can_sleep(false));
            world.insert_collider(capsule(2.0 * out), Some(foot));
            let hip = RevoluteJointBuilder::new(Vector::Z)
                .local_anchor1(out)
                .limits([-0.5236, 0.5236])
                .contacts_enabled(false);
            joints.push(world.insert_multibody_joint(root, thigh, hip).unwrap());
            let range = if sign > 0.0 { [0.5236, 1.2217] } else { [-1.2217, -0.5236] };
            let ankle =
                RevoluteJointBuilder::new(axis).local_anchor1(out).limits(range).contacts_enabled(false);
            joints.push(world.insert_multibody_joint(thigh, foot, ankle).unwrap());
        }
        let (body, _) = world.multibody_joints.get_mut(joints[0]).unwrap();
        body.set_self_contacts_enabled(false);
        body.damping_mut().fill(0.0);
        body.damping_mut().rows_mut(6, 8).fill(1.0);
        body.armature_mut().rows_mut(6, 8).fill(1.0);
        Self { world, root, joints, random: 1 }
    }

    fn uniform(&mut self) -> f32 {
        self.random ^= self.random << 13;
        self.random ^= self.random >> 7;
        self.random ^= self.random << 17;
        (self.random >> 40) as f32 / (1u64 << 23) as f32 - 1.0
    }

    fn step(&mut self, amplitude: f32) {
        const STIFFNESS: f32 = 1e-3;
        for handle in self.joints.clone() {
            let torque = amplitude * self.uniform();
            let (body, id) = self.world.multibody_joints.get_mut(handle).unwrap();
            body.link_mut(id).unwrap().joint.set_spring(3, STIFFNESS, torque / STIFFNESS);
        }
        self.world.step();
    }

    fn state(&self) -> Vec<f32> {
        let mut out = vec![self.world.bodies[self.root].translation().z];
        for handle in &self.joints {
            let (body, id) = self.world.multibody_joints.get(*handle).unwrap();
            out.push(body.link(id).unwrap().joint().coords()[3]);
        }
        out
    }
}

fn main() {
    let argument: Vec<String> = std::env::args().collect();
    let substeps: usize = argument[2].parse().unwrap();
    match argument[1].as_str() {
        "state" => {
            let (steps, amplitude): (usize, f32) =
                (argument[3].parse().unwrap(), argument[4].parse().unwrap());
            let mut ant = Ant::new(substeps);
            for _ in 0..steps {
                ant.step(amplitude);
            }
            println!("{:?}", ant.state());
        }
        "once" => {
            // One step from each of many random states: generalised velocities and joint angles after it.
            let mut random = Ant::new(substeps);
            for _ in 0..argument[3].parse().unwrap() {
                let mut ant = Ant::new(substeps);
                let (body, _) = ant.world.multibody_joints.get_mut(ant.joints[0]).unwrap();
                let mut place = vec![0.0; 14];
                place[2] = 0.25 * random.uniform();
                for k in 0..3 {
                    place[3 + k] = 0.3 * random.uniform();
                }
                for k in 0..4 {
                    place[6 + 2 * k] = 0.5 * random.uniform();
                    place[7 + 2 * k] = [0.87, -0.87, -0.87, 0.87][k] + 0.3 * random.uniform();
                }
                body.apply_displacements(&place);
                for k in 0..14 {
                    body.generalized_velocity_mut()[k] = 3.0 * random.uniform();
                }
                let handle = ant.joints[0];
                let bodies = &mut ant.world.bodies;
                let (body, _) = ant.world.multibody_joints.get_mut(handle).unwrap();
                body.forward_kinematics(bodies, false);
                body.update_rigid_bodies(bodies, true);
                ant.step(30.0);
                let (body, _) = ant.world.multibody_joints.get(handle).unwrap();
                let v: Vec<f32> = body.generalized_velocity().iter().copied().collect();
                println!("{:?}", [v, ant.state()].concat());
            }
        }
        "speed" => {
            let length = Duration::from_secs_f64(argument[3].parse().unwrap());
            let mut ant = Ant::new(substeps);
            for _ in 0..20 {
                ant.step(0.0);
            }
            let (began, mut steps) = (Instant::now(), 0u32);
            while began.elapsed() < length {
                for _ in 0..50 {
                    ant.step(30.0);
                }
                steps += 50;
            }
            println!("{:.0}", f64::from(steps) / began.elapsed().as_secs_f64());
        }
        _ => unreachable!(),
    }
}
