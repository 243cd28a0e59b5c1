//! Which state of its subgoal an execution goes for (4.1.2).
//!
//! For robustness one of the states that the parent is known to succeed from. For hierarchical optimality the one from
//! which the rest of the chain is worth most: dynamic programming distributes the value of the task's goal over the
//! states β̂ₖ in which each skill triggered its subgoal,
//!
//! ```text
//! Ṽₖ(g) = max over g′ in β̂ₚ of V(g, g′) · Ṽₚ(g′), p the parent of k;    Ṽ = 1 at the task's goal
//! ```
//!
//! and at `s` skill `k` goes for the `g` in β̂ₖ with the greatest Q̃(s, g) = V(s, g) · Ṽₖ(g). V(s, g) is the policy's value of
//! getting from `s` to `g`: with attainment paid it is the discounted probability of it, so legs multiply, and Q̃ is the
//! discounted probability of arriving at the task's goal that way. (The authors add costs, whose value of a pair that was
//! never tried would be the best of all in a table.)

use inroads_agents::{Context, Experience, Memory, draw::argmax};
use inroads_envs::Rng;

use super::{
    Aim, Chaining, Explore, Subgoals,
    aim::any,
    skill::{Moment, observation},
};
use crate::{Goal, Initiation, PolicyOverSkills, SkillId, SkillPolicy, Subgoal};

/// Draws of a subgoal state before one outside the set is taken: a set's examples may lie outside of it (seen by the
/// authors too, whose code draws up to 200 times).
const DRAWS: usize = 32;

/// Ṽₖ over β̂ₖ, by skill.
#[derive(Clone, Debug)]
pub(super) struct Values<G>(Vec<Vec<(G, f32)>>);

impl<O, A, I, P, Q, S> Chaining<O, A, I, P, Q, S>
where
    O: AsRef<[f32]> + Clone,
    I: Initiation<O, A>,
    P: SkillPolicy<O, A, S::Goal>,
    Q: PolicyOverSkills<O>,
    S: Aim<O>,
{
    /// What executions go for: whole sets where nobody is told more.
    pub(super) fn subgoals(&self) -> Subgoals {
        if S::TELLS { self.config.subgoals } else { Subgoals::Set }
    }

    /// The state of its subgoal that skill `k` goes for when it is called at `s`; none where its policy is not told.
    pub(super) fn pursue(
        &self,
        k: SkillId,
        s: &O,
        values: &mut Option<Values<S::Goal>>,
        all: &Experience<O, A>,
        ctx: &mut Context,
    ) -> Option<S::Goal> {
        if k == SkillId::GLOBAL {
            return match self.config.explore {
                Explore::Task => None,
                Explore::Events => self.nearest(s, all, &mut ctx.acting),
            };
        }
        match self.subgoals() {
            Subgoals::Set => None,
            Subgoals::Sample => self.sample(k, all, &mut ctx.acting),
            Subgoals::DynamicProgramming => {
                let values = values.get_or_insert_with(|| self.distribute(all));
                let row = &values.0[k.index()];
                let worth: Vec<_> = row.iter().map(|(g, rest)| self.leg(s, k, g) * rest).collect();
                match worth.is_empty() {
                    true => self.sample(k, all, &mut ctx.acting),
                    false => Some(row[argmax(&worth, &mut ctx.acting)].0.clone()),
                }
            }
        }
    }

    /// A state of the nearest salient event: by the median distance of the states that a skill is known to succeed from, as
    /// the authors have it, or by that of the task's goal. Where the task's goal is no state to go for, its skill's are.
    fn nearest(&self, s: &O, all: &Experience<O, A>, rng: &mut Rng) -> Option<S::Goal> {
        let far = |moment: &Moment| Some(self.aim.distance(s, &self.aim.at(observation(all, *moment)?)?));
        let median = |k: SkillId| {
            let mut far: Vec<f32> = self.repertoire.skill(k).positives.iter().filter_map(far).collect();
            far.sort_by(f32::total_cmp);
            far.get(far.len() / 2).copied()
        };
        let skills = self.repertoire.learned().filter(|k| self.salient(*k));
        let events = skills.filter_map(|k| Some((median(k)?, Some(k))));
        let task = self.aim.task().map(|goal| (self.aim.distance(s, &goal), None));
        let (_, nearest) = events.chain(task).min_by(|(a, _), (b, _)| a.total_cmp(b))?;
        match nearest {
            None => self.aim.task(),
            Some(k) => self.example(Subgoal::Enter(k), &self.repertoire.skill(k).positives, all, rng),
        }
    }

    /// One of the states that skill `k` might go for, at random; none where its policy is not told.
    pub(super) fn sampled(&self, k: SkillId, all: &Experience<O, A>, rng: &mut Rng) -> Option<S::Goal> {
        match self.subgoals() {
            Subgoals::Set => None,
            Subgoals::Sample | Subgoals::DynamicProgramming => self.sample(k, all, rng),
        }
    }

    /// A state that skill `k` is to reach: the task's goal, if it is one; else one in which the task was done, or one that the
    /// parent is known to succeed from and that may still be aimed at.
    fn sample(&self, k: SkillId, all: &Experience<O, A>, rng: &mut Rng) -> Option<S::Goal> {
        let subgoal = self.repertoire.skill(k).subgoal;
        match subgoal {
            Subgoal::Task => {
                self.aim.task().or_else(|| self.example(subgoal, &self.repertoire.skill(k).effects, all, rng))
            }
            Subgoal::Enter(parent) => {
                self.example(subgoal, &self.repertoire.skill(parent).positives, all, rng)
            }
        }
    }

    /// One of these states at random, preferably one inside the subgoal.
    fn example(
        &self,
        subgoal: Subgoal,
        of: &[Moment],
        all: &Experience<O, A>,
        rng: &mut Rng,
    ) -> Option<S::Goal> {
        let mut drawn = None;
        for _ in 0..DRAWS {
            let Some(s) = any(of, rng).and_then(|moment| observation(all, *moment)) else { continue };
            drawn = Some(s);
            if self.may_aim(subgoal, s) {
                break;
            }
        }
        self.aim.at(drawn?)
    }

    /// Whether `s` is still inside a subgoal. The task's is where it was done.
    fn may_aim(&self, subgoal: Subgoal, s: &O) -> bool {
        subgoal == Subgoal::Task || self.repertoire.inside(subgoal, s)
    }

    /// V(s, g): what getting from `s` to `g` is worth to skill `k`.
    fn leg(&self, s: &O, k: SkillId, g: &S::Goal) -> f32 {
        match g.reached(s) {
            true => 1.0,
            false => self.aim.probability(self.policy.values(&Memory::new(), s, &[(k, Some(g))])[0]),
        }
    }

    /// Ṽₖ of all skills. A parent is older than its children, so one pass from the oldest is enough.
    fn distribute(&self, all: &Experience<O, A>) -> Values<S::Goal> {
        let mut values: Vec<Vec<(S::Goal, f32)>> = vec![Vec::new()];
        for k in self.repertoire.learned() {
            let skill = self.repertoire.skill(k);
            let mut row: Vec<(S::Goal, f32)> = Vec::new();
            if let (Subgoal::Task, Some(goal)) = (skill.subgoal, self.aim.task()) {
                values.push(vec![(goal, 1.0)]);
                continue;
            }
            let known = |moment: &Moment| observation(all, *moment);
            for s in skill.effects.iter().filter_map(known).filter(|s| self.may_aim(skill.subgoal, s)) {
                let Some(goal) = self.aim.at(s) else { continue };
                if row.iter().any(|(known, _)| *known == goal) {
                    continue;
                }
                let rest = match skill.subgoal {
                    Subgoal::Task => 1.0,
                    Subgoal::Enter(parent) => {
                        let legs = values[parent.index()].iter();
                        legs.map(|(g, rest)| self.leg(s, parent, g) * rest).fold(0.0, f32::max)
                    }
                };
                row.push((goal, rest));
            }
            values.push(row);
        }
        Values(values)
    }
}
