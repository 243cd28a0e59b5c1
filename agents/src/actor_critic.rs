//! What the learners of deterministic policies have in common: DDPG and TD3.

use crate::encode::Inputs;
use crate::nets::Batch;
use crate::{Clip, Encode};

/// y = r + γ(1−d)·v, row by row, where v is what each clip's last observation is worth.
pub(crate) fn targets<O, A, G>(clips: &[Clip<O, A, G>], discount: f32, next: &[f32]) -> Vec<f32> {
    let returns = clips.iter().map(|clip| clip.discounted(discount));
    returns.zip(next).map(|((reward, discount), value)| reward + discount * value).collect()
}

/// Where clips begin, what was done there, what it turned out to be worth, and what each counts.
pub(crate) fn batch<O, G: Encode>(
    inputs: &Inputs<O>,
    clips: &[Clip<O, Vec<f32>, G>],
    targets: Vec<f32>,
) -> Batch {
    Batch {
        states: inputs.rows(clips.iter().map(|clip| (clip.first(), clip.goal))),
        actions: clips.iter().flat_map(|clip| &clip.actions[clip.lead]).copied().collect(),
        targets,
        weights: clips.iter().map(|clip| clip.weight).collect(),
    }
}

/// Whether settings are possible; an error names the setting and the mend.
pub(crate) mod check {
    pub(crate) fn sizes(hidden: &[usize], batch: usize) -> Result<(), String> {
        if hidden.is_empty() || hidden.contains(&0) {
            return Err(format!("hidden is {hidden:?}; name at least one layer, and none of width 0"));
        }
        if batch == 0 {
            return Err("batch is 0; an update needs at least one clip".into());
        }
        Ok(())
    }

    pub(crate) fn positive(settings: &[(&str, f32)]) -> Result<(), String> {
        all(settings, |x| x.is_finite() && x > 0.0, "be a number above 0")
    }

    pub(crate) fn shares(settings: &[(&str, f32)]) -> Result<(), String> {
        all(settings, |x| (0.0..=1.0).contains(&x), "lie in [0, 1]")
    }

    pub(crate) fn prices(settings: &[(&str, f32)]) -> Result<(), String> {
        all(settings, |x| x.is_finite() && x >= 0.0, "be 0 (none) or a number above")
    }

    fn all(settings: &[(&str, f32)], fine: impl Fn(f32) -> bool, must: &str) -> Result<(), String> {
        match settings.iter().find(|(_, value)| !fine(*value)) {
            Some((name, value)) => Err(format!("{name} is {value}; it must {must}")),
            None => Ok(()),
        }
    }
}
