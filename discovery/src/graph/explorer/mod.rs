//! The agent of chapters 7 and 9: go to a vertex, explore beyond it, add what was found, connect it.
//!
//! Algorithm 1 of the thesis, a call at a time. An actor chooses an expansion vertex among those that it can get to from
//! where it is (equations 7.3, 7.4), plans to it on the abstract process (7.2.2.4), calls one skill after the other, and
//! explores from there. When its exploration is over, what it found may become a vertex (7.2.2.7); when its episode is
//! over, edges and counts are brought up to date (`survey`). Goals that somebody else has are pursued too (`query`).
//!
//! Whoever does not explore (`Context::explore` is not set) goes to the vertex of the greatest utility, from which most of
//! the task's reward is expected, by a plan without optimism, and on from there by the frontier's policy without noise.

mod query;
mod skilled;
mod survey;

use inroads_agents::{
    Bag, Checkpoint, Context, Corrupt, Experience, Lesson, Memory, Transition, draw::argmax, experience::Aim,
};
use inroads_envs::End;
use serde::{Deserialize, Serialize};

use super::{Plan, Planner, SkillGraph, Vertex};
use crate::{
    Call, Discovery, Goal, Outcome, SkillId, SkillPolicy, Stop,
    execution::Driver,
    frontier::{Candidate, Frontier},
};

/// Settings of [`GraphExplorer`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ExplorerConfig {
    /// H: steps after which a skill hands back, at least 1. (The thesis gives no value.)
    pub horizon: u32,
    /// Steps of an exploration; 0: to the end of the episode (7.2.2.6).
    pub explore_for: u32,
    /// τ of equation 7.7, in \[0, 1\]: the probability above which a confident value makes an edge. With values
    /// discounted by γ, γ to the horizon says that the vertex is just within reach of one call.
    pub edge_value: f32,
    /// c of equation 7.7, in \[0, 1\]: how much a value is doubted that rests on few visits.
    pub edge_doubt: f32,
    /// States of every episode that are taken as goals in hindsight, whatever became of it (HER with `future`).
    pub hindsight: u32,
    /// Whether every state in which the task paid becomes a vertex, however novel (authors' precursor).
    pub rewarded: bool,
    /// Vertices at most.
    pub max_vertices: u32,
}

impl Default for ExplorerConfig {
    fn default() -> Self {
        Self {
            horizon: 20,
            explore_for: 0,
            edge_value: 0.9,
            edge_doubt: 0.1,
            hindsight: 4,
            rewarded: false,
            max_vertices: 200,
        }
    }
}

impl ExplorerConfig {
    /// What is wrong with these values, if anything.
    ///
    /// # Errors
    /// A sentence that names the setting and the mend.
    pub fn check(&self) -> Result<(), String> {
        if self.horizon == 0 {
            return Err("horizon is 0; a skill needs at least one step".into());
        }
        if self.max_vertices == 0 {
            return Err("max_vertices is 0; a graph needs at least one vertex".into());
        }
        for (name, value) in [("edge_value", self.edge_value), ("edge_doubt", self.edge_doubt)] {
            if !(0.0..=1.0).contains(&value) {
                return Err(format!("{name} is {value}; it must lie in [0, 1]"));
            }
        }
        Ok(())
    }
}

/// Builds a graph of goals `G`, pursued by the policies of `P`, and expands it by `F`.
pub struct GraphExplorer<G, P, F> {
    config: ExplorerConfig,
    graph: SkillGraph,
    /// Of each vertex: its goal.
    goals: Vec<G>,
    /// Of each vertex: where it was reached lately, as (episode, step), oldest first.
    effects: Vec<Vec<(u64, u32)>>,
    policy: P,
    frontier: F,
    planner: Box<dyn Planner>,
    /// For who does not explore; none: the same.
    sober: Option<Box<dyn Planner>>,
}

/// What an explorer keeps for one episode of one actor.
#[derive(Clone, Debug)]
pub struct Lane<G> {
    /// The acting skill.
    pub(crate) driver: Driver,
    errand: Errand<G>,
    /// Of the policy that acts beyond the graph.
    outside: Memory,
}

impl<G> Default for Lane<G> {
    fn default() -> Self {
        Self { driver: Driver::default(), errand: Errand::Idle, outside: Memory::new() }
    }
}

/// What an actor is about.
#[derive(Clone, Debug)]
enum Errand<G> {
    Idle,
    /// On the way to a vertex, by a plan.
    Going(Vertex, Plan),
    /// Beyond the graph.
    Exploring,
    /// On the way to a goal that somebody else has.
    Sent(query::Mission<G>),
}

impl<G, P, F> GraphExplorer<G, P, F> {
    /// An explorer without a vertex; `policy` and `frontier` must be as young.
    pub fn new(config: &ExplorerConfig, planner: Box<dyn Planner>, policy: P, frontier: F) -> Self {
        Self {
            config: config.clone(),
            graph: SkillGraph::default(),
            goals: Vec::new(),
            effects: Vec::new(),
            policy,
            frontier,
            planner,
            sober: None,
        }
    }

    /// The same with another planner for who does not explore: one that hopes for nothing.
    pub fn sober(self, planner: Box<dyn Planner>) -> Self {
        Self { sober: Some(planner), ..self }
    }

    /// The graph.
    pub fn graph(&self) -> &SkillGraph {
        &self.graph
    }

    /// Of each vertex its goal.
    pub fn goals(&self) -> &[G] {
        &self.goals
    }

    /// Where a vertex was reached lately, as (episode, step), oldest first.
    pub fn effects(&self, v: Vertex) -> &[(u64, u32)] {
        &self.effects[v.index()]
    }

    /// N(s): the vertices whose goals `s` attains (equation 7.2).
    pub fn vertices_at<O>(&self, s: &O) -> Vec<Vertex>
    where
        G: Goal<O>,
    {
        self.graph.vertices().filter(|v| self.goals[v.index()].reached(s)).collect()
    }

    /// How probable it is that the skill of each of these vertices succeeds from `s` (equation 7.5).
    fn probabilities<O, A>(&self, s: &O, vertices: &[Vertex]) -> Vec<f32>
    where
        P: SkillPolicy<O, A, G>,
    {
        let calls: Vec<_> = vertices.iter().map(|v| (v.skill(), Some(&self.goals[v.index()]))).collect();
        self.successes(s, &calls)
    }

    /// How probable it is that each of these calls succeeds from `s`.
    fn successes<O, A>(&self, s: &O, calls: &[(SkillId, Option<&G>)]) -> Vec<f32>
    where
        P: SkillPolicy<O, A, G>,
    {
        let values = self.policy.values(&Memory::new(), s, calls);
        values.into_iter().map(|value| value.clamp(0.0, 1.0)).collect()
    }

    /// States in which a vertex was reached lately, of episodes that are still remembered, oldest first.
    fn states<'a, O, A>(&self, v: Vertex, all: &'a Experience<O, A>) -> Vec<&'a O> {
        let at = |(number, step): &(u64, u32)| Some(&all.episode(*number)?.observations[*step as usize]);
        self.effects[v.index()].iter().filter_map(at).collect()
    }

    /// The planner of who explores, or of who does not.
    fn planner(&self, explore: bool) -> &dyn Planner {
        match &self.sober {
            Some(sober) if !explore => &**sober,
            _ => &*self.planner,
        }
    }

    /// The call of the skill that ends at `v`.
    pub(crate) fn call(&self, v: Vertex) -> Call<G>
    where
        G: Clone,
    {
        Call { skill: v.skill(), goal: Some(self.goals[v.index()].clone()), budget: self.config.horizon }
    }

    /// What is done beyond the graph.
    fn exploration(&self) -> Call<G> {
        let budget = if self.config.explore_for == 0 { u32::MAX } else { self.config.explore_for };
        Call { skill: SkillId::GLOBAL, goal: None, budget }
    }

    /// The vertex to call next by a plan: from where one is on the graph the planned one, otherwise the one that is most
    /// probably reached (7.2.2.5). None where no skill is known to lead anywhere: there is no closest vertex then.
    fn next<O, A>(&self, here: &[Vertex], plan: &Plan, s: &O, ctx: &mut Context) -> Option<Vertex>
    where
        P: SkillPolicy<O, A, G>,
    {
        let planned: Vec<_> = here.iter().filter(|v| plan.next[v.index()].is_some()).collect();
        if !planned.is_empty() {
            let values: Vec<_> = planned.iter().map(|v| plan.value[v.index()]).collect();
            return plan.next[planned[argmax(&values, &mut ctx.acting)].index()];
        }
        if plan.elsewhere.is_some() {
            return plan.elsewhere;
        }
        let others: Vec<_> = self.graph.vertices().filter(|v| !here.contains(v)).collect();
        let probabilities = self.probabilities(s, &others);
        let closest = argmax(&probabilities, &mut ctx.acting);
        (probabilities.get(closest)? > &0.0).then(|| others[closest])
    }

    /// Where to explore from next, and the way there: among the vertices that the planner finds a way to. Nobody goes on
    /// from where episodes end, so such vertices are none of them; without any other there is nowhere to go first.
    fn choose<O, A>(
        &self,
        outside: &mut Memory,
        here: &[Vertex],
        all: &Experience<O, A>,
        ctx: &mut Context,
    ) -> Option<(Vertex, Plan)>
    where
        F: Frontier<O, A, G>,
    {
        let last = |v: &Vertex| self.effects[v.index()].last().copied();
        let over = |(number, step): (u64, u32)| {
            let episode = all.episode(number);
            episode.is_some_and(|e| e.end == Some(End::Terminated) && step as usize == e.actions.len())
        };
        let reachable = self.planner(ctx.explore).reachable(&self.graph, here);
        let candidates: Vec<_> = self
            .graph
            .vertices()
            .filter(|v| reachable[v.index()] && !last(v).is_some_and(over))
            .map(|vertex| Candidate { vertex, states: self.states(vertex, all) })
            .collect();
        if candidates.is_empty() {
            return None;
        }
        let target = self.frontier.choose(outside, &candidates, ctx);
        Some((target, self.planner(ctx.explore).plan(&self.graph, target)))
    }
}

impl<O, A, G, P, F> Discovery<O, A> for GraphExplorer<G, P, F>
where
    O: Clone,
    G: Goal<O>,
    P: SkillPolicy<O, A, G>,
    F: Frontier<O, A, G>,
{
    type Goal = G;
    type Lane = Lane<G>;

    fn decide(&self, lane: &mut Lane<G>, s: &O, all: &Experience<O, A>, ctx: &mut Context) -> Call<G> {
        let here = self.vertices_at(s);
        // Nowhere in the graph one is lost too, but there the closest vertex is the way (7.2.2.5).
        let stranded = |target: &Vertex, plan: &Plan| {
            !here.is_empty() && !here.contains(target) && here.iter().all(|v| plan.next[v.index()].is_none())
        };
        match &lane.errand {
            Errand::Going(target, plan) if !stranded(target, plan) => {}
            // Who has fallen off and come back elsewhere may find no way from there, and chooses anew.
            Errand::Idle | Errand::Going(..) => {
                let chosen = self.choose(&mut lane.outside, &here, all, ctx);
                lane.errand = chosen.map_or(Errand::Exploring, |(v, plan)| Errand::Going(v, plan));
            }
            Errand::Exploring | Errand::Sent(_) => {}
        }
        let call = match &lane.errand {
            Errand::Sent(mission) => self.on_mission(mission, &here, s, ctx),
            Errand::Going(target, plan) if !here.contains(target) => {
                self.next(&here, plan, s, ctx).map(|v| self.call(v))
            }
            _ => None,
        };
        let call = call.unwrap_or_else(|| {
            if !matches!(lane.errand, Errand::Sent(_)) {
                lane.errand = Errand::Exploring;
            }
            self.exploration()
        });
        lane.driver.hand_to(call.skill);
        call
    }

    fn act(&self, lane: &mut Lane<G>, call: &Call<G>, s: &O, ctx: &mut Context) -> A {
        match call.skill {
            SkillId::GLOBAL => self.frontier.act(&mut lane.outside, s, ctx),
            _ => self.policy.act(lane.driver.memory(), call, s, ctx),
        }
    }

    fn reached(&self, call: &Call<G>, t: &Transition<O, A>) -> bool {
        call.goal.as_ref().is_some_and(|goal| goal.reached(t.after))
    }

    /// The frontier has counted the last state of an exploration when it is asked what was new about it.
    fn seen(&mut self, all: &Experience<O, A>, ctx: &mut Context) {
        self.frontier.step(all, ctx);
    }

    fn finished(&mut self, lane: &mut Lane<G>, out: &Outcome<G>, all: &Experience<O, A>, ctx: &mut Context) {
        let Some(episode) = all.episode(out.episode) else { return };
        let (from, to) = (out.steps.start as usize, out.steps.end as usize);
        if let Some(v) = Vertex::of(out.call.skill) {
            let reward = episode.rewards[from..to].iter().sum();
            let changed: Vec<_> =
                self.vertices_at(&episode.observations[from]).into_iter().map(|i| (i, v)).collect();
            for (i, _) in &changed {
                self.graph.called(*i, v, out.stop == Stop::Reached, reward, (to - from) as u32);
            }
            if let Errand::Going(target, plan) = &mut lane.errand {
                self.planner.replan(&self.graph, *target, plan, &changed);
            }
            if out.stop != Stop::Reached {
                let (steps, goal) = (out.steps.clone(), out.call.goal.clone());
                let aim = Aim::Subgoal { attained: false };
                self.policy
                    .lesson(v.skill(), Lesson { episode: out.episode, steps, aim, goal, rewards: None });
            }
        } else {
            let states = &episode.observations[from + 1..=to];
            let found = self.frontier.propose(states, ctx);
            lane.errand = Errand::Idle;
            if let Some(goal) = found {
                self.add(goal, all);
            }
        }
        if out.end.is_some() {
            self.close(out.episode, all, ctx);
        }
    }

    fn learn(&mut self, call: &Call<G>, all: &Experience<O, A>, ctx: &mut Context) {
        self.policy.step(call.skill, all, ctx);
    }

    fn updates(&self) -> Vec<(&'static str, u64)> {
        vec![("skills", self.policy.updates()), ("frontier", self.frontier.updates())]
    }
}

impl<G, P, F> Checkpoint for GraphExplorer<G, P, F>
where
    G: Serialize + serde::de::DeserializeOwned,
    P: Checkpoint,
    F: Checkpoint,
{
    fn save(&self, bag: &mut Bag) {
        bag.put("graph", &(&self.graph, &self.goals, &self.effects));
        bag.put_part("policy", &self.policy);
        bag.put_part("frontier", &self.frontier);
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        (self.graph, self.goals, self.effects) = bag.get("graph")?;
        bag.get_part("policy", &mut self.policy)?;
        bag.get_part("frontier", &mut self.frontier)
    }
}
