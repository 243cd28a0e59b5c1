//! A controller for the point robot, written by hand: it goes straight to a place, and knows nothing of walls.
//!
//! It stands in for a learned goal-reaching policy where that is not what is studied (thesis 6.2.1 has a learned model
//! and a planner over it).

use inroads_sim::{math, rigid::MAX_TURN};

use super::Stride;
use crate::Spec;

/// Steers a point robot straight to a place, backwards where that is the shorter turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steering {
    /// Where an observation has the heading.
    theta: usize,
    /// Metres of a forward action of 1.
    stride: f32,
}

impl Steering {
    /// The controller for a domain; none when what walks there is no point robot.
    pub fn of(spec: &Spec) -> Option<Self> {
        let [forward, turn] = spec.action.dimensions() else { return None };
        if (&*forward.name, &*turn.name) != ("forward", "turn") {
            return None;
        }
        let theta = spec.observation.dimensions().iter().position(|d| d.name == "theta")?;
        let stride =
            [Stride::Rllab, Stride::Small].into_iter().find(|stride| stride.unit() == forward.unit)?;
        Some(Self { theta, stride: stride.metres() as f32 })
    }

    /// The action that takes an observed robot nearer to a place, given in metres.
    pub fn action(&self, observation: &[f32], place: [f32; 2]) -> Vec<f32> {
        let [dx, dy] = [place[0] - observation[0], place[1] - observation[1]];
        let off = math::atan2f(dy, dx) - observation[self.theta];
        let (sin, cos) = (math::sinf(off), math::cosf(off));
        // The angle to turn by, ahead or backwards, in [−π/2, π/2].
        let turn = math::atan2f(sin * cos.signum(), cos.abs()).clamp(-MAX_TURN as f32, MAX_TURN as f32);
        // It turns before it goes: what is left of the way lies along the new heading.
        let along = (dx * dx + dy * dy).sqrt() * math::cosf(off - turn);
        vec![(along / self.stride).clamp(-1.0, 1.0), turn / MAX_TURN as f32]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Environment,
        maze::{PointMaze, U_MAZE},
    };

    /// Steps until the robot of the U-maze, put at the origin, is this near to a place; none after 60.
    fn walk(stride: Stride, place: [f32; 2], near: f32) -> Option<u32> {
        let mut env = PointMaze::striding(&U_MAZE, stride).unwrap();
        let steering = Steering::of(env.spec()).unwrap();
        env.restore(inroads_sim::rigid::PointState::default()).unwrap();
        let mut seen = Vec::new();
        (0..60).find(|_| {
            env.observe(&mut seen);
            let there = (seen[0] - place[0]).hypot(seen[1] - place[1]) < near;
            if !there {
                env.step(&steering.action(&seen, place)).unwrap();
            }
            there
        })
    }

    #[test]
    fn it_goes_straight_ahead_backwards_and_sideways_and_not_round_a_wall() {
        assert_eq!(walk(Stride::Rllab, [3.0, 0.0], 0.01), Some(3));
        assert_eq!(walk(Stride::Small, [3.0, 0.0], 0.01), Some(15));
        assert_eq!(walk(Stride::Small, [-1.0, 0.0], 0.01), Some(5));
        // Sideways it goes to and fro; half a metre is inside the regions that graphs are made of.
        assert!(walk(Stride::Small, [0.0, 1.0], 0.5).is_some_and(|steps| steps < 40));
        assert_eq!(walk(Stride::Small, [0.0, 8.0], 0.5), None);
    }

    #[test]
    fn a_corridor_of_choices_has_no_point_robot() {
        assert_eq!(Steering::of(crate::corridor::Corridor::new(5).spec()), None);
    }
}
