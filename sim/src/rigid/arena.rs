//! A Rapier world that starts every step from the same template.

use rapier3d::prelude::*;

/// Time that one step of a robot takes, seconds (rllab's point model).
pub(super) const DT: f32 = 0.02;

/// A world and the state it is rewound to.
///
/// Rapier keeps impulses and contacts from step to step to start its solver warm, and no call forgets them.
/// Copying the template's sets does, which makes what follows a function of what the caller sets and of
/// nothing that came before. The shapes themselves are shared, not copied.
pub(super) struct Arena {
    template: PhysicsWorld,
    live: PhysicsWorld,
}

impl Arena {
    /// An empty world: z up, no tunnelling checks (robots do their own), no reuse of old contacts.
    ///
    /// One sub-step with ten passes that take the velocity of the push-out away again: with Rapier's defaults,
    /// four and one, a robot displaced into a wall leaves it at up to 9 m/s and 20 rad/s; so, it stays below
    /// 0.8 and 3.6 over 10^5 random steps, in two thirds of the time.
    pub(super) fn empty() -> PhysicsWorld {
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::new(0.0, 0.0, -9.81);
        world.integration_parameters.dt = DT;
        world.integration_parameters.num_solver_iterations = 1;
        world.integration_parameters.num_internal_stabilization_iterations = 10;
        world.integration_parameters.max_ccd_substeps = 0;
        world.integration_parameters.contact_recycling = false;
        world
    }

    /// Takes a world as the template.
    pub(super) fn new(mut template: PhysicsWorld) -> Self {
        // Builds the search tree over the walls once instead of once a step.
        template.detect_collisions(&(), &());
        let mut live = PhysicsWorld::new();
        live.gravity = template.gravity;
        live.integration_parameters = template.integration_parameters;
        Self { template, live }
    }

    /// The world as the template has it.
    pub(super) fn rewound(&mut self) -> &mut PhysicsWorld {
        self.live.islands.clone_from(&self.template.islands);
        self.live.broad_phase.clone_from(&self.template.broad_phase);
        self.live.narrow_phase.clone_from(&self.template.narrow_phase);
        self.live.bodies.clone_from(&self.template.bodies);
        self.live.colliders.clone_from(&self.template.colliders);
        &mut self.live
    }
}
