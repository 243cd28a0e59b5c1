//! Initiation value functions: a skill may start where its policy, as it is now, will probably succeed (thesis 5.1.1).
//!
//! ```text
//! I_o = { s : max_g V_o(s, g) + B(s) > T }
//! ```
//!
//! V is learned by policy evaluation from lessons, whoever took their steps ([`inroads_agents::evaluate`]); so it follows
//! the policy, and gives credit to the good part of a way that failed. A classifier of outcomes does neither.

use std::collections::VecDeque;
use std::marker::PhantomData;

use inroads_agents::experience::{Aim, Pay};
use inroads_agents::{Bag, Checkpoint, Context, Corrupt, Evaluator, Experience, Key, Lesson, Replay};
use rand::RngExt;
use serde::{Deserialize, Serialize, de::DeserializeOwned};

use super::bonus::{Bonus, Starts};
use super::{Act, Initiation};
use crate::SkillId;

/// Settings of [`Ivf`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct IvfConfig {
    /// T: probability of success above which the skill may start (authors: 0.5).
    pub optimistic: f32,
    /// Probability from which on another skill may aim at a state, `optimistic` or above (authors: 0.75).
    pub pessimistic: f32,
    /// Successful trajectories to be seen until which the skill may start anywhere (thesis: 5; authors' grids: 10).
    pub gestation: u32,
    /// Whether a lesson that ends without success ends for good, as γ = 1 asks for (thesis: the horizon is part of the
    /// question). With γ < 1 it need not (authors' code).
    pub horizon_ends: bool,
    /// Steps of lessons that a skill remembers (authors: 1e5).
    pub capacity: usize,
    /// Minibatch updates for each step of new lessons, after each execution (authors: 1).
    pub updates_per_step: f32,
    /// Most updates after one execution.
    pub most_updates: u64,
    /// Optimism.
    pub bonus: Bonus,
}

impl Default for IvfConfig {
    fn default() -> Self {
        Self {
            optimistic: 0.5,
            pessimistic: 0.75,
            gestation: 5,
            horizon_ends: true,
            capacity: 20_000,
            updates_per_step: 1.0,
            most_updates: 500,
            bonus: Bonus::None,
        }
    }
}

impl IvfConfig {
    /// What is wrong with these values, if anything. `discount` is the evaluator's γ.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self, discount: f32) -> Result<(), String> {
        for (name, value) in [("optimistic", self.optimistic), ("pessimistic", self.pessimistic)] {
            if !(0.0..=1.0).contains(&value) {
                return Err(format!("{name} is {value}; it must lie in [0, 1]"));
            }
        }
        if self.pessimistic < self.optimistic {
            let (low, high) = (self.pessimistic, self.optimistic);
            return Err(format!(
                "pessimistic is {low} and optimistic {high}; where skills aim at they must be able to start, so set \
                 pessimistic = {high} or above"
            ));
        }
        if self.capacity == 0 {
            return Err("capacity is 0; at least one step must be remembered".into());
        }
        if !(self.updates_per_step.is_finite() && self.updates_per_step >= 0.0) {
            return Err(format!("updates_per_step is {}; it must be 0 or above", self.updates_per_step));
        }
        if discount == 1.0 && !self.horizon_ends {
            return Err(
                "discount is 1 and horizon_ends is false: a value that has risen would never fall; set \
                        horizon_ends = true or discount = 0.99"
                    .into(),
            );
        }
        self.bonus.check()
    }
}

/// Goals of a skill that its value function is asked for (authors: the last 20 effects).
const GOALS: usize = 20;

/// Lessons about failures that wait for the first goal: the skill is in gestation then, so few are enough.
const WAITING: usize = 100;

/// Sets that a value function of success draws, one evaluator `E` a skill.
///
/// `G` is a goal that the evaluator reads: a skill succeeds in many states, and may reach some from where it does not
/// reach others. `()` is one goal for all of them.
pub struct Ivf<O, A, E, G = ()> {
    config: IvfConfig,
    blank: E,
    /// The goal that is attained in a state.
    goal: fn(&O) -> G,
    members: Vec<Member<E, G>>,
    kinds: PhantomData<fn(&O, &A)>,
}

struct Member<E, G> {
    evaluator: E,
    replay: Replay<G>,
    /// Lessons that nothing was learned from yet, or whose goal is not known.
    waiting: VecDeque<Lesson>,
    /// Goals attained last, each once.
    goals: VecDeque<G>,
    /// Steps of lessons that nothing was learned from yet.
    fresh: u64,
    /// Lessons that attained the subgoal: successful trajectories seen, whoever took them.
    attained: u32,
    /// Executions that succeeded, and that failed.
    outcomes: (u32, u32),
    starts: Starts,
}

impl<O, A, E: Clone, G> Ivf<O, A, E, G> {
    /// A family that evaluates with copies of `blank`; `goal` says which goal is attained in a state.
    pub fn new(config: &IvfConfig, blank: E, goal: fn(&O) -> G) -> Self {
        Self { config: config.clone(), blank, goal, members: Vec::new(), kinds: PhantomData }
    }

    fn member(&self, k: SkillId) -> Option<&Member<E, G>> {
        self.members.get(k.index().checked_sub(1)?)
    }

    fn member_mut(&mut self, k: SkillId) -> Option<&mut Member<E, G>> {
        self.members.get_mut(k.index().checked_sub(1)?)
    }

    fn blank_member(&self) -> Member<E, G> {
        let replay = Replay::new(self.config.capacity).paying(Pay::ATTAINMENT);
        Member {
            evaluator: self.blank.clone(),
            replay: if self.config.horizon_ends { replay.closing() } else { replay },
            waiting: VecDeque::new(),
            goals: VecDeque::new(),
            fresh: 0,
            attained: 0,
            outcomes: (0, 0),
            starts: Starts::default(),
        }
    }

    pub(super) fn config(&self) -> &IvfConfig {
        &self.config
    }

    /// Whether too few successes were seen to keep a skill from starting anywhere. Lessons are counted, for a method may
    /// stop telling outcomes (a chain does when it takes a set for final).
    pub(super) fn gestating(&self, k: SkillId) -> bool {
        self.member(k).is_some_and(|member| member.attained < self.config.gestation)
    }

    /// Counts a lesson of skill `k` if it is a success.
    pub(super) fn count(&mut self, k: SkillId, lesson: &Lesson) {
        if let (Some(member), Aim::Subgoal { attained: true }) = (self.member_mut(k), lesson.aim) {
            member.attained += 1;
        }
    }
}

impl<O: Key, A, E: Evaluator<O, A, G> + Clone, G> Ivf<O, A, E, G> {
    /// How probable it is that skill `k` succeeds from each of these states: 1 for the global option, whose set has no
    /// end, and 0 before the first success.
    pub fn values(&self, k: SkillId, states: &[&O]) -> Vec<f32> {
        match self.member(k) {
            Some(member) => member.best(|goal| member.evaluator.values(states, Some(goal)), states.len()),
            None => vec![1.0; states.len()],
        }
    }

    /// V(s) and B(s).
    pub(super) fn optimism(&self, k: SkillId, s: &O) -> (f32, f32) {
        let Some(member) = self.member(k) else { return (1.0, 0.0) };
        let now = self.values(k, &[s])[0];
        let earlier = match self.config.bonus {
            Bonus::Progress => member.best(|goal| member.evaluator.earlier(&[s], Some(goal)), 1)[0],
            Bonus::None | Bonus::Count { .. } => now,
        };
        (now, self.config.bonus.of(now, earlier, member.starts.of(s)))
    }
}

impl<E, G> Member<E, G> {
    /// The greatest of `n` values over all goals.
    fn best(&self, of: impl Fn(&G) -> Vec<f32>, n: usize) -> Vec<f32> {
        self.goals.iter().fold(vec![0.0; n], |best, goal| {
            best.into_iter().zip(of(goal)).map(|(best, value): (f32, f32)| best.max(value)).collect()
        })
    }
}

impl<E, G: Key + Clone> Member<E, G> {
    /// Gives waiting lessons their goals: the one that was attained, else one of those that are known.
    fn name<O, A>(&mut self, goal: fn(&O) -> G, all: &Experience<O, A>, ctx: &mut Context) {
        let waiting = std::mem::take(&mut self.waiting);
        let attained = |lesson: &Lesson| {
            let state = &all.episode(lesson.episode)?.observations[lesson.steps.end as usize];
            (lesson.aim == Aim::Subgoal { attained: true }).then(|| goal(state))
        };
        let named: Vec<_> = waiting.iter().map(attained).collect();
        for goal in named.iter().flatten() {
            self.goals.retain(|known| known.key() != goal.key());
            self.goals.push_back(goal.clone());
        }
        self.goals.drain(..self.goals.len().saturating_sub(GOALS));
        if self.goals.is_empty() {
            self.waiting = waiting;
            self.waiting.drain(..self.waiting.len().saturating_sub(WAITING));
            return;
        }
        for (lesson, goal) in waiting.into_iter().zip(named) {
            let any = || self.goals[ctx.learning.random_range(0..self.goals.len())].clone();
            self.fresh += lesson.steps.len() as u64;
            self.replay.push(lesson.with_goal(goal.unwrap_or_else(any)));
        }
    }
}

impl<O, A, E, G> Initiation<O, A> for Ivf<O, A, E, G>
where
    O: Key,
    E: Evaluator<O, A, G> + Clone,
    G: Key + Clone + Serialize + DeserializeOwned,
{
    fn born(&mut self, k: SkillId, _: &[O]) {
        assert_eq!(k.index(), self.members.len() + 1, "skills are born in the order of their numbers");
        self.members.push(self.blank_member());
    }

    fn contains(&self, k: SkillId, s: &O) -> bool {
        self.gestating(k) || {
            let (value, bonus) = self.optimism(k, s);
            value + bonus > self.config.optimistic
        }
    }

    /// Probability that is lacking to the pessimistic threshold.
    fn distance(&self, k: SkillId, s: &O) -> f32 {
        (self.config.pessimistic - self.values(k, &[s])[0]).max(0.0)
    }

    fn chance(&self, k: SkillId, s: &O) -> Option<f32> {
        Some(self.values(k, &[s])[0])
    }

    fn outcome(&mut self, k: SkillId, states: &[O], success: bool) {
        let Some(member) = self.member_mut(k) else { return };
        match success {
            true => member.outcomes.0 += 1,
            false => member.outcomes.1 += 1,
        }
        if let Some(start) = states.first() {
            member.starts.count(start);
        }
    }

    fn interrupted(&mut self, k: SkillId, s: &O) {
        if let Some(member) = self.member_mut(k) {
            member.starts.count(s);
        }
    }

    fn lesson(&mut self, k: SkillId, lesson: &Lesson) {
        self.count(k, lesson);
        let capacity = self.config.capacity;
        let Some(member) = self.member_mut(k) else { return };
        // What it pays is success and nothing else, whatever the policy is rewarded with.
        member.waiting.push_back(Lesson { rewards: None, ..lesson.clone() });
        // Each has a step at least, so of more lessons than this none would be remembered.
        if member.waiting.len() > capacity {
            member.waiting.pop_front();
        }
    }

    fn learn(&mut self, k: SkillId, all: &Experience<O, A>, act: &Act<'_, O, A>, ctx: &mut Context) {
        let (goal, config) = (self.goal, self.config.clone());
        let Some(member) = self.member_mut(k) else { return };
        member.name(goal, all, ctx);
        // Also those that had waited while their episodes were forgotten.
        member.replay.forget_before(all.first());
        let due = (member.fresh as f64 * f64::from(config.updates_per_step)) as u64;
        member.fresh = 0;
        let mut clips = Vec::new();
        for _ in 0..due.min(config.most_updates) {
            member.replay.sample(all, member.evaluator.batch(), &mut ctx.learning, &mut clips);
            member.evaluator.learn(&clips, &|s, ctx| act(k, s, ctx), ctx);
        }
    }

    /// Executions that succeeded and that failed.
    fn examples(&self, k: SkillId) -> (usize, usize) {
        self.member(k).map_or((0, 0), |member| (member.outcomes.0 as usize, member.outcomes.1 as usize))
    }
}

impl<O, A, E, G> Checkpoint for Ivf<O, A, E, G>
where
    E: Checkpoint + Clone,
    G: Serialize + DeserializeOwned,
{
    fn save(&self, bag: &mut Bag) {
        bag.put("members", &self.members.len());
        for (i, member) in self.members.iter().enumerate() {
            bag.put_part(&format!("{i}.evaluator"), &member.evaluator);
            bag.put(&format!("{i}.lessons"), &(&member.replay, &member.waiting, &member.goals));
            bag.put(
                &format!("{i}.counts"),
                &(member.fresh, member.attained, member.outcomes, &member.starts),
            );
        }
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        self.members.clear();
        for i in 0..bag.get::<usize>("members")? {
            let mut member = self.blank_member();
            bag.get_part(&format!("{i}.evaluator"), &mut member.evaluator)?;
            (member.replay, member.waiting, member.goals) = bag.get(&format!("{i}.lessons"))?;
            (member.fresh, member.attained, member.outcomes, member.starts) =
                bag.get(&format!("{i}.counts"))?;
            self.members.push(member);
        }
        Ok(())
    }
}
