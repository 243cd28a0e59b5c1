//! The mazes of the registry.
//!
//! Names are `<robot>-<maze>`, then what differs from the plain domain: `-small-steps` (D4RL's point, 0.2 m a
//! step), `-timed` (the observation ends with the elapsed time), `-dense` (paid by the distance). The point's
//! U-maze is the thesis' Point-Maze and is called `point-maze`; `point-umaze` and `point-arena` have no task, for the
//! unsupervised phase of chapter 6.

use inroads_sim::rigid::Model;

use super::{AntMaze, Maze, MazeError, Picture, PointMaze, Starts, Stride, maps};
use crate::registry::{AnyEnvironment, Entry, Make, Options};
use crate::{Pay, TimeLimit};

/// The thesis' Point-Maze: round three sides of a U, with the goal at (0, 8) (section 3.2).
pub const U_MAZE: Maze<'static> = Maze {
    name: "point-maze",
    about: "a point robot walks round a U to a goal behind the wall; -1 a step",
    cells: maps::U,
    scale: 4.0,
    goal: None,
    tolerance: 0.6,
    starts: Starts::Map,
    pay: Pay::Sparse,
    locked: false,
    timed: false,
    limit: 1000,
};

/// The U-maze without a task, where a graph of skills is found before any goal is known (thesis section 6.2). With a
/// task, and anywhere to start and to go, the same floor is `point-maze-small-steps`.
pub const FREE_U_MAZE: Maze<'static> = Maze {
    name: "point-umaze",
    about: "a point robot with D4RL's small steps in a U-maze without a task",
    pay: Pay::Nothing,
    ..U_MAZE
};

/// The open arena without a task; with one it is `point-reacher-small-steps`.
pub const FREE_ARENA: Maze<'static> = Maze {
    name: "point-arena",
    about: "a point robot with D4RL's small steps in an open arena without a task",
    starts: Starts::Map,
    pay: Pay::Nothing,
    ..REACHER
};

/// A short straight corridor, of ours, where learners can be tested in seconds.
pub const CORRIDOR: Maze<'static> = Maze {
    name: "point-corridor",
    about: "a point robot walks down a straight corridor of 8 m; -1 a step",
    cells: maps::CORRIDOR,
    limit: 300,
    ..U_MAZE
};

/// An E with two starts and one goal (thesis section 3.2).
pub const E_MAZE: Maze<'static> = Maze {
    name: "point-e-maze",
    about: "a point robot walks from an E's top or bottom rung to the goal on the middle one; -1 a step",
    cells: maps::E,
    ..U_MAZE
};

/// D4RL's medium maze, from (0, 0) to (20, 20).
pub const MEDIUM_MAZE: Maze<'static> = Maze {
    name: "point-medium-maze",
    about: "a point robot crosses D4RL's medium maze to the opposite corner; -1 a step",
    cells: maps::MEDIUM,
    ..U_MAZE
};

/// D4RL's large maze, from (0, 0) to (32, 24).
pub const LARGE_MAZE: Maze<'static> = Maze {
    name: "point-large-maze",
    about: "a point robot crosses D4RL's large maze to the opposite corner; -1 a step",
    cells: maps::LARGE,
    ..U_MAZE
};

/// Four rooms, from the middle of one, (0, 0), to that of the opposite one, (12, 12) (author's code of
/// chapter 4).
pub const FOUR_ROOMS: Maze<'static> = Maze {
    name: "point-four-rooms",
    about: "a point robot walks from one of four rooms to the opposite one; -1 a step",
    cells: maps::FOUR_ROOMS,
    scale: 3.0,
    ..U_MAZE
};

/// The open arena with the goal (0, 0) in its middle and starts anywhere (thesis section 4.2.3: uniformly in
/// (−10, 10); here, as far as the robot fits between the walls at ±10.5).
pub const REACHER: Maze<'static> = Maze {
    name: "point-reacher",
    about: "a point robot starts anywhere in an open arena and walks to its middle; -1 a step",
    cells: maps::ARENA,
    scale: 3.0,
    goal: Some([0.0, 0.0]),
    starts: Starts::Anywhere,
    ..U_MAZE
};

/// Four Rooms with Lock and Key (thesis section 3.2): key at (8, 8), lock at (0, 8).
pub const LOCK_AND_KEY: Maze<'static> = Maze {
    name: "point-lock-and-key",
    about: "a point robot fetches a key from one of four rooms and takes it to a lock in another; -1 a step",
    cells: maps::LOCK_AND_KEY,
    scale: 2.0,
    locked: true,
    ..U_MAZE
};

/// The thesis' Ant U-Maze (sections 4.2, 6.2): D4RL's, from (0, 0) to (0, 8).
pub const ANT_U_MAZE: Maze<'static> = Maze {
    name: "ant-u-maze",
    about: "an ant walks round a U to a goal behind the wall; -1 a step",
    ..U_MAZE
};

/// The thesis' Ant Medium-Maze (sections 5.2, 6.2): D4RL's, from (0, 0) to (20, 20).
pub const ANT_MEDIUM_MAZE: Maze<'static> = Maze {
    name: "ant-medium-maze",
    about: "an ant crosses D4RL's medium maze to the opposite corner; -1 a step",
    ..MEDIUM_MAZE
};

/// The thesis' Ant Large-Maze (sections 4.2, 6.2): D4RL's, from (0, 0) to (32, 24).
pub const ANT_LARGE_MAZE: Maze<'static> = Maze {
    name: "ant-large-maze",
    about: "an ant crosses D4RL's large maze to the opposite corner; -1 a step",
    ..LARGE_MAZE
};

/// The thesis' Ant Four-Rooms (section 4.2), from (0, 0) to (12, 12).
pub const ANT_FOUR_ROOMS: Maze<'static> = Maze {
    name: "ant-four-rooms",
    about: "an ant walks from one of four rooms to the opposite one; -1 a step",
    ..FOUR_ROOMS
};

/// The thesis' Ant-Reacher (sections 4.2.3, 6.2): anywhere in the arena to (0, 0).
pub const ANT_REACHER: Maze<'static> = Maze {
    name: "ant-reacher",
    about: "an ant starts anywhere in an open arena and walks to its middle; -1 a step",
    ..REACHER
};

/// What walks in a maze of the registry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Walker {
    /// A point robot.
    Point(Stride),
    /// The ant, or a user's body in its place.
    Ant,
}

/// A maze of the registry, with what walks in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Listed {
    /// The maze.
    pub maze: Maze<'static>,
    /// What walks in it.
    pub walker: Walker,
}

/// rllab's point in a maze.
const fn point(maze: Maze<'static>) -> Listed {
    Listed { maze, walker: Walker::Point(Stride::Rllab) }
}

/// The ant in a maze.
const fn ant(maze: Maze<'static>) -> Listed {
    Listed { maze, walker: Walker::Ant }
}

/// An ant that observes the time since its episode began: 30 numbers (thesis section 5.2).
macro_rules! timed {
    ($of:literal, $maze:expr) => {
        ant(Maze {
            name: concat!($of, "-timed"),
            about: concat!($of, " whose observation ends with the elapsed time"),
            timed: true,
            ..$maze
        })
    };
}

/// D4RL's point in the maze of another domain.
macro_rules! small_steps {
    ($of:literal, $maze:expr) => {
        Listed {
            maze: Maze {
                name: concat!($of, "-small-steps"),
                about: concat!($of, " with D4RL's point, whose steps are a fifth as long"),
                ..$maze
            },
            walker: Walker::Point(Stride::Small),
        }
    };
}

/// A domain that is paid by the distance to the goal.
macro_rules! dense {
    ($of:literal, $listed:expr, $price:expr, $paid:literal) => {
        Listed {
            maze: Maze {
                name: concat!($of, "-dense"),
                about: concat!($of, " paid by ", $paid, " the distance to the goal a step"),
                pay: Pay::Dense { price: $price },
                ..$listed.maze
            },
            ..$listed
        }
    };
}

macro_rules! list {
    ($($listed:expr),* $(,)?) => {
        /// All mazes, in the registry's order.
        pub const ALL: &[Listed] = &[$($listed),*];

        pub(crate) const ENTRIES: &[Entry] = &[$(Entry {
            name: $listed.maze.name,
            about: $listed.maze.about,
            make: Make::Bodies {
                make: || $listed.build(&Options::default()).expect("the mazes of this crate are well formed"),
                picture: || $listed.picture(&Options::default()).ok(),
            },
        }),*];
    };
}

list! {
    point(U_MAZE),
    dense!("point-maze", point(U_MAZE), 0.1, "minus a tenth of"),
    point(CORRIDOR),
    point(E_MAZE),
    point(MEDIUM_MAZE),
    point(LARGE_MAZE),
    point(FOUR_ROOMS),
    point(LOCK_AND_KEY),
    point(REACHER),
    small_steps!("point-maze", U_MAZE),
    small_steps!("point-e-maze", E_MAZE),
    small_steps!("point-medium-maze", MEDIUM_MAZE),
    small_steps!("point-large-maze", LARGE_MAZE),
    small_steps!("point-four-rooms", FOUR_ROOMS),
    small_steps!("point-lock-and-key", LOCK_AND_KEY),
    small_steps!("point-reacher", REACHER),
    Listed { maze: FREE_U_MAZE, walker: Walker::Point(Stride::Small) },
    Listed { maze: FREE_ARENA, walker: Walker::Point(Stride::Small) },
    ant(ANT_REACHER),
    ant(ANT_U_MAZE),
    ant(ANT_MEDIUM_MAZE),
    ant(ANT_LARGE_MAZE),
    ant(ANT_FOUR_ROOMS),
    timed!("ant-reacher", ANT_REACHER),
    timed!("ant-u-maze", ANT_U_MAZE),
    timed!("ant-medium-maze", ANT_MEDIUM_MAZE),
    timed!("ant-large-maze", ANT_LARGE_MAZE),
    timed!("ant-four-rooms", ANT_FOUR_ROOMS),
    dense!("ant-reacher", ant(ANT_REACHER), 1.0, "minus"),
    dense!("ant-u-maze", ant(ANT_U_MAZE), 1.0, "minus"),
    dense!("ant-medium-maze", ant(ANT_MEDIUM_MAZE), 1.0, "minus"),
    dense!("ant-large-maze", ant(ANT_LARGE_MAZE), 1.0, "minus"),
}

impl Listed {
    /// The maze of that name.
    pub fn find(name: &str) -> Option<Self> {
        ALL.iter().find(|listed| listed.maze.name == name).copied()
    }

    /// The maze with a user's changes.
    fn altered<'a>(&self, options: &Options<'a>) -> Maze<'a> {
        let own = self.maze;
        Maze {
            cells: options.map.unwrap_or(own.cells),
            scale: options.scale.unwrap_or(own.scale),
            // A new map has a goal of its own.
            goal: options.goal.or(own.goal.filter(|_| options.map.is_none())),
            starts: options.starts.unwrap_or(own.starts),
            ..own
        }
    }

    /// The domain, with a user's changes.
    ///
    /// # Errors
    /// [`MazeError`] says which change cannot be made.
    pub fn build(&self, options: &Options<'_>) -> Result<AnyEnvironment, MazeError> {
        let maze = self.altered(options);
        Ok(AnyEnvironment::Vectors(match self.walker {
            Walker::Point(stride) => {
                Box::new(TimeLimit::new(PointMaze::striding(&maze, stride)?, maze.limit))
            }
            Walker::Ant => Box::new(TimeLimit::new(walked(&maze, options.body)?, maze.limit)),
        }))
    }

    /// The domain seen from above, with a user's changes.
    ///
    /// # Errors
    /// As [`build`](Self::build).
    pub fn picture(&self, options: &Options<'_>) -> Result<Picture, MazeError> {
        let maze = self.altered(options);
        Ok(match self.walker {
            Walker::Point(stride) => PointMaze::striding(&maze, stride)?.picture(),
            Walker::Ant => walked(&maze, options.body)?.picture(),
        })
    }
}

/// A maze with a user's body or the ant.
fn walked(maze: &Maze<'_>, body: Option<&Model>) -> Result<AntMaze, MazeError> {
    match body {
        Some(body) => AntMaze::walked_by(maze, body),
        None => AntMaze::new(maze),
    }
}
