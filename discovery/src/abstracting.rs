//! Exploration from abstract subgoals, and a policy over the options that come of it (thesis 9.2.1, 9.2.5).
//!
//! [`GraphExplorer`] does what the text calls (a) to (f): pick a subgoal, attain it, explore from there, name what was
//! new. This file adds what the options are for, π_O: some episodes explore, in the others (and whenever nobody explores)
//! options are called for the task's reward (`decisions.md`: the share is a setting).
//!
//! Option 0 is one step of a policy that learns the task alone, as in 3.1.2: so π_O can do whatever primitive actions can.

use inroads_agents::{
    Actor, Agent, Checkpoint, Context, Curious, Experience, Learner, Memory, Transition, checkpoint,
    experience::discounted,
};
use rand::RngExt;
use serde::{Deserialize, Serialize};

use crate::{
    Call, Choice, Discovery, Goal, GraphExplorer, Hierarchy, Outcome, PolicyOverSkills, SkillId, SkillPolicy,
    Skilled,
    frontier::Frontier,
    graph::{ExplorerLane, Vertex},
    record::{GraphRecord, Place, PlanRecord},
};

/// Settings of [`Abstracting`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct AbstractingConfig {
    /// Share of training episodes that explore; the others follow the policy over options.
    pub explore: f32,
    /// γ of the policy over options.
    pub discount: f32,
}

impl Default for AbstractingConfig {
    fn default() -> Self {
        Self { explore: 0.5, discount: 0.99 }
    }
}

impl AbstractingConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the fix.
    pub fn check(&self) -> Result<(), String> {
        for (name, value) in [("explore", self.explore), ("discount", self.discount)] {
            if !(0.0..=1.0).contains(&value) {
                return Err(format!("{name} is {value}; it must lie in [0, 1]"));
            }
        }
        Ok(())
    }
}

/// An explorer whose skills also serve the task. `O` is seen; `L` learns the task step by step.
pub struct Abstracting<O, G, P, F, L, V> {
    config: AbstractingConfig,
    explorer: GraphExplorer<G, P, F>,
    task: Curious<O, L>,
    over: V,
}

checkpoint!(
    [O, G, P, F, L, V] Abstracting<O, G, P, F, L, V>;
    plain: ;
    parts: explorer, task, over;
    where GraphExplorer<G, P, F>: Checkpoint, L: Checkpoint, V: Checkpoint
);

/// What an actor keeps for one episode.
#[derive(Clone, Debug)]
pub struct Lane<G> {
    explorer: ExplorerLane<G>,
    /// Of the policy for the task.
    memory: Memory,
    /// Whether this episode explores; drawn with its first decision.
    explores: Option<bool>,
    /// The decisions so far, as the policy over options is to learn from them.
    choices: Vec<Choice>,
}

impl<G> Default for Lane<G> {
    fn default() -> Self {
        Self { explorer: ExplorerLane::default(), memory: Memory::new(), explores: None, choices: Vec::new() }
    }
}

impl<G> Lane<G> {
    fn explores(&self) -> bool {
        self.explores == Some(true)
    }
}

impl<O, G, P, F, L, V> Abstracting<O, G, P, F, L, V> {
    /// An agent whose parts are all as young.
    pub fn new(
        config: &AbstractingConfig,
        explorer: GraphExplorer<G, P, F>,
        task: Curious<O, L>,
        over: V,
    ) -> Self {
        Self { config: config.clone(), explorer, task, over }
    }

    /// What explores, and has the graph.
    pub fn explorer(&self) -> &GraphExplorer<G, P, F> {
        &self.explorer
    }
}

/// The options that may be called at `s`: those whose subgoals it does not attain, and option 0.
fn admissible<O, G: Goal<O>, P, F>(explorer: &GraphExplorer<G, P, F>, s: &O) -> Vec<SkillId> {
    let away = explorer.graph().vertices().filter(|v| !explorer.goals()[v.index()].reached(s));
    std::iter::once(SkillId::GLOBAL).chain(away.map(Vertex::skill)).collect()
}

impl<O, A, G, P, F, L, V> Discovery<O, A> for Abstracting<O, G, P, F, L, V>
where
    O: Clone,
    G: Goal<O>,
    P: SkillPolicy<O, A, G>,
    F: Frontier<O, A, G>,
    L: Learner<O, A, ()>,
    V: PolicyOverSkills<O>,
{
    type Goal = G;
    type Lane = Lane<G>;

    fn decide(&self, lane: &mut Lane<G>, s: &O, all: &Experience<O, A>, ctx: &mut Context) -> Call<G> {
        let share = self.config.explore;
        lane.explores.get_or_insert_with(|| ctx.explore && ctx.acting.random::<f32>() < share);
        if lane.explores() {
            return self.explorer.decide(&mut lane.explorer, s, all, ctx);
        }
        let skill = self.over.choose(s, &admissible(&self.explorer, s), ctx);
        lane.explorer.driver.hand_to(skill);
        match Vertex::of(skill) {
            Some(v) => self.explorer.call(v),
            None => Call { skill, goal: None, budget: 1 },
        }
    }

    fn act(&self, lane: &mut Lane<G>, call: &Call<G>, s: &O, ctx: &mut Context) -> A {
        match call.skill {
            SkillId::GLOBAL if !lane.explores() => self.task.act(&mut lane.memory, s, ctx),
            _ => self.explorer.act(&mut lane.explorer, call, s, ctx),
        }
    }

    fn reached(&self, call: &Call<G>, t: &Transition<O, A>) -> bool {
        self.explorer.reached(call, t)
    }

    fn seen(&mut self, all: &Experience<O, A>, ctx: &mut Context) {
        self.explorer.seen(all, ctx);
    }

    fn finished(&mut self, lane: &mut Lane<G>, out: &Outcome<G>, all: &Experience<O, A>, ctx: &mut Context) {
        let known = self.explorer.graph().len();
        if lane.explores() || out.call.skill != SkillId::GLOBAL {
            self.explorer.finished(&mut lane.explorer, out, all, ctx);
        } else if out.end.is_some() {
            self.explorer.close(out.episode, all, ctx);
        }
        let Some(episode) = all.episode(out.episode) else { return };
        let (from, to) = (out.steps.start as usize, out.steps.end as usize);
        for goal in &self.explorer.goals()[known..] {
            let triggers = episode.observations[from..=to].iter().filter(|s| goal.reached(s));
            self.over.grow(&triggers.cloned().collect::<Vec<_>>());
        }
        // What explores is none of the options.
        if out.call.skill != SkillId::GLOBAL || !lane.explores() {
            let (reward, discount) =
                discounted(episode.rewards[from..to].iter().copied(), self.config.discount);
            lane.choices.push(Choice {
                episode: out.episode,
                steps: out.steps.clone(),
                skill: out.call.skill,
                reward,
                discount,
                terminal: out.end == Some(inroads_envs::End::Terminated),
            });
        }
        if out.end.is_some() {
            // From the last to the first, so that one episode carries a reward all the way back.
            for choice in lane.choices.drain(..).rev() {
                self.over.record(choice, all);
                self.over.learn(all, &|s| admissible(&self.explorer, s), ctx);
            }
        }
    }

    fn learn(&mut self, call: &Call<G>, all: &Experience<O, A>, ctx: &mut Context) {
        self.explorer.learn(call, all, ctx);
        self.task.step(all.latest(), all, ctx);
    }

    fn updates(&self) -> Vec<(&'static str, u64)> {
        let mut updates = Discovery::<O, A>::updates(&self.explorer);
        updates.extend([("task", self.task.updates()), ("over options", self.over.updates())]);
        updates
    }
}

impl<O, A, G, P, F, L, V> Skilled<O, A> for Hierarchy<O, A, Abstracting<O, G, P, F, L, V>>
where
    O: Clone + AsRef<[f32]>,
    A: Clone,
    G: Goal<O>,
    P: SkillPolicy<O, A, G>,
    F: Frontier<O, A, G>,
    L: Learner<O, A, ()>,
    V: PolicyOverSkills<O>,
    Self: Agent<O, A>,
{
    fn graph(&self) -> Option<GraphRecord> {
        Some(self.method().explorer.recorded(self.experience()))
    }

    fn plan(&self, from: &Place<'_, O>, to: &Place<'_, O>) -> Option<PlanRecord> {
        self.method().explorer.way(from, to, self.experience())
    }

    /// Whoever is sent follows the explorer, not the policy over options.
    fn pursue(&self, to: &Place<'_, O>) -> Option<Box<dyn Actor<O, A> + '_>> {
        let explorer = self.method().explorer.sent(to, self.experience())?;
        Some(self.watch(Lane { explorer, explores: Some(true), ..Lane::default() }))
    }
}
