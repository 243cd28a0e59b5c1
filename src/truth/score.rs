//! Belief and truth in numbers.

use serde::{Deserialize, Serialize};

use super::Cell;

/// How well a skill's set foretells where the skill succeeds. A cell is one in which the skill has something to do; it is
/// *inside* a set when at least half of its calls began there, and *true* when at least half of them succeeded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Score {
    /// Cells that are judged.
    pub cells: usize,
    /// The area of all of them, m².
    pub area: f64,
    /// The area in which the skill may start, m².
    pub may_start: f64,
    /// The area at which other skills may aim, m².
    pub may_aim: f64,
    /// The area in which at least half of the calls succeed, m².
    pub succeeds: f64,
    /// The probability of success, in the mean over all cells.
    pub success: f64,
    /// The same over the cells in which the skill may start; none where there are none.
    pub success_inside: Option<f64>,
    /// Of the cells in which the skill may start, the share that is true; none where there are none.
    pub precision: Option<f64>,
    /// Of the true cells, the share in which it may start; none where there are none.
    pub recall: Option<f64>,
    /// The mean of the shares of true and of other cells that the set tells; none where there are cells of one kind only.
    pub balanced_accuracy: Option<f64>,
    /// Of the cells at which others may aim, the share that is true; none where there are none.
    pub aim_precision: Option<f64>,
    /// Mean square difference between the probability that was believed and what came (Brier); none where sets only tell inside
    /// from outside.
    pub brier: Option<f64>,
}

impl Score {
    /// Of cells of that area each, m².
    pub(super) fn of(cells: &[Cell], area: f64) -> Self {
        let judged: Vec<_> = cells.iter().filter_map(|cell| Some((cell, cell.success()?))).collect();
        let half = |cell: &Cell, count: u32| 2 * count >= cell.tried;
        let starts = |cell: &Cell| half(cell, cell.may_start);
        let aims = |cell: &Cell| half(cell, cell.may_aim);
        let holds = |cell: &Cell| half(cell, cell.succeeded);
        let count = |of: &dyn Fn(&Cell) -> bool| judged.iter().filter(|(cell, _)| of(cell)).count() as f64;
        let both = count(&|cell| starts(cell) && holds(cell));
        let neither = count(&|cell| !starts(cell) && !holds(cell));
        let (start, aim, truth) = (count(&starts), count(&aims), count(&holds));
        let all = judged.len() as f64;
        let share = |part: f64, of: f64| (of > 0.0).then(|| part / of);
        let inside: f64 = judged.iter().filter(|(cell, _)| starts(cell)).map(|(_, success)| success).sum();
        let recall = share(both, truth);
        Self {
            cells: judged.len(),
            area: all * area,
            may_start: start * area,
            may_aim: aim * area,
            succeeds: truth * area,
            success: share(judged.iter().map(|(_, success)| success).sum(), all).unwrap_or(0.0),
            success_inside: share(inside, start),
            precision: share(both, start),
            recall,
            balanced_accuracy: recall
                .zip(share(neither, all - truth))
                .map(|(yes, no)| f64::midpoint(yes, no)),
            aim_precision: share(count(&|cell| aims(cell) && holds(cell)), aim),
            brier: brier(cells),
        }
    }
}

/// Over all calls, with the mean belief of a cell.
fn brier(cells: &[Cell]) -> Option<f64> {
    let known = cells.iter().filter_map(|cell| Some((cell, f64::from(cell.chance?))));
    let (sum, calls) = known.fold((0.0, 0.0), |(sum, calls), (cell, chance)| {
        let (yes, tried) = (f64::from(cell.succeeded), f64::from(cell.tried));
        (sum + yes * (1.0 - chance).powi(2) + (tried - yes) * chance.powi(2), calls + tried)
    });
    (calls > 0.0).then(|| sum / calls)
}
