//! Graph consolidation (6.1.4): which part of the graph to connect next, and the chains of options that do it.
//!
//! A chain is chapter 3's in small: options are created backwards from the region to be reached, each for the event that
//! enough trajectories met first, until one may begin where the chain is to begin.

use std::{collections::BTreeMap, ops::Range};

use inroads_agents::{Experience, draw::argmax};
use inroads_envs::Rng;
use serde::{Deserialize, Serialize};

use super::atlas::{Atlas, distance};
use crate::graph::Vertex;
use crate::{Subgoal, chain::Gestation};

/// Options that lead from one region to another, and those that are about to be.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Chain {
    /// The first ends in `to`, the others where one before may begin.
    options: Vec<Vertex>,
    gestations: Vec<Gestation>,
    /// Attempts that have failed since the last one that succeeded.
    misses: u32,
}

/// All chains, by the regions that they lead from and to.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Chains {
    chains: BTreeMap<(Vertex, Vertex), Chain>,
}

impl Chains {
    /// The options from one region to another, the last link of the chain first.
    pub(super) fn options(&self, from: Vertex, to: Vertex) -> &[Vertex] {
        self.chains.get(&(from, to)).map_or(&[], |chain| &chain.options)
    }

    /// An attempt to get from one region to the other is over.
    pub(super) fn attempted(&mut self, from: Vertex, to: Vertex, arrived: bool) {
        let chain = self.chains.entry((from, to)).or_default();
        chain.misses = if arrived { 0 } else { chain.misses + 1 };
    }

    /// Some steps of an episode ended with an event that an option could aim at. With enough of them the gestation of
    /// that option is complete.
    pub(super) fn triggered(
        &mut self,
        pair: (Vertex, Vertex),
        event: Vertex,
        (episode, steps): (u64, Range<u32>),
        needed: u32,
    ) -> Option<Gestation> {
        let subgoal = Subgoal::Enter(event.skill());
        let gestations = &mut self.chains.entry(pair).or_default().gestations;
        let index = gestations.iter().position(|g| g.subgoal == subgoal).unwrap_or_else(|| {
            gestations.push(Gestation::new(subgoal));
            gestations.len() - 1
        });
        gestations[index].triggers.push((episode, steps));
        (gestations[index].triggers.len() >= needed as usize).then(|| gestations.swap_remove(index))
    }

    /// A chain has another option.
    pub(super) fn grow(&mut self, from: Vertex, to: Vertex, option: Vertex) {
        self.chains.entry((from, to)).or_default().options.push(option);
    }

    /// The closest pair (v_d, v_a) of a region that can be reached and one that `wanted` is said of; none where there is
    /// none of either.
    ///
    /// Distances are the greatest of two effect sets. A pair between which nobody got lately counts as farther, the more
    /// often it was tried: else a wall between two neighbours would hold the agent for good.
    pub(super) fn closest<I, A>(
        &self,
        atlas: &Atlas<A, I>,
        reachable: &[bool],
        wanted: impl Fn(Vertex) -> bool,
        patience: u32,
        all: &Experience<Vec<f32>, A>,
        rng: &mut Rng,
    ) -> Option<(Vertex, Vertex)> {
        let (mut pairs, mut nearness): (Vec<_>, Vec<f32>) = Default::default();
        let mut best = f32::INFINITY;
        for (a, goal) in atlas.regions().filter(|(v, _)| !reachable[v.index()] && wanted(*v)) {
            for (d, region) in atlas.regions().filter(|(v, _)| reachable[v.index()]) {
                let misses = self.chains.get(&(d, a)).map_or(0, |chain| chain.misses);
                let weight = 1.0 + misses as f32 / patience as f32;
                // States of a region are within its radius, so only near pairs need be looked at closely.
                let least = distance(region.at(), goal.at()) - region.tolerance() - goal.tolerance();
                if weight * least > best {
                    continue;
                }
                let far = weight * between(atlas, d, a, all);
                best = best.min(far);
                pairs.push((d, a));
                nearness.push(-far);
            }
        }
        (!pairs.is_empty()).then(|| pairs[argmax(&nearness, rng)])
    }
}

/// The greatest distance between states of two regions' effect sets; of their middles where one has none.
fn between<A, I>(atlas: &Atlas<A, I>, d: Vertex, a: Vertex, all: &Experience<Vec<f32>, A>) -> f32 {
    let Some((from, to)) = atlas.region(d).zip(atlas.region(a)) else { return f32::INFINITY };
    let places = |v, region: &super::Region| -> Vec<Vec<f32>> {
        let mut places: Vec<_> =
            atlas.effects(v, all).map(|s| region.kept().map(|(i, _)| s[i as usize]).collect()).collect();
        if places.is_empty() {
            places.push(region.at().to_vec());
        }
        places
    };
    let (from, to) = (places(d, from), places(a, to));
    from.iter().flat_map(|d| to.iter().map(|a| distance(d, a))).fold(0.0, f32::max)
}
