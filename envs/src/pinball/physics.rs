//! How a ball moves: the peers' rules, operation by operation, in double precision.
//!
//! Nothing is added up or compared in another order than theirs, so states agree to the last digits that sines and
//! arctangents leave in doubt. What is quicker here is only which edges are looked at ([`Board::near`]).

use std::f64::consts::{PI, TAU};

use inroads_sim::math::{atan2, cos, sin};
use serde::{Deserialize, Serialize};

use super::board::{Board, Edge, nearest};

/// Where a ball is, in sides of the board, and how fast: a velocity of 1 carries it its own radius a decision.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ball {
    /// To the right, 0 to 1.
    pub x: f64,
    /// Down in pictures, 0 to 1.
    pub y: f64,
    /// Velocity to the right, −2 to 2.
    pub xdot: f64,
    /// Velocity downwards, −2 to 2.
    pub ydot: f64,
}

/// Parts of a decision, each with its own motion and contacts.
pub const SUBSTEPS: u32 = 20;
/// What a push adds to a velocity.
const PUSH: f64 = 1.0 / 5.0;
/// Greatest velocity an axis.
pub(super) const FASTEST: f64 = 2.0;
/// What is left of a velocity after a decision.
const DRAG: f64 = 0.995;
/// Where a ball that has left the board is put back to, and the same from the other side.
const BACK: [f64; 2] = [0.05, 0.95];
/// Greatest angle between a velocity and an edge that is being hit: a little more than a right angle, so that a ball
/// that slides along an edge hits it.
const LEAVING: f64 = PI / 1.99;

impl Ball {
    /// A ball at rest.
    pub fn at([x, y]: [f64; 2]) -> Self {
        Self { x, y, xdot: 0.0, ydot: 0.0 }
    }

    /// Its centre.
    pub fn centre(&self) -> [f64; 2] {
        [self.x, self.y]
    }

    /// Its speed.
    pub fn speed(&self) -> f64 {
        (self.xdot * self.xdot + self.ydot * self.ydot).sqrt()
    }

    fn roll(&mut self, radius: f64) {
        self.x += self.xdot * radius / f64::from(SUBSTEPS);
        self.y += self.ydot * radius / f64::from(SUBSTEPS);
    }
}

/// What a ball ran into at a moment.
enum Contact {
    Nothing,
    /// One obstacle, which sends it off with this velocity.
    One([f64; 2]),
    /// Several: it goes back where it came from.
    Several,
}

impl Board {
    /// A decision: a push along a unit vector (or none), then twenty times motion and contacts. Whether the ball has
    /// come to the target; it then stays as it is.
    pub(super) fn decide(&self, ball: &mut Ball, push: [f64; 2]) -> bool {
        ball.xdot = (ball.xdot + push[0] * PUSH).clamp(-FASTEST, FASTEST);
        ball.ydot = (ball.ydot + push[1] * PUSH).clamp(-FASTEST, FASTEST);
        for substep in 1..=SUBSTEPS {
            ball.roll(self.radius);
            match self.contact(ball, self.near(ball.centre())) {
                Contact::Nothing => {}
                Contact::One([xdot, ydot]) => {
                    (ball.xdot, ball.ydot) = (xdot, ydot);
                    if substep == SUBSTEPS {
                        ball.roll(self.radius);
                    }
                }
                Contact::Several => (ball.xdot, ball.ydot) = (-ball.xdot, -ball.ydot),
            }
            let [dx, dy] = [ball.x - self.target[0], ball.y - self.target[1]];
            if (dx * dx + dy * dy).sqrt() < self.reach {
                return true;
            }
        }
        (ball.xdot, ball.ydot) = (ball.xdot * DRAG, ball.ydot * DRAG);
        (ball.x, ball.y) = (returned(ball.x), returned(ball.y));
        false
    }

    /// What the ball touches among some edges, which are in order.
    fn contact(&self, ball: &Ball, edges: &[u32]) -> Contact {
        let mut contact = Contact::Nothing;
        let mut rest = edges.iter().map(|&edge| &self.edges[edge as usize]).peekable();
        while let Some(first) = rest.peek() {
            let obstacle = first.obstacle;
            let own = std::iter::from_fn(|| rest.next_if(|edge| edge.obstacle == obstacle));
            if !self.extents[obstacle as usize].near(ball.centre(), self.radius) {
                own.for_each(drop);
                continue;
            }
            let mut hit = own.filter(|edge| hits(edge, ball, self.radius));
            let Some(edge) = hit.next() else { continue };
            // A second edge: a corner, which sends everything back.
            let corner = hit.next().is_some();
            hit.for_each(drop);
            contact = match contact {
                Contact::Nothing if corner => Contact::One([-ball.xdot, -ball.ydot]),
                Contact::Nothing => Contact::One(reflected(edge, ball)),
                Contact::One(_) | Contact::Several => return Contact::Several,
            };
        }
        contact
    }
}

/// Whether a ball touches an edge and is not leaving it.
fn hits(edge: &Edge, ball: &Ball, radius: f64) -> bool {
    let [x, y] = nearest(edge, ball.centre());
    // The signs of zeros count: the angle of a vector of length 0 depends on them.
    let [dx, dy] = [x - ball.x, y - ball.y];
    if dx * dx + dy * dy > radius * radius {
        return false;
    }
    let angle = angle([ball.xdot, ball.ydot], [dx, dy]);
    (if angle > PI { TAU - angle } else { angle }) <= LEAVING
}

/// The velocity after a mirror's reflection in an edge.
fn reflected(edge: &Edge, ball: &Ball) -> [f64; 2] {
    let along = if edge.along[0] < 0.0 { edge.along.map(|x| -x) } else { edge.along };
    let mut theta = angle([ball.xdot, ball.ydot], along) - PI;
    if theta < 0.0 {
        theta += TAU;
    }
    theta += angle([-1.0, 0.0], along);
    if theta > TAU {
        theta -= TAU;
    }
    let speed = ball.speed();
    [speed * cos(theta), speed * sin(theta)]
}

/// The angle from one vector to another, 0 to 2π; both are measured from the y axis.
fn angle(u: [f64; 2], v: [f64; 2]) -> f64 {
    let angle = atan2(u[0], u[1]) - atan2(v[0], v[1]);
    if angle < 0.0 { angle + TAU } else { angle }
}

/// A coordinate on the board again.
fn returned(at: f64) -> f64 {
    match at {
        at if at > 1.0 => BACK[1],
        at if at < 0.0 => BACK[0],
        at => at,
    }
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::pinball::Configuration;
    use crate::{Rng, Seed};

    /// The rules read aloud: every edge of every polygon, in order, nothing prepared.
    fn straightforward(configuration: &Configuration, ball: &mut Ball, push: [f64; 2]) -> bool {
        let radius = configuration.ball();
        let (target, reach) = configuration.target();
        ball.xdot = (ball.xdot + push[0] * 0.2).clamp(-2.0, 2.0);
        ball.ydot = (ball.ydot + push[1] * 0.2).clamp(-2.0, 2.0);
        let roll = |ball: &mut Ball| {
            ball.x += ball.xdot * radius / 20.0;
            ball.y += ball.ydot * radius / 20.0;
        };
        for substep in 0..20 {
            roll(ball);
            let effects: Vec<_> =
                configuration.polygons().iter().filter_map(|corners| effect(corners, ball, radius)).collect();
            match effects[..] {
                [] => {}
                [[xdot, ydot]] => {
                    (ball.xdot, ball.ydot) = (xdot, ydot);
                    if substep == 19 {
                        roll(ball);
                    }
                }
                _ => (ball.xdot, ball.ydot) = (-ball.xdot, -ball.ydot),
            }
            let [dx, dy] = [ball.x - target[0], ball.y - target[1]];
            if (dx * dx + dy * dy).sqrt() < reach {
                return true;
            }
        }
        ball.xdot *= 0.995;
        ball.ydot *= 0.995;
        for at in [&mut ball.x, &mut ball.y] {
            if *at > 1.0 {
                *at = 0.95;
            } else if *at < 0.0 {
                *at = 0.05;
            }
        }
        false
    }

    /// The velocity that a polygon gives a ball that runs into it.
    fn effect(corners: &[[f64; 2]], ball: &Ball, radius: f64) -> Option<[f64; 2]> {
        let box_of = |axis: usize| {
            let values = corners.iter().map(|corner| corner[axis]);
            (values.clone().fold(f64::MAX, f64::min), values.fold(f64::MIN, f64::max))
        };
        let ((left, right), (top, bottom)) = (box_of(0), box_of(1));
        if ball.x - radius > right || ball.x + radius < left {
            return None;
        }
        if ball.y - radius > bottom || ball.y + radius < top {
            return None;
        }
        let velocity = [ball.xdot, ball.ydot];
        let mut hit = Vec::new();
        for (i, &a) in corners.iter().enumerate() {
            let b = corners[(i + 1) % corners.len()];
            let along = [b[0] - a[0], b[1] - a[1]];
            let from = [ball.x - a[0], ball.y - a[1]];
            let share =
                (from[0] * along[0] + from[1] * along[1]) / (along[0] * along[0] + along[1] * along[1]);
            let share = share.clamp(0.0, 1.0);
            let to = [a[0] + along[0] * share - ball.x, a[1] + along[1] * share - ball.y];
            if to[0] * to[0] + to[1] * to[1] <= radius * radius {
                let wide = angle(velocity, to);
                if (if wide > PI { 2.0 * PI - wide } else { wide }) <= PI / 1.99 {
                    hit.push(if along[0] < 0.0 { [-along[0], -along[1]] } else { along });
                }
            }
        }
        match hit[..] {
            [] => None,
            [along] => {
                let mut theta = angle(velocity, along) - PI;
                theta += if theta < 0.0 { 2.0 * PI } else { 0.0 };
                theta += angle([-1.0, 0.0], along);
                theta -= if theta > 2.0 * PI { 2.0 * PI } else { 0.0 };
                let speed = (velocity[0] * velocity[0] + velocity[1] * velocity[1]).sqrt();
                Some([speed * cos(theta), speed * sin(theta)])
            }
            _ => Some([-velocity[0], -velocity[1]]),
        }
    }

    fn bits(ball: &Ball) -> [u64; 4] {
        [ball.x, ball.y, ball.xdot, ball.ydot].map(f64::to_bits)
    }

    /// Plays with both, also from places that no episode comes to: inside obstacles, off the board.
    fn agree(configuration: &Configuration, rng: &mut Rng) {
        for _ in 0..40 {
            let at = [rng.random_range(-0.1..1.1), rng.random_range(-0.1..1.1)];
            let mut ball =
                Ball { xdot: rng.random_range(-2.0..2.0), ydot: rng.random_range(-2.0..2.0), ..Ball::at(at) };
            for _ in 0..200 {
                let push =
                    [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0], [0.0, 0.0]][rng.random_range(0..5)];
                let mut other = ball;
                let there = configuration.board.decide(&mut ball, push);
                assert_eq!(there, straightforward(configuration, &mut other, push));
                assert_eq!(bits(&ball), bits(&other), "{ball:?} {other:?}");
                if there {
                    break;
                }
            }
        }
    }

    #[test]
    fn looking_only_at_what_is_near_changes_no_bit() {
        let mut rng = Seed(3).stream("test", 0);
        for name in ["hard_single", "simple_single", "medium", "box", "empty"] {
            agree(&Configuration::named(name).unwrap(), &mut rng);
        }
    }

    #[test]
    fn nor_on_boards_that_nobody_has_seen() {
        let mut rng = Seed(4).stream("test", 0);
        for _ in 0..20 {
            let mut text =
                format!("ball {}\ntarget 0.9 0.9 0.03\nstart 0.5 0.5\n", rng.random_range(0.004..0.1));
            for _ in 0..rng.random_range(0..12) {
                let [x, y] = [rng.random_range(0.0..0.8), rng.random_range(0.0..0.8)];
                text.push_str("polygon");
                for _ in 0..rng.random_range(3..8) {
                    let [dx, dy]: [f64; 2] = [rng.random_range(0.0..0.2), rng.random_range(0.0..0.2)];
                    text.push_str(&format!(" {} {}", x + dx, y + dy));
                }
                text.push('\n');
            }
            // Some cover their own start, and are none.
            if let Ok(configuration) = Configuration::parse(&text) {
                agree(&configuration, &mut rng);
            }
        }
    }

    #[test]
    fn speed_outlasts_every_collision() {
        let mut rng = Seed(5).stream("test", 0);
        for name in ["hard_single", "medium"] {
            let configuration = Configuration::named(name).unwrap();
            let mut turned = 0;
            for _ in 0..3000 {
                let velocity: [f64; 2] = [rng.random_range(-2.0..2.0), rng.random_range(-2.0..2.0)];
                let mut ball = Ball::at(configuration.sample(&mut rng));
                (ball.xdot, ball.ydot) = (velocity[0], velocity[1]);
                let before = ball;
                let there = configuration.board.decide(&mut ball, [0.0, 0.0]);
                let drag = if there { 1.0 } else { DRAG };
                assert!((ball.speed() - drag * before.speed()).abs() < 1e-12, "{before:?} {ball:?}");
                turned += usize::from((ball.xdot - drag * before.xdot).abs() > 1e-9);
            }
            assert!(turned > 300, "{name}: only {turned} balls met anything");
        }
    }

    #[test]
    fn a_push_adds_a_fifth_up_to_two_and_drag_comes_last() {
        let empty = Configuration::named("empty").unwrap();
        let mut ball = Ball::at([0.5, 0.5]);
        assert!(!empty.board.decide(&mut ball, [1.0, 0.0]));
        assert!((ball.x - (0.5 + 0.2 * 0.02)).abs() < 1e-12 && ball.xdot == 0.2 * 0.995, "{ball:?}");
        ball = Ball { xdot: 1.95, ..Ball::at([0.3, 0.5]) };
        empty.board.decide(&mut ball, [1.0, 0.0]);
        assert_eq!(ball.xdot, 2.0 * 0.995);
    }

    #[test]
    fn who_leaves_the_board_is_put_back() {
        let bare = Configuration::parse("ball 0.02\ntarget 0.9 0.2 0.04\nstart 0.2 0.9").unwrap();
        let mut ball = Ball { xdot: 2.0, ydot: -2.0, ..Ball::at([0.99, 0.01]) };
        bare.board.decide(&mut ball, [0.0, 0.0]);
        assert_eq!(ball.centre(), [0.95, 0.05]);
    }

    /// Two that are in the same place turn a ball back where one would deflect it.
    #[test]
    fn a_polygon_that_is_there_twice_counts_twice() {
        let wall = "polygon 0.4 0.5 0.8 0.5 0.8 0.6 0.4 0.6\n";
        let thrown = |walls: &str| {
            let text = format!("ball 0.02\ntarget 0.1 0.1 0.04\nstart 0.2 0.9\n{walls}");
            let mut ball = Ball { xdot: 1.0, ydot: 1.0, ..Ball::at([0.6, 0.47]) };
            Configuration::parse(&text).unwrap().board.decide(&mut ball, [0.0, 0.0]);
            [ball.xdot, ball.ydot].map(|v| v.signum())
        };
        assert_eq!(thrown(wall), [1.0, -1.0]);
        assert_eq!(thrown(&format!("{wall}{wall}")), [-1.0, -1.0]);
    }

    #[test]
    fn a_ball_at_rest_stays_where_it_is() {
        let hard = Configuration::named("hard_single").unwrap();
        let mut rng = Seed(6).stream("test", 0);
        // Also where it touches a wall, exactly or not.
        let touching = [[0.025, 0.5], [0.5, 0.99 - 0.015], [0.01, 0.01]];
        for at in touching.into_iter().chain((0..200).map(|_| hard.sample(&mut rng))) {
            let mut ball = Ball::at(at);
            if !hard.board.decide(&mut ball, [0.0, 0.0]) {
                assert_eq!((ball.centre(), ball.speed()), (at, 0.0));
            }
        }
    }
}
