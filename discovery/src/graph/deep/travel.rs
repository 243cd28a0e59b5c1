//! On the way to a vertex by plans (6.1.3): which option to execute next, and where to go where none can be executed.

use inroads_agents::{Context, Experience, draw::argmax};

use super::{DeepGraph, Lane, Region};
use crate::graph::{Plan, Vertex};
use crate::{Call, Initiation};

impl<A, I: Initiation<Vec<f32>, A>, P> DeepGraph<A, I, P> {
    /// The option at `s` from which the way of a plan is the shortest, and what that is worth; none where there is none
    /// (6.1.3, case a).
    pub(super) fn first(
        &self,
        (plan, target): (&Plan, Vertex),
        s: &Vec<f32>,
        failed: Option<Vertex>,
        ctx: &mut Context,
    ) -> Option<(Vertex, f32)> {
        let known = |o: &Vertex| plan.leads(*o, target) && failed != Some(*o);
        let options: Vec<_> =
            self.atlas.options().filter(known).filter(|o| self.atlas.executable(*o, s)).collect();
        if options.is_empty() {
            return None;
        }
        let here = self.atlas.regions_at(s).first().copied();
        let worth = |o: &Vertex| self.planner.through(&self.atlas.call(here, *o), *o, target, plan);
        let values: Vec<_> = options.iter().map(worth).collect();
        let best = argmax(&values, &mut ctx.acting);
        Some((options[best], values[best]))
    }

    /// The nearest region from which a plan leads on.
    pub(super) fn entry(&self, (plan, target): (&Plan, Vertex), s: &[f32]) -> Option<(Vertex, &Region)> {
        let known = self.atlas.regions().filter(|(v, _)| plan.leads(*v, target));
        known.min_by(|(_, a), (_, b)| a.distance(s).total_cmp(&b.distance(s)))
    }

    /// What to do at `s` on the way to a vertex: the first option of the plan, and without one a step to where the plan
    /// can be entered.
    pub(super) fn towards(
        &self,
        lane: &mut Lane,
        target: Vertex,
        s: &Vec<f32>,
        all: &Experience<Vec<f32>, A>,
        ctx: &mut Context,
    ) -> Call<Region> {
        let revision = self.atlas.revision();
        let plan = match lane.plan.take() {
            Some((plan, to, of)) if (to, of) == (target, revision) => plan,
            _ => self.planner.plan(self.atlas.graph(), target),
        };
        let call = self.next((&plan, target), lane.failed, s, all, ctx);
        lane.plan = Some((plan, target, revision));
        call
    }

    fn next(
        &self,
        (plan, target): (&Plan, Vertex),
        failed: Option<Vertex>,
        s: &Vec<f32>,
        all: &Experience<Vec<f32>, A>,
        ctx: &mut Context,
    ) -> Call<Region> {
        let first = self.first((plan, target), s, failed, ctx);
        // An edge forgives outliers: one may be in a region and not where the option may begin that leads on from there.
        // Rather than another that leads back (and so round for ever) the nearest state is looked for where it may.
        let worth = |v: &Vertex| first.is_none_or(|(_, value)| plan.value[v.index()] > value);
        let gate = self.atlas.regions_at(s).into_iter().filter(worth).find_map(|v| {
            let next = plan.next[v.index()].filter(|next| !self.atlas.executable(*next, s))?;
            self.gate(v, next, s, all)
        });
        match (gate, first) {
            (Some(gate), _) => self.walk(&gate),
            (None, Some((o, _))) => self.call(o, s, all, ctx),
            (None, None) => match self.entry((plan, target), s) {
                Some((_, region)) => self.walk(region),
                None => self.walk(&self.random_place(ctx)),
            },
        }
    }

    /// The nearest state of a region in which an option may begin.
    fn gate(&self, v: Vertex, o: Vertex, s: &[f32], all: &Experience<Vec<f32>, A>) -> Option<Region> {
        let gates = self.atlas.effects(v, all).filter(|gate| self.atlas.contains(o, gate));
        let places = gates.map(|gate| self.ground.ball(self.ground.place(gate), 0.0));
        places.min_by(|a, b| a.distance(s).total_cmp(&b.distance(s)))
    }
}
