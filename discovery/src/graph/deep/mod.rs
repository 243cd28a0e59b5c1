//! Deep skill graphs (chapter 6): an agent that proposes places to itself, connects them by chains of options, and plans
//! on the graph that they form.
//!
//! It is not the explorer of chapters 7 and 9: there a vertex is a goal and its one policy may be called from anywhere,
//! here options have initiation sets, several may lead to one region, and edges follow from sets and not from counts.
//! Graph, planner, sets, gestation, policies and the execution of options are the same.

mod atlas;
mod config;
mod consolidate;
mod learning;
mod query;
mod sampled;
mod travel;
mod walks;

pub use config::DeepGraphConfig;
pub use inroads_agents::goal::{Ground, Region};

use inroads_agents::{Checkpoint, Context, Experience, Transition, checkpoint, draw::argmax};
use inroads_envs::Spec;
use rand::RngExt;

use super::{Plan, Planner, Vertex};
use crate::{Call, Discovery, Goal, Initiation, Outcome, SkillId, SkillPolicy, execution::Driver};
use atlas::Atlas;
use consolidate::Chains;
use query::Progress;
use sampled::Sampled;
use walks::Walks;

/// Draws of a place before an expansion is given up (authors).
const DRAWS: u32 = 50;

/// Builds a graph of goal regions and options with a family of initiation sets `I` and of option policies `P`.
pub struct DeepGraph<A, I, P> {
    config: DeepGraphConfig,
    ground: Ground,
    /// The task's goal, where there is a task.
    task: Option<Region>,
    sampler: Sampled,
    planner: Box<dyn Planner>,
    atlas: Atlas<A, I>,
    chains: Chains,
    walks: Walks,
    policy: P,
    /// Vertices whose edges are to be tested again. Empty between episodes.
    changed: Vec<Vertex>,
}

checkpoint!([A, I, P] DeepGraph<A, I, P>; plain: chains, walks; parts: atlas, policy; where I: Checkpoint, P: Checkpoint);

/// What a deep graph keeps for one episode of one actor.
#[derive(Clone, Debug, Default)]
pub struct Lane {
    /// Who acts.
    driver: Driver,
    /// Steps of the episode so far.
    clock: u32,
    /// Expansions tried in this episode.
    tries: u32,
    errand: Errand,
    /// The option that failed last, while no other has succeeded since: it is not called again from there.
    failed: Option<Vertex>,
    /// Where a query wants to be; none where the agent may do what it likes.
    wanted: Option<Region>,
    query: Progress,
    /// The latest plan, where it leads, and the revision of the graph that it holds for.
    plan: Option<(Plan, Vertex, u64)>,
}

impl Lane {
    /// For an episode with a query.
    fn pursuing(wanted: Region) -> Self {
        Self { wanted: Some(wanted), ..Self::default() }
    }
}

/// What an actor is about.
#[derive(Clone, Debug, Default)]
enum Errand {
    #[default]
    Idle,
    /// On the way to a vertex since a step, and what is to be done there.
    Going(Vertex, u32, Then),
    /// Some steps in the direction of a place, outside the graph, since a step.
    Extending(Region, u32),
    /// From one region to another, to which there is no way yet.
    Connecting(Attempt),
}

/// What is done at a vertex.
#[derive(Clone, Debug)]
enum Then {
    Nothing,
    Extend(Region),
    Connect(Vertex),
}

/// An attempt to get from one region to another.
#[derive(Clone, Debug)]
struct Attempt {
    from: Vertex,
    to: Vertex,
    /// The step at which it began, and how far away.
    since: u32,
    distance: f32,
    /// Whether it has met an event that an option could aim at.
    met: bool,
    /// Whether an option has acted.
    helped: bool,
}

impl<A, I: Initiation<Vec<f32>, A>, P> DeepGraph<A, I, P> {
    /// A graph without a vertex; `initiation` and `policy` must be as young.
    pub fn new(
        config: &DeepGraphConfig,
        spec: &Spec,
        ground: Ground,
        planner: Box<dyn Planner>,
        initiation: I,
        policy: P,
    ) -> Self {
        let task = spec.goal.as_ref().map(|goal| ground.ball(goal.at.clone(), goal.tolerance));
        Self {
            config: config.clone(),
            task,
            sampler: Sampled::new(ground.bounds().to_vec(), DRAWS),
            ground,
            planner,
            atlas: Atlas::new(initiation, config.inclusion),
            chains: Chains::default(),
            walks: Walks::default(),
            policy,
            changed: Vec::new(),
        }
    }

    /// One step straight to a place, without an option.
    fn walk(&self, to: &Region) -> Call<Region> {
        Call { skill: SkillId::GLOBAL, goal: Some(to.clone()), budget: 1 }
    }

    fn random_place(&self, ctx: &mut Context) -> Region {
        self.ground.ball(self.sampler.place(&mut ctx.acting), self.config.tolerance)
    }

    /// The call of an option: for the region that it ends in, or for a state in which it has ended (6.2.1).
    fn call(&self, o: Vertex, s: &[f32], all: &Experience<Vec<f32>, A>, ctx: &mut Context) -> Call<Region> {
        let goal = self.atlas.region(self.atlas.end(o)).cloned().unwrap_or_else(|| {
            let effects: Vec<_> = self.atlas.effects(o, all).collect();
            // An option is born with effects; they may be forgotten when it was not executed for long.
            let at = if effects.is_empty() { s } else { effects[ctx.acting.random_range(0..effects.len())] };
            self.ground.ball(self.ground.place(at), self.config.tolerance)
        });
        Call { skill: o.skill(), goal: Some(goal), budget: self.config.horizon }
    }

    /// What an agent that may do what it likes does next.
    fn errand(
        &self,
        lane: &mut Lane,
        s: &Vec<f32>,
        all: &Experience<Vec<f32>, A>,
        ctx: &mut Context,
    ) -> Call<Region> {
        if self.config.flat || self.atlas.graph().is_empty() {
            let budget = if self.config.flat { self.config.horizon } else { 1 };
            return Call { budget, ..self.walk(&self.random_place(ctx)) };
        }
        if self.spent(lane, s) {
            lane.errand = Errand::Idle;
        }
        loop {
            lane.errand = match &lane.errand {
                Errand::Idle => self.choose(lane, s, all, ctx),
                Errand::Going(target, _, then) if self.atlas.ended(*target, s) => match then {
                    Then::Nothing => Errand::Idle,
                    Then::Extend(place) => Errand::Extending(place.clone(), lane.clock),
                    Then::Connect(to) => self.attempt(*target, *to, s, lane.clock),
                },
                Errand::Going(target, ..) => {
                    let target = *target;
                    return self.towards(lane, target, s, all, ctx);
                }
                Errand::Extending(place, _) => {
                    return Call { budget: self.config.extension, ..self.walk(place) };
                }
                Errand::Connecting(attempt) => return self.connect(attempt, s, all, ctx),
            };
        }
    }

    /// Whether the errand has had its time. An agent that is watched is never told that a call is over
    /// ([`Discovery::finished`]), so this is asked before the next one.
    fn spent(&self, lane: &Lane, s: &Vec<f32>) -> bool {
        match &lane.errand {
            Errand::Idle => false,
            Errand::Going(_, since, _) => lane.clock - since >= self.config.patience,
            Errand::Extending(_, since) => lane.clock > *since,
            Errand::Connecting(attempt) => {
                self.atlas.contains(attempt.to, s) || lane.clock - attempt.since >= self.limit(attempt)
            }
        }
    }

    /// Steps that an attempt may take.
    fn limit(&self, attempt: &Attempt) -> u32 {
        if attempt.met { self.config.patience } else { self.config.horizon }
    }

    fn attempt(&self, from: Vertex, to: Vertex, s: &[f32], since: u32) -> Errand {
        let distance = self.atlas.region(to).map_or(0.0, |region| region.distance(s));
        Errand::Connecting(Attempt { from, to, since, distance, met: false, helped: false })
    }

    /// The next errand: to expand the graph or to consolidate it, or to go to a region that one is not in. Where there is
    /// but one region, the graph is expanded.
    fn choose(
        &self,
        lane: &mut Lane,
        s: &Vec<f32>,
        all: &Experience<Vec<f32>, A>,
        ctx: &mut Context,
    ) -> Errand {
        let here = self.atlas.at(s);
        let graph = self.atlas.graph();
        let reachable = self.planner.reachable(graph, &here);
        if self.expands(lane, all, ctx) {
            lane.tries += 1;
            let new = |place: &[f32]| !self.atlas.known(&self.ground.moved(s, place), self.config.spacing);
            if let Some(place) = self.sampler.acceptable(new, &mut ctx.acting) {
                let place = self.ground.ball(place, self.config.tolerance);
                let nearest = self.nearest(&place, &reachable, all, ctx);
                return nearest.map_or(Errand::Idle, |v| Errand::Going(v, lane.clock, Then::Extend(place)));
            }
        }
        // A_g, where there is a goal to be reached; all that cannot be reached otherwise.
        let to_task = self.task_vertex().map(|task| (self.planner.plan(graph, task), task));
        let wanted = |v: Vertex| to_task.as_ref().is_none_or(|(plan, task)| plan.leads(v, *task));
        let patience = self.config.gestation;
        let pair = self.chains.closest(&self.atlas, &reachable, wanted, patience, all, &mut ctx.acting);
        if let Some((d, a)) = pair {
            return Errand::Going(d, lane.clock, Then::Connect(a));
        }
        let others: Vec<_> = match self.task_vertex() {
            Some(v) => vec![v],
            None => self.atlas.regions().map(|(v, _)| v).collect(),
        };
        let others: Vec<_> = others.into_iter().filter(|v| !self.atlas.ended(*v, s)).collect();
        match others.len() {
            0 => Errand::Extending(self.random_place(ctx), lane.clock),
            n => Errand::Going(others[ctx.acting.random_range(0..n)], lane.clock, Then::Nothing),
        }
    }

    /// Whether the next errand of this episode is an expansion.
    fn expands(&self, lane: &Lane, all: &Experience<Vec<f32>, A>, ctx: &Context) -> bool {
        let due = self.config.expand_every > 0 && all.latest().is_multiple_of(self.config.expand_every);
        ctx.explore && due && lane.tries < self.config.tries && self.has_room()
    }

    fn has_room(&self) -> bool {
        self.atlas.graph().len() < self.config.max_vertices as usize
    }

    /// The region of the task's goal, once it is in the graph.
    fn task_vertex(&self) -> Option<Vertex> {
        let task = self.task.as_ref()?;
        self.atlas.regions().find(|(_, region)| *region == task).map(|(v, _)| v)
    }

    /// v_nn: the nearest of these vertices to a place (6.1.3).
    fn nearest(
        &self,
        place: &Region,
        among: &[bool],
        all: &Experience<Vec<f32>, A>,
        ctx: &mut Context,
    ) -> Option<Vertex> {
        let vertices: Vec<_> = self.atlas.graph().vertices().filter(|v| among[v.index()]).collect();
        let nearness: Vec<_> = vertices.iter().map(|v| -self.atlas.distance(*v, place, all)).collect();
        (!vertices.is_empty()).then(|| vertices[argmax(&nearness, &mut ctx.acting)])
    }

    /// What to do between two regions: an option of their chain if one can be executed, otherwise a step straight on.
    fn connect(
        &self,
        attempt: &Attempt,
        s: &Vec<f32>,
        all: &Experience<Vec<f32>, A>,
        ctx: &mut Context,
    ) -> Call<Region> {
        let options = self.chains.options(attempt.from, attempt.to);
        if let Some(o) = options.iter().find(|o| self.atlas.executable(**o, s)) {
            return self.call(*o, s, all, ctx);
        }
        match self.atlas.region(attempt.to) {
            Some(region) => self.walk(region),
            None => self.walk(&self.random_place(ctx)),
        }
    }
}

impl<A, I, P> Discovery<Vec<f32>, A> for DeepGraph<A, I, P>
where
    I: Initiation<Vec<f32>, A>,
    P: SkillPolicy<Vec<f32>, A, Region>,
{
    type Goal = Region;
    type Lane = Lane;

    fn decide(
        &self,
        lane: &mut Lane,
        s: &Vec<f32>,
        all: &Experience<Vec<f32>, A>,
        ctx: &mut Context,
    ) -> Call<Region> {
        if let Some(o) = lane.driver.owner().and_then(Vertex::of) {
            lane.failed = Some(o).filter(|o| !self.atlas.ended(*o, s));
        }
        let task = || self.task.clone().filter(|_| !ctx.explore);
        let call = match lane.wanted.clone().or_else(task) {
            Some(goal) => self.pursuit(lane, &goal, s, all, ctx),
            None => self.errand(lane, s, all, ctx),
        };
        lane.driver.hand_to(call.skill);
        call
    }

    fn act(&self, lane: &mut Lane, call: &Call<Region>, s: &Vec<f32>, ctx: &mut Context) -> A {
        lane.clock += 1;
        self.policy.act(lane.driver.memory(), call, s, ctx)
    }

    fn reached(&self, call: &Call<Region>, t: &Transition<Vec<f32>, A>) -> bool {
        match Vertex::of(call.skill) {
            Some(o) => self.atlas.ended(o, t.after),
            None => call.goal.as_ref().is_some_and(|goal| goal.reached(t.after)),
        }
    }

    fn finished(
        &mut self,
        lane: &mut Lane,
        out: &Outcome<Region>,
        all: &Experience<Vec<f32>, A>,
        ctx: &mut Context,
    ) {
        if let Some(o) = Vertex::of(out.call.skill) {
            self.executed(o, out, all, ctx);
        }
        let over = match &mut lane.errand {
            Errand::Idle => self.config.flat && self.walked(out, all, ctx),
            Errand::Going(_, since, _) => out.steps.end - *since >= self.config.patience,
            Errand::Extending(..) => self.extended(out, all, ctx),
            Errand::Connecting(attempt) => self.connected(attempt, out, all, ctx),
        };
        if over {
            lane.errand = Errand::Idle;
            self.relink(all);
        }
    }

    fn learn(&mut self, call: &Call<Region>, all: &Experience<Vec<f32>, A>, ctx: &mut Context) {
        self.perceive(all);
        self.policy.step(call.skill, all, ctx);
    }

    fn updates(&self) -> Vec<(&'static str, u64)> {
        vec![("options", self.policy.updates())]
    }
}
