//! Articulated bodies in mazes: the ant, or any other that walks freely.

use std::borrow::Cow;

use inroads_sim::{
    Shape, math,
    rigid::{
        Articulated, CellMap, Configuration, Joint, Model, Physics, Rectangle, Snapshot, StateError,
        Surroundings, Vector, ant,
    },
    view::{Solid, colour},
};
use rand::RngExt;
use rand_distr::StandardNormal;

use super::{Heading, Maze, MazeError, MazeTask, Robot};
use crate::{Dimension, Kind, Rng};

/// Greatest start noise of every position, metres, radians or parts of a quaternion, uniform (Gymnasium's and
/// D4RL's reset).
const POSITION_NOISE: f32 = 0.1;
/// Standard deviation of the start's velocities (same source).
const VELOCITY_NOISE: f32 = 0.1;
/// Usual greatest speeds, for scaling only: m/s and rad/s of the root, rad/s and m/s of joints.
const USUAL_SPEED: [f32; 3] = [2.0, 4.0, 8.0];

/// A body whose root moves freely.
///
/// It observes MuJoCo's `qpos` and `qvel`: the root's x, y, z and quaternion w, x, y, z, the joints'
/// positions, then the root's velocity (world's frame), its angular velocity (its own frame) and the joints'
/// velocities. Its actions are its actuators' controls in [-1, 1], 1 being an actuator's gear.
pub struct Body {
    sim: Articulated,
    /// As the model has it: joints at zero.
    zero: Configuration,
    /// What was last read while the simulation was sound.
    seen: Configuration,
    clearance: f64,
    map: Option<CellMap>,
}

impl Body {
    /// A body on a floor of this height (metres) among a map's walls.
    ///
    /// # Errors
    /// [`MazeError::Body`] when the model cannot be simulated or does not move freely, [`MazeError::Open`]
    /// when it could walk off the map.
    pub fn new(model: &Model, physics: Physics, floor: f32, map: &CellMap) -> Result<Self, MazeError> {
        if let Some([line, column]) = map.opening() {
            return Err(MazeError::Open { line, column });
        }
        Self::among(model, physics, floor, Some(map))
    }

    /// A body on a floor of this height (metres) without walls and without end.
    ///
    /// # Errors
    /// [`MazeError::Body`] when the model cannot be simulated or does not move freely.
    pub fn on_open_floor(model: &Model, physics: Physics, floor: f32) -> Result<Self, MazeError> {
        Self::among(model, physics, floor, None)
    }

    fn among(model: &Model, physics: Physics, floor: f32, map: Option<&CellMap>) -> Result<Self, MazeError> {
        if model.links.first().is_none_or(|root| root.joint != Joint::Free) {
            return Err(MazeError::Body(format!(
                "the root of model {:?} is fixed; give its first body a free joint, so that it can walk",
                model.name
            )));
        }
        if model.actuators.is_empty() {
            return Err(MazeError::Body(format!("model {:?} has no actuators; give it motors", model.name)));
        }
        let around = Surroundings { floor: Some(floor), walls: map };
        let sim = Articulated::new(std::slice::from_ref(model), around, physics)
            .map_err(|why| MazeError::Body(why.to_string()))?;
        let zero = sim.zero();
        let reach = sim.solids(|_, _| colour::TORSO).map(|solid| reach(&solid, &zero.q)).fold(0.0, f32::max);
        let clearance = f64::from(reach * (1.0 + POSITION_NOISE) + POSITION_NOISE);
        Ok(Self { seen: zero.clone(), zero, sim, clearance, map: map.cloned() })
    }

    /// Positions and velocities now.
    pub fn configuration(&self) -> &Configuration {
        &self.seen
    }

    /// Puts it into a state; what follows depends on nothing that came before.
    ///
    /// # Errors
    /// [`StateError`] when numbers are missing or not finite, or a link is in a wall.
    pub fn restore(&mut self, to: &Configuration) -> Result<(), StateError> {
        self.sim.restore(to)?;
        self.seen.clone_from(self.sim.configuration());
        Ok(())
    }

    fn model(&self) -> &Model {
        &self.sim.models()[0]
    }
}

/// How far a solid is from the root along x or y, metres, at most.
fn reach(solid: &Solid, root: &[f32]) -> f32 {
    let (points, radius) = match &solid.shape {
        Shape::Ball { radius } => (vec![Vector::ZERO], *radius),
        Shape::Capsule { from, to, radius } => (vec![*from, *to], *radius),
        // A ball about the corners, and about the rim.
        Shape::Cuboid { half } => (vec![Vector::ZERO], half.length()),
        Shape::Cylinder { half_height, radius } => (vec![Vector::ZERO], math::hypotf(*half_height, *radius)),
        Shape::Hull { points } => (points.clone(), 0.0),
    };
    let far = |point: Vector| {
        let at = solid.pose * point;
        (at.x - root[0]).abs().max((at.y - root[1]).abs())
    };
    points.into_iter().map(far).fold(0.0, f32::max) + radius
}

impl Robot for Body {
    type State = (Snapshot, Configuration);

    fn observation(&self, bounds: Rectangle) -> Vec<Dimension> {
        let place = |name, axis: usize| {
            Dimension::linear(name, "m", bounds.low[axis] as f32, bounds.high[axis] as f32)
        };
        let [linear, angular, joint] = USUAL_SPEED;
        let mut all =
            vec![place("x", 0), place("y", 1), Dimension::linear("z", "m", 0.0, 2.0 * self.zero.q[2])];
        all.extend(["qw", "qx", "qy", "qz"].map(|name| Dimension::linear(name, "", -1.0, 1.0)));
        let joints = || {
            self.model().links.iter().filter_map(|link| match &link.joint {
                Joint::Hinge(axis) => Some((&link.name, axis.range, "rad", "rad/s", std::f32::consts::PI)),
                Joint::Slide(axis) => Some((&link.name, axis.range, "m", "m/s", f32::INFINITY)),
                Joint::Fixed | Joint::Free => None,
            })
        };
        let named = |name: String, unit, [low, high]: [f32; 2]| Dimension {
            name: Cow::Owned(name),
            unit,
            low,
            high,
            kind: Kind::Linear,
        };
        all.extend(joints().map(|(name, range, unit, _, usual)| {
            named(name.clone(), unit, range.unwrap_or([-usual, usual]))
        }));
        all.extend(["vx", "vy", "vz"].map(|name| Dimension::linear(name, "m/s", -linear, linear)));
        all.extend(["wx", "wy", "wz"].map(|name| Dimension::linear(name, "rad/s", -angular, angular)));
        all.extend(
            joints().map(|(name, _, _, unit, _)| named(format!("{name} speed"), unit, [-joint, joint])),
        );
        all
    }

    fn action(&self) -> Vec<Dimension> {
        let links = &self.model().links;
        let control = |link: usize| Dimension {
            name: Cow::Owned(links[link].name.clone()),
            unit: "gear",
            low: -1.0,
            high: 1.0,
            kind: Kind::Linear,
        };
        self.model().actuators.iter().map(|actuator| control(actuator.link)).collect()
    }

    /// Its reach when its joints are at zero, with the start's noise.
    fn clearance(&self) -> f64 {
        self.clearance
    }

    fn begin(&mut self, [x, y]: [f64; 2], rng: Option<&mut Rng>) -> Result<(), String> {
        let mut start = self.zero.clone();
        (start.q[0], start.q[1]) = (x as f32, y as f32);
        if let Some(rng) = rng {
            let near = |rng: &mut Rng| rng.random_range(-POSITION_NOISE..POSITION_NOISE);
            start.q.iter_mut().for_each(|q| *q += near(rng));
            start.v.iter_mut().for_each(|v| *v += VELOCITY_NOISE * rng.sample::<f32, _>(StandardNormal));
        }
        self.restore(&start).map_err(|why| why.to_string())
    }

    fn act(&mut self, action: &[f32]) -> Result<(), String> {
        self.sim.step(action).map_err(|fault| fault.to_string())?;
        let now = self.sim.configuration();
        let at = [now.q[0], now.q[1]];
        if self.map.as_ref().is_some_and(|map| map.is_wall(at.map(f64::from))) {
            let [x, y] = at;
            return Err(format!(
                "model {:?} was driven through a wall at ({x}, {y}); weaken it",
                self.model().name
            ));
        }
        self.seen.clone_from(now);
        Ok(())
    }

    fn at(&self) -> [f32; 2] {
        [self.seen.q[0], self.seen.q[1]]
    }

    fn observe(&self, out: &mut Vec<f32>) {
        out.extend_from_slice(&self.seen.q);
        out.extend_from_slice(&self.seen.v);
    }

    fn heading(&self) -> Heading {
        Heading::Quaternion(3)
    }

    fn save(&self) -> Self::State {
        (self.sim.save(), self.seen.clone())
    }

    fn load(&mut self, (sim, seen): &Self::State) {
        self.sim.load(sim);
        self.seen.clone_from(seen);
    }

    fn draw(&self, out: &mut Vec<Solid>) {
        let links = &self.model().links;
        let paint = |_, link: usize| match link {
            0 => colour::TORSO,
            _ if links.iter().any(|other| other.parent == Some(link)) => colour::LEG,
            _ => colour::FOOT,
        };
        out.extend(self.sim.solids(paint));
    }
}

/// A body, the ant by default, in a maze.
pub type AntMaze = MazeTask<Body>;

impl AntMaze {
    /// Builds a maze for the thesis' ant: ten actions a second, 30 N m.
    ///
    /// # Errors
    /// [`MazeError`] says what is wrong with the description.
    pub fn new(maze: &Maze<'_>) -> Result<Self, MazeError> {
        Self::walked_by(maze, &ant::model(ant::THESIS.gear))
    }

    /// Builds a maze for another body, which starts at its model's place and moves as the ant does: ten
    /// actions a second. For other physics see [`MazeTask::with`] and [`Body::new`].
    ///
    /// # Errors
    /// [`MazeError`] says what is wrong with the description or the body.
    pub fn walked_by(maze: &Maze<'_>, model: &Model) -> Result<Self, MazeError> {
        Self::with(maze, |map| Body::new(model, ant::THESIS.physics, ant::THESIS.floor, map))
    }

    /// Positions and velocities now, which [`restore`](Self::restore) takes back.
    pub fn configuration(&self) -> &Configuration {
        self.robot().configuration()
    }

    /// Begins an episode in a given state instead of one that a seed names.
    ///
    /// # Errors
    /// [`StateError`] when numbers are missing or not finite, or a link is in a wall.
    pub fn restore(&mut self, to: &Configuration) -> Result<(), StateError> {
        self.place(|robot| robot.restore(to))
    }
}
