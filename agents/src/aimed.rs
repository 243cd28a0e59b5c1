//! A learner alone on its way to one goal, which it reads, so that it can learn of others in hindsight (UVFA, Schaul 2015;
//! HER, Andrychowicz 2017): the flat baseline of chapters 4 and 6.

use serde::{Serialize, de::DeserializeOwned};

use crate::{
    Actor, Agent, Context, Experience, Goal, Learner, Memory, Practice, Transition, checkpoint,
    flat::Greedy,
    hindsight::{self, HindsightConfig, Strategy},
};

/// What a state achieves, as a goal.
pub type Achievement<O, G> = Box<dyn Fn(&O) -> G>;

/// A learner that goes for the task's goal. It is paid by the goal ([`Pay`](crate::experience::Pay)), not by the task, and
/// learns of an episode when that is over.
pub struct Aimed<O, A, G, L> {
    learner: L,
    goal: G,
    achievement: Achievement<O, G>,
    hindsight: HindsightConfig,
    practice: Practice<G>,
    experience: Experience<O, A>,
    memory: Memory,
}

checkpoint!(
    [O, A, G, L] Aimed<O, A, G, L>;
    plain: practice, experience;
    parts: learner;
    where
        O: Serialize + DeserializeOwned,
        A: Serialize + DeserializeOwned,
        G: Serialize + DeserializeOwned,
        L: crate::Checkpoint
);

impl<O: Clone, A: Clone, G: Goal<O>, L: Learner<O, A, G>> Aimed<O, A, G, L> {
    /// An agent on its way to `goal` that remembers about `capacity` steps. `achievement` says which goal a state attains.
    pub fn new(
        learner: L,
        goal: G,
        achievement: Achievement<O, G>,
        hindsight: HindsightConfig,
        practice: Practice<G>,
        capacity: usize,
    ) -> Self {
        let (experience, memory) = (Experience::new(capacity), Memory::new());
        Self { learner, goal, achievement, hindsight, practice, experience, memory }
    }

    /// The episode is over: its steps are lessons about the goal, and about some that it achieved where hindsight wants
    /// lessons.
    fn teach(&mut self, ctx: &mut Context) {
        let number = self.experience.latest();
        let steps = 0..self.experience.length(number);
        let Some(episode) = self.experience.episode(number) else { return };
        for lesson in hindsight::lessons(&self.goal, number, episode, steps.clone()) {
            self.practice.push(lesson);
        }
        if self.hindsight.strategy == Strategy::Achieved {
            let n = self.hindsight.per_episode;
            for goal in hindsight::achieved(episode, &self.achievement, |_| 1.0, n, &mut ctx.learning) {
                // The way to where it was first achieved.
                let first = hindsight::lessons(&goal, number, episode, steps.clone()).into_iter().next();
                first.into_iter().for_each(|lesson| self.practice.push(lesson));
            }
        }
    }
}

impl<O: Clone, A: Clone, G: Goal<O>, L: Learner<O, A, G>> Actor<O, A> for Aimed<O, A, G, L> {
    fn begin(&mut self, s: &O, _: &mut Context) {
        self.memory.clear();
        self.experience.begin(s);
    }

    fn act(&mut self, s: &O, ctx: &mut Context) -> A {
        let number = self.experience.latest();
        if self.practice.replay().notes_at(self.experience.length(number)) {
            self.experience.note(number, &self.memory);
        }
        self.learner.act(&mut self.memory, s, Some(&self.goal), ctx)
    }

    fn observe(&mut self, t: &Transition<O, A>, ctx: &mut Context) {
        self.experience.push(t);
        if t.end.is_some() {
            self.teach(ctx);
        }
        let Self { learner, achievement, hindsight, practice, experience, .. } = self;
        let pay = practice.replay().pay();
        practice.step(learner.batch(), experience, ctx, |clips, ctx| {
            let goals = hindsight.goals(clips, experience, &*achievement, &mut ctx.learning);
            learner.learn(&hindsight::relabelled(clips, &goals, pay), ctx)
        });
    }
}

impl<O, A, G, L> Agent<O, A> for Aimed<O, A, G, L>
where
    O: Clone + Serialize + DeserializeOwned,
    A: Clone + Serialize + DeserializeOwned,
    G: Goal<O>,
    L: Learner<O, A, G>,
{
    fn frozen(&self) -> Box<dyn Actor<O, A> + '_> {
        Box::new(Greedy::new(&self.learner, Some(&self.goal)))
    }

    fn updates(&self) -> Vec<(&'static str, u64)> {
        vec![("policy", self.practice.updates())]
    }
}
