//! A Rapier world whose whole memory can be copied.

use rapier3d::prelude::*;

use super::Physics;

/// Rapier's world and the handle of its walls.
pub(super) struct World {
    pub(super) rapier: PhysicsWorld,
    pub(super) walls: Option<ColliderHandle>,
}

/// Everything in a world that outlives a step: bodies, joints, contacts, the solver's warm starts. The shapes
/// themselves are shared, not copied.
#[derive(Clone)]
pub(super) struct Sets {
    islands: IslandManager,
    broad_phase: BroadPhaseBvh,
    narrow_phase: NarrowPhase,
    bodies: RigidBodySet,
    colliders: ColliderSet,
    multibody_joints: MultibodyJointSet,
}

impl World {
    /// An empty world.
    pub(super) fn empty(physics: &Physics) -> Self {
        let mut rapier = PhysicsWorld::new();
        rapier.gravity = physics.gravity;
        let parameters = &mut rapier.integration_parameters;
        parameters.normalized_prediction_distance = physics.prediction;
        // Thick walls and a floor without end need no tunnelling checks.
        parameters.max_ccd_substeps = 0;
        // Old contacts are wrong by up to 5 cm: too much beside feet of 8 cm.
        parameters.contact_recycling = false;
        parameters.num_internal_stabilization_iterations = physics.relaxations as usize;
        Self { rapier, walls: None }
    }

    /// Makes what was inserted known to all of Rapier's parts, once instead of at every restore.
    pub(super) fn settle(&mut self) {
        self.rapier.detect_collisions(&(), &());
    }

    pub(super) fn step(&mut self, seconds: f32, substeps: u32) {
        self.rapier.integration_parameters.dt = seconds;
        self.rapier.integration_parameters.num_solver_iterations = substeps as usize;
        self.rapier.step();
    }

    pub(super) fn quarantined(&self) -> bool {
        !self.rapier.quarantine().is_empty()
    }

    pub(super) fn sets(&self) -> Sets {
        Sets {
            islands: self.rapier.islands.clone(),
            broad_phase: self.rapier.broad_phase.clone(),
            narrow_phase: self.rapier.narrow_phase.clone(),
            bodies: self.rapier.bodies.clone(),
            colliders: self.rapier.colliders.clone(),
            multibody_joints: self.rapier.multibody_joints.clone(),
        }
    }

    pub(super) fn set(&mut self, to: &Sets) {
        self.rapier.islands.clone_from(&to.islands);
        self.rapier.broad_phase.clone_from(&to.broad_phase);
        self.rapier.narrow_phase.clone_from(&to.narrow_phase);
        self.rapier.bodies.clone_from(&to.bodies);
        self.rapier.colliders.clone_from(&to.colliders);
        self.rapier.multibody_joints.clone_from(&to.multibody_joints);
    }

    /// The multibody with this index; all indices come from this world.
    pub(super) fn multibody(&self, index: MultibodyIndex) -> &Multibody {
        self.rapier.multibody_joints.get_multibody(index).expect("no multibody is ever removed")
    }
}
