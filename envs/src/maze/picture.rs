//! Mazes for people: seen from above as flat figures, and as scenes.

use inroads_sim::{
    Shape,
    rigid::{CellMap, Pose, Rectangle, Vector},
    view::{Mark, Scene, Solid, colour},
};

use super::{Heading, ground::Ground, task::HAS_KEY};

/// How far a camera stands off, metres.
const DISTANCE: f32 = 8.0;
/// Height of walls in pictures, metres. In the physics nothing comes over them, here people look over them.
const WALL_HEIGHT: f32 = 0.8;
/// Radius of the mark where a key lies, metres; it is drawn smaller than its reach.
const KEY_RADIUS: f32 = 0.35;
/// Radius of a key that is carried, and how high above the floor it is, metres.
const CARRIED: [f32; 2] = [0.15, 1.25];

/// A maze seen from above, for figures. Agents never see one.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// The walls, which do not overlap. Metres, as all here.
    pub walls: Vec<Rectangle>,
    /// The least rectangle that holds all free space.
    pub bounds: Rectangle,
    /// Where episodes start, but for noise.
    pub starts: Vec<[f64; 2]>,
    /// The goal.
    pub goal: [f64; 2],
    /// Greatest distance from the goal that counts as there.
    pub tolerance: f64,
    /// Where a key lies.
    pub key: Option<[f64; 2]>,
    pub(super) heading: Heading,
    pub(super) resting: Vec<f32>,
}

impl Picture {
    pub(super) fn new(ground: &Ground, goal: [f64; 2], heading: Heading, resting: Vec<f32>) -> Self {
        Self {
            walls: ground.map.walls(),
            bounds: ground.map.bounds(),
            starts: ground.places.clone(),
            goal,
            tolerance: ground.tolerance,
            key: ground.key,
            heading,
            resting,
        }
    }

    /// What an agent would see that stands still at a point and faces along x.
    pub fn observation_at(&self, at: [f64; 2]) -> Vec<f32> {
        let mut seen = self.resting.clone();
        seen[..2].copy_from_slice(&at.map(|x| x as f32));
        seen
    }

    /// The same with the key in its possession; none where there is no key.
    pub fn holding_at(&self, at: [f64; 2]) -> Option<Vec<f32>> {
        self.key?;
        let mut seen = self.observation_at(at);
        seen[HAS_KEY] = 1.0;
        Some(seen)
    }

    /// Which way the robot looks: radians from the x axis towards the y axis, NaN when it looks nowhere.
    pub fn heading(&self, observation: &[f32]) -> f32 {
        self.heading.of(observation)
    }
}

/// The walls of a map as boxes on the floor.
pub fn walls(map: &CellMap) -> impl Iterator<Item = Solid> {
    let middle = WALL_HEIGHT / 2.0;
    map.walls().into_iter().map(move |wall| {
        let along = |axis: usize, sign: f64| ((wall.high[axis] + sign * wall.low[axis]) / 2.0) as f32;
        Solid {
            shape: Shape::Cuboid { half: Vector::new(along(0, -1.0), along(1, -1.0), middle) },
            pose: Pose::from_translation(Vector::new(along(0, 1.0), along(1, 1.0), middle)),
            colour: colour::WALL,
        }
    })
}

/// The scene of a maze without its robot, which stands at `at` and may carry the key.
pub(super) fn scene(ground: &Ground, goal: [f32; 2], at: [f32; 2], held: bool) -> Scene {
    let mut solids: Vec<_> = walls(&ground.map).collect();
    let mut marks = vec![Mark { at: goal, radius: ground.tolerance as f32, colour: colour::GOAL }];
    if let Some(key) = ground.key {
        let [radius, height] = CARRIED;
        let pose = Pose::from_translation(Vector::new(at[0], at[1], height));
        match held {
            true => solids.push(Solid { shape: Shape::Ball { radius }, pose, colour: colour::KEY }),
            false => marks.push(Mark { at: key.map(|x| x as f32), radius: KEY_RADIUS, colour: colour::KEY }),
        }
    }
    Scene {
        solids,
        marks,
        trail: Vec::new(),
        bounds: ground.map.bounds(),
        focus: Vector::new(at[0], at[1], 0.5),
        distance: DISTANCE,
    }
}
