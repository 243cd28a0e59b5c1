//! Mazes: a robot walks to a goal (thesis sections 3.2, 4.2, 5.2 and 6.2).
//!
//! A [`Maze`] is data: map, scale, goal, starts, pay. What walks in it is a [`Robot`]: rllab's [`Point`],
//! D4RL's (the same with a fifth of the stride), the ant, or any other body. [`MazeTask`] makes a domain of
//! the two; the registry's stand in [`catalogue`]. The time limit is [`TimeLimit`](crate::TimeLimit)'s
//! business.
//!
//! ```
//! use inroads_envs::{Environment, maze::{Maze, PointMaze, U_MAZE}};
//! let cells = "#####\n#r.g#\n#####";
//! let mut corridor = PointMaze::new(&Maze { cells, scale: 3.0, ..U_MAZE })?;
//! corridor.reset(0);
//! corridor.step(&vec![1.0, 0.0])?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod body;
pub mod catalogue;
mod description;
mod ground;
pub mod maps;
mod picture;
mod point;
mod robot;
mod steering;
mod task;

pub use body::{AntMaze, Body};
pub use catalogue::{CORRIDOR, U_MAZE};
pub use description::{Maze, MazeError, Starts};
pub use inroads_sim::rigid::Rectangle;
pub use picture::{Picture, walls};
pub use point::{Point, PointMaze, Stride};
pub use robot::{Heading, Robot};
pub use steering::Steering;
pub use task::{MazeState, MazeTask};

pub(crate) use catalogue::ENTRIES;
