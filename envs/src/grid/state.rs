//! All that changes in the course of an episode.

use super::{Board, Cell, Door, GridError, Pose};

/// What success is, besides stepping on a goal, which always is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Task {
    /// Stepping on a goal.
    #[default]
    Reach,
    /// Holding such an object after trying to pick something up. A box counts whatever is in it.
    Take(Cell),
    /// That the door in this cell is open after something was toggled.
    Open([u8; 2]),
}

/// All that changes in the course of an episode: what [`Snapshot`](crate::Snapshot) keeps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct State {
    /// What stands where, without the agent and what it carries.
    pub board: Board,
    /// Where the agent is.
    pub pose: Pose,
    /// What the agent carries: a key, a ball, a box, or [`Cell::Empty`].
    pub carried: Cell,
    /// What success is.
    pub task: Task,
    /// Steps taken in this episode.
    pub steps: u32,
}

impl State {
    /// An empty board at the beginning of an episode.
    pub(super) fn empty(size: [u8; 2]) -> Self {
        let (board, pose) = (Board::empty(size), Pose::default());
        Self { board, pose, carried: Cell::Empty, task: Task::Reach, steps: 0 }
    }

    /// The beginning of an episode on somebody's own board.
    ///
    /// # Errors
    /// [`GridError::Agent`] and [`GridError::Task`], as [`check`](Self::check).
    pub fn new(board: Board, pose: Pose, task: Task) -> Result<Self, GridError> {
        let state = Self { board, pose, carried: Cell::Empty, task, steps: 0 };
        state.check().map(|()| state)
    }

    /// Whether the agent stands where one can, carries what one can, and has something to succeed with.
    ///
    /// # Errors
    /// [`GridError`] says what is not so.
    pub fn check(&self) -> Result<(), GridError> {
        if !self.board.get(self.pose.at).walkable() {
            return Err(GridError::Agent { at: self.pose.at });
        }
        if self.carried != Cell::Empty && !self.carried.portable() {
            return Err(GridError::Carried(self.carried));
        }
        let is = |wanted: fn(Cell) -> bool| self.board.cells().any(|(_, cell)| wanted(cell));
        match self.task {
            Task::Reach if !is(|cell| matches!(cell, Cell::Goal(_))) => Err(GridError::Task("a goal")),
            Task::Open(at) if !matches!(self.board.get(at), Cell::Door(..)) => {
                Err(GridError::Task("a door in the cell that it names"))
            }
            Task::Take(wanted) if !wanted.portable() => Err(GridError::Task("a key, a ball or a box")),
            _ => Ok(()),
        }
    }

    /// Whether the task is done, given that something was just picked up or toggled.
    pub(super) fn taken(&self) -> bool {
        let kind = |cell: Cell| {
            let [object, colour, _] = cell.encode();
            (object, colour)
        };
        matches!(self.task, Task::Take(wanted) if kind(wanted) == kind(self.carried))
    }

    /// As [`taken`](Self::taken), of the door.
    pub(super) fn opened(&self) -> bool {
        matches!(self.task, Task::Open(at) if matches!(self.board.get(at), Cell::Door(_, Door::Open)))
    }
}
