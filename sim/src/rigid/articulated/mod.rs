//! Articulated bodies on Rapier's multibodies: joints are coordinates, so they never drift apart.
//!
//! What Rapier calls a step is here a *call*: contacts are found once, then the solver makes several sub-steps.
//! Actions are generalised forces exactly on the joints. Positions and velocities are read and set in MuJoCo's
//! order and frames ([`Configuration`]), and what follows a [`restore`](Articulated::restore) or a
//! [`load`](Articulated::load) depends on nothing that came before.

mod build;
mod check;
mod contacts;
mod error;
mod limits;
mod physics;
mod state;
mod tree;
mod world;

use rapier3d::math::Pose;

pub(in crate::rigid) use build::solid;
pub use contacts::{Contact, Party};
pub use error::{ModelError, PhysicsFault, StateError};
pub use physics::{Limits, Physics, Surroundings};
pub use state::Configuration;

use self::{limits::Call, state::WALL_TOLERANCE, tree::Tree, world::World};
use crate::{
    rigid::{CellMap, Model},
    view::{Colour, Solid},
};

/// Near walls contacts are looked for after each sub-step, and so often at least, seconds: MuJoCo's time step in the
/// thesis' mazes. Of a million random steps of the ant ten leave a leg deeper than 2 cm in a wall; fifty at 33 ms, one
/// or two at 11 ms, which takes 1.6 times as long.
const NEAR_WALLS: f32 = 0.02;

/// Models in a world of their own.
pub struct Articulated {
    models: Vec<Model>,
    trees: Vec<Tree>,
    physics: Physics,
    walls: Option<CellMap>,
    world: World,
    /// What [`Articulated::restore`] starts from: nothing has touched, nothing moves.
    template: world::Sets,
    configuration: Configuration,
    /// Generalised forces of the step under way, in the order of the velocities.
    forces: Vec<f32>,
    /// The configuration before the call under way.
    before: Configuration,
    /// Which joints, in the order of the velocities, were set to beyond their range and are not back yet.
    returning: Vec<bool>,
    /// Whether those that are returning have yet to be thrown.
    unthrown: bool,
}

/// All that the future of an [`Articulated`] depends on, the solver's memory included.
#[derive(Clone)]
pub struct Snapshot {
    sets: Box<world::Sets>,
    configuration: Configuration,
    returning: Vec<bool>,
    unthrown: bool,
}

impl Articulated {
    /// Puts models into a world, all joints at zero and free roots at their places, at rest.
    ///
    /// # Errors
    /// [`ModelError`] names the link and the mend.
    pub fn new(models: &[Model], around: Surroundings<'_>, physics: Physics) -> Result<Self, ModelError> {
        let (trees, world) = build::build(models, around, &physics)?;
        let template = world.sets();
        let zero = state::zero(models, &trees);
        let forces = vec![0.0; zero.v.len()];
        let mut made = Self {
            models: models.to_vec(),
            trees,
            physics,
            walls: around.walls.cloned(),
            world,
            template,
            configuration: zero.clone(),
            before: zero.clone(),
            returning: vec![false; zero.v.len()],
            unthrown: false,
            forces,
        };
        made.take_up(&zero);
        Ok(made)
    }

    /// The models, in the order in which states and controls hold theirs.
    pub fn models(&self) -> &[Model] {
        &self.models
    }

    /// How time passes.
    pub fn physics(&self) -> &Physics {
        &self.physics
    }

    /// Actuators of all models: how many controls [`step`](Self::step) takes.
    pub fn actuators(&self) -> usize {
        self.models.iter().map(|model| model.actuators.len()).sum()
    }

    /// All joints at zero, free roots at their places, at rest.
    pub fn zero(&self) -> Configuration {
        state::zero(&self.models, &self.trees)
    }

    /// Positions and velocities now.
    pub fn configuration(&self) -> &Configuration {
        &self.configuration
    }

    /// Takes up a state with fresh caches: what follows depends on it and on nothing that came before.
    ///
    /// Quaternions are brought to length 1. Joints may be outside their ranges; what becomes of them is said at
    /// [`Physics`].
    ///
    /// # Errors
    /// [`StateError`] when numbers are too few, too many or not finite, or a body would be deeper in a wall than
    /// 2 cm; nothing has changed then.
    pub fn restore(&mut self, to: &Configuration) -> Result<(), StateError> {
        let to = to.admit(&self.trees)?;
        let before = self.walls.is_some().then(|| self.save());
        self.take_up(&to);
        match (self.in_wall(), before) {
            (Some(fault), Some(before)) => {
                self.load(&before);
                Err(fault)
            }
            _ => Ok(()),
        }
    }

    /// One control step. Controls stand in the order of the models' actuators; beyond [-1, 1] they count as the
    /// nearest of the two, as in MuJoCo.
    ///
    /// # Errors
    /// [`PhysicsFault`]: the wrong number of controls, one that is not finite, or a simulation that broke down.
    pub fn step(&mut self, controls: &[f32]) -> Result<(), PhysicsFault> {
        admit("controls", "control", controls, self.actuators())?;
        self.forces.fill(0.0);
        let drives = self.trees.iter().flat_map(|tree| &tree.drives);
        for (&(v, gear), control) in drives.zip(controls) {
            self.forces[v] += gear * control.clamp(-1.0, 1.0);
        }
        let (calls, seconds, substeps) = (self.physics.calls, self.physics.call(), self.physics.substeps);
        for _ in 0..calls {
            // Where a leg comes round a corner in one call, the contact that was found before misses the wall.
            let often = substeps.max((seconds / NEAR_WALLS).round() as u32);
            let (parts, substeps) = if self.near_walls(seconds) { (often, 1) } else { (1, substeps) };
            (0..parts).try_for_each(|_| self.call(seconds / parts as f32, substeps))?;
        }
        Ok(())
    }

    /// One Rapier call of `seconds` with a generalised force on every degree of freedom, in the order of the
    /// velocities: N and N m; for free roots a force in the world's frame that acts at the root's origin and a
    /// torque in the root's frame, as MuJoCo's `qfrc_applied`. For controllers that compute forces themselves.
    ///
    /// # Errors
    /// [`PhysicsFault`]: the wrong number of forces, one that is not finite, or a simulation that broke down.
    pub fn advance(&mut self, forces: &[f32], seconds: f32, substeps: u32) -> Result<(), PhysicsFault> {
        admit("forces", "force", forces, self.forces.len())?;
        if !(seconds > 0.0 && seconds.is_finite()) {
            return Err(PhysicsFault::NotFinite { what: "seconds", index: 0, value: seconds });
        }
        self.forces.copy_from_slice(forces);
        self.call(seconds, substeps.max(1))
    }

    /// Everything that the future depends on.
    pub fn save(&self) -> Snapshot {
        Snapshot {
            sets: Box::new(self.world.sets()),
            configuration: self.configuration.clone(),
            returning: self.returning.clone(),
            unthrown: self.unthrown,
        }
    }

    /// Goes back to what was saved, to the bit, warm starts and contacts included. The snapshot must be of this
    /// world or of one made from the same models, surroundings and physics.
    pub fn load(&mut self, saved: &Snapshot) {
        self.world.set(&saved.sets);
        self.configuration.clone_from(&saved.configuration);
        self.returning.clone_from(&saved.returning);
        self.unthrown = saved.unthrown;
    }

    /// Where a link's frame is in the world.
    ///
    /// # Panics
    /// When there is no such model or link.
    pub fn link_pose(&self, model: usize, link: usize) -> Pose {
        self.trees[model].link_pose(&self.world, link)
    }

    /// What touches what, as the last call left it.
    pub fn contacts(&self) -> impl Iterator<Item = Contact> + '_ {
        contacts::contacts(&self.world)
    }

    /// All solids of all models where they are now, coloured by model and link.
    pub fn solids(&self, colour: impl Fn(usize, usize) -> Colour) -> impl Iterator<Item = Solid> {
        self.models.iter().enumerate().flat_map(move |(m, model)| {
            let colour = &colour;
            let parts = model.links.iter().enumerate().flat_map(move |(l, link)| {
                let (place, colour) = (self.link_pose(m, l), colour(m, l));
                link.solids.iter().map(move |part| Solid {
                    shape: part.shape.clone(),
                    pose: place * part.pose,
                    colour,
                })
            });
            parts.collect::<Vec<_>>()
        })
    }

    /// How deep the deepest solid is in a wall, metres: 0 when none touches one, infinite when the middle of one
    /// is in a wall or outside the map.
    pub fn depth_in_walls(&self) -> f32 {
        let Some(map) = &self.walls else { return 0.0 };
        let depths = self.trees.iter().filter_map(|tree| Some(tree.deepest(&self.world, map)?.0));
        depths.fold(0.0, f32::max)
    }

    /// The kinetic energy and that in the field of gravity, joules; the latter is zero at the world's origin.
    pub fn energy(&self) -> f32 {
        self.trees.iter().map(|tree| tree.energy(&self.world, self.physics.gravity)).sum()
    }

    /// One Rapier call under the forces that are set, and what springy limits add to it.
    fn call(&mut self, seconds: f32, substeps: u32) -> Result<(), PhysicsFault> {
        for tree in &self.trees {
            tree.push(&mut self.world, &self.forces);
        }
        let Limits::Springy { time_constant } = self.physics.limits else {
            self.world.step(seconds, substeps);
            return self.read();
        };
        if !std::mem::take(&mut self.unthrown) {
            return self.springy(seconds, substeps, time_constant);
        }
        // The throw is an impulse, given as a force in a short call of its own.
        let short = (time_constant / 2.0).min(seconds / 2.0);
        let forces = self.forces.clone();
        for joint in self.trees.iter().flat_map(|tree| &tree.joints) {
            self.forces[joint.v] += joint.impulse(&self.configuration, time_constant) / short;
        }
        for tree in &self.trees {
            tree.push(&mut self.world, &self.forces);
        }
        let thrown = self.springy(short, 1, time_constant);
        self.forces = forces;
        thrown?;
        self.call(seconds - short, substeps)
    }

    /// One Rapier call between springy limits, under the forces that were pushed.
    fn springy(&mut self, seconds: f32, substeps: u32, time_constant: f32) -> Result<(), PhysicsFault> {
        self.before.clone_from(&self.configuration);
        let (before, forces, returning) = (&self.before, &self.forces, &self.returning);
        let call = Call { before, forces, seconds, substeps, time_constant, returning };
        for tree in &self.trees {
            tree.meet_limits(&mut self.world, &call);
        }
        self.world.step(seconds, substeps);
        self.read()?;
        let (before, forces, returning) = (&self.before, &self.forces, &self.returning);
        let call = Call { before, forces, seconds, substeps, time_constant, returning };
        for tree in &self.trees {
            tree.rebound(&mut self.world, &call, &mut self.configuration);
        }
        if self.returning.contains(&true) {
            self.note_returning();
        }
        Ok(())
    }

    /// Notes which of the joints that were set to beyond their range are still there.
    fn note_returning(&mut self) {
        for joint in self.trees.iter().flat_map(|tree| &tree.joints) {
            self.returning[joint.v] &= joint.beyond(&self.configuration);
        }
    }

    /// Reads the configuration, and notices when the simulation broke down.
    fn read(&mut self) -> Result<(), PhysicsFault> {
        let quarantined = self.world.quarantined();
        for (tree, model) in self.trees.iter().zip(&self.models) {
            let diverged = |why| PhysicsFault::Diverged { model: model.name.clone(), why };
            if quarantined {
                return Err(diverged("Rapier put a body into quarantine"));
            }
            if !tree.read(&self.world, &mut self.configuration) {
                return Err(diverged("a number is not finite or beyond a million"));
            }
        }
        Ok(())
    }

    /// Takes up an admissible state.
    fn take_up(&mut self, to: &Configuration) {
        self.world.set(&self.template);
        for tree in &self.trees {
            tree.write(&mut self.world, to);
        }
        self.configuration.clone_from(to);
        self.returning.fill(matches!(self.physics.limits, Limits::Springy { .. }));
        self.note_returning();
        self.unthrown = self.returning.contains(&true);
    }

    /// Whether a solid may meet a wall in the coming call.
    fn near_walls(&self, seconds: f32) -> bool {
        let most = self.physics.prediction;
        let near = |map| self.trees.iter().any(|tree| tree.near_walls(&self.world, map, seconds, most));
        self.walls.as_ref().is_some_and(near)
    }

    /// Which link is in a wall, if one is.
    fn in_wall(&self) -> Option<StateError> {
        let map = self.walls.as_ref()?;
        self.trees.iter().zip(&self.models).find_map(|(tree, model)| {
            let (depth, link, at) = tree.deepest(&self.world, map)?;
            (depth > WALL_TOLERANCE).then(|| StateError::InWall {
                model: model.name.clone(),
                link: model.links[link].name.clone(),
                depth,
                x: at.x,
                y: at.y,
            })
        })
    }
}

/// Whether numbers are as many as expected and finite.
fn admit(all: &'static str, one: &'static str, given: &[f32], expected: usize) -> Result<(), PhysicsFault> {
    if given.len() != expected {
        return Err(PhysicsFault::Length { what: all, given: given.len(), expected });
    }
    match given.iter().position(|x| !x.is_finite()) {
        Some(index) => Err(PhysicsFault::NotFinite { what: one, index, value: given[index] }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod refusals;
#[cfg(test)]
mod tests;
