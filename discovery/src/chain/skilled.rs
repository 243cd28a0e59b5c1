//! What pictures and tables are drawn from.

use inroads_agents::Actor;
use serde::{Serialize, de::DeserializeOwned};

use super::{Aim, Chaining, Lane, trial::OneCall};
use crate::{
    Hierarchy, Initiation, PolicyOverSkills, SkillId, SkillPolicy, SkillRecord, Skilled, Subgoal,
    record::Trial,
};

impl<O, A, I, P, Q, S> Skilled<O, A> for Hierarchy<O, A, Chaining<O, A, I, P, Q, S>>
where
    O: AsRef<[f32]> + Clone + Serialize + DeserializeOwned,
    A: Clone + Serialize + DeserializeOwned,
    I: Initiation<O, A>,
    P: SkillPolicy<O, A, S::Goal>,
    Q: PolicyOverSkills<O>,
    S: Aim<O>,
{
    fn skills(&self) -> Vec<SkillRecord> {
        let repertoire = &self.method().repertoire;
        repertoire
            .learned()
            .map(|k| {
                let skill = repertoire.skill(k);
                SkillRecord {
                    skill: k.0,
                    enters: match skill.subgoal {
                        Subgoal::Task => None,
                        Subgoal::Enter(parent) => Some(parent.0),
                    },
                    phase: skill.phase,
                    born: skill.born,
                    executions: skill.executions,
                    successes: skill.successes,
                    examples: repertoire.examples(k),
                }
            })
            .collect()
    }

    fn members(&self, s: &O) -> Vec<bool> {
        let repertoire = &self.method().repertoire;
        repertoire.learned().map(|k| repertoire.contains(k, s)).collect()
    }

    fn targets(&self, s: &O) -> Vec<bool> {
        let repertoire = &self.method().repertoire;
        repertoire.learned().map(|k| repertoire.targets(k, s)).collect()
    }

    fn chances(&self, s: &O) -> Vec<Option<f32>> {
        let repertoire = &self.method().repertoire;
        repertoire.learned().map(|k| repertoire.chance(k, s)).collect()
    }

    fn one_call(&self, skill: u32) -> Option<Box<dyn Trial<O, A> + '_>> {
        let known = self.method().repertoire.learned().any(|k| k == SkillId(skill));
        known.then(|| Box::new(OneCall::new(self.method(), self.experience(), SkillId(skill))) as _)
    }

    fn chain_alone(&self) -> Option<Box<dyn Actor<O, A> + '_>> {
        let any = self.method().repertoire.learned().len() > 0;
        any.then(|| self.watch(Lane { chain_alone: true, ..Lane::default() }))
    }
}
