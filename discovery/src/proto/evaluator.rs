//! The proto-goal evaluator: which goals are plausible (thesis 8.3.1).

use inroads_agents::{Encoder, Experience};
use inroads_envs::{Annotated, Rng};

use super::{
    GoalId, GoalSpace, ProtoConfig,
    plausible::{Judgement, Plausibility},
    space::Candidate,
};
use crate::{
    Wanted,
    record::{GoalRecord, GoalState},
};

/// What an evaluation says of a goal that was observed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    /// Whether it is reachable (8.1) and controllable (8.2), or nobody knows: then the best is assumed (footnote 2).
    pub plausible: bool,
    /// h(g), its timescale: the mean value of seeking it, in [0, 1]; 0 when nobody knows (8.4.1.1).
    pub timescale: f32,
}

/// Judges goals by what seeking and avoiding them is worth, as far as the experience tells (thesis 8.3.1).
pub trait SeekAvoid<O, A> {
    /// A verdict on each of these goals, which were all observed. The experience has a step or more.
    fn judge(&self, all: &Experience<Annotated<O>, A>, goals: &[Wanted], rng: &mut Rng) -> Vec<Verdict>;
}

/// By least-squares policy iteration on a batch of the experience (8.3.1.1).
pub struct LeastSquares<E> {
    plausibility: Plausibility,
    encoder: E,
    choices: usize,
}

impl<E> LeastSquares<E> {
    /// A judge of the proto-goals of a domain with this many actions, whose observations `encoder` writes as numbers.
    pub fn new(plausibility: Plausibility, encoder: E, choices: usize) -> Self {
        Self { plausibility, encoder, choices }
    }
}

impl<O, E: Encoder<O>> SeekAvoid<O, usize> for LeastSquares<E> {
    fn judge(&self, all: &Experience<Annotated<O>, usize>, goals: &[Wanted], rng: &mut Rng) -> Vec<Verdict> {
        let observed = vec![1; goals.len()];
        let judged = self.plausibility.judge(all, &self.encoder, self.choices, goals, &observed, rng);
        // Features without a Gram matrix say nothing about any goal.
        let judged = judged.map_or_else(|_| vec![Judgement::Absent; goals.len()], |judged| judged.goals);
        let verdict = |judgement: Judgement| Verdict {
            plausible: self.plausibility.accepts(&judgement),
            timescale: if let Judgement::Estimated(found) = judgement { found.seek } else { 0.0 },
        };
        judged.into_iter().map(verdict).collect()
    }
}

/// Judges every goal that was observed.
pub(super) fn evaluate<O, A>(
    space: &mut GoalSpace,
    judge: &impl SeekAvoid<O, A>,
    all: &Experience<Annotated<O>, A>,
    rng: &mut Rng,
) {
    let observed: Vec<GoalId> = space.iter().filter(|(_, goal)| goal.seen > 0).map(|(id, _)| id).collect();
    let wanted: Vec<_> = observed.iter().map(|id| space.goal(*id).wanted.clone()).collect();
    for (id, verdict) in observed.into_iter().zip(judge.judge(all, &wanted, rng)) {
        let goal = space.goal_mut(id);
        (goal.plausible, goal.timescale) = (Some(verdict.plausible), verdict.timescale);
    }
}

/// The goal space as plain data.
pub fn records(space: &GoalSpace, config: &ProtoConfig) -> Vec<GoalRecord> {
    let record = |(_, goal): (GoalId, &Candidate)| GoalRecord {
        bits: goal.wanted.0.ones().map(|bit| bit as u32).collect(),
        state: match goal.plausible {
            None => GoalState::Unseen,
            Some(false) => GoalState::Pruned,
            Some(true) if goal.pursuits.mastered(config.mastery) => GoalState::Mastered,
            Some(true) => GoalState::Plausible,
        },
        attained: goal.attained,
        pursued: goal.pursuits.count(),
        success: goal.pursuits.success(),
    };
    space.iter().map(record).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use inroads_envs::{Bits, Seed};

    /// Says this of goals, by their first bit.
    struct Known(Vec<Verdict>);

    impl SeekAvoid<(), usize> for Known {
        fn judge(&self, _: &Experience<Annotated<()>, usize>, goals: &[Wanted], _: &mut Rng) -> Vec<Verdict> {
            goals.iter().map(|goal| self.0[goal.0.ones().next().unwrap()]).collect()
        }
    }

    #[test]
    fn a_goal_is_unseen_pruned_plausible_or_mastered() {
        let mut seen = Bits::new(4);
        (0..3).for_each(|bit| seen.set(bit));
        let mut space = GoalSpace::new(1);
        space.count(&Bits::new(4), &seen, 0.0);
        let config = ProtoConfig::default();
        let states = |space: &GoalSpace| {
            records(space, &config).into_iter().map(|goal| goal.state).collect::<Vec<_>>()
        };
        use GoalState::{Mastered, Plausible, Pruned, Unseen};
        assert_eq!(states(&space), [Unseen; 4], "before the first evaluation");
        let verdict = |plausible, timescale| Verdict { plausible, timescale };
        let known =
            Known(vec![verdict(true, 0.5), verdict(false, 0.25), verdict(true, 0.0), verdict(true, 1.0)]);
        evaluate(&mut space, &known, &Experience::new(1), &mut Seed(0).stream("test", 0));
        assert_eq!(states(&space), [Plausible, Pruned, Plausible, Unseen]);
        space.goal_mut(GoalId(0)).pursuits.push(true);
        space.goal_mut(GoalId(1)).pursuits.push(true);
        assert_eq!(states(&space), [Mastered, Pruned, Plausible, Unseen]);
        let timescales: Vec<_> = space.iter().map(|(_, goal)| goal.timescale).collect();
        assert_eq!(timescales, [0.5, 0.25, 0.0, 0.0]);
    }
}
