//! Which attained goals to learn about in hindsight (thesis 8.4.2).

use inroads_agents::draw;
use inroads_envs::{Bits, Rng};
use serde::{Deserialize, Serialize};

use super::{GoalId, GoalSpace, ProtoConfig, desirable::novelty};

/// How goals are picked among those that a call attained.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Relabel {
    /// M_her of them, in proportion to novelty (thesis).
    Novel,
    /// M_her of them, all with the same probability (its ablation).
    Uniform,
    /// All of them (its other ablation).
    All,
}

/// The goals to learn about, of steps before and after which these bits held: some of the plausible ones that they
/// attained.
pub fn goals(space: &GoalSpace, bits: &[&Bits], config: &ProtoConfig, rng: &mut Rng) -> Vec<GoalId> {
    let mut attained: Vec<_> = bits.windows(2).flat_map(|step| space.attained(step[0], step[1])).collect();
    attained.sort_unstable();
    attained.dedup();
    attained.retain(|id| space.goal(*id).is_plausible());
    let weights: Vec<_> = match config.relabel {
        Relabel::All => return attained,
        Relabel::Novel => attained.iter().map(|id| novelty(space.goal(*id))).collect(),
        Relabel::Uniform => vec![1.0; attained.len()],
    };
    draw::different(&weights, config.hindsight, rng).into_iter().map(|i| attained[i]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use inroads_envs::Seed;

    fn bits(ones: &[usize]) -> Bits {
        let mut bits = Bits::new(4);
        ones.iter().for_each(|bit| bits.set(*bit));
        bits
    }

    #[test]
    fn attained_goals_are_those_that_came_to_hold_and_are_plausible() {
        let path = [bits(&[0, 3]), bits(&[1, 3]), bits(&[2]), bits(&[1])];
        let path: Vec<_> = path.iter().collect();
        let mut space = GoalSpace::new(1);
        for step in path.windows(2) {
            space.count(step[0], step[1], 0.0);
        }
        for id in [0, 1, 3] {
            space.goal_mut(GoalId(id)).plausible = Some(true);
        }
        let mut rng = Seed(0).stream("test", 0);
        let config = |relabel| ProtoConfig { relabel, ..ProtoConfig::default() };
        for relabel in [Relabel::All, Relabel::Novel, Relabel::Uniform] {
            let found = goals(&space, &path, &config(relabel), &mut rng);
            assert_eq!(found, [GoalId(1)], "0 and 3 held from the start, 2 is not plausible");
        }
    }

    #[test]
    fn what_is_new_is_learned_sooner() {
        let mut space = GoalSpace::new(1);
        let path = [bits(&[]), bits(&[0]), bits(&[1])];
        let path: Vec<_> = path.iter().collect();
        for _ in 0..9 {
            space.count(path[0], path[1], 0.0);
        }
        space.count(path[1], path[2], 0.0);
        (0..2).for_each(|id| space.goal_mut(GoalId(id)).plausible = Some(true));
        let mut rng = Seed(0).stream("test", 0);
        let mut often = |relabel| {
            let config = ProtoConfig { relabel, hindsight: 1, ..ProtoConfig::default() };
            (0..4000).filter(|_| goals(&space, &path, &config, &mut rng) == [GoalId(0)]).count() as i64
        };
        // Weights 1/3 and 1.
        assert!((often(Relabel::Novel) - 1000).abs() < 120 && (often(Relabel::Uniform) - 2000).abs() < 130);
    }
}
