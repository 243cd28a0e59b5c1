//! What a deep skill graph learns from what happened: regions (6.1.3), options and their sets (6.1.4, 3.1.3), and lessons
//! for policies that learn.

use std::ops::Range;

use inroads_agents::{Context, Experience, Lesson};
use rand::RngExt;

use super::{Attempt, DeepGraph, Region};
use crate::graph::Vertex;
use crate::{
    Initiation, Outcome, SkillId, SkillPolicy, Stop,
    chain::{Gestation, OptionReward, Phase, SHORTEST, observation},
    hindsight::lessons,
};

type All<A> = Experience<Vec<f32>, A>;

impl<A, I: Initiation<Vec<f32>, A>, P> DeepGraph<A, I, P> {
    /// Takes in the newest step: regions that were entered, and the regions of the start and of the task's goal where
    /// they are not in the graph yet.
    pub(super) fn perceive(&mut self, all: &All<A>)
    where
        P: SkillPolicy<Vec<f32>, A, Region>,
    {
        let number = all.latest();
        let Some(episode) = all.episode(number) else { return };
        let [.., before, after] = &episode.observations[..] else { return };
        let now = episode.actions.len() as u32;
        if now == 1 && !self.config.flat {
            if let Some(task) = self.task.clone().filter(|_| self.task_vertex().is_none()) {
                self.add_region(task, number);
            }
            for v in self.atlas.regions_at(before) {
                self.enter(v, number, 0);
            }
            if self.has_room() && self.atlas.at(before).is_empty() {
                let start = self.ground.ball(self.ground.place(before), self.config.tolerance);
                let v = self.add_region(start, number);
                self.enter(v, number, 0);
            }
        }
        let left = self.atlas.regions_at(before);
        for v in self.atlas.regions_at(after).into_iter().filter(|v| !left.contains(v)) {
            self.enter(v, number, now);
        }
        if episode.end.is_some() {
            self.relink(all);
        }
    }

    fn add_region(&mut self, region: Region, now: u64) -> Vertex
    where
        P: SkillPolicy<Vec<f32>, A, Region>,
    {
        let v = self.atlas.add_region(region, now);
        self.policy.born(v.skill());
        v
    }

    fn enter(&mut self, v: Vertex, episode: u64, step: u32) {
        self.atlas.entered(v, episode, step);
        self.changed.push(v);
    }

    /// Tests the edges of the vertices whose sets have changed.
    pub(super) fn relink(&mut self, all: &All<A>) {
        let mut changed = std::mem::take(&mut self.changed);
        changed.sort_unstable();
        changed.dedup();
        self.atlas.relink(&changed, all);
    }

    /// Option `o` was executed: its counts, its set while that is being learned (3.1.3), and its lessons.
    pub(super) fn executed(&mut self, o: Vertex, out: &Outcome<Region>, all: &All<A>, ctx: &mut Context)
    where
        P: SkillPolicy<Vec<f32>, A, Region>,
    {
        let Some(episode) = all.episode(out.episode) else { return };
        let (start, end) = (out.steps.start as usize, out.steps.end as usize);
        let success = out.stop == Stop::Reached;
        let from = self.atlas.regions_at(&episode.observations[start]);
        self.atlas.executed(o, &from, out.episode, (out.steps.start, out.steps.end), success);
        if self.atlas.skill(o).phase == Phase::Refining {
            match out.stop {
                Stop::Reached => {
                    // The start, and the last states: from each of them the execution went on to succeed.
                    let last = (end + 1).saturating_sub(self.config.segment as usize).max(start + 1);
                    let mut states = vec![episode.observations[start].clone()];
                    states.extend_from_slice(&episode.observations[last..=end]);
                    self.atlas.refine(o, &states, true);
                }
                Stop::TimedOut => self.atlas.refine(o, &episode.observations[start..=start], false),
                // Nobody knows what it would have done.
                Stop::CutShort => {}
            }
            if self.atlas.skill(o).successes >= self.config.refinements {
                self.atlas.fix(o);
            }
        }
        self.changed.push(o);
        self.teach(out, out.steps.clone(), all, ctx);
    }

    /// A walk to a random place is over, of an agent without a graph.
    pub(super) fn walked(&mut self, out: &Outcome<Region>, all: &All<A>, ctx: &mut Context) -> bool
    where
        P: SkillPolicy<Vec<f32>, A, Region>,
    {
        self.teach(out, out.steps.clone(), all, ctx);
        false
    }

    /// Some steps were made beyond the graph: where they led is a new region, if it is not known (6.1.3).
    pub(super) fn extended(&mut self, out: &Outcome<Region>, all: &All<A>, ctx: &mut Context) -> bool
    where
        P: SkillPolicy<Vec<f32>, A, Region>,
    {
        self.teach(out, out.steps.clone(), all, ctx);
        let Some(seen) = all.episode(out.episode).and_then(|e| e.observations.get(out.steps.end as usize))
        else {
            return true;
        };
        if self.has_room() && !self.atlas.known(seen, self.config.spacing) {
            let region = self.ground.ball(self.ground.place(seen), self.config.tolerance);
            let v = self.add_region(region, out.episode);
            self.enter(v, out.episode, out.steps.end);
        }
        true
    }

    /// A step or an option between two regions is over: what it tells of their chain, and whether the attempt is over.
    pub(super) fn connected(
        &mut self,
        attempt: &mut Attempt,
        out: &Outcome<Region>,
        all: &All<A>,
        ctx: &mut Context,
    ) -> bool
    where
        P: SkillPolicy<Vec<f32>, A, Region>,
    {
        let Some(seen) = all.episode(out.episode).and_then(|e| e.observations.get(out.steps.end as usize))
        else {
            return true;
        };
        let pair @ (from, to) = (attempt.from, attempt.to);
        let arrived = self.atlas.contains(to, seen);
        let steps = attempt.since..out.steps.end;
        if out.call.skill != SkillId::GLOBAL {
            attempt.helped = true;
        } else if !attempt.met {
            let entered =
                self.chains.options(from, to).iter().find(|o| self.atlas.contains(**o, seen)).copied();
            if let Some(event) = arrived.then_some(to).or(entered) {
                attempt.met = true;
                self.met(pair, event, (out.episode, steps.clone()), all);
            }
        }
        let spent = steps.end - steps.start;
        let too_long = spent >= self.limit(attempt);
        if arrived || too_long {
            self.chains.attempted(from, to, arrived);
        }
        if (arrived || too_long) && !attempt.helped {
            self.walks.count(attempt.distance, arrived);
        }
        let over = arrived || too_long || out.end.is_some();
        if over && !attempt.helped {
            self.teach(out, steps, all, ctx);
        }
        over
    }

    /// Some steps from one region towards another met an event: the end of the chain, or where one of its options may
    /// begin. With enough of them an option is created that ends there.
    fn met(
        &mut self,
        (from, to): (Vertex, Vertex),
        event: Vertex,
        (number, steps): (u64, Range<u32>),
        all: &All<A>,
    ) where
        P: SkillPolicy<Vec<f32>, A, Region>,
    {
        let spent = steps.end - steps.start;
        let full = self.chains.options(from, to).len() >= self.config.chain as usize || !self.has_room();
        if event != to && (full || spent < self.config.segment.div_ceil(SHORTEST)) {
            // It began at the border of that option's set, or there shall be no other option: the set is wider.
            if let Some(episode) = all.episode(number) {
                let states = &episode.observations[steps.start as usize..=steps.end as usize];
                self.atlas.refine(event, states, true);
                self.embrace(event, from, all);
            }
        } else if !full {
            let complete = self.chains.triggered((from, to), event, (number, steps), self.config.gestation);
            if let Some(gestation) = complete {
                self.bear(&gestation, (from, to), number, all);
            }
        }
    }

    /// Creates the option whose gestation is complete.
    fn bear(&mut self, gestation: &Gestation, (from, to): (Vertex, Vertex), now: u64, all: &All<A>)
    where
        P: SkillPolicy<Vec<f32>, A, Region>,
    {
        let moments = gestation.positives(self.config.segment, all);
        let positives: Vec<_> = moments.into_iter().filter_map(|m| observation(all, m)).cloned().collect();
        if positives.is_empty() {
            return;
        }
        let ended = gestation.entered();
        let spent = |steps: &Range<u32>| (steps.end - steps.start).min(self.config.segment) as f32;
        let mean = gestation.triggers.iter().map(|(_, steps)| spent(steps)).sum::<f32>() / ended.len() as f32;
        let o = self.atlas.add_option(gestation.subgoal, now, &positives, &ended, mean);
        self.policy.born(o.skill());
        self.chains.grow(from, to, o);
        self.embrace(o, from, all);
    }

    /// Where the region that a chain begins in touches the set of one of its options, all of the region's states become
    /// examples of that set (authors): they differ by less than the option can tell, and if it fails from one of them the
    /// set will shrink again.
    fn embrace(&mut self, o: Vertex, from: Vertex, all: &All<A>) {
        self.changed.push(o);
        let states: Vec<_> = self.atlas.effects(from, all).cloned().collect();
        if states.iter().any(|s| self.atlas.contains(o, s)) {
            self.atlas.refine(o, &states, true);
        }
    }

    /// Lessons of some steps of an errand: for the place that was wanted, for the one that was reached, and for one on the
    /// way (hindsight).
    fn teach(&mut self, out: &Outcome<Region>, steps: Range<u32>, all: &All<A>, ctx: &mut Context)
    where
        P: SkillPolicy<Vec<f32>, A, Region>,
    {
        let Some(episode) = all.episode(out.episode) else { return };
        let on_the_way = ctx.learning.random_range(steps.start..steps.end) + 1;
        let achieved = [steps.end, on_the_way].map(|step| {
            let place = self.ground.place(&episode.observations[step as usize]);
            self.ground.ball(place, self.config.tolerance)
        });
        for goal in out.call.goal.iter().chain(&achieved) {
            for lesson in lessons(goal, out.episode, episode, steps.clone()) {
                let rewards = (self.config.option_reward == OptionReward::Dense).then(|| {
                    let Range { start, end } = lesson.steps;
                    let afters = &episode.observations[start as usize + 1..=end as usize];
                    afters.iter().map(|after| -goal.distance(after)).collect()
                });
                self.policy.lesson(out.call.skill, Lesson { rewards, ..lesson });
            }
        }
    }
}
