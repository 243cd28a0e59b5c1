//! Option policies (3.1.1, 4.1.2): one network each, one for all, or a controller that somebody has written.

mod given;
mod per_skill;
mod shared;

pub use given::Given;
pub use per_skill::PerSkill;
pub use shared::Shared;

use inroads_agents::{Checkpoint, Context, Experience, Lesson, Memory};

use crate::{Call, SkillId};

/// A family of option policies. `G` is what a policy reads to know its skill's subgoal, `()` where each skill has a
/// policy of its own.
pub trait SkillPolicy<O, A, G>: Checkpoint {
    /// A new skill `k` begins; where it gets a policy of its own, with a copy of the global option's (3.1.2).
    fn born(&mut self, k: SkillId);

    /// The called skill's action at `s`.
    fn act(&self, memory: &mut Memory, call: &Call<G>, s: &O, ctx: &mut Context) -> A;

    /// What `s` is worth to each of these skills, called for these goals.
    fn values(&self, memory: &Memory, s: &O, calls: &[(SkillId, Option<&G>)]) -> Vec<f32>;

    /// Something for skill `k` to learn from.
    fn lesson(&mut self, k: SkillId, lesson: Lesson<G>);

    /// Minibatch updates of skill `k`'s policy; none while it has too few lessons.
    fn practise(&mut self, k: SkillId, updates: u64, all: &Experience<O, A>, ctx: &mut Context);

    /// The updates that one more step of skill `k` makes due; none before the policy has warmed up.
    fn step(&mut self, k: SkillId, all: &Experience<O, A>, ctx: &mut Context);

    /// Updates made so far, over all skills.
    fn updates(&self) -> u64;
}
