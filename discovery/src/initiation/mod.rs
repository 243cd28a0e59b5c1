//! Initiation sets: where a skill may start (3.1.3), and where another may aim (4.1.1).
//!
//! A family is chosen by configuration, so the trait is usable as `dyn`. Families that only label states implement
//! [`born`](Initiation::born), [`distance`](Initiation::distance), [`outcome`](Initiation::outcome) and
//! [`examples`](Initiation::examples); one that evaluates the skill's policy (chapter 5) also takes lessons, and learns
//! from them after each execution.

mod binary;
mod bonus;
mod dual;
mod examples;
mod ivf;
mod weighted;

pub use binary::Binary;
pub use bonus::Bonus;
pub use dual::Dual;
pub use ivf::{Ivf, IvfConfig};
pub use weighted::{Weighted, WeightedConfig, Weights};

use inroads_agents::{Bag, Checkpoint, Context, Corrupt, Experience, Lesson};

use crate::SkillId;

/// What a skill would do at a state without exploring: π_o, whatever it reads beside the state.
pub type Act<'a, O, A> = dyn Fn(SkillId, &O, &mut Context) -> A + 'a;

/// A family of initiation sets, one a skill. The global option has none: it starts anywhere.
pub trait Initiation<O, A>: Checkpoint {
    /// A new skill `k` begins with states from which its subgoal was reached.
    fn born(&mut self, k: SkillId, positives: &[O]);

    /// Whether skill `k` may start at `s` (optimistic where a family tells the two apart, 4.1.1).
    fn contains(&self, k: SkillId, s: &O) -> bool {
        self.targets(k, s)
    }

    /// Whether another skill may aim at `s` in order to enter `k`'s set (pessimistic).
    fn targets(&self, k: SkillId, s: &O) -> bool {
        self.distance(k, s) <= 0.0
    }

    /// How far `s` is outside what may be aimed at, 0 inside; in the family's own units, for dense rewards (3.1.1).
    fn distance(&self, k: SkillId, s: &O) -> f32;

    /// How probable it is, as far as the family knows, that skill `k` succeeds from `s`; none of one that only tells inside from
    /// outside.
    fn chance(&self, _k: SkillId, _s: &O) -> Option<f32> {
        None
    }

    /// Skill `k` was executed: `states` led to its subgoal, or did not.
    fn outcome(&mut self, k: SkillId, states: &[O], success: bool);

    /// Skill `k` was executed from `s`, and the episode ended before anybody could tell whether it would succeed. Nothing to
    /// a family that counts no executions.
    fn interrupted(&mut self, _k: SkillId, _s: &O) {}

    /// What some steps, whoever took them, teach of skill `k`'s subgoal: whether their last one attained it. Nothing to a
    /// family that labels states only.
    fn lesson(&mut self, _k: SkillId, _lesson: &Lesson) {}

    /// An execution of skill `k` is over, and its lessons are given: time to learn from `all`, in which lessons are ranges,
    /// by the policy as it is now. Nothing to a family that labels states only.
    fn learn(&mut self, _k: SkillId, _all: &Experience<O, A>, _act: &Act<'_, O, A>, _ctx: &mut Context) {}

    /// The number of positive and negative examples that `k`'s set was learned from.
    fn examples(&self, k: SkillId) -> (usize, usize);
}

impl<O, A> Checkpoint for Box<dyn Initiation<O, A>> {
    fn save(&self, bag: &mut Bag) {
        (**self).save(bag);
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        (**self).load(bag)
    }
}

/// A family that the configuration chose.
impl<O, A> Initiation<O, A> for Box<dyn Initiation<O, A>> {
    fn born(&mut self, k: SkillId, positives: &[O]) {
        (**self).born(k, positives);
    }

    fn contains(&self, k: SkillId, s: &O) -> bool {
        (**self).contains(k, s)
    }

    fn targets(&self, k: SkillId, s: &O) -> bool {
        (**self).targets(k, s)
    }

    fn distance(&self, k: SkillId, s: &O) -> f32 {
        (**self).distance(k, s)
    }

    fn chance(&self, k: SkillId, s: &O) -> Option<f32> {
        (**self).chance(k, s)
    }

    fn outcome(&mut self, k: SkillId, states: &[O], success: bool) {
        (**self).outcome(k, states, success);
    }

    fn interrupted(&mut self, k: SkillId, s: &O) {
        (**self).interrupted(k, s);
    }

    fn lesson(&mut self, k: SkillId, lesson: &Lesson) {
        (**self).lesson(k, lesson);
    }

    fn learn(&mut self, k: SkillId, all: &Experience<O, A>, act: &Act<'_, O, A>, ctx: &mut Context) {
        (**self).learn(k, all, act, ctx);
    }

    fn examples(&self, k: SkillId) -> (usize, usize) {
        (**self).examples(k)
    }
}
