//! What an episode that is over tells the graph: visits, edges, lessons, and what the values say of edges now.

use inroads_agents::{Context, Experience};
use rand::RngExt;

use super::GraphExplorer;
use crate::{Goal, SkillId, SkillPolicy, frontier::Frontier, graph::Vertex, hindsight::lessons};

/// States that are remembered of each vertex: the authors keep the last 20.
const EFFECTS: usize = 20;
/// The latest of them over which the values of edges are averaged. Ours: goals that are whole states have one state each,
/// and every value costs a look into a table or a network for every other vertex.
const SAMPLED: usize = 2;
/// Past episodes that may teach a new vertex, the latest: as many as the authors' effects, one each.
const PAST: usize = 20;

impl<G, P, F> GraphExplorer<G, P, F> {
    /// A new vertex with this goal, about which past episodes have something to teach; the running one when it is over.
    /// Nothing happens when there is one with the same goal, or there are too many.
    pub(super) fn add<O, A>(&mut self, goal: G, all: &Experience<O, A>)
    where
        G: Goal<O>,
        P: SkillPolicy<O, A, G>,
    {
        if self.graph.len() >= self.config.max_vertices as usize || self.goals.contains(&goal) {
            return;
        }
        let v = self.graph.add();
        self.effects.push(Vec::new());
        self.policy.born(v.skill());
        for number in all.numbers().rev().skip(1).take(PAST) {
            self.teach(v.skill(), &goal, number, all);
        }
        self.goals.push(goal);
    }

    /// Gives a skill the lessons of an episode in which its goal was attained.
    fn teach<O, A>(&mut self, skill: SkillId, goal: &G, number: u64, all: &Experience<O, A>)
    where
        G: Goal<O>,
        P: SkillPolicy<O, A, G>,
    {
        let Some(episode) = all.episode(number) else { return };
        if !episode.observations.iter().any(|s| goal.reached(s)) {
            return;
        }
        for lesson in lessons(goal, number, episode, 0..episode.actions.len() as u32) {
            self.policy.lesson(skill, lesson);
        }
    }

    /// Where an episode entered vertices: at which step which.
    fn entries<O, A>(&self, number: u64, all: &Experience<O, A>) -> Vec<(u32, Vertex)>
    where
        G: Goal<O>,
    {
        let Some(episode) = all.episode(number) else { return Vec::new() };
        let mut entries = Vec::new();
        let mut before = Vec::new();
        for (step, s) in episode.observations.iter().enumerate() {
            let here = self.vertices_at(s);
            entries.extend(here.iter().filter(|v| !before.contains(*v)).map(|v| (step as u32, *v)));
            before = here;
        }
        entries
    }

    /// An episode is over.
    pub(crate) fn close<O, A>(&mut self, number: u64, all: &Experience<O, A>, ctx: &mut Context)
    where
        G: Goal<O>,
        P: SkillPolicy<O, A, G>,
        F: Frontier<O, A, G>,
    {
        let Some(episode) = all.episode(number) else { return };
        if self.config.rewarded {
            let paid = episode.rewards.iter().zip(&episode.observations[1..]).filter(|(r, _)| **r > 0.0);
            let goals: Vec<_> = paid.filter_map(|(_, s)| self.frontier.aim(s)).collect();
            goals.into_iter().for_each(|goal| self.add(goal, all));
        }
        let entries = self.entries(number, all);
        let mut met: Vec<_> = entries.iter().map(|(_, v)| *v).collect();
        met.sort_unstable();
        met.dedup();
        for (at, (step, v)) in entries.iter().enumerate() {
            self.graph.visit(*v);
            let effects = &mut self.effects[v.index()];
            if effects.len() == EFFECTS {
                effects.remove(0);
            }
            effects.push((number, *step));
            // Observed transitions (7.2.2.3).
            let within =
                entries[at + 1..].iter().take_while(|(later, _)| later - step <= self.config.horizon);
            for (_, w) in within.filter(|(later, w)| later > step && w != v) {
                self.graph.change(*v, *w).connected = true;
            }
        }
        for v in &met {
            let goal = self.goals[v.index()].clone();
            self.teach(v.skill(), &goal, number, all);
        }
        for _ in 0..self.config.hindsight {
            let step = ctx.learning.random_range(1..episode.observations.len());
            let goal = self.frontier.aim(&episode.observations[step]);
            if let Some(goal) = goal.filter(|goal| !self.goals.contains(goal)) {
                self.teach(SkillId::GLOBAL, &goal, number, all);
            }
        }
        self.revalue(&met, all);
    }

    /// Puts the values of the policies on the edges (equation 7.5), and adds the edges that equation 7.7 asks for: those
    /// from the vertices that were `met`, whose counts are others now.
    fn revalue<O, A>(&mut self, met: &[Vertex], all: &Experience<O, A>)
    where
        P: SkillPolicy<O, A, G>,
    {
        let mut values = vec![0.0; self.graph.len()];
        for i in self.graph.vertices() {
            let states = self.states(i, all);
            let states = &states[states.len().saturating_sub(SAMPLED)..];
            if states.is_empty() {
                continue;
            }
            let to: Vec<_> = match met.binary_search(&i) {
                Ok(_) => self.graph.vertices().filter(|j| *j != i).collect(),
                Err(_) => self.graph.successors(i).map(|(j, _)| j).collect(),
            };
            values.fill(0.0);
            for s in states {
                values.iter_mut().zip(self.probabilities(s, &to)).for_each(|(sum, p)| *sum += p);
            }
            for (j, sum) in to.iter().zip(&values) {
                let value = sum / states.len() as f32;
                let visits = self.graph.visits(i).min(self.graph.visits(*j)).max(1);
                let confident =
                    value - self.config.edge_doubt / (visits as f32).sqrt() > self.config.edge_value;
                if confident || self.graph.edge(i, *j).connected {
                    let edge = self.graph.change(i, *j);
                    (edge.value, edge.connected) = (value, true);
                }
            }
        }
    }
}
