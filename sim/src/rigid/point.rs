//! The point robot of rllab's mazes: it is displaced by its actions and pushed back by walls.
//!
//! An action turns the robot and moves its centre outright; then one physics step integrates the velocity that
//! it has from its start or from contacts. A centre that would end in a wall, or pass through one on the way
//! (our addition), goes back to where it was, and only the turn remains. The rule is rllab's `PointEnv` and
//! `MazeEnv` with manual collision; Rapier takes MuJoCo's place.

use rapier3d::prelude::*;

use super::arena::{Arena, DT};
use super::{CellMap, walls};
use crate::{
    Shape, math,
    view::{Colour, Solid},
};

/// Greatest displacement of one action, metres, forwards or backwards.
pub const MAX_FORWARD: f64 = 1.0;
/// Greatest turn of one action, radians, left or right.
pub const MAX_TURN: f64 = 0.25;
/// No step ends with the centre faster than this, metres a second. Random play stays below 0.8 (MuJoCo's
/// stiffer contacts kick it to 12), so the bound guards against restored states and rare corners only.
pub const MAX_SPEED: f64 = 2.0;
/// No step ends with a faster spin than this, radians a second. Random play stays below 3.6 (MuJoCo: 19).
pub const MAX_SPIN: f64 = 5.0;

/// Share of its velocity that floor friction leaves the centre in one step. MuJoCo's contact with the floor
/// comes and goes, so that single steps keep 0.5 to 1.0; over the first ten, drifting robots keep 0.75 a step.
/// Spin is not damped: a ball has no grip on the floor there.
const KEPT: f64 = 0.75;

/// Radius of the ball, and its height above the floor, metres.
const RADIUS: f32 = 0.5;
/// Half sizes of the nose, metres.
const NOSE: Vector = Vector::new(0.5, 0.1, 0.1);
/// How far ahead of the centre the nose's middle lies, metres.
const NOSE_AHEAD: f32 = 0.6;
/// Density of ball and nose, kg/m³.
const DENSITY: f32 = 100.0;
/// Rapier looks for contacts less far ahead of the robot's surface than this, metres.
const LOOKOUT: f64 = 0.1;

/// Everything that the robot's future depends on, besides the map and the actions.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct PointState {
    /// Position of the ball's centre, metres.
    pub x: f64,
    /// Position of the ball's centre, metres.
    pub y: f64,
    /// Heading, radians, not wrapped.
    pub theta: f64,
    /// Velocity of the centre, metres a second.
    pub vx: f64,
    /// Velocity of the centre, metres a second.
    pub vy: f64,
    /// Spin, radians a second.
    pub omega: f64,
}

impl PointState {
    fn at(&self) -> [f64; 2] {
        [self.x, self.y]
    }

    fn is_finite(&self) -> bool {
        [self.x, self.y, self.theta, self.vx, self.vy, self.omega].iter().all(|x| x.is_finite())
    }
}

/// What happened in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Motion {
    /// The centre was put back because it had come into a wall, or through one.
    pub blocked: bool,
    /// Points at which walls pushed the robot during the step.
    pub contacts: usize,
}

impl Motion {
    /// Whether the robot met a wall in any way.
    pub fn touched(&self) -> bool {
        self.blocked || self.contacts > 0
    }
}

/// What a point robot does not carry out. Its state is as it was before.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PointError {
    /// The state to restore has a component that is not finite, or its centre is in a wall.
    #[error("the point robot cannot stand at {0:?}: its centre must be in free space and all numbers finite")]
    Misplaced(PointState),
    /// The action is outside its range.
    #[error("the point robot cannot move by {forward} m (at most ±1) and {turn} rad (at most ±0.25)")]
    Action {
        /// Displacement, metres.
        forward: f64,
        /// Turn, radians.
        turn: f64,
    },
    /// Rapier put the body into quarantine, or returned numbers that are not finite: a fault of the simulation.
    #[error("the physics of the point robot diverged at {0:?}; please report this state and the map")]
    Diverged(PointState),
}

/// The robot in its maze.
pub struct PointRobot {
    map: CellMap,
    arena: Arena,
    body: RigidBodyHandle,
    state: PointState,
    /// Whether Rapier may be spared where no wall is near. Only a test says no.
    shortcut: bool,
}

impl PointRobot {
    /// Radius of its ball, metres.
    pub const RADIUS: f32 = RADIUS;

    /// A robot at rest at the map's first start.
    pub fn new(map: CellMap) -> Self {
        let mut world = Arena::empty();
        if let Some(walls) = walls::collider(&map, RADIUS, map.scale() as f32) {
            world.insert_collider(walls, None);
        }
        let body = world.insert_body(
            RigidBodyBuilder::dynamic()
                .translation(Vector::new(0.0, 0.0, RADIUS))
                .enabled_translations(true, true, false)
                .enabled_rotations(false, false, true)
                .can_sleep(false),
        );
        let ball = ColliderBuilder::ball(RADIUS);
        let nose = ColliderBuilder::cuboid(NOSE.x, NOSE.y, NOSE.z).translation(Vector::X * NOSE_AHEAD);
        for part in [ball, nose] {
            world.insert_collider(part.density(DENSITY).friction(1.0), Some(body));
        }
        Self { map, arena: Arena::new(world), body, state: PointState::default(), shortcut: true }
    }

    /// The maze.
    pub fn map(&self) -> &CellMap {
        &self.map
    }

    /// Where the robot is and how it moves. [`restore`](Self::restore) takes it back, bit for bit.
    pub fn state(&self) -> PointState {
        self.state
    }

    /// Puts the robot into a state.
    ///
    /// # Errors
    /// [`PointError::Misplaced`] when the centre is in a wall or a number is not finite.
    pub fn restore(&mut self, state: PointState) -> Result<(), PointError> {
        if !state.is_finite() || self.map.is_wall(state.at()) {
            return Err(PointError::Misplaced(state));
        }
        self.state = state;
        Ok(())
    }

    /// What it looks like, in the colours of its ball and its nose.
    pub fn solids(&self, [ball, nose]: [Colour; 2]) -> [Solid; 2] {
        let PointState { x, y, theta, .. } = self.state;
        let turn = Rotation::from_rotation_z(theta.rem_euclid(std::f64::consts::TAU) as f32);
        let pose = Pose::from_parts(Vector::new(x as f32, y as f32, RADIUS), turn);
        let ahead = pose * Pose::from_translation(Vector::X * NOSE_AHEAD);
        [
            Solid { shape: Shape::Ball { radius: RADIUS }, pose, colour: ball },
            Solid { shape: Shape::Cuboid { half: NOSE }, pose: ahead, colour: nose },
        ]
    }

    /// Turns by `turn` radians, then moves by `forward` metres, then lets 0.02 s pass.
    ///
    /// # Errors
    /// [`PointError::Action`] when a number exceeds [`MAX_FORWARD`] or [`MAX_TURN`] or is not one;
    /// [`PointError::Diverged`] when the physics failed.
    pub fn step(&mut self, forward: f64, turn: f64) -> Result<Motion, PointError> {
        // Written so that NaN is refused.
        if !(forward.abs() <= MAX_FORWARD && turn.abs() <= MAX_TURN) {
            return Err(PointError::Action { forward, turn });
        }
        let old = self.state;
        let theta = old.theta + turn;
        let pushed = PointState {
            x: old.x + math::cos(theta) * forward,
            y: old.y + math::sin(theta) * forward,
            theta,
            vx: old.vx * KEPT,
            vy: old.vy * KEPT,
            omega: old.omega,
        };
        let (mut new, contacts) = self.let_time_pass(pushed)?;
        let blocked = self.map.crosses_wall(old.at(), new.at());
        if blocked {
            [new.x, new.y] = old.at();
        }
        self.state = slowed(new);
        Ok(Motion { blocked, contacts })
    }

    /// One physics step. In free flight it is integrated here, in double precision; Rapier, whose numbers are
    /// single, has a say only where there is a contact. So leaving Rapier out where no wall is within reach
    /// changes no bit.
    fn let_time_pass(&mut self, from: PointState) -> Result<(PointState, usize), PointError> {
        let dt = f64::from(DT);
        let drifted = PointState {
            x: from.x + from.vx * dt,
            y: from.y + from.vy * dt,
            theta: from.theta + from.omega * dt,
            ..from
        };
        if self.shortcut && !self.may_touch_wall(&from) {
            return Ok((drifted, 0));
        }
        match self.collide(from)? {
            (_, 0) => Ok((drifted, 0)),
            contact => Ok(contact),
        }
    }

    /// Whether a wall may lie so near ball or nose that Rapier finds a contact: false is certain, true is not.
    fn may_touch_wall(&self, from: &PointState) -> bool {
        let ball = f64::from(RADIUS) + LOOKOUT;
        if self.map.may_touch_wall(from.at(), ball) {
            return true;
        }
        let (sin, cos) = (math::sin(from.theta), math::cos(from.theta));
        let [ahead, long, wide] = [NOSE_AHEAD, NOSE.x, NOSE.y].map(f64::from);
        let middle = [from.x + cos * ahead, from.y + sin * ahead];
        let (cos, sin) = (cos.abs(), sin.abs());
        self.map.may_meet_wall(middle, [cos * long + sin * wide + LOOKOUT, sin * long + cos * wide + LOOKOUT])
    }

    /// One physics step by Rapier, and the number of contact points in it.
    fn collide(&mut self, from: PointState) -> Result<(PointState, usize), PointError> {
        let world = self.arena.rewound();
        let body = &mut world.bodies[self.body];
        let heading = from.theta.rem_euclid(std::f64::consts::TAU) as f32;
        let placed =
            Pose::new(Vector::new(from.x as f32, from.y as f32, RADIUS), AngVector::new(0.0, 0.0, heading));
        body.set_position(placed, true);
        // Rapier's linear velocity is that of the centre of mass, which lies a little ahead of the centre.
        let ahead = placed.rotation * body.local_center_of_mass();
        let omega = from.omega as f32;
        body.set_linvel(
            Vector::new(from.vx as f32, from.vy as f32, 0.0) + Vector::Z.cross(ahead) * omega,
            true,
        );
        body.set_angvel(Vector::Z * omega, true);
        world.step();

        let body = &world.bodies[self.body];
        // Only differences are taken from Rapier: absolute ones would lose digits, and turns.
        let moved = body.translation() - placed.translation;
        let turned = placed.rotation.inverse() * *body.rotation();
        let velocity = body.velocity_at_point(body.translation());
        let to = PointState {
            x: from.x + f64::from(moved.x),
            y: from.y + f64::from(moved.y),
            theta: from.theta + 2.0 * math::atan2(f64::from(turned.z), f64::from(turned.w)),
            vx: f64::from(velocity.x),
            vy: f64::from(velocity.y),
            omega: f64::from(body.angvel().z),
        };
        if !world.quarantine().is_empty() || !to.is_finite() {
            return Err(PointError::Diverged(from));
        }
        let contacts = world
            .contact_pairs()
            .flat_map(|pair| pair.solver_manifolds())
            .map(|manifold| manifold.data.num_active_contacts())
            .sum();
        Ok((to, contacts))
    }
}

/// Enforces [`MAX_SPEED`] and [`MAX_SPIN`].
fn slowed(state: PointState) -> PointState {
    let speed = math::hypot(state.vx, state.vy);
    let share = if speed > MAX_SPEED { MAX_SPEED / speed } else { 1.0 };
    PointState {
        vx: state.vx * share,
        vy: state.vy * share,
        omega: state.omega.clamp(-MAX_SPIN, MAX_SPIN),
        ..state
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const U_MAZE: &str = "#####\n#r..#\n###.#\n#g..#\n#####";

    fn robot() -> PointRobot {
        PointRobot::new(CellMap::parse(U_MAZE, 4.0).unwrap())
    }

    /// Numbers in [-1, 1] from a seed (Knuth's linear congruence).
    fn numbers(mut seed: u64) -> impl FnMut() -> f64 {
        move || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        }
    }

    fn bits(state: PointState) -> [u64; 6] {
        [state.x, state.y, state.theta, state.vx, state.vy, state.omega].map(f64::to_bits)
    }

    fn speed(state: PointState) -> f64 {
        state.vx.hypot(state.vy)
    }

    #[test]
    fn at_rest_and_clear_of_walls_motion_is_the_action_and_nothing_else() {
        let mut robot = robot();
        let motion = robot.step(-0.5, 0.25).unwrap();
        let expected = PointState {
            x: -0.5 * 0.25_f64.cos(),
            y: -0.5 * 0.25_f64.sin(),
            theta: 0.25,
            ..Default::default()
        };
        assert_eq!((robot.state(), motion), (expected, Motion::default()));
        for _ in 0..40 {
            robot.step(0.0, 0.25).unwrap();
        }
        assert_eq!(robot.state().theta, 10.25, "the heading is not wrapped");
    }

    #[test]
    fn walls_push_back_what_enters_them_and_block_the_centre() {
        let mut robot = robot();
        // The nose ends 1.1 m ahead, the wall begins at x = -2.
        robot.restore(PointState { theta: std::f64::consts::PI, ..Default::default() }).unwrap();
        let motion = robot.step(1.0, 0.0).unwrap();
        assert!(!motion.blocked && motion.contacts > 0 && motion.touched());
        assert!(robot.state().x > -1.0, "pushed back from -1 to {}", robot.state().x);
        let before = robot.state();
        robot.step(1.0, 0.0).unwrap();
        let motion = robot.step(1.0, 0.1).unwrap();
        assert!(motion.blocked && robot.state().theta > before.theta);
    }

    #[test]
    fn nothing_tunnels_through_thin_walls() {
        let mut robot = PointRobot::new(CellMap::parse("#######\n#r.#..#\n#######", 0.9).unwrap());
        for _ in 0..100 {
            robot.step(1.0, 0.0).unwrap();
            assert!(robot.state().x < 1.35);
        }
    }

    #[test]
    fn leaving_rapier_out_where_no_wall_is_near_changes_no_bit() {
        let (mut short, mut long) = (robot(), robot());
        long.shortcut = false;
        let mut number = numbers(1);
        let mut spared = 0;
        for _ in 0..20_000 {
            let (forward, turn) = (number(), 0.25 * number());
            spared += usize::from(!short.may_touch_wall(&short.state()));
            assert_eq!(short.step(forward, turn), long.step(forward, turn));
            assert_eq!(bits(short.state()), bits(long.state()));
        }
        assert!(spared > 1_000, "the shortcut was taken {spared} times");
    }

    #[test]
    fn rapier_agrees_with_our_integration_of_free_flight() {
        let mut robot = robot();
        let from = PointState { x: 8.0, y: 4.0, theta: 9.0, vx: 1.5, vy: -0.5, omega: 2.0 };
        let (rapier, contacts) = robot.collide(from).unwrap();
        let (ours, _) = robot.let_time_pass(from).unwrap();
        assert_eq!(contacts, 0);
        // They differ by the centre of mass that swings about the centre: 4 cm, 2 rad/s, 0.02 s.
        assert!((rapier.x - ours.x).abs() < 1e-4 && (rapier.y - ours.y).abs() < 1e-4, "{rapier:?} {ours:?}");
        assert!((rapier.theta - ours.theta).abs() < 1e-5 && (rapier.vx - ours.vx).abs() < 5e-3);
    }

    #[test]
    fn what_follows_a_restored_state_does_not_depend_on_what_came_before() {
        let (mut first, mut second) = (robot(), robot());
        let mut number = numbers(2);
        for _ in 0..500 {
            first.step(number(), 0.25 * number()).unwrap();
        }
        let saved = first.state();
        // The second robot comes to the same state by another way: from a different place, out of contacts.
        for _ in 0..77 {
            second.step(1.0, 0.03).unwrap();
        }
        second.restore(saved).unwrap();
        for _ in 0..2_000 {
            let (forward, turn) = (number(), 0.25 * number());
            assert_eq!(first.step(forward, turn), second.step(forward, turn));
            assert_eq!(bits(first.state()), bits(second.state()));
        }
    }

    #[test]
    fn a_hundred_thousand_random_steps_stay_in_free_space_at_bounded_speed() {
        let mut robot = robot();
        let mut number = numbers(3);
        let (mut fastest, mut spin, mut contacts) = (0.0_f64, 0.0_f64, 0);
        for step in 0..100_000 {
            if step % 500 == 0 {
                let noise =
                    PointState { vx: 0.3 * number(), vy: 0.3 * number(), omega: number(), ..robot.state() };
                robot.restore(noise).unwrap();
            }
            contacts += usize::from(robot.step(number(), 0.25 * number()).unwrap().touched());
            let state = robot.state();
            assert!(!robot.map().is_wall(state.at()), "{state:?}");
            fastest = fastest.max(speed(state));
            spin = spin.max(state.omega.abs());
        }
        assert!(contacts > 10_000, "walls were met {contacts} times");
        assert!(fastest < MAX_SPEED && spin < MAX_SPIN, "the bounds had to be enforced");
    }

    #[test]
    fn full_speed_into_every_wall_at_all_headings() {
        let mut robot = robot();
        let cells: Vec<_> = robot.map().free_cells().collect();
        for [x, y] in cells {
            for heading in 0..72 {
                for forward in [1.0, -1.0] {
                    let theta = f64::from(heading) * std::f64::consts::TAU / 72.0;
                    let (vx, vy) = (MAX_SPEED * theta.cos(), MAX_SPEED * theta.sin());
                    robot.restore(PointState { x, y, theta, vx, vy, omega: 0.0 }).unwrap();
                    for _ in 0..12 {
                        robot.step(forward, 0.0).unwrap();
                        let state = robot.state();
                        assert!(!robot.map().is_wall(state.at()) && speed(state) <= MAX_SPEED * 1.000_001);
                    }
                }
            }
        }
    }

    #[test]
    fn what_cannot_be_is_refused_and_changes_nothing() {
        let mut robot = robot();
        robot.step(0.3, 0.1).unwrap();
        let before = robot.state();
        for (forward, turn) in
            [(f64::NAN, 0.0), (0.0, f64::NAN), (1.01, 0.0), (0.0, -0.26), (f64::INFINITY, 0.0)]
        {
            assert!(matches!(robot.step(forward, turn), Err(PointError::Action { .. })));
        }
        for wrong in [PointState { y: 2.0, ..before }, PointState { omega: f64::NAN, ..before }] {
            assert!(matches!(robot.restore(wrong), Err(PointError::Misplaced(_))));
        }
        assert_eq!(robot.state(), before);
    }
}
