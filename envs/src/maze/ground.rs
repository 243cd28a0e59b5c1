//! A maze's floor: its map with what lies on it, and points drawn from its free space.

use inroads_sim::rigid::CellMap;
use rand::RngExt;

use super::{Maze, MazeError, Starts};
use crate::Rng;

/// Draws of a point before the nearest substitute is taken. One draw in twenty succeeds in the narrowest maze
/// that is admitted in practice, so that the substitute is a matter of form.
const DRAWS: u32 = 1000;

/// The map of a maze and what lies on it. Metres.
#[derive(Clone, Debug)]
pub(super) struct Ground {
    pub(super) map: CellMap,
    pub(super) goal: [f64; 2],
    pub(super) tolerance: f64,
    pub(super) key: Option<[f64; 2]>,
    /// Where episodes start.
    pub(super) places: Vec<[f64; 2]>,
    /// They start anywhere in free space instead; the places are then good for pictures only.
    anywhere: bool,
}

impl Ground {
    pub(super) fn new(maze: &Maze<'_>) -> Result<Self, MazeError> {
        let map = CellMap::parse(maze.cells, maze.scale)?;
        if !(maze.tolerance.is_finite() && maze.tolerance > 0.0) {
            return Err(MazeError::Tolerance(maze.tolerance));
        }
        let goal = maze.goal.or(map.goals().first().copied()).filter(|&at| !map.is_wall(at));
        let (found, expected) = (map.keys().len(), usize::from(maze.locked));
        if found != expected {
            return Err(MazeError::Keys { found, expected });
        }
        Ok(Self {
            goal: goal.ok_or(MazeError::Goal)?,
            tolerance: maze.tolerance,
            key: map.keys().first().copied(),
            places: map.starts().to_vec(),
            anywhere: false,
            map,
        })
    }

    /// Changes where episodes start, for a robot that needs `clearance` about itself.
    ///
    /// # Errors
    /// [`MazeError::NoRoom`] when there is no such place.
    pub(super) fn start_at(&mut self, starts: Starts<'_>, clearance: f64) -> Result<(), MazeError> {
        let fits = |at: [f64; 2]| !self.map.may_touch_wall(at, clearance);
        match starts {
            Starts::Map => self.places = self.map.starts().to_vec(),
            Starts::At([]) => return Err(MazeError::NoRoom("the list of starts is empty")),
            Starts::At(places) => self.places = places.to_vec(),
            Starts::Anywhere if self.map.free_cells().any(fits) => self.places = self.map.starts().to_vec(),
            Starts::Anywhere => {
                return Err(MazeError::NoRoom("the robot fits into no cell; give a greater scale"));
            }
        }
        self.anywhere = starts == Starts::Anywhere;
        Ok(())
    }

    /// Draws where an episode starts; `away` says of a point that it is not at the goal already.
    pub(super) fn start(&self, clearance: f64, away: impl Fn([f64; 2]) -> bool, rng: &mut Rng) -> [f64; 2] {
        if !self.anywhere {
            return self.places[rng.random_range(0..self.places.len())];
        }
        let fits = |&at: &[f64; 2]| !self.map.may_touch_wall(at, clearance) && away(at);
        let drawn = (0..DRAWS).map(|_| self.point(rng)).find(fits);
        drawn.or_else(|| self.map.free_cells().find(fits)).unwrap_or(self.places[0])
    }

    /// Draws a point of free space.
    pub(super) fn free_point(&self, rng: &mut Rng) -> [f64; 2] {
        let drawn = (0..DRAWS).map(|_| self.point(rng)).find(|&at| !self.map.is_wall(at));
        drawn.unwrap_or(self.map.starts()[0])
    }

    /// Draws a point of the least rectangle about free space.
    fn point(&self, rng: &mut Rng) -> [f64; 2] {
        let bounds = self.map.bounds();
        std::array::from_fn(|axis| rng.random_range(bounds.low[axis]..bounds.high[axis]))
    }
}
