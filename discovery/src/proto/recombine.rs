//! New goals of mastered ones (thesis 8.2.3, 8.4.3).

use super::{GoalSpace, ProtoConfig};
use crate::Wanted;

/// Adds the AND of every pair of plausible and mastered goals, as a candidate that the next evaluation may find plausible.
pub(super) fn recombine(space: &mut GoalSpace, config: &ProtoConfig) {
    let mastered: Vec<_> = space
        .iter()
        .filter(|(_, goal)| goal.is_plausible() && goal.pursuits.mastered(config.mastery))
        .map(|(_, goal)| goal.wanted.0.clone())
        .collect();
    for (i, one) in mastered.iter().enumerate() {
        for other in &mastered[i + 1..] {
            let mut both = one.clone();
            other.ones().for_each(|bit| both.set(bit));
            let fits = both.ones().count() <= config.max_bits && space.len() < config.max_goals;
            if fits && space.find(&both).is_none() {
                space.add(Wanted(both));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::proto::GoalId;
    use inroads_envs::Bits;

    #[test]
    fn only_pairs_of_mastered_goals_come_in_and_each_once() {
        let mut space = GoalSpace::new(1);
        space.count(&Bits::new(4), &Bits::new(4), 0.0);
        for i in 0..4 {
            let goal = space.goal_mut(GoalId(i));
            goal.plausible = Some(i != 3);
            goal.pursuits.push(i != 0);
        }
        let config = ProtoConfig { max_bits: 3, ..ProtoConfig::default() };
        recombine(&mut space, &config);
        recombine(&mut space, &config);
        let new: Vec<_> = space.iter().skip(4).map(|(_, g)| g.wanted.0.ones().collect::<Vec<_>>()).collect();
        assert_eq!(new, [[1, 2]], "goal 0 is not mastered, goal 3 is not plausible");
        // A mastered combination combines as well, up to three proto-goals.
        let pair = space.goal_mut(GoalId(4));
        pair.plausible = Some(true);
        pair.pursuits.push(true);
        space.goal_mut(GoalId(0)).pursuits.push(true);
        recombine(&mut space, &config);
        let triples = space.iter().filter(|(_, g)| g.wanted.0.ones().count() == 3).count();
        assert_eq!((space.len(), triples), (4 + 3 + 1, 1), "{{0,1}}, {{0,2}}, {{1,2}} and {{0,1,2}}");
    }
}
