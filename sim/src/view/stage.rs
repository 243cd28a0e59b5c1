//! What a ray of light tells: the nearest surface, its paint, the sun and the sky.

use rapier3d::math::Vector;

use super::{
    Camera, Scene,
    bins::Bins,
    body::{Body, ON_FLOOR},
    colour::{Light, light},
    floor::Floor,
    lens::{Lens, Ray},
    sun::Sun,
};

/// What lies beyond everything.
pub(super) const BEYOND: Light = light([225, 230, 238]);
/// The sun's light on a surface that faces it.
const SUN: Light = Light::new(0.80, 0.77, 0.70);
/// The light of the sky from above, and of the floor from below.
const AMBIENT: [Light; 2] = [Light::new(0.40, 0.43, 0.48), Light::new(0.22, 0.21, 0.20)];
/// How bright highlights are.
const GLOSS: f32 = 0.10;
/// The cell of the grid by which bodies are found, pixels.
const CELL: f32 = 8.0;
/// From where to where the floor fades away, in distances of the camera from its focus.
const FADE: [f32; 2] = [1.3, 3.2];
/// Surfaces nearer together than this share of their distance are one: that of the earlier body.
const TIE: f32 = 1e-4;
/// Through so many walls the focus is seen.
const WALLS: usize = 4;
/// How clear walls are there.
const GLASS: f32 = 0.8;
/// How far about the focus: from where to where it fades, in distances of the camera.
const HOLE: [f32; 2] = [0.17, 0.27];
/// So far in front of the focus walls are as clear as they get, in distances of the camera; behind it they are not.
const AHEAD: f32 = 0.1;
/// A focus no farther from a wall than this counts as in it, in distances of the camera.
const IN_WALL: f32 = 0.01;

/// A scene before a camera, ready to be looked at.
pub(super) struct Stage<'a> {
    bodies: Vec<Body>,
    bins: Bins,
    floor: Floor<'a>,
    sun: Sun,
    lens: Lens,
    /// Where a camera in perspective looks, and from what distance.
    focus: Option<(Vector, f32)>,
    /// The same, unless it lies in a wall: then walls may hide it.
    sought: Option<(Vector, f32)>,
}

impl<'a> Stage<'a> {
    /// For a frame of that width and height; nothing if the camera sees nothing.
    pub(super) fn new(scene: &'a Scene, camera: &Camera, size: [u32; 2]) -> Option<Self> {
        let bodies: Vec<_> = scene.solids.iter().filter_map(Body::new).collect();
        let balls = bodies.iter().flat_map(Body::balls);
        let top = balls.fold(0.0_f32, |top, (centre, radius)| top.max(centre.z + radius));
        let lens = Lens::new(camera, size, top + 1.0)?;
        let focus = match *camera {
            Camera::Above { .. } => None,
            Camera::Beside { focus, distance, .. } => Some((focus, distance)),
        };
        let in_wall = |focus, slack| bodies.iter().any(|body| body.block && body.holds(focus, slack));
        let sought = focus.filter(|&(focus, distance)| !in_wall(focus, distance * IN_WALL));
        let shorter = size[0].min(size[1]) as f32;
        let across = shorter * lens.scale * focus.map_or(1.0, |(_, distance)| distance);
        let size = size.map(|x| x as f32);
        let bins = lens.bins(size, CELL, &bodies);
        let floor = Floor::new(scene, &lens, size, across);
        Some(Self { bins, floor, sun: Sun::new(&bodies, &lens), lens, focus, sought, bodies })
    }

    /// The light that comes from a place in the frame, pixels.
    pub(super) fn look(&self, x: f32, y: f32) -> Light {
        let ray = self.lens.ray(x, y);
        let bodies = self.bins.at(x, y);
        let Some((body, t)) = self.nearest(bodies, &ray, self.lens.near.unwrap_or(0.0)) else {
            return self.ground(&ray, [x, y]);
        };
        let seen = self.surface(&ray, body, t);
        let behind = if self.bodies[body].block { self.glimpse(bodies, &ray, [x, y], t) } else { None };
        behind.map_or(seen, |(behind, share)| seen.lerp(behind, share * GLASS))
    }

    /// The light from behind a wall at `t`, and how much of it is to be seen: up to 1 if it comes from about the
    /// focus and the wall is in front of it.
    fn glimpse(&self, bodies: &[u32], ray: &Ray, place: [f32; 2], t: f32) -> Option<(Light, f32)> {
        let (focus, distance) = self.sought?;
        let ahead = smooth(0.0, AHEAD, ((focus - ray.origin).dot(ray.direction) - t) / distance);
        if ahead <= 0.0 {
            return None;
        }
        let mut hit = self.nearest(bodies, ray, t);
        for _ in 1..WALLS {
            let wall = hit.filter(|&(body, _)| self.bodies[body].block);
            let Some((_, t)) = wall else { break };
            hit = self.nearest(bodies, ray, t);
        }
        let at = ray.at(hit.map_or(-ray.origin.z / ray.direction.z, |(_, t)| t));
        let wall = |&body: &u32| {
            let body = &self.bodies[body as usize];
            body.block && body.holds(at, ON_FLOOR)
        };
        // Under a wall there is no floor.
        let floor = ray.direction.z < 0.0 && !bodies.iter().any(wall);
        let about = 1.0 - smooth(HOLE[0], HOLE[1], (at - focus).length() / distance);
        if about <= 0.0 || hit.is_none() && !floor {
            return None;
        }
        let light = hit.map_or_else(|| self.ground(ray, place), |(body, t)| self.surface(ray, body, t));
        Some((light, ahead * about))
    }

    /// The first body that the ray enters beyond a distance, and where.
    fn nearest(&self, bodies: &[u32], ray: &Ray, beyond: f32) -> Option<(usize, f32)> {
        // The floor hides what is below it.
        let below = if ray.direction.z < 0.0 { -ray.origin.z / ray.direction.z } else { f32::INFINITY };
        let (mut best, mut nearest) = (None, below);
        for &body in bodies {
            let t = self.bodies[body as usize].enter(ray);
            if t > beyond && t < nearest - nearest.min(t) * TIE {
                (best, nearest) = (Some(body as usize), t);
            }
        }
        best.map(|body| (body, nearest))
    }

    fn surface(&self, ray: &Ray, body: usize, t: f32) -> Light {
        let at = ray.at(t);
        let normal = self.bodies[body].normal(at);
        let lit = self.lit(at, normal, Some(body));
        let sky = AMBIENT[1].lerp(AMBIENT[0], 0.5 + 0.5 * normal.z);
        let mut seen = self.bodies[body].light * (sky + SUN * lit);
        if lit > 0.0 && !self.bodies[body].block {
            let half_way = (self.sun.towards - ray.direction).normalize_or_zero();
            // To the 24th power (Blinn 1977), by products: those are the same on every machine.
            let cosine = normal.dot(half_way).max(0.0);
            let eighth = (0..3).fold(cosine, |power, _| power * power);
            seen += SUN * (GLOSS * eighth * eighth * eighth);
        }
        seen.lerp(BEYOND, self.veil(at))
    }

    /// The floor, or what is beyond it.
    fn ground(&self, ray: &Ray, place: [f32; 2]) -> Light {
        let t = -ray.origin.z / ray.direction.z;
        if !(ray.direction.z < 0.0 && t > 0.0) {
            return BEYOND;
        }
        let at = ray.at(t);
        let veil = self.veil(at);
        if veil >= 1.0 {
            return BEYOND;
        }
        let paint = self.floor.paint(&self.lens, ray, at, place);
        (paint * (AMBIENT[0] + SUN * self.lit(at, Vector::Z, None))).lerp(BEYOND, veil)
    }

    /// The share of the sun's light that a surface receives.
    fn lit(&self, at: Vector, normal: Vector, but: Option<usize>) -> f32 {
        let cosine = normal.dot(self.sun.towards);
        if cosine <= 0.0 || self.sun.shadowed(&self.bodies, at, but) { 0.0 } else { cosine }
    }

    /// How much of a point is lost in the distance.
    fn veil(&self, at: Vector) -> f32 {
        self.focus.map_or(0.0, |(focus, distance)| {
            let (x, y) = (at.x - focus.x, at.y - focus.y);
            smooth(FADE[0], FADE[1], (x * x + y * y).sqrt() / distance)
        })
    }
}

/// From 0 at `from` smoothly to 1 at `to`.
fn smooth(from: f32, to: f32, x: f32) -> f32 {
    let share = ((x - from) / (to - from)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Shape,
        rigid::{Pose, Rectangle, Rotation},
        view::Solid,
    };

    /// Solids of all shapes about the origin.
    fn heap(seed: u32) -> Scene {
        let mut state = seed;
        let mut random = |low: f32, high: f32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            low + (high - low) * (state >> 8) as f32 / (1 << 24) as f32
        };
        let mut solids = Vec::new();
        for index in 0..25 {
            let mut vector = |size: f32| Vector::from([(); 3].map(|()| random(-size, size)));
            let (at, axis, end, half) = (vector(5.0), vector(1.0), vector(2.0), vector(1.5).abs() + 0.05);
            let points = (0..12).map(|_| vector(0.8)).collect();
            let shape = match index % 5 {
                0 => Shape::Ball { radius: half.x },
                1 => Shape::Capsule { from: -end, to: end, radius: 0.2 * half.x },
                2 => Shape::Cuboid { half },
                3 => Shape::Cylinder { half_height: half.x, radius: half.y },
                _ => Shape::Hull { points },
            };
            let turn = Rotation::from_axis_angle(axis.normalize(), random(0.0, 3.0));
            let pose = Pose::from_parts(at + Vector::Z * 4.0, turn);
            solids.push(Solid { shape, pose, colour: [9 * index, 0, 0] });
        }
        Scene {
            solids,
            marks: vec![],
            trail: vec![],
            bounds: Rectangle { low: [-4.0, -3.0], high: [4.0, 3.0] },
            focus: Vector::new(0.0, 0.0, 4.0),
            // Some solids reach behind the camera.
            distance: 4.0,
        }
    }

    #[test]
    fn cells_miss_nothing() {
        let all: Vec<u32> = (0..25).collect();
        let (mut hits, mut shadows) = (0, 0);
        for seed in 0..8 {
            let scene = heap(seed);
            for camera in [Camera::above(scene.bounds), Camera::watching(&scene)] {
                let stage = Stage::new(&scene, &camera, [90, 70]).unwrap();
                assert_eq!(stage.bodies.len(), 25);
                for (x, y) in (0..90 * 70).map(|at| ((at % 90) as f32 + 0.3, (at / 90) as f32 + 0.6)) {
                    let ray = stage.lens.ray(x, y);
                    let hit = stage.nearest(&all, &ray, 0.1);
                    assert_eq!(stage.nearest(stage.bins.at(x, y), &ray, 0.1), hit, "{x}, {y}: {seed}");
                    let Some((body, t)) = hit else { continue };
                    let (at, normal) = (ray.at(t), stage.bodies[body].normal(ray.at(t)));
                    assert!((normal.length() - 1.0).abs() < 1e-2 && normal.dot(ray.direction) < 1e-2);
                    let sunwards = Ray { origin: at, direction: stage.sun.towards };
                    let enters = |other: usize| stage.bodies[other].enter(&sunwards);
                    let shadowed =
                        (0..25).any(|other| other != body && (1e-4..f32::INFINITY).contains(&enters(other)));
                    assert_eq!(
                        stage.sun.shadowed(&stage.bodies, at, Some(body)),
                        shadowed,
                        "{x}, {y}: {seed}"
                    );
                    hits += 1;
                    shadows += usize::from(shadowed);
                }
            }
        }
        assert!(hits > 20_000 && shadows > 5_000, "{hits} {shadows}");
    }

    #[test]
    fn rays_enter_bodies_on_their_surface() {
        let scene = heap(3);
        let stage = Stage::new(&scene, &Camera::watching(&scene), [90, 70]).unwrap();
        for (x, y) in (0..90 * 70).map(|at| ((at % 90) as f32, (at / 90) as f32)) {
            let ray = stage.lens.ray(x, y);
            let Some((body, t)) = stage.nearest(stage.bins.at(x, y), &ray, 0.1) else { continue };
            let shaken = stage.bodies[body].grown(1e-3);
            assert!(shaken.enter(&ray) < t && shaken.enter(&ray) > t - 0.5);
        }
    }
}
