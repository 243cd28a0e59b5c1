//! Truth beside belief, from a run.

use std::path::Path;

use super::View;
use crate::{
    figures::{self, Belief, Patch, Raster, Rect},
    run::{Run, RunError},
    truth::{SkillTruth, Truth},
};

/// Draws every skill's sets and where it succeeds, beside each other.
///
/// # Errors
/// [`RunError`] when the environment has no map, or the file cannot be written.
pub fn truth(run: &Run, truth: &Truth, path: &Path) -> Result<(), RunError> {
    let view = View::of(&run.config.settings);
    let view = view.ok_or_else(|| RunError::NoMap(run.config.settings.environment.clone()))?;
    let sets = view.sets(run).into_iter().zip(view.targets(run));
    let half = truth.lattice.cell().map(|side| side / 2.0);
    let beliefs: Vec<_> = truth
        .skills
        .iter()
        .zip(sets)
        .map(|(skill, (may_start, may_aim))| Belief {
            title: super::title(&skill.skill),
            believed: believed(skill, may_start != may_aim),
            found: found(skill),
            colour: skill.skill.skill as usize,
            may_aim: if may_start == may_aim { Raster::default() } else { may_aim },
            may_start,
            patches: skill
                .cells
                .iter()
                .map(|cell| Patch { rect: Rect::around(cell.at, half), success: cell.success() })
                .collect(),
        })
        .collect();
    Ok(figures::beliefs(path, &view.map, &beliefs)?)
}

fn believed(skill: &SkillTruth, differ: bool) -> String {
    let score = &skill.score;
    match differ {
        true => format!("may start on {:.1} m², be aimed at on {:.1}", score.may_start, score.may_aim),
        false => format!("may start on {:.1} m²", score.may_start),
    }
}

fn found(skill: &SkillTruth) -> String {
    let score = &skill.score;
    let share = |share: Option<f64>| share.map_or_else(|| "–".to_owned(), |share| format!("{share:.2}"));
    let (precision, recall) = (share(score.precision), share(score.recall));
    format!("succeeds on {:.1} m²; precision {precision}, recall {recall}", score.succeeds)
}
