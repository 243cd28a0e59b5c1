//! Expansion by novelty (chapter 7).

use inroads_agents::{
    Checkpoint, Context, Curious, Experience, Learner, Memory, checkpoint,
    draw::{argmax, proportional},
};

use super::{Candidate, Frontier};
use crate::{graph::Vertex, naming::Name};

/// Goes out where much that is new and much reward is expected, and brings home the newest state it found.
pub struct Novel<O, L, N> {
    curious: Curious<O, L>,
    name: N,
    /// k of equation 7.8: standard deviations above the mean bonus that make a state worth a vertex (thesis: 1).
    threshold: f32,
}

checkpoint!([O, L, N] Novel<O, L, N>; plain: ; parts: curious; where L: Checkpoint);

impl<O, L, N> Novel<O, L, N> {
    /// A frontier that acts by `curious`, which has a novelty.
    pub fn new(curious: Curious<O, L>, name: N, threshold: f32) -> Self {
        Self { curious, name, threshold }
    }

    /// U(n) = E\[V_novelty(s)\] over the states of a vertex; 0 where none is remembered. To who does not explore, what the
    /// task is worth from there.
    fn utility<A>(&self, candidate: &Candidate<'_, O>, explore: bool) -> f32
    where
        L: Learner<O, A, ()>,
    {
        let value = |s: &&O| self.curious.learner(explore).values(&Memory::new(), s, &[None])[0];
        candidate.states.iter().map(value).sum::<f32>() / candidate.states.len().max(1) as f32
    }
}

impl<O, A, G, L: Learner<O, A, ()>, N: Name<O, G>> Frontier<O, A, G> for Novel<O, L, N> {
    /// In proportion to utility (equation 7.4); evenly while nobody has any.
    fn choose(&self, _: &mut Memory, candidates: &[Candidate<'_, O>], ctx: &mut Context) -> Vertex {
        let utilities: Vec<f32> = candidates.iter().map(|c| self.utility(c, ctx.explore).max(0.0)).collect();
        let pick = match ctx.explore {
            true => {
                proportional(&utilities.iter().map(|u| f64::from(*u)).collect::<Vec<_>>(), 1, &mut ctx.acting)
                    [0]
            }
            false => argmax(&utilities, &mut ctx.acting),
        };
        candidates[pick].vertex
    }

    fn act(&self, memory: &mut Memory, s: &O, ctx: &mut Context) -> A {
        self.curious.act(memory, s, ctx)
    }

    /// The newest state, if it is newer than most that were ever seen (equation 7.8).
    fn propose(&self, states: &[O], ctx: &mut Context) -> Option<G> {
        let bonuses: Vec<_> = states.iter().map(|s| self.curious.bonus(s)).collect();
        // Of all that are seen for the first time, any.
        let newest = argmax(&bonuses, &mut ctx.acting);
        let oldest = (0..states.len()).min_by(|a, b| bonuses[*a].total_cmp(&bonuses[*b]))?;
        let seen = self.curious.bonuses();
        let stands_out = bonuses[newest] > seen.mean() + self.threshold * seen.deviation();
        let novelty = |s: &O| self.curious.bonus(s);
        stands_out.then(|| self.name.name(&states[newest], &states[oldest], &novelty)).flatten()
    }

    fn aim(&self, s: &O) -> Option<G> {
        self.name.exactly(s)
    }

    fn step(&mut self, all: &Experience<O, A>, ctx: &mut Context) {
        self.curious.step(all.latest(), all, ctx);
    }

    fn updates(&self) -> u64 {
        self.curious.updates()
    }
}
