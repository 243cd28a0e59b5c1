//! No learned policy over options: the chain is scanned from the goal outwards (authors' code of chapters 4 and 6).

use inroads_agents::{Context, Experience, checkpoint};

use super::{Choice, PolicyOverSkills};
use crate::SkillId;

/// Calls the admissible skill that was learned first, which is the nearest to the goal; a primitive action only where no
/// learned skill may start.
#[derive(Clone, Copy, Debug, Default)]
pub struct Scan;

checkpoint!([] Scan; plain: ; parts: );

impl<O> PolicyOverSkills<O> for Scan {
    fn choose(&self, _: &O, admissible: &[SkillId], _: &mut Context) -> SkillId {
        let learned = admissible.iter().copied().filter(|k| *k != SkillId::GLOBAL);
        learned.min().unwrap_or(SkillId::GLOBAL)
    }

    fn record<A>(&mut self, _: Choice, _: &Experience<O, A>) {}

    fn learn<A>(&mut self, _: &Experience<O, A>, _: &dyn Fn(&O) -> Vec<SkillId>, _: &mut Context) {}

    fn grow(&mut self, _: &[O]) {}

    fn values(&self, _: &O) -> Vec<f32> {
        Vec::new()
    }

    fn updates(&self) -> u64 {
        0
    }
}
