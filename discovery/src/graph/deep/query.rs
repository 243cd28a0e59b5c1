//! Querying the skill graph (6.1.5): from where one is to any place, by the three cases of the thesis.
//!
//! A frozen agent walks the parts outside the graph without options. One that may learn has the place as its task: it
//! becomes a region, and chains are built to it as in training.

use inroads_agents::{Actor, Agent, Context, Experience};
use inroads_envs::Seed;

use super::{DeepGraph, Lane, Region};
use crate::graph::{Plan, Vertex};
use crate::{
    Call, Goal, Hierarchy, Initiation, SkillPolicy, SkillRecord, Skilled,
    record::{EdgeRecord, GraphRecord, Place, PlanRecord, Query, VertexRecord},
};

/// How far an actor has come with a query.
#[derive(Clone, Debug, Default)]
pub(super) struct Progress {
    /// The vertex that the graph is left from.
    target: Option<Vertex>,
    /// The step at which it was left.
    left: Option<u32>,
}

impl<A, I: Initiation<Vec<f32>, A>, P> DeepGraph<A, I, P> {
    /// The vertex to plan to for a place, and whether being there is being at the place: one whose effect set lies in it,
    /// and otherwise the nearest.
    ///
    /// Of the vertices that can be reached from these; but of all regions that an edge leads to where none of them is nearer
    /// than `s`: then `s` counts as outside the graph, although it lies in some part of it that leads nowhere.
    fn target(
        &self,
        goal: &Region,
        (s, here): (Option<&Vec<f32>>, &[Vertex]),
        all: &Experience<Vec<f32>, A>,
        ctx: &mut Context,
    ) -> Option<(Vertex, bool)> {
        let graph = self.atlas.graph();
        let within = |v: &Vertex| {
            let mut effects = self.atlas.effects(*v, all).peekable();
            effects.peek().is_some() && effects.all(|s| goal.reached(s))
        };
        let mut best = |among: &[bool]| {
            let inside = graph.vertices().filter(|v| among[v.index()]).find(within);
            inside.map(|v| (v, true)).or_else(|| Some((self.nearest(goal, among, all, ctx)?, false)))
        };
        let mut regions = vec![false; graph.len()];
        for (_, j, _) in graph.edges().filter(|(_, j, _)| self.atlas.region(*j).is_some()) {
            regions[j.index()] = true;
        }
        if !regions.contains(&true) {
            self.atlas.regions().for_each(|(v, _)| regions[v.index()] = true);
        }
        let found = best(&graph.descendants(here));
        let nearer = |v: Vertex| s.is_none_or(|s| self.atlas.distance(v, goal, all) < goal.distance(s));
        found.filter(|(v, _)| nearer(*v)).or_else(|| best(&regions))
    }

    /// What to do next on the way to a place.
    pub(super) fn pursuit(
        &self,
        lane: &mut Lane,
        goal: &Region,
        s: &Vec<f32>,
        all: &Experience<Vec<f32>, A>,
        ctx: &mut Context,
    ) -> Call<Region> {
        if self.config.flat {
            return Call { budget: self.config.horizon, ..self.walk(goal) };
        }
        if let Some(left) = lane.query.left {
            // Beside the place for so long: the graph is entered anew.
            let lost = lane.clock - left >= 2 * self.config.horizon;
            if goal.reached(s) || !lost {
                return self.walk(goal);
            }
            lane.query = Progress::default();
        }
        let target =
            lane.query.target.or_else(|| Some(self.target(goal, (Some(s), &self.atlas.at(s)), all, ctx)?.0));
        lane.query.target = target;
        match target {
            Some(v) if !self.atlas.ended(v, s) => self.towards(lane, v, s, all, ctx),
            _ => {
                lane.query.left = Some(lane.clock);
                self.walk(goal)
            }
        }
    }

    /// The way from a place to another, as far as can be told before it is gone.
    fn way(
        &self,
        from: &Place<'_, Vec<f32>>,
        to: &Place<'_, Vec<f32>>,
        all: &Experience<Vec<f32>, A>,
        ctx: &mut Context,
    ) -> Option<PlanRecord> {
        let (seen, here) = match from {
            Place::Vertex(v) => (None, vec![self.vertex(*v)?]),
            Place::State(s) => (Some(*s), self.atlas.at(s)),
        };
        let (target, outside) = match to {
            Place::Vertex(v) => (self.vertex(*v)?, None),
            Place::State(s) => {
                let goal = self.ground.ball(self.ground.place(s), self.config.tolerance);
                if seen.is_some_and(|s| goal.reached(s)) {
                    return Some(PlanRecord { case: Query::Inside, legs: Vec::new(), outside: 1.0 });
                }
                let (target, inside) = self.target(&goal, (seen, &here), all, ctx)?;
                let rest = (!inside).then(|| self.walks.probability(self.atlas.distance(target, &goal, all)));
                (target, rest)
            }
        };
        let plan = self.planner.plan(self.atlas.graph(), target);
        let mut legs = Vec::new();
        let mut started = true;
        let first = match from {
            Place::Vertex(v) => Vertex(*v),
            // Already there.
            Place::State(s) if self.atlas.ended(target, s) => target,
            Place::State(s) => match self.first((&plan, target), s, None, ctx) {
                Some((o, _)) => {
                    legs.push((o.0, self.atlas.probability(self.atlas.regions_at(s).first().copied(), o)));
                    o
                }
                None => {
                    let (v, region) = self.entry((&plan, target), s)?;
                    if !region.reached(s) {
                        started = false;
                        legs.push((v.0, self.walks.probability(region.distance(s))));
                    }
                    v
                }
            },
        };
        self.follow(&plan, first, target, &mut legs)?;
        let case = match (started, outside) {
            (false, _) => Query::StartOutside,
            (true, Some(_)) => Query::GoalOutside,
            (true, None) => Query::Inside,
        };
        Some(PlanRecord { case, legs, outside: outside.unwrap_or(1.0) })
    }

    /// The legs of a plan behind a vertex; none where there is no way.
    fn follow(&self, plan: &Plan, first: Vertex, target: Vertex, legs: &mut Vec<(u32, f32)>) -> Option<()> {
        let mut at = first;
        // No way needs a vertex twice: a longer one goes round.
        for _ in 0..plan.next.len() {
            if at == target {
                return Some(());
            }
            let next = plan.next[at.index()]?;
            legs.push((next.0, self.atlas.probability(Some(at), next)));
            at = next;
        }
        None
    }

    fn vertex(&self, number: u32) -> Option<Vertex> {
        self.atlas.graph().vertices().find(|v| v.0 == number)
    }
}

/// A context for questions that nobody acts on. Ties of plans are broken as its seed has it.
fn asking() -> Context {
    Context::evaluation(Seed(0), 0)
}

impl<A, I, P> Skilled<Vec<f32>, A> for Hierarchy<Vec<f32>, A, DeepGraph<A, I, P>>
where
    A: Clone,
    I: Initiation<Vec<f32>, A>,
    P: SkillPolicy<Vec<f32>, A, Region>,
    Self: Agent<Vec<f32>, A>,
{
    fn skills(&self) -> Vec<SkillRecord> {
        let atlas = &self.method().atlas;
        let record = |o: Vertex| {
            let skill = atlas.skill(o);
            SkillRecord {
                skill: o.skill().0,
                enters: Some(atlas.end(o).skill().0),
                phase: skill.phase,
                born: skill.born,
                executions: skill.executions,
                successes: skill.successes,
                examples: atlas.examples(o),
            }
        };
        atlas.options().map(record).collect()
    }

    fn members(&self, s: &Vec<f32>) -> Vec<bool> {
        let atlas = &self.method().atlas;
        atlas.options().map(|o| atlas.contains(o, s)).collect()
    }

    fn graph(&self) -> Option<GraphRecord> {
        let (method, all) = (self.method(), self.experience());
        let (atlas, graph) = (&method.atlas, method.atlas.graph());
        let vertex = |v: Vertex| VertexRecord {
            vertex: v.0,
            at: atlas.effects(v, all).last().cloned().unwrap_or_default(),
            visits: graph.visits(v),
            kept: atlas.region(v).map_or_else(Vec::new, |region| region.kept().collect()),
        };
        let edges = graph.edges().map(|(i, j, edge)| EdgeRecord {
            from: i.0,
            to: j.0,
            probability: atlas.probability(Some(i), j),
            tries: edge.tries,
            successes: edge.successes,
        });
        Some(GraphRecord { vertices: graph.vertices().map(vertex).collect(), edges: edges.collect() })
    }

    fn plan(&self, from: &Place<'_, Vec<f32>>, to: &Place<'_, Vec<f32>>) -> Option<PlanRecord> {
        self.method().way(from, to, self.experience(), &mut asking())
    }

    fn pursue(&self, to: &Place<'_, Vec<f32>>) -> Option<Box<dyn Actor<Vec<f32>, A> + '_>> {
        let (method, all) = (self.method(), self.experience());
        let region = match to {
            Place::State(s) => method.ground.ball(method.ground.place(s), method.config.tolerance),
            Place::Vertex(v) => {
                let v = method.vertex(*v)?;
                let effect = || method.atlas.effects(v, all).last();
                match method.atlas.region(v) {
                    Some(region) => region.clone(),
                    None => method.ground.ball(method.ground.place(effect()?), method.config.tolerance),
                }
            }
        };
        Some(self.watch(Lane::pursuing(region)))
    }
}
