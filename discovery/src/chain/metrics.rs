//! Which skills make a chain: whose probability of success is measured (4.2.2, equation 4.2).

use crate::SkillRecord;

/// The skills that lead from a skill to the task's goal, the skill itself first.
pub fn chain_from(skills: &[SkillRecord], skill: u32) -> Vec<u32> {
    let record = |k: u32| skills.iter().find(|record| record.skill == k);
    std::iter::successors(record(skill), |last| record(last.enters?)).map(|record| record.skill).collect()
}

/// The skills that no other skill aims at: where chains begin.
pub fn leaves(skills: &[SkillRecord]) -> Vec<u32> {
    let aimed_at = |k: u32| skills.iter().any(|record| record.enters == Some(k));
    skills.iter().map(|record| record.skill).filter(|k| !aimed_at(*k)).collect()
}

/// The chaining probability (equation 4.2): the product of the empirical success rates of the skills of a chain. Of a tree
/// that is the longest chain's, of several equally long ones the youngest's. Skills that were never executed are left out,
/// for they have no rate; none where none was.
pub fn chaining_probability(skills: &[SkillRecord]) -> Option<f64> {
    let executed: Vec<_> = skills.iter().filter(|record| record.executions > 0).cloned().collect();
    let longest = executed
        .iter()
        .map(|record| chain_from(&executed, record.skill))
        .max_by_key(|chain| (chain.len(), chain[0]))?;
    let rate = |record: &&SkillRecord| longest.contains(&record.skill);
    Some(executed.iter().filter(rate).map(|r| r.successes as f64 / r.executions as f64).product())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::Phase;

    fn record(skill: u32, enters: Option<u32>, successes: u64, executions: u64) -> SkillRecord {
        SkillRecord { skill, enters, phase: Phase::Fixed, born: 0, executions, successes, examples: (0, 0) }
    }

    #[test]
    fn a_tree_has_a_chain_a_leaf() {
        // 1 reaches the goal; 2 and 3 enter 1; 4 enters 3.
        let skills = [
            record(1, None, 9, 10),
            record(2, Some(1), 1, 2),
            record(3, Some(1), 4, 5),
            record(4, Some(3), 0, 0),
        ];
        assert_eq!(leaves(&skills), [2, 4]);
        assert_eq!((chain_from(&skills, 4), chain_from(&skills, 2)), (vec![4, 3, 1], vec![2, 1]));
        assert!(chain_from(&skills, 9).is_empty());
    }

    #[test]
    fn the_longest_chain_that_was_executed_has_a_probability() {
        let chain = [
            record(1, None, 9, 10),
            record(2, Some(1), 1, 2),
            record(3, Some(1), 4, 5),
            record(4, Some(3), 0, 0),
        ];
        // 4 was never executed, and of 2 → 1 and 3 → 1 the latter is younger.
        assert_eq!(chaining_probability(&chain), Some(0.9 * 0.8));
        assert_eq!(chaining_probability(&chain[3..]), None);
    }
}
