//! The solids that bodies are made of, as plain data: what collides is what is drawn.

use rapier3d::math::Vector;

/// A solid about its own origin. Metres.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A ball.
    Ball {
        /// Its radius.
        radius: f32,
    },
    /// All points within `radius` of the segment between two points.
    Capsule {
        /// One end of the segment.
        from: Vector,
        /// The other end.
        to: Vector,
        /// Its radius.
        radius: f32,
    },
    /// A box parallel to the axes.
    Cuboid {
        /// Half its sizes.
        half: Vector,
    },
    /// A cylinder along z.
    Cylinder {
        /// Half its height.
        half_height: f32,
        /// Its radius.
        radius: f32,
    },
    /// The convex hull of points.
    Hull {
        /// The points.
        points: Vec<Vector>,
    },
}
