//! A policy of its own for every skill, as chapter 3 has it.

use inroads_agents::{
    Bag, Checkpoint, Context, Corrupt, Experience, Learner, Lesson, Memory, Pace, Practice, Replay,
};

use super::SkillPolicy;
use crate::{Call, SkillId};

/// A learner of its own for every skill, as chapter 3 has it.
pub struct PerSkill<L> {
    members: Vec<Member<L>>,
    blank: L,
    /// Makes a skill's learner of the global option's.
    fork: fn(&L) -> L,
    /// Of a skill that was not executed yet. It waits for no warm-up: somebody has explored for it.
    fresh: Practice,
}

struct Member<L> {
    learner: L,
    practice: Practice,
}

impl<L: Clone> PerSkill<L> {
    /// A family with the global option's policy only. A new skill begins with `fork` of it, which is a clone as
    /// far as the weights go (3.1.2). Each skill remembers about `capacity` steps of lessons.
    pub fn new(global: L, fork: fn(&L) -> L, capacity: usize, pace: Pace) -> Self {
        let blank = global.clone();
        let practice = |pace| Practice::new(Replay::new(capacity), pace);
        let members = vec![Member { learner: global, practice: practice(pace) }];
        Self { members, blank, fork, fresh: practice(Pace { warm_up: 0, ..pace }) }
    }
}

impl<O, A, G, L: Learner<O, A, ()> + Clone> SkillPolicy<O, A, G> for PerSkill<L> {
    fn born(&mut self, k: SkillId) {
        assert_eq!(k.index(), self.members.len(), "skills are born in the order of their numbers");
        let learner = (self.fork)(&self.members[0].learner);
        self.members.push(Member { learner, practice: self.fresh.clone() });
    }

    fn act(&self, memory: &mut Memory, call: &Call<G>, s: &O, ctx: &mut Context) -> A {
        self.members[call.skill.index()].learner.act(memory, s, None, ctx)
    }

    fn values(&self, memory: &Memory, s: &O, calls: &[(SkillId, Option<&G>)]) -> Vec<f32> {
        calls.iter().flat_map(|(k, _)| self.members[k.index()].learner.values(memory, s, &[None])).collect()
    }

    fn lesson(&mut self, k: SkillId, lesson: Lesson<G>) {
        self.members[k.index()].practice.push(lesson.without_goal());
    }

    fn practise(&mut self, k: SkillId, updates: u64, all: &Experience<O, A>, ctx: &mut Context) {
        let Member { learner, practice } = &mut self.members[k.index()];
        practice.practise(updates, learner.batch(), all, ctx, |clips, ctx| learner.learn(clips, ctx));
    }

    fn step(&mut self, k: SkillId, all: &Experience<O, A>, ctx: &mut Context) {
        let Member { learner, practice } = &mut self.members[k.index()];
        practice.step(learner.batch(), all, ctx, |clips, ctx| learner.learn(clips, ctx));
    }

    fn updates(&self) -> u64 {
        self.members.iter().map(|m| m.practice.updates()).sum()
    }
}

impl<L: Checkpoint + Clone> Checkpoint for PerSkill<L> {
    fn save(&self, bag: &mut Bag) {
        bag.put("members", &self.members.len());
        for (i, member) in self.members.iter().enumerate() {
            bag.put_part(&format!("{i}.learner"), &member.learner);
            bag.put(&format!("{i}.practice"), &member.practice);
        }
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        self.members.clear();
        for i in 0..bag.get::<usize>("members")? {
            let mut learner = if i == 0 { self.blank.clone() } else { (self.fork)(&self.blank) };
            bag.get_part(&format!("{i}.learner"), &mut learner)?;
            self.members.push(Member { learner, practice: bag.get(&format!("{i}.practice"))? });
        }
        Ok(())
    }
}
