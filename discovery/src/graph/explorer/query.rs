//! Goals that somebody else has: plans to them, and going there (thesis 6.1.5, 7.3.3.2).

use inroads_agents::{Context, Experience};

use super::{Errand, GraphExplorer, Lane};
use crate::{
    Call, Goal, SkillPolicy,
    frontier::Frontier,
    graph::{Cost, Dijkstra, Direct, Plan, Planner, Vertex},
    record::{Place, PlanRecord, Query},
};

/// Who is asked for a way answers with the one that most probably succeeds, whoever plans for who explores: rewards on
/// the way are no matter of the question, and [`Direct`] has nothing to say of ways.
const ASKED: Dijkstra = Dijkstra { cost: Cost::Surprise };

/// On the way to a goal that somebody else has.
#[derive(Clone, Debug)]
pub(super) struct Mission<G> {
    goal: G,
    /// The vertex that lies there, or the one from which the goal is most probably reached.
    target: Vertex,
    /// V of the goal from there; none where the vertex lies there.
    near: Option<f32>,
    plan: Plan,
}

impl<G, P, F> GraphExplorer<G, P, F> {
    /// How probably a goal is reached from `s`.
    fn value<O, A>(&self, s: &O, v: Vertex, goal: &G) -> f32
    where
        P: SkillPolicy<O, A, G>,
    {
        self.successes(s, &[(v.skill(), Some(goal))])[0]
    }

    /// What it takes to go to a place; none where no goal can be made of it, or there is no graph.
    fn mission<O, A>(&self, to: &Place<'_, O>, all: &Experience<O, A>) -> Option<Mission<G>>
    where
        G: Goal<O>,
        P: SkillPolicy<O, A, G>,
        F: Frontier<O, A, G>,
    {
        let inside = match to {
            Place::Vertex(number) => self.graph.vertices().find(|v| v.0 == *number),
            Place::State(s) => self.vertices_at(*s).first().copied(),
        };
        let (goal, target, near) = match (inside, to) {
            (Some(v), _) => (self.goals[v.index()].clone(), v, None),
            (None, Place::State(s)) => {
                let goal = self.frontier.aim(s)?;
                let (target, near) = self.closest_to(&goal, all)?;
                (goal, target, Some(near))
            }
            (None, Place::Vertex(_)) => return None,
        };
        let plan = ASKED.plan(&self.graph, target);
        Some(Mission { goal, target, near, plan })
    }

    /// The vertex from which a goal is most probably reached (equation 7.10), and how probably.
    fn closest_to<O, A>(&self, goal: &G, all: &Experience<O, A>) -> Option<(Vertex, f32)>
    where
        P: SkillPolicy<O, A, G>,
    {
        let mean = |v: Vertex| {
            let states = self.states(v, all);
            let sum: f32 = states.iter().map(|s| self.value(*s, v, goal)).sum();
            (v, sum / states.len().max(1) as f32)
        };
        self.graph.vertices().map(mean).reduce(|a, b| if b.1 > a.1 { b } else { a })
    }

    /// The call of one who was sent: along the plan; and for the goal itself where the plan ends, or where it is as near.
    /// None once one is there.
    pub(super) fn on_mission<O, A>(
        &self,
        mission: &Mission<G>,
        here: &[Vertex],
        s: &O,
        ctx: &mut Context,
    ) -> Option<Call<G>>
    where
        G: Goal<O>,
        P: SkillPolicy<O, A, G>,
    {
        let Mission { goal, target, near, plan } = mission;
        if goal.reached(s) {
            return None;
        }
        let direct = Call { skill: target.skill(), goal: Some(goal.clone()), budget: self.config.horizon };
        if here.contains(target) || near.is_some_and(|near| self.value(s, *target, goal) >= near) {
            return Some(direct);
        }
        Some(self.next(here, plan, s, ctx).map_or(direct, |v| self.call(v)))
    }

    /// A lane on the way to a place, by plans; none where there is no way to make one.
    pub(crate) fn sent<O, A>(&self, to: &Place<'_, O>, all: &Experience<O, A>) -> Option<Lane<G>>
    where
        G: Goal<O>,
        P: SkillPolicy<O, A, G>,
        F: Frontier<O, A, G>,
    {
        Some(Lane { errand: Errand::Sent(self.mission(to, all)?), ..Lane::default() })
    }

    /// A lane on which the skill of `v` is called again and again, wherever one is: to see how often it succeeds.
    ///
    /// # Panics
    /// When there is no such vertex.
    pub fn calling(&self, v: Vertex) -> Lane<G>
    where
        G: Clone,
    {
        let plan = Direct.plan(&self.graph, v);
        let mission = Mission { goal: self.goals[v.index()].clone(), target: v, near: None, plan };
        Lane { errand: Errand::Sent(mission), ..Lane::default() }
    }

    /// The way from one place to another; none where there is none.
    pub(crate) fn way<O, A>(
        &self,
        from: &Place<'_, O>,
        to: &Place<'_, O>,
        all: &Experience<O, A>,
    ) -> Option<PlanRecord>
    where
        G: Goal<O>,
        P: SkillPolicy<O, A, G>,
        F: Frontier<O, A, G>,
    {
        let mission = self.mission(to, all)?;
        let starts = match from {
            Place::Vertex(number) => vec![self.graph.vertices().find(|v| v.0 == *number)?],
            Place::State(s) => self.vertices_at(*s),
        };
        let worth = |v: &Vertex| {
            if *v == mission.target { f32::INFINITY } else { mission.plan.value[v.index()] }
        };
        let mut legs = Vec::new();
        let mut at = match (starts.into_iter().reduce(|a, b| if worth(&b) > worth(&a) { b } else { a }), from)
        {
            (Some(v), _) => v,
            (None, Place::State(s)) => {
                let all: Vec<_> = self.graph.vertices().collect();
                let entered = all.iter().copied().zip(self.probabilities(*s, &all));
                let (v, p) =
                    entered.reduce(|a, b| if b.1 > a.1 { b } else { a }).filter(|(_, p)| *p > 0.0)?;
                legs.push((v.0, p));
                v
            }
            (None, Place::Vertex(_)) => return None,
        };
        let case = match (legs.is_empty(), mission.near.is_some()) {
            (false, _) => Query::StartOutside,
            (true, true) => Query::GoalOutside,
            (true, false) => Query::Inside,
        };
        while at != mission.target {
            let next = mission.plan.next[at.index()]?;
            legs.push((next.0, self.graph.edge(at, next).value));
            at = next;
        }
        Some(PlanRecord { case, legs, outside: mission.near.unwrap_or(1.0) })
    }
}
