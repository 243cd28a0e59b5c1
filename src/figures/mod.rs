//! Pictures from plain data: learning curves, drawings on a maze map, graphs, goals, and a moving picture
//! of an episode.
//!
//! Nothing here knows an agent or an environment. A caller fills in numbers, a function writes one file:
//!
//! | function | file | in the thesis |
//! |---|---|---|
//! | [`curves`] | PNG, learning curves with every seed drawn | figure 3.1 |
//! | [`dots()`] | PNG, a dot a seed and their mean with its interval | figure 4.4 |
//! | [`sets()`] | PNG, one panel a skill: where its initiation set is | figure 3.2 |
//! | [`trajectories`] | PNG, paths coloured by the option that acted | figure 3.3 |
//! | [`graph()`] | PNG, a graph of skills on a map, a picture of the world, a lattice, or in layers | figures 6.4, 7.4 |
//! | [`goal_space()`] | PNG, one panel a time: which proto-goals are plausible and mastered | figure 8.3 |
//! | [`kept_features`] | PNG, a table of abstract subgoals and the features that they keep | section 9.2.3 |
//! | [`reliability()`] | PNG, predicted against measured probabilities | |
//! | [`movie()`] | GIF, the robot in its maze seen from above, coloured by the option that acts | |
//! | [`beliefs`] | PNG, two panels a skill: its sets, and where it succeeds | figure 4.5 |
//! | [`heat()`] | PNG, grids of cells: truth beside belief | |
//! | [`film()`], [`still`] | GIF and PNG of frames that somebody else drew | |
//!
//! Three rules hold in all of them. World coordinates have **y upwards**. Colours are numbers of one palette that
//! colour-blind readers can tell apart ([`skill_name`]: 0, black, is the global option). And the same data give the
//! same bytes: no clock, no system font, no randomness.
//!
//! Lists may be empty and values may be NaN: what cannot be drawn is left out. Where not even an empty picture is
//! left (no panel, no frame), where a raster has the wrong length, or where the file cannot be written, the answer is
//! a [`FigureError`].
//!
//! Shapes are rasterised by `tiny-skia`, letters come from the DejaVu fonts through `ttf-parser`: all Rust.

mod animation;
mod axis;
mod belief;
mod canvas;
mod caption;
mod chart;
mod dots;
mod error;
mod film;
mod goal_space;
mod graph;
mod heat;
mod indexed;
mod kept;
mod legend;
mod map;
mod maze;
mod movie;
mod palette;
mod raster;
mod reliability;
mod sets;
mod summary;
#[cfg(test)]
mod tests;
mod text;
mod trajectory;

pub use belief::{Belief, Patch, beliefs};
pub use chart::{Level, Panel, Series, Sheet, curves, curves_on};
pub use dots::{Column, Dots, dots};
pub use error::FigureError;
pub use film::{film, still};
pub use goal_space::{GoalPanel, GoalSquare, goal_space};
pub use graph::{Edge, Graph, Ground, Role, Vertex, graph};
pub use heat::{Heat, heat};
pub use kept::{Feature, Kept, kept_features};
pub use map::{Map, Rect};
pub use movie::{Pose, movie};
pub use palette::skill_name;
pub use raster::Raster;
pub use reliability::{Bin, Calibration, reliability};
pub use sets::{SetPicture, sets, sets_in_columns};
pub use summary::Summary;
pub use trajectory::{Trajectory, trajectories};
