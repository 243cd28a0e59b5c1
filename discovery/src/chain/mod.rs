//! Deep skill chaining (chapter 3): skills built backwards from the goal, each one ending where another may
//! start, until the start states are covered.
//!
//! A chain and a tree are the same code. Every trajectory from a start state that no skill covers yet is
//! attributed to the first salient event that it meets (the task's goal, or a finished initiation set), and an
//! event with enough of them begets a skill. With one start region the first event met is always the end of
//! the chain; with two, one event may beget a skill for either (3.1.4).
//!
//! Robust chaining (chapter 4) is the same with other parts: sets that tell where one may start from where one may aim
//! ([`Dual`](crate::initiation::Dual)), executions that go for one state of their subgoal ([`Aim`], `pursuit.rs`), and one
//! policy for all skills that is taught every goal in hindsight.

mod aim;
mod config;
mod gestation;
mod growth;
mod lessons;
pub mod metrics;
mod pursuit;
mod repertoire;
mod skill;
mod skilled;
mod trial;

pub use aim::{Aim, Places, Sets, States};
pub use config::{ChainAt, ChainConfig, Explore, Lessons, OptionReward, Subgoals};
pub(crate) use skill::observation;
pub use skill::{Moment, Phase, Skill};

use inroads_agents::{
    Checkpoint, Context, Experience, Lesson, Memory, Transition, checkpoint, experience::discounted,
};
use inroads_envs::{End, Spec};
use rand::RngExt;

use crate::{
    Call, Choice, Discovery, Goal, Initiation, Outcome, PolicyOverSkills, SkillId, SkillPolicy, Stop,
    execution::Driver,
};
pub(crate) use gestation::Gestation;
pub(crate) use growth::SHORTEST;
use pursuit::Values;
use repertoire::Repertoire;

/// Skill chaining over observations `O` and actions `A`, with a family of initiation sets `I`, a family of option
/// policies `P`, and a policy over options `Q`. Executions are told what `S` makes of their subgoals.
pub struct Chaining<O, A, I, P, Q, S = Sets> {
    config: ChainConfig,
    repertoire: Repertoire<O, A, I>,
    policy: P,
    over: Q,
    aim: S,
    gestations: Vec<Gestation>,
}

checkpoint!(
    [O, A, I, P, Q, S] Chaining<O, A, I, P, Q, S>;
    plain: gestations;
    parts: repertoire, policy, over;
    where I: Checkpoint, P: Checkpoint, Q: Checkpoint
);

/// What a chain keeps for one episode of one actor.
#[derive(Clone, Debug)]
pub struct Lane<G> {
    /// Who acts.
    driver: Driver,
    /// Whether the global option is forbidden wherever a learned skill may start.
    chain_alone: bool,
    /// What subgoal states are worth, as it was when first asked for in this episode.
    values: Option<Values<G>>,
    /// The goals that executions of this episode went for.
    pursued: Vec<G>,
}

impl<G> Default for Lane<G> {
    fn default() -> Self {
        Self { driver: Driver::default(), chain_alone: false, values: None, pursued: Vec::new() }
    }
}

impl<O: AsRef<[f32]> + Clone, A, I: Initiation<O, A>, P, Q> Chaining<O, A, I, P, Q> {
    /// A chain that has the global option only: `initiation`, `policy` and `over` must be as young. Executions go for
    /// whole sets, whatever [`ChainConfig::subgoals`] says, where it is not [`aiming`](Self::aiming).
    pub fn new(config: &ChainConfig, spec: &Spec, initiation: I, policy: P, over: Q) -> Self {
        let repertoire = Repertoire::new(spec, initiation);
        Self { config: config.clone(), repertoire, policy, over, aim: Sets, gestations: Vec::new() }
    }
}

impl<O, A, I, P, Q> Chaining<O, A, I, P, Q> {
    /// The same with executions that are told single states, as [`ChainConfig::subgoals`] chooses them.
    ///
    /// # Panics
    /// When the configuration says that executions go for whole sets.
    pub fn aiming<S>(self, aim: S) -> Chaining<O, A, I, P, Q, S> {
        assert_ne!(self.config.subgoals, Subgoals::Set, "executions that go for sets are told no states");
        let Self { config, repertoire, policy, over, aim: Sets, gestations } = self;
        Chaining { config, repertoire, policy, over, aim, gestations }
    }
}

impl<O, A, I, P, Q, S> Chaining<O, A, I, P, Q, S>
where
    O: AsRef<[f32]> + Clone,
    I: Initiation<O, A>,
    P: SkillPolicy<O, A, S::Goal>,
    Q: PolicyOverSkills<O>,
    S: Aim<O>,
{
    /// All skills, the global option first.
    pub fn skills(&self) -> &[Skill] {
        self.repertoire.skills()
    }

    /// A call of skill `k` at `s`, with the goal that it would go for.
    pub fn call(
        &self,
        k: SkillId,
        lane: &mut Lane<S::Goal>,
        s: &O,
        all: &Experience<O, A>,
        ctx: &mut Context,
    ) -> Call<S::Goal> {
        lane.driver.hand_to(k);
        let goal = self.pursue(k, s, &mut lane.values, all, ctx);
        let primitive = k == SkillId::GLOBAL && goal.is_none();
        Call { skill: k, goal, budget: if primitive { 1 } else { self.config.timeout } }
    }

    /// Whether a skill's set has become a salient event that other skills may aim at.
    fn salient(&self, k: SkillId) -> bool {
        match self.config.chain_at {
            ChainAt::InitiationEnd => self.repertoire.skill(k).phase != Phase::Refining,
            ChainAt::Gestation => true,
        }
    }

    /// Hands a decision and what came of it to the policy over options, and lets it learn.
    fn decided(&mut self, out: &Outcome<S::Goal>, all: &Experience<O, A>, ctx: &mut Context) {
        let Some(episode) = all.episode(out.episode) else { return };
        let last = if self.config.intra_option { out.steps.end } else { out.steps.start + 1 };
        for step in out.steps.start..last {
            let rewards = &episode.rewards[step as usize..out.steps.end as usize];
            let (reward, discount) = discounted(rewards.iter().copied(), self.config.discount);
            let choice = Choice {
                episode: out.episode,
                steps: step..out.steps.end,
                skill: out.call.skill,
                reward,
                discount,
                terminal: out.end == Some(End::Terminated),
            };
            self.over.record(choice, all);
            let repertoire = &self.repertoire;
            self.over.learn(all, &|s| repertoire.admissible(s), ctx);
        }
    }

    /// Where an execution entered its subgoal, if it ended there. One that goes for a single state may be over, time-out
    /// or not, at another state of the set: that is a success of the skill all the same (authors' code).
    fn entered(&self, out: &Outcome<S::Goal>, all: &Experience<O, A>) -> Option<Moment> {
        if out.call.goal.is_none() {
            return (out.stop == Stop::Reached).then_some((out.episode, out.steps.end));
        }
        let episode = all.episode(out.episode)?;
        let subgoal = self.repertoire.skill(out.call.skill).subgoal;
        let attains = |step: &u32| self.repertoire.attained_by(subgoal, episode, *step as usize);
        out.steps.clone().next_back().filter(attains)?;
        out.steps.clone().find(attains).map(|step| (out.episode, step + 1))
    }

    /// Refines a skill's set by an execution of it (3.1.3).
    fn refine(&mut self, out: &Outcome<S::Goal>, success: bool, all: &Experience<O, A>) {
        let k = out.call.skill;
        if k == SkillId::GLOBAL || self.repertoire.skill(k).phase == Phase::Fixed {
            return;
        }
        let (start, end) = (out.steps.start, out.steps.end);
        if success {
            // The start, and the last states: from each of them the execution went on to succeed.
            let from = (end + 1).saturating_sub(self.config.segment).max(start + 1);
            let states = std::iter::once(start).chain(from..=end).map(|step| (out.episode, step));
            self.repertoire.succeeded(k, &states.collect::<Vec<_>>(), all);
        } else if out.stop == Stop::TimedOut {
            self.repertoire.failed(k, (out.episode, start), all);
        } else {
            // The episode ended first: nobody knows what the skill would have done.
            self.repertoire.interrupted(k, (out.episode, start), all);
        }
        let skill = self.repertoire.skill(k);
        let long_enough = skill.episodes >= self.config.initiation_episodes;
        if long_enough && skill.successes >= u64::from(self.config.initiation_successes) {
            self.repertoire.mature(k, if self.config.freeze { Phase::Fixed } else { Phase::Mature });
        }
    }

    /// Lets the set of skill `k` learn from its lessons, where sets do (chapter 5), by the policy as it is now.
    fn evaluate(&mut self, k: SkillId, all: &Experience<O, A>, ctx: &mut Context) {
        if k == SkillId::GLOBAL || self.repertoire.skill(k).phase == Phase::Fixed {
            return;
        }
        let goal = self.sampled(k, all, &mut ctx.learning);
        let policy = &self.policy;
        let act = |k, s: &O, ctx: &mut Context| {
            let explore = std::mem::replace(&mut ctx.explore, false);
            let call = Call { skill: k, goal: goal.clone(), budget: 1 };
            let action = policy.act(&mut Memory::new(), &call, s, ctx);
            ctx.explore = explore;
            action
        };
        self.repertoire.learn(k, all, &act, ctx);
    }
}

impl<O, A, I, P, Q, S> Discovery<O, A> for Chaining<O, A, I, P, Q, S>
where
    O: AsRef<[f32]> + Clone,
    I: Initiation<O, A>,
    P: SkillPolicy<O, A, S::Goal>,
    Q: PolicyOverSkills<O>,
    S: Aim<O>,
{
    type Goal = S::Goal;
    type Lane = Lane<S::Goal>;

    fn decide(
        &self,
        lane: &mut Self::Lane,
        s: &O,
        all: &Experience<O, A>,
        ctx: &mut Context,
    ) -> Call<S::Goal> {
        let mut skills: Vec<_> = self.repertoire.startable(s).collect();
        if skills.is_empty() || !lane.chain_alone {
            skills.insert(0, SkillId::GLOBAL);
        }
        let skill = self.over.choose(s, &skills, ctx);
        self.call(skill, lane, s, all, ctx)
    }

    fn act(&self, lane: &mut Self::Lane, call: &Call<S::Goal>, s: &O, ctx: &mut Context) -> A {
        self.policy.act(lane.driver.memory(), call, s, ctx)
    }

    fn reached(&self, call: &Call<S::Goal>, t: &Transition<O, A>) -> bool {
        let subgoal = self.repertoire.skill(call.skill).subgoal;
        let attained = || self.repertoire.attained(subgoal, t.after, t.reward, t.end);
        match &call.goal {
            None => attained(),
            // It goes for some event, but any skill that may start does better.
            Some(goal) if call.skill == SkillId::GLOBAL => {
                goal.reached(t.after) || attained() || self.repertoire.startable(t.after).next().is_some()
            }
            Some(goal) => goal.reached(t.after) && attained(),
        }
    }

    fn finished(
        &mut self,
        lane: &mut Self::Lane,
        out: &Outcome<S::Goal>,
        all: &Experience<O, A>,
        ctx: &mut Context,
    ) {
        let k = out.call.skill;
        let entered = self.entered(out, all);
        self.repertoire.executed(k, out.episode, entered);
        self.decided(out, all, ctx);
        if self.config.lessons == Lessons::Own {
            if k != SkillId::GLOBAL {
                self.teach(k, out.episode, out.steps.clone(), all);
            }
            self.teach_own(out, all, ctx);
        }
        if let Some(goal) = &out.call.goal
            && !lane.pursued.contains(goal)
        {
            lane.pursued.push(goal.clone());
        }
        self.refine(out, entered.is_some(), all);
        self.evaluate(k, all, ctx);
        if out.end.is_some() {
            self.close(out.episode, &lane.pursued, all, ctx);
        }
    }

    fn learn(&mut self, call: &Call<S::Goal>, all: &Experience<O, A>, ctx: &mut Context) {
        let episode = all.latest();
        let now = all.length(episode);
        if self.aim.task().is_none() {
            self.policy.lesson(SkillId::GLOBAL, Lesson::task(episode, now - 1));
        }
        self.policy.step(SkillId::GLOBAL, all, ctx);
        if S::TELLS {
            // One policy for all, which has made its step.
            return;
        }
        let learned = self.repertoire.learned().len() as u32;
        if call.skill != SkillId::GLOBAL {
            self.policy.step(call.skill, all, ctx);
        } else if self.config.lessons == Lessons::All && learned > 0 {
            // What a primitive action shows is a lesson for every skill: one of them learns meanwhile.
            let k = SkillId(ctx.learning.random_range(1..=learned));
            self.policy.step(k, all, ctx);
        }
    }

    fn updates(&self) -> Vec<(&'static str, u64)> {
        vec![("options", self.policy.updates()), ("over_options", self.over.updates())]
    }
}
