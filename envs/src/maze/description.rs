//! What makes one maze differ from another, as data, and why there is no such maze.

use inroads_sim::rigid::MapError;

use crate::Pay;

/// Where episodes start. Noise comes on top.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Starts<'a> {
    /// At the map's start cells; where there are several, the seed chooses.
    Map,
    /// Uniformly in the free space in which the robot fits, but not within the goal's tolerance.
    Anywhere,
    /// At one of these points, metres; the seed chooses.
    At(&'a [[f64; 2]]),
}

/// A maze, whatever walks in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Maze<'a> {
    /// Its name in the registry.
    pub name: &'static str,
    /// One sentence.
    pub about: &'static str,
    /// The map, as [`CellMap::parse`](inroads_sim::rigid::CellMap::parse) reads it.
    pub cells: &'a str,
    /// Side of a cell, metres.
    pub scale: f64,
    /// The goal, metres from the first start; `None` for the map's first goal cell.
    pub goal: Option<[f64; 2]>,
    /// Greatest distance from the goal that counts as there, metres.
    pub tolerance: f64,
    /// Where episodes start.
    pub starts: Starts<'a>,
    /// What a step pays.
    pub pay: Pay,
    /// Whether the goal is a lock, which needs the key from the map's key cell.
    pub locked: bool,
    /// Whether the observation ends with the time since the episode's start, a thousandth a step.
    pub timed: bool,
    /// Steps after which an episode is truncated.
    pub limit: u32,
}

/// Why there is no such maze.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MazeError {
    /// The map cannot be read.
    #[error(transparent)]
    Map(#[from] MapError),
    /// The robot does not fit into a cell.
    #[error("cells of {scale} m are too narrow for a robot of {robot} m; give a scale of at least {robot}")]
    Narrow {
        /// Side of a cell, metres.
        scale: f64,
        /// What the robot needs.
        robot: f64,
    },
    /// There is no goal, or it is in a wall.
    #[error("the goal must lie in free space: mark a cell with g, or give a point that is not in a wall")]
    Goal,
    /// The tolerance is not a positive finite number.
    #[error("a goal cannot have tolerance {0}; give a positive finite number of metres")]
    Tolerance(f64),
    /// A lock without a key, or a key without a lock.
    #[error(
        "{found} key cells where {expected} are needed: mark one cell with k where the domain \
         has a lock, and none elsewhere"
    )]
    Keys {
        /// Key cells of the map.
        found: usize,
        /// Key cells that the domain needs.
        expected: usize,
    },
    /// The robot could walk off the map.
    #[error(
        "map line {line}, column {column}: the cell is free and at the map's edge; put a wall (#) all round"
    )]
    Open {
        /// Line of the map, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
    },
    /// The robot cannot stand at a start.
    #[error("the robot cannot start at ({}, {}): {why}; give a greater scale or another start", at[0], at[1])]
    Start {
        /// The place, metres.
        at: [f64; 2],
        /// Why not.
        why: String,
    },
    /// There is no place to start at.
    #[error("there is no place to start at: {0}")]
    NoRoom(&'static str),
    /// The body cannot be simulated, or cannot walk.
    #[error("the body cannot be used: {0}")]
    Body(String),
}
