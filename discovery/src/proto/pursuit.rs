//! Which goal to pursue next: the nearest of some new ones, of one timescale (thesis 8.4.1).

use inroads_agents::draw::{argmax, proportional as draw};
use inroads_envs::{Bits, Rng};
use rand::RngExt;

use super::{
    GoalId, GoalSpace, ProtoConfig,
    desirable::{novelty, utility},
};

/// The goal to pursue where these bits hold; none when no plausible goal is left to attain. `values` says of goals how
/// probable it is that the policy gets there from here: V_θ(s, g).
///
/// K goals are drawn by desirability; those are divided into strata by their timescales; of one stratum, drawn uniformly, M
/// are drawn by novelty, and the nearest is taken.
pub fn choose(
    space: &GoalSpace,
    bits: &Bits,
    config: &ProtoConfig,
    values: impl FnOnce(&[GoalId]) -> Vec<f32>,
    rng: &mut Rng,
) -> Option<GoalId> {
    let (ids, weights): (Vec<_>, Vec<_>) = space
        .iter()
        .filter(|(_, goal)| goal.is_plausible() && !bits.contains(&goal.wanted.0))
        .map(|(id, goal)| (id, utility(goal)))
        .unzip();
    if ids.is_empty() {
        return None;
    }
    let mut drawn: Vec<_> = draw(&weights, config.draws, rng).into_iter().map(|i| ids[i]).collect();
    drawn.sort_unstable();
    drawn.dedup();
    let strata = strata(space, drawn, config.strata);
    let stratum = &strata[rng.random_range(0..strata.len())];
    let weights: Vec<_> = stratum.iter().map(|id| novelty(space.goal(*id))).collect();
    let mut few: Vec<_> = draw(&weights, config.nearest_of, rng).into_iter().map(|i| stratum[i]).collect();
    few.sort_unstable();
    few.dedup();
    Some(few[argmax(&values(&few), rng)])
}

/// The goals in at most `n` strata of about the same size, by their timescales; none is empty.
fn strata(space: &GoalSpace, mut goals: Vec<GoalId>, n: usize) -> Vec<Vec<GoalId>> {
    goals.sort_by(|a, b| space.goal(*a).timescale.total_cmp(&space.goal(*b).timescale).then(a.cmp(b)));
    let n = n.min(goals.len());
    (0..n).map(|i| goals[i * goals.len() / n..(i + 1) * goals.len() / n].to_vec()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use inroads_envs::Seed;

    fn bits(ones: &[usize]) -> Bits {
        let mut bits = Bits::new(6);
        ones.iter().for_each(|bit| bits.set(*bit));
        bits
    }

    /// Goals 0 to 4 are plausible, the lower the slower; goal 5 is not.
    fn space() -> GoalSpace {
        let mut space = GoalSpace::new(1);
        space.count(&bits(&[]), &bits(&[]), 0.0);
        for i in 0..6 {
            let goal = space.goal_mut(GoalId(i));
            (goal.plausible, goal.timescale) = (Some(i < 5), i as f32);
        }
        space
    }

    #[test]
    fn strata_are_even_and_ordered_by_timescale() {
        let ids = |ids: &[u32]| ids.iter().map(|i| GoalId(*i)).collect::<Vec<_>>();
        let found = strata(&space(), ids(&[4, 1, 0, 3, 2]), 2);
        assert_eq!(found, [ids(&[0, 1]), ids(&[2, 3, 4])]);
        assert_eq!(strata(&space(), ids(&[4, 1]), 5), [ids(&[1]), ids(&[4])]);
    }

    #[test]
    fn every_stratum_has_its_turn_and_within_one_the_nearest_goal_does() {
        let (space, mut rng) = (space(), Seed(0).stream("test", 0));
        // So many draws that both goals of a stratum are among them.
        let config = ProtoConfig { strata: 2, nearest_of: 50, ..ProtoConfig::default() };
        // The slower of each stratum are the nearer.
        let near = |few: &[GoalId]| few.iter().map(|id| 1.0 - id.0 as f32 / 10.0).collect::<Vec<_>>();
        let mut times = [0; 6];
        for _ in 0..200 {
            let id = choose(&space, &bits(&[4]), &config, near, &mut rng).expect("some goals do not hold");
            times[id.index()] += 1;
        }
        // Goal 4 holds: strata are {0, 1} and {2, 3}.
        assert_eq!((times[1], times[3], times[4], times[5]), (0, 0, 0, 0));
        assert!(times[0] > 60 && times[2] > 60);
        assert_eq!(choose(&space, &bits(&[0, 1, 2, 3, 4]), &config, near, &mut rng), None);
    }
}
