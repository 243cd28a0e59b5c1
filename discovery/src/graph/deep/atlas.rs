//! The vertices of a deep skill graph: goal regions and options, where each may begin and has ended, and which edges
//! follow from that (6.1.1, 6.1.4).
//!
//! A goal region is treated as the thesis does "to unify notation": its initiation set is the region itself, its effect
//! set the states in which it was entered. So "end in that vertex's initiation set" is what every option does, whether
//! its subgoal is a region or another option.

use std::marker::PhantomData;

use inroads_agents::{Bag, Checkpoint, Corrupt, Experience};
use serde::{Deserialize, Serialize};

use super::{Region, walks::laplace};
use crate::graph::{Edge, SkillGraph, Vertex};
use crate::{
    Goal, Initiation, SkillId, Subgoal,
    chain::{Phase, Skill},
};

/// Calls of an edge after which its own counts speak, and not those of the option from everywhere.
const KNOWN: u32 = 5;

/// What is known of a vertex.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Row {
    skill: Skill,
    set: Set,
    /// Steps of its gestation, on the average; 0 for a region.
    steps: f32,
    /// Steps that all its executions took, whether they succeeded or not.
    spent: u64,
}

/// Where a vertex may begin.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
enum Set {
    /// It is a goal region.
    Ball(Region),
    /// It is an option, whose set has this number in the family.
    Learned(SkillId),
}

/// Vertices with their sets, and the graph that follows from them.
pub(super) struct Atlas<A, I> {
    graph: SkillGraph,
    rows: Vec<Row>,
    /// Changes of what plans rest on.
    revision: u64,
    sets: I,
    /// Share of an effect set that makes an edge.
    inclusion: f32,
    actions: PhantomData<fn(&A)>,
}

impl<A, I> Atlas<A, I> {
    pub(super) fn new(sets: I, inclusion: f32) -> Self {
        let (graph, rows) = (SkillGraph::default(), Vec::new());
        Self { graph, rows, revision: 0, sets, inclusion, actions: PhantomData }
    }

    /// A number that is another one whenever plans may be: they hold for as long as it stays.
    pub(super) fn revision(&self) -> u64 {
        self.revision
    }

    pub(super) fn graph(&self) -> &SkillGraph {
        &self.graph
    }

    pub(super) fn skill(&self, v: Vertex) -> &Skill {
        &self.rows[v.index()].skill
    }

    /// The goal region that a vertex is; none for an option.
    pub(super) fn region(&self, v: Vertex) -> Option<&Region> {
        match &self.rows[v.index()].set {
            Set::Ball(region) => Some(region),
            Set::Learned(_) => None,
        }
    }

    /// All vertices that are goal regions.
    pub(super) fn regions(&self) -> impl Iterator<Item = (Vertex, &Region)> {
        self.graph.vertices().filter_map(|v| Some((v, self.region(v)?)))
    }

    /// All vertices that are options.
    pub(super) fn options(&self) -> impl Iterator<Item = Vertex> {
        self.graph.vertices().filter(|v| self.region(*v).is_none())
    }

    /// The vertex whose initiation set a vertex ends in: itself for a region.
    pub(super) fn end(&self, v: Vertex) -> Vertex {
        match self.skill(v).subgoal {
            Subgoal::Enter(k) => Vertex::of(k).unwrap_or(v),
            Subgoal::Task => v,
        }
    }

    /// States in which a vertex ended lately, of episodes that are still remembered: its effect set.
    pub(super) fn effects<'a>(
        &self,
        v: Vertex,
        all: &'a Experience<Vec<f32>, A>,
    ) -> impl Iterator<Item = &'a Vec<f32>> {
        self.skill(v)
            .effects
            .iter()
            .filter_map(|(number, step)| all.episode(*number)?.observations.get(*step as usize))
    }

    /// ‖v − place‖: the greatest distance of its effect set (6.1.3); of a region's middle where nothing is remembered.
    pub(super) fn distance(&self, v: Vertex, place: &Region, all: &Experience<Vec<f32>, A>) -> f32 {
        let farthest = self.effects(v, all).map(|s| place.distance(s)).fold(f32::NEG_INFINITY, f32::max);
        match self.region(v) {
            Some(region) if farthest < 0.0 => distance(region.at(), place.at()),
            _ if farthest < 0.0 => f32::INFINITY,
            _ => farthest,
        }
    }

    /// How probable it is that a vertex, called at a state of `from`, succeeds. To be in a region where one is already
    /// takes no call.
    pub(super) fn probability(&self, from: Option<Vertex>, o: Vertex) -> f32 {
        if self.region(o).is_some() {
            return 1.0;
        }
        let edge = from.map(|from| self.graph.edge(from, o)).unwrap_or_default();
        let skill = self.skill(o);
        match edge.tries >= KNOWN {
            true => laplace(u64::from(edge.successes), u64::from(edge.tries)),
            false => laplace(skill.successes, skill.executions),
        }
    }

    /// What is known of calling option `o` at a state of `from`, were that a vertex of its own.
    pub(super) fn call(&self, from: Option<Vertex>, o: Vertex) -> Edge {
        let skill = self.skill(o);
        Edge {
            connected: true,
            tries: skill.executions as u32,
            successes: skill.successes as u32,
            value: self.probability(from, o),
            reward: 0.0,
            steps: self.cost(o),
        }
    }

    /// What it costs to get along option `o`: the steps of all its executions, a success; an option that fails is dear.
    pub(super) fn cost(&self, o: Vertex) -> f32 {
        let row = &self.rows[o.index()];
        match (self.region(o), row.skill.successes) {
            (Some(_), _) => 0.0,
            (None, 0) => row.steps + row.spent as f32,
            (None, successes) => row.spent as f32 / successes as f32,
        }
    }
}

impl<A, I: Initiation<Vec<f32>, A>> Atlas<A, I> {
    /// I_v: whether the vertex may begin at `s`.
    pub(super) fn contains(&self, v: Vertex, s: &Vec<f32>) -> bool {
        match &self.rows[v.index()].set {
            Set::Ball(region) => region.reached(s),
            Set::Learned(k) => self.sets.contains(*k, s),
        }
    }

    /// β_v: whether `s` is where the vertex ends.
    pub(super) fn ended(&self, v: Vertex, s: &Vec<f32>) -> bool {
        self.contains(self.end(v), s)
    }

    /// Whether `o` is an option that can be executed at `s`: one that is at its end already has nothing to do.
    pub(super) fn executable(&self, o: Vertex, s: &Vec<f32>) -> bool {
        self.region(o).is_none() && self.contains(o, s) && !self.ended(o, s)
    }

    /// V(s): the options that can be executed at `s`, and the regions that it lies in (equation 6.3).
    pub(super) fn at(&self, s: &Vec<f32>) -> Vec<Vertex> {
        let maps =
            |v: &Vertex| self.executable(*v, s) || self.region(*v).is_some_and(|region| region.reached(s));
        self.graph.vertices().filter(maps).collect()
    }

    /// B(s): the regions that `s` lies in (equation 6.2).
    pub(super) fn regions_at(&self, s: &Vec<f32>) -> Vec<Vertex> {
        self.regions().filter(|(_, region)| region.reached(s)).map(|(v, _)| v).collect()
    }

    /// Whether a region about `s` would tell nothing new (authors' reject rules): it lies in an option's set, or nearer
    /// to a region than `spacing`.
    pub(super) fn known(&self, s: &Vec<f32>, spacing: f32) -> bool {
        self.regions().any(|(_, region)| region.distance(s) < spacing)
            || self.options().any(|o| self.contains(o, s))
    }

    fn add(&mut self) -> Vertex {
        self.revision += 1;
        self.graph.add()
    }

    /// A new vertex for a goal region.
    pub(super) fn add_region(&mut self, region: Region, now: u64) -> Vertex {
        let v = self.add();
        let skill = Skill::new(Subgoal::Enter(v.skill()), Phase::Fixed, now);
        self.rows.push(Row { skill, set: Set::Ball(region), steps: 0.0, spent: 0 });
        v
    }

    /// A new vertex for an option that ends in the set of `subgoal`, may begin where `positives` are, and has ended at
    /// these steps of these episodes.
    pub(super) fn add_option(
        &mut self,
        subgoal: Subgoal,
        now: u64,
        positives: &[Vec<f32>],
        ended: &[(u64, u32)],
        steps: f32,
    ) -> Vertex {
        let k = SkillId(self.options().count() as u32 + 1);
        let v = self.add();
        self.sets.born(k, positives);
        let mut skill = Skill::new(subgoal, Phase::Refining, now);
        skill.effects = ended.to_vec();
        self.rows.push(Row { skill, set: Set::Learned(k), steps, spent: 0 });
        v
    }

    /// A region was entered at a step of an episode.
    pub(super) fn entered(&mut self, v: Vertex, episode: u64, step: u32) {
        self.graph.visit(v);
        self.rows[v.index()].skill.executed(episode, Some((episode, step)));
    }

    /// Option `o` was executed from a state of these vertices.
    pub(super) fn executed(
        &mut self,
        o: Vertex,
        from: &[Vertex],
        episode: u64,
        steps: (u32, u32),
        success: bool,
    ) {
        self.revision += 1;
        for i in from {
            // What an edge costs and how probable it is, its test says.
            let edge = self.graph.change(*i, o);
            edge.tries += 1;
            edge.successes += u32::from(success);
        }
        self.graph.visit(o);
        let row = &mut self.rows[o.index()];
        row.skill.executed(episode, success.then_some((episode, steps.1)));
        row.spent += u64::from(steps.1 - steps.0);
    }

    /// Refines the set of option `o` by states that led to its subgoal, or did not.
    pub(super) fn refine(&mut self, o: Vertex, states: &[Vec<f32>], success: bool) {
        if let Set::Learned(k) = self.rows[o.index()].set {
            self.sets.outcome(k, states, success);
        }
    }

    /// The set of option `o` changes no more.
    pub(super) fn fix(&mut self, o: Vertex) {
        self.rows[o.index()].skill.phase = Phase::Fixed;
    }

    /// Positive and negative examples behind the set of option `o`.
    pub(super) fn examples(&self, o: Vertex) -> (usize, usize) {
        match self.rows[o.index()].set {
            Set::Learned(k) => self.sets.examples(k),
            Set::Ball(_) => (0, 0),
        }
    }

    /// Tests all edges from and to these vertices again.
    pub(super) fn relink(&mut self, changed: &[Vertex], all: &Experience<Vec<f32>, A>) {
        self.revision += u64::from(!changed.is_empty());
        for &v in changed {
            for w in self.graph.vertices().filter(|w| *w != v) {
                self.test(v, w, all);
                self.test(w, v, all);
            }
        }
    }

    /// E_i ⊆ I_j, but for a share of outliers (6.1.4). Without remembered effects the edge stays what it is.
    fn test(&mut self, i: Vertex, j: Vertex, all: &Experience<Vec<f32>, A>) {
        let count = self.effects(i, all).count();
        if count == 0 {
            return;
        }
        let outliers = ((1.0 - self.inclusion) * count as f32 + 1e-3) as usize;
        // Most pairs are told apart by their first few states.
        let outside = self.effects(i, all).filter(|s| !self.contains(j, s)).take(outliers + 1).count();
        let connected = outside <= outliers;
        let (steps, value) = (self.cost(j), self.probability(Some(i), j));
        if connected || self.graph.edge(i, j).connected {
            let edge = self.graph.change(i, j);
            (edge.connected, edge.steps, edge.value) = (connected, steps, value);
        }
    }
}

impl<A, I: Checkpoint> Checkpoint for Atlas<A, I> {
    fn save(&self, bag: &mut Bag) {
        bag.put("vertices", &(&self.graph, &self.rows));
        bag.put_part("sets", &self.sets);
    }

    fn load(&mut self, bag: &Bag) -> Result<(), Corrupt> {
        self.revision += 1;
        (self.graph, self.rows) = bag.get("vertices")?;
        bag.get_part("sets", &mut self.sets)
    }
}

/// Euclidean distance of two places.
pub(super) fn distance(a: &[f32], b: &[f32]) -> f32 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f32>().sqrt()
}
