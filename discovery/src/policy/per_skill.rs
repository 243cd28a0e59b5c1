//! A policy of its own for every skill, as chapter 3 has it.

use inroads_agents::{
    Bag, Checkpoint, Clip, Context, Corrupt, Experience, Learner, Lesson, Memory, Pace, Replay,
};

use super::SkillPolicy;
use crate::{Call, SkillId};

/// A learner of its own for every skill, as chapter 3 has it.
pub struct PerSkill<L> {
    members: Vec<Member<L>>,
    blank: L,
    /// Makes a skill's learner of the global option's.
    fork: fn(&L) -> L,
    pace: Pace,
    capacity: usize,
}

struct Member<L> {
    learner: L,
    replay: Replay,
    steps: u64,
    updates: u64,
}

impl<L: Clone> PerSkill<L> {
    /// A family with the global option's policy only. A new skill begins with `fork` of it, which is a clone as
    /// far as the weights go (3.1.2). Each skill remembers about `capacity` steps of lessons.
    pub fn new(global: L, fork: fn(&L) -> L, capacity: usize, pace: Pace) -> Self {
        let blank = global.clone();
        let member = Member { learner: global, replay: Replay::new(capacity), steps: 0, updates: 0 };
        Self { members: vec![member], blank, fork, pace, capacity }
    }
}

impl<O, A, G, L: Learner<O, A, ()> + Clone> SkillPolicy<O, A, G> for PerSkill<L> {
    fn born(&mut self, k: SkillId) {
        assert_eq!(k.index(), self.members.len(), "skills are born in the order of their numbers");
        let learner = (self.fork)(&self.members[0].learner);
        self.members.push(Member { learner, replay: Replay::new(self.capacity), steps: 0, updates: 0 });
    }

    fn act(&self, memory: &mut Memory, call: &Call<G>, s: &O, ctx: &mut Context) -> A {
        self.members[call.skill.index()].learner.act(memory, s, None, ctx)
    }

    fn values(&self, memory: &Memory, s: &O, calls: &[(SkillId, Option<&G>)]) -> Vec<f32> {
        calls.iter().flat_map(|(k, _)| self.members[k.index()].learner.values(memory, s, &[None])).collect()
    }

    fn lesson(&mut self, k: SkillId, lesson: Lesson<G>) {
        self.members[k.index()].replay.push(lesson.without_goal());
    }

    fn practise(&mut self, k: SkillId, updates: u64, all: &Experience<O, A>, ctx: &mut Context) {
        let member = &mut self.members[k.index()];
        member.replay.forget_before(all.first());
        let batch = member.learner.batch();
        if updates == 0 || member.replay.len() < batch {
            return;
        }
        let mut clips: Vec<Clip<O, A, ()>> = Vec::with_capacity(batch);
        for _ in 0..updates {
            member.replay.sample(all, batch, &mut ctx.learning, &mut clips);
            member.learner.learn(&clips, ctx);
            member.updates += 1;
        }
    }

    fn step(&mut self, k: SkillId, all: &Experience<O, A>, ctx: &mut Context) {
        let member = &mut self.members[k.index()];
        member.steps += 1;
        let due = self.pace.due(member.steps);
        if k != SkillId::GLOBAL || member.replay.len() >= self.pace.warm_up {
            SkillPolicy::<O, A, G>::practise(self, k, due, all, ctx);
        }
    }

    fn updates(&self) -> u64 {
        self.members.iter().map(|m| m.updates).sum()
    }
}

impl<L: Checkpoint + Clone> Checkpoint for PerSkill<L> {
    fn save(&self, bag: &mut Bag) {
        bag.put("members", &self.members.len());
        for (i, member) in self.members.iter().enumerate() {
            bag.put_part(&format!("{i}.learner"), &member.learner);
            bag.put(&format!("{i}.replay"), &member.replay);
            bag.put(&format!("{i}.counts"), &(member.steps, member.updates));
        }
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        self.members.clear();
        for i in 0..bag.get::<usize>("members")? {
            let mut learner = if i == 0 { self.blank.clone() } else { (self.fork)(&self.blank) };
            bag.get_part(&format!("{i}.learner"), &mut learner)?;
            let replay = bag.get(&format!("{i}.replay"))?;
            let (steps, updates) = bag.get(&format!("{i}.counts"))?;
            self.members.push(Member { learner, replay, steps, updates });
        }
        Ok(())
    }
}
