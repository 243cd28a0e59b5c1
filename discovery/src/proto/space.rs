//! The goal space: every goal that was ever thought of, and what has become of it (thesis 8.2).

use std::collections::BTreeMap;

use inroads_envs::Bits;
use serde::{Deserialize, Serialize};

use super::mastery::Pursuits;
use crate::Wanted;

/// A goal's number: that of the proto-goal for goals of one, higher for combinations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct GoalId(pub u32);

impl GoalId {
    /// The number as an index.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A goal and all that is known of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// What must hold.
    pub wanted: Wanted,
    /// Steps after which it held.
    pub seen: u64,
    /// N(g): steps that made it hold.
    pub attained: u64,
    /// Sum of the task's rewards of those steps.
    pub reward: f64,
    /// What came of pursuing it.
    pub pursuits: Pursuits,
    /// What the latest evaluation said; nothing before the first one that had seen it.
    pub plausible: Option<bool>,
    /// h(g): the mean value of seeking it; 0 when the evaluation's batch knew nothing of it.
    pub timescale: f32,
}

impl Candidate {
    fn new(wanted: Wanted, window: usize) -> Self {
        let pursuits = Pursuits::new(window);
        Self { wanted, seen: 0, attained: 0, reward: 0.0, pursuits, plausible: None, timescale: 0.0 }
    }

    /// Whether it may be pursued.
    pub fn is_plausible(&self) -> bool {
        self.plausible == Some(true)
    }

    /// R(g): mean of the task's rewards of the steps that attained it.
    pub fn mean_reward(&self) -> f64 {
        if self.attained == 0 { 0.0 } else { self.reward / self.attained as f64 }
    }
}

/// All goals, those of one proto-goal first.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GoalSpace {
    goals: Vec<Candidate>,
    /// Combinations by the lowest of their bits: only those whose bit is set need a look.
    combinations: Vec<BTreeMap<Bits, GoalId>>,
    /// Latest pursuits that mastery is judged by.
    window: usize,
}

impl GoalSpace {
    /// A space of no goals yet; how many proto-goals there are, the first observation tells.
    pub fn new(window: usize) -> Self {
        Self { window, ..Self::default() }
    }

    /// How many goals there are.
    pub fn len(&self) -> usize {
        self.goals.len()
    }

    /// Whether there is none: before the first step.
    pub fn is_empty(&self) -> bool {
        self.goals.is_empty()
    }

    /// How many proto-goals the domain has.
    pub fn proto_goals(&self) -> usize {
        self.combinations.len()
    }

    /// All of them, by number.
    pub fn iter(&self) -> impl Iterator<Item = (GoalId, &Candidate)> {
        (0..).map(GoalId).zip(&self.goals)
    }

    /// One of them.
    pub fn goal(&self, id: GoalId) -> &Candidate {
        &self.goals[id.index()]
    }

    /// One of them, to be changed.
    pub(super) fn goal_mut(&mut self, id: GoalId) -> &mut Candidate {
        &mut self.goals[id.index()]
    }

    /// The combination of these proto-goals, when it was thought of already.
    pub fn find(&self, bits: &Bits) -> Option<GoalId> {
        let mut ones = bits.ones();
        let lowest = ones.next()?;
        if ones.next().is_none() {
            return Some(GoalId(lowest as u32));
        }
        self.combinations[lowest].get(bits).copied()
    }

    /// Adds a combination of two or more proto-goals that is not there yet.
    pub(super) fn add(&mut self, wanted: Wanted) {
        let id = GoalId(self.goals.len() as u32);
        let lowest = wanted.0.ones().next();
        if let Some(lowest) = lowest {
            self.combinations[lowest].insert(wanted.0.clone(), id);
            self.goals.push(Candidate::new(wanted, self.window));
        }
    }

    /// The goals that hold, by number; none before the first step was counted.
    pub fn holding(&self, bits: &Bits) -> Vec<GoalId> {
        if self.is_empty() {
            return Vec::new();
        }
        let mut holding: Vec<_> = bits.ones().map(|bit| GoalId(bit as u32)).collect();
        for bit in bits.ones() {
            let held = self.combinations[bit].iter().filter(|(wanted, _)| bits.contains(wanted));
            holding.extend(held.map(|(_, id)| *id));
        }
        holding.sort_unstable();
        holding
    }

    /// The goals that a step attains: they hold after it, and did not before (`decisions.md`).
    pub fn attained(&self, before: &Bits, after: &Bits) -> Vec<GoalId> {
        let mut attained = self.holding(after);
        attained.retain(|id| !before.contains(&self.goal(*id).wanted.0));
        attained
    }

    /// Counts a step. The first one tells how many proto-goals there are.
    pub(super) fn count(&mut self, before: &Bits, after: &Bits, reward: f32) {
        if self.is_empty() {
            self.combinations = vec![BTreeMap::new(); after.len()];
            for bit in 0..after.len() {
                let mut bits = Bits::new(after.len());
                bits.set(bit);
                self.goals.push(Candidate::new(Wanted(bits), self.window));
            }
        }
        for id in self.holding(after) {
            self.goals[id.index()].seen += 1;
        }
        for id in self.attained(before, after) {
            let goal = &mut self.goals[id.index()];
            goal.attained += 1;
            goal.reward += f64::from(reward);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(crate) fn bits(of: usize, ones: &[usize]) -> Bits {
        let mut bits = Bits::new(of);
        ones.iter().for_each(|bit| bits.set(*bit));
        bits
    }

    #[test]
    fn a_step_attains_what_holds_after_it_and_not_before() {
        let mut space = GoalSpace::new(3);
        space.count(&bits(4, &[0]), &bits(4, &[0, 1]), 0.5);
        assert_eq!((space.len(), space.proto_goals()), (4, 4));
        space.add(Wanted(bits(4, &[0, 1])));
        space.add(Wanted(bits(4, &[1, 2])));
        assert_eq!(space.find(&bits(4, &[1, 2])), Some(GoalId(5)));
        assert_eq!((space.find(&bits(4, &[2])), space.find(&bits(4, &[0, 2]))), (Some(GoalId(2)), None));
        assert_eq!(space.holding(&bits(4, &[0, 1])), [GoalId(0), GoalId(1), GoalId(4)]);
        assert_eq!(space.attained(&bits(4, &[1]), &bits(4, &[0, 1])), [GoalId(0), GoalId(4)]);
        space.count(&bits(4, &[1]), &bits(4, &[0, 1]), 1.0);
        let counts: Vec<_> = space.iter().map(|(_, g)| (g.seen, g.attained, g.mean_reward())).collect();
        assert_eq!(
            counts,
            [(2, 1, 1.0), (2, 1, 0.5), (0, 0, 0.0), (0, 0, 0.0), (1, 1, 1.0), (0, 0, 0.0)],
            "the combination was thought of after the first step"
        );
    }
}
