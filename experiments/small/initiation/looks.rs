//! What a look at sets and policies finds.

use inroads::discovery::SkillId;
use serde::Serialize;

use super::practice::{GOALS, Practice, practise, seen};
use super::truth::Cells;
use super::ways::Way;

/// Executions that are asked for, over the four options.
pub(super) const QUERIES: u64 = 4000;
/// Queries between two looks.
const EVERY: u64 = 100;

/// What a look finds, over all pairs of an option and a cell that is not its goal.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct Look {
    pub(super) queries: u64,
    pub(super) executions: u64,
    /// Share of pairs about which the set is right.
    pub(super) accuracy: f64,
    /// Mean of the shares of those that are inside in truth, and of those that are not, where there are any.
    pub(super) balanced: f64,
    /// Share of pairs inside, as the sets say.
    pub(super) predicted: f64,
    /// Share of pairs inside in truth: the policy succeeds with probability above one half.
    pub(super) actual: f64,
}

/// The first option's set: what is true, and what is said.
pub(super) struct Picture {
    pub(super) truth: Vec<f64>,
    pub(super) inside: Vec<bool>,
}

fn look(cells: &Cells, queries: u64, executions: u64, agent: &Practice) -> (Look, Picture) {
    let (mut right, mut count, mut predicted) = ([0.0; 2], [0.0; 2], 0.0);
    let mut first = None;
    for (option, goal) in GOALS.into_iter().enumerate() {
        let truth = cells.success(goal, agent.policy.learner());
        let set = |cell: &[u8; 2]| agent.sets.contains(SkillId(option as u32 + 1), &seen(*cell, goal));
        let inside: Vec<bool> = cells.at.iter().map(set).collect();
        for (cell, (truth, inside)) in cells.at.iter().zip(truth.iter().zip(&inside)) {
            if *cell != goal {
                let class = *truth > 0.5;
                count[usize::from(class)] += 1.0;
                right[usize::from(class)] += f64::from(u8::from(*inside == class));
                predicted += f64::from(u8::from(*inside));
            }
        }
        first.get_or_insert(Picture { truth, inside });
    }
    let all = count[0] + count[1];
    let shares: Vec<f64> = (0..2).filter(|c| count[*c] > 0.0).map(|c| right[c] / count[c]).collect();
    let look = Look {
        queries,
        executions,
        accuracy: (right[0] + right[1]) / all,
        balanced: shares.iter().sum::<f64>() / shares.len() as f64,
        predicted: predicted / all,
        actual: count[1] / all,
    };
    (look, first.expect("there are options"))
}

/// Practises with one seed: a look at every hundredth query, and the picture at the end.
pub(super) fn practised(way: &Way, seed: u64, slip: f64) -> (Vec<Look>, Picture) {
    let cells = Cells::new(slip);
    let (mut looks, mut last) = (Vec::new(), None);
    practise(seed, QUERIES, slip, way.build(seed), |queries, executions, agent| {
        if queries % EVERY == 0 {
            let (look, picture) = look(&cells, queries, executions, agent);
            looks.push(look);
            last = Some(picture);
        }
    });
    (looks, last.expect("the first look is before the first query"))
}
