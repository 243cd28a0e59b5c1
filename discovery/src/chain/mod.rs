//! Deep skill chaining (chapter 3): skills built backwards from the goal, each one ending where another may
//! start, until the start states are covered.
//!
//! A chain and a tree are the same code. Every trajectory from a start state that no skill covers yet is
//! attributed to the first salient event that it meets (the task's goal, or a finished initiation set), and an
//! event with enough of them begets a skill. With one start region the first event met is always the end of
//! the chain; with two, one event may beget a skill for either (3.1.4).

mod config;
mod gestation;
mod lessons;
mod repertoire;
mod skill;

pub use config::{ChainAt, ChainConfig, Lessons, OptionReward};
pub use skill::{Phase, Skill};

use std::ops::Range;

use inroads_agents::{
    Actor, Checkpoint, Context, Experience, Lesson, Memory, Transition, checkpoint, experience::Aim,
};
use inroads_envs::{End, Spec};
use rand::RngExt;
use serde::{Serialize, de::DeserializeOwned};

use crate::{
    Call, Choice, Discovery, Hierarchy, Initiation, Outcome, PolicyOverSkills, SkillId, SkillPolicy,
    SkillRecord, Skilled, Stop, Subgoal, execution::discounted,
};
use gestation::Gestation;
use repertoire::Repertoire;

/// A trajectory shorter than this part of a segment brings forth no skill: it began at the event's border, and a
/// set of two or three states would be learned from it (authors' tree code: K/5).
const SHORTEST: u32 = 5;

/// Deep skill chaining over observations `O`, with a family of initiation sets `I`, a family of option policies
/// `P`, and a policy over options `Q`.
pub struct Chaining<O, I, P, Q> {
    config: ChainConfig,
    repertoire: Repertoire<O, I>,
    policy: P,
    over: Q,
    gestations: Vec<Gestation>,
}

checkpoint!(
    [O, I, P, Q] Chaining<O, I, P, Q>;
    plain: gestations;
    parts: repertoire, policy, over;
    where I: Checkpoint, P: Checkpoint, Q: Checkpoint
);

/// What a chain keeps for one episode of one actor.
#[derive(Clone, Debug, Default)]
pub struct Lane {
    /// The acting policy's memory, and whose it is.
    memory: Memory,
    owner: Option<SkillId>,
    /// Whether the global option is forbidden wherever a learned skill may start.
    chain_alone: bool,
}

impl<O: AsRef<[f32]> + Clone, I: Initiation<O>, P, Q: PolicyOverSkills<O>> Chaining<O, I, P, Q> {
    /// A chain that has the global option only: `initiation`, `policy` and `over` must be as young.
    pub fn new(config: &ChainConfig, spec: &Spec, initiation: I, policy: P, over: Q) -> Self {
        let repertoire = Repertoire::new(spec, initiation);
        Self { config: config.clone(), repertoire, policy, over, gestations: Vec::new() }
    }

    /// All skills, the global option first.
    pub fn skills(&self) -> &[Skill] {
        self.repertoire.skills()
    }

    /// Whether a skill's set has become a salient event that other skills may aim at.
    fn salient(&self, k: SkillId) -> bool {
        match self.config.chain_at {
            ChainAt::InitiationEnd => self.repertoire.skill(k).phase == Phase::Fixed,
            ChainAt::Gestation => true,
        }
    }

    /// Hands a decision and what came of it to the policy over options, and lets it learn.
    fn decided<A>(&mut self, out: &Outcome, all: &Experience<O, A>, ctx: &mut Context) {
        let Some(episode) = all.episode(out.episode) else { return };
        let last = if self.config.intra_option { out.steps.end } else { out.steps.start + 1 };
        for step in out.steps.start..last {
            let rewards = &episode.rewards[step as usize..out.steps.end as usize];
            let (reward, discount) = discounted(rewards, self.config.discount);
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

    /// Refines a young skill's set by an execution of it (3.1.3).
    fn refine<A>(&mut self, out: &Outcome, all: &Experience<O, A>) {
        let k = out.call.skill;
        let Some(episode) = all.episode(out.episode) else { return };
        if k == SkillId::GLOBAL || self.repertoire.skill(k).phase == Phase::Fixed {
            return;
        }
        let (start, end) = (out.steps.start as usize, out.steps.end as usize);
        match out.stop {
            Stop::Reached => {
                // The start, and the last states: from each of them the execution went on to succeed.
                let from = (end + 1).saturating_sub(self.config.segment as usize).max(start + 1);
                let mut states = vec![episode.observations[start].clone()];
                states.extend_from_slice(&episode.observations[from..=end]);
                self.repertoire.refine(k, &states, true);
            }
            Stop::TimedOut => self.repertoire.refine(k, &episode.observations[start..=start], false),
            // Nobody knows what the skill would have done.
            Stop::CutShort => {}
        }
        let skill = self.repertoire.skill(k);
        let long_enough = skill.episodes >= self.config.initiation_episodes;
        if long_enough && skill.successes >= u64::from(self.config.initiation_successes) {
            self.repertoire.fix(k);
        }
    }

    /// An episode is over: every skill may learn from it, and it may bring forth a new one.
    fn close<A>(&mut self, number: u64, all: &Experience<O, A>, ctx: &mut Context)
    where
        P: SkillPolicy<O, A>,
    {
        if self.config.lessons == Lessons::All {
            for k in self.repertoire.learned() {
                self.teach(k, number, 0..all.length(number), all);
            }
        }
        let Some(gestation) = self.gestate(number, all) else { return };
        let (positives, triggers) = gestation.states(self.config.segment, all);
        let overlap = self.repertoire.overlap(gestation.subgoal, &positives);
        if positives.is_empty() || overlap > self.config.sibling_overlap {
            return;
        }
        let k = self.repertoire.born(gestation.subgoal, number, &positives);
        self.policy.born(k);
        self.over.grow(&triggers);
        for past in all.numbers() {
            self.teach(k, past, 0..all.length(past), all);
        }
        self.policy.practise(k, u64::from(self.config.pretrain), all, ctx);
    }

    /// Gives skill `k` the lessons of some steps of an episode.
    fn teach<A>(&mut self, k: SkillId, number: u64, steps: Range<u32>, all: &Experience<O, A>)
    where
        P: SkillPolicy<O, A>,
    {
        let Some(episode) = all.episode(number) else { return };
        let subgoal = self.repertoire.skill(k).subgoal;
        let reward = self.config.option_reward;
        for lesson in self.repertoire.lessons(subgoal, number, episode, steps, reward) {
            self.policy.lesson(k, lesson);
        }
    }

    /// Attributes an episode that began outside every set to the first salient event it met. A gestation that
    /// is complete with it is handed back.
    fn gestate<A>(&mut self, number: u64, all: &Experience<O, A>) -> Option<Gestation> {
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
        let index = self.gestations.iter().position(|g| g.subgoal == subgoal).unwrap_or_else(|| {
            self.gestations.push(Gestation::new(subgoal));
            self.gestations.len() - 1
        });
        self.gestations[index].triggers.push((number, step));
        let complete = self.gestations[index].triggers.len() >= self.config.gestation as usize;
        complete.then(|| self.gestations.swap_remove(index))
    }

    /// The first salient event that an episode meets, and the step that meets it. Where sets overlap the
    /// youngest is met: it lies farthest from the goal.
    fn first_event<A>(&self, number: u64, all: &Experience<O, A>) -> Option<(Subgoal, u32)> {
        let episode = all.episode(number)?;
        (0..episode.actions.len()).find_map(|step| {
            let after = &episode.observations[step + 1];
            let mut youngest = self.repertoire.learned().rev();
            let entered = youngest.find(|&k| self.salient(k) && self.repertoire.contains(k, after));
            let done = self.repertoire.attained_by(Subgoal::Task, episode, step);
            let event = entered.map(Subgoal::Enter).or(done.then_some(Subgoal::Task))?;
            Some((event, step as u32))
        })
    }
}

impl<O, A, I, P, Q> Discovery<O, A> for Chaining<O, I, P, Q>
where
    O: AsRef<[f32]> + Clone,
    I: Initiation<O>,
    P: SkillPolicy<O, A>,
    Q: PolicyOverSkills<O>,
{
    type Lane = Lane;

    fn decide(&self, lane: &mut Lane, s: &O, ctx: &mut Context) -> Call {
        let mut skills: Vec<_> = self.repertoire.startable(s).collect();
        if skills.is_empty() || !lane.chain_alone {
            skills.insert(0, SkillId::GLOBAL);
        }
        let skill = self.over.choose(s, &skills, ctx);
        if lane.owner != Some(skill) {
            lane.memory.clear();
            lane.owner = Some(skill);
        }
        Call { skill, budget: if skill == SkillId::GLOBAL { 1 } else { self.config.timeout } }
    }

    fn act(&self, lane: &mut Lane, call: Call, s: &O, ctx: &mut Context) -> A {
        self.policy.act(call.skill, &mut lane.memory, s, ctx)
    }

    fn reached(&self, call: Call, t: &Transition<O, A>) -> bool {
        let subgoal = self.repertoire.skill(call.skill).subgoal;
        self.repertoire.attained(subgoal, t.after, t.reward, t.end)
    }

    fn finished(&mut self, out: &Outcome, all: &Experience<O, A>, ctx: &mut Context) {
        let k = out.call.skill;
        self.repertoire.executed(k, out.episode, out.steps.end, out.stop == Stop::Reached);
        self.decided(out, all, ctx);
        if k != SkillId::GLOBAL && self.config.lessons == Lessons::Own {
            self.teach(k, out.episode, out.steps.clone(), all);
        }
        self.refine(out, all);
        if out.end.is_some() {
            self.close(out.episode, all, ctx);
        }
    }

    fn learn(&mut self, call: Call, all: &Experience<O, A>, ctx: &mut Context) {
        let episode = all.latest();
        let now = all.length(episode);
        let lesson = Lesson { episode, steps: now - 1..now, aim: Aim::Task, rewards: None };
        self.policy.lesson(SkillId::GLOBAL, lesson);
        self.policy.step(SkillId::GLOBAL, all, ctx);
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

impl<O, A, I, P, Q> Skilled<O, A> for Hierarchy<O, A, Chaining<O, I, P, Q>>
where
    O: AsRef<[f32]> + Clone + Serialize + DeserializeOwned,
    A: Clone + Serialize + DeserializeOwned,
    I: Initiation<O>,
    P: SkillPolicy<O, A>,
    Q: PolicyOverSkills<O>,
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

    fn chain_alone(&self) -> Option<Box<dyn Actor<O, A> + '_>> {
        let any = self.method().repertoire.learned().len() > 0;
        any.then(|| self.watch(Lane { chain_alone: true, ..Lane::default() }))
    }
}
