//! Truth beside belief: where each skill really succeeds, beside where its initiation set says that it may start.
//!
//! Any state can be restored, so every learned skill is called, with its frozen policy and without noise, from a grid of places
//! of the run's maze: the robot stands at each as the environment's reset would put it there, and the skill acts until it has
//! reached its subgoal, its time is up, or the episode has ended. The agent takes no part in it but by acting: all of this is
//! outside `agents` and `discovery`, which never see a state restored. In a maze with a lock the key is not held, as at an
//! episode's start.

mod score;
#[cfg(test)]
mod tests;

pub use score::Score;

use std::{fs, path::Path};

use inroads_discovery::SkillRecord;
use inroads_envs::{
    Seed,
    maze::{MazeError, Starts},
    registry::{self, AnyEnvironment, MakeError, Options},
};
use serde::{Deserialize, Serialize};

use crate::{
    config::Settings,
    draw::View,
    figures::{Map, Rect},
    run::RunError,
    session::{Attempt, Session},
};

/// How it is found out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct How {
    /// Cells along the longer side of the maze, at least 1.
    pub cells: usize,
    /// Calls of each skill in each cell, at least 1.
    pub times: u32,
}

impl Default for How {
    /// On a U-maze of 12 m cells of 0.6 m, which is the tolerance of its goal.
    fn default() -> Self {
        Self { cells: 20, times: 3 }
    }
}

/// Cells that cover the least rectangle about a maze's free space. Metres.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lattice {
    /// The corner with the smallest x and y.
    pub low: [f32; 2],
    /// The corner with the largest x and y.
    pub high: [f32; 2],
    /// Cells along x.
    pub columns: usize,
    /// Cells along y.
    pub rows: usize,
}

impl Lattice {
    /// Cells as square as can be, so many along the longer side.
    pub fn of(free: Rect, cells: usize) -> Self {
        let [w, h] = free.size();
        let side = w.max(h) / cells as f32;
        let count = |length: f32| ((length / side).round() as usize).max(1);
        Self { low: free.min, high: free.max, columns: count(w), rows: count(h) }
    }

    /// Width and height of a cell.
    pub fn cell(&self) -> [f32; 2] {
        let parts = [self.columns as f32, self.rows as f32];
        [0, 1].map(|axis| (self.high[axis] - self.low[axis]) / parts[axis])
    }

    /// The middle of a cell.
    pub fn middle(&self, column: usize, row: usize) -> [f32; 2] {
        let (cell, number) = (self.cell(), [column as f32, row as f32]);
        [0, 1].map(|axis| self.low[axis] + (number[axis] + 0.5) * cell[axis])
    }

    /// The middles of the cells that are free, with column and row: row by row from the lowest y.
    fn free<'a>(&'a self, map: &'a Map) -> impl Iterator<Item = (usize, usize, [f32; 2])> + 'a {
        let all = (0..self.rows).flat_map(|row| (0..self.columns).map(move |column| (column, row)));
        all.map(|(column, row)| (column, row, self.middle(column, row))).filter(|(.., at)| map.is_free(*at))
    }
}

/// What calls of one skill from one cell came to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cell {
    /// Its column, from the smallest x.
    pub column: usize,
    /// Its row, from the smallest y.
    pub row: usize,
    /// Its middle, metres.
    pub at: [f32; 2],
    /// Calls that had something to do.
    pub tried: u32,
    /// Calls that were made inside the subgoal, where the skill is not admissible (equation 3.1) and nothing is to be tried.
    pub there: u32,
    /// Of those that were tried, how many ended inside the subgoal.
    pub succeeded: u32,
    /// How many the end of the episode cut short.
    pub cut_short: u32,
    /// How many began where the initiation set says that the skill may start.
    pub may_start: u32,
    /// How many began where another skill might have aimed at.
    pub may_aim: u32,
    /// How probable success was held to be, in the mean; none where sets only tell inside from outside.
    pub chance: Option<f32>,
    /// Steps of those that succeeded, in the mean; none when none did.
    pub steps: Option<f32>,
}

impl Cell {
    fn new(column: usize, row: usize, at: [f32; 2], attempts: &[Attempt]) -> Self {
        let count = |of: fn(&Attempt) -> bool| attempts.iter().filter(|attempt| of(attempt)).count() as u32;
        let tried = count(|attempt| attempt.came.steps > 0);
        let mean =
            |values: Vec<f32>| (!values.is_empty()).then(|| values.iter().sum::<f32>() / values.len() as f32);
        let done = attempts.iter().filter(|attempt| attempt.came.steps > 0);
        let chances: Vec<_> = done.clone().filter_map(|attempt| attempt.chance).collect();
        let steps = done.filter(|attempt| attempt.came.success).map(|attempt| attempt.came.steps as f32);
        Self {
            column,
            row,
            at,
            tried,
            there: attempts.len() as u32 - tried,
            succeeded: count(|attempt| attempt.came.steps > 0 && attempt.came.success),
            cut_short: count(|attempt| attempt.came.stop == inroads_discovery::Stop::CutShort),
            may_start: count(|attempt| attempt.came.steps > 0 && attempt.may_start),
            may_aim: count(|attempt| attempt.came.steps > 0 && attempt.may_aim),
            chance: mean(chances),
            steps: mean(steps.collect()),
        }
    }

    /// The share of calls that succeeded; none where none had anything to do.
    pub fn success(&self) -> Option<f64> {
        (self.tried > 0).then(|| f64::from(self.succeeded) / f64::from(self.tried))
    }
}

/// One skill.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SkillTruth {
    /// What the agent tells of it.
    #[serde(flatten)]
    pub skill: SkillRecord,
    /// Belief and truth in numbers.
    pub score: Score,
    /// Every cell in which the robot can stand.
    pub cells: Vec<Cell>,
}

/// All learned skills of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    /// The agent's name.
    pub agent: String,
    /// The environment's name.
    pub environment: String,
    /// The run's seed.
    pub seed: u64,
    /// Training episodes until then.
    pub episodes: u64,
    /// Calls of each skill in each cell.
    pub times: u32,
    /// Where the cells are.
    pub lattice: Lattice,
    /// The skills, oldest first.
    pub skills: Vec<SkillTruth>,
}

impl Truth {
    /// Calls every learned skill of a session from everywhere; `watch` is told after each cell how many are done, of how many.
    /// The session is not changed.
    ///
    /// # Errors
    /// [`RunError::NoMap`] where there is no map to take places from, [`RunError::NoCalls`] where there is nothing to call, or
    /// the environment refused an action.
    pub fn of(
        session: &dyn Session,
        settings: &Settings,
        how: How,
        mut watch: impl FnMut(usize, usize),
    ) -> Result<Self, RunError> {
        let view = View::of(settings).ok_or_else(|| RunError::NoMap(settings.environment.clone()))?;
        let lattice = Lattice::of(view.free(), how.cells.max(1));
        let (episodes, _) = session.progress();
        let records = session.skills();
        let none = || RunError::NoCalls { agent: settings.agent.clone(), episodes };
        if records.is_empty() {
            return Err(none());
        }
        let mut cells: Vec<Vec<Cell>> = vec![Vec::new(); records.len()];
        let places: Vec<_> = lattice.free(&view.map).collect();
        for (done, &(column, row, at)) in places.iter().enumerate() {
            watch(done, places.len());
            let Some(mut env) = elsewhere(settings, at)? else { continue };
            for (record, cells) in records.iter().zip(&mut cells) {
                let mut attempts = Vec::new();
                for time in 0..how.times {
                    // The same starts for all skills.
                    let index = (done * how.times as usize) as u64 + u64::from(time);
                    let start = Seed(settings.seed).number("truth-start", index);
                    let attempt = session.attempt(record.skill, &mut env, start, index)?;
                    attempts.push(attempt.ok_or_else(none)?);
                }
                cells.push(Cell::new(column, row, at, &attempts));
            }
        }
        watch(places.len(), places.len());
        let [w, h] = lattice.cell();
        let skills = records.into_iter().zip(cells).map(|(skill, cells)| SkillTruth {
            skill,
            score: Score::of(&cells, f64::from(w * h)),
            cells,
        });
        let Settings { agent, environment, seed, .. } = settings;
        Ok(Self {
            agent: agent.clone(),
            environment: environment.clone(),
            seed: *seed,
            episodes,
            times: how.times,
            lattice,
            skills: skills.collect(),
        })
    }

    /// Writes it as JSON.
    ///
    /// # Errors
    /// [`RunError::Io`] when the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), RunError> {
        let text = serde_json::to_string(self).expect("plain data always encodes");
        fs::write(path, text + "\n").map_err(RunError::io("write", path))
    }
}

/// The run's environment with starts at that point; none where the robot cannot stand there.
fn elsewhere(settings: &Settings, at: [f32; 2]) -> Result<Option<AnyEnvironment>, RunError> {
    let places = [at.map(f64::from)];
    let made = settings.world.with_options(|own| {
        let options = Options { starts: Some(Starts::At(&places)), ..*own };
        match registry::make_with(&settings.environment, &options) {
            Err(MakeError::Maze { why: MazeError::Start { .. }, .. }) => Ok(None),
            made => made.map(Some),
        }
    })?;
    Ok(made)
}
