//! What the end of an episode brings: lessons for every skill, and perhaps a new one.

use std::ops::Range;

use inroads_agents::{Context, Experience, experience::Episode};
use rand::RngExt;

use super::{Aim, Chaining, Gestation, Lessons, OptionReward, Subgoals, lessons::about, skill::observation};
use crate::{Goal, Initiation, Outcome, PolicyOverSkills, SkillId, SkillPolicy, Subgoal, hindsight};

/// A trajectory shorter than this part of a segment brings forth no skill: it began at the event's border, and a
/// set of two or three states would be learned from it (authors' tree code: K/5).
pub(crate) const SHORTEST: u32 = 5;

impl<O, A, I, P, Q, S> Chaining<O, A, I, P, Q, S>
where
    O: AsRef<[f32]> + Clone,
    I: Initiation<O, A>,
    P: SkillPolicy<O, A, S::Goal>,
    Q: PolicyOverSkills<O>,
    S: Aim<O>,
{
    /// An episode is over: every skill may learn from it, and it may bring forth a new one.
    pub(super) fn close(
        &mut self,
        number: u64,
        pursued: &[S::Goal],
        all: &Experience<O, A>,
        ctx: &mut Context,
    ) {
        if self.config.lessons == Lessons::All {
            for k in self.repertoire.learned() {
                self.teach(k, number, 0..all.length(number), all);
            }
            self.teach_goals(number, pursued, all, ctx);
        }
        let Some(gestation) = self.gestate(number, all) else { return };
        let positives = gestation.positives(self.config.segment, all);
        let states: Vec<O> = positives.iter().filter_map(|m| observation(all, *m)).cloned().collect();
        if states.is_empty()
            || self.repertoire.overlap(gestation.subgoal, &states) > self.config.sibling_overlap
        {
            return;
        }
        let k = self.repertoire.born(gestation.subgoal, number, &states);
        self.repertoire.known(k, &positives, &gestation.entered());
        self.policy.born(k);
        let triggers: Vec<O> =
            gestation.before().into_iter().filter_map(|m| observation(all, m)).cloned().collect();
        self.over.grow(&triggers);
        self.teach_past(k, all, ctx);
        self.policy.practise(k, u64::from(self.config.pretrain), all, ctx);
        self.evaluate(k, all, ctx);
    }

    /// Gives skill `k` the lessons that some steps of an episode are about its subgoal.
    pub(super) fn teach(&mut self, k: SkillId, number: u64, steps: Range<u32>, all: &Experience<O, A>) {
        let Some(episode) = all.episode(number) else { return };
        let subgoal = self.repertoire.skill(k).subgoal;
        for lesson in self.repertoire.lessons(subgoal, number, episode, steps, self.config.option_reward) {
            self.repertoire.lesson(k, &lesson);
            if self.subgoals() == Subgoals::Set {
                self.policy.lesson(k, about(lesson));
            }
        }
    }

    /// What an execution teaches its policy: the goal that it went for, the state that it came to (authors' code), and some
    /// of the states on its way.
    pub(super) fn teach_own(&mut self, out: &Outcome<S::Goal>, all: &Experience<O, A>, ctx: &mut Context) {
        let Some(episode) = all.episode(out.episode) else { return };
        let Some(pursued) = &out.call.goal else { return };
        let mut goals = vec![pursued.clone()];
        for i in 0..self.config.hindsight {
            let (first, last) = (out.steps.start + 1, out.steps.end);
            let step = if i == 0 { last } else { ctx.learning.random_range(first..=last) };
            goals.extend(self.aim.at(&episode.observations[step as usize]));
        }
        for goal in &goals {
            self.teach_goal(out.call.skill, goal, out.episode, episode, out.steps.clone());
        }
    }

    /// What a whole episode teaches a policy that is told goals: those that its executions went for, and some of the states
    /// that it came by.
    fn teach_goals(&mut self, number: u64, pursued: &[S::Goal], all: &Experience<O, A>, ctx: &mut Context) {
        let Some(episode) = all.episode(number) else { return };
        if self.subgoals() == Subgoals::Set {
            return;
        }
        let mut goals = pursued.to_vec();
        for _ in 0..self.config.hindsight {
            let achieved = &episode.observations[ctx.learning.random_range(0..episode.observations.len())];
            goals.extend(self.aim.at(achieved).filter(|goal| !goals.contains(goal)));
        }
        for goal in &goals {
            self.teach_goal(SkillId::GLOBAL, goal, number, episode, 0..all.length(number));
        }
    }

    /// What all that is remembered teaches a new skill: its subgoal, or some states of it where policies learn of steps that
    /// others took.
    fn teach_past(&mut self, k: SkillId, all: &Experience<O, A>, ctx: &mut Context) {
        let draws = if self.config.lessons == Lessons::All { self.config.hindsight } else { 0 };
        let goals: Vec<_> = (0..draws).filter_map(|_| self.sampled(k, all, &mut ctx.learning)).collect();
        for past in all.numbers() {
            self.teach(k, past, 0..all.length(past), all);
            let Some(episode) = all.episode(past) else { continue };
            for goal in &goals {
                self.teach_goal(k, goal, past, episode, 0..all.length(past));
            }
        }
    }

    /// What some steps of an episode teach the policy of skill `k` of getting to a goal.
    fn teach_goal(
        &mut self,
        k: SkillId,
        goal: &S::Goal,
        number: u64,
        episode: &Episode<O, A>,
        steps: Range<u32>,
    ) {
        for mut lesson in hindsight::lessons(goal, number, episode, steps) {
            if self.config.option_reward == OptionReward::Dense {
                let afters = lesson.steps.start as usize + 1..=lesson.steps.end as usize;
                let pays = |s| if goal.reached(s) { 0.0 } else { -self.aim.distance(s, goal) };
                lesson.rewards = Some(episode.observations[afters].iter().map(pays).collect());
            }
            self.policy.lesson(k, lesson);
        }
    }

    /// Attributes an episode that began outside every set to the first salient event it met. A gestation that
    /// is complete with it is handed back.
    fn gestate(&mut self, number: u64, all: &Experience<O, A>) -> Option<Gestation> {
        let start = all.episode(number)?.observations.first()?;
        let full = self.repertoire.learned().len() >= self.config.max_skills as usize;
        if full || self.repertoire.covers(start) {
            return None;
        }
        let (subgoal, step) = self.first_event(number, all)?;
        if step + 1 < self.config.segment.div_ceil(SHORTEST) {
            return None;
        }
        // One skill a subgoal at a time: the next one waits until the set of the last has settled.
        let mut siblings = self.repertoire.learned().filter(|&k| self.repertoire.skill(k).subgoal == subgoal);
        if !siblings.all(|k| self.salient(k)) {
            return None;
        }
        let same = |g: &Gestation| g.subgoal == subgoal && self.one_branch(g, start, all);
        let index = self.gestations.iter().position(same).unwrap_or_else(|| {
            self.gestations.push(Gestation::new(subgoal));
            self.gestations.len() - 1
        });
        self.gestations[index].triggers.push((number, 0..step + 1));
        let complete = self.gestations[index].triggers.len() >= self.config.gestation as usize;
        complete.then(|| self.gestations.swap_remove(index))
    }

    /// Whether a trajectory that began at `start` belongs to the same branch of the tree as those of a gestation.
    fn one_branch(&self, gestation: &Gestation, start: &O, all: &Experience<O, A>) -> bool {
        let of_first =
            gestation.triggers.first().and_then(|(number, _)| all.episode(*number)?.observations.first());
        self.config.branch == 0.0
            || of_first.is_none_or(|first| self.repertoire.apart(first, start) <= self.config.branch)
    }

    /// The first salient event that an episode meets, and the step that meets it. Where sets overlap the
    /// youngest is met: it lies farthest from the goal.
    fn first_event(&self, number: u64, all: &Experience<O, A>) -> Option<(Subgoal, u32)> {
        let episode = all.episode(number)?;
        (0..episode.actions.len()).find_map(|step| {
            let after = &episode.observations[step + 1];
            let mut youngest = self.repertoire.learned().rev();
            let entered = youngest.find(|&k| self.salient(k) && self.repertoire.targets(k, after));
            let entered = entered.map(Subgoal::Enter);
            let done = self.repertoire.attained_by(Subgoal::Task, episode, step).then_some(Subgoal::Task);
            let event = if self.config.goal_first { done.or(entered) } else { entered.or(done) };
            event.map(|event| (event, step as u32))
        })
    }
}
