//! The skills that there are: where they may start, where they end, and what was counted of them.

use std::marker::PhantomData;

use inroads_agents::{Checkpoint, Context, Experience, Lesson, checkpoint, experience::Episode};
use inroads_envs::{End, Goal, Spec};

use super::skill::{Moment, Phase, Skill, observation};
use crate::{Initiation, SkillId, Subgoal, initiation::Act};

/// Skills over observations `O` and actions `A` with a family of initiation sets `I`.
pub(super) struct Repertoire<O, A, I> {
    goal: Option<Goal>,
    place: Vec<usize>,
    success_reward: f32,
    initiation: I,
    /// Row 0 is the global option.
    skills: Vec<Skill>,
    kinds: PhantomData<fn(&O, &A)>,
}

checkpoint!([O, A, I] Repertoire<O, A, I>; plain: skills; parts: initiation; where I: Checkpoint);

impl<O: AsRef<[f32]> + Clone, A, I: Initiation<O, A>> Repertoire<O, A, I> {
    /// The global option alone.
    pub(super) fn new(spec: &Spec, initiation: I) -> Self {
        Self {
            goal: spec.goal.clone(),
            place: spec.place.clone(),
            success_reward: spec.success_reward,
            initiation,
            skills: vec![Skill::new(Subgoal::Task, Phase::Fixed, 0)],
            kinds: PhantomData,
        }
    }

    /// All skills, the global option first.
    pub(super) fn skills(&self) -> &[Skill] {
        &self.skills
    }

    pub(super) fn skill(&self, k: SkillId) -> &Skill {
        &self.skills[k.index()]
    }

    /// The numbers of the learned skills, oldest first.
    pub(super) fn learned(
        &self,
    ) -> impl DoubleEndedIterator<Item = SkillId> + ExactSizeIterator + use<O, A, I> {
        (1..self.skills.len()).map(|k| SkillId(k as u32))
    }

    /// Whether skill `k` may start at `s`, by its initiation set alone.
    pub(super) fn contains(&self, k: SkillId, s: &O) -> bool {
        self.initiation.contains(k, s)
    }

    /// Whether another skill may aim at `s` in order to enter the set of skill `k`.
    pub(super) fn targets(&self, k: SkillId, s: &O) -> bool {
        self.initiation.targets(k, s)
    }

    /// How probable it is, by its set, that skill `k` succeeds from `s`.
    pub(super) fn chance(&self, k: SkillId, s: &O) -> Option<f32> {
        self.initiation.chance(k, s)
    }

    /// Whether some learned skill may start at `s`.
    pub(super) fn covers(&self, s: &O) -> bool {
        self.learned().any(|k| self.contains(k, s))
    }

    /// Whether the subgoal's region contains `s`: β as a function of a state.
    pub(super) fn inside(&self, subgoal: Subgoal, s: &O) -> bool {
        match subgoal {
            Subgoal::Task => self.goal.as_ref().is_some_and(|goal| goal.reached(s.as_ref())),
            Subgoal::Enter(parent) => self.targets(parent, s),
        }
    }

    /// Whether a step attains the subgoal. The task's goal may be no region: then the reward tells.
    pub(super) fn attained(&self, subgoal: Subgoal, after: &O, reward: f32, end: Option<End>) -> bool {
        match subgoal {
            Subgoal::Task if end == Some(End::Terminated) => reward >= self.success_reward,
            _ => self.inside(subgoal, after),
        }
    }

    /// Whether step number `step` of a remembered episode attains the subgoal.
    pub(super) fn attained_by(&self, subgoal: Subgoal, episode: &Episode<O, A>, step: usize) -> bool {
        let last = step + 1 == episode.actions.len();
        let end = if last { episode.end } else { None };
        self.attained(subgoal, &episode.observations[step + 1], episode.rewards[step], end)
    }

    /// How far `s` is from the subgoal: metres to the goal's point, or outside the parent's set in the units of
    /// its classifier.
    pub(super) fn distance(&self, subgoal: Subgoal, s: &O) -> f32 {
        match subgoal {
            Subgoal::Task => self.goal.as_ref().map_or(0.0, |goal| goal.distance(s.as_ref())),
            Subgoal::Enter(parent) => self.initiation.distance(parent, s),
        }
    }

    /// How far two states are apart, by where one is in them.
    pub(super) fn apart(&self, a: &O, b: &O) -> f32 {
        self.place.iter().map(|&dim| (a.as_ref()[dim] - b.as_ref()[dim]).powi(2)).sum::<f32>().sqrt()
    }

    /// The learned skills of equation 3.1: those that may start at `s` and do not end there.
    pub(super) fn startable(&self, s: &O) -> impl Iterator<Item = SkillId> {
        self.learned().filter(|&k| self.contains(k, s) && !self.inside(self.skill(k).subgoal, s))
    }

    /// O′(s) of equation 3.1: the global option is always in it.
    pub(super) fn admissible(&self, s: &O) -> Vec<SkillId> {
        std::iter::once(SkillId::GLOBAL).chain(self.startable(s)).collect()
    }

    /// The greatest share of `states` that lies in the set of one skill with this subgoal.
    pub(super) fn overlap(&self, subgoal: Subgoal, states: &[O]) -> f32 {
        let share = |k| states.iter().filter(|s| self.contains(k, s)).count() as f32 / states.len() as f32;
        let siblings = self.learned().filter(|&k| self.skill(k).subgoal == subgoal);
        siblings.map(share).fold(0.0, f32::max)
    }

    /// A new skill for a subgoal, in training episode `now`.
    pub(super) fn born(&mut self, subgoal: Subgoal, now: u64, positives: &[O]) -> SkillId {
        let k = SkillId(self.skills.len() as u32);
        self.initiation.born(k, positives);
        self.skills.push(Skill::new(subgoal, Phase::Refining, now));
        k
    }

    /// Remembers what is known of a new skill: states that it succeeds from, and where its subgoal was entered.
    pub(super) fn known(&mut self, k: SkillId, positives: &[Moment], entered: &[Moment]) {
        self.skills[k.index()].succeeds_from(positives);
        self.skills[k.index()].affected(entered);
    }

    /// Counts an execution of skill `k` in `episode` that entered its subgoal at a moment, or failed.
    pub(super) fn executed(&mut self, k: SkillId, episode: u64, entered: Option<Moment>) {
        self.skills[k.index()].executed(episode, entered);
    }

    /// Refines the set of skill `k` by states that led to its subgoal.
    pub(super) fn succeeded(&mut self, k: SkillId, from: &[Moment], all: &Experience<O, A>) {
        let states: Vec<O> = from.iter().filter_map(|m| observation(all, *m)).cloned().collect();
        self.initiation.outcome(k, &states, true);
        self.skills[k.index()].succeeds_from(from);
    }

    /// Refines the set of skill `k` by a state that did not lead to its subgoal.
    pub(super) fn failed(&mut self, k: SkillId, from: Moment, all: &Experience<O, A>) {
        if let Some(state) = observation(all, from) {
            self.initiation.outcome(k, std::slice::from_ref(state), false);
        }
    }

    /// Tells the set of skill `k` of an execution from there that the end of the episode cut short.
    pub(super) fn interrupted(&mut self, k: SkillId, from: Moment, all: &Experience<O, A>) {
        if let Some(state) = observation(all, from) {
            self.initiation.interrupted(k, state);
        }
    }

    /// Gives the set of skill `k` a lesson about its subgoal, until it is fixed.
    pub(super) fn lesson(&mut self, k: SkillId, lesson: &Lesson) {
        if self.skill(k).phase != Phase::Fixed {
            self.initiation.lesson(k, lesson);
        }
    }

    /// Lets the set of skill `k` learn from its lessons.
    pub(super) fn learn(
        &mut self,
        k: SkillId,
        all: &Experience<O, A>,
        act: &Act<'_, O, A>,
        ctx: &mut Context,
    ) {
        self.initiation.learn(k, all, act, ctx);
    }

    /// Ends the initiation period of skill `k`: it enters another phase.
    pub(super) fn mature(&mut self, k: SkillId, phase: Phase) {
        self.skills[k.index()].phase = phase;
    }

    /// Positive and negative examples behind the set of skill `k`.
    pub(super) fn examples(&self, k: SkillId) -> (usize, usize) {
        self.initiation.examples(k)
    }
}
